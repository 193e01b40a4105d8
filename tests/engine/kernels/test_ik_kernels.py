"""The steps of inverse kinematics one by one, as plain Python: what is compiled is the same text."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from poekin.engine.kernels import follow_kernels, ik_all_kernel, ik_kernels
from poekin.engine.kernels import ik_codes as codes
from poekin.formulas.inverse import pose_error
from poekin.groups import se3, so3
from poekin.model.chain import Chain

MASK = 2**64 - 1
N = np.array([2.0, 3.0, -6.0]) / 7
ARM = Chain.from_space(
    [[0, 0, 1, 0, 0, 0], [0, 1, 0, -0.4, 0, 0], [0, 1, 0, -0.4, 0, 0.5], [1, 0, 0, 0, 0.4, 0]],
    se3.exp([0.2, -0.1, 0.3, 0.9, 0.1, 0.4]),
)
Q = np.array([0.3, -0.7, 1.1, 0.4])
FREE, WIDE = np.zeros(4), np.tile([-9.0, 9.0], (4, 1))
WEIGHTS = np.array([1.0, 0.5, 2.0, 3.0, 0.25, 1.5])


@pytest.fixture(autouse=True)
def plain(monkeypatch) -> Iterator[None]:
    """The arm is a chain, asked in Python."""

    def one(arm: Any, q: np.ndarray, T: np.ndarray, J: np.ndarray, scratch: np.ndarray) -> None:
        T[:], J[:] = arm.fk(q), arm.jacobian(q, "hybrid")

    monkeypatch.setattr(ik_kernels, "run_one", one)
    with np.errstate(over="ignore", invalid="ignore"):  # as in compiled code
        yield


def shifted(x: int) -> int:
    """Marsaglia's xorshift of 64 bits."""
    x ^= x << 13 & MASK
    x ^= x >> 7
    return x ^ x << 17 & MASK


def seeded(seed: int, index: int) -> int:
    state = seed * 0x9E3779B97F4A7C15 + (index + 1) * 0xBF58476D1CE4E5B9 & MASK
    for _ in range(4):
        state = shifted(state | 1)
    return state


@pytest.mark.parametrize(
    ("seed", "index"), [(0, 0), (1, 0), (0, 1), (12345, 678), (2**40 + 7, 2**20)]
)
def test_random_numbers_are_xorshift_from_a_spread_seed(seed, index):
    state = ik_kernels.seeded(seed, index)
    assert int(state) == seeded(seed, index)
    assert int(ik_kernels.next_random(state)) == shifted(seeded(seed, index))


@pytest.mark.parametrize("m", [1, 6, 20])
def test_memory_of_a_try_has_rows_of_four_numbers_a_coordinate_and_sixteen_more(m):
    work = ik_kernels.scratch_of_try(m)
    assert (work.T.shape, work.J.shape, work.H.shape) == ((4, 4), (6, m), (m, m))
    # of an arm's code these are sines and cosines of twice as many angles as it has coordinates
    assert work.rows.shape == (4, 2 * 2 * m + 16)


def rotation_error(T: np.ndarray, target: np.ndarray) -> tuple[float, float, float]:
    return pose_error.rotation_error(T[:3, :3].ravel(), target[:3, :3].ravel())


def options(**changed: float) -> np.ndarray:
    row = np.zeros(codes.OPTIONS)
    row[codes.TOL_POSITION] = row[codes.TOL_ROTATION] = 1e-9
    row[codes.ITERATIONS], row[codes.RESTARTS], row[codes.TASK] = 100, 0, codes.POSE
    row[codes.AXIS : codes.AXIS + 3], row[codes.WEIGHTS :] = [0, 0, 1], 1.0
    for name, value in changed.items():
        row[getattr(codes, name)] = value
    return row


def test_parts_of_the_error_that_a_task_does_not_ask_for_are_no_errors():
    T, target = ARM.fk(Q), se3.exp([0.1, 0.2, -0.3, 0.5, 0.4, 0.1])
    turn = np.array(rotation_error(T, target))
    off = target[:3, 3] - T[:3, 3]
    whole = (
        pytest.approx(np.linalg.norm(off), rel=1e-14),
        pytest.approx(pose_error.angle(turn), rel=1e-14),
    )
    for task, expected in (
        (codes.POSE, whole),
        (codes.POSITION, (whole[0], 0)),
        (codes.ROTATION, (0, whole[1])),
    ):
        J, e = ARM.jacobian(Q, "hybrid").copy(), np.zeros(6)
        assert ik_kernels.error_parts(task, np.array([0, 0, 1.0]), T, target, J, e) == expected
        assert e == pytest.approx([*turn, *off], abs=1e-15)
        assert np.array_equal(J, ARM.jacobian(Q, "hybrid"))


def test_of_a_direction_the_jacobian_loses_the_turn_about_it():
    T, target, axis = (
        ARM.fk(Q),
        se3.exp([0.1, 0.2, -0.3, 0.5, 0.4, 0.1]),
        np.array([0.48, 0.6, 0.64]),
    )
    J, e = ARM.jacobian(Q, "hybrid").copy(), np.zeros(6)
    position, rotation = ik_kernels.error_parts(codes.DIRECTION, axis, T, target, J, e)
    a, b = T[:3, :3] @ axis, target[:3, :3] @ axis
    assert position == pytest.approx(np.linalg.norm(target[:3, 3] - T[:3, 3]), rel=1e-14)
    assert rotation == pytest.approx(math.atan2(np.linalg.norm(np.cross(a, b)), a @ b), rel=1e-14)
    full = ARM.jacobian(Q, "hybrid")
    assert J[:3] == pytest.approx((np.eye(3) - np.outer(a, a)) @ full[:3], abs=1e-15)
    assert np.array_equal(J[3:], full[3:])


