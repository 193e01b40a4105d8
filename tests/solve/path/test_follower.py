"""How a path is put together: steps, pieces of a step, other solutions, and what is done where
there is none.
"""

from __future__ import annotations

import inspect
import itertools
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.model import screw
from poekin.model.readings.coupled import WITHIN
from poekin.solve import motion
from poekin.solve.ik import ik as ik_module
from poekin.solve.ik.choice.every_solution import EverySolution
from poekin.solve.ik.ik_problem import Settings, make_problem
from poekin.solve.path import follow as follow_module
from poekin.solve.path import follower

SETTINGS = Settings("position", None, True, 1e-9, 1e-9, None, None, 100, 30, 0, False)
HOME = np.eye(4)
HOME[0, 3] = 2
ARM = pk.Chain.from_space(
    [*(screw.revolute([0, 0, 1], [x, 0, 0]) for x in (0, 1)), screw.prismatic([0, 0, 1])], HOME,
    limits=[[-3, 3], [-3, 3], [-1, 1]],
).compile()  # fmt: skip
Q = np.array([0.4, 0.9, 0.1])
COUPLED = (
    ARM.chain.replace(q_names=[*"abc"], joint_names=[*"abc"], limits=[[-3, 3], [-3, 1.2], [-1, 1]])
    .coupled("b = a + b")
    .replace(limits=[[-3, 3], [-1, 1], [-1, 1]])
)


def one(count: int = 1, most: float = 0.1, progress: Any = None) -> follower.Follower:
    """What follows a path that goes from Q along x, before it does."""
    T = np.tile(ARM.fk(Q), (count, 1, 1))
    T[:, 0, 3] += 0.01 * np.arange(count)
    return follower.Follower(make_problem(ARM, SETTINGS), T, np.full(3, most), progress)


def test_a_path_is_asked_for_as_a_single_pose_is(monkeypatch):
    asked: list[Settings] = []

    def noted(fast: Any, settings: Settings) -> Any:
        asked.append(settings)
        return make_problem(fast, settings)

    for module in (follow_module, ik_module):
        monkeypatch.setattr(module, "make_problem", noted)
    arm = pk.load("ur5").chain()
    T = arm.fk(arm.random(0, 2))
    follow_module.follow(arm, T[:1])
    ik_module.ik(arm, T)
    assert asked[0] == asked[1]
    assert asked[0] == Settings("pose", None, True, 1e-9, 1e-9, None, None, 100, 30, 0, False)
    assert inspect.signature(follow_module.follow).parameters["max_step"].default == 0.1


def test_a_step_is_divided_into_8_64_and_512_pieces_of_the_screw_motion():
    f, T_b = one(), ARM.fk(Q + 0.5)
    asked: list[np.ndarray] = []
    enough = 10_000

    def descend(
        targets: np.ndarray, start: np.ndarray, q: np.ndarray, anywhere: bool = False
    ) -> int:
        asked.append(targets)
        assert start is Q
        assert not anywhere
        q[:] = np.arange(len(q))[:, None]
        return len(q) if len(q) >= enough else len(q) - 1

    f._descend = descend  # type: ignore[method-assign]
    assert f._in_pieces(Q, f.targets[0], T_b) is None
    assert [len(T) for T in asked] == [8, 64, 512]
    for T in asked:
        way = motion.screw(f.targets[0], T_b, np.arange(1, len(T) + 1) / len(T))
        np.testing.assert_array_equal(T, way)
    enough = 64
    assert f._in_pieces(Q, f.targets[0], T_b).tolist() == [63, 63, 63]  # type: ignore[union-attr]
    assert len(asked) == 5


def test_an_arm_with_few_coordinates_goes_beside_all_pieces_but_the_last(monkeypatch):
    f, T_b = one(), ARM.fk(Q + 0.5)
    monkeypatch.setattr(f.problem, "underactuated", True)
    beside: list[np.ndarray] = []
    asked: list[tuple[int, float]] = []

    def towards(target: np.ndarray, q: np.ndarray) -> np.ndarray:
        beside.append(target)
        return q + 1.0

    def descend(targets: np.ndarray, start: np.ndarray, q: np.ndarray) -> int:
        np.testing.assert_array_equal(targets, T_b[None])
        asked.append((len(beside), float(start[0] - Q[0])))
        q[:] = 7.0
        return len(beside) > 70

    f._towards, f._descend = towards, descend  # type: ignore[method-assign]
    found = f._in_pieces(Q, f.targets[0], T_b)
    assert found is not None
    assert found.tolist() == [7, 7, 7]
    # 7 of 8 pieces, then 63 of 64, then 511 of 512: each time from the start on
    assert asked == [(7, 7.0), (70, 63.0), (581, 511.0)]
    way = motion.screw(f.targets[0], T_b, np.arange(1, 8) / 8)
    np.testing.assert_array_equal(beside[:7], way)


