"""What is no calibration of an arm of Universal Robots, or none of this one, is refused by name."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.errors import PoekinError
from poekin.formats import ur
from poekin.formats.dh import Row, Table
from poekin.testing.calibrated_arm import UR10E
from tests.formats.test_ur import NOMINAL, nominal_robot

ANY: Any = "ur10e"
SEVENTH: Any = 7
SEVEN = Table("standard", [Row(a=0.1, alpha=0.1 * i) for i in range(7)], name="seven")
FLIPPED = Table("standard", [Row(**{**r.__dict__, "flip": i == 2}) for i, r in enumerate(NOMINAL.rows)], name="flipped")
SLIDING = Table("standard", [Row(**{**r.__dict__, "kind": "prismatic" if i == 1 else r.kind})
                             for i, r in enumerate(NOMINAL.rows)], name="sliding")  # fmt: skip
TOOLED = Table("standard", NOMINAL.rows, tool=pk.se3.exp([0, 0, 0, 0.1, 0, 0]), name="tooled")
UPSIDE = ur.deltas(NOMINAL, delta_alpha=[math.pi, 0, 0, 0, 0, 0])


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: ur.from_dh(SEVEN, nominal=NOMINAL), r"has 6 joints, the table 'seven' has 7: 'joint1', 'joint2'"),
        (lambda: ur.from_dh(UR10E, nominal=SEVEN), r"has 6 joints, the table 'seven' has 7"),
        (lambda: ur.from_dh(FLIPPED, nominal=NOMINAL), r"table 'flipped': joint 'elbow_joint' is flipped"),
        (lambda: ur.from_dh(SLIDING, nominal=NOMINAL), r"joint 'shoulder_lift_joint' is prismatic"),
        (lambda: ur.from_dh(TOOLED, nominal=NOMINAL), r"'wrist_3_link' is the tip .* off that joint's axis, by 100 mm"),
        (lambda: ur.from_dh(UPSIDE, nominal=NOMINAL), r"axis of 'shoulder_lift_joint' points the other way"),
        (lambda: ur.from_dh(pk.dh.published("panda"), nominal=NOMINAL), r"the table 'panda' has 7"),
        (lambda: ur.from_dh(UR10E, nominal=ANY), r"expected a dh.Table, got str"),
        (lambda: ur.deltas(ANY), r"deltas: expected a dh.Table, got str"),
        (
            lambda: ur.deltas(NOMINAL, delta_a=[0.0] * 7),
            r"delta_a: expected 6 numbers.* got 7: the calibration of anot",
        ),
        (lambda: ur.deltas(NOMINAL, delta_a=[[0.0] * 6]), r"delta_a: expected 6 numbers.* got shape \(1, 6\)"),
        (
            lambda: ur.deltas(NOMINAL, delta_d=[0, 0, math.nan, 0, 0, 0]),
            r"delta_d\[2\]: expected a finite number, got nan",
        ),
        (lambda: ur.apply(nominal_robot(), ANY), r"apply: expected a Calibration, got str"),
        (
            lambda: ur.apply(pk.load("panda"), ur.from_dh(UR10E, nominal=NOMINAL), tip="panda_hand"),
            r"has 7 joints from",
        ),
        (
            lambda: ur.Calibration(np.eye(4)[None].repeat(7, 0)),
            r"expected shape \(6, 4, 4\), one pose a link, got \(7,",
        ),
        (lambda: ur.Calibration(np.eye(4)[None].repeat(6, 0) * 2), r"pose of shoulder is no pose: its last row is"),
        (lambda: ur.Calibration(np.eye(4)[None].repeat(6, 0), SEVENTH), r"hash: expected a text, got 7"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_what_is_no_calibration_of_this_arm_is_refused(make, message):
    with pytest.raises(PoekinError, match=message) as caught:
        make()
    assert isinstance(caught.value, ValueError)