def test_of_a_plane_the_error_and_the_jacobian_lose_what_leads_out_of_it():
    T, target = ARM.fk(Q), se3.exp([0.1, 0.2, -0.3, 0.5, 0.4, 0.1])
    J, e = ARM.jacobian(Q, "hybrid").copy(), np.zeros(6)
    position, rotation = ik_kernels.error_parts(codes.PLANAR, N, T, target, J, e)
    off = (np.eye(3) - np.outer(N, N)) @ (target[:3, 3] - T[:3, 3])
    turn = pose_error.planar_error(T[:3, :3].ravel(), target[:3, :3].ravel(), N)
    assert e == pytest.approx([*turn, *off], abs=1e-15)
    assert position == pytest.approx(np.linalg.norm(off), rel=1e-14)
    assert rotation == pytest.approx(pose_error.angle(turn), rel=1e-14)
    full = ARM.jacobian(Q, "hybrid")
    assert J[:3] == pytest.approx(np.outer(N, N) @ full[:3], abs=1e-15)
    assert J[3:] == pytest.approx((np.eye(3) - np.outer(N, N)) @ full[3:], abs=1e-15)


def descended(
    q: np.ndarray,
    target: np.ndarray,
    limits: np.ndarray = WIDE,
    fixed: np.ndarray = FREE,
    **changed: Any,
):
    q, weights = q.copy(), changed.pop("weights", np.ones(6))
    row = options(**changed)
    row[codes.WEIGHTS :] = weights
    m = len(q)
    problem = ik_kernels.KernelProblem(ARM, limits, fixed, row)  # type: ignore[arg-type]
    return q, ik_kernels.descend(problem, target, q, ik_kernels.scratch_of_try(m))


def step(q: np.ndarray, target: np.ndarray, weights: np.ndarray, free: list[int]) -> np.ndarray:
    """(Jᵀ W J + E I) dq = Jᵀ W e with E = 0.1 eᵀ W e / 2, of the coordinates that are free."""
    T, J, W = ARM.fk(q), ARM.jacobian(q, "hybrid")[:, free], np.diag(weights)
    e = np.array([*rotation_error(T, target), *(target[:3, 3] - T[:3, 3])])
    dq = np.zeros(len(q))
    dq[free] = np.linalg.solve(J.T @ W @ J + 0.05 * (e @ W @ e) * np.eye(len(free)), J.T @ W @ e)
    return dq


TARGET = ARM.fk(np.array([0.8, -0.2, 0.6, 0.9]))


@pytest.mark.parametrize("weights", [np.ones(6), WEIGHTS])
@pytest.mark.parametrize("fixed", [[], [1], [0, 3]])
def test_a_step_is_that_of_damped_least_squares(weights, fixed):
    kept, free = FREE.copy(), [k for k in range(4) if k not in fixed]
    kept[fixed] = 1.0
    q, (state, position, rotation, taken) = descended(
        Q, TARGET, fixed=kept, ITERATIONS=1, weights=weights
    )
    assert q == pytest.approx(Q + step(Q, TARGET, weights, free), abs=1e-12)
    assert (state, taken) == (codes.OUT_OF_ITERATIONS, 1)
    assert position == pytest.approx(np.linalg.norm(TARGET[:3, 3] - ARM.fk(q)[:3, 3]), rel=1e-12)
    assert rotation == pytest.approx(
        np.linalg.norm(so3.log(TARGET[:3, :3] @ ARM.fk(q)[:3, :3].T)), rel=1e-9
    )


def test_a_coordinate_at_a_limit_stays_where_it_is_pushed_further_and_goes_where_it_is_not():
    T, J = ARM.fk(Q), ARM.jacobian(Q, "hybrid")
    e = np.array([*rotation_error(T, TARGET), *(TARGET[:3, 3] - T[:3, 3])])
    pull = J.T @ e
    assert (np.abs(pull) > 0.01).all()
    for k in range(4):
        for side in (0, 1):
            limits = WIDE.copy()
            limits[k, side] = Q[k]
            pushed = (pull[k] < 0) == (side == 0)
            q, _ = descended(Q, TARGET, limits=limits, ITERATIONS=1)
            free = [j for j in range(4) if j != k or not pushed]
            expected = np.clip(Q + step(Q, TARGET, np.ones(6), free), limits[:, 0], limits[:, 1])
            assert q == pytest.approx(expected, abs=1e-12)


def test_a_step_ends_at_the_limits():
    dq = step(Q, TARGET, np.ones(6), [0, 1, 2, 3])
    limits = np.stack([Q - np.abs(dq) / 2, Q + np.abs(dq) / 2], axis=1)
    q, _ = descended(Q, TARGET, limits=limits, ITERATIONS=1)
    assert q == pytest.approx(Q + dq / 2, abs=1e-15)