def test_the_first_piece_is_no_longer_than_another():
    f = one(most=0.05)
    assert f._in_pieces(Q + np.array([0.2, -0.1, 0]), f.targets[0], f.targets[0]) is None
    found = f._in_pieces(Q + np.array([0.04, -0.02, 0]), f.targets[0], f.targets[0])
    assert found is not None
    assert np.abs(found - Q).max() < 0.1


def test_the_first_pose_may_be_at_any_distance_and_the_next_may_not():
    f = one(3)
    q = np.empty((3, 3))
    assert f._descend(f.targets, Q - 0.5, q, anywhere=True) == 3
    assert f._descend(f.targets, Q - 0.5, q) == 0
    f.targets[1, 0, 3] -= 0.5
    assert f._descend(f.targets, Q - 0.5, q, anywhere=True) == 1


def test_in_the_values_of_its_joints_a_path_goes_on_until_a_reading_leaves_its_limits():
    x = np.linspace([0.4, 0.9, 0.1], [-0.6, 0.9, 0.1], 41)
    T = ARM.fk(x)
    readings = np.linalg.solve(COUPLED.coupling, x.T).T
    problem = make_problem(COUPLED.compile(), SETTINGS)
    assert problem.by_joints is not None
    within = int((readings[:, 1] <= 1.0).sum())
    assert 5 < within < 40
    q = np.empty((40, 3))
    f = follower.Follower(problem, T, np.full(3, 0.1), None)
    assert f._slide(problem.by_joints, T[1:], readings[0], q) == within - 1
    np.testing.assert_allclose(q[: within - 1], readings[1:within], rtol=0, atol=1e-8)
    # A step of 0.025 rad of joint a may go with one of b: half of what a reading may is left to each.
    f.most[:] = 0.04
    assert f._slide(problem.by_joints, T[1:], readings[0], q) == 0
    assert make_problem(COUPLED.compile(), SETTINGS._replace(limits=False)).by_joints is None
    assert one().problem.by_joints is None


@pytest.mark.parametrize(("k", "limit"), [(0, 3.0), (1, 1.0), (2, -1.0)])
def test_a_reading_that_rounding_takes_beyond_its_limit_is_at_it(k, limit):
    problem = make_problem(COUPLED.compile(), SETTINGS)
    assert problem.by_joints is not None
    f = follower.Follower(problem, np.zeros((1, 4, 4)), np.full(3, 0.1), None)
    reading = np.zeros(3)

    def kernel(*given: Any) -> int:
        given[-1][:] = COUPLED.coupling @ reading
        return 1

    f._kernel = kernel  # type: ignore[method-assign]
    q = np.empty((1, 3))
    for share, done in ((-1.0, 1), (0.9, 1), (1.1, 0)):
        # rounding grows with the size of a reading, and is not less than that of 1
        reading[k] = limit + share * np.copysign(WITHIN, limit) * (1 + abs(limit))
        assert f._slide(problem.by_joints, f.targets, np.zeros(3), q) == done
        assert q[0, k] == (limit if share > 0 else pytest.approx(reading[k], rel=1e-15))


def test_a_path_goes_on_within_readings_limits_and_joints_by_turns_until_neither_leads_on():
    f = follower.Follower(make_problem(COUPLED.compile(), SETTINGS), np.zeros((9, 4, 4)), Q, None)
    ends = {"steps": {0: 2, 5: 1, 8: 0}, "slide": {2: 3, 6: 2, 8: 0}}
    calls: list[tuple[str, int, list[float]]] = []

    def way(name: str) -> Any:
        def follow(*arrays: Any) -> int:
            targets, start, q = arrays[1:] if name == "slide" else arrays[:3]
            k = 9 - len(targets)
            calls.append((name, k, start.tolist()))
            count = ends[name][k]
            q[:count] = np.arange(k, k + count)[:, None]
            return count

        return follow

    f._steps, f._slide = way("steps"), way("slide")  # type: ignore[method-assign]
    q = np.empty((9, 3))
    assert f._descend(f.targets, Q, q) == 8
    assert calls == [
        ("steps", 0, Q.tolist()), ("slide", 2, [1.0] * 3), ("steps", 5, [4.0] * 3), ("slide", 6, [5.0] * 3),
        ("steps", 8, [7.0] * 3), ("slide", 8, [7.0] * 3),
    ]  # fmt: skip
    assert q[:8, 0].tolist() == list(range(8))


