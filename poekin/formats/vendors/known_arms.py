"""Nominal kinematics of the vendors' arms, and the one among them that a calibration fits."""

from __future__ import annotations

import math
from functools import cache
from typing import NamedTuple

import numpy as np

from ...groups.arrays import Array
from ...groups.vectors import translation_part
from ...model.chain import Chain
from .. import dh, rpy
from .calibration import FactoryCalibration
from .deviations import Deviation, axis_deviations
from .naming import JOINTS, flexiv, ufactory
from .ur.tables import from_dh

PI = math.pi
H = math.pi / 2

Row = tuple[float, float, float, float, float, float]
Rows = tuple[Row, ...]

UR_TABLES = ("ur3", "ur5", "ur10", "ur3e", "ur5e", "ur10e", "ur16e")

UFACTORY: dict[str, Rows] = {
    "xarm5": (
        (0, 0, 0.267, 0, 0, 0),
        (0, 0, 0, -H, 0, 0),
        (0.0535, -0.2845, 0, 0, 0, 0),
        (0.0775, 0.3425, 0, 0, 0, 0),
        (0.076, 0.097, 0, -H, 0, 0),
    ),
    "xarm6": (
        (0, 0, 0.267, 0, 0, 0),
        (0, 0, 0, -H, 0, 0),
        (0.0535, -0.2845, 0, 0, 0, 0),
        (0.0775, 0.3425, 0, -H, 0, 0),
        (0, 0, 0, H, 0, 0),
        (0.076, 0.097, 0, -H, 0, 0),
    ),
    "xarm7": (
        (0, 0, 0.267, 0, 0, 0),
        (0, 0, 0, -H, 0, 0),
        (0, -0.293, 0, H, 0, 0),
        (0.0525, 0, 0, H, 0, 0),
        (0.0775, -0.3425, 0, H, 0, 0),
        (0, 0, 0, H, 0, 0),
        (0.076, 0.097, 0, -H, 0, 0),
    ),
    "xarm7_mirror": (
        (-0.00052471, 0, 0.2668, 0, 0, 0),
        (0, 0, 0, H, 0, 0),
        (0, 0.29289, 0, -H, 0, 0),
        (0.052665, 0, 0, -H, 0, 0),
        (0.077699, 0.34258, 0, -H, 0, 0),
        (0, 0, 0, -H, 0, 0),
        (0.075998, -0.096156, 0, H, 0, 0),
    ),
    "lite6": (
        (0, 0, 0.2435, 0, 0, 0),
        (0, 0, 0, H, -H, PI),
        (0.2002, 0, 0, -PI, 0, H),
        (0.087, -0.22761, 0, H, 0, 0),
        (0, 0, 0, H, 0, 0),
        (0, 0.0625, 0, -H, 0, 0),
    ),
    "uf850": (
        (0, 0, 0.364, 0, 0, 0),
        (0, 0, 0, H, -H, 0),
        (0.39, 0, 0, -PI, 0, -H),
        (0.15, 0.426, 0, -H, 0, 0),
        (0, 0, 0, -H, 0, 0),
        (0, -0.09, 0, H, 0, 0),
    ),
}
"""x, y, z [m], roll, pitch, yaw [rad] about fixed axes of each joint's origin; axes z.

Source: xarm_description, config/kinematics/default, one file an arm.
"""