def test_what_is_reached_is_solved_and_the_tolerances_hold_each_for_its_part():
    q, (state, position, rotation, taken) = descended(Q, TARGET)
    assert state == codes.SOLVED
    assert 2 < taken < 12
    assert max(position, rotation) <= 1e-9
    assert ARM.fk(q) == pytest.approx(TARGET, abs=1e-8)
    _, (_, position, rotation, _) = descended(Q, TARGET, ITERATIONS=0)
    for at, angle, state in (
        (position, rotation, codes.SOLVED),
        (position * 0.999, rotation, codes.OUT_OF_ITERATIONS),
        (position, rotation * 0.999, codes.OUT_OF_ITERATIONS),
    ):
        same, (ended, *_, taken) = descended(
            Q, TARGET, ITERATIONS=0, TOL_POSITION=at, TOL_ROTATION=angle
        )
        assert (ended, taken) == (state, 0)
        assert np.array_equal(same, Q)


@pytest.mark.parametrize(
    ("ratios", "taken"), [([0.901] * 3, 3), ([0.901, 0.901, 0.899, 0.901, 0.901, 0.901], 6)]
)
def test_three_steps_in_a_row_that_leave_nine_tenths_end_a_try(ratios, taken, monkeypatch):
    sizes = iter(np.cumprod([1.0, *ratios, *[0.5] * 3]))

    def one(arm: Any, q: np.ndarray, T: np.ndarray, J: np.ndarray, scratch: np.ndarray) -> None:
        T[:], J[:] = np.eye(4), np.ones((6, 4))
        T[0, 3] = -math.sqrt(next(sizes))

    monkeypatch.setattr(ik_kernels, "run_one", one)
    _, (state, *_, count) = descended(Q, np.eye(4))
    assert (state, count) == (codes.STALLED, taken)


@pytest.mark.parametrize("off", [math.nan, math.inf])
def test_a_try_with_an_error_that_is_not_finite_ends_after_two_steps(off, monkeypatch):
    def one(arm: Any, q: np.ndarray, T: np.ndarray, J: np.ndarray, scratch: np.ndarray) -> None:
        T[:], J[:] = np.eye(4), 1.0
        T[0, 3] = off

    monkeypatch.setattr(ik_kernels, "run_one", one)
    _, (state, *_, taken) = descended(Q, np.eye(4))
    assert (state, taken) == (codes.STALLED, 2)


def test_the_axis_of_a_task_is_three_numbers_of_the_options():
    row = np.arange(float(codes.OPTIONS))
    assert ik_kernels.axis_of(row).tolist() == row[codes.AXIS : codes.WEIGHTS].tolist()


@pytest.mark.parametrize("place", range(16))
def test_a_target_is_finite_or_not(place):
    for wrong in (math.nan, math.inf, -math.inf):
        target = np.eye(4)
        target.flat[place] = wrong
        assert ik_kernels.is_finite(target) == (place >= 12)


class Tries:
    """In place of `descend`: takes down where each try begins, and ends it as is written."""

    def __init__(self, *ends: tuple[float, float, float, int], places: Any = ()):
        self.ends, self.places, self.begun = list(ends), iter(places), []

    def __call__(
        self,
        problem: Any,
        target: Any,
        q: np.ndarray,
        *rest: Any,
    ) -> Any:
        self.begun.append(q.copy())
        q[:] = next(self.places, q + 100.0)
        return self.ends.pop(0)


RANGES = np.array([[-1.0, 2.0], [5.0, 5.5], [-3.0, -2.0], [0.0, 1.0]])
FAIL, GOOD = (codes.STALLED, 0.5, 0.5, 7), (codes.SOLVED, 1e-12, 1e-12, 4)


def random_places(seed: int, index: int, count: int, places: list[int]) -> list[list[float]]:
    """What random starts have to be, in order, of the coordinates that are not fixed."""
    state, rows = seeded(seed, index), []
    for _ in range(count):
        row = []
        for k in places:
            state = shifted(state)
            low, high = RANGES[k]
            row.append(low + (state >> 11) * 2.0**-53 * (high - low))
        rows.append(row)
    return rows


def solved(
    tries: Tries,
    monkeypatch,
    q0: Any = Q,
    restarts: int = 5,
    fixed: Any = FREE,
    target: Any = TARGET,
):
    monkeypatch.setattr(ik_kernels, "descend", tries)
    q, info = np.zeros((1, 4)), np.full((1, codes.INFO), -1.0)
    row = options(RESTARTS=restarts)
    ik_kernels.solve_many.function(
        ARM, target[None], np.array(q0)[None], WIDE, RANGES, fixed, row, np.array([3.0]), 9, q, info
    )
    return q[0], info[0].tolist()


def test_the_first_try_begins_at_q0_and_the_others_anywhere_in_the_ranges(monkeypatch):
    fixed = np.array([0.0, 0, 1, 0])
    tries = Tries(FAIL, FAIL, GOOD)
    q, info = solved(tries, monkeypatch, fixed=fixed)
    starts = random_places(9, 3, 2, [0, 1, 3])
    assert np.array_equal(tries.begun[0], Q)
    for begun, (a, b, d) in zip(tries.begun[1:], starts, strict=True):
        assert begun.tolist() == [a, b, Q[2], d]
    assert q.tolist() == (tries.begun[2] + 100).tolist()
    assert info == [1e-12, 1e-12, 18, 2, codes.SOLVED]


def test_what_is_nan_in_q0_begins_anywhere(monkeypatch):
    tries = Tries(GOOD)
    solved(tries, monkeypatch, q0=[0.1, math.nan, 0.3, math.nan])
    ((b, d),) = random_places(9, 3, 1, [1, 3])
    assert tries.begun[0].tolist() == [0.1, b, 0.3, d]


