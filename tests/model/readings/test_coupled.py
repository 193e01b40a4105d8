"""A coupled chain is the chain at the joint values that its readings make, in all that it answers."""

from __future__ import annotations

import pickle
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import InputError
from poekin.model.readings.coupled import (
    beyond_own_limits,
    joint_values,
    own_coupling,
    own_limits,
    own_readings,
    own_speeds,
    reading_limits,
    reading_speeds,
    sum_limits,
)
from poekin.model.sampling import dominant_ratios, half_range, joint_ratios, sampling_range

ROBOT = pk.load("puma560")
ARM = ROBOT.chain()
ROWS = np.random.default_rng(3).normal(size=(5, 6))


def joints(readings: np.ndarray, sign: float) -> np.ndarray:
    x = readings.copy()
    x[..., 2] += sign * readings[..., 1]
    return x


@pytest.mark.parametrize(("said", "sign"), [("J3 = J2 + J3", 1.0), ("J3 = J3 - J2", -1.0)])
def test_poses_and_jacobians_are_those_of_the_joint_values(said, sign):
    coupled = ARM.coupled(said)
    assert coupled.q_names == ARM.q_names
    x = joints(ROWS, sign)
    np.testing.assert_allclose(coupled.fk(ROWS), ARM.fk(x), rtol=0, atol=1e-15)
    fast = coupled.compile()
    np.testing.assert_allclose(fast.fk(ROWS), ARM.fk(x), rtol=0, atol=1e-14)
    for frame in ("space", "body", "hybrid"):
        J = ARM.jacobian(x, frame)
        J[..., 1] += sign * J[..., 2]  # the second reading moves both
        np.testing.assert_allclose(coupled.jacobian(ROWS, frame), J, rtol=0, atol=1e-14)
        np.testing.assert_allclose(fast.jacobian(ROWS, frame), J, rtol=0, atol=1e-14)


def test_inverse_kinematics_gives_readings():
    coupled = ARM.coupled("J3 = J2 + J3")
    readings = np.array([0.3, 0.5, -0.9, 0.2, 0.4, 0.1])
    T = ARM.fk(joints(readings, 1.0))
    found = pk.ik(coupled, T, q0=readings + 0.05)
    assert found.success
    np.testing.assert_allclose(found.q, readings, rtol=0, atol=1e-9)
    every = pk.ik_all(coupled, T, limits=False, seed=0)
    alone = pk.ik_all(ARM, T, limits=False, seed=0)
    assert len(every.solutions) == len(alone.solutions) == 8
    again = coupled.fk(every.solutions)
    np.testing.assert_allclose(again, np.tile(T, (8, 1, 1)), rtol=0, atol=1e-9)


@given(seed=st.integers(0, 99))
def test_readings_of_joints_within_their_limits_are_within_theirs_and_reach_them(seed):
    rng = np.random.default_rng(seed)
    K = np.eye(6) + np.tril(rng.integers(-2, 3, (6, 6)), -1)
    limits = np.sort(rng.normal(size=(6, 2)), axis=1)
    limits[0, 1] = np.inf
    x = np.where(rng.integers(0, 2, (400, 6)), *np.clip(limits, -1e3, 1e3).T)
    readings = np.linalg.solve(K, x.T).T
    box = reading_limits(K, limits)
    rounding = 1e-12 * (1 + np.abs(readings))
    assert (readings >= box[:, 0] - rounding).all()
    assert (readings <= box[:, 1] + rounding).all()
    corners = np.array(np.meshgrid(*np.clip(limits, -1e3, 1e3))).reshape(6, -1)
    reached = np.linalg.solve(K, corners)
    lower = np.where(np.isinf(box[:, 0]), box[:, 0], reached.min(axis=1))
    np.testing.assert_allclose(lower, box[:, 0], rtol=0, atol=1e-9)


