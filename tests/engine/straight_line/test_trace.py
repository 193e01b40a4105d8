"""What the recording scalar folds, merges and leaves out, and what it does not."""

import math
from typing import Any

import pytest

from poekin.engine.straight_line.program import Angles, program
from poekin.engine.straight_line.trace import FOLD_TOLERANCE, Graph, Traced, folded

EPS = 1e-16


def traced(count=3):
    graph = Graph()
    return graph, *(graph.input(-1 - k) for k in range(count))


def cost(graph, *outputs):
    count = program(graph, Angles(graph), outputs).count
    return count.multiplications, count.additions


@pytest.mark.parametrize("exact", [-1.0, 0.0, 1.0])
def test_a_constant_is_0_or_1_or_minus_1_where_it_is_but_for_rounding(exact):
    for off in (0.0, 2.0**-53, -(2.0**-53), FOLD_TOLERANCE):
        assert folded(exact + off) == exact
    assert folded(exact + 4 * FOLD_TOLERANCE) == exact + 4 * FOLD_TOLERANCE
    assert folded(2.0 - FOLD_TOLERANCE) == 2.0 - FOLD_TOLERANCE


@pytest.mark.parametrize("zero", [0.0, -0.0, 0, FOLD_TOLERANCE, -FOLD_TOLERANCE])
def test_a_product_with_zero_and_a_sum_with_zero_are_never_recorded(zero):
    graph, x, _, _ = traced()
    assert x * zero == 0.0
    assert cost(graph, x + zero, zero - x, zero + x * 1.0) == (0, 0)


@pytest.mark.parametrize("one", [1.0, 1, 1 + FOLD_TOLERANCE, 1 - FOLD_TOLERANCE, -1.0, -1])
def test_a_product_with_one_is_the_number_itself_or_its_negative(one):
    graph, x, _, _ = traced()
    result = x * one
    assert isinstance(result, Traced)
    assert (result.number, result.sign) == (x.number, 1 if one > 0 else -1)
    assert cost(graph, result) == (0, 0)


@pytest.mark.parametrize(
    "near", [2 * FOLD_TOLERANCE, 1 + 2 * FOLD_TOLERANCE, -1 + 2 * FOLD_TOLERANCE]
)
def test_what_is_near_zero_or_one_but_not_within_rounding_stays(near):
    graph, x, _, _ = traced()
    assert cost(graph, x * near) == (1, 0)


def test_a_sum_with_a_number_that_is_not_quite_zero_is_an_addition():
    graph, x, _, _ = traced()
    assert cost(graph, x + 2 * FOLD_TOLERANCE) == (0, 1)


def test_constants_that_meet_are_0_or_1_only_exactly():
    graph, x, _, _ = traced()
    assert cost(graph, x * 1e-9 * 1e-9, x * 3.0 * ((1 + FOLD_TOLERANCE) / 3.0)) == (2, 0)
    assert cost(graph, x * 1e-200 * 1e-200, x * 0.5 * 2.0) == (0, 0)


def test_equal_nodes_are_one_node_whatever_their_order_and_sign():
    graph, x, y, z = traced()
    assert cost(graph, x * y + z, z + y * x, -(x * -y) + z) == (1, 1)
    assert cost(graph, x - y, y - x) == (0, 1)


def test_a_number_minus_itself_is_zero_and_plus_itself_is_one_product():
    graph, x, y, _ = traced()
    assert x * y - y * x == 0.0
    assert cost(graph, x + x) == (1, 0)


def test_constants_that_meet_are_multiplied_beforehand():
    graph, x, _, _ = traced()
    result: Any = 3.0 * (0.5 * x)
    assert cost(graph, result) == (1, 0)
    assert graph.nodes[result.number].first == 1.5
    assert cost(graph, 2.0 * (0.5 * x)) == (0, 0)


def test_a_constant_that_is_added_and_taken_away_leaves_no_trace():
    graph, x, y, _ = traced()
    both = x * y
    cases: Any = [
        (1.0 - (1.0 - x), x),
        (-1.0 - (x - 1.0), -x),
        ((both + 2.5) - 2.5, both),
        (-(0.5 - both) + 0.5, both),
    ]
    for found, wanted in cases:
        assert (found.number, found.sign) == (wanted.number, wanted.sign)
    assert cost(graph, 1.0 + (1.0 - x), 1.0 - (1.5 - x)) == (0, 4)


def test_a_constant_that_was_added_elsewhere_before_leaves_no_trace_either():
    _graph, x, y, _ = traced()
    _ = x + 2.5
    both: Any = x * y
    found: Any = (both + 2.5) - 2.5
    assert (found.number, found.sign) == (both.number, both.sign)


