"""The search for all solutions: turns within limits, parts of a batch, and walks along a continuum."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.engine.kernels import ik_all_kernel as kernel
from poekin.engine.kernels import ik_codes
from poekin.model import screw
from poekin.solve.ik_all import ik_all_search as module
from poekin.solve.ik_all import sources
from poekin.solve.ik_all.ik_all import ik_all
from poekin.solve.ik_all.ik_all_search import Rule
from poekin.solve.ik_all.solution_sets.found import Found, joined, replaced
from poekin.solve.ik_all.solution_sets.places import Box, turns_within
from poekin.solve.ik_all.solution_sets.self_motion import SelfMotion
from poekin.solve.joint_units import bounds, periods
from poekin.solve.ragged import Ragged

TURN = 2 * np.pi
LIMITS = [[-1.5 * np.pi, 4 * np.pi], [-0.5, 1.0]]


def arm(reach: float = 0.75) -> pk.Chain:
    """A joint that turns, and a slide 0.5 m away from it."""
    axes = [screw.revolute([0, 0, 1.0], [0, 0, 0]), screw.prismatic([0, 0, 1.0])]
    return pk.Chain.from_space(axes, pk.se3.exp([0, 0, 0, reach, 0, 0]), limits=LIMITS)


@pytest.mark.parametrize(
    ("q", "first", "last"),
    [
        ([0.1, 0.5], [0, 0], [1, 0]),
        ([0.0, 0.5], [0, 0], [2, 0]),
        ([1e-13, -0.5], [0, 0], [2, 0]),
        ([3e-12, 1.0], [0, 0], [1, 0]),
        ([-1.5 * np.pi, 0.5], [0, 0], [2, 0]),
        ([-1.5 * np.pi - 9e-13, 0.5], [0, 0], [2, 0]),
        ([-1.5 * np.pi - 3e-12, 0.5], [1, 0], [2, 0]),
        ([7 * np.pi, 0.5], [-4, 0], [-2, 0]),
        ([0.1, 1 + 9e-13], [0, 0], [1, 0]),
        ([0.1, -0.5 - 9e-13], [0, 0], [1, 0]),
        ([0.1, 1 + 3e-12], [0, 1], [1, 0]),
        ([0.1, -0.5 - 3e-12], [0, 1], [1, 0]),
    ],
)
def test_so_many_turns_may_be_added_within_the_limits(q, first, last):
    found = turns_within(Box(bounds(arm(), True), periods(arm())), np.array([q]))
    assert [x[0].tolist() for x in found] == [first, last]
    found = turns_within(Box(bounds(arm(), False), periods(arm())), np.array([q]))
    assert [x[0].tolist() for x in found] == [[-np.inf, 0], [np.inf, 0]]


def test_a_pose_is_accepted_within_1e_10_or_a_share_of_a_long_arm_s_reach():
    assert module.accepted(arm()) == 1e-10
    assert module.accepted(arm(1e4)) == pytest.approx(1e-12 * arm(1e4).reach)
    assert periods(arm()).tolist() == [TURN, 0]


def test_the_links_are_so_long_together_and_points_count_as_a_metre():
    z = [0, 0, 1.0]
    axes = [screw.revolute(z, [1.0, 0, 0]), screw.revolute(z, [1.0, 0.5, 0])]
    assert module._size(
        pk.Chain.from_space(axes, pk.se3.exp([0, 0, 0, 1, 0.5, 0.25]))
    ) == pytest.approx(0.75)
    assert module._size(pk.Chain.from_space(axes[:1], pk.se3.exp([0, 0, 0, 1, 0, 0]))) == 1.0


def search_of(chain: pk.Chain, parallel: bool = False) -> module.SearchedArm:
    box = Box(bounds(chain, True), periods(chain))
    return module.SearchedArm(chain.compile(), box, np.ones(chain.dof, bool), parallel)


def rows(*parts: Any) -> Ragged:
    return Ragged(np.concatenate([np.empty((0, 2)), *parts]), np.array([len(p) for p in parts]))


def found_at(*parts: Any) -> Found:
    q = rows(*parts)
    N = len(q)
    none = np.zeros(N, int)
    return Found(q, np.ones(len(q.rows)), none, none, none > 0, none > 0)


NOWHERE = np.empty((0, 2))


@pytest.mark.parametrize("parallel", [False, True])
@pytest.mark.parametrize(("at_once", "sizes"), [(4096, (32, 32, 6)), (35, (32, 3, 32, 3))])
def test_a_long_batch_is_searched_32_targets_at_a_time_each_with_its_own_number(
    parallel, at_once, sizes, monkeypatch
):
    monkeypatch.setattr(module, "_AT_ONCE", at_once)
    asked: list[tuple[Any, ...]] = []

    def call(address: Any, T: np.ndarray, starts: Any, *words: Any) -> None:
        *_, indices, _, q, hits, condition, info = words
        asked.append((len(T), starts[0, 0, 0].item(), indices.tolist()))
        q[:, 0] = indices[:, None]
        hits[:], condition[:], info[:] = 1.0, 1.0, 0.0
        info[:, kernel.FOUND] = 1

    monkeypatch.setattr(kernel, "search", SimpleNamespace(call=call))
    starts = rows(*(np.full((1, 2), float(k)) for k in range(70)))
    T = np.tile(np.eye(4), (70, 1, 1))
    values = np.full((70, 2), np.nan)
    found = module.search(search_of(arm(), parallel), T, values, starts, Rule(3, 4, 5, 6, 9))
    assert sorted(asked, key=lambda one: one[1]) == [
        (n, first, list(map(float, range(first, first + n))))
        for n, first in zip(sizes, np.cumsum([0, *sizes]).tolist(), strict=False)
    ]
    assert len(found) == 70
    assert found.q.rows[:, 0].tolist() == list(range(70))


def test_what_is_not_said_of_a_search_is_its_usual_rule(monkeypatch):
    asked: list[tuple[Any, ...]] = []

    def search(one: Any, T: Any, values: Any, starts: Ragged, rule: Rule) -> Found:
        asked.append((rule, one.box.limits.tolist(), one.parallel, [s.shape for s in starts]))
        return found_at(*[NOWHERE] * len(T))

    monkeypatch.setattr(sources, "search", search)
    ik_all(arm(), np.tile(np.eye(4), (2, 1, 1)), method="search")
    assert asked == [(Rule(14, 2000, 200, 200, 0), LIMITS, False, [(0, 2)] * 2)]
    accepted: tuple[dict[str, Any], ...] = (
        {"min_hits": 1}, {"restarts": 1}, {"iterations": 1}, {"seed": 0}, {"seed": 2**62 - 1}
    )  # fmt: skip
    for least in accepted:
        ik_all(arm(), np.eye(4), method="search", **least)
    refused: tuple[tuple[str, Any], ...] = (
        ("min_hits", 0), ("restarts", 0), ("iterations", 0), ("seed", -1), ("seed", 2**62), ("min_hits", True)
    )  # fmt: skip
    for word, value in refused:
        said = (
            f"^{word}: expected a whole number from {0 if word == 'seed' else 1} on, got {value}$"
        )
        with pytest.raises(pk.PoekinError, match=said):
            ik_all(arm(), np.eye(4), method="search", **dict[str, Any]({word: value}))


STEP = 0.05
TARGET = module.Target(np.eye(4), np.full(2, np.nan))


@pytest.mark.parametrize(
    ("size", "turns", "moves"),
    [(0.99 * STEP / 4, 0, False), (1.01 * STEP / 4, 0, True), (0.99 * 2 * STEP, 0, True), (1.01 * 2 * STEP, 0, False),
     (STEP, 3, True), (STEP, -1, True), (0.0, 1, False)],
)  # fmt: skip
def test_a_walk_that_comes_to_rest_a_step_away_is_along_a_continuum(
    size, turns, moves, monkeypatch
):
    q, asked = np.array([0.3, 0.2]), list[tuple[Any, ...]]()
    J = np.zeros((6, 2))
    J[0, 1] = 2.0  # the first coordinate moves nothing

    def search(one: Any, T: Any, values: Any, starts: Ragged, rule: Rule, first: int = 0) -> Any:
        asked.append((T.shape, starts[0] - q, rule, first))
        end = q + np.array([size + TURN * turns, 0])
        return found_at([end, end + 1]), np.ones(2)

    monkeypatch.setattr(module, "_search", search)
    way = module._way_along(search_of(arm()), TARGET, q, J)
    ((shape, start, rule, first),) = asked
    assert (shape, rule, first) == ((1, 4, 4), Rule(1, 0, 200, 0, 0), 0), (
        "one try, from there alone"
    )
    np.testing.assert_allclose(np.abs(start), [[STEP, 0]], atol=1e-15)
    assert (way is not None) == moves
    if way is not None:
        np.testing.assert_allclose(way, [size, 0], atol=1e-12)


@pytest.mark.parametrize(("ratio", "singular"), [(0.99e-5, True), (1.01e-5, False), (0.0, True)])
def test_a_motion_is_lost_where_its_singular_value_is_1e_5_of_the_largest(
    ratio, singular, monkeypatch
):
    asked: list[Any] = []

    def search(*words: Any) -> Any:
        asked.append(words)
        return found_at(NOWHERE), np.empty(0)

    monkeypatch.setattr(module, "_search", search)
    J = np.zeros((6, 2))
    J[0, 0], J[4, 1] = 2.0, 2.0 * ratio
    assert module._way_along(search_of(arm()), TARGET, np.zeros(2), J) is None
    assert bool(asked) == singular


def test_the_kernel_is_told_starts_ranges_rules_and_the_number_of_each_target(monkeypatch):
    chain = pk.Chain.from_space(arm().screws, arm().home, limits=[[-1.0, 2.0], [-0.5, 1.0]])
    one, asked = search_of(chain), list[tuple[Any, ...]]()

    def call(*words: Any) -> None:
        asked.append(words)
        *_, q, hits, condition, info = words
        q[:], hits[:], condition[:], info[:] = 7.0, 3.0, 0.5, 0.0
        info[:, kernel.FOUND], info[:, kernel.AT_ENDS], info[:, kernel.AT_RESTARTS] = (
            [2, 0, 40],
            5,
            [6, 0, 1],
        )
        info[2, kernel.FULL] = 1.0

    monkeypatch.setattr(kernel, "search", SimpleNamespace(call=call))
    T = np.tile(np.eye(4), (3, 1, 1))
    starts = rows(np.array([[0.1, 0.2]]), NOWHERE, np.array([[0.3, 0.4], [0.5, 0.6]]))
    values = np.array([[np.nan, 0.1], [np.nan, 0.2], [np.nan, 0.3]])
    one = replace(one, free=np.array([True, False]))
    found, condition = module._search(one, T, values, starts, Rule(3, 4, 5, 6, 9), 64)
    (words,) = asked
    (
        address,
        targets,
        begun,
        given,
        limits,
        ranges,
        turn,
        free,
        locked,
        options,
        rules,
        indices,
        seed,
        q,
        hits,
        bounds_of_condition,
        info,
    ) = words
    assert address == one.fast.hybrid_address
    np.testing.assert_array_equal(targets, T)
    assert begun.tolist() == [[[0.1, 0.2], [0, 0]], [[0, 0], [0, 0]], [[0.3, 0.4], [0.5, 0.6]]]
    assert given.tolist() == [1, 0, 2]
    np.testing.assert_array_equal(limits, np.tile([-np.inf, np.inf], (2, 1)))
    assert free.tolist() == [1.0, 0.0]
    np.testing.assert_array_equal(locked, values)
    assert bounds_of_condition.shape == hits.shape
    assert (condition == 0.5).all()
    np.testing.assert_allclose(ranges, [[-np.pi, np.pi], [-0.5, 1.0]])
    np.testing.assert_allclose(turn, [TURN, 0])
    expected = np.zeros(ik_codes.OPTIONS)
    expected[ik_codes.TOL_POSITION], expected[ik_codes.TOL_ROTATION] = 1e-13 * chain.reach, 1e-13
    expected[ik_codes.ITERATIONS], expected[ik_codes.WEIGHTS :] = 5, 1
    np.testing.assert_allclose(options, expected, rtol=1e-12)
    wanted = {kernel.MAX_ERROR: 1e-10, kernel.MIN_HITS: 3, kernel.RESTARTS: 4, kernel.MAX_MISSES: 6}
    assert dict(enumerate(rules.tolist())) == {k: wanted.get(k, 0) for k in range(kernel.RULE)}
    assert (indices.tolist(), indices.dtype, seed) == ([64, 65, 66], np.float64, 9)
    assert (q.shape, hits.shape, info.shape) == ((3, 40, 2), (3, 40), (3, kernel.INFO))
    assert found.q.counts.tolist() == [2, 0, 40]
    assert len(found.hits) == len(condition) == 42
    assert found.ends.tolist() == [5, 5, 5]
    assert found.restarts.tolist() == [6, 0, 1]
    assert found.full.tolist() == [False, False, True]
    assert not found.singular.any()
    assert not found.self_motion
    assert (found.q.rows == 7).all()
    q[:] = 0.0
    assert (found.q.rows == 7).all(), "a copy"
    module._search(one, T, values, rows(NOWHERE, NOWHERE, NOWHERE), Rule(3, 4, 5, 6, 9))
    assert asked[1][2].shape == (3, 0, 2)


def test_found_solutions_are_kept_placed_joined_and_replaced_target_by_target():
    along_a = SelfMotion(("a",), np.ones(2))
    along_b = SelfMotion(("b",), np.ones(2))
    one = replace(
        found_at([[1, 1], [2, 2]], NOWHERE, [[3, 3.0]]),
        hits=np.array([5.0, 4, 3]),
        ends=np.array([9, 8, 7]),
        self_motion={2: along_a},
    )
    assert one.least_hits().tolist() == [4, 0, 3]
    kept = one.kept(np.array([False, True, True]))
    assert (kept.q.counts.tolist(), kept.hits.tolist()) == ([1, 0, 1], [4, 3])
    placed = one.placed(np.array([0, 2, 3]), 5)
    assert placed.q.counts.tolist() == [2, 0, 0, 1, 0]
    assert (placed.ends.tolist(), placed.self_motion) == ([9, 0, 8, 7, 0], {3: along_a})
    both = joined([one, one], 2)
    assert both.q.counts.tolist() == [2, 0, 1] * 2
    assert both.self_motion == {2: along_a, 5: along_a}
    assert len(joined([], 2)) == 0
    new = replace(
        found_at([[8, 8]], [[9, 9], [7, 7.0]]), ends=np.array([1, 2]), self_motion={0: along_b}
    )
    mixed = replaced(one, np.array([1, 2]), new)
    assert mixed.q.rows[:, 0].tolist() == [1, 2, 8, 9, 7]
    assert mixed.q.counts.tolist() == [2, 1, 2]
    assert mixed.hits.tolist() == [5, 4, 1, 1, 1]
    assert (mixed.ends.tolist(), mixed.self_motion) == ([9, 1, 2], {1: along_b})


def test_starts_of_a_locked_arm_have_the_locked_values():
    def starts(x: float, *unsure: bool) -> Any:
        def given(T: np.ndarray) -> Any:
            counts = np.where(T[:, 0, 3] > 1, 0, 2)
            return np.full((counts.sum(), 2), x), counts, np.array(unsure)

        return SimpleNamespace(starts=given)

    axes = [screw.revolute([0, 0, 1], [x, 0, 0]) for x in (0, 1, 2)]
    chain = pk.Chain.from_space(axes, np.eye(4))
    values = np.array([[np.nan, 0.1, np.nan], [np.nan, 0.2, np.nan], [np.nan, 0.1, np.nan]])
    solvers = [starts(5.0, False, True), starts(6.0, False)]
    between = np.array([True, False, True])
    asked = sources.Solvers(solvers, np.array([0, 1, 0]), chain, between)
    T = np.tile(np.eye(4), (3, 1, 1))
    T[2, 0, 3] = 2.0
    found, unsure = sources.starts_of(asked, T, values)
    assert [q.tolist() for q in found] == [[[5, 0.1, 5]] * 2, [[6, 0.2, 6]] * 2, []]
    assert unsure.tolist() == [False, False, True]