FLEXIV: dict[str, Rows] = {
    "Rizon4 or 4s": (
        (0, 0, 0.155, 0, 0, PI),
        (0, 0.03, 0.21, 0, 0, 0),
        (0, 0.035, 0.205, 0, 0, 0),
        (-0.02, -0.03, 0.19, 0, 0, PI),
        (-0.02, 0.025, 0.195, 0, 0, PI),
        (0, 0.03, 0.19, 0, 0, 0),
        (-0.015, 0.073, 0.11, 0, -H, 0),
    ),
    "Rizon4R": (
        (0, 0, 0.155, PI, 0, PI),
        (0, 0.03, -0.21, 0, 0, PI),
        (0, -0.035, -0.205, 0, 0, PI),
        (-0.02, -0.03, -0.19, 0, 0, 0),
        (0.02, -0.025, -0.195, 0, 0, 0),
        (0, 0.03, -0.19, 0, 0, PI),
        (0.015, -0.073, -0.11, 0, -H, 0),
    ),
    "Rizon10 or 10s": (
        (0, 0, 0.21, 0, 0, PI),
        (0, 0.0675, 0.24, 0, 0, 0),
        (0, 0.0625, 0.2275, 0, 0, 0),
        (0, -0.0625, 0.2225, 0, 0, PI),
        (0, 0.0575, 0.205, 0, 0, PI),
        (0, 0.03, 0.19, 0, 0, 0),
        (-0.015, 0.073, 0.11, 0, -H, 0),
    ),
    "Rizon10R": (
        (0, 0, 0.21, PI, 0, PI),
        (0, 0.0675, -0.24, 0, 0, PI),
        (0, -0.0625, -0.2275, 0, 0, PI),
        (0, -0.0625, -0.2225, 0, 0, 0),
        (0, -0.0575, -0.205, 0, 0, 0),
        (0, 0.03, -0.19, 0, 0, PI),
        (0.015, -0.073, -0.11, 0, -H, 0),
    ),
    "Enlight-L": (
        (0, 0, 0.146, 0, 0, 0),
        (0, -0.037, 0.114, H, 0, 0),
        (0, 0.181, -0.037, -H, 0, 0),
        (0, 0.037, 0.109, -H, 0, 0),
        (0, -0.156, -0.037, H, 0, 0),
        (0, -0.0261, 0.124, H, 0, 0),
        (0, 0.134, -0.0261, -H, 0, 0),
    ),
}
"""Likewise; axes z y z y z y z for Rizon, all z for Enlight.

An arm with s in its name differs from the one without in what lies on and behind the last axis.
Source: flexiv_description, config, one file an arm.
"""

Z = (0.0, 0.0, 1.0)
Y = (0.0, 1.0, 0.0)
RIZON = (Z, Y, Z, Y, Z, Y, Z)
"""Axes of a Rizon, in rizon_arm.xacro where its files do not state them."""


class KnownArmFit(NamedTuple):
    """A known arm and the axis of it that is farthest off."""

    arm: KnownArm
    worst: Deviation


class KnownArm(NamedTuple):
    """A vendor's arm: its nominal calibration to the last link, and where its joints are."""

    name: str
    calibration: FactoryCalibration
    chain: Chain
    places: Array

    def fit(self, chain: Chain) -> KnownArmFit:
        """Fit of a chain of as many joints. What hangs behind the last joint does not count."""
        found = axis_deviations(self.chain, chain, self.places)
        return KnownArmFit(self, max(found, key=lambda deviation: deviation.score))


def known_arms(n: int) -> tuple[KnownArm, ...]:
    """The arms of n joints."""
    arms = numbered_arms(n)
    if n == len(JOINTS):
        arms = (*_universal_robots(), *arms)
    return arms


def numbered_arms(n: int) -> tuple[KnownArm, ...]:
    """The arms of n joints that UFACTORY and Flexiv make."""
    return tuple(arm for arm in _others() if len(arm.chain.joint_names) == n)


def best_fit(chain: Chain) -> KnownArmFit | None:
    """The known arm that a chain fits best, from the vendor's base on; None if it fits none."""
    fits = [arm.fit(chain) for arm in known_arms(len(chain.joint_names))]
    best = min(fits, key=lambda fit: fit.worst.score, default=None)
    if best is None or best.worst.far:
        return None
    return best


@cache
def _universal_robots() -> tuple[KnownArm, ...]:
    arms = []
    for name in UR_TABLES:
        table = dh.published(name)
        arms.append(_known(name, from_dh(table, nominal=table)))
    return tuple(arms)


@cache
def _others() -> tuple[KnownArm, ...]:
    arms = []
    for name, rows in UFACTORY.items():
        arms.append(_known(name, FactoryCalibration(_poses(rows), naming=ufactory(len(rows)))))
    for name, rows in FLEXIV.items():
        axes = np.tile(Z, (len(rows), 1))
        if name.startswith("Rizon"):
            axes = np.array(RIZON)
        naming = flexiv(len(rows), flange=False)
        arms.append(_known(name, FactoryCalibration(_poses(rows), naming=naming, axes=axes)))
    return tuple(arms)


def _known(name: str, calibration: FactoryCalibration) -> KnownArm:
    places = []
    T = np.eye(4)
    for pose in calibration.poses:
        T = T @ pose
        places.append(translation_part(T))
    return KnownArm(name, calibration, calibration.to_chain(), np.array(places))


def _poses(rows: Rows) -> Array:
    return np.array([rpy.pose(row[:3], row[3:]) for row in rows])
