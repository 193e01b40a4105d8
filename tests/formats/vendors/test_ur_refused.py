"""What is no calibration of an arm of Universal Robots, or none of this one, is refused by name."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import poekin as pk
from benchmarks.calibrated_arm import UR10E
from poekin.errors import PoekinError
from poekin.formats import vendors
from poekin.formats.dh import Row, Table
from poekin.formats.vendors import ur
from tests.formats.vendors.test_ur import NOMINAL, nominal_robot

ANY: Any = "ur10e"
MAKERS = "dh.read(path), dh.published(name) and dh.from_chain(...).table make one"
SEVENTH: Any = 7
SEVEN = Table("standard", [Row(a=0.1, alpha=0.1 * i) for i in range(7)], name="seven")
FLIPPED = Table(
    "standard",
    [Row(**{**r.__dict__, "flip": i == 2}) for i, r in enumerate(NOMINAL.rows)],
    name="flipped",
)
SLIDING = Table("standard", [Row(**{**r.__dict__, "kind": "prismatic" if i == 1 else r.kind})
                             for i, r in enumerate(NOMINAL.rows)], name="sliding")  # fmt: skip
TOOLED = Table("standard", NOMINAL.rows, tool=pk.se3.exp([0, 0, 0, 0.1, 0, 0]), name="tooled")
UPSIDE = ur.add_deltas(NOMINAL, delta_alpha=[math.pi, 0, 0, 0, 0, 0])


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (
            lambda: ur.from_dh(SEVEN, nominal=NOMINAL),
            (
                "an arm of Universal Robots has 6 joints, the table 'seven' has 7: 'joint1', "
                "'joint2', 'joint3', 'joint4', 'joint5', 'joint6', 'joint7'"
            ),
        ),
        pytest.param(
            lambda: ur.from_dh(UR10E, nominal=SEVEN),
            "an arm of Universal Robots has 6 joints, the table 'seven' has 7: 'joint1', "
            "'joint2', 'joint3', 'joint4', 'joint5', 'joint6', 'joint7'",
            id="nominal table of seven joints",
        ),
        (
            lambda: ur.from_dh(FLIPPED, nominal=NOMINAL),
            (
                "table 'flipped': joint 'elbow_joint' is flipped; a calibration has turning joints about +z"
            ),
        ),
        (
            lambda: ur.from_dh(SLIDING, nominal=NOMINAL),
            (
                "table 'sliding': joint 'shoulder_lift_joint' is prismatic; a calibration has turning joints about +z"
            ),
        ),
        (
            lambda: ur.from_dh(TOOLED, nominal=NOMINAL),
            (
                "the flange of the table 'tooled' is off the axis of 'wrist_3_joint': a calibration "
                "has no place for a or alpha of the last joint, nor for a tool"
            ),
        ),
        (
            lambda: ur.from_dh(UPSIDE, nominal=NOMINAL),
            (
                "the axis of 'shoulder_lift_joint' points the other way in the table 'ur10e' "
                "than in 'ur10e': they are not of the same arm"
            ),
        ),
        (
            lambda: ur.from_dh(pk.dh.published("panda"), nominal=NOMINAL),
            (
                "an arm of Universal Robots has 6 joints, the table 'panda' has 7: "
                "'panda_joint1', 'panda_joint2', 'panda_joint3', 'panda_joint4', 'panda_joint5', "
                "'panda_joint6', 'panda_joint7'"
            ),
        ),
        (
            lambda: ur.from_dh(UR10E, nominal=ANY),
            f"from_dh: expected a dh.Table, got 'ur10e'; {MAKERS}",
        ),
        (lambda: ur.add_deltas(ANY), f"add_deltas: expected a dh.Table, got 'ur10e'; {MAKERS}"),
        (
            lambda: ur.add_deltas(NOMINAL, delta_a=[0.0] * 7),
            (
                "delta_a: expected 6 numbers, one a joint of the table 'ur10e', got 7: the calibration of another arm?"
            ),
        ),
        (
            lambda: ur.add_deltas(NOMINAL, delta_a=[[0.0] * 6]),
            (
                "delta_a: expected 6 numbers, one a joint of the table 'ur10e', got shape (1, "
                "6): the calibration of another arm?"
            ),
        ),
        (
            lambda: ur.add_deltas(NOMINAL, delta_d=[0, 0, math.nan, 0, 0, 0]),
            "delta_d[2]: expected a finite number, got nan",
        ),
        (
            lambda: pk.calibration.apply(nominal_robot(), ANY),
            "'ur10e': expected a calibration, a .toml of `Calibration.save` or a .yaml of a vendor; "
            "pk.relinked puts the chain of any other model on a robot",
        ),
        (
            lambda: pk.calibration.apply(
                pk.load("panda"), ur.from_dh(UR10E, nominal=NOMINAL), tip="panda_hand"
            ),
            (
                "the robot has 7 joints from 'panda_link0' to 'panda_hand': 'panda_joint1', "
                "'panda_joint2', 'panda_joint3', 'panda_joint4', 'panda_joint5', 'panda_joint6', "
                "'panda_joint7'; the chain has 6: 'shoulder_pan_joint', 'shoulder_lift_joint', "
                "'elbow_joint', 'wrist_1_joint', 'wrist_2_joint', 'wrist_3_joint'; it fits 'ur10e', "
                "within 1.38 mm and 0.359°"
            ),
        ),
        (
            lambda: vendors.FactoryCalibration(np.eye(4)[None].repeat(7, 0)),
            "poses: expected shape (6, 4, 4), one pose a link, got (7, 4, 4)",
        ),
        (
            lambda: vendors.FactoryCalibration(np.eye(4)[None].repeat(6, 0) * 2),
            "pose of shoulder is no pose: its last row is [0.0, 0.0, 0.0, 2.0], expected [0, 0, 0, 1]",
        ),
        (
            lambda: vendors.FactoryCalibration(np.eye(4)[None].repeat(6, 0), SEVENTH),
            "hash: expected a text, got 7",
        ),
    ],
)
def test_what_is_no_calibration_of_this_arm_is_refused(make, message):
    with pytest.raises(PoekinError) as caught:
        make()
    assert str(caught.value) == message
    assert isinstance(caught.value, ValueError)
