"""Nominal kinematics of the vendors' arms, and the one among them that a calibration fits."""

from __future__ import annotations

import pkgutil
import tomllib
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

UR_TABLES = ("ur3", "ur5", "ur10", "ur3e", "ur5e", "ur10e", "ur16e")

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
    data = pkgutil.get_data(__name__, "known_arms.toml") or b""
    tables = tomllib.loads(data.decode("utf-8"))
    arms = [
        _known(name, FactoryCalibration(_poses(rows), naming=ufactory(len(rows))))
        for name, rows in tables["UFACTORY"].items()
    ]
    for name, rows in tables["Flexiv"].items():
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


def _poses(rows: list[list[float]]) -> Array:
    return np.array([rpy.pose(row[:3], np.radians(row[3:]).tolist()) for row in rows])