def test_a_path_goes_on_by_steps_then_by_pieces_from_where_the_steps_end():
    f = one(9)
    calls: list[tuple[Any, ...]] = []
    ends = {(0, True): 3, (4, False): 2, (7, False): 0}

    def descend(
        targets: np.ndarray, start: np.ndarray, q: np.ndarray, anywhere: bool = False
    ) -> int:
        k = 9 - len(targets)
        calls.append((k, start.tolist(), anywhere))
        count = ends[k, anywhere]
        q[:count] = np.arange(k, k + count)[:, None]
        return count

    def in_pieces(q_a: np.ndarray, T_a: np.ndarray, T_b: np.ndarray) -> np.ndarray | None:
        k = next(k for k, T in enumerate(f.targets) if T is T_b or np.array_equal(T, T_b))
        calls.append(("pieces", k, q_a.tolist()))
        assert np.array_equal(T_a, f.targets[k - 1])
        return None if k == 7 else np.full(3, 100.0 + k)

    f._descend, f._in_pieces = descend, in_pieces  # type: ignore[method-assign]
    end, q = f.on(0, Q, first=True)
    assert calls == [
        (0, Q.tolist(), True), ("pieces", 3, [2.0] * 3), (4, [103.0] * 3, False), ("pieces", 6, [5.0] * 3),
        (7, [106.0] * 3, False), ("pieces", 7, [106.0] * 3),
    ]  # fmt: skip
    assert end == 7
    assert q[:, 0].tolist() == [0, 1, 2, 103, 4, 5, 106]
    ends[0, True] = 0
    end, q = f.on(0, Q, first=True)
    assert (end, len(q)) == (0, 0)
    ends[4, False] = 5
    end, q = f.on(4, Q, first=False)
    assert (end, q[:, 0].tolist()) == (9, [4, 5, 6, 7, 8])


def test_a_path_is_put_together_of_what_can_be_followed_changes_and_what_is_nearest():
    told: list[tuple[int, int]] = []
    f = one(8, progress=lambda done, count: told.append((done, count)))
    calls: list[tuple[Any, ...]] = []

    def rows(k: int, end: int, by: float) -> tuple[int, np.ndarray]:
        return end, by + np.tile(np.arange(k, end, dtype=float)[:, None], (1, 3))

    def on(k: int, last: np.ndarray, first: bool) -> tuple[int, np.ndarray]:
        calls.append(("on", k, float(last[0]), first))
        return rows(k, {0: 2, 2: 2, 4: 4, 5: 5, 6: 8}[k], 0)

    def best(k: int, last: np.ndarray | None) -> tuple[int, np.ndarray]:
        calls.append(("best", k, None if last is None else float(last[0])))
        return rows(k, {0: 2, 2: 4, 4: 4, 5: 6}[k], 10)

    def near(k: int, last: np.ndarray | None) -> np.ndarray:
        calls.append(("near", k, None if last is None else float(last[0])))
        return np.full((1, 3), 50.0)

    f.on, f.best, f._near = on, best, near  # type: ignore[method-assign]
    q, changes = f.run(Q)
    assert calls == [
        ("on", 0, 0.4, True), ("on", 2, 1.0, False), ("best", 2, 1.0), ("on", 4, 13.0, False), ("best", 4, 13.0),
        ("near", 4, 13.0), ("on", 5, 50.0, False), ("best", 5, 50.0), ("on", 6, 15.0, False),
    ]  # fmt: skip
    assert q[:, 0].tolist() == [0, 1, 12, 13, 50, 15, 6, 7]
    assert changes == [2, 5]
    assert told == [(0, 8), (2, 8), (4, 8), (5, 8), (6, 8), (8, 8)]
    calls.clear()
    q, changes = f.run(None)
    assert calls[:2] == [("best", 0, None), ("on", 2, 11.0, False)]
    assert changes == [2, 5], "where it begins is no change"