def test_of_tries_that_fail_the_nearest_is_kept(monkeypatch):
    ends = [
        (codes.STALLED, 0.5, 0.5, 1),
        (codes.OUT_OF_ITERATIONS, 0.1, 0.3, 2),
        (codes.STALLED, 0.3, 0.2, 4),
    ]
    q, info = solved(tries := Tries(*ends), monkeypatch, restarts=2)
    assert q.tolist() == (tries.begun[1] + 100).tolist()
    assert info == [0.1, 0.3, 7, 2, codes.OUT_OF_ITERATIONS]
    ends = [(codes.STALLED, *errors, 1) for errors in ((0.5, 0.5), (0.1, 0.3), (0.3, 0.05))]
    again = (codes.STALLED, 0.05, 0.3, 1)  # as near, and later
    q, info = solved(tries := Tries(*ends, again), monkeypatch, restarts=3)
    assert q.tolist() == (tries.begun[2] + 100).tolist()
    assert info == [0.3, 0.05, 4, 3, codes.STALLED]
    for first in (math.nan, math.inf):
        ends = [(codes.STALLED, first, 0.5, 1), (codes.STALLED, 5.0, 0.3, 2)]
        q, info = solved(tries := Tries(*ends), monkeypatch, restarts=1)
        assert info[:2] == [5.0, 0.3]
        q, info = solved(tries := Tries(ends[0]), monkeypatch, restarts=0)
        assert info[2:] == [1, 0, codes.STALLED]
        assert np.array_equal(q, Q + 100)


def test_a_target_that_is_not_finite_is_not_tried_and_those_after_it_are(monkeypatch):
    targets = np.stack([TARGET, TARGET])
    targets[0, 1, 3] = math.inf
    monkeypatch.setattr(ik_kernels, "descend", tries := Tries(GOOD))
    q, info = np.zeros((2, 4)), np.full((2, codes.INFO), -1.0)
    ik_kernels.solve_many.function(
        ARM, targets, np.stack([Q, Q]), WIDE, RANGES, FREE, options(), np.zeros(2), 9, q, info
    )
    assert [begun.tolist() for begun in tries.begun] == [Q.tolist()]
    assert np.isnan(q[0]).all()
    assert np.isnan(info[0, :2]).all()
    assert info[0, 2:].tolist() == [0, 0, codes.BAD_TARGET]
    assert info[1].tolist() == [1e-12, 1e-12, 4, 0, codes.SOLVED]


def test_each_target_has_its_own_start_and_random_numbers(monkeypatch):
    monkeypatch.setattr(ik_kernels, "descend", tries := Tries(FAIL, GOOD, FAIL, GOOD))
    q, info = np.zeros((2, 4)), np.zeros((2, codes.INFO))
    starts = np.stack([Q, Q + 1])
    ik_kernels.solve_many.function(
        ARM,
        np.stack([TARGET, TARGET]),
        starts,
        WIDE,
        RANGES,
        FREE,
        options(RESTARTS=1),
        np.array([4.0, 0]),
        2,
        q,
        info,
    )
    assert [begun.tolist() for begun in tries.begun] == [
        starts[0].tolist(), *random_places(2, 4, 1, [0, 1, 2, 3]),
        starts[1].tolist(), *random_places(2, 0, 1, [0, 1, 2, 3]),
    ]  # fmt: skip
    assert info[:, codes.AT_RESTARTS].tolist() == [1, 1]


def followed(
    tries: Tries, monkeypatch, most: Any = (500.0,) * 4
) -> tuple[int, np.ndarray, np.ndarray]:
    monkeypatch.setattr(follow_kernels, "descend", tries)
    q, info = np.zeros((3, 4)), np.full((3, codes.INFO), -1.0)
    reached = follow_kernels.follow.function(
        ARM, np.stack([TARGET] * 3), Q, WIDE, FREE, options(), np.array(most), q, info
    )
    return reached, q, info


def test_each_pose_of_a_path_begins_where_the_one_before_ended(monkeypatch):
    tries = Tries(GOOD, GOOD, (codes.SOLVED, 1e-11, 1e-10, 3))
    reached, q, info = followed(tries, monkeypatch)
    assert reached == 3
    assert [begun.tolist() for begun in tries.begun] == [(Q + 100.0 * k).tolist() for k in range(3)]
    assert q == pytest.approx(np.stack([Q + 100, Q + 200, Q + 300]), abs=1e-12)
    assert info.tolist() == [
        [1e-12, 1e-12, 4, 0, 0],
        [1e-12, 1e-12, 4, 0, 0],
        [1e-11, 1e-10, 3, 0, 0],
    ]


def test_a_path_ends_at_the_first_pose_that_is_not_reached(monkeypatch):
    reached, q, info = followed(Tries(GOOD, FAIL), monkeypatch)
    assert reached == 1
    assert q[1] == pytest.approx(Q + 200)
    assert info[1].tolist() == [0.5, 0.5, 7, 0, codes.STALLED]
    assert not q[2].any()


@pytest.mark.parametrize("k", range(4))
def test_a_path_ends_where_a_coordinate_moves_too_far(k, monkeypatch):
    most = [500.0] * 4
    places = [np.zeros(4), -3.0 * np.eye(4)[k], np.zeros(4)]
    most[k] = 3.0
    assert followed(Tries(GOOD, GOOD, GOOD, places=places), monkeypatch, most)[0] == 3
    most[k] = 3.0 - 1e-9
    reached, q, info = followed(Tries(GOOD, GOOD, GOOD, places=places), monkeypatch, most)
    assert reached == 1
    assert q[1].tolist() == places[1].tolist()
    assert info[1, codes.AT_STATE] == codes.SOLVED


