"""Solvers keep the joints of coupled readings within their own limits, and lose no solution."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.model.readings.coupled import beyond_own_limits
from poekin.solve.ik.joint_domain import make_joint_domain
from poekin.solve.joint_units import joint_units

ARM = pk.load("puma560").chain()
SAID = {
    "Fanuc": "J3 = J2 + J3",
    "differential wrist": ["J5 = 1/2 J5 + 1/2 J6", "J6 = 1/2 J5 - 1/2 J6"],
}
LOWER_UPPER = ARM.limits
LOWER, UPPER = LOWER_UPPER.T


@pytest.fixture(scope="module", params=SAID)
def chain(request):
    return ARM.coupled(SAID[request.param])


def own(chain, q):
    """Whether the joints of configurations are within the limits of the arm itself."""
    x = q @ chain.coupling.T
    return ((x >= LOWER - 1e-11) & (x <= UPPER + 1e-11)).all(axis=-1)


def test_every_pose_within_the_joints_limits_is_reached_within_them(chain):
    T = chain.fk(chain.random(0, 100))
    ways: list[dict[str, Any]] = [{}, {"nearest_to": np.zeros(6)}, {"lock": {}}]
    for options in ways:
        found = pk.ik(chain, T, **options)
        assert found.success.all()
        assert own(chain, found.q).all()
    free = pk.ik(chain, T, limits=False)
    assert free.success.all()
    assert not own(chain, free.q).all()


def test_all_solutions_are_those_of_the_arm_itself(chain):
    x = ARM.random(1, 10)
    every = pk.ik_all(chain, ARM.fk(x), method="search")
    alone = pk.ik_all(ARM, ARM.fk(x), method="search")
    assert every.counts.tolist() == alone.counts.tolist()
    for readings, joints in zip(every.solutions, alone.solutions, strict=True):
        found = readings @ chain.coupling.T
        apart = np.abs(found[:, None] - joints).max(axis=-1).min(axis=1)
        assert (apart < 1e-6).all()


def test_a_locked_reading_and_narrower_limits_of_readings_keep_the_joints_limits_too():
    chain = ARM.coupled("J3 = J2 + J3")
    narrow = chain.limits.copy()
    narrow[2] = -2.0, 1.0
    narrower = chain.replace(limits=narrow)
    q = narrower.random(2, 30)
    assert own(chain, q).all()
    found = pk.ik(narrower, chain.fk(q))
    assert found.success.all()
    assert own(chain, found.q).all()
    assert (found.q[:, 2] >= -2).all()
    assert (found.q[:, 2] <= 1).all()
    for solutions in pk.ik_all(narrower, chain.fk(q[:5]), method="search").solutions:
        assert own(chain, solutions).all()
        assert len(solutions)
    name = chain.q_names[2]
    for row in q[:10]:
        T = chain.fk(row)
        locked = pk.ik(chain, T, lock={name: row[2]}, task="position")
        assert locked.success
        assert own(chain, locked.q)
        assert locked.q[2] == row[2]


def test_a_pose_beyond_a_joint_s_own_limits_is_refused_for_them():
    joint = pk.screw.revolute([0, 0, 1], [0, 0, 0])
    elbow = pk.screw.revolute([0, 0, 1], [1, 0, 0])
    home = pk.se3.exp([0, 0, 0, 2, 0, 0])
    limits = [[-2.0, 2.0], [0.5, 1.0]]
    names = ["a", "b"]
    arm = pk.Chain.from_space([joint, elbow], home, limits=limits, joint_names=names)
    chain = arm.coupled("b = a + b")
    beyond = chain.fk([0.5, 1.0])
    found = pk.ik(chain, beyond, task="pose")
    assert not found.success
    assert found.reason == "limits"
    assert found.limits_hit == (("b",),)
    assert not pk.ik(chain, beyond, lock={"b": 1.0}).success
    assert len(pk.ik_all(chain, beyond).solutions) == 0
    assert pk.ik(chain, beyond, limits=False).success


def unbounded(chain, names):
    """The arm with these names of readings, and limits of the joints alone."""
    wide = [[-np.inf, np.inf]] * chain.dof
    return chain.replace(q_names=names, limits=wide, joint_limits=LOWER_UPPER)


@pytest.mark.parametrize("lock", [{}, {"m4": 0.1}], ids=["free", "locked"])
def test_a_joint_whose_own_limits_forbid_a_pose_is_named(chain, lock):
    x = np.array([0.2, 0.3, UPPER[2] + 0.1, 0.1, 0.2, 0.3])
    arm = unbounded(chain, [f"m{k}" for k in range(1, 7)])
    found = pk.ik(arm, ARM.fk(x), lock=lock)
    assert found.reason == "limits"
    assert "joint3" in found.limits_hit[0]
    assert set(found.limits_hit[0]) < set(arm.joint_names)
    assert "in the way are those of 'joint3'" in found.summary()


def test_a_start_beyond_joints_own_limits_is_by_the_names_of_readings_and_warns_of_the_joints():
    arm = unbounded(ARM.coupled("J3 = J2 + J3"), ["m1", "m3", "m2", "m4", "m5", "m6"])
    q0 = dict.fromkeys(arm.q_names, 0.0) | {"m2": 9.0}  # the third column, of joint 3 alone
    with pytest.warns(pk.PoekinWarning, match=r"limits of 'joint3' and is moved"):
        assert pk.ik(arm, ARM.fk(np.full(6, 0.1)), q0=q0).success


def narrow(chain, least, most):
    """The arm with other limits of its third reading."""
    limits = chain.limits.copy()
    limits[2] = least, most
    return chain.replace(limits=limits)


@pytest.mark.parametrize("side", [0, 1], ids=["lower", "upper"])
def test_every_pose_is_reached_within_limits_of_a_reading_that_are_narrower_on_one_side_alone(side):
    wide = ARM.coupled("J3 = J2 + J3")
    ends = wide.limits[2].copy()
    ends[side] = -1.5
    chain = narrow(wide, *ends)
    T = chain.fk(chain.random(3, 100))
    found = pk.ik(chain, T)
    assert found.success.all()
    assert own(chain, found.q).all()
    assert (ends[0] <= found.q[:, 2]).all()
    assert (found.q[:, 2] <= ends[1]).all()
    np.testing.assert_allclose(chain.fk(found.q) - T, 0, atol=1e-8)


def test_of_solutions_whole_turns_apart_those_within_all_limits_are_counted_and_none_is_lost():
    turn = 2 * np.pi
    wide = ARM.replace(limits=[[-turn, turn]] * 6)
    chain = narrow(wide.coupled("J3 = J2 + J3"), -turn, turn)
    T = wide.fk(wide.random(0))
    of_joints = pk.ik_all(wide, T, method="search", all_revolutions=True).solutions
    readings = of_joints @ np.linalg.inv(chain.coupling).T
    within = (np.abs(readings[:, 2]) <= turn).sum()
    every = pk.ik_all(chain, T, method="search", all_revolutions=True)
    one_each = pk.ik_all(chain, T, method="search")
    assert len(every.solutions) == one_each.n_revolutions.sum() == within < len(of_joints)
    assert (every.n_revolutions == 1).all()

    joint_limits = np.full((6, 2), [-np.inf, np.inf])
    joint_limits[2] = 2.0, 6.0  # a turn of the third reading away for half of the solutions
    chain = chain.replace(joint_limits=joint_limits)
    found = pk.ik_all(chain, wide.fk([0.3, 2.5, 3.9, 0.2, 0.5, 0.1]), method="search")
    assert len(found.solutions) == 8
    x3 = found.solutions @ chain.coupling[2]
    assert ((x3 >= 2.0) & (x3 <= 6.0)).all()


def test_the_sentence_counts_no_solution_beyond_a_joint_s_own_limits():
    chain = narrow(ARM.coupled("J3 = J2 + J3"), -2.0, 1.0)
    for T in chain.fk(chain.random(3, 5)):
        found = pk.ik_all(chain, T, method="search")
        assert f"{len(found.solutions)} of them within the limits" in found.explanation


def test_a_path_ends_at_a_joint_s_own_limits_where_those_of_readings_are_narrower():
    chain = narrow(ARM.coupled("J3 = J2 + J3"), -3.0, 1.5)
    x0 = np.array([0.2, 0.5, -0.6, 0.1, 0.8, 0.3])
    x = np.tile(x0, (60, 1))
    x[:, 2] = np.linspace(-0.6, UPPER[2] + 0.3, 60)
    path = pk.follow(chain, ARM.fk(x), q0=np.linalg.solve(chain.coupling, x0))
    reached = x[:, 2] <= UPPER[2]
    np.testing.assert_array_equal(path.success, reached)
    assert own(chain, path.q).all()
    assert (path.reason[~reached] == "limits").all()
    assert (path.position_error[~reached] > 1e-4).all()


def test_a_path_goes_to_the_joints_own_limits_and_no_farther(chain):
    x0 = np.array([0.2, 0.5, -0.6, 0.1, 0.8, 0.3])
    x = np.tile(x0, (60, 1))
    x[:, 2] = np.linspace(-0.6, UPPER[2] + 0.3, 60)
    q0 = np.linalg.solve(chain.coupling, x0)
    path = pk.follow(chain, ARM.fk(x), q0=q0)
    assert own(chain, path.q[path.success]).all()
    alone = pk.follow(ARM, ARM.fk(x), q0=x0)
    np.testing.assert_array_equal(path.success, alone.success)


def test_no_reading_steps_farther_than_is_said(chain):
    x = np.linspace([0.2, 0.5, -0.6, 0.1, 0.8, 0.3], [0.5, 0.8, -0.3, 0.4, 1.1, 0.6], 100)
    q0 = np.linalg.solve(chain.coupling, x[0])
    path = pk.follow(chain, ARM.fk(x), q0=q0, max_step=np.full(6, 0.02))
    assert path.ok
    assert (np.abs(np.diff(path.q, axis=0)) <= 0.02).all()


def reaching(chain, count=80):
    """Positions along which joint 3 alone would go beyond its limit, and where they start."""
    x0 = np.array([0.2, 0.5, UPPER[2] - 0.1, 0.1, 0.8, 0.3])
    q0 = np.linalg.solve(chain.coupling, x0)
    way = chain.jacobian(q0, "hybrid")[3:, 2]
    T = np.tile(chain.fk(q0), (count, 1, 1))
    T[:, :3, 3] += np.linspace(0, 0.14, count)[:, None] * way / np.linalg.norm(way)
    return T, q0


def test_a_path_slides_along_a_joint_s_own_limit_where_what_it_follows_is_locked():
    tool = pk.se3.exp([0, 0, 0, 0.1, 0.05, 0.3])
    chain = ARM.retooled(tool).coupled("J3 = J2 + J3")
    T, q0 = reaching(chain)
    path = pk.follow(chain, T, q0=q0, task="position", lock={"joint2": q0[1]})
    assert path.ok
    assert own(chain, path.q).all()
    assert not path.at_limits
    (met,) = path.joints_at_limits
    assert (met.name, met.last, met.bound) == ("joint3", len(T) - 1, UPPER[2])
    assert met.first > 0
    assert "joint 'joint3' at its own limit 0.785398" in str(path)
    assert path.to_dict()["joints_at_limits"]
    free = pk.follow(chain, T, q0=q0, task="position", lock={"joint2": q0[1]}, limits=False)
    assert free.joint_limits is None
    assert free.joints_at_limits == ()


@pytest.mark.parametrize("seed", range(3))
def test_a_path_slides_along_a_joint_s_own_limit_where_those_of_readings_are_narrower(seed):
    rng = np.random.default_rng(seed)
    tool = pk.se3.exp([0, 0, 0, 0.1, 0.05, 0.3])
    chain = ARM.retooled(tool).coupled("J3 = J2 + J3")
    T, q0 = reaching(chain)
    T[:, :3, 3] += np.linspace(0, 0.02, len(T))[:, None] * rng.normal(size=3)
    limits = chain.limits.copy()
    limits[1] = q0[1] - 0.05, q0[1] + 0.05
    limits[2] = -3.0, 1.5
    chain = chain.replace(limits=limits)
    path = pk.follow(chain, T, q0=q0, task="position")
    assert path.ok
    assert path.largest_step < 0.05
    assert own(chain, path.q).all()
    assert ((path.q >= limits[:, 0]) & (path.q <= limits[:, 1])).all()
    assert [met.name for met in path.joints_at_limits] == ["joint3"]
    # Within the reading's limits alone the same path leaves joint 3's.
    wide = chain.replace(joint_limits=None)
    assert not own(chain, pk.follow(wide, T, q0=q0, task="position").q).all()


@pytest.mark.parametrize("seed", range(5))
def test_what_locked_readings_leave_of_joints_limits_is_the_domain_of_the_others(seed):
    rng = np.random.default_rng(seed)
    limits = ARM.limits.copy()
    limits[5] = -0.3, 0.2
    arm = ARM.replace(limits=limits)
    chain = arm.coupled(["J3 = J2 + 2 J3", "J4 = 3 J4 - J3", "J6 = J6 - 1/2 J5"])
    narrow = chain.limits * rng.uniform(0.1, 1, (6, 1))
    chain = chain.replace(limits=narrow)
    lock = tuple((name, 0.3 * chain.random(rng)[k]) for name, k in (("joint2", 1), ("joint6", 5)))
    units = joint_units(chain.compile(), True)
    domain = make_joint_domain(units, lock, True)
    x = domain.held(np.zeros(6))
    assert (domain.limits[:, 0] <= domain.limits[:, 1]).all()
    fast = units.fast.chain
    # Joint 4 follows two that are free: what it leaves of them is no box.
    asked = np.arange(6) != 3
    for k in (2, 4):
        for end, beyond in zip(domain.limits[k], (-1e-9, 1e-9), strict=True):
            x[k] = end
            assert not beyond_own_limits(fast, x)[asked].any()
            x[k] += beyond
            out = (x < fast.limits[:, 0]) | (x > fast.limits[:, 1])
            assert (beyond_own_limits(fast, x)[asked] | out[asked]).any()
        x[k] = 0.0


def test_beside_a_locked_reading_another_has_what_the_offset_of_its_joint_leaves_it():
    slides = [pk.screw.prismatic(way) for way in ([1, 0, 0], [0, 1, 0])]
    chain = pk.Chain.from_space(
        slides,
        np.eye(4),
        coupling=[[1, 0], [1, 1]],
        offset=[0, 0.25],
        joint_limits=[[0, 2], [0, 1]],
    )
    lock = {chain.q_names[0]: 0.5}
    domain = make_joint_domain(joint_units(chain.compile(), True), tuple(lock.items()), True)
    np.testing.assert_allclose(domain.limits[1], [-0.75, 0.25], atol=1e-15)
    assert pk.ik(chain, chain.fk([0.5, -0.7]), lock=lock).success


def test_readings_that_cannot_keep_a_joint_s_limits_beside_what_is_locked_have_their_own():
    chain = narrow(ARM.coupled("J3 = J2 + J3"), -0.1, 0.1)
    units = joint_units(chain.compile(), True)
    domain = make_joint_domain(units, (("joint2", 1.5),), True)
    np.testing.assert_array_equal(domain.limits[2], [-0.1, 0.1])
    found = pk.ik(chain, chain.fk([0.1, 1.5, 0.05, 0.2, 0.3, 0.4]), lock={"joint2": 1.5})
    assert found.reason == "limits"


def test_limits_of_joints_that_no_reading_beside_what_is_locked_can_keep_are_told():
    chain = ARM.coupled("J3 = J2 + J3")
    other = chain.replace(limits=[[-np.inf, np.inf]] * 6, joint_limits=LOWER_UPPER)
    q = np.array([0.1, UPPER[1] + 0.1, 0.2, 0.1, 0.2, 0.3])  # joint 2 itself is beyond
    found = pk.ik(other, other.fk(q), lock={"joint2": q[1]})
    assert not found.success
    assert "joint2" in found.limits_hit[0]


def test_a_trajectory_that_takes_a_joint_beyond_its_own_limits_says_so():
    names = ["a", "b"]
    slides = [pk.screw.prismatic([1, 0, 0]), pk.screw.prismatic([0, 1, 0])]
    table = pk.Chain.from_space(slides, np.eye(4), limits=[[0, 2.0], [0, 1]], joint_names=names)
    chain = table.coupled("b = a + b")
    x = np.array([[0.0, 0], [1, 1], [2, 1]])
    q = np.linalg.solve(chain.coupling, x.T).T
    found = pk.motion.time_optimal(chain, q, speed=1.0, acceleration=1.0)
    assert found.beyond_limits.tolist() == [0, 0]
    # The readings go 1 and sqrt 2: b of 0, 1, 1 there is s (2 + sqrt 2 - s) / (1 + sqrt 2), at most
    # (1 + sqrt 2) / 2.
    np.testing.assert_allclose(found.joints_beyond_limits, [0, (np.sqrt(2) - 1) / 2], rtol=1e-4)
    assert "joint 'b' leaves its own limits by 0.207 (rad or m)" in found.summary()
    inside = pk.motion.time_optimal(chain, q[:2], speed=1.0, acceleration=1.0)
    assert inside.joints_beyond_limits.tolist() == [0, 0]
    assert "leaves" not in inside.summary()


def offset_table():
    """Two slides; the second is at the sum of both readings and 0.25 m."""
    return pk.Chain.from_space(
        [pk.screw.prismatic([1, 0, 0]), pk.screw.prismatic([0, 1, 0])],
        np.eye(4),
        coupling=[[1, 0], [1, 1]],
        offset=[0, 0.25],
        joint_limits=[[0, 2], [0, 1]],
    )


def test_a_trajectory_is_beyond_a_joint_s_own_limits_by_the_joint_s_value_not_its_readings_alone():
    chain = offset_table()
    found = pk.motion.time_optimal(chain, [[0, 0], [0.5, 0.5]], speed=1.0, acceleration=1.0)
    np.testing.assert_allclose(found.joints_beyond_limits, [0, 0.25], rtol=1e-9)


def test_a_pose_is_within_a_joint_s_own_limits_by_the_joint_s_value_not_its_readings_alone():
    chain = offset_table()
    found = pk.ik(chain, chain.fk([[0.5, -0.65], [0.5, 0.35]]))  # the second slide at 0.1 and 1.1
    assert found.reason.tolist() == ["solved", "limits"]
    assert found.limits_hit == ((), ("joint2",))