def test_limits_that_no_other_reading_changes_stay_and_sums_of_infinite_ones_are_infinite():
    coupled = ARM.coupled("J3 = J2 + J3")
    for k in (0, 1, 3, 4, 5):
        np.testing.assert_array_equal(coupled.limits[k], ARM.limits[k])
    (a, b), (c, d) = ARM.limits[2], ARM.limits[1]
    np.testing.assert_allclose(coupled.limits[2], [a - d, b - c], rtol=1e-15)
    K = np.array([[1.0, 0.0], [1.0, 1.0]])
    open_ended = np.array([[-np.inf, 1.0], [0.0, np.inf]])
    assert reading_limits(K, open_ended).tolist() == [[-np.inf, 1.0], [-1.0, np.inf]]
    assert sum_limits(K, open_ended).tolist() == [[-np.inf, 1.0], [-np.inf, np.inf]]


@given(seed=st.integers(0, 999))
def test_limits_of_joints_are_kept_to_the_last_digit(seed):
    rng = np.random.default_rng(seed)
    limits = np.sort(rng.normal(size=(6, 2)), axis=1)
    limits[rng.integers(6)] = -np.inf, np.inf
    speeds = rng.uniform(0.5, 3, 6)
    arm = ARM.replace(limits=limits, velocity_limits=speeds, offset=rng.normal(size=6))
    for said in ("J3 = J2 + J3", ["J5 = 1/2 J5 + 1/2 J6", "J6 = 1/2 J5 - 1/2 J6"]):
        chain = arm.coupled(said)
        np.testing.assert_array_equal(own_limits(chain), own_limits(arm))
        np.testing.assert_array_equal(own_speeds(chain), speeds)
        moved = chain.rezeroed(np.ones(6))
        x = chain.coupling @ np.ones(6)
        np.testing.assert_allclose(own_limits(moved), own_limits(arm) - x[:, None], atol=1e-15)


@pytest.mark.parametrize("limits", [(-np.inf, 1.0), (-1.0, np.inf), (-1.0, 1.0)])
def test_joints_say_those_of_their_limits_that_their_coordinates_do_not_leave(limits):
    arm = ARM.replace(limits=[*ARM.limits[:2], limits, *ARM.limits[3:]])
    chain = arm.coupled("J3 = J2 + J3")
    # joint 3 alone is moved by two readings, and by more than its own range
    assert chain.joint_limits[2].tolist() == list(limits)
    assert np.isinf(np.delete(chain.joint_limits, 2, axis=0)).all()
    np.testing.assert_array_equal(own_limits(chain), own_limits(arm))


def test_joint_values_are_the_coordinates_through_the_coupling_and_the_offset():
    chain = ARM.replace(offset=np.arange(6.0)).coupled("J3 = J2 + J3")
    q = np.array([[1.0, 2, 3, 4, 5, 6], [0, 0, 0, 0, 0, 0]])
    expected = q @ chain.coupling.T + [0, 1, 2, 3, 4, 5]
    np.testing.assert_array_equal(joint_values(chain, q), expected)
    assert chain.coupling[2].tolist() == [0, 1, 1, 0, 0, 0]


def test_a_joint_at_zero_may_pass_its_own_limit_by_rounding_and_no_more():
    narrow = ARM.replace(joint_limits=np.zeros((6, 2)))
    off = np.array([0.0, 5e-13, -5e-13, 2e-12, -2e-12, 0.0])
    assert beyond_own_limits(narrow, off).tolist() == [False, False, False, True, True, False]


def test_limits_of_readings_alone_leave_each_joint_what_their_sum_does():
    K = np.array([[1.0, 0.0], [1.0, 1.0]])
    of = {"coupling": K, "limits": [[-2, 1], [-4, 3]], "q_names": ["joint1", "joint2"]}
    chain = pk.Chain.from_space(ARM.screws[:2], ARM.home, **of)
    assert own_limits(chain).tolist() == [[-2, 1], [-6, 4]]
    assert np.isinf(chain.joint_limits).all()


