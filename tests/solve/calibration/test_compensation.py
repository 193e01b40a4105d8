"""Commands that put the true arm where it should be."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError
from poekin.groups import so3
from poekin.solve.calibration import calibrate
from poekin.solve.calibration.terms.named import BUILDERS
from tests.solve.calibration.terms.sagging import arm, case

CHAIN = arm("ur5")
MADE = case(CHAIN, 0, sag=1e-3, count=120)
PAYLOAD = np.linspace(0, 3, 120)
KINDS: Any = ("screws", "home", "gains", *BUILDERS)
EVERY = calibrate(
    CHAIN, MADE.q, MADE.points, parameters=KINDS, folds=0,
    on_rank_deficiency="fix", conditions={"payload": PAYLOAD},
)  # fmt: skip
SAG = calibrate(
    CHAIN, MADE.q, MADE.points, parameters=("screws", "home", "compliance"),
    on_rank_deficiency="fix", folds=0,
)  # fmt: skip
LAST = MADE.q[:3]


@pytest.mark.parametrize(
    ("found", "conditions"),
    [(SAG, None), (EVERY, None), (EVERY, {"payload": 5.0, "previous": LAST})],
    ids=["sag", "all", "all, conditions"],
)
def test_the_true_arm_is_at_the_target_after_the_nominal_controllers_command(found, conditions):
    T = CHAIN.fk(MADE.fresh[:3])
    command = found.compensate(T, conditions=conditions, nearest_to=MADE.fresh[:3])
    reached = found.chain.fk(found.true_joints(command.q, conditions))
    assert np.linalg.norm(reached[:, :3, 3] - T[:, :3, 3], axis=1).max() <= 1e-9
    turns = so3.log(np.swapaxes(reached[:, :3, :3], 1, 2) @ T[:, :3, :3])
    assert np.linalg.norm(turns, axis=1).max() <= 1e-9
    # the controller solves its own inverse kinematics, of the nominal arm
    alone = pk.ik(CHAIN, command.T, nearest_to=command.q)
    np.testing.assert_allclose(alone.q, command.q, rtol=0, atol=1e-8)
    # what it is about: half a millimetre and more
    assert np.linalg.norm(command.T[:, :3, 3] - T[:, :3, 3], axis=1).min() > 5e-4


def test_one_pose_is_a_batch_without_axes():
    T = CHAIN.fk(MADE.fresh[0])
    command = SAG.compensate(T)
    assert command.q.shape == (6,)
    assert command.T.shape == (4, 4)
    assert SAG.true_joints(dict(zip(CHAIN.q_names, command.q, strict=True))).shape == (6,)


def test_the_command_is_near_the_configuration_that_was_asked_for():
    q = MADE.fresh[:3]
    command = SAG.compensate(CHAIN.fk(q), nearest_to=q)
    assert np.abs(command.q - q).max() < 0.2
    assert np.abs(SAG.compensate(CHAIN.fk(q)).q - q).max() > 1.0


def test_without_terms_the_true_joints_are_the_readings():
    plain = calibrate(CHAIN, MADE.q, MADE.points, folds=0, on_rank_deficiency="fix")
    q = CHAIN.random(0, 6).reshape(2, 3, 6)
    np.testing.assert_array_equal(plain.true_joints(q), q)


def test_what_is_out_of_reach_is_refused():
    T = np.eye(4)
    T[0, 3] = 9.0
    with pytest.raises(InputError, match="compensate: the calibrated arm cannot reach T"):
        SAG.compensate(T)
