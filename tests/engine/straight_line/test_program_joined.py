"""Two programs written by hand as one: angles and steps that both have are there once."""

from __future__ import annotations

import numpy as np

from poekin.engine.count import Count
from poekin.engine.straight_line.interpret import evaluate
from poekin.engine.straight_line.program import Angle, Program, joined
from poekin.engine.straight_line.trace import Node

A = Angle(None, ((0, 1.0),), 0.0)
B = Angle(None, ((1, 1.0),), 0.25)
C = Angle(0, ((1, 2.0),), 0.0)
D = Angle(None, ((2, -1.0),), 0.0)


def inputs(count: int, *coordinates: int) -> list[Node]:
    return [Node("input", number) for number in (*range(count), *(-1 - k for k in coordinates))]


def made(angles, nodes, ends) -> Program:
    return Program(angles, tuple(enumerate(nodes)), ends, Count())


# sines and cosines 0 to 5 of three angles, q_0, q_2
FIRST = made(
    (A, B, C),
    [*inputs(6, 0, 2), Node("product", 0, 3), Node("sum", 8, 6, -1), Node("reciprocal", 1.0, 7)],
    ((9, -1.0), (10, 1.0), (None, 0.5)),
)
# of these D and the last one are new: it is made from B, as C is from A
SECOND_ANGLES = (B, D, Angle(0, ((1, 2.0),), 0.0), A)
SECOND = made(
    SECOND_ANGLES,
    [
        *inputs(8, 2, 1),
        Node("reciprocal", 1.0, 8),  # which the first one has too
        Node("scaled", 0.75, 3),
        Node("product", 4, 7),
        Node("sum", 11, 12, -1),
        Node("sum", 2, 5, 1),
        Node("constant", 2.0),
        Node("product", 6, 1),  # the first one has it too
        Node("reciprocal", 1.0, 15),
    ],
    (*tuple((k, (-1.0) ** k) for k in range(18)), (None, -0.25)),
)


def test_what_both_have_is_there_once_and_what_one_has_keeps_its_numbers():
    both = joined(FIRST, SECOND)
    assert both.angles == (A, B, C, D, Angle(1, ((1, 2.0),), 0.0))
    # of the second: sines and cosines of two angles, q_1, and all other steps but two
    assert len(both.steps) == len(FIRST.steps) + 4 + 1 + 6
    assert both.steps[: len(FIRST.steps)] == FIRST.steps
    assert len({number for number, _ in both.steps}) == len(both.steps)
    assert len({node for _, node in both.steps}) == len(both.steps)
    assert joined(FIRST, FIRST).steps == FIRST.steps
    assert joined(FIRST, FIRST).outputs == 2 * FIRST.outputs


def test_outputs_are_those_of_the_first_and_behind_them_of_the_second_to_the_last_bit():
    q = np.random.default_rng(0).uniform(0.5, 2, (20, 3))
    for one, other in ((FIRST, SECOND), (SECOND, FIRST), (SECOND, SECOND)):
        found = evaluate(joined(one, other), q)
        np.testing.assert_array_equal(found, np.hstack([evaluate(one, q), evaluate(other, q)]))


def test_its_cost_is_that_of_its_steps_and_angles():
    count = joined(FIRST, SECOND).count
    # products of three steps and of 2 q_1 twice; sums of three steps and of three angles
    assert (count.multiplications, count.additions) == (3 + 2, 3 + 3)
    assert (count.divisions, count.sines, count.cosines) == (2, 5, 5)
    empty = made((), [], ((None, 3.0),))
    assert joined(empty, FIRST).steps == FIRST.steps
    assert joined(empty, FIRST).outputs == (empty.outputs[0], *FIRST.outputs)
