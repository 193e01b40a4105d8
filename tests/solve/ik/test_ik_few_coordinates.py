"""Arms with fewer coordinates than a task constrains: what they reach is solved, and else the task
that they can do is named.
"""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import poekin as pk
from poekin.groups import se3, so3
from poekin.model import screw
from poekin.solve.ik.ik import ik
from poekin.solve.ik.solution import UNREACHABLE
from poekin.solve.ik_all.ik_all import ik_all
from poekin.solve.path.follow import follow

Z = np.array([0.0, 0.0, 1.0])
LENGTHS = st.floats(0.1, 1.5)
FEW = settings(max_examples=max(settings().max_examples // 5, 10))


def revolutes(*x):
    return [screw.revolute(Z, [at, 0, 0]) for at in x]


def home(*p):
    return se3.exp([0, 0, 0, *p])


def planar(lengths):
    """Arm of parallel axes with these links along x."""
    ends = np.cumsum([0, *lengths])
    return pk.Chain.from_space(revolutes(*ends[:-1]), home(ends[-1], 0, 0))


def scara(a, b):
    axes = [*revolutes(0, a, a + b), screw.prismatic(-Z)]
    limits = [[-3, 3], [-2.5, 2.5], [-6, 6], [0, 0.5]]
    return pk.Chain.from_space(axes, home(a + b, 0, 0.2), limits=limits)


def rrp(a, b):
    axes = [screw.revolute(Z, [0, 0, 0]), screw.revolute([0, 1, 0], [0, 0, a])]
    limits = [[-3, 3], [-1.4, 1.4], [0.1, 1]]
    return pk.Chain.from_space([*axes, screw.prismatic([1, 0, 0])], home(b, 0, a), limits=limits)


def five(a, b):
    points = [[0, 0, 0.3], [a, 0, 0.3], [a + b, 0, 0.3]]
    axes = [screw.revolute([0, 1, 0], p) for p in points]
    roll = screw.revolute([1, 0, 0], points[2])
    return pk.Chain.from_space(
        [screw.revolute(Z, [0, 0, 0]), *axes, roll], home(a + b + 0.1, 0, 0.3)
    )


MAKERS = {
    "one joint": lambda a, b: planar([a]),
    "2R": lambda a, b: planar([a, b]),
    "planar 3R": lambda a, b: planar([a, b, 0.3]),
    "SCARA": scara,
    "RRP": rrp,
    "5R": five,
}


@st.composite
def arms(draw):
    """An arm of one of the kinds, of drawn lengths, somewhere in the base frame."""
    make = MAKERS[draw(st.sampled_from(sorted(MAKERS)))]
    P = se3.exp(draw(st.tuples(*[st.floats(-2, 2)] * 6)))
    return make(draw(LENGTHS), draw(LENGTHS)).rebased(P)


@FEW
@given(arms(), st.integers(0, 2**32 - 1))
def test_a_pose_that_a_configuration_has_is_solved_from_a_random_start(arm, seed):
    T = arm.fk(arm.random(seed, 8))
    found = ik(arm, T, seed=seed)
    assert found.success.all()
    np.testing.assert_allclose(arm.fk(found.q), T, rtol=0, atol=3e-9 * arm.reach)
    assert (found.reason == "solved").all()
    assert found.reachable_tasks == ()


@FEW
@given(arms(), st.integers(0, 2**32 - 1), st.floats(0.05, 2.0))
def test_the_task_that_is_named_for_a_tilted_pose_solves_it(arm, seed, angle):
    rng = np.random.default_rng(seed)
    axis = rng.normal(size=3)
    tilt = np.eye(4)
    tilt[:3, :3] = so3.exp(angle * axis / np.linalg.norm(axis))
    T = arm.fk(arm.random(rng, 3)) @ tilt
    found = ik(arm, T, seed=seed)
    for k in np.flatnonzero(found.reason == UNREACHABLE):
        tasks = found.reachable_tasks[k]
        assert "position" in tasks
        for task in tasks:
            assert ik(arm, T[k], task=task, seed=seed).success, task
            assert repr(task) in found.summary(int(k))


@pytest.mark.parametrize("pan, tasks", [(0.0, ("position",)), (1.0, ())])
def test_a_task_that_only_a_locked_coordinate_could_do_is_not_named(pan, tasks):
    arm = pk.load("ur5").chain()
    q = [pan, -1.0, 1.2, 0.3, 0.4, 0.5]
    lock = {arm.q_names[0]: 0.0} | {arm.q_names[k]: q[k] for k in (3, 4, 5)}
    tilted = arm.fk(q) @ se3.exp([0.2, 0.3, 0.1, 0, 0, 0])
    assert ik(arm, tilted, lock=lock).reachable_tasks == (tasks,)


def test_what_is_solved_only_as_it_comes_to_rest_has_the_errors_of_a_solution():
    arm = planar([1.0, 0.7])
    found = ik(arm, arm.fk([[0.3, 0.9], [0.2, 0.8]]), q0=[0.1, 0.7], restarts=0, iterations=1)
    assert found.success.all()
    assert (found.reason == "solved").all()
    assert max(found.position_error.max(), found.rotation_error.max()) <= 1e-9


def test_an_arm_in_degrees_has_the_tasks_and_solutions_that_it_has_in_radians():
    arm = planar([1.0, 0.7])
    degrees = arm.replace(coupling=np.deg2rad(np.eye(2)))
    T = arm.fk([[0.3, 0.9], [0.2, 0.8]])
    tilted = ik(degrees, T @ se3.exp([0.3, 0.2, 0, 0, 0, 0]))
    assert tilted.reachable_tasks == (("planar", "position"),) * 2
    at_rest = ik(degrees, T, q0=np.rad2deg([0.1, 0.7]), restarts=0, iterations=1)
    assert (at_rest.reason == "solved").all()


@pytest.mark.parametrize("name", sorted(MAKERS))
def test_out_of_reach_an_arm_comes_to_rest_at_the_least_error_nearby(name):
    arm = MAKERS[name](0.7, 0.4)
    rng = np.random.default_rng(3)
    T = arm.fk(arm.random(rng, 5)) @ se3.exp([1.2, -0.9, 0.4, 0.2, 0.1, -0.1])

    def cost(q, target):
        found = arm.fk(q)
        chord = np.linalg.norm(found[..., :3, :3] - target[:3, :3], axis=(-2, -1))
        off = np.linalg.norm(found[..., :3, 3] - target[:3, 3], axis=-1)
        return off**2 + chord**2 / 2  # 4 sin^2(angle / 2)

    found = ik(arm, T, seed=1)
    assert set(found.reason) <= {"unreachable", "limits"}
    for q, target in zip(found.q, T, strict=True):
        near = q + rng.normal(size=(300, arm.dof)) * 10.0 ** rng.uniform(-6, -1, (300, 1))
        near = np.clip(near, *arm.limits.T)
        assert cost(near, target).min() >= cost(q, target) * (1 - 1e-3)


@FEW
@given(st.floats(-3, 3), st.integers(0, 2**32 - 1), st.floats(-0.5, 0.5))
def test_the_planar_task_reaches_the_place_in_the_plane_and_the_angle_about_its_normal(z, seed, x):
    arm = planar([1.0, 0.7, 0.4])
    q = arm.random(seed)
    T = arm.fk(q)
    T[2, 3] = z
    T[:3, :3] = T[:3, :3] @ so3.exp([x, 0, 0])  # a turn about a line in the plane
    found = ik(arm, T, task="planar", seed=seed)
    assert found.success
    reached = arm.fk(found.q)
    np.testing.assert_allclose(reached[:2, 3], T[:2, 3], rtol=0, atol=2e-9)
    np.testing.assert_allclose(reached[:3, :3], arm.fk(q)[:3, :3], rtol=0, atol=2e-9)
    assert found.position_error <= 1e-9
    assert ik(arm, T).success == (abs(z) <= 1e-9 and abs(x) <= 1e-9)


def test_beyond_the_plane_s_reach_the_distance_in_the_plane_is_said():
    T = np.eye(4)
    T[:3, 3] = 3, 0, 50
    found = ik(planar([1.0, 0.7, 0.4]), T, task="planar")
    assert found.reason == "unreachable"
    assert found.distance_beyond_reach == pytest.approx(3 - 2.1, rel=1e-9)
    assert 3 - 2.1 <= found.position_error < 3 - 2.0


def test_a_tool_upside_down_has_no_angle_in_the_plane():
    flipped = np.diag([1.0, -1, -1, 1])
    flipped[:2, 3] = 1, 0.5
    found = ik(planar([1.0, 0.7, 0.4]), flipped, task="planar")
    assert found.reason == "unreachable"
    assert found.rotation_error == pytest.approx(np.pi)
    assert ik(planar([1.0, 0.7]), flipped, task="planar").reachable_tasks == (("position",),)


def test_limits_of_an_arm_of_few_coordinates_are_in_the_way_where_they_are():
    arm = planar([1.0, 0.7]).replace(limits=[[-1, 1], [-1, 1]])
    found = ik(arm, planar([1.0, 0.7]).fk([0.5, 1.5]))
    assert found.reason == "limits"
    assert found.limits_hit == (("joint2",),)
    assert found.reachable_tasks == ((),)


def test_a_batch_of_few_coordinates_has_a_reason_for_each_of_its_targets():
    arm = planar([1.0, 0.7])
    T = np.tile(arm.fk([0.3, 0.9]), (2, 2, 1, 1))
    T[0, 1, 2, 3] += 0.1
    T[1, 0] = np.nan
    T[1, 1, :3, :3] = np.eye(3)
    found = ik(arm, T)
    assert found.reason.tolist() == [["solved", "unreachable"], ["bad target", "unreachable"]]
    assert found.reachable_tasks == (
        (),
        ("planar", "rotation"),
        (),
        ("direction", "position", "rotation"),
    )
    assert np.isnan(found.q[1, 0]).all()
    bad = ik(arm, T[1, 0], task="planar")
    assert np.isnan([bad.position_error, bad.rotation_error]).all()


def test_fewer_restarts_than_the_other_tasks_would_get_are_theirs_too():
    arm = planar([1.0, 0.7])
    T = home(0.4, 0.2, 0)
    found = ik(arm, T, q0=[0.1, 0.2], restarts=0)
    for task in found.reachable_tasks[0]:
        assert ik(arm, T, task=task, q0=[0.1, 0.2], restarts=0).success


@pytest.mark.parametrize("name", sorted(MAKERS))
def test_a_path_of_an_arm_s_own_poses_is_followed_in_one_branch_however_far_apart_they_are(name):
    arm = MAKERS[name](0.7, 0.4)
    start = np.clip(0.4, *arm.limits.T)
    q = start + 0.3 * np.sin(np.linspace(0, 3, 9))[:, None] * np.linspace(1, 0.2, arm.dof)
    for path in (
        follow(arm, arm.fk(q), q0=q[0], max_step=0.5),
        follow(arm, arm.fk(q[::3]), q0=q[0], max_step=0.05),  # in pieces
    ):
        assert path.ok
        assert path.branch_switches == ()
    np.testing.assert_allclose(path.q, q[::3], rtol=0, atol=1e-6)


def test_a_path_says_which_task_would_do():
    arm = planar([1.0, 0.7])
    T = np.tile(arm.fk([0.3, 0.9]), (3, 1, 1))
    T[1, :3, :3] = np.eye(3)
    path = follow(arm, T)
    assert path.success.tolist() == [True, False, True]
    assert path.solution.reachable_tasks == ((), ("direction", "position", "rotation"), ())
    assert "only with task='direction' or task='position' or" in path.summary()


@pytest.mark.parametrize("name", ["2R", "planar 3R", "SCARA", "RRP", "5R"])
def test_all_solutions_of_few_coordinates_hold_the_one_the_pose_was_made_of(name):
    arm = MAKERS[name](0.7, 0.4)
    for q in arm.random(np.random.default_rng(5), 4):
        every = ik_all(arm, arm.fk(q), method="search")
        off = np.abs(np.angle(np.exp(1j * (every.solutions - q))))
        slides = arm.local.slides != 0
        off[:, slides] = np.abs(every.solutions - q)[:, slides]
        assert off.max(axis=1).min() < 1e-6
