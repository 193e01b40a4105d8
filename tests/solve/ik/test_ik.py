"""Inverse kinematics: solved means solved, and where it is not, the reason is the right one."""

import warnings
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import InputError, PoekinWarning, PoseError, ShapeError, UnknownName
from poekin.model import screw
from poekin.solve.ik.ik import ik
from poekin.solve.ik.ik_problem import STEPS, IKProblem, Settings, make_problem
from poekin.solve.ik.joint_domain import make_joint_domain
from poekin.solve.ik.solution import REASONS
from poekin.solve.ik_all.ik_all import ik_all
from poekin.solve.joint_units import joint_units
from poekin.solve.path.follow import follow
from poekin.testing.strategies import chain_strategies

PANDA = pk.load("panda").chain(tip="panda_hand")
UR5 = pk.load("ur5").chain()
PUMA = pk.load("puma560").chain()
ARMS = {"panda": PANDA, "ur5": UR5, "puma560": PUMA}
TOLERANCE = 1e-9


def true_errors(chain, q, T):
    """|p* - p| and the angle between, by numpy alone."""
    found = chain.fk(q)
    position = np.linalg.norm(found[..., :3, 3] - T[..., :3, 3], axis=-1)
    # |R - S|_F = 2 sqrt(2) sin(angle / 2)
    chord = np.linalg.norm(found[..., :3, :3] - T[..., :3, :3], axis=(-2, -1)) / (2 * np.sqrt(2))
    return position, 2 * np.arcsin(np.minimum(chord, 1))


def within(chain, q):
    lower, upper = chain.limits.T
    return ((q >= lower) & (q <= upper)).all(axis=-1)


@pytest.mark.parametrize("name", ARMS)
def test_reachable_poses_are_solved_within_limits_to_the_tolerance(name):
    arm = ARMS[name]
    T = arm.fk(arm.random(11, 1000))
    found = ik(arm, T, seed=1)
    # a pose in thousands may need more than 100 restarts
    assert found.success.mean() >= 0.998
    position, rotation = true_errors(arm, found.q[found.success], T[found.success])
    # what the check itself rounds
    assert max(position.max(), rotation.max()) <= TOLERANCE + 1e-14
    assert within(arm, found.q).all()
    assert set(found.reason[found.success]) == {"solved"}
    easy = ik(arm, T[found.success][:5], seed=1)
    assert easy.success.all()
    assert (easy.distance_beyond_reach == 0).all()


