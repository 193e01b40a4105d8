"""Straight-line programs of any shape: interpreted and as machine code they compute what was
recorded.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from poekin.engine.kernels import arm_kernels
from poekin.engine.straight_line import interpret, specialise
from poekin.engine.straight_line.arm_code import ArmCode
from poekin.engine.straight_line.machine_code import object_code
from poekin.engine.straight_line.program import Angle, Angles, Program, joined, program
from poekin.engine.straight_line.trace import Graph

ROWS = 7  # four at a time, and three one at a time
CONSTANTS = (0.0, 1.0, -1.0, 0.5, -1.75, 3.0)
# A step rounds by 2^-53 of the size of its operands, a sine by 2 × 2^-53, an angle of up to 20 rad
# by some 2^-53 of it: the sum over 20 steps, each of which hands on what came before it.
WITHIN = 400 * 2.0**-53


class Both:
    """A recorded number, its value in each row, and the sum of the sizes of what it was made of."""

    def __init__(self, traced: Any, value: Any, size: Any):
        self.traced, self.value, self.size = traced, value, size

    def __add__(self, other: Both) -> Both:
        return Both(self.traced + other.traced, self.value + other.value, self.size + other.size)

    def __sub__(self, other: Both) -> Both:
        return Both(self.traced - other.traced, self.value - other.value, self.size + other.size)

    def __mul__(self, other: Both) -> Both:
        return Both(self.traced * other.traced, self.value * other.value, self.size * other.size)

    def __neg__(self) -> Both:
        return Both(-self.traced, -self.value, self.size)


@st.composite
def programs(draw, m=None):
    """A program of six outputs for each of m coordinates, its configurations, and what it has to give
    with how large it was.
    """
    m = m or draw(st.integers(1, 3))
    q = np.random.default_rng(draw(st.integers(0, 2**32 - 1))).uniform(-2, 2, (ROWS, m))
    graph = Graph()
    angles = Angles(graph)
    numbers = [Both(graph.input(-1 - k), q[:, k], np.full(ROWS, 2.0)) for k in range(m)]
    for _ in range(draw(st.integers(1, 4))):
        factors = [draw(st.sampled_from((0.0, 1.0, -1.0, 0.5, 2.0))) for _ in range(m)]
        offset, quarters = draw(st.sampled_from((0.0, 0.3, -1.1))), draw(st.integers(-5, 5))
        x = q @ factors + offset + quarters * np.pi / 2
        both = angles.sine_cosine(factors, offset, quarters)
        # a quarter turn is exact in the program and rounded here
        numbers += [
            Both(t, v, np.full(ROWS, 8.0))
            for t, v in zip(both, (np.sin(x), np.cos(x)), strict=True)
        ]
    numbers += [Both(c, np.full(ROWS, c), np.full(ROWS, abs(c))) for c in CONSTANTS]
    some = st.integers(0, 1000)
    for _ in range(draw(st.integers(1, 12))):
        a, b = (numbers[draw(some) % len(numbers)] for _ in range(2))
        made = draw(st.sampled_from((a + b, a - b, a * b, -a)))
        if made.size.max() < 1e3:
            numbers.append(made)
    outputs = [numbers[-1 - draw(some) % len(numbers)] for _ in range(6 * m)]
    made = program(graph, angles, [x.traced for x in outputs])
    return made, q, np.stack([x.value for x in outputs], 1), np.stack([x.size for x in outputs], 1)


def by_machine(made: Program, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The outputs by machine code: of all rows, and of each by itself."""
    m = q.shape[1]
    arm = ArmCode(object_code(made, pose=False), len(made.angles), m)
    many, one = np.full((len(q), 6, m), np.nan), np.full((len(q), 6, m), np.nan)
    arm_kernels.jacobian_many.ready()(arm.address, q, many)
    for row, J in zip(q, one, strict=True):
        assert arm_kernels.jacobian_one.ready()(arm.address, row.copy(), J) == 1
    return many.reshape(len(q), -1), one.reshape(len(q), -1)