class Choice:
    """A follower whose solutions of a pose, and how far each of them gets, are known."""

    def __init__(
        self, ends: dict[float, tuple[int, float]], rounds: list[list[float]], solved: set[int]
    ):
        self.f, self.turns, self.tried = one(5), list[int](), list[float]()

        def solutions(k: int, turn: int, last: Any) -> np.ndarray:
            self.turns.append(turn)
            return np.tile(np.array(rounds[turn])[:, None], (1, 3))

        def extend(way: Any, stop: int) -> None:
            assert way.done == 0
            assert stop >= 5
            self.tried.append(float(way.rows[0, 0]))
            end, step = ends[float(way.rows[0, 0])]
            way.done = end - way.first
            way.rows[1 : way.done + 1] = way.rows[0] + step * np.arange(way.done)[:, None]
            way.stuck = end < 5

        self.f._solutions, self.f._extend = solutions, extend  # type: ignore[method-assign]
        self.f._solved = lambda k: k in solved  # type: ignore[method-assign]


def test_the_start_that_gets_farthest_and_then_has_the_smallest_largest_step_is_chosen():
    ends = {1.0: (3, 0.01), 2.0: (5, 0.3), 3.0: (5, 0.1), 4.0: (5, 0.2)}
    c = Choice(ends, [[1.0, 2.0, 3.0, 4.0]], {3, 4})
    end, q = c.f.best(0, None)
    assert (end, q[0].tolist(), len(q)) == (5, [3.0] * 3, 5)
    assert c.turns == [0]
    # after a pose it is the one that jumps least
    c = Choice(ends, [[1.0, 2.0, 3.0, 4.0]], {3, 4})
    end, q = c.f.best(0, np.full(3, 4.4))
    assert (end, q[0].tolist()) == (5, [4.0] * 3)
    c = Choice({1.0: (5, 0.5), 2.0: (5, 0.25)}, [[1.0, 2.0]], set())
    assert c.f.best(0, None)[1][0, 0] == 2.0


@pytest.mark.parametrize("after", [False, True], ids=["first", "after a pose"])
@pytest.mark.parametrize("seed", range(20))
def test_the_start_that_is_chosen_is_that_of_all_of_them_followed_to_the_end(seed, after):
    count = 300
    rng = np.random.default_rng(seed)
    f = one(count)
    # each way moves now and then, some of them alike, where what is followed at a time may end
    steps = np.zeros((8, count, 3))
    for way in steps:
        way[rng.choice([1, 63, 64, 65, 127, 128, 129, 299], 3), 1] = rng.integers(1, 5, 3)
    ways = 0.5 + np.arange(8.0)[:, None, None] + np.cumsum(steps, axis=1)
    ends = rng.choice([count, *rng.integers(1, count, 2)], 8)
    last = np.full(3, 3.6) if after else None

    def extend(way: Any, stop: int) -> None:
        i = int(way.rows[0, 0])
        assert not way.stuck
        np.testing.assert_array_equal(way.q, ways[i, : way.done])
        way.done = min(stop, ends[i])
        way.rows[1 : way.done + 1] = ways[i, : way.done]
        way.stuck = way.done < min(stop, count)

    starts = np.tile(np.arange(8.0)[:, None], (1, 3))
    f._solutions = lambda *_: starts  # type: ignore[method-assign]
    f._extend, f._solved = extend, lambda k: False  # type: ignore[method-assign]
    end, q = f.best(0, last)
    if last is None:
        jumps = [np.abs(np.diff(ways[i, : ends[i]], axis=0)).max(initial=0) for i in range(8)]
    else:
        jumps = np.linalg.norm(starts - last, axis=1)
    best = max(range(8), key=lambda i: (ends[i], -jumps[i]))
    assert end == ends[best]
    np.testing.assert_array_equal(q, ways[best, :end])