def test_a_sum_of_coordinates_takes_what_each_counts():
    graph, x, y, _ = traced()
    assert graph.linear([], 0.25) == 0.25
    one: Any = graph.linear([(0, 1.0)], 0.0)
    assert one.number == x.number
    total: Any = graph.linear([(0, -1.0), (1, 2.0)], 0.5)
    wanted = 0.5 - x + 2.0 * y
    assert (total.number, total.sign) == (wanted.number, wanted.sign)


def test_what_no_output_needs_is_left_out():
    graph, x, y, z = traced()
    _ = x * y * z + x
    assert cost(graph, x + y) == (0, 1)


def test_quarter_turns_and_signs_of_an_angle_need_no_other_sine():
    graph = Graph()
    angles: Any = Angles(graph)
    s, c = angles.sine_cosine([1.0], 0.0, 0)
    for factor in (1.0, -1.0):
        for quarters in range(-4, 5):
            s2, c2 = angles.sine_cosine([factor], 0.0, quarters)
            assert {s2.number, c2.number} == {s.number, c.number}
    count = program(graph, angles, [s, c]).count
    assert (count.sines, count.cosines, count.additions) == (1, 1, 0)


@pytest.mark.parametrize("factor, quarters, sine, cosine", [(1, 1, "c", "-s"), (-1, 0, "-s", "c"), (-1, 1, "c", "s"),
                                                            (1, 2, "-s", "-c"), (-1, 3, "-c", "-s")])  # fmt: skip
def test_quarter_turns_and_signs_are_the_right_ones(factor, quarters, sine, cosine):
    angles: Any = Angles(Graph())
    s, c = angles.sine_cosine([1.0], 0.0, 0)
    named = {"s": s, "c": c, "-s": -s, "-c": -c}
    for got, name in zip(
        angles.sine_cosine([float(factor)], 0.0, quarters), (sine, cosine), strict=True
    ):
        assert (got.number, got.sign) == (named[name].number, named[name].sign)


def test_a_sum_of_angles_is_made_from_the_sum_before_it():
    graph = Graph()
    angles = Angles(graph)
    outputs = [
        angles.sine_cosine(f, 0.0, 0)[0] for f in ([1.0, 0, 0], [1.0, 1.0, 0], [1.0, 1.0, 1.0])
    ]
    assert program(graph, angles, outputs).count.additions == 2


def test_a_sum_of_scaled_angles_is_made_from_another_one_where_that_saves_multiplications():
    graph = Graph()
    angles = Angles(graph)
    outputs = [angles.sine_cosine(f, 0.0, 0)[0] for f in ([1.0, 2.0], [2.0, 3.0], [0.0, 0.0, 1.0])]
    made = program(graph, angles, outputs)
    assert [angle.base for angle in made.angles] == [None, None, 1]
    assert (made.count.multiplications, made.count.additions) == (1, 3)


@pytest.mark.parametrize("quarters", [-3, 1, 2, 8])
def test_an_offset_that_is_a_right_angle_is_a_quarter_turn(quarters):
    angles: Any = Angles(Graph())
    turned = angles.sine_cosine([1.0], quarters * math.pi / 2, 0)
    exact = angles.sine_cosine([1.0], 0.0, quarters)
    assert [(x.number, x.sign) for x in turned] == [(x.number, x.sign) for x in exact]
    assert angles.sine_cosine([0.0], math.pi / 2, 0) == (1.0, 0.0)


@pytest.mark.parametrize("quarters", [-1, 0, 1])
@pytest.mark.parametrize("side", [-1, 1])
def test_an_offset_is_a_right_angle_up_to_its_rounding_and_no_further(quarters, side):
    def turned(offset):
        found: Any = Angles(Graph()).sine_cosine([1.0], offset, 0)
        return [(x.number, x.sign) for x in found]

    def operations(offset):
        angles = Angles(Graph())
        return program(angles.graph, angles, angles.sine_cosine([1.0], offset, 0)).count.additions

    right = quarters * math.pi / 2
    assert turned(right + side * FOLD_TOLERANCE) == turned(right)
    assert operations(right + side * FOLD_TOLERANCE) == 0
    assert operations(right + 2 * side * FOLD_TOLERANCE) == 1


def test_an_offset_that_is_no_right_angle_costs_an_addition():
    graph = Graph()
    angles = Angles(graph)
    assert program(graph, angles, [angles.sine_cosine([1.0], 0.7, 0)[0]]).count.additions == 1


def test_outputs_within_rounding_of_zero_and_one_are_that():
    graph, x, _, _ = traced()
    outputs = program(graph, Angles(graph), [1 - EPS, -EPS, 0.3, -x]).outputs
    assert outputs == ((None, 1.0), (None, 0.0), (None, 0.3), (x.number, -1.0))