@given(seed=st.integers(0, 99))
def test_velocity_limits_of_readings_are_the_largest_that_the_joints_own_leave(seed):
    rng = np.random.default_rng(seed)
    K = np.eye(6) + np.tril(rng.integers(-2, 3, (6, 6)), -1)
    speeds = rng.uniform(0.5, 3, 6)
    found = reading_speeds(K, speeds)
    corners = np.array(np.meshgrid(*(speeds[:, None] * [-1, 1]))).reshape(6, -1)
    reached = np.abs(np.linalg.solve(K, corners)).max(axis=1)
    np.testing.assert_allclose(found, reached, rtol=1e-12)
    # a joint that nothing else follows, and that follows none, keeps its own
    alone = (np.count_nonzero(K, axis=0) == 1) & (np.count_nonzero(K, axis=1) == 1)
    np.testing.assert_array_equal(found[alone], speeds[alone])


def test_velocity_limits_of_chains_and_robots_are_those_of_their_readings():
    chain = ARM.replace(velocity_limits=[1.0, 2.0, 3.0, np.inf, 5.0, 6.0])
    coupled = chain.coupled("J3 = J2 + J3")
    np.testing.assert_array_equal(coupled.velocity_limits, [1.0, 2.0, 5.0, np.inf, 5.0, 6.0])
    np.testing.assert_array_equal(own_speeds(coupled), chain.velocity_limits)
    # said of joints alone where the readings' allow more
    said = [np.inf, np.inf, 3.0, np.inf, np.inf, np.inf]
    np.testing.assert_array_equal(coupled.joint_velocity_limits, said)
    fast = [replace(joint, velocity=2.0) for joint in ROBOT.joints if joint.kind != "fixed"]
    fast += [joint for joint in ROBOT.joints if joint.kind == "fixed"]
    robot = pk.Robot("fast", ROBOT.links, fast, coupling="J3 = J2 + J3")
    expected = [2.0, 2.0, 4.0, 2.0, 2.0, 2.0]
    np.testing.assert_array_equal(robot.chain().velocity_limits, expected)
    np.testing.assert_array_equal(own_speeds(robot.chain()), np.full(6, 2.0))


def test_random_configurations_keep_the_joints_within_their_own_limits():
    chain = ARM.coupled("J3 = J2 + J3")
    q = chain.random(0, (40, 50))
    x = q @ chain.coupling.T
    lower, upper = ARM.limits.T
    assert ((x >= lower - 1e-12) & (x <= upper + 1e-12)).all()
    # uniform: as far as the joints' own limits, and the box of the readings is not filled
    np.testing.assert_allclose(x[..., 2].min(), lower[2], atol=0.05)
    np.testing.assert_allclose(x[..., 2].max(), upper[2], atol=0.05)
    part = ROBOT.coupled("J3 = J2 + J3").chain(base="link2")
    x3 = (part.random(0, 2000) @ part.coupling.T)[:, 0]
    assert (x3 >= lower[2] - 1e-12).all()
    assert (x3 <= upper[2] + 1e-12).all()
    assert chain.random(0).shape == (6,)
    np.testing.assert_array_equal(ARM.random(3, 5), ARM.random(3, 5))


def test_what_is_drawn_again_is_spread_over_the_coordinates_limits_as_what_is_drawn_first():
    one = pk.Chain.from_space(ARM.screws[:1], ARM.home, limits=[[-1.0, 3.0]])
    q = one.replace(joint_limits=[[-0.5, 1.5]]).random(0, 4000)  # every second one is drawn again
    found = np.quantile(q, [0.0, 0.25, 0.5, 0.75, 1.0])
    # five standard deviations of the median of 4000 numbers of density 1/2
    np.testing.assert_allclose(found, [-0.5, 0.0, 0.5, 1.0, 1.5], rtol=0, atol=5 / 4000**0.5)