some_examples = settings(max_examples=max(settings().max_examples // 3, 20))


@some_examples
@given(programs())
def test_an_interpreted_program_gives_what_was_recorded(case):
    made, q, wanted, size = case
    assert (np.abs(interpret.evaluate(made, q) - wanted) <= WITHIN * np.maximum(size, 1)).all()


@some_examples
@given(programs())
def test_machine_code_gives_what_was_recorded(case):
    made, q, wanted, size = case
    for got in by_machine(made, q):
        assert (np.abs(got - wanted) <= WITHIN * np.maximum(size, 1)).all()


@some_examples
@given(st.data(), st.integers(1, 3))
def test_two_programs_joined_give_the_outputs_of_both(data, m):
    one, q, *_ = data.draw(programs(m))
    two, *_ = data.draw(programs(m))
    both = joined(one, two)
    # the same steps on the same numbers
    wanted = np.hstack([interpret.evaluate(made, q) for made in (one, two)])
    np.testing.assert_array_equal(interpret.evaluate(both, q), wanted)
    assert both.count.sines <= one.count.sines + two.count.sines
    assert joined(one, one).steps == one.steps


@pytest.mark.parametrize(
    "base, terms, offset, cost",
    [
        (None, ((0, 1.0),), 0.0, (0, 0)),
        (None, ((0, -1.0),), 0.0, (0, 0)),
        (None, ((0, 1.0), (1, -1.0)), 0.0, (0, 1)),
        (None, ((0, 0.5), (1, 2.0)), 0.3, (2, 2)),
        (3, ((0, 1.0),), 0.0, (0, 1)),
        (3, ((0, 0.5),), 0.3, (1, 2)),
        (3, (), 0.3, (0, 1)),
        (3, (), 0.0, (0, 0)),
    ],
)
def test_an_angle_costs_its_products_and_its_sums(base, terms, offset, cost):
    angle = Angle(base, terms, offset)
    assert (angle.multiplications, angle.additions) == cost


def test_an_angle_is_made_from_another_only_where_that_saves_something():
    def chosen(*forms):
        angles = Angles(Graph())
        outputs = [angles.sine_cosine(factors, offset, 0)[0] for factors, offset in forms]
        return program(angles.graph, angles, outputs).angles

    one, two = ([1.0, 0, 0], 0.0), ([1.0, 1.0, 0], 0.25)
    assert chosen(two, one) == (
        Angle(None, ((0, 1.0),), 0.0),
        Angle(None, ((0, 1.0), (1, 1.0)), 0.25),
    )  # as dear
    three = ([1.0, 1.0, 1.0], 0.5)
    assert chosen(three, two)[1] == Angle(0, ((2, 1.0),), 0.25)
    assert chosen(([1.0, 0, 0], 0.0), ([0, 1.0, 0], 0.0))[1] == Angle(None, ((1, 1.0),), 0.0)
    assert chosen(([0.5, 0, 0], 0.0), ([0.5, 1.0, 0], 0.0))[1] == Angle(
        0, ((1, 1.0),), 0.0
    )  # a product less
    # what another has besides is taken away again: q_0 / 2 + q_2 - q_2 + q_1 is as dear
    assert chosen(([0.5, 0, 1.0], 0.0), ([0.5, 1.0, 0], 0.0))[1] == Angle(
        None, ((0, 0.5), (1, 1.0)), 0.0
    )
    # twice the first coordinate tells nothing of the sum of both: 2 q_0 - q_0 + q_1 is dearer
    assert chosen(([2.0, 0, 0], 0.0), ([1.0, 1.0, 0], 0.0))[1] == Angle(
        None, ((0, 1.0), (1, 1.0)), 0.0
    )


def test_of_angles_and_nodes_those_that_no_output_needs_are_left_out():
    graph = Graph()
    angles = Angles(graph)
    (s, _), (_, c) = angles.sine_cosine([1.0, 0.0], 0.0, 0), angles.sine_cosine([0.0, 1.0], 0.0, 0)
    _ = s * graph.input(-1)
    made = program(graph, angles, [c])
    assert made.angles == (Angle(None, ((1, 1.0),), 0.0),)
    assert [(node.kind, node.first) for _, node in made.steps] == [("input", 1)]
    assert (made.count.sines, made.count.cosines, made.count.multiplications) == (1, 1, 0)


def test_operations_of_angles_and_of_steps_are_counted_together():
    graph = Graph()
    angles = Angles(graph)
    s, c = angles.sine_cosine([0.5, 1.0], 0.0, 0)
    count = program(graph, angles, [s * c + s]).count
    assert (count.multiplications, count.additions, count.sines, count.cosines) == (2, 2, 1, 1)


def test_the_cost_of_a_sine_or_a_division_is_that_of_ten_products():
    graph = Graph()
    angles = Angles(graph)
    s, c = angles.sine_cosine([1.0], 0.0, 0)
    t, d = angles.sine_cosine([1.0], 0.5, 0)
    made = program(graph, angles, [s * c + t * d])
    assert (made.count.multiplications, made.count.additions, made.count.sines) == (2, 2, 2)
    assert specialise._cost(made) == 2 + 2 + 10 * 2