@settings(max_examples=max(settings().max_examples // 10, 5))
@given(st.data())
def test_success_is_never_claimed_beyond_the_tolerance(data):
    chain = data.draw(chain_strategies.chains(min_joints=6, max_joints=8, coupled=False))
    T = chain.fk(data.draw(chain_strategies.coordinates(chain, (3,))))
    T[1, :3, 3] += data.draw(st.sampled_from([0.0, 1e-8, 0.5, 100.0]))
    tolerance = data.draw(st.sampled_from([1e-9, 1e-5]))
    found = ik(chain, T, restarts=2, iterations=20, tol_position=tolerance, tol_rotation=tolerance)
    position, rotation = true_errors(chain, found.q, T)
    # for arms of some metres, lengths in micrometres and up
    rounding = 1e-13 * chain.reach * (1 + np.abs(found.q).max())
    assert (position[found.success] <= tolerance + rounding).all()
    assert (rotation[found.success] <= tolerance + rounding).all()
    np.testing.assert_allclose(found.position_error, position, rtol=0, atol=rounding)
    np.testing.assert_allclose(
        found.rotation_error, rotation, rtol=0, atol=1e-7
    )  # the chord's own digits near pi


@pytest.mark.parametrize("axis", [3, 0])
@pytest.mark.parametrize("off, held", [(0.9e-9, True), (1.1e-9, False), (1e-7, False)])
def test_the_judgement_is_by_the_tolerance_itself(axis, off, held):
    settings = Settings("pose", None, True, TOLERANCE, TOLERANCE, None, None, 0, 1, 0, False)
    q = UR5.random(9, 20)
    T = UR5.fk(q) @ pk.se3.exp(np.eye(6)[axis] * off)
    errors, success = make_problem(UR5.compile(), settings).pose_errors(T, q)
    assert (success == held).all()
    np.testing.assert_allclose(errors[:, 0 if axis == 3 else 1], off, rtol=0, atol=1e-14)


def test_the_same_seed_gives_the_same_result_and_another_one_another():
    T = PANDA.fk(PANDA.random(3, 50))
    a, b, c = (ik(PANDA, T, seed=seed).q for seed in (5, 5, 6))
    np.testing.assert_array_equal(a, b)
    assert np.abs(a - c).max() > 0.1
    np.testing.assert_array_equal(ik(PANDA, T, seed=5, parallel=True).q, a)


def test_a_target_s_result_does_not_depend_on_its_batch_s_shape():
    T = PANDA.fk(PANDA.random(3, 6))
    flat, square = ik(PANDA, T), ik(PANDA, T.reshape(2, 3, 4, 4))
    np.testing.assert_array_equal(square.q.reshape(6, 7), flat.q)
    assert square.success.shape == (2, 3)
    assert square.summary(1, 2) == flat.summary(5)
    one = ik(PANDA, T[0])
    assert one.q.shape == (7,)
    assert one.success.shape == ()
    np.testing.assert_array_equal(one.q, flat.q[0])


@pytest.mark.parametrize("task", ["pose", "position", "rotation", "direction"])
@pytest.mark.parametrize("start", [None, "near", "beyond"])
def test_one_target_is_solved_as_a_batch_of_one(task, start):
    free = UR5.replace(limits=np.tile([-np.inf, np.inf], (6, 1)))
    for arm in (PANDA, UR5, free):
        for q in arm.random(8, 6):
            q0 = None if start is None else q + {"near": 0.05, "beyond": 9.0}[start]
            lock = {arm.q_names[1]: float(q[1])} if start == "near" else None
            options: dict[str, Any] = {"task": task, "lock": lock}
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", pk.PoekinWarning)
                one = ik(arm, arm.fk(q), q0=q0, **options)
                many = ik(arm, arm.fk(q)[None], q0=q0, **options)
            for name in ("q", "success", "reason", "iterations", "restarts"):
                np.testing.assert_array_equal(getattr(one, name), getattr(many, name)[0])
                assert getattr(one, name).dtype == getattr(many, name).dtype
            for name in ("position_error", "rotation_error", "distance_beyond_reach"):
                assert getattr(one, name) == pytest.approx(getattr(many, name)[0], abs=1e-14)
            assert one.success.shape == one.reason.shape == ()


def test_without_a_start_it_begins_near_the_middle_of_the_limits():
    T = PANDA.fk(PANDA.random(4, 200))
    middle = PANDA.limits.mean(axis=1)
    found = ik(PANDA, T, restarts=0)
    beside = 0.02 * np.diff(PANDA.limits)[:, 0] * [1, -1, 1, -1, 1, -1, 1]
    np.testing.assert_array_equal(found.q, ik(PANDA, T, q0=middle + beside, restarts=0).q)
    anywhere = ik(PANDA, T, q0=PANDA.random(5, 200), restarts=0)
    assert found.success.sum() > 1.3 * anywhere.success.sum()

    def distance(solution):
        return np.median(np.linalg.norm(solution.q - middle, axis=1)[solution.success])

    assert distance(found) < distance(anywhere)


def test_the_first_try_reaches_straight_inwards():
    joints = [pk.screw.revolute([0, 0, 1], [x, 0, 0]) for x in (0.0, 0.5)]
    planar = pk.Chain.from_space(joints, pk.se3.exp([0, 0, 0, 1, 0, 0]))
    target = pk.se3.exp([0, 0, 0, 0.6, 0, 0])
    assert ik(planar, target, task="position", restarts=0).success
    # where it is stretched no joint moves it inwards
    assert not ik(planar, target, task="position", q0=np.zeros(2), restarts=0).success


def test_it_starts_at_q0():
    q = PANDA.random(4, 20)
    found = ik(PANDA, PANDA.fk(q), q0=q)
    assert found.success.all()
    assert (found.iterations == 0).all()
    np.testing.assert_array_equal(found.q, q)
    near = ik(PANDA, PANDA.fk(q), q0=q + 1e-3)
    # seven joints for six numbers: not the same, but near
    assert np.abs(near.q - q).max() < 0.1


def test_an_arm_beyond_its_reach_says_by_how_much():
    T = np.eye(4)
    T[0, 3] = 5.0
    found = ik(UR5, T)
    assert not found.success
    assert found.reason == "unreachable"
    # the links' lengths and offsets laid out end to end
    longest = np.linalg.norm(UR5.local.frames[1:, :3, 3], axis=1).sum()
    assert found.distance_beyond_reach == pytest.approx(
        np.linalg.norm(T[:3, 3] - UR5.local.frames[0][:3, 3]) - longest, rel=1e-9
    )
    assert "farther than the arm's reach by" in found.summary()
    assert f"{1e3 * found.position_error:.4g} mm" in found.summary()


@pytest.mark.parametrize("name", ARMS)
def test_no_pose_of_the_arm_is_beyond_its_reach(name):
    arm = ARMS[name]
    assert (
        ik(arm, arm.fk(arm.random(0, 300)), restarts=0, iterations=1).distance_beyond_reach == 0
    ).all()


def test_the_reach_of_a_slide_begins_at_its_offset():
    axes = [screw.prismatic(axis) for axis in np.eye(3)]
    gantry = pk.Chain.from_space(axes, np.eye(4), offset=[5.0, 0.0, -3.0], limits=[[-1, 1]] * 3)
    T = gantry.fk(gantry.random(0, 50))
    assert (
        ik(gantry, T, task="position", restarts=0, iterations=1).distance_beyond_reach == 0
    ).all()
    far = np.eye(4)
    far[0, 3] = (
        5.0 + 3.0 + 3.0 + 0.5
    )  # all slides and offsets one after the other, and half a metre
    for iterations in (1, 30):
        found = ik(gantry, far, task="position", iterations=iterations)
        assert found.distance_beyond_reach == pytest.approx(0.5, abs=1e-9)
        assert found.reason == "unreachable"


def test_limits_that_are_in_the_way_are_named():
    q = np.array([0.3, -0.5, 0.2, -1.5, 0.4, 1.0, 0.1])
    limits = np.stack([q - 0.2, q + 0.2], axis=1)
    arm = pk.Chain.from_space(
        PANDA.screws, PANDA.home, limits=limits, joint_names=PANDA.joint_names
    )
    q_far = q.copy()
    q_far[3] -= 1.0
    found = ik(arm, PANDA.fk(q_far))
    assert found.reason == "limits"
    assert within(arm, found.q)
    assert found.limits_hit[0]
    at = np.abs(found.q[:, None] - arm.limits).min(axis=1) <= 1e-9
    assert found.limits_hit[0] == tuple(np.array(PANDA.joint_names)[at])
    assert all(name in found.summary() for name in found.limits_hit[0])
    assert ik(arm, PANDA.fk(q_far), limits=False).success


def test_who_says_limits_names_them():
    tight = pk.Chain.from_space(
        UR5.screws, UR5.home, limits=np.tile([-1.5, 1.0], (6, 1)), joint_names=UR5.joint_names
    )
    found = ik(tight, UR5.fk(UR5.random(1, 200)), restarts=3)
    assert (found.reason == "limits").sum() > 100
    for reason, names in zip(found.reason, found.limits_hit, strict=True):
        assert bool(names) == (reason == "limits")
    assert within(tight, found.q).all()


def test_nan_in_one_target_is_nan_in_its_solution_only():
    T = PANDA.fk(PANDA.random(0, 3))
    T[1, 0, 3] = np.nan
    found = ik(PANDA, T)
    assert found.success.tolist() == [True, False, True]
    assert found.reason[1] == "bad target"
    assert np.isnan(found.q[1]).all()
    assert found.distance_beyond_reach[1] == 0
    assert "finite" in found.summary(1)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("at", [(0, 0), (1, 2), (0, 3), (2, 3), (3, 0), (3, 3)])
def test_a_target_that_is_not_finite_is_its_own_affair(at, bad):
    T = UR5.fk(UR5.random(0, 3))
    expected, every = ik(UR5, T).q, ik_all(UR5, T, limits=False).counts
    T[1][at] = bad
    found = ik(UR5, T)
    assert found.reason.tolist() == ["solved", "bad target", "solved"]
    np.testing.assert_array_equal(found.q[[0, 2]], expected[[0, 2]])
    assert np.isnan(found.q[1]).all()
    assert ik(UR5, T[1]).reason == "bad target"
    assert ik_all(UR5, T, limits=False).counts.tolist() == [every[0], 0, every[2]]
    assert follow(UR5, T).reason.tolist()[1] == "bad target"
    T[2, 0, 0] += 0.5
    with pytest.raises(PoseError, match=r"T\[2\] is no pose"):
        ik(UR5, T)


def test_a_target_that_is_no_pose_is_named():
    T = UR5.fk(UR5.random(0, 3))
    T[2, 0, 0] += 0.1
    with pytest.raises(PoseError, match=r"T\[2\] is no pose: its rotation misses orthonormality"):
        ik(UR5, T)


def test_an_empty_batch_is_an_empty_solution():
    found = ik(UR5, np.empty((0, 4, 4)))
    assert found.q.shape == (0, 6)
    assert found.success.shape == (0,)


@pytest.mark.parametrize("task", ["position", "rotation", "direction"])
def test_a_part_of_the_pose_is_enough_for_its_task(task):
    T = UR5.fk(UR5.random(5, 100))
    axis = [1.0, 2.0, -2.0] if task == "direction" else None
    found = ik(UR5, T, task=task, axis=axis)
    assert found.success.all()
    got = UR5.fk(found.q)
    if task != "rotation":
        assert np.abs(got[:, :3, 3] - T[:, :3, 3]).max() <= TOLERANCE
    if task == "rotation":
        assert true_errors(UR5, found.q, T)[1].max() <= TOLERANCE + 1e-14
    if task == "direction":
        a = np.array(axis) / 3
        assert np.abs(got[:, :3, :3] @ a - T[:, :3, :3] @ a).max() <= TOLERANCE + 1e-14
    assert true_errors(UR5, found.q, T)[1 if task != "rotation" else 0].max() > 0.01


def test_locked_coordinates_stay():
    q = PANDA.random(8, 20)
    found = ik(PANDA, PANDA.fk(q), lock={"panda_joint3": 0.25}, q0=q)
    assert (found.q[:, 2] == 0.25).all()
    assert found.success.mean() > 0.5
    few = ik(PANDA, PANDA.fk(q[0]), lock={"panda_joint3": 0.25, "panda_joint5": 0.0})
    assert (few.q[[2, 4]] == [0.25, 0.0]).all()
    assert few.reason == "unreachable"
    assert "position" in few.reachable_tasks[0]
    with pytest.raises(
        InputError,
        match=r"^expected an arm with a coordinate that may move, the chain has all of them locked$",
    ):
        ik(PANDA, PANDA.fk(q), lock=dict.fromkeys(PANDA.q_names, 0.0) | {"panda_joint4": -1.0})
    with pytest.raises(
        InputError, match=r"^expected an arm with a coordinate that may move, the chain has none$"
    ):
        ik(pk.Chain.from_space([], np.eye(4)), np.eye(4))
    with pytest.raises(UnknownName, match="no coordinate 'joint3'; did you mean"):
        ik(PANDA, PANDA.fk(q), lock={"joint3": 0.25})
    with pytest.raises(InputError, match="'panda_joint3': expected a number within"):
        ik(PANDA, PANDA.fk(q), lock={"panda_joint3": 9.0})
    with pytest.raises(InputError, match=r"lock: 'panda_joint3': expected a number .*, got True$"):
        ik(PANDA, PANDA.fk(q), lock={"panda_joint3": True})


def test_the_solution_nearest_to_a_configuration_is_found():
    q = UR5.random(2, 30)
    q[:, 4] = np.where(
        np.abs(np.sin(q[:, 4])) < 0.2, 1.0, q[:, 4]
    )  # away from the wrist's singularity
    q[:, 2] = np.where(np.abs(np.sin(q[:, 2])) < 0.2, 1.0, q[:, 2])
    found = ik(UR5, UR5.fk(q), nearest_to=q + 0.02)
    assert np.abs(found.q - q).max() < 1e-6
    assert not found.iterations.any(), "it is one of all, which is no search"
    found = ik(UR5, UR5.fk(q), nearest_to=q + 0.02, task="direction")
    assert (found.iterations > 48).all(), "those of all the tries"


@pytest.mark.parametrize("aim", ["middle", "nearest", "manipulability"])
def test_joints_to_spare_serve_the_aim(aim):
    q, q0 = PANDA.random(6, 10), PANDA.random(7, 10)
    T, middle = PANDA.fk(q), PANDA.limits.mean(axis=1)

    def cost(q):
        if aim == "manipulability":
            return -np.linalg.slogdet(
                np.einsum("kij,klj->kil", *(2 * [PANDA.jacobian(q, "space")]))
            )[1]
        return np.linalg.norm(q - (q0 if aim == "nearest" else middle), axis=1)

    plain, served = ik(PANDA, T, q0=q0), ik(PANDA, T, q0=q0, secondary_objective=aim)
    assert served.success.all()
    assert (cost(served.q) <= cost(plain.q) + 1e-6).all()
    assert cost(served.q).mean() < cost(plain.q).mean() - 0.05
    assert within(PANDA, served.q).all()


def test_q0_outside_the_limits_is_moved_with_a_warning_that_names_the_joints():
    q0 = np.zeros(7)
    with pytest.warns(PoekinWarning, match="q0 is outside the limits of 'panda_joint4'"):
        found = ik(PANDA, PANDA.fk(PANDA.random(0)), q0=q0)
    assert found.success


def test_coupled_and_helical_and_sliding_joints_are_solved():
    z, rng = [0.0, 0.0, 1.0], np.random.default_rng(0)
    joints = [screw.revolute(z, [0, 0, 0]), screw.prismatic([0, 1, 0]), screw.helical([1, 0, 0], [0, 0, 0.3], 0.1),
              screw.revolute([0, 1, 0], [0.4, 0, 0.3]), screw.revolute(z, [0.5, 0.1, 0.3]),
              screw.revolute([1, 0, 0], [0, 0.1, 0.6]), screw.revolute([0, 1, 0], [0.6, 0, 0.6])]  # fmt: skip
    C = np.eye(7)[:, :6]
    C[6, 3] = -0.5
    chain = pk.Chain.from_space(joints, pk.se3.exp([0.1, 0.2, 0.3, 0.5, 0, 0.8]), coupling=C, q_names=list("abcdef"),
                     limits=[[-2, 2], [-0.5, 0.5], [-2, 2], [-2, 2], [-2, 2], [-2, 2]])  # fmt: skip
    T = chain.fk(chain.random(rng, 200))
    found = ik(chain, T)
    assert found.success.mean() > 0.95
    assert within(chain, found.q).all()
    assert (
        max(e.max() for e in true_errors(chain, found.q[found.success], T[found.success]))
        <= 1e-9 + 1e-14
    )


def test_coordinates_without_limits_come_within_a_turn():
    arm = pk.Chain.from_space(PUMA.screws, PUMA.home)
    found = ik(arm, arm.fk(arm.random(0, 200)))
    assert np.abs(found.q).max() <= np.pi + 1e-12


@pytest.mark.parametrize("options, error, message", [
    ({"task": "pos"}, InputError, "task: expected 'pose', 'position', .* or 'planar', got 'pos'"),
    ({"axis": [0, 0, 1]}, InputError, "axis: only the task 'direction'"),
    ({"task": "direction", "axis": [0, 0, 0]}, InputError, "axis: expected a direction"),
    ({"tol_position": 0}, InputError, "tol_position: expected a positive number, got 0"),
    ({"tol_rotation": "1e-9"}, InputError, "tol_rotation: expected a positive number"),
    ({"restarts": -1}, InputError, "restarts: expected a whole number from 0 on, got -1"),
    ({"iterations": 0}, InputError, "iterations: expected a whole number from 1 on"),
    ({"seed": 1.5}, InputError, "seed: expected a whole number"),
    ({"limits": "no"}, InputError, "limits: expected True or False, got 'no'"),
    ({"weights": [1, 2]}, ShapeError, r"weights: expected shape \(..., 6\)"),
    ({"weights": [1, 1, 1, 1, 1, 0]}, InputError, "weights: expected six positive numbers"),
    ({"secondary_objective": "top"}, InputError,
     "secondary_objective: expected 'middle', 'nearest' or 'manipulability', got 'top'"),
    ({"secondary_objective": "nearest"}, InputError, "'nearest' needs q0"),
    ({"q0": [0, 0]}, ShapeError, "q0: expected 7 coordinates"),
    ({"q0": np.zeros((3, 7))}, ShapeError, r"q0: shape \(3, 7\) does not fit"),
    ({"lock": ["panda_joint1"]}, InputError, "lock: expected a dict"),
    ({"lock": ("panda_joint1", 0.5)}, InputError, "lock: expected a dict"),
], ids=lambda v: str(v) if isinstance(v, dict) else "")  # fmt: skip
def test_mistakes_are_told(options, error, message):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PoekinWarning)
        with pytest.raises(error, match=message):
            ik(PANDA, PANDA.home, **options)


def test_what_is_no_arm_is_told():
    with pytest.raises(InputError, match=r"^chain: expected a Chain, as .* makes it, got 'panda'"):
        ik("panda", np.eye(4))  # pyright: ignore[reportArgumentType]


def test_progress_and_words():
    told = []
    found = ik(
        UR5, UR5.fk(UR5.random(0, 30)), progress=lambda done, total: told.append((done, total))
    )
    assert told == [(30, 30)]
    assert repr(found) == "<Solution 30 of 30 solved>"
    assert found.summary(0).startswith("solved: ")
    assert found.summary() == str(found) == "30 of 30 solved"
    with pytest.raises(ShapeError, match="summary: expected an index of 1 numbers, got 2"):
        found.summary(0, 0)
    assert REASONS == ("solved", "unreachable", "limits", "iterations", "bad target")


def upright(n):
    """n joints with vertical axes, 0.2 m apart: the tool's z axis is up for good."""
    home = np.eye(4)
    home[0, 3] = 0.2 * n
    return pk.Chain.from_space(
        [screw.revolute([0.0, 0.0, 1.0], [0.2 * k, 0, 0]) for k in range(n)], home
    )


def test_a_tool_that_points_the_opposite_way_is_not_taken_for_solved():
    arm = upright(5)
    T = arm.fk(arm.random(0, 20))
    T[:, :3, :3] @= np.diag([1.0, -1.0, -1.0])
    found = ik(arm, T, task="direction", restarts=3)
    assert not found.success.any()
    np.testing.assert_allclose(found.rotation_error, np.pi, rtol=0, atol=1e-12)


def test_from_the_opposite_direction_a_tool_is_turned_over():
    q = UR5.random(5, 20)
    T = UR5.fk(q)
    T[:, :3, :3] @= np.diag([1.0, -1.0, -1.0])
    found = ik(UR5, T, task="direction", q0=q, restarts=0)
    assert found.success.mean() > 0.5  # not all can be reached so
    z = UR5.fk(found.q)[:, :3, 2]
    np.testing.assert_allclose(z[found.success], T[found.success, :3, 2], rtol=0, atol=2e-9)


@pytest.mark.parametrize("size", [1e200, 1e-200])
def test_a_direction_may_be_of_any_length(size):
    T, options = UR5.fk(UR5.random(0, 5)), {"task": "direction", "seed": 3}
    np.testing.assert_array_equal(
        ik(UR5, T, axis=[3 * size, 0, 4 * size], **options).q,
        ik(UR5, T, axis=[3, 0, 4], **options).q,
    )


def test_targets_may_be_read_only_or_without_alignment():
    T = UR5.fk(UR5.random(0, 3))
    expected = ik(UR5, T).q
    frozen = T.copy()
    frozen.flags.writeable = False
    crooked = np.frombuffer(b"\0" + T.tobytes(), np.float64, offset=1).reshape(T.shape)
    for form in (frozen, crooked, np.asfortranarray(T), T.tolist()):
        np.testing.assert_array_equal(ik(UR5, form).q, expected)
    assert ik(UR5, UR5.home).success


@pytest.mark.parametrize("aim", ["middle", "nearest", "manipulability"])
def test_an_aim_leaves_bad_targets_alone(aim):
    q = PANDA.random(0, 3)
    T, q0 = PANDA.fk(q), q + 0.1  # near: a restart draws by the place in the batch
    found = ik(
        PANDA, np.where(np.arange(3)[:, None, None] == 1, np.nan, T), secondary_objective=aim, q0=q0
    )
    assert found.reason.tolist() == ["solved", "bad target", "solved"]
    # as many as are good: BLAS may round a matrix by where it lies in memory
    others = ik(PANDA, T[[0, 2]], secondary_objective=aim, q0=q0[[0, 2]])
    np.testing.assert_array_equal(found.q[[0, 2]], others.q)


@pytest.mark.parametrize("aim", ["middle", "nearest", "manipulability"])
def test_an_aim_moves_no_locked_coordinate(aim):
    T = PANDA.fk(PANDA.random(3, 20))
    found = ik(
        PANDA,
        T,
        task="position",
        secondary_objective=aim,
        lock={"panda_joint3": 0.5},
        q0=PANDA.random(1),
    )
    assert found.success.all()
    assert (found.q[:, 2] == 0.5).all()


def test_a_direction_leaves_the_turn_about_it_to_the_aim():
    arm, q0 = UR5.retooled(pk.se3.exp([0.5, 0.3, 0, 0, 0, 0])), UR5.random(4, 50)
    T, middle = arm.fk(arm.random(3, 50)), arm.limits.mean(axis=1)
    plain, served = (
        ik(arm, T, task="direction", q0=q0),
        ik(arm, T, task="direction", q0=q0, secondary_objective="middle"),
    )
    assert served.success.all()
    far = [np.linalg.norm(found.q - middle, axis=1) for found in (plain, served)]
    assert far[1].mean() < far[0].mean() - 0.5


def test_an_arm_of_few_joints_improves_the_manipulability_of_its_position():
    y = [0.0, 1.0, 0.0]
    axes = [
        screw.revolute([0.0, 0.0, 1.0], [0, 0, 0]),
        *(screw.revolute(y, [x, 0, 0]) for x in (0, 0.4, 0.8)),
    ]
    arm = pk.Chain.from_space(axes, pk.se3.exp([0, 0, 0, 1.2, 0, 0]))
    q0 = arm.random(2, 50)
    T = arm.fk(arm.random(1, 50))
    plain, served = (
        ik(arm, T, task="position", q0=q0, secondary_objective=aim)
        for aim in (None, "manipulability")
    )
    assert served.success.all()
    w = [pk.manipulability(arm, found.q).translation.yoshikawa for found in (plain, served)]
    assert (w[1] >= w[0] * (1 - 1e-6)).all()
    assert w[1].mean() > 1.1 * w[0].mean()


@pytest.mark.parametrize("arm, tolerance", [(PANDA, 3e-16), (UR5, 1e-16)], ids=["panda", "ur5"])
def test_the_reason_is_solved_where_success_is_claimed_and_nowhere_else(arm, tolerance):
    found = ik(
        arm, arm.fk(arm.random(0, 300)), tol_position=tolerance, tol_rotation=tolerance, restarts=3
    )
    assert not found.success.all()
    np.testing.assert_array_equal(found.reason == "solved", found.success)


def test_weights_are_relative_to_each_other():
    T = UR5.fk(UR5.random(0, 50))
    assert ik(UR5, T, weights=np.full(6, 1e-12)).success.all()


def test_a_bad_nearest_to_is_named_and_q0_beside_it_is_looked_at():
    T = PANDA.home
    with pytest.raises(InputError, match="nearest_to: expected finite numbers"):
        ik(PANDA, T, nearest_to=np.full(7, np.nan))
    with pytest.raises(ShapeError, match=r"nearest_to: shape \(3, 7\) does not fit"):
        ik(PANDA, T, nearest_to=np.zeros((3, 7)))
    with pytest.raises(ShapeError, match="q0: expected 7 coordinates"):
        ik(PANDA, T, nearest_to=PANDA.random(0), q0=[1, 2])


def test_nearest_to_is_measured_from_where_it_is_said_outside_the_limits_too():
    arm = pk.Chain.from_space(UR5.screws, UR5.home, limits=[[-1.5, 4.5]] * 6)
    T, near = arm.fk(arm.random(5, 60)), np.full(6, -2.0)
    found, every = (
        ik(arm, T, nearest_to=near),
        ik_all(arm, T, method="search", all_revolutions=True),
    )
    least = np.array([np.linalg.norm(Q - near, axis=1).min() for Q in every.solutions])
    assert found.success.all()
    assert (np.linalg.norm(found.q - near, axis=1) <= least + 1e-6).all()


@pytest.mark.parametrize("arm", [UR5, PUMA], ids=["ur5", "puma560"])
def test_the_nearest_solution_is_the_nearest_of_all(arm):
    T, near = arm.fk(arm.random(5, 100)), arm.random(6, 100)
    every = ik_all(arm, T, method="search", all_revolutions=True)
    least = np.array(
        [np.linalg.norm(Q - n, axis=1).min() for Q, n in zip(every.solutions, near, strict=True)]
    )
    found = ik(arm, T, nearest_to=near)
    assert (np.linalg.norm(found.q - near, axis=1) <= least + 1e-6).all()


def test_turns_are_taken_off_to_the_nearest_place_within_the_limits():
    room = make_joint_domain(joint_units(UR5.compile()), None, True)  # ±2 pi
    np.testing.assert_allclose(
        room.wrapped(np.full((1, 6), -6.0), np.full((1, 6), 6.0)), 2 * np.pi - 6, rtol=0, atol=1e-14
    )
    arm = pk.Chain.from_space(UR5.screws, UR5.home, limits=[[-np.pi, 3.0]] * 6)
    narrow = make_joint_domain(joint_units(arm.compile()), None, True)
    np.testing.assert_allclose(
        narrow.wrapped(np.full((1, 6), 10.0), np.full((1, 6), 3.0)),
        10 - 4 * np.pi,
        rtol=0,
        atol=1e-14,
    )


def test_a_locked_coordinate_is_not_said_to_be_in_the_way():
    T = PANDA.fk(PANDA.random(3, 50))
    T[:, :3, 3] *= 1.25
    found = ik(PANDA, T, lock={"panda_joint1": PANDA.limits[0, 1]})
    named = {name for names in found.limits_hit for name in names}
    assert named
    assert "panda_joint1" not in named


def test_a_long_way_to_slide_is_gone():
    gantry = pk.Chain.from_space([screw.prismatic(axis) for axis in np.eye(3)], np.eye(4))
    far = [500.0, -300.0, 1000.0]
    np.testing.assert_allclose(
        ik(gantry, gantry.fk(far), task="position").q, far, rtol=0, atol=1e-9
    )
    rail = pk.Chain.from_space(
        np.vstack([screw.prismatic([1, 0, 0]), UR5.screws]),
        UR5.home,
        limits=[[0, 1000], *UR5.limits],
    )
    T = rail.fk(rail.random(0, 100))
    assert ik(rail, T, q0=np.zeros(7), restarts=20).success.all()


def test_an_element_is_named_from_the_end_too():
    found = ik(UR5, UR5.fk(UR5.random(0, 6)).reshape(2, 3, 4, 4))
    assert found.summary(-1, -2) == found.summary(1, 1)
    with pytest.raises(IndexError, match="out of bounds"):
        found.summary(2, 0)


@pytest.mark.parametrize("axis, error, message", [
    ([[0, 0, 1]], InputError, r"axis: expected a direction \(3,\)"),
    ([[0], 1], ShapeError, "axis: expected an array of numbers, got rows of different lengths"),
    ("z", InputError, "axis: expected real numbers"),
], ids=["rows", "ragged", "text"])  # fmt: skip
def test_an_axis_that_is_none_is_told(axis, error, message):
    with pytest.raises(error, match=message):
        ik(UR5, UR5.home, task="direction", axis=axis)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("size", [1.0, 500.0])
def test_long_arms_with_joints_to_spare_give_numbers(size, seed):
    rng, n = np.random.default_rng(seed), 7 + seed
    axes = [
        screw.revolute(np.eye(3)[rng.integers(3)], size * rng.integers(-1, 2, 3)) for _ in range(n)
    ]
    home = np.eye(4)
    home[:3, 3] = size * rng.integers(-2, 3, 3)
    arm = pk.Chain.from_space(axes, home, limits=np.tile([-1.0, 1.0], (n, 1)))
    T = arm.fk(arm.random(rng, 30))
    found = ik(arm, T, restarts=1)
    assert np.isfinite(found.q).all()
    assert np.isfinite(found.position_error + found.rotation_error).all()
    assert ik(arm, T).success.mean() >= 0.6


@pytest.mark.parametrize("options, message", [
    ({"limits": 1}, "limits: expected True or False, got 1"),
    ({"seed": False}, "seed: expected a whole number"),
    ({"parallel": 0}, "parallel: expected True or False, got 0"),
    ({"restarts": 100.0}, "restarts: expected a whole number"),
    ({"iterations": 30.0}, "iterations: expected a whole number"),
    ({"tol_position": True}, "tol_position: expected a positive number, got True"),
], ids=str)  # fmt: skip
def test_a_setting_that_is_none_is_told_after_its_equal_was_accepted(options, message):
    T = UR5.fk(UR5.random(0))
    assert ik(UR5, T).success
    ik(UR5, T, tol_position=1)
    with pytest.raises(InputError, match=message):
        ik(UR5, T, **options)


def test_a_setting_of_another_type_is_another_solver_and_the_same_result():
    T = UR5.fk(UR5.random(0))
    options: dict[str, Any] = {
        "restarts": np.int64(7),
        "limits": np.True_,
        "tol_position": np.float64(1e-9),
    }
    np.testing.assert_array_equal(ik(UR5, T, **options).q, ik(UR5, T, restarts=7).q)


@pytest.mark.parametrize("parallel", [False, True])
def test_an_interrupt_is_seen_between_some_of_many_targets(parallel, monkeypatch):
    T = np.tile(np.eye(4), (1000, 1, 1))
    T[:, 0, 3] = 5.0  # out of reach
    solver = make_problem(
        UR5.compile(), Settings("pose", None, True, 1e-9, 1e-9, None, None, 100, 30, 0, parallel)
    )
    whole, sizes = solver._solve.call, []

    def call(arm, targets, *arguments):
        sizes.append(len(targets))
        if len(sizes) == 3:
            raise KeyboardInterrupt
        whole(arm, targets, *arguments)

    monkeypatch.setattr(solver, "_solve", SimpleNamespace(call=call))
    with pytest.raises(KeyboardInterrupt):
        ik(UR5, T, parallel=parallel)
    assert max(sizes) * 101 * 30 <= STEPS  # of the most tries and iterations


@pytest.mark.parametrize("scale", [1.0, 100.0])
def test_the_nearest_solution_of_an_arm_without_limits_is_turns_away_from_zero(scale):
    arm = pk.Chain.from_space(
        UR5.screws,
        UR5.home,
        coupling=None if scale == 1 else np.eye(6) / scale,
        q_names=UR5.joint_names,
    )
    turns = np.array([2, -3, 1, 0, -1, 5])
    q = np.array([0.3, -1.1, 1.3, 0.4, 0.9, -0.2]) + 2 * np.pi * turns
    near = scale * (q + 0.01)
    found = ik(arm, arm.fk(scale * q), nearest_to=near)
    np.testing.assert_allclose(found.q, scale * q, rtol=0, atol=1e-6 * scale)
    assert np.abs(ik(arm, arm.fk(scale * q)).q).max() <= scale * np.pi + 1e-12


def test_the_manipulability_of_a_direction_is_that_of_its_five_numbers():
    arm, q0 = UR5.retooled(pk.se3.exp([0.5, 0.3, 0, 0, 0, 0.1])), UR5.random(4, 20)
    T = arm.fk(arm.random(3, 20))

    def yoshikawa(q):
        P, J = arm.fk_jacobian(q, "hybrid")
        tool = (
            np.swapaxes(P[:, :3, :3], 1, 2) @ J[:, :3]
        )  # turns about the tool's axes, of which x and y move its z
        five = np.concatenate([tool[:, :2], J[:, 3:]], axis=1)
        return np.sqrt(np.linalg.det(five @ np.swapaxes(five, 1, 2)))

    plain, served = (
        ik(arm, T, task="direction", q0=q0, secondary_objective=aim)
        for aim in (None, "manipulability")
    )
    assert served.success.all()
    assert (yoshikawa(served.q) >= yoshikawa(plain.q) * (1 - 1e-6)).all()
    assert yoshikawa(served.q).mean() > 1.1 * yoshikawa(plain.q).mean()


@pytest.mark.parametrize("task", ["position", "rotation"])
def test_a_wide_tolerance_is_kept_by_every_target_too(task):
    T = UR5.fk(UR5.random(12, 500))
    found = ik(UR5, T, task=task, tol_position=0.1, tol_rotation=0.1)
    assert found.success.all()
    # they end where they are good enough, not at rounding
    assert np.median(found.position_error + found.rotation_error) > 1e-3


@pytest.mark.parametrize("given", [True, False])
def test_the_first_try_for_the_nearest_begins_at_q0_or_else_at_what_is_to_be_near(
    given, monkeypatch
):
    q = UR5.random(2, 3)
    q0, near, begun, whole = q + 0.1, q - 0.2, [], IKProblem.solve

    def solve(self, targets, indices, q0, **options):
        begun.append(q0.copy())
        return whole(self, targets, indices, q0, **options)

    monkeypatch.setattr(IKProblem, "solve", solve)
    ik(UR5, UR5.fk(q), q0=q0 if given else None, nearest_to=near, task="direction")
    np.testing.assert_array_equal(begun[0], np.clip(q0 if given else near, *UR5.limits.T))