@pytest.mark.parametrize(
    "own", [(7.0, 8.0), (-700.0, -699.0), (6.2, 8.0), (7.0, np.inf), (-np.inf, -7.0)], ids=str
)
@pytest.mark.parametrize("said", ["J3 = J2 + J3", "J3 = J2 - 2 J3"])
def test_readings_without_limits_are_drawn_from_where_the_joints_own_limits_lie(said, own):
    wide = [[-np.inf, np.inf]] * 6
    limits = np.tile([-np.inf, np.inf], (6, 1))
    limits[2] = own
    limits[1] = -2.0, 2.0
    chain = ARM.coupled(said).replace(limits=wide, joint_limits=limits)
    q = chain.random(0, 500)
    x = q @ chain.coupling.T
    assert ((x >= limits[:, 0] - 1e-9) & (x <= limits[:, 1] + 1e-9)).all()
    # The reading that joint 3 alone follows is moved, the others are drawn as ever.
    others = [0, 1, 3, 4, 5]
    assert (np.abs(q[:, others]) <= np.pi).all()
    low, high = sampling_range(chain)
    np.testing.assert_allclose((high - low)[others], 2 * np.pi)
    # The middle is reached, though it is not in the middle.
    within = chain.replace(joint_limits=np.tile([-6.0, 5.0], (6, 1)))
    np.testing.assert_array_equal(sampling_range(within)[0], -half_range(within))


@pytest.mark.parametrize("own", [(-1.0, np.inf), (2.0, np.inf), (-np.inf, 9.0)], ids=str)
def test_a_range_that_its_joint_s_own_limit_leaves_a_part_of_is_not_moved(own):
    arm = pk.Chain.from_space(
        [[0, 0, 1, 0, 0, 0]], np.eye(4), offset=[5.0], joint_limits=[own], limits=None
    )
    np.testing.assert_allclose(sampling_range(arm), [[-np.pi], [np.pi]])


def test_the_ratio_of_the_joint_that_a_coordinate_moves_most_keeps_its_sign():
    turn, slide = [0, 0, 1, 0, 0, 0], [0, 0, 0, 1, 0, 0]
    C = [[1.0, 0.0], [-2.0, 0.5], [9.0, -0.25]]
    arm = pk.Chain.from_space([turn, turn, slide], np.eye(4), coupling=C, q_names=["a", "b"])
    assert dominant_ratios(arm).tolist() == [-2.0, 0.5]
    assert joint_ratios(arm).tolist() == [2.0, 0.5]


def test_a_chain_that_no_configuration_keeps_within_its_joints_limits_draws_none():
    far = np.tile([50.0, 51.0], (6, 1))
    with pytest.raises(
        InputError, match=r"of 10000 draws .* none keeps the joints within their own: joint_limits"
    ):
        ARM.replace(joint_limits=far).random(0)


def test_a_chain_of_coupled_readings_may_be_coupled_again():
    twice = ARM.coupled("J3 = J2 + J3").coupled("J3 = J3 - J2")
    np.testing.assert_array_equal(twice.coupling, np.eye(6))
    assert twice.nontrivial_coupling is None


def test_a_robot_s_chains_and_poses_take_readings():
    robot = ROBOT.coupled("J3 = J2 + J3")
    assert robot.coupling == ("joint3 = joint2 + joint3",)
    assert robot.chain() == ARM.coupled("J3 = J2 + J3")
    x = joints(ROWS, 1.0)
    plain = ROBOT.fk(x)
    for link, T in robot.fk(ROWS).items():
        np.testing.assert_allclose(T, plain[link], rtol=0, atol=1e-15)
    np.testing.assert_array_equal(robot.limits, robot.chain().limits)
    assert robot != ROBOT
    again = pickle.loads(pickle.dumps(robot))
    assert (again, hash(again)) == (robot, hash(robot))
    assert pk.Robot("puma560", robot.links, robot.joints, coupling="q3 = q3 + q2") == robot
    heavy = pk.Robot("r", robot.links, robot.joints, masses=[pk.LinkMass(robot.links[-1], 2.0)])
    assert heavy.coupled("J3 = J2 + J3").masses == heavy.masses != ()