@pytest.mark.parametrize("task", [codes.POSE, codes.POSITION, codes.ROTATION, codes.DIRECTION])
def test_results_are_judged_by_the_chain_in_the_parts_of_the_task(task):
    q, axis = np.stack([Q, Q + 0.1, -Q]), np.array([0.48, 0.6, 0.64])
    targets, errors = np.stack([TARGET, ARM.fk(Q + 0.1), np.eye(4)]), np.full((3, 2), -1.0)
    ik_kernels.pose_errors.function(ARM.kernel_table, q, targets, task, axis, errors)
    for target, row, (position, rotation) in zip(targets, q, errors, strict=True):
        T = ARM.fk(row)
        a, b = T[:3, :3] @ axis, target[:3, :3] @ axis
        turns = {
            codes.POSITION: 0.0,
            codes.DIRECTION: math.atan2(np.linalg.norm(np.cross(a, b)), a @ b),
        }
        whole = float(np.linalg.norm(so3.log(target[:3, :3] @ T[:3, :3].T)))
        assert rotation == pytest.approx(turns.get(task, whole), abs=1e-14)
        off = 0.0 if task == codes.ROTATION else np.linalg.norm(target[:3, 3] - T[:3, 3])
        assert position == pytest.approx(off, abs=1e-15)
    short = Chain.from_space(ARM.screws[:3], ARM.home)
    there = short.fk(Q[:3])[None]
    ik_kernels.pose_errors.function(short.kernel_table, q[:1, :3], there, task, axis, errors)
    assert errors[0] == pytest.approx([0.0, 0.0], abs=1e-14)


def test_an_angle_goes_the_shorter_way_round():
    turn = 2 * math.pi
    for d, period, expected in (
        (0.3, turn, 0.3), (-0.3, turn, -0.3), (3.5, turn, 3.5 - turn), (-3.5, turn, turn - 3.5),
        (turn + 0.1, turn, 0.1), (-3 * turn - 0.1, turn, -0.1), (3.5, 0.0, 3.5), (0.7, 0.5, 0.2), (100.0, 0.0, 100.0),
        (0.5, 1.0, -0.5), (-0.5, 1.0, -0.5),
    ):  # fmt: skip
        assert ik_all_kernel.wrapped_difference(d, period) == pytest.approx(expected, abs=1e-12)


PERIODS = np.array([2 * math.pi, 0.0, 2 * math.pi, 0.0])


def is_same(target: Any, a: Any, b: Any, middle: np.ndarray, limit: float) -> bool:
    problem: Any = ik_kernels.KernelProblem(ARM, WIDE, FREE, options())  # type: ignore[arg-type]
    return ik_all_kernel.is_same(
        problem, target, (a, b, middle), PERIODS, limit, ik_kernels.scratch_of_try(4)
    )


@pytest.mark.parametrize("k", range(4))
def test_two_ends_are_one_where_they_are_one_place_or_the_pose_halfway_is_the_target_s(k):
    trial, target = np.empty(4), ARM.fk(Q)

    def same(apart: float, accepted: float, around: float = 0.0) -> bool:
        b = Q.copy()
        b[k] += apart + around
        return is_same(target, Q, b, trial, accepted)

    assert same(0.99e-7, 0.0)
    assert same(-0.99e-7, 0.0)
    assert not same(2e-7, 1e-9)
    assert same(2e-7, 1e-6)  # halfway it is 1e-7 off
    assert same(-0.99e-2, 0.1)
    assert trial[k] == pytest.approx(Q[k] - 0.495e-2, abs=1e-12)
    assert not same(1.01e-2, 0.1)
    assert same(0.99e-7, 0.0, 2 * math.pi) == (PERIODS[k] > 0)
    halfway = Q + 2e-3 * np.eye(4)[k]
    off = ARM.fk(halfway)[:3, 3] - target[:3, 3]
    turned = np.linalg.norm(so3.log(ARM.fk(halfway)[:3, :3] @ target[:3, :3].T))
    largest = max(float(np.linalg.norm(off)), float(turned))
    assert same(4e-3, largest * 1.001)
    assert not same(4e-3, largest * 0.999)


@pytest.mark.parametrize("m", [1, 4, 6])
def test_columns_are_nearly_dependent_below_1e_5_of_each_other(m):
    rng = np.random.default_rng(m)
    U = np.linalg.qr(rng.normal(size=(6, 6)))[0][:, :m]
    work, ones = ik_kernels.scratch_of_try(m), np.ones(6)
    for k in range(m):
        for small, singular in ((1.1e-5, False), (0.9e-5, m > 1)):
            sizes = np.ones(m)
            sizes[k] = small
            for unit in (1.0, 1e3, 1e-3):
                scaled = work._replace(J=U * sizes * unit)
                assert ik_all_kernel.is_singular(ones, np.ones(m), scaled) == singular
    if m > 1:
        J = U.copy()
        J[:, -1] = J[:, 0] + 1e-9 * J[:, -1]
        assert ik_all_kernel.is_singular(ones, np.ones(m), work._replace(J=J))


