"""follow: joints along a path of poses."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import InputError, PoseError, ShapeError, UnknownName
from poekin.solve import motion
from poekin.solve.ik.ik import ik
from poekin.solve.ik.ik_problem import Settings, make_problem
from poekin.solve.ik.least_error import slope_at
from poekin.solve.path import follower
from poekin.solve.path.follow import follow
from poekin.solve.path.path_result import NEAR_SINGULAR

TOL = 1e-9
PANDA_Q = np.array([0, -0.5, 0, -2.0, 0, 1.6, 0.8])
UR5_Q = np.array([0, -1.2, 1.6, -1.9, -1.57, 0])


@pytest.fixture(scope="module")
def panda():
    return pk.load("panda").chain(tip="panda_hand").compile()


@pytest.fixture(scope="module")
def ur5():
    return pk.load("ur5").chain().compile()


def planar(limits=None):  # type: ignore[no-untyped-def]
    """Two links of 1 m in a plane."""
    home = np.eye(4)
    home[0, 3] = 2
    axes = [pk.screw.revolute([0, 0, 1], [x, 0, 0]) for x in (0, 1)]
    slide = pk.screw.prismatic([0, 0, 1])
    return pk.Chain.from_space(
        [*axes, slide], home, joint_names=["shoulder", "elbow", "lift"], limits=limits
    )


def straight(arm, q, by, count):  # type: ignore[no-untyped-def]
    T_s0 = arm.fk(q)
    T_s1 = T_s0.copy()
    T_s1[:3, 3] += by
    return motion.line(T_s0, T_s1, np.linspace(0, 1, count))


def off(arm, q, T):  # type: ignore[no-untyped-def]
    """|p* - p| and the angle between, by the oracle of plain linear algebra: not what `follow`
    judges by.
    """
    P = arm.fk(q)
    angle = 2 * np.arcsin(
        np.minimum(np.linalg.norm(P[:, :3, :3] - T[:, :3, :3], axis=(1, 2)) / np.sqrt(8), 1)
    )
    return max(np.linalg.norm(P[:, :3, 3] - T[:, :3, 3], axis=1).max(), angle.max())


@pytest.mark.parametrize("given_q0", [False, True], ids=["free", "q0"])
@pytest.mark.parametrize(("name", "q"), [("panda", PANDA_Q), ("ur5", UR5_Q)], ids=["panda", "ur5"])
def test_a_straight_path_of_half_a_metre_is_followed_without_a_jump(name, q, given_q0, request):
    arm = request.getfixturevalue(name)
    T = straight(arm, q, [0, 0.25, 0], 1000)
    path = follow(arm, T, q0=q if given_q0 else None)
    assert path.ok
    assert path.branch_switches == ()
    assert path.largest_step == np.abs(np.diff(path.q, axis=0)).max() <= 0.1
    assert off(arm, path.q, T) <= TOL
    if given_q0:
        np.testing.assert_allclose(path.q[0], q, rtol=0, atol=1e-8)


@pytest.mark.parametrize("most, switches", [(0.02, (1,)), (0.1, ())])
def test_largest_steps_by_name_are_in_the_coordinates_own_unit_as_a_row_of_them_is(most, switches):
    radians = np.pi / 180
    arm = planar().replace(coupling=np.diag([radians, radians, 1.0]))
    q = np.array([[10, 40, 0], [30, 60, 0.0]])
    named = {"shoulder": most, "elbow": most, "lift": 1.0}
    for steps in (named, list(named.values())):
        path = follow(arm, arm.fk(q), q0=q[0], max_step=steps)
        assert path.branch_switches == switches


@settings(max_examples=30)
@given(seed=st.integers(0, 10**6), count=st.integers(2, 40))
def test_between_two_poses_the_joints_never_jump_unless_it_is_said(seed, count):
    arm = ARM
    rng = np.random.default_rng(seed)
    q = arm.chain.random(rng, 2)
    T = arm.fk(motion.joint(q[0], q[1], np.linspace(0, 1, count)))
    path = follow(arm, T, q0=q[0], max_step=0.5)
    done = path.success
    assert done[0]
    if done.any():
        assert off(arm, path.q[done], T[done]) <= TOL
    lower, upper = arm.chain.limits.T
    assert ((path.q >= lower) & (path.q <= upper)).all()
    for k in np.flatnonzero(path.steps > 0.5) + 1:
        # a step that is longer is one of the pieces of a screw motion, a change that is told, or
        # not reached
        if k not in path.branch_switches and done[k] and done[k - 1]:
            assert any(
                _ends_at(arm, T[k - 1], T[k], path.q[k - 1], path.q[k], n) for n in follower.PIECES
            )


def _ends_at(arm, T_a, T_b, q_a, q_b, pieces):  # type: ignore[no-untyped-def]
    """Whether so many pieces of the screw motion lead from q_a to q_b in steps of at most half a
    radian.
    """
    way = follow(arm, motion.screw(T_a, T_b, np.arange(pieces + 1) / pieces), q0=q_a, max_step=0.5)
    return (
        way.largest_step <= 0.5
        and way.branch_switches == ()
        and np.abs(way.q[-1] - q_b).max() < 1e-6
    )


ARM = pk.load("ur5").chain().compile()


def test_a_path_of_its_own_configurations_is_followed_on_its_own_branch(ur5):
    q = UR5_Q + 0.4 * np.sin(np.linspace(0, 6, 500))[:, None] * [1, 0.5, -0.3, 0.7, 0.4, 1]
    path = follow(ur5, ur5.fk(q), q0=q[0])
    np.testing.assert_allclose(path.q, q, rtol=0, atol=1e-7)


def test_without_q0_a_branch_is_chosen_that_follows_the_whole_path():
    # with the elbow bent one way the shoulder's limit is in the way half way round: only the other
    # one goes on
    arm = planar([[-0.2, 3.0], [-2.5, 2.5], [-1, 1]])
    q = motion.joint([0.0, 1.0, 0.0], [2.9, 1.0, 0.0], np.linspace(0, 1, 200))
    T = arm.fk(q)
    path = follow(arm, T, task="position")
    assert path.ok
    assert path.branch_switches == ()
    other = [1.0 - 0.0, -1.0, 0.0]
    stopped = follow(arm, T, q0=other, task="position")
    assert len(stopped.branch_switches) == 1
    k = stopped.branch_switches[0]
    assert stopped.success.all()
    assert stopped.steps[k - 1] > 0.5
    assert np.delete(stopped.steps, k - 1).max() <= 0.1
    assert f"the branch changes before pose {k}" in str(stopped)
    assert not stopped.ok
    assert any(s.name == "shoulder" for s in stopped.at_limits) or stopped.q[k - 1, 0] > 2.9


def test_of_several_starts_the_one_that_gets_farthest_is_taken(monkeypatch):
    arm = planar([[-0.2, 3.0], [-2.5, 2.5], [-1, 1]])
    T = arm.fk(motion.joint([0.0, 1.0, 0.0], [2.9, 1.0, 0.0], np.linspace(0, 1, 200)))
    starts = np.array([[1.0, -1.0, 0.0], [0.0, 1.0, 0.0], [1.0, -1.0, 0.0]])
    monkeypatch.setattr(follower.Follower, "_solutions", lambda *_: starts)
    path = follow(arm, T, task="position")
    assert path.ok
    np.testing.assert_allclose(path.q[0], starts[1], rtol=0, atol=1e-8)


def test_coarse_poses_are_joined_by_pieces_of_the_screw_motion(ur5):
    q = motion.joint(UR5_Q, np.add(UR5_Q, [1.0, 0.3, -0.2, 0.1, 0.3, -0.8]), np.linspace(0, 1, 6))
    path = follow(ur5, ur5.fk(q), q0=q[0], max_step=0.1)
    assert path.branch_switches == ()
    np.testing.assert_allclose(path.q, q, rtol=0, atol=1e-7)
    assert path.largest_step > 0.1


def test_a_pose_out_of_reach_is_told_and_the_path_goes_on_after_it():
    arm = planar([[-3, 3], [-3, 3], [0, 0.1]])
    x = np.concatenate([np.linspace(1.5, 2.2, 50), np.linspace(2.2, 1.5, 50)])
    T = np.tile(np.eye(4), (100, 1, 1))
    T[:, 0, 3] = x
    path = follow(arm, T, q0=[-0.7, 1.4, 0.0], task="position")
    np.testing.assert_array_equal(path.success, x <= 2)
    k = int(np.argmax(x))
    assert path.solution.summary(k).startswith(
        "unreachable: the target is farther than the arm's reach by 100 mm"
    )
    # the nearest is at full length; the links' length and what the lift could do are the bound of
    # the reach
    np.testing.assert_allclose(path.position_error[x > 2], x[x > 2] - 2, rtol=0, atol=1e-3)
    # a stretched arm may bend either way, and does so as the root of the distance: no step is small
    # enough
    assert len(path.branch_switches) <= 1
    assert path.largest_step < 0.5
    said = next(s for s in path.summary().splitlines() if "not reached" in s)
    assert said.startswith(f"poses 36 to 63 not reached, least of all {k}: unreachable: ")


def test_an_arm_in_degrees_is_as_near_to_a_first_pose_out_of_reach_as_in_radians():
    arm = planar([[-3, 3], [-3, 3], [0, 0.1]])
    degrees = arm.replace(
        coupling=np.diag([np.pi / 180] * 2 + [1.0]), limits=[[-172, 172], [-172, 172], [0, 0.1]]
    )
    T = np.tile(np.eye(4), (1, 1, 1))
    T[0, :2, 3] = 1.5, 1.6
    path = follow(degrees, T, task="position")
    assert path.position_error[0] == pytest.approx(np.hypot(1.5, 1.6) - 2, abs=1e-3)


def test_an_arm_in_degrees_jumps_to_the_nearest_solution_where_its_branch_changes(panda):
    arm = panda.chain
    degrees = arm.replace(coupling=np.deg2rad(np.eye(7)), limits=np.rad2deg(arm.limits))
    q = arm.random(1, 2)
    T = arm.fk(q)
    path = follow(degrees, T, q0=np.rad2deg(q[0]), max_step=[3.0] * 7)
    assert path.branch_switches == (1,)
    nearest = ik(degrees, T[1], nearest_to=path.q[0])
    np.testing.assert_allclose(path.q[1], nearest.q, rtol=0, atol=1e-6)


def test_a_bad_target_is_skipped(ur5):
    T = straight(ur5, UR5_Q, [0, 0.1, 0], 20)
    whole = follow(ur5, T, q0=UR5_Q)
    T[[0, 7]] = np.nan
    path = follow(ur5, T, q0=UR5_Q)
    assert list(path.reason[[0, 7]]) == ["bad target"] * 2
    assert np.isnan(path.q[[0, 7]]).all()
    assert path.branch_switches == ()
    rest = np.delete(np.arange(20), [0, 7])
    np.testing.assert_allclose(path.q[rest], whole.q[rest], rtol=0, atol=1e-8)
    assert "bad target" in str(path)


def test_a_path_of_bad_targets_alone_and_an_empty_one(ur5):
    path = follow(ur5, np.full((3, 4, 4), np.nan))
    assert not path.success.any()
    assert path.largest_step == 0
    empty = follow(ur5, np.empty((0, 4, 4)), times=[])
    assert empty.q.shape == (0, 6)
    assert empty.ok
    assert str(empty).startswith("0 of 0 poses reached")
    assert follow(ur5, ur5.fk(UR5_Q)[None], times=[0.0], speed=1, acceleration=1).ok


def test_limits_that_are_met_are_named():
    arm = planar([[-3, 3], [0.0, 2.0], [-0.1, 0.1]])
    q = np.column_stack(
        [np.zeros(20), np.linspace(1, 1.9, 20), np.minimum(np.linspace(0, 0.2, 20), 0.1)]
    )
    path = follow(arm, arm.fk(q), q0=q[0], task="position")
    assert path.success.all()
    (met,) = path.at_limits
    assert (met.name, met.bound) == ("lift", 0.1)
    assert met.first == int(np.argmax(q[:, 2] >= 0.1))
    assert met.last == 19
    assert "'lift' at its limit 0.1" in str(path)


def test_limits_in_the_way_are_the_reason():
    arm = planar([[-3, 3], [0.0, 2.0], [-0.1, 0.1]])
    T = arm.fk([[0.0, 1.0, 0.0]] * 4)
    T[2:, 2, 3] = 0.3
    path = follow(arm, T, task="position")
    assert list(path.reason) == ["solved", "solved", "limits", "limits"]
    assert path.position_error[2] == pytest.approx(0.2, abs=1e-6)
    assert "in the way are those of 'lift'" in path.solution.summary(2)
    free = follow(arm, T, limits=False, task="position")
    assert free.ok
    np.testing.assert_array_equal(free.limits, np.tile([-np.inf, np.inf], (arm.dof, 1)))
    np.testing.assert_array_equal(follow(arm, T, task="position").limits, arm.limits)


def test_speed_and_acceleration_that_are_exceeded_are_named_with_their_place():
    arm, t = planar(), np.linspace(0, 2, 201)
    timing = motion.minimum_time("trapezoidal", 1.0, speed=0.7, acceleration=2.0)
    q = motion.joint([0.0, 1.0, 0.0], [1.0, 1.0, 0.0], timing(t).s)
    given = {"q0": q[0], "times": t, "task": "position"}
    path = follow(
        arm, arm.fk(q), **given, speed={"shoulder": 0.6, "elbow": 1, "lift": 1}, acceleration=1.5
    )
    (fast,) = path.speed_violations
    assert fast.name == "shoulder"
    assert fast.value == pytest.approx(0.7, rel=1e-5)
    # s' = 2 t passes 0.6 at 0.3 s
    assert t[fast.first] == pytest.approx(0.3, abs=0.011)
    assert {(s.name, round(s.value, 2)) for s in path.acceleration_violations} == {
        ("shoulder", 2.0)
    }
    assert not path.ok
    assert "'shoulder' exceeds its speed, 0.7 of 0.6" in str(path)
    assert follow(arm, arm.fk(q), **given, speed=0.71, acceleration=2.01).ok


def test_a_singularity_on_the_way_is_met(ur5):
    # the wrist's two axes are parallel at q5 = 0
    q = motion.joint([*UR5_Q[:4], 0.3, 0.0], [*UR5_Q[:4], -0.3, 0.0], np.linspace(0, 1, 301))
    path = follow(ur5, ur5.fk(q), q0=q[0])
    (met,) = path.near_singular
    assert met.worst == 150
    assert met.first <= 150 <= met.last
    assert path.inverse_condition[met.worst] < 1e-6
    assert path.inverse_condition[0] > NEAR_SINGULAR
    assert "near a singularity" in str(path)
    assert path.success.all()
    assert follow(ur5, ur5.fk(q[:100]), q0=q[0]).near_singular == ()


@pytest.mark.parametrize("task", ["position", "direction", "rotation"])
def test_a_part_of_a_pose_is_followed(panda, task):
    T = straight(panda, PANDA_Q, [0, 0.2, 0], 50)
    path = follow(panda, T, task=task, q0=PANDA_Q)
    assert path.ok
    assert (path.inverse_condition > NEAR_SINGULAR).all()
    if task != "rotation":
        np.testing.assert_allclose(panda.fk(path.q)[:, :3, 3], T[:, :3, 3], rtol=0, atol=TOL)


def test_a_locked_joint_stays(panda):
    T = straight(panda, PANDA_Q, [0, 0.2, 0], 50)
    path = follow(panda, T, lock={"panda_joint3": 0.0})
    assert path.ok
    np.testing.assert_array_equal(path.q[:, 2], 0.0)


def test_the_same_seed_gives_the_same_path(panda):
    T = straight(panda, PANDA_Q, [0, 0.2, 0], 50)
    np.testing.assert_array_equal(follow(panda, T, seed=3).q, follow(panda, T, seed=3).q)


def test_a_chain_and_its_compiled_form_give_the_same(ur5):
    T = straight(ur5, UR5_Q, [0, 0.1, 0], 10)
    np.testing.assert_array_equal(follow(ur5.chain, T, q0=UR5_Q).q, follow(ur5, T, q0=UR5_Q).q)


def test_a_planted_jump_is_caught(ur5):
    """A path that is followed pose by pose from random starts, as a loop over `ik` would, does not
    pass for one.
    """
    T = straight(ur5, UR5_Q, [0, 0.1, 0], 50)
    path = follow(ur5, T, q0=UR5_Q)
    path.solution.q[20] = ik(ur5, T[20], q0=np.add(UR5_Q, [0, 0.9, -3.2, 2.3, 0, 0])).q
    fresh = type(path)(*(getattr(path, f) for f in path.__dataclass_fields__))
    assert fresh.largest_step > 0.1


def test_progress_is_told_and_files_are_written(ur5, tmp_path):
    T, said = straight(ur5, UR5_Q, [0, 0.1, 0], 10), []
    path = follow(ur5, T, q0=UR5_Q, times=np.arange(10.0), progress=lambda *x: said.append(x))
    assert said[-1] == (10, 10)
    path.to_csv(tmp_path / "q.csv")
    q, t = motion.read_joints(tmp_path / "q.csv", ur5.chain)
    np.testing.assert_array_equal(q, path.q)
    np.testing.assert_array_equal(t, np.arange(10.0))
    pytest.importorskip("matplotlib")
    assert path.plot(tmp_path / "q.svg").startswith("<svg")
    assert (tmp_path / "q.svg").exists()


@pytest.mark.parametrize(
    ("options", "kind", "says"),
    [
        ({"q0": [0.0]}, ShapeError, r"q0: expected 6 coordinates"),
        ({"q0": np.full(6, np.nan)}, InputError, r"q0: expected finite"),
        ({"times": [0.0]}, ShapeError, r"times: expected one for each pose \(3,\), got shape \(1,\)"),
        ({"times": [0, 2, 1]}, InputError,
         r"^times: expected finite ascending seconds, got \[2\.0, 1\.0\] from times\[1\] on$"),
        ({"times": [0, 1, 0.5]}, InputError, r"ascending seconds, got \[1\.0, 0\.5\] from times\[1\]"),
        ({"times": [0, 0, 1]}, InputError, r"ascending seconds, got \[0\.0, 0\.0\] from times\[0\]"),
        ({"times": [0, 1, np.inf]}, InputError, r"ascending seconds, got \[1\.0, inf\]"),
        ({"speed": 1}, InputError,
         r"^speed and acceleration: expected together with times, when each pose is to be reached$"),
        ({"acceleration": 1}, InputError, r"^speed and acceleration: expected together with times"),
        ({"times": [0, 1, 2], "speed": -1}, InputError, r"speed: expected positive numbers"),
        ({"times": [0, 1, 2], "acceleration": [1, 2]}, ShapeError, r"acceleration: expected 6 coordinates"),
        ({"times": [0, 1, 2], "speed": {"no": 1}}, UnknownName, r"speed: no coordinate 'no'"),
        ({"max_step": 0}, InputError, r"max_step: expected positive"),
        ({"max_step": "far"}, InputError, r"max_step: expected real numbers"),
        ({"task": "dance"}, InputError, r"task: expected 'pose', "),
        ({"tol_position": 0}, InputError, r"tol_position: expected a positive"),
        ({"lock": {"no": 1.0}}, UnknownName, r"lock: no coordinate 'no'"),
    ],
    ids=lambda x: ",".join(x) if isinstance(x, dict) else None,
)  # fmt: skip
def test_what_cannot_be_followed_is_refused(ur5, options, kind, says):
    with pytest.raises(kind, match=says):
        follow(ur5, np.tile(np.eye(4), (3, 1, 1)), **options)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"limits": 1}, "limits: expected True or False, got 1"),
        ({"seed": False}, "seed: expected a whole number"),
        ({"tol_position": True}, "tol_position: expected a positive number, got True"),
        ({"tol_rotation": True}, "tol_rotation: expected a positive number, got True"),
    ],
    ids=str,
)
def test_a_setting_that_is_none_is_told_after_its_equal_was_accepted(ur5, options, message):
    poses = ur5.fk(UR5_Q + np.linspace(0.0, 0.1, 3)[:, None])
    assert follow(ur5, poses).success.all()
    follow(ur5, poses, tol_position=1, tol_rotation=1)
    with pytest.raises(InputError, match=message):
        follow(ur5, poses, **options)


def test_what_is_no_path_is_refused(ur5):
    with pytest.raises(ShapeError, match=r"expected a path \(N, 4, 4\), got shape \(4, 4\)"):
        follow(ur5, np.eye(4))
    with pytest.raises(PoseError, match=r"poses\[1\] is no pose"):
        follow(ur5, np.stack([np.eye(4), 2 * np.eye(4)]))
    with pytest.raises(InputError, match=r"chain: expected a Chain, as .* makes it, got 'arm'"):
        follow("arm", np.eye(4))  # type: ignore[arg-type]
    q = np.array([0.0, 10.0, 0, 0, 0, 0])
    with pytest.warns(pk.PoekinWarning, match=r"q0 is outside the limits"):
        follow(ur5, ur5.fk(UR5_Q)[None], q0=q)


def test_rotations_by_more_than_half_a_turn_are_followed(ur5):
    # the tool turns by two turns about its own axis: each pose is near the last, whatever the whole
    # angle is
    q = UR5_Q + np.linspace(0, 1, 400)[:, None] * [0, 0, 0, 0, 0, 2 * np.pi - 0.1]
    path = follow(ur5, ur5.fk(q), q0=q[0])
    np.testing.assert_allclose(path.q, q, rtol=0, atol=1e-7)


@pytest.mark.parametrize("seed", [20, 185])
def test_a_path_out_of_reach_ends_in_numbers_where_the_arm_is_singular(seed):
    rng = np.random.default_rng(seed)
    axes = [
        pk.screw.revolute(np.eye(3)[rng.integers(3)], rng.integers(-1, 2, 3) * 0.5)
        for _ in range(6)
    ]
    home = np.eye(4)
    home[:3, 3] = rng.integers(-2, 3, 3) * 0.5
    arm = pk.Chain.from_space(axes, home)
    T_s0 = arm.fk(arm.random(rng))
    T_s1 = T_s0.copy()
    T_s1[:3, 3] += [5, 1, 2]
    path = follow(arm, motion.line(T_s0, T_s1, np.linspace(0, 1, 12)), limits=False)
    assert path.success[0]
    assert not path.success[-1]
    assert np.isfinite(path.q).all()


def test_a_tool_that_cannot_turn_far_enough_turns_as_far_as_it_can():
    slides = [pk.screw.prismatic(axis) for axis in np.eye(3)]
    tilts = [pk.screw.revolute(axis, [0, 0, 0]) for axis in ([0, 1, 0], [1, 0, 0])]
    arm = pk.Chain.from_space(
        [*slides, *tilts], np.eye(4), limits=[*[[-1, 1]] * 3, [-0.5, 1.0], [-0.1, 0.1]]
    )
    target = pk.se3.exp([0, 2.5, 0, 0.2, 0.1, 0])  # 2.5 rad: farther off than a right angle
    path = follow(arm, np.tile(target, (15, 1, 1)), q0=np.zeros(5), task="direction")
    assert set(path.reason) == {"limits"}
    np.testing.assert_allclose(path.q[-1, 3], 1.0, rtol=0, atol=1e-9)


def test_bad_targets_are_told_apart_from_poses_that_are_not_reached(ur5):
    T = np.tile(ur5.fk(UR5_Q), (4, 1, 1))
    T[1], T[2, 0, 3] = np.nan, 9.0
    said = str(follow(ur5, T, q0=UR5_Q))
    assert "pose 1 not reached: bad target" in said
    assert "pose 2 not reached: unreachable" in said


def test_the_errors_of_a_bad_target_are_not_known(ur5):
    T = np.tile(ur5.fk(UR5_Q), (2, 1, 1))
    T[1] = np.nan
    path = follow(ur5, T, q0=UR5_Q, task="position")
    assert np.isnan([path.position_error[1], path.rotation_error[1]]).all()


def follower_of(arm, T, most=0.1, **options):  # type: ignore[no-untyped-def]
    """What follows a path, before it does."""
    settings = {"task": "pose", "axis": None, "limits": True, "tol_position": TOL, "tol_rotation": TOL, "lock": None,
                "weights": None, "restarts": 100, "iterations": 30, "seed": 0, "parallel": False}  # fmt: skip
    solver = make_problem(arm, Settings(**{**settings, **options}))
    return follower.Follower(solver, np.ascontiguousarray(T), np.full(arm.dof, most), None)


@pytest.mark.parametrize("lock", [None, (("panda_joint3", 0.3),)])
def test_starts_are_several_solutions_of_their_pose_with_what_is_locked_where_it_is(panda, lock):
    q = np.where(np.arange(7) == 2, 0.3, PANDA_Q)
    T = panda.fk(q)[None]
    one = follower_of(panda, T, lock=lock)
    for turn in (0, 1):
        found = one._solutions(0, turn, None)
        assert len(found) > 1
        assert off(panda, found, np.tile(T, (len(found), 1, 1))) <= TOL
        assert lock is None or (found[:, 2] == 0.3).all()
    nearest = one._solutions(0, 0, q)[0]
    np.testing.assert_allclose(nearest, q, atol=1e-6)


def test_a_step_towards_a_pose_out_of_reach_goes_no_farther_than_is_allowed_and_down():
    arm = planar().compile()
    T = np.tile(np.eye(4), (1, 1, 1))
    T[0, :3, 3] = 3.0, 0.5, 0
    one, last = follower_of(arm, T, most=0.05, task="position"), np.array([0.4, -0.9, 0.0])
    (q,) = one._near(0, last)
    assert (np.abs(q - last) <= 0.05 + 1e-15).all()
    before, after = (np.linalg.norm(arm.fk(x)[:3, 3] - T[0, :3, 3]) for x in (last, q))
    assert after < before - 0.01
    (far,) = follower_of(arm, T, most=10.0, task="position")._near(0, last)
    assert np.linalg.norm(arm.fk(far)[:3, 3] - T[0, :3, 3]) == pytest.approx(
        np.hypot(3, 0.5) - 2, abs=1e-5
    )
    e2, H, g = slope_at(one.problem, T[0], last)
    error = T[0, :3, 3] - arm.fk(last)[:3, 3]
    J = arm.chain.jacobian(last, "hybrid")[3:]
    assert e2 == pytest.approx(error @ error)
    np.testing.assert_allclose(H, J.T @ J, atol=1e-14)
    np.testing.assert_allclose(g, J.T @ error, atol=1e-14)


def test_it_is_said_of_a_pose_that_is_reached_after_all_that_the_steps_ended(ur5):
    T = ur5.fk(np.array([UR5_Q, UR5_Q]))
    T[1, 0, 3] += 9
    one = follower_of(ur5, T)
    assert one.failure(0) == ("iterations", 0.0, (), ())
    reason, beyond, blocked, _ = one.failure(1)
    assert (reason, blocked) == ("unreachable", ())
    assert 7 < beyond < 9
