"""The steps that list solutions one by one, as plain Python: borders, places, order and counts."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from poekin.engine.kernels import ik_codes as codes
from poekin.engine.kernels.branches import listed_branches as kernel
from poekin.engine.kernels.branches.sharpen import Branches, BranchProblem

INF = math.inf


def test_numbers_of_a_rule_a_box_and_a_row_have_places_of_their_own():
    assert [*range(5)] == [kernel.CLEAR, kernel.ABSENT, kernel.MOVED, kernel.HOPELESS, kernel.RULE]
    assert [*range(3)] == [kernel.LOW, kernel.HIGH, kernel.PERIOD]
    assert [*range(4)] == [kernel.POSITION, kernel.ROTATION, kernel.PLACES, kernel.ERRORS]
    assert [*range(4)] == [kernel.FOUND, kernel.WITHIN, kernel.IS_CLEAR, kernel.INFO]


@pytest.mark.parametrize("i", range(3))
@pytest.mark.parametrize("way", [1.0, -1.0])
def test_a_row_has_moved_where_one_coordinate_is_farther_off_than_the_most(i, way):
    before = np.array([[5.0, 5, 5], [9.0, 9, 9], [1.0, 2.0, -3.0]])
    q = np.array([[9.0, 9, 9], [1.0, 2.0, -3.0]])
    for off, moved in ((0.5, False), (0.75, True), (math.nan, True)):
        q[1, i] = before[2, i] + way * off
        assert bool(kernel.is_moved(q, 1, before, 2, 0.5)) is moved


@pytest.mark.parametrize("i", range(3))
def test_a_row_is_known_where_one_before_it_of_its_target_is_within_1e_7_and_whole_turns(i):
    box = np.zeros((3, 3))
    box[:, kernel.PERIOD] = 2 * np.pi, 0.0, 2 * np.pi
    same = np.array([0.0, 0.25, -0.5])
    q = np.stack([same, same + 1, same - 1, same])
    assert not kernel.is_known(q, 3, 1, box)
    assert kernel.is_known(q, 3, 0, box)
    for off, known in ((0.9e-7, True), (-0.9e-7, True), (1.1e-7, False), (-1.1e-7, False)):
        for turns in (0, 1):
            q[1] = same
            q[1, i] += off + 2 * np.pi * turns
            expected = known and (turns == 0 or i != 1)
            assert kernel.is_known(q, 3, 1, box) == expected


def test_rows_are_known_up_to_the_limit_of_what_is_apart(monkeypatch):
    monkeypatch.setattr(kernel, "_APART", 0.5)
    assert kernel.is_known(np.array([[0.0], [0.5]]), 1, 0, np.zeros((1, 3)))


@pytest.mark.parametrize(
    ("x", "box", "number", "place"),
    [
        (0.25, (-INF, INF, 1.0), 1, 0.25),
        (7.25, (-INF, INF, 1.0), 1, 7.25),
        (0.25, (-INF, INF, 0.0), 1, 0.25),
        (0.25, (0.0, INF, 1.0), 1, 0.25),
        (0.25, (2.0, INF, 1.0), 1, 2.25),
        (0.25, (-INF, -2.0, 1.0), 1, -2.75),
        (0.25, (-1.0, 1.0, 1.0), 2, 0.25),
        (0.25, (0.5, 3.0, 1.0), 2, 1.25),
        (0.25, (-3.0, -0.8, 1.0), 2, -1.75),
        (0.25, (0.5, 1.0, 1.0), 0, 0.25),
        (0.25, (0.0, 1.0, 2.5), 1, 0.25),
        (0.25, (-1.0, 1.0, 0.0), 1, 0.25),
        (0.25, (0.5, 1.0, 0.0), 0, 0.25),
        (0.25, (-1.0, 0.0, 0.0), 0, 0.25),
        # within 1e-12 of a limit
        (-0.9e-12, (0.0, 1.0, 0.0), 1, 0.0),
        (-1.1e-12, (0.0, 1.0, 0.0), 0, -1.1e-12),
        (0.9e-12, (-1.0, 0.0, 0.0), 1, 0.0),
        (1.1e-12, (-1.0, 0.0, 0.0), 0, 1.1e-12),
        (-0.9e-12, (0.0, 0.5, 1.0), 1, 0.0),
        (-1.1e-12, (0.0, 0.5, 1.0), 0, -1.1e-12),
        (0.9e-12, (-0.5, 0.0, 1.0), 1, 0.0),
        (1.1e-12, (-0.5, 0.0, 1.0), 0, 1.1e-12),
        # never -0
        (-0.0, (-INF, INF, 1.0), 1, 0.0),
        (-0.0, (-1.0, 1.0, 0.0), 1, 0.0),
    ],
    ids=str,
)
def test_a_coordinate_goes_to_the_place_fewest_periods_away_and_its_places_are_counted(
    x, box, number, place
):
    q = np.array([[9.0, 9.0], [x, 2.5]])
    other = (-INF, 10.0, 3.0)  # places without end are not counted
    for i in (0, 1):
        q[1] = 2.5
        q[1, i] = x
        boxes = np.array([other, other])
        boxes[i] = box
        assert kernel.placed(q, 1, boxes) == number
        assert q[1, i] == place
        assert math.copysign(1.0, q[1, i]) == math.copysign(1.0, place)
    assert q[0].tolist() == [9.0, 9.0]


def test_a_limit_is_within_the_limits(monkeypatch):
    monkeypatch.setattr(kernel, "_EDGE", 0.5)
    for x, place in ((-0.5, 0.0), (1.5, 1.0)):
        q = np.array([[x]])
        assert kernel.placed(q, 0, np.array([[0.0, 1.0, 0.0]])) == 1
        assert q[0, 0] == place


def test_the_numbers_of_places_of_all_coordinates_are_multiplied():
    q = np.array([[0.25, 0.25]])
    box = np.array([[0.0, 2.5, 1.0], [-1.0, 2.5, 1.0]])
    assert kernel.placed(q, 0, box) == 3 * 4
    box[:, kernel.HIGH] = 2.0
    assert kernel.placed(q, 0, box) == 2 * 3


@given(st.lists(st.tuples(st.integers(0, 2), st.integers(0, 2), st.integers(0, 2)), max_size=8))
def test_rows_are_put_in_order_by_the_first_number_that_differs(rows):
    keys = np.array(rows, float).reshape(-1, 3)
    order = np.full(len(keys) + 1, -7)
    for count in range(len(keys)):
        kernel.insert(keys, order, count)
    assert order.tolist() == [*np.lexsort(keys.T[::-1]), -7]


def test_memory_has_room_for_every_branch_and_four_more(monkeypatch):
    given: list[Any] = []
    monkeypatch.setattr(kernel, "list_all", lambda *arguments: given.extend(arguments))
    q = np.zeros((20, 6))
    kernel.listed.function(
        0, np.zeros((10, 2, 7)), np.zeros((10, 4, 4)), ANYWHERE, np.zeros(6), np.zeros(codes.OPTIONS),
        rule(), q, np.zeros((20, kernel.ERRORS)), np.zeros((10, kernel.INFO))
    )  # fmt: skip
    _, _, _, branches, one, *_ = given
    assert [a.shape for a in branches] == [(24, 6), (24, 2), (24,)]
    assert [a.shape for a in one] == [(2, 6), (2, 6), (2, kernel.ERRORS), (2,)]


def rule(**changed: float) -> np.ndarray:
    row = np.zeros(kernel.RULE)
    values = {"CLEAR": 0.25, "ABSENT": 0.5, "MOVED": 0.125, "HOPELESS": 2.0} | changed
    for name, value in values.items():
        row[getattr(kernel, name)] = value
    return row


def test_what_may_be_solutions_is_gathered_with_its_owners_and_the_last_one_again():
    nan = math.nan
    rows = np.array(
        [
            [[1.0, 2.0, 0.5], [3.0, 4.0, nan], [5.0, 6.0, -0.5]],
            [[7.0, 8.0, -0.75], [9.0, 10.0, -0.25], [11.0, 12.0, 1.0]],
        ]
    )
    q, owners = np.zeros((10, 2)), np.full(10, -1)
    assert kernel.gather(rows, rule(), q, owners) == 4
    assert q[:9].tolist() == [[1, 2], [5, 6], [9, 10], *[[11.0, 12.0]] * 5, [0.0, 0.0]]
    assert owners.tolist() == [0, 0, 1, 1, 1, 1, 1, 1, -1, -1]
    q, owners = np.full((10, 2), 7.0), np.zeros(10, int)
    rows[..., 2] = nan
    assert kernel.gather(rows, rule(), q, owners) == 0
    assert (q == 7.0).all()


ANYWHERE = np.tile([-INF, INF, 0.0], (2, 1))


def one_target(found, margins, before=None, errors=None, box=ANYWHERE, **changed):
    """Solutions, their numbers, what a row says, and what is returned, of branches `found`, which
    were at `before`; two rows of another target lie before them.
    """
    found = np.array(found, float)
    most = len(margins)
    rows = np.column_stack([found if before is None else before, margins])
    mine = np.array([row for row, margin in zip(found, margins, strict=True) if margin >= -0.5])
    q = np.concatenate([found[:2], mine.reshape(-1, 2), np.full((4, 2), 9.0)])
    ends = np.zeros((len(q), 2))
    if errors is not None:
        ends[2 : 2 + len(errors)] = errors
    options = np.zeros(codes.OPTIONS)
    options[[codes.TOL_POSITION, codes.TOL_ROTATION]] = 1e-3, 1e-4
    problem = BranchProblem(0, box, rule(**changed), options)
    one = kernel.Listed(
        np.full((most, 2), np.nan),
        np.full((most, 2), np.nan),
        np.full((most, kernel.ERRORS), np.nan),
        np.full(most, -1),
    )
    info = np.full(kernel.INFO, -1.0)
    branches = Branches(q, ends, np.zeros(len(q), int))
    number, within = kernel.list_one(problem, rows, branches, 2, one, info)
    order = one.order[:within]
    assert info[: kernel.IS_CLEAR].tolist() == [number, within]
    return one.q[order], one.numbers[order], bool(info[kernel.IS_CLEAR]), number


THREE = [[0.5, 1.0], [-0.5, 3.0], [0.25, 2.0]]


def test_solutions_of_one_target_are_in_order_with_their_errors():
    q, numbers, clear, number = one_target(
        THREE, [1.0, 0.3, 1.0], errors=[[1e-3, 1e-4], [2e-4, 3e-5], [0, 0]]
    )
    assert (q.tolist(), clear, number) == (sorted(THREE), True, 3)
    assert numbers.tolist() == [[2e-4, 3e-5, 1], [0, 0, 1], [1e-3, 1e-4, 1]]


def test_coordinates_that_differ_by_less_than_a_nanoradian_are_in_the_order_of_the_next():
    two = [[0.5 + 0.3e-9, 1.0], [0.5 - 0.1e-9, 2.0]]
    q, *_ = one_target(two, [1.0, 1.0])
    assert q.tolist() == two
    q, *_ = one_target([[0.5 + 0.6e-9, 1.0], [0.5 - 0.1e-9, 2.0]], [1.0, 1.0])
    assert q[:, 1].tolist() == [2.0, 1.0]


@pytest.mark.parametrize("k", range(3))
@pytest.mark.parametrize(
    ("fault", "clear"),
    [
        ({"margin": 0.25}, False),
        ({"margin": 0.26}, True),
        ({"margin": -0.5}, False),
        ({"errors": [1.1e-3, 0.0]}, False),
        ({"errors": [0.0, 1.1e-4]}, False),
        ({"errors": [math.nan, 0.0]}, False),
        ({"off": 0.125}, True),
        ({"off": -0.126}, False),
    ],
    ids=str,
)
def test_a_target_is_clear_where_each_of_its_branches_is(k, fault, clear):
    margins, errors, before = np.ones(3), np.zeros((3, 2)), np.array(THREE)
    margins[k] = fault.get("margin", 1.0)
    errors[k] = fault.get("errors", 0.0)
    before[k, 1] += fault.get("off", 0.0)
    q, _, said, number = one_target(THREE, margins, before, errors)
    assert said is clear
    assert (len(q), number) == (3 if clear else 0, 3)


def test_two_branches_at_one_place_are_not_clear_and_those_of_other_targets_do_not_count():
    assert one_target(THREE, np.ones(3))[2]
    assert not one_target([*THREE, THREE[1]], np.ones(4))[2]
    turn = [THREE[1][0] + 1.0, THREE[1][1]]
    assert one_target([*THREE, turn], np.ones(4))[2]
    box = np.array([[-INF, INF, 1.0], [-INF, INF, 0.0]])
    assert not one_target([*THREE, turn], np.ones(4), box=box)[2]


def test_of_solutions_those_within_the_limits_are_listed_at_their_places():
    box = np.array([[0.3, 2.6, 1.0], [0.0, 2.5, 0.0]])
    q, numbers, clear, number = one_target(THREE, np.ones(3), box=box)
    assert (q.tolist(), clear, number) == ([[0.5, 1.0], [1.25, 2.0]], True, 3)
    assert numbers[:, kernel.PLACES].tolist() == [3, 2]


@pytest.mark.parametrize(("far", "clear"), [(100.0, True), (101.0, False)])
def test_a_place_of_more_than_a_hundred_radians_away_is_looked_at_there(far, clear):
    box = np.array([[far - 0.25, far + 0.25, 1.0], [-INF, INF, 0.0]])
    q, _, said, _ = one_target([[0.0, 1.0], [0.125, 2.0]], np.ones(2), box=box)
    assert said is clear
    assert len(q) == 2 * clear


@pytest.mark.parametrize(
    ("margins", "clear"),
    [
        ([-2.1, -3.0, math.nan], True),
        ([-2.1, -2.0, math.nan], False),
        ([-2.0, -2.1, -2.1], False),
        ([-2.1, -2.1, -1.9], False),
        ([-2.1, -2.1, 1.0], True),
    ],
)
def test_a_target_without_a_branch_is_clear_where_all_margins_are_hopeless(margins, clear):
    q, _, said, number = one_target(THREE, margins)
    assert said is clear
    assert len(q) == number == (margins[2] == 1.0)