@pytest.mark.parametrize("m", [2, 4, 6, 7])
def test_a_bound_of_the_condition_is_one_and_locked_columns_do_not_count(m):
    rng = np.random.default_rng(m)
    work, ones = ik_kernels.scratch_of_try(m), np.ones(6)
    for _ in range(100):
        J = rng.normal(size=(6, m)) * 10.0 ** rng.uniform(-3, 3, m)
        free = np.ones(m)
        free[rng.integers(m)] = 0.0
        if m < 7 and rng.random() < 0.5:
            free[:] = 1.0
        work = work._replace(J=J)
        ik_all_kernel.is_singular(ones, free, work)
        sizes = np.linalg.svd(J[:, free > 0], compute_uv=False)
        # squares: the pivots are known to u times the squared condition
        bound = ik_all_kernel.condition_bound(free, work) ** 2
        exact = (sizes[-1] / sizes[0]) ** 2
        assert bound <= exact + 64 * 2.0**-53 * m
    J = np.eye(6)[:, :m] if m < 7 else np.eye(6)[:, [0, 1, 2, 3, 4, 5, 5]]
    free = np.ones(m)
    free[6:] = 0.0
    work = work._replace(J=J)
    assert not ik_all_kernel.is_singular(ones, free, work)
    n = min(m, 6)
    expected = ((n - 1) ** (n - 1) / n**n) ** 0.5
    assert ik_all_kernel.condition_bound(free, work) == pytest.approx(expected)
    free = np.ones(m)
    free[-1] = 0.0
    work = work._replace(J=np.eye(6, m) * 1e-6)  # a pivot of 1 is of what is locked
    assert not ik_all_kernel.is_singular(ones, free, work)
    free[:] = np.eye(m)[0]
    assert not ik_all_kernel.is_singular(ones, free, work)
    assert ik_all_kernel.condition_bound(free, work) == pytest.approx(1.0)
    work = work._replace(J=np.eye(6, m))
    ik_all_kernel.is_singular(ones, free, work)
    assert ik_all_kernel.condition_bound(free, work) == pytest.approx(1.0)
    for wrong in (-1e-17, math.nan):  # what rounding makes of a pivot
        by_rounding = work._replace(H=np.diag([wrong, *[1.0] * (m - 1)]))
        assert ik_all_kernel.condition_bound(np.ones(m), by_rounding) == 0.0
    work = work._replace(J=np.zeros((6, m)))
    ik_all_kernel.is_singular(ones, free, work)
    assert ik_all_kernel.condition_bound(free, work) == 0.0
    J = rng.normal(size=(6, m))
    J[:, 1] = J[:, 0] = np.eye(6)[0]  # two joints about one axis: a pivot of exactly 0
    work = work._replace(J=J)
    assert ik_all_kernel.is_singular(ones, np.ones(m), work)
    assert ik_all_kernel.condition_bound(np.ones(m), work) == 0.0


def test_a_locked_coordinate_starts_every_try_at_its_own_value_of_the_target(monkeypatch):
    begun: list[list[float]] = []

    def descend(problem: Any, target: Any, q: np.ndarray, *rest: Any) -> tuple[int, ...]:
        assert problem.fixed.tolist() == [0, 1, 0, 0]
        begun.append(q.tolist())
        return codes.SOLVED, 0, 0, 1

    monkeypatch.setattr(ik_all_kernel, "descend", descend)
    monkeypatch.setattr(ik_all_kernel, "is_singular", lambda *rest: False)
    rule = np.zeros(ik_all_kernel.RULE)
    rule[ik_all_kernel.RESTARTS] = 3
    rule[ik_all_kernel.MIN_HITS] = 99
    rule[ik_all_kernel.MAX_MISSES] = 9
    values = np.full((2, 4), np.nan)
    values[:, 1] = 0.25, -0.5
    ik_all_kernel.search.function(
        ARM, np.stack([TARGET] * 2), np.zeros((2, 0, 4)), np.zeros(2), WIDE, RANGES, PERIODS,
        np.array([1.0, 0, 1, 1]), values, options(), rule, np.arange(2.0), 9, np.zeros((2, 8, 4)), np.zeros((2, 8)),
        np.zeros((2, 8)), np.zeros((2, ik_all_kernel.INFO))
    )  # fmt: skip
    assert [q[1] for q in begun] == [0.25] * 3 + [-0.5] * 3


def test_solutions_were_found_often_enough():
    hits = np.array([3.0, 2.0, 5.0, 1.0])
    regular, last = np.zeros(4, bool), np.array([False, False, False, True])
    both = np.array([True, False, False, True])
    for singular, count, each, pairs, enough in (
        (regular, 3, 2.0, False, True), (regular, 3, 2.5, False, False), (regular, 4, 2.0, False, False),
        (regular, 2, 2.0, True, True), (regular, 3, 2.0, True, False), (regular, 3, 0.25, True, True),
        (regular, 3, 0.26, True, False), (regular, 1, 0.375, True, True), (regular, 1, 0.376, True, False),
        (last, 4, 1.0, True, True), (last, 4, 1.5, True, False), (both, 4, 2.0, False, True),
        (both, 4, 2.1, False, False), (both, 3, 2.0, True, True), (both, 3, 2.1, True, False),
    ):  # fmt: skip
        assert bool(ik_all_kernel.is_enough(hits, singular, count, each, pairs)) is enough