def test_a_start_that_jumps_more_than_another_does_to_the_end_is_followed_no_farther():
    f = one(200)
    done_of: dict[float, int] = {}

    def extend(way: Any, stop: int) -> None:
        start = float(way.rows[0, 0])
        way.done = min(stop, 200)
        way.rows[1 : way.done + 1] = start * np.arange(way.done)[:, None]
        done_of[start] = way.done

    starts = np.tile([[0.3], [0.1], [0.2]], (1, 3))
    f._solutions = lambda *_: starts  # type: ignore[method-assign]
    f._extend = extend  # type: ignore[method-assign]
    end, q = f.best(0, None)
    assert (end, q[1, 0]) == (200, 0.1)
    assert follower.AT_ONCE == 64
    assert done_of == {0.3: 64, 0.1: 200, 0.2: 64}
    done_of.clear()
    # after a pose the nearest goes first, and no other where it gets to the end
    assert f.best(0, np.full(3, 0.19))[1][1, 0] == 0.2
    assert done_of == {0.2: 200}


def test_a_way_that_is_followed_in_parts_is_the_way_that_is_followed_at_once():
    arm = pk.load("ur5").chain().compile()
    q = motion.joint([0.0, -1.2, 1.6, -1.9, -1.5, 0.0], [3.0, -0.2, 0.6, -2.9, -0.5, 0.5],
                     np.linspace(0, 1, 40))  # fmt: skip
    problem = make_problem(arm, SETTINGS._replace(task="pose"))
    f = follower.Follower(problem, arm.fk(q), np.full(6, 0.05), None)  # every step is in pieces
    at_once, in_parts = f._way(0, q[0]), f._way(0, q[0])
    f._extend(at_once, 40)
    np.testing.assert_allclose(at_once.q, q, rtol=0, atol=1e-6)
    for stop in range(3, 43, 3):
        f._extend(in_parts, stop)
    np.testing.assert_array_equal(in_parts.q, at_once.q)
    assert not at_once.stuck
    assert not in_parts.stuck


def test_starts_are_looked_for_in_four_rounds_until_one_gets_to_the_end_and_none_is_tried_twice():
    rounds = [[1.0, 1.0 + 5e-7, 2.0], [2.0, 3.0 - 2e-6], [3.0, 1.5], [2.5]]
    ends = {x: (4, 0.1) for row in rounds for x in row}
    c = Choice(ends, rounds, {0, 4})
    assert c.f.best(0, None)[0] == 4
    assert c.turns == [0, 1, 2, 3]
    assert c.tried == [1.0, 2.0, 3.0 - 2e-6, 3.0, 1.5, 2.5]
    ends[3.0] = (5, 0.9)
    c = Choice(ends, rounds, {0, 4})
    assert c.f.best(0, None)[0] == 5
    assert c.turns == [0, 1, 2]
    # the pose that all of them end before cannot be reached
    c = Choice(dict.fromkeys(ends, (4, 0.1)), rounds, {0})
    assert c.f.best(0, None)[0] == 4
    assert c.turns == [0]


def test_where_no_start_gets_anywhere_there_is_none():
    c = Choice({1.0: (2, 0.0)}, [[1.0]] * 4, {2})
    end, q = c.f.best(2, None)
    assert (end, len(q)) == (2, 0)
    # what is known to have no solution is not tried
    for known, turns in (((2, None), []), ((1, None), []), ((3, None), [0]), (None, [0])):
        c = Choice({1.0: (3, 0.0)}, [[1.0]], set())
        c.f._known = known  # type: ignore[assignment]
        c.f.best(2, None)
        assert c.turns == turns
    c = Choice({1.0: (5, 0.0)}, [[1.0]], {2})
    c.f._known = (1, None)  # type: ignore[assignment]
    assert c.f.best(2, None)[0] == 5


def test_eight_tries_a_round_each_with_numbers_of_its_own(monkeypatch):
    f = one()
    asked: list[tuple[Any, ...]] = []
    solve = f.problem.solve

    def noted(T: np.ndarray, number: np.ndarray, q0: np.ndarray, **options: Any) -> Any:
        asked.append((len(T), number.tolist(), bool(np.isnan(q0).all()), options))
        return solve(T, number, q0, **options)

    monkeypatch.setattr(f.problem, "solve", noted)
    for turn in (0, 3):
        f._solutions(0, turn, None)
    assert asked == [
        (8, [8 * turn + k for k in range(8)], True, {"restarts": 10}) for turn in (0.0, 3.0)
    ]


