"""What is said of one solution and of many: the reason, with its own numbers and names."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from poekin.errors import ShapeError
from poekin.solve.ik.solution import REASONS, Solution, place


def made(reason, position=2e-3, rotation=3e-4, beyond=0.0, blocked=((),)):
    reason = np.array(reason)
    shape, zero = reason.shape, np.zeros(reason.shape, int)
    return Solution(
        np.ones((*shape, 2)), reason == "solved", reason, np.full(shape, position), np.full(shape, rotation), zero,
        zero, np.full(shape, beyond), blocked,
    )  # fmt: skip


OFF = "2 mm and 0.01719° off"


@pytest.mark.parametrize("solution, words", [
    (made("solved"), f"solved: {OFF}"),
    (made("bad target", np.nan, np.nan), "bad target: it is not made of finite numbers"),
    (made("limits", blocked=(("a", "b"),)),
     f"limits: solvable without them, in the way are those of 'a', 'b'; the nearest pose found is {OFF}"),
    (made("iterations"),
     f"iterations: the nearest try was still moving when they ended; the nearest pose found is {OFF}"),
    (made("unreachable"), f"unreachable: the nearest pose found is {OFF}"),
    (made("unreachable", beyond=0.123456),
     f"unreachable: the target is farther than the arm's reach by 123.5 mm; the nearest pose found is {OFF}"),
    (made("unreachable", beyond=29.9),
     f"unreachable: the target is farther than the arm's reach by 2.99e+04 mm; the nearest pose found is {OFF}"),
    (made("unreachable", beyond=30.0),
     f"unreachable: the target is farther than the arm's reach by 3e+04 mm; the nearest pose found is {OFF}"),
    (made("unreachable", beyond=30.01),
     "unreachable: the target is 30.01 m beyond the arm's reach, as one in millimetres would be;"
     f" poses are in m (of files in mm, --mm says so); the nearest pose found is {OFF}"),
    (made("unreachable", beyond=499.2),
     "unreachable: the target is 499.2 m beyond the arm's reach, as one in millimetres would be;"
     f" poses are in m (of files in mm, --mm says so); the nearest pose found is {OFF}"),
])  # fmt: skip
def test_why_is_said_with_all_its_numbers(solution, words):
    assert solution.summary() == str(solution) == words
    assert repr(solution) == f"<Solution {words}: q = [1.0, 1.0]>"


def test_of_many_each_is_counted_by_its_reason_and_asked_by_its_place():
    reason = [["solved", "limits", "solved"], ["unreachable", "limits", "bad target"]]
    blocked = ((), ("a",), (), (), ("b",), ())
    many = made(reason, blocked=blocked)
    assert many.summary() == "2 of 6 solved, 1 unreachable, 2 limits, 1 bad target"
    assert repr(many) == "<Solution 2 of 6 solved, 1 unreachable, 2 limits, 1 bad target>"
    assert "those of 'a';" in many.summary(0, 1)
    assert "those of 'b';" in many.summary(1, 1)
    assert "those of 'b';" in many.summary(-1, -2)
    assert repr(made(["solved", "iterations"])) == "<Solution 1 of 2 solved, 1 iterations>"
    assert repr(made(["solved"] * 3)) == "<Solution 3 of 3 solved>"
    assert set(reason[0] + reason[1]) < set(REASONS)


def test_an_arm_with_too_few_coordinates_is_told_which_tasks_reach_the_target():
    few = replace(made(["solved", "unreachable"]), reachable_tasks=((), ("planar", "position")))
    assert few.summary(1) == (
        f"unreachable: the nearest pose found is {OFF}; with so few coordinates the arm reaches "
        "this target only with task='planar' or task='position'"
    )
    assert few.summary(0) == f"solved: {OFF}"
    assert replace(few, reachable_tasks=((), ())).summary(1).endswith(OFF)


def test_a_solution_is_plain_data_and_json():
    found = made(["solved", "limits"], blocked=((), ("a",)))
    document = found.to_dict()
    assert document["reason"] == ["solved", "limits"]
    assert document["limits_hit"] == [[], ["a"]]
    assert json.loads(found.to_json()) == document


def test_a_place_in_a_batch_is_counted_in_c_order():
    assert [place((i, j), (2, 3), "why") for i in range(2) for j in range(3)] == list(range(6))
    assert place((), (), "why") == 0
    with pytest.raises(ShapeError, match=r"^why: expected an index of 2 numbers, got 1$"):
        place((1,), (2, 3), "why")
    with pytest.raises(IndexError):
        place((2, 0), (2, 3), "why")
