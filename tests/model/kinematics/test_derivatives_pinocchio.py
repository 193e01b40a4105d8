"""Rate and Hessian of the Jacobian, and acceleration, against Pinocchio; the benchmark does it for
every robot.
"""

from __future__ import annotations

import warnings

import numpy as np
import pytest

from benchmarks.derivative_errors import derivative_errors
from benchmarks.pinocchio_derivatives import derivatives
from poekin.analysis.validate import routes
from poekin.errors import InputError, PoekinWarning
from poekin.formats.erd import example_robots
from poekin.formats.load import load
from poekin.testing.oracles.pinocchio_oracle import PinocchioOracle
from tests.versions import needs

ROBOTS = example_robots()[0]
# One arm, one with a gripper, mimic joints, prismatic joints, legs below a floating joint, two
# joints.
SAMPLE = ["panda", "ur5_robot", "talos_full_v2", "pr2", "go2", "TwoDofs", "romeo_small"]
BAR = 1e-13  # of the issue; 1e-14 is what all 721 chains of the 68 robots hold in the benchmark


def model(name):
    needs("pin", "3")  # Pinocchio 2 has no kinematic Hessians in Python
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PoekinWarning)
        robot = load(ROBOTS[name])
    with open(ROBOTS[name], "rb") as stream:
        return robot, PinocchioOracle(stream.read())


@pytest.mark.parametrize("name", SAMPLE)
def test_every_chain_of_a_robot_has_pinocchio_s_derivatives(name):
    robot, oracle = model(name)
    for base, tip, _ in routes(robot):
        errors = derivative_errors(robot.chain(base, tip), oracle, samples=2)
        assert errors.worst <= BAR, (base, tip, errors)


class Wrong:
    """A chain, one of whose methods answers wrongly."""

    def __init__(self, chain, **wrong):
        self._chain, self._wrong = chain, wrong

    def __getattr__(self, name):
        return self.__dict__["_wrong"].get(name) or getattr(self.__dict__["_chain"], name)


def _spatial(chain, q, dq, ddq, frame):
    """p'' - omega x p' in the hybrid frame."""
    A, V = chain.acceleration(q, dq, ddq, frame).copy(), chain.velocity(q, dq, frame)
    if frame == "hybrid":
        A[..., 3:] -= np.cross(V[..., :3], V[..., 3:])
    return A


PLANTED = {
    "a rate 1e-11 off": lambda c: {"jacobian_rate": lambda *a: c.jacobian_rate(*a) * (1 + 1e-11)},
    "indices swapped": lambda c: {"hessian": lambda *a: np.swapaxes(c.hessian(*a), -1, -2)},
    "spatial for classical": lambda c: {"acceleration": lambda *a: _spatial(c, *a)},
}


@pytest.mark.parametrize("fault", PLANTED)
def test_the_comparison_sees_what_is_wrong(fault):
    robot, oracle = model("panda")
    chain = robot.chain(tip=robot.leaves[0])
    assert derivative_errors(chain, oracle, samples=2).worst <= BAR
    assert derivative_errors(Wrong(chain, **PLANTED[fault](chain)), oracle, samples=2).worst > BAR


def test_a_base_that_moves_is_refused():
    robot, oracle = model("panda")
    q = {name: np.zeros(1) for name in oracle.coordinates}
    rates = np.ones((1, len(oracle.coordinates)))
    with pytest.raises(InputError, match=r"^the base 'panda_link3' moves: rates of 0 expected"):
        derivatives(oracle, q, rates, rates, robot.leaves[0], "panda_link3")