def test_both_parts_of_an_error_are_accepted_up_to_the_limit():
    for position, rotation, accepted in (
        (0.5, 0.5, True), (0.0, 0.25, True), (0.75, 0.25, False), (0.25, 0.75, False), (0.75, 0.75, False),
        (math.nan, 0.25, False), (0.25, math.nan, False),
    ):  # fmt: skip
        assert bool(ik_all_kernel.is_accepted(position, rotation, 0.5)) is accepted


def test_numbers_of_a_rule_and_a_row_have_places_of_their_own():
    kernel = ik_all_kernel
    assert [*range(4)] == [kernel.MAX_ERROR, kernel.MIN_HITS, kernel.RESTARTS, kernel.MAX_MISSES]
    assert [*range(4)] == [kernel.FOUND, kernel.AT_RESTARTS, kernel.AT_ENDS, kernel.FULL]
    assert (kernel.RULE, kernel.INFO) == (4, 4)


class Search:
    """A search for solutions whose tries end as is written: the place, and whether its columns are
    dependent.
    """

    def __init__(
        self, monkeypatch, ends: Any, room: int = 8, given: int = 2, free: Any = (1.0,) * 4, **rule: float
    ):  # fmt: skip
        self.begun: list[np.ndarray] = []
        self.ends = iter(ends)
        numbers = {"MAX_ERROR": 1e-6, "MIN_HITS": 2.0, "RESTARTS": 20, "MAX_MISSES": 5} | rule
        self.rule = np.zeros(ik_all_kernel.RULE)
        for name, value in numbers.items():
            self.rule[getattr(ik_all_kernel, name)] = value
        self.again: list[int] = []
        monkeypatch.setattr(ik_all_kernel, "descend", self._descend)
        monkeypatch.setattr(ik_all_kernel, "is_singular", lambda *rest: self.bad)
        monkeypatch.setattr(
            ik_all_kernel,
            "is_same",
            lambda problem, target, ends, *rest: bool(np.abs(ends[0] - ends[1]).max() < 1e-3),
        )
        m = len(free)
        self.hits = np.zeros((1, room))
        self.q = np.tile(
            [0.1, 1.0, 0.2, 0.3, *[0.0] * (m - 4)], (1, room, 1)
        )  # nothing is known yet
        self.bounds = np.zeros((1, room))
        self.info = np.full((1, ik_all_kernel.INFO), -1.0)
        places = np.tile(Q, 2)[:m]
        starts = np.stack([places + 50, places + 60, places + 70])[None]
        limits, ranges, periods = (np.concatenate([a, a])[:m] for a in (WIDE, RANGES, PERIODS))
        ik_all_kernel.search.function(
            ARM, TARGET[None], starts, np.array([given]), limits, ranges, periods, np.array(free),
            np.full((1, m), 0.25), options(), self.rule, np.array([3.0]), 9, self.q, self.hits, self.bounds, self.info
        )  # fmt: skip

    def _descend(
        self, problem: Any, target: Any, q: np.ndarray, *rest: Any
    ) -> tuple[int, float, float, int]:
        self.begun.append(q.copy())
        place, error, self.bad = (*next(self.ends), False)[:3]
        q[:4] = [0.1, place, 0.2, 0.3]
        q[4:] = 0.0
        return codes.SOLVED if error == 0 else codes.STALLED, error, error, 1

    @property
    def found(self) -> tuple[list[float], list[float], list[float]]:
        count = int(self.info[0, ik_all_kernel.FOUND])
        return self.q[0, :count, 1].tolist(), self.hits[0, :count].tolist(), self.info[0].tolist()


def test_a_search_begins_at_the_given_starts_and_then_anywhere(monkeypatch):
    found = Search(monkeypatch, [(1, 0), (2, 0)] * 4)
    assert [begun.tolist() for begun in found.begun] == [
        (Q + 50).tolist(), (Q + 60).tolist(), *random_places(9, 3, 2, [0, 1, 2, 3])
    ]  # fmt: skip
    assert found.found == ([1, 2], [2, 2], [2, 2, 4, 0])


def test_an_odd_number_of_solutions_is_no_reason_to_end_only_with_six_coordinates(monkeypatch):
    assert Search(monkeypatch, [(1, 0)] * 20).found == (
        [1],
        [3],
        [1, 1, 3, 0],
    )  # a random try at least


@pytest.mark.parametrize(
    ("free", "hits"), [((1,) * 5, 3), ((1,) * 6, 16), ((1,) * 7, 3), ((1, 1, 1, 1, 0, 1, 1), 16)]
)
def test_of_six_free_coordinates_an_odd_number_is_looked_into_eight_times_longer(
    free, hits, monkeypatch
):
    monkeypatch.setattr(ik_all_kernel, "condition_bound", lambda *rest: 0.5)
    found = Search(monkeypatch, [(1, 0)] * 20, free=np.array(free, float), MIN_HITS=2.0)
    assert found.found[:2] == ([1], [hits])


def test_each_given_start_is_tried_and_a_random_one_whatever_was_found(monkeypatch):
    found = Search(monkeypatch, [(1, 0)] * 20, given=3, MIN_HITS=1.0)
    assert found.found == ([1], [4], [1, 1, 4, 0])


def test_a_search_without_restarts_has_none(monkeypatch):
    assert Search(monkeypatch, [(1, 0)] * 3, RESTARTS=0).found == ([1], [2], [1, 0, 2, 0])
    full = Search(monkeypatch, [(1, 0), (2, 0), (3, 0)], given=3, room=1)
    assert full.found == ([1], [1], [1, 0, 2, 1])


