"""Entries joint1 to jointN of a calibration's file, by which UFACTORY and Flexiv name them alike."""

from __future__ import annotations

import re

import numpy as np

from ...errors import ModelError, join_names, quote
from ...groups.arrays import Array
from ...model.provenance import warn
from ..text.yaml_text import MappingNode
from . import yaml_keys
from .calibration import FactoryCalibration
from .known_arms import RIZON, KnownArmFit, numbered_arms
from .naming import Vendor, flexiv, ufactory

SIZES = (5, 6, 7)
_JOINT = re.compile(r"joint\d+")
_Z = np.array([0.0, 0.0, 1.0])


def is_numbered(entries: MappingNode) -> bool:
    """Tests whether some of the keys are joint1, joint2, ..."""
    return any(_JOINT.fullmatch(key) for key in entries.items)


def calibration(
    entries: MappingNode,
    place: str,
    rpy: str,
    metadata: MappingNode | None,
    vendor: Vendor | None,
) -> FactoryCalibration:
    """The calibration that the entries are; metadata, what the file says of the arm as a whole.

    Raises: ModelError. Warns: of joints not measured.
    """
    n = sum(_JOINT.fullmatch(key) is not None for key in entries.items)
    if n not in SIZES:
        raise ModelError(
            f"{place}:{entries.line}: kinematics: expected joint1 to joint5, joint6 or joint7, got"
            f" {join_names(entries.items)}"
        )
    names = ufactory(n).entries
    flange_key = flexiv(n).tip_joint
    yaml_keys.check(entries, names, (flange_key, "hash"), place, "kinematics")
    poses = np.array(
        [yaml_keys.pose(entries, name, place, rpy, (yaml_keys.AXIS,)) for name in names]
    )
    stated = [yaml_keys.axis(entries, name, place) for name in names]
    axes = None
    if any(axis is not None for axis in stated):
        axes = np.array([_Z if axis is None else axis for axis in stated])
    flange = np.eye(4)
    has_flange = flange_key in entries.items
    if has_flange:
        flange = yaml_keys.pose(entries, flange_key, place, rpy)
    signs = axes is not None or has_flange or metadata is not None
    if vendor is None:
        vendor = _vendor(poses, signs, place)
    mark = yaml_keys.text(entries, "hash", place)
    if vendor != "Flexiv":
        return FactoryCalibration(poses, mark, ufactory(n))
    model = ""
    if metadata is not None:
        model = yaml_keys.text(metadata, "model_name", place)
        mark = mark or yaml_keys.text(metadata, "robot_sn", place)
        _warn_if_partly(metadata, n, place)
    if axes is None:
        axes = _axes(model, poses, place)
    naming = flexiv(n, flange=has_flange)
    return FactoryCalibration(poses, mark, naming, axes, flange)


def _fit(poses: Array) -> KnownArmFit:
    """The arm of UFACTORY or Flexiv that poses fit best whose joints turn about its axes."""
    found = []
    for arm in numbered_arms(len(poses)):
        nominal = arm.calibration
        trial = FactoryCalibration(poses, naming=nominal.naming, axes=nominal.axes)
        found.append(arm.fit(trial.to_chain()))
    return min(found, key=lambda fit: fit.worst.score)


def _vendor(
    poses: Array,
    signs: bool,
    place: str,
) -> Vendor:
    """The vendor, by what only Flexiv writes, else by the arm that is meant."""
    if signs:
        return "Flexiv"
    if len(poses) != max(SIZES):
        return "UFACTORY"
    best = _fit(poses)
    if best.worst.far:
        raise ModelError(
            f"{place}: expected an arm of UFACTORY or Flexiv, and this is near none that is known:"
            f" of the nearest, {quote(best.arm.name)}, {quote(best.worst.name)} is"
            f" {best.worst.summary()} off; vendor='UFACTORY' or vendor='Flexiv' of"
            " pk.vendors.read says which it is"
        )
    return best.arm.calibration.naming.vendor


def _axes(model: str, poses: Array, place: str) -> Array:
    """Axes of an arm of Flexiv whose file does not state them."""
    if model.startswith("Rizon") and len(poses) == len(RIZON):
        return np.array(RIZON)
    best = _fit(poses)
    if not best.worst.far and best.arm.calibration.vendor == "Flexiv":
        return best.arm.calibration.axes
    raise ModelError(
        f"{place}: no joint states its axis, and it is near no arm of Flexiv that is known: write"
        " axis: 0 1 0 below each joint that turns about y, and axis: 0 0 1 below one that turns about z"
    )


def _warn_if_partly(metadata: MappingNode, n: int, place: str) -> None:
    said = yaml_keys.text(metadata, "joints_synced", place)
    if said.isascii() and said.isdecimal() and int(said) < n:
        line = metadata.items["joints_synced"].line
        warn(f"{place}:{line}: only {said} of {n} joints are measured, the others are nominal")