def test_a_chain_from_the_middle_has_the_readings_that_its_joints_follow():
    robot = ROBOT.coupled("J3 = J2 + J3")
    part = robot.chain(base="link2")
    assert part.q_names == ("joint3", "joint4", "joint5", "joint6", "joint2")
    x = joints(ROWS, 1.0)
    expected = ROBOT.chain(base="link2").fk(x[:, 2:])
    np.testing.assert_allclose(part.fk(ROWS[:, [2, 3, 4, 5, 1]]), expected, rtol=0, atol=1e-15)
    assert np.isinf(part.limits[[0, 4]]).all()
    assert robot.chain(base="link3") == ROBOT.chain(base="link3")


def test_coupling_is_of_coordinates_where_joints_mimic():
    joints_ = [
        pk.Joint("a", "revolute", "base", "one", axis=(0, 0, 1)),
        pk.Joint("b", "revolute", "one", "two", axis=(1, 0, 0)),
        pk.Joint("c", "revolute", "two", "tip", axis=(0, 0, 1), mimic=pk.Mimic("b", -0.5, 0.1)),
    ]
    links = ["base", "one", "two", "tip"]
    robot = pk.Robot("mimic", links, joints_, coupling="b = a + b")
    chain = robot.chain()
    assert chain.coupling.tolist() == [[1, 0], [1, 1], [-0.5, -0.5]]
    q = np.array([0.3, 0.4])
    plain = pk.Robot("mimic", links, joints_)
    np.testing.assert_allclose(chain.fk(q), plain.chain().fk([0.3, 0.7]), rtol=0, atol=1e-15)
    np.testing.assert_allclose(robot.fk(q)["tip"], chain.fk(q), rtol=0, atol=1e-15)
    assert own_readings(chain) is None


def test_a_robot_that_is_coupled_is_not_coupled_again():
    with pytest.raises(InputError) as caught:
        ROBOT.coupled("J3 = J2 + J3").coupled("J3 = J2 + J3")
    assert str(caught.value) == (
        "coupling: the readings of robot 'puma560' are coupled already: joint3 = joint2 + joint3"
    )


def test_own_readings_are_told_from_other_coordinates():
    coupled = ARM.coupled("J3 = J2 + J3")
    np.testing.assert_array_equal(own_readings(coupled), coupled.coupling)
    assert own_readings(ARM) is None
    turned = ARM.replace(coupling=-np.eye(6))
    np.testing.assert_array_equal(own_coupling(turned), -np.eye(6))
    assert own_readings(turned) is None
    np.testing.assert_array_equal(own_coupling(coupled), coupled.coupling)
    assert own_coupling(ARM) is own_coupling(ARM.replace(coupling=np.eye(6))) is None
    order = ARM.q_names[::-1]
    assert own_coupling(ARM.replace(coupling=np.eye(6)[::-1], q_names=order)) is None
    assert own_readings(coupled.replace(q_names=list("abcdef"))) is None
    names = coupled.q_names[::-1]
    turned = coupled.replace(coupling=coupled.coupling[:, ::-1], q_names=names, limits=None)
    np.testing.assert_array_equal(own_readings(turned), coupled.coupling)


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
def test_rounding_of_an_inverse_makes_no_reading_depend_on_an_unlimited_coordinate(size):
    # three rotations by a third of a turn are the identity but for rounding
    c, s = -0.5, 0.75**0.5
    R = np.array([[c, -s], [s, c]])
    K = R @ R @ R / size
    assert K[0, 1] != 0
    found = reading_limits(K, np.array([[-1.0, 2.0], [-np.inf, np.inf]]))
    np.testing.assert_allclose(found[0], [-size, 2 * size], rtol=1e-14)
    assert found[1].tolist() == [-np.inf, np.inf]
