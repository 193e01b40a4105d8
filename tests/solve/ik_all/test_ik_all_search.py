"""The search for all solutions: turns within limits, parts of a batch, and walks along a continuum."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.engine.kernels import ik_all_kernel as kernel
from poekin.engine.kernels import ik_codes
from poekin.model import screw
from poekin.solve.ik_all import ik_all as ik_all_module
from poekin.solve.ik_all import ik_all_search as module
from poekin.solve.ik_all.ik_all import ik_all
from poekin.solve.ik_all.ik_all_search import Found, Rule
from poekin.solve.joint_units import periods

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
    found = module.turns_within(arm(), np.array([q]), True)
    assert [x[0].tolist() for x in found] == [first, last]
    found = module.turns_within(arm(), np.array([q]), False)
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


def test_a_long_batch_is_searched_32_targets_at_a_time_each_with_its_own_number(monkeypatch):
    asked: list[tuple[Any, ...]] = []

    def part(fast: Any, T: np.ndarray, starts: Any, rule: Rule, first: int = 0) -> list[Found]:
        asked.append((len(T), float(starts[0][0, 0]), rule, first))
        return [Found(np.empty((0, 2)), np.empty(0), 0, 1, False)] * len(T)

    monkeypatch.setattr(module, "_search", part)
    rule = Rule(3, 4, 5, 6, 9)
    starts = [np.full((1, 2), float(k)) for k in range(70)]
    found = module.search(arm().compile(), np.tile(np.eye(4), (70, 1, 1)), starts, rule, True)
    assert asked == [(32, 0.0, rule, 0), (32, 32.0, rule, 32), (6, 64.0, rule, 64)]
    assert len(found) == 70


def test_what_is_not_said_of_a_search_is_its_usual_rule(monkeypatch):
    asked: list[tuple[Any, ...]] = []

    def search(fast: Any, T: Any, starts: Any, rule: Rule, limits: bool) -> list[Found]:
        asked.append((rule, limits, [s.shape for s in starts]))
        return [Found(np.empty((0, 2)), np.empty(0), 0, rule.max_misses, False)] * len(T)

    monkeypatch.setattr(ik_all_module, "search", search)
    ik_all(arm(), np.tile(np.eye(4), (2, 1, 1)), method="search")
    assert asked == [(Rule(14, 2000, 200, 200, 0), True, [(0, 2)] * 2)]
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

    def search(fast: Any, T: np.ndarray, starts: Any, rule: Rule, first: int = 0) -> list[Found]:
        asked.append((T.shape, starts[0] - q, rule, first))
        end = q + np.array([size + TURN * turns, 0])
        return [Found(np.array([end, end + 1]), np.ones(2), 1, 0, False)]

    monkeypatch.setattr(module, "_search", search)
    way = module._way_along(arm().compile(), np.eye(4), q, J)
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

    def search(*words: Any) -> list[Found]:
        asked.append(words)
        return [Found(np.empty((0, 2)), np.empty(0), 0, 0, False)]

    monkeypatch.setattr(module, "_search", search)
    J = np.zeros((6, 2))
    J[0, 0], J[4, 1] = 2.0, 2.0 * ratio
    assert module._way_along(arm().compile(), np.eye(4), np.zeros(2), J) is None
    assert bool(asked) == singular


def test_the_kernel_is_told_starts_ranges_rules_and_the_number_of_each_target(monkeypatch):
    chain = pk.Chain.from_space(arm().screws, arm().home, limits=[[-1.0, 2.0], [-0.5, 1.0]])
    fast, asked = chain.compile(), list[tuple[Any, ...]]()

    def call(*words: Any) -> None:
        asked.append(words)
        *_, q, hits, info = words
        q[:], hits[:], info[:] = 7.0, 3.0, 0.0
        info[:, kernel.FOUND], info[:, kernel.AT_ENDS], info[:, kernel.AT_RESTARTS] = (
            [2, 0, 40],
            5,
            [6, 0, 1],
        )
        info[2, kernel.FULL] = 1.0

    monkeypatch.setattr(kernel, "search", SimpleNamespace(call=call))
    T = np.tile(np.eye(4), (3, 1, 1))
    starts = [np.array([[0.1, 0.2]]), np.empty((0, 2)), np.array([[0.3, 0.4], [0.5, 0.6]])]
    found = module._search(fast, T, starts, Rule(3, 4, 5, 6, 9), 64)
    (words,) = asked
    (
        address,
        targets,
        rows,
        given,
        free,
        ranges,
        turn,
        options,
        rules,
        indices,
        seed,
        q,
        hits,
        info,
    ) = words
    assert address == fast.hybrid_address
    np.testing.assert_array_equal(targets, T)
    assert rows.tolist() == [[[0.1, 0.2], [0, 0]], [[0, 0], [0, 0]], [[0.3, 0.4], [0.5, 0.6]]]
    assert given.tolist() == [1, 0, 2]
    np.testing.assert_array_equal(free, np.tile([-np.inf, np.inf], (2, 1)))
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
    assert [len(f.solutions) for f in found] == [len(f.hits) for f in found] == [2, 0, 40]
    assert [(f.ends, f.restarts, f.full, f.singular, f.self_motion_coordinates) for f in found] == [
        (5, 6, False, False, ()), (5, 0, False, False, ()), (5, 1, True, False, ())
    ]  # fmt: skip
    assert (found[0].solutions == 7).all()
    q[:] = 0.0
    assert (found[0].solutions == 7).all(), "a copy"
    module._search(fast, T[:3], [np.empty((0, 2))] * 3, Rule(3, 4, 5, 6, 9))
    assert asked[1][2].shape == (3, 0, 2)


def test_where_a_closed_form_gives_up_there_is_no_start():
    def starts(T: np.ndarray) -> np.ndarray:
        if T[0, 3] > 1:
            raise RuntimeError
        return np.full((2, 6), T[0, 3])

    T = np.tile(np.eye(4), (3, 1, 1))
    T[:, 0, 3] = [0.5, 2.0, 0.25]
    solver: Any = SimpleNamespace(starts=starts)
    found, given_up = ik_all_module._starts(solver, T)
    assert [len(q) for q in found] == [2, 0, 2]
    assert found[1].shape == (0, 6)
    assert given_up == {1}
