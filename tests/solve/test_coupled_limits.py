"""Solvers keep the joints of coupled readings within their own limits, and lose no solution."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import poekin as pk

ARM = pk.load("puma560").chain()
SAID = {
    "Fanuc": "J3 = J2 + J3",
    "differential wrist": ["J5 = 1/2 J5 + 1/2 J6", "J6 = 1/2 J5 - 1/2 J6"],
}
LOWER, UPPER = ARM.limits.T


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
    assert every.count.tolist() == alone.count.tolist()
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