def test_thirty_steps_are_tried_towards_what_is_out_of_reach(monkeypatch):
    f = one()
    asked: list[np.ndarray] = []

    def slope(
        problem: Any, target: np.ndarray, q: np.ndarray
    ) -> tuple[float, np.ndarray, np.ndarray]:
        asked.append(q)
        return 1.0, np.eye(3), np.full(3, 0.01)

    monkeypatch.setattr(follower, "slope_at", slope)
    assert f._near(0, Q)[0].tolist() == Q.tolist()
    assert len(asked) == 31
    steps = [float(np.abs(q - Q).max()) for q in asked[1:]]
    # (1 + damping) step = slope: the damping begins at 1e-3, and is five times as large after a
    # step that is no better
    assert steps == pytest.approx([0.01 / (1 + 1e-3 * 5**k) for k in range(30)], rel=1e-9)
    asked.clear()
    sizes = iter([1.0, 0.5, 0.2, 0.2 - 1e-10, 0.1])

    def better(
        problem: Any, target: np.ndarray, q: np.ndarray
    ) -> tuple[float, np.ndarray, np.ndarray]:
        asked.append(q)
        return next(sizes), np.eye(3), np.full(3, 0.01)

    monkeypatch.setattr(follower, "slope_at", better)
    f._near(0, Q)
    ways = [float((b - a)[0]) for a, b in itertools.pairwise(asked)]
    assert ways == pytest.approx([0.01 / (1 + 1e-3 * 0.2**k) for k in range(3)], rel=1e-9), (
        "the last gains too little"
    )


def test_of_a_matrix_without_inverse_the_damping_is_a_share_of_its_largest_number(monkeypatch):
    f = one(most=1e3)
    asked: list[np.ndarray] = []

    def slope(
        problem: Any, target: np.ndarray, q: np.ndarray
    ) -> tuple[float, np.ndarray, np.ndarray]:
        asked.append(q)
        return 1.0 / len(asked), np.diag([1e14, 0, 0]), np.array([0, 7.0, 0])

    monkeypatch.setattr(follower, "slope_at", slope)
    f._near(0, Q)
    assert (asked[1] - asked[0])[1] == pytest.approx(
        0.7, rel=1e-9
    )  # 1e-13 of 1e14 is more than 1e-3


@pytest.mark.parametrize("last", [None, [29.0, 0.5, 0.0]])
def test_other_solutions_of_a_pose_lie_turns_away_towards_the_last_joints_or_the_middle_of_the_limits(
    last,
):
    wide = pk.Chain.from_space(
        ARM.chain.screws, HOME, limits=[[10, 40], [-40, 30], [-1, 1]]
    ).compile()
    f = follower.Follower(make_problem(wide, SETTINGS), ARM.fk(Q)[None], np.full(3, 0.1), None)
    near = np.array([25.0, -5.0, 0.0] if last is None else last)
    found = f._solutions(0, 2, None if last is None else near)
    assert len(found) > 1
    assert (np.abs(found - near) <= np.pi + 1e-9).all()
    assert (np.abs(f._solutions(0, 3, near) - near) > np.pi).any(), "every other round as they are"


@pytest.mark.parametrize("complete", [True, False])
def test_starts_are_all_solutions_in_the_first_round_and_others_after_it(complete, monkeypatch):
    asked = []

    def every(problem: Any, T: np.ndarray, near: np.ndarray) -> EverySolution:
        asked.append((T.tolist(), near.tolist()))
        return EverySolution(np.array([Q, Q + 1]), np.zeros(2, int), np.array([complete]))

    monkeypatch.setattr(follower, "every_solution", every)
    f = one(3)
    found = f._solutions(1, 0, None)
    assert np.array_equal(found, [Q, Q + 1]) == complete
    f._solutions(1, 0, Q + 2)
    for turn in (1, 2, 3):
        f._solutions(1, turn, None)
    middle = ARM.chain.limits.mean(axis=1)
    T = f.targets[1:2].tolist()
    rounds = [call for call in asked if len(call[1]) == 1]
    assert rounds[0] == (T, [middle.tolist()])
    assert rounds[1] == (T, [(Q + 2).tolist()])
    assert len(rounds) == 2


def test_of_an_arm_with_a_closed_form_no_branch_is_missed_as_a_start():
    arm = pk.load("ur5").chain()
    T = arm.fk(arm.random(1, 1))
    settings = SETTINGS._replace(task="pose")
    f = follower.Follower(make_problem(arm.compile(), settings), T, np.full(6, 0.1), None)
    assert len(f._solutions(0, 0, None)) == pk.ik_all(arm, T[0]).counts == 8
