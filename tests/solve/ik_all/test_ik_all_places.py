"""Where solutions lie within the limits, how many places each stands for, and in which order they
are listed.
"""

from __future__ import annotations

import itertools

import numpy as np
import pytest

import poekin as pk
from poekin.model import screw
from poekin.solve.ik_all.ik_all import ik_all
from poekin.solve.ik_all.solution_sets import places as module
from poekin.solve.ik_all.solution_sets.places import Box, Places
from poekin.solve.joint_units import bounds, periods
from poekin.solve.ragged import Ragged

TURN = 2 * np.pi
AXES = [screw.revolute([0, 0, 1.0], [0, 0, 0]), screw.prismatic([0, 0, 1.0])]


def arm(turn: list[float] | None = None) -> pk.Chain:
    """A joint that turns, within limits or without, and a slide from -0.5 to 1."""
    limits = [[-np.inf, np.inf] if turn is None else turn, [-0.5, 1.0]]
    return pk.Chain.from_space(AXES, pk.se3.exp([0, 0, 0, 0.75, 0, 0]), limits=limits)


def found(*parts: list[list[float]]) -> Ragged:
    rows = [row for part in parts for row in part]
    return Ragged(np.array(rows, float).reshape(-1, 2), np.array([len(part) for part in parts]))


def places_of(
    chain: pk.Chain, every: Ragged, limits: bool = True, all_revolutions: bool = False
) -> Places:
    box = Box(bounds(chain, limits), periods(chain))
    return module.make_places(chain, every, box, False, all_revolutions)


EVERY = found([[0.1, 0.5], [0.2, 1.5]], [], [[-3.0, 0.25], [3.0, -0.5]])


@pytest.mark.parametrize(
    ("turn", "q", "owner", "number", "within"),
    [
        (None, [[0.1, 0.5], [-3, 0.25], [3, -0.5]], [0, 2, 2], [1, 1, 1], [1, 0, 2]),
        ([-1.0, 1.0], [[0.1, 0.5]], [0], [1], [1, 0, 0]),
        ([-TURN, TURN], [[0.1, 0.5], [-3, 0.25], [3, -0.5]], [0, 2, 2], [2, 2, 2], [1, 0, 2]),
        (
            [TURN, 3 * TURN],
            [[0.1 + TURN, 0.5], [2 * TURN - 3, 0.25], [TURN + 3, -0.5]],
            [0, 2, 2],
            [2, 2, 2],
            [1, 0, 2],
        ),
        (
            [-np.inf, 0.0],
            [[0.1 - TURN, 0.5], [-3, 0.25], [3 - TURN, -0.5]],
            [0, 2, 2],
            [1, 1, 1],
            [1, 0, 2],
        ),
    ],
)
def test_of_places_whole_turns_apart_the_one_nearest_to_0_is_listed_with_their_number(
    turn, q, owner, number, within
):
    places = places_of(arm(turn), EVERY)
    np.testing.assert_allclose(places.q, q, atol=1e-14)
    assert (places.owner.tolist(), places.number.tolist(), places.within.tolist()) == (
        owner,
        number,
        within,
    )
    free = places_of(arm(turn), EVERY, False)
    assert free.q[:, 0].tolist() == [0.1, 0.2, -3, 3]
    assert (free.number.tolist(), free.within.tolist()) == ([1] * 4, [2, 0, 2])


def test_copies_are_all_places_within_the_limits_the_fewest_turns_first():
    places = places_of(arm([-TURN, 2 * TURN]), EVERY, True, True)
    expected = [[0.1 + k * TURN, 0.5] for k in (0, -1, 1)] + [
        [-3 + k * TURN, 0.25] for k in (0, 1, 2)
    ]
    expected += [[3 + k * TURN, -0.5] for k in (0, -1, 1)]
    np.testing.assert_allclose(places.q, expected, atol=1e-13)
    assert (places.owner.tolist(), places.number.tolist()) == ([0] * 3 + [2] * 6, [1] * 9)
    assert places.within.tolist() == [1, 0, 2], "solutions, not places"
    none = places_of(arm(), found([]), True, True)
    assert (none.q.shape, none.number.tolist(), none.within.tolist()) == ((0, 2), [], [0])
    assert not np.signbit(places_of(arm(), found([[-0.0, -0.0]])).q).any()