def test_a_search_of_an_arm_finds_where_it_can_be(monkeypatch):
    solution = np.array([0.8, -0.2, 0.6, 0.9])
    rule = np.zeros(ik_all_kernel.RULE)
    rule[ik_all_kernel.MAX_ERROR], rule[ik_all_kernel.MIN_HITS] = 1e-6, 1.0
    q, hits, bounds = np.zeros((1, 8, 4)), np.zeros((1, 8)), np.zeros((1, 8))
    info = np.zeros((1, ik_all_kernel.INFO))
    ik_all_kernel.search.function(
        ARM, TARGET[None], solution[None, None] + 0.01, np.ones(1), WIDE, RANGES, PERIODS, np.ones(4),
        np.full((1, 4), np.nan), options(), rule, np.zeros(1), 9, q, hits, bounds, info
    )  # fmt: skip
    assert info.tolist() == [[1, 0, 1, 0]]
    assert q[0, 0] == pytest.approx(solution, abs=1e-7)  # of errors of 1e-9
    sizes = np.linalg.svd(ARM.jacobian(solution, "hybrid"), compute_uv=False)
    assert 0.0 < bounds[0, 0] <= sizes[-1] / sizes[0]


def test_what_is_not_accepted_is_no_solution(monkeypatch):
    ends = [(1, 1.1e-6), (1, 0), (2, 1.0), (1, 0), (1, 0)]
    assert Search(monkeypatch, ends).found == ([1], [2], [1, 2, 2, 0])


def test_a_search_without_a_solution_ends_early(monkeypatch):
    assert Search(monkeypatch, [(1, 1.0)] * 20).found == ([], [], [0, 5, 0, 0])
    assert Search(monkeypatch, [(1, 1.0)] * 20, given=3, MAX_MISSES=1).found == (
        [],
        [],
        [0, 1, 0, 0],
    )
    assert Search(monkeypatch, [(1, 1.0)] * 20, MAX_MISSES=50, RESTARTS=7).found == (
        [],
        [],
        [0, 7, 0, 0],
    )


def test_a_search_ends_after_its_restarts_whatever_was_found(monkeypatch):
    ends = ((k, 0) for k in range(100))
    assert Search(monkeypatch, ends, room=50).found[2] == [22, 20, 22, 0]


def test_without_room_a_search_ends_and_says_so(monkeypatch):
    assert Search(monkeypatch, ((k, 0) for k in range(100)), room=4).found == (
        [0, 1, 2, 3],
        [1] * 4,
        [4, 3, 5, 1],
    )


def test_of_a_continuum_twelve_members_are_kept(monkeypatch):
    found = Search(monkeypatch, ((k, 0, True) for k in range(100)), room=50, MIN_HITS=5.0)
    assert found.found == (list(range(12)), [1] * 12, [12, 20, 22, 0])


def test_a_try_that_is_near_is_gone_on_with_three_times(monkeypatch):
    near = [(1, 1e-7)] * 4
    found = Search(monkeypatch, [*near, (1, 1e-7), (1, 0), (2, 1e-7), (2, 1.0), *[(1, 0)] * 9])
    assert found.begun[1].tolist() == [0.1, 1, 0.2, 0.3]
    assert found.begun[4].tolist() == (Q + 60).tolist()
    assert found.found == ([1], [2], [1, 1, 2, 0])


def test_solutions_are_within_a_period(monkeypatch):
    monkeypatch.setattr(ik_all_kernel, "is_same", lambda *rest: True)
    places = iter([np.array([7.0, 8.0, -7.0, 9.0])] * 9)

    class Far(Search):
        def _descend(
            self, problem: Any, target: Any, q: np.ndarray, *rest: Any
        ) -> tuple[int, float, float, int]:
            self.bad = False
            q[:] = next(places)
            return codes.SOLVED, 0.0, 0.0, 1

    turn = 2 * math.pi
    assert Far(monkeypatch, []).q[0, 0] == pytest.approx([7 - turn, 8.0, turn - 7, 9.0], abs=1e-12)


@pytest.mark.parametrize("row", range(6))
@pytest.mark.parametrize("side", [0, 1])
def test_each_part_of_the_error_decides_whether_a_coordinate_is_pushed_beyond_its_limit(
    row, side, monkeypatch
):
    sign = (-1.0, 1.0)[side]

    def one(arm: Any, q: np.ndarray, T: np.ndarray, J: np.ndarray, scratch: np.ndarray) -> None:
        e = 1e-3 * sign * np.eye(6)[row]
        T[:], J[:] = np.eye(4), 0.0
        T[:3, :3], T[:3, 3] = so3.exp(-e[:3]), -e[3:]
        J[row, :2] = 1.0
        J[(row + 1) % 3, :2] = 1e-9  # it turns

    monkeypatch.setattr(ik_kernels, "run_one", one)
    limits = WIDE.copy()
    limits[0, side] = Q[0]
    q, _ = descended(Q, np.eye(4), limits=limits, ITERATIONS=1, weights=WEIGHTS)
    # alone the second one goes the whole way, where both went half of it each
    assert q[1] - Q[1] == pytest.approx(1e-3 * sign, rel=1e-4)
    assert q[0] == Q[0]
    limits[0, side], limits[0, 1 - side] = WIDE[0, side], Q[0]
    q, _ = descended(Q, np.eye(4), limits=limits, ITERATIONS=1, weights=WEIGHTS)
    assert q[:2] - Q[:2] == pytest.approx([5e-4 * sign] * 2, rel=1e-4)
