"""What joints to spare are for: only coordinates with both limits have a middle, and steps too long
are shortened.
"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.engine.kernels import ik_codes as codes
from poekin.errors import InputError
from poekin.model import screw
from poekin.solve.ik.choice import redundancy
from poekin.solve.ik.ik import ik
from poekin.solve.ik.ik_problem import Settings, make_problem


def test_only_a_coordinate_with_two_limits_has_a_middle():
    # two slides along one line: what the first gives up the second takes over, which has no middle
    # to be drawn to
    limits, q0 = [[-1, 1], [0, np.inf], [-1, 1], [-1, 1]], [1.0, 1.0, 0.5, 0.5]
    arm = pk.Chain.from_space(
        [screw.prismatic(way) for way in np.eye(3)[[0, 0, 1, 2]]], np.eye(4), limits=limits
    )
    found = ik(arm, arm.fk(q0), task="position", q0=q0, secondary_objective="middle")
    # the slides share each step: the second is one and the third two halves of the way
    np.testing.assert_allclose(found.q, [0, 2, 0.5, 0.5], rtol=0, atol=1e-9)


@pytest.mark.parametrize("limit", [np.inf, 10.0])
def test_the_nearest_to_q0_is_not_a_whole_turn_away_from_it(limit):
    arm = pk.load("panda").chain(tip="panda_hand").replace(limits=[[-limit, limit]] * 7)
    for turns in (0.0, 2 * np.pi):
        q0 = np.array([5.0 - turns, -0.5, 0.2, -2.0, 0.3, 1.6, 0.8 + turns])
        found = ik(arm, arm.fk(q0 + 0.05), q0=q0, secondary_objective="nearest")
        assert found.success
        assert np.abs(found.q - q0).max() < 0.1


@pytest.mark.parametrize("length", [1.0, 2.0])
def test_a_step_that_is_too_long_is_made_shorter(length):
    # a table that slides far to the side: what brings the slides back turns the tip about a circle
    axes = [*map(screw.prismatic, np.eye(3)), screw.revolute([0, 0, 1.0], [0, 0, 0])]
    arm = pk.Chain.from_space(axes, pk.se3.exp([0, 0, 0, length, 0, 0]))
    found = ik(
        arm, arm.fk([0, 10.0, 0, 0]), task="position", q0=np.zeros(4), secondary_objective="nearest"
    )
    assert found.success
    spare = np.linalg.svd(arm.jacobian(found.q, "hybrid")[3:])[2][
        -1
    ]  # the one motion that leaves the tip
    assert (
        abs(spare @ found.q) <= 1e-3
    )  # the distance to 0 does not change along it: no solution nearby is nearer


def solver(task="position", lock=None):
    """The solver of an arm with three slides and a joint that turns, of which the first and the
    last have limits.
    """
    axes = [*map(screw.prismatic, np.eye(3)), screw.revolute([0, 0, 1.0], [0, 0, 0])]
    limits = [[-1, 3], [-np.inf, np.inf], [0, np.inf], [-2, 1]]
    chain = pk.Chain.from_space(
        axes, pk.se3.exp([0, 0, 0, 1, 0, 0]), limits=limits, joint_names=list("abcd")
    )
    return make_problem(
        chain.compile(), Settings(task, None, True, 1e-9, 1e-9, lock, None, 5, 30, 0, False)
    )


def test_an_aim_is_measured_from_q0_or_from_the_middle_of_the_limits_that_there_are():
    arm, q0, q = solver(), np.array([[0.5, 6.0, 7.0, 0.25]]), np.array([[2.0, 5.0, 5.0, 0.5]])
    nearest = redundancy.make_aim(arm, q0, "nearest")
    middle = redundancy.make_aim(arm, q0, "middle")
    np.testing.assert_array_equal(nearest.goal, q0)
    np.testing.assert_array_equal(middle.goal, [[1, 6, 7, -0.5]])
    assert nearest.weights == 1
    np.testing.assert_array_equal(middle.weights, [1, 0, 0, 1])
    np.testing.assert_allclose(nearest.value(q), 1.5**2 + 1 + 4 + 0.25**2)
    np.testing.assert_allclose(middle.value(q), 1 + 1)


@pytest.mark.parametrize("task, rows", [("position", slice(3, 6)), ("rotation", slice(0, 3))])
def test_the_manipulability_is_that_of_the_task_by_what_may_move(task, rows):
    q = np.array([[0.1, 0.2, 0.3, 0.7], [0.5, 0.1, 0.2, -0.4]])
    for lock in (None, (("b", 0.5),)):
        arm = solver(task, lock) if task == "position" else None
        if arm is None:
            ball = pk.Chain.from_space([screw.revolute(axis, [0, 0, 0]) for axis in np.eye(3)[[0, 1, 2, 0]]], np.eye(4),
                            joint_names=list("abcd"))  # fmt: skip
            arm = make_problem(
                ball.compile(), Settings(task, None, True, 1e-9, 1e-9, lock, None, 5, 30, 0, False)
            )
        J = arm.fast.chain.jacobian(q, "hybrid")[:, rows]
        if lock:
            J[..., 1] = 0
        np.testing.assert_allclose(redundancy._jacobian(arm, q), J, atol=1e-14)
        expected = -0.5 * np.log(np.linalg.det(J @ J.swapaxes(1, 2)))
        value = redundancy.make_aim(arm, q, "manipulability").value(q)
        np.testing.assert_allclose(value, expected, atol=1e-12)


def planar(*points):
    axes = [screw.revolute([0, 0, 1.0], [x, 0, 0]) for x in points]
    return pk.Chain.from_space(axes, pk.se3.exp([0, 0, 0, 1.2, 0, 0]))


def in_the_plane(arm, q, rows):
    J = arm.jacobian(q, "hybrid")[rows]
    return np.sqrt(np.linalg.det(J @ J.T))


@pytest.mark.parametrize("task, points, rows", [
    ("pose", (0.0, 0.4, 0.7, 1.0), [2, 3, 4]), ("planar", (0.0, 0.4, 0.7, 1.0), [2, 3, 4]),
    ("position", (0.0, 0.5, 0.9), [3, 4]), ("direction", (0.0, 0.5, 0.9), [3, 4]),
])  # fmt: skip
def test_the_manipulability_of_an_arm_in_a_plane_is_that_of_its_plane(task, points, rows):
    arm = planar(*points)
    q0 = np.array([0.3, 0.9, -0.4, 0.7][: len(points)])
    asked = Settings(task, None, True, 1e-9, 1e-9, None, None, 5, 30, 0, False)
    problem = make_problem(arm.compile(), asked)
    value = redundancy.make_aim(problem, q0[None], "manipulability").value(q0[None])
    np.testing.assert_allclose(value, -np.log(in_the_plane(arm, q0, rows)), rtol=1e-9)
    found = ik(arm, arm.fk(q0), task=task, q0=q0, secondary_objective="manipulability")
    assert found.success
    # at the best there is, no motion that the task leaves free changes it
    spare = np.linalg.svd(arm.jacobian(found.q, "hybrid")[rows])[2][-1]
    up, down = (in_the_plane(arm, found.q + s * spare, rows) for s in (1e-4, -1e-4))
    assert in_the_plane(arm, found.q, rows) > 1.01 * in_the_plane(arm, q0, rows)
    assert abs(up - down) / 2e-4 < 2e-3


@pytest.mark.parametrize("elbow, steep", [(1.4, False), (0.05, True)])
def test_the_way_to_more_manipulability_is_along_its_gradient_and_of_size_1_at_most(elbow, steep):
    asked = Settings("position", None, True, 1e-9, 1e-9, None, None, 5, 30, 0, False)
    aim = redundancy.Aim(make_problem(planar(0.0, 0.5, 0.9).compile(), asked))
    q = np.array([[0.3, elbow, elbow]])
    h = 1e-5 * np.eye(3)
    gradient = np.array([aim.value(q + e)[0] - aim.value(q - e)[0] for e in h]) / 2e-5
    size = np.linalg.norm(gradient)
    assert (size > 1) == steep
    np.testing.assert_allclose(aim._way(q)[0], -gradient / max(size, 1.0), rtol=1e-4, atol=1e-7)


def test_no_step_to_more_manipulability_is_longer_than_half_a_radian():
    asked = Settings("position", None, True, 1e-9, 1e-9, None, None, 5, 30, 0, False)
    aim = redundancy.Aim(make_problem(planar(0.0, 0.5, 0.9).compile(), asked))
    q = np.array([[0.3, 1.4, 1.4]] * 3)
    steps = aim.moved(q, np.array([1e-3, 2e-3, 1e3])) - q
    spare = np.linalg.svd(redundancy._jacobian(aim.problem, q)[0])[2][2]
    np.testing.assert_allclose(steps[0], 1e-3 * spare * (spare @ aim._way(q)[0]), atol=1e-12)
    short, double, longest = np.linalg.norm(steps, axis=1)
    np.testing.assert_allclose([double / short, longest], [2, 0.5], rtol=1e-9)
    np.testing.assert_allclose(steps[2], 0.5 * steps[0] / short, rtol=1e-9)


def test_the_manipulability_of_a_panda_is_the_most_along_its_self_motion():
    arm = pk.load("panda").chain(tip="panda_link8")
    q0 = np.array([-2.5, 1.3, 0.8, -2.6, 0, 0.3, 0.6])
    T = arm.fk(q0)
    found = ik(arm, T, q0=q0, secondary_objective="manipulability")
    q, best = found.q, 0.0
    for way in (1, -1):
        # along the self-motion, a hundredth of a radian at a time
        q, last = found.q, way * np.linalg.svd(arm.jacobian(found.q, "hybrid"))[2][-1]
        for _ in range(150):
            spare = np.linalg.svd(arm.jacobian(q, "hybrid"))[2][-1]
            last = spare * np.sign(spare @ last)
            q0 = np.clip(q + 0.01 * last, *arm.limits.T)
            there = ik(arm, T, q0=q0, restarts=0)
            if not there.success:
                break
            q = there.q
            best = max(best, pk.manipulability(arm, q).pose.yoshikawa)
    assert pk.manipulability(arm, found.q).pose.yoshikawa >= 0.999 * best > 0.0


def test_an_arm_without_a_motion_of_the_task_stays_where_it_is():
    slides = pk.Chain.from_space([screw.prismatic(way) for way in np.eye(3)], np.eye(4))
    q0 = [0.1, 0.2, 0.3]
    found = ik(slides, np.eye(4), task="rotation", q0=q0, secondary_objective="manipulability")
    assert found.success
    np.testing.assert_array_equal(found.q, q0)


def test_a_move_leaves_the_task_to_first_order_and_goes_down_the_aim_within_the_limits():
    arm, q = solver(), np.array([[2.5, 0.2, 0.3, 0.7]])
    moved = redundancy.Aim(arm, q + 0.3).moved(q, np.array([0.5]))
    J = arm.fast.chain.jacobian(q[0], "hybrid")[3:]
    way = (moved - q)[0]
    np.testing.assert_allclose(J @ way, 0, atol=1e-12)
    spare = np.linalg.svd(J)[2][-1]
    np.testing.assert_allclose(way, 0.5 * spare * (spare @ np.full(4, 0.3)), atol=1e-12)
    held = redundancy.Aim(solver(lock=(("a", 2.5),)), q + 5).moved(q, np.array([1.0]))
    assert held[0, 0] == 2.5
    far = redundancy.Aim(arm, q + 50).moved(q, np.array([1.0]))
    assert ((far >= arm.domain.limits[:, 0]) & (far <= arm.domain.limits[:, 1])).all()


@pytest.mark.parametrize("aim, q0, words", [
    ("best", None, r"^secondary_objective: expected 'middle', 'nearest' or 'manipulability', got 'best'$"),
    (3, None, r"^secondary_objective: expected 'middle', 'nearest' or 'manipulability', got 3$"),
    ("nearest", None, r"^secondary_objective: 'nearest' needs q0, what to be near to$"),
])  # fmt: skip
def test_what_is_no_aim_is_told(aim, q0, words):
    with pytest.raises(InputError, match=words):
        redundancy.check_objective(aim, q0)
    redundancy.check_objective("nearest", [0])
    redundancy.check_objective("middle", None)
    redundancy.check_objective(None, None)


def test_an_aim_is_served_in_25_steps_that_double_after_a_better_one_and_halve_after_others(
    monkeypatch,
):
    moves, asked = [], []

    def moved(aim, q, step):
        moves.append((q.copy(), step.copy()))
        return q + 1.0

    def solve(targets, numbers, q0, *, restarts):
        asked.append((len(targets), numbers.tolist(), restarts))
        info = np.zeros((len(targets), codes.INFO))
        info[:, codes.AT_STATE] = [codes.SOLVED, codes.SOLVED, codes.STALLED]
        return q0, info

    # the first target gets better twice and then as good, the second worse, the third better but is
    # not solved
    values = iter([[9.0, 9, 9], [8, 9.5, 1], [7, 9, 1], *[[7.0, 10, 1]] * 30])
    monkeypatch.setattr(redundancy.Aim, "moved", moved)
    monkeypatch.setattr(redundancy.Aim, "value", lambda *_: np.array(next(values)))
    q = np.zeros((3, 2))
    stub: Any = SimpleNamespace(solve=solve, domain=SimpleNamespace(wrapped=lambda q, near: q))
    found = redundancy.optimise(stub, np.zeros((3, 4, 4)), q, np.full((3, 2), np.nan), "nearest")
    assert asked == [(3, [0, 1, 2], 0)] * 25
    assert found.tolist() == [[2, 2], [0, 0], [0, 0]]
    assert not q.any()
    steps = np.array([step for _, step in moves])
    np.testing.assert_allclose(steps[:, 0], [0.5, 1, *(2 * 0.5**k for k in range(23))])
    np.testing.assert_allclose(steps[:, 1:], 0.5 * 0.5 ** np.arange(25.0)[:, None] * [1, 1])


def test_of_bad_targets_nothing_is_asked_and_others_begin_whole_turns_nearer(monkeypatch):
    asked = []

    def solve(targets, numbers, q0, *, restarts):
        asked.append(targets[:, 0, 0].tolist())
        return q0, np.zeros((len(targets), codes.INFO))

    monkeypatch.setattr(redundancy.Aim, "moved", lambda aim, q, *_: q - 1.0)
    monkeypatch.setattr(redundancy.Aim, "value", lambda aim, q: q[:, 0])
    q, T = np.array([[5.0], [np.nan], [7.0]]), np.arange(3.0)[:, None, None] * np.ones((3, 4, 4))
    stub: Any = SimpleNamespace(
        solve=solve, domain=SimpleNamespace(wrapped=lambda q, near: q - 6.0)
    )
    found = redundancy.optimise(stub, T, q, q, "nearest")
    np.testing.assert_array_equal(found, [[-26], [np.nan], [-24]])
    assert asked == [[0, 2]] * 25