@pytest.mark.parametrize(
    ("q", "owner", "order"),
    [
        ([[3e-9, 0, 0], [0, 1, 0]], [0, 0], [1, 0]),
        ([[3e-10, 0, 0], [0, 1, 0]], [0, 0], [0, 1]),
        ([[3e-10, 1, 0], [0, 0, 5]], [0, 0], [1, 0]),
        ([[0, 0, 2], [0, 0, 1], [0, -1, 9]], [0, 0, 0], [2, 1, 0]),
        ([[9, 9, 9], [0, 0, 0]], [0, 1], [0, 1]),
        ([[2, 0, 0], [1, 0, 0], [9, 9, 9], [0, 0, 0]], [0, 0, 2, 2], [1, 0, 3, 2]),
        ([[k % 7, 0, -k] for k in range(9)], [0] * 8 + [40], [7, 0, 1, 2, 3, 4, 5, 6, 8]),
        (np.empty((0, 3)), np.empty(0, int), []),
    ],
)
def test_solutions_are_sorted_target_by_target_and_to_nine_digits(q, owner, order):
    assert module._order(np.array(q, float), np.array(owner)).tolist() == order


@pytest.mark.parametrize("few", [0, 10**6])
def test_the_order_is_that_of_tuples_however_it_is_found(few, monkeypatch):
    monkeypatch.setattr(module, "_FEW", few)
    rng = np.random.default_rng(few)
    owner = np.sort(rng.integers(0, 30, 150))
    q = rng.integers(0, 3, (150, 3)) + 1e-12 * rng.normal(size=(150, 3))
    keys = [
        (int(o), *np.round(row).tolist(), k)
        for k, (o, row) in enumerate(zip(owner, q, strict=True))
    ]
    assert module._order(q, owner).tolist() == [key[-1] for key in sorted(keys)]


def test_turns_between_are_all_of_them_row_after_row_the_fewest_first():
    first, last = (
        np.array([[-1.0, 0, 2], [0, 0, 0], [-2, 5, -1]]),
        np.array([[1.0, 0, 3], [0, 0, 0], [2, 5, 1]]),
    )
    row, turns = module.turns_between(first, last)
    for k in range(3):
        ranges = [np.arange(a, b + 1) for a, b in zip(first[k], last[k], strict=True)]
        expected = sorted(itertools.product(*ranges), key=np.linalg.norm)
        assert turns[row == k].tolist() == [list(some) for some in expected]
    assert (np.diff(row) >= 0).all()
    row, turns = module.turns_between(np.empty((0, 3)), np.empty((0, 3)))
    assert (row.shape, turns.shape) == ((0,), (0, 3))


def test_what_is_known_of_a_bad_target_is_nothing():
    T = np.tile(arm([-1, 1]).fk([0.1, 0.2]), (3, 1, 1))
    T[1] = np.inf
    result = ik_all(arm([-1, 1]), T, method="search")
    assert result.counts.tolist() == result.anywhere.tolist() == [1, 0, 1]
    assert result.continuum.tolist() == [False] * 3
    assert result.solutions[1].shape == (0, 2)
    assert (result.n_revolutions[1].shape, result.n_revolutions[1].dtype) == ((0,), np.int64)
    assert np.isnan([result.p_missing[1], result.position_error[1], result.rotation_error[1]]).all()
    assert np.isfinite(
        [result.p_missing[[0, 2]], result.position_error[[0, 2]], result.rotation_error[[0, 2]]]
    ).all()
    assert result.explanation[1] == "0 solutions: bad target, it is not made of finite numbers"
    alone = ik_all(arm([-1, 1]), T[0], method="search")
    np.testing.assert_allclose(alone.solutions, [[0.1, 0.2]], atol=1e-9)
    assert (alone.n_revolutions.tolist(), alone.method) == ([1], "search")
