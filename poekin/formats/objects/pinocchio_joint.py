"""What a joint of a Pinocchio model is: its elementary motions, in the words of poekin's joints."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ...errors import ModelError, quote
from ...groups.arrays import Array
from .attributes import has

_PREFIX = "JointModel"
_UNIT = {"X": (1.0, 0.0, 0.0), "Y": (0.0, 1.0, 0.0), "Z": (0.0, 0.0, 1.0)}
_X, _Y, _Z = _UNIT.values()
# Joints of several degrees of freedom that are elementary motions one after the other, with the
# axes in their order.
_SERIES = {
    "SphericalZYX": (("revolute", _Z), ("revolute", _Y), ("revolute", _X)),
    "Translation": (("prismatic", _X), ("prismatic", _Y), ("prismatic", _Z)),
}
_FREE = {"FreeFlyer": "floating", "Planar": "planar"}
_KINDS = {"R": "revolute", "RUB": "continuous", "P": "prismatic", "H": "helical"}
_UNALIGNED = {
    "RevoluteUnaligned": "revolute",
    "RevoluteUnboundedUnaligned": "continuous",
    "PrismaticUnaligned": "prismatic",
    "HelicalUnaligned": "helical",
}


class Motion(NamedTuple):
    """One elementary motion: pose of its frame behind the one before it, kind, axis, pitch [m per
    rad].
    """

    origin: Array
    kind: str
    axis: tuple[float, ...]
    pitch: float = 0.0


def joint_type(joint: Any) -> str:
    """The type of a joint, as in "RX"."""
    return str(joint.shortname()).removeprefix(_PREFIX)


def motions(joint: Any, name: str) -> list[Motion]:
    """The elementary motions of a joint of a model, one after the other.

    Raises: ModelError that names the joint where it has none: spherical (a unit quaternion) and
    ellipsoid joints, and
    a mimic joint or a type not known here whose axis cannot be read.
    """
    kind, bare = joint_type(joint), joint.extract() if has(joint, "extract") else joint
    here = np.eye(4)
    if kind in _FREE:
        return [Motion(here, _FREE[kind], _Z)]
    if kind in _SERIES:
        return [Motion(here, single, axis) for single, axis in _SERIES[kind]]
    if kind == "Universal":
        return [Motion(here, "revolute", _three(axis)) for axis in (bare.axis1, bare.axis2)]
    if kind == "Composite":
        return [
            Motion(placement.homogeneous @ first.origin if i == 0 else first.origin, *first[1:])
            for placement, part in zip(bare.jointPlacements, bare.joints, strict=True)
            for i, first in enumerate(motions(part, name))
        ]
    stem, letter = kind[:-1], kind[-1:]
    if stem in _KINDS and letter in _UNIT:
        return [Motion(here, _KINDS[stem], _UNIT[letter], float(getattr(bare, "pitch", 0.0)))]
    if kind in _UNALIGNED and has(bare, "axis"):
        return [
            Motion(here, _UNALIGNED[kind], _three(bare.axis), float(getattr(bare, "pitch", 0.0)))
        ]
    if kind in _UNALIGNED or kind == "Mimic":
        return [_by_subspace(joint, bare, name, _UNALIGNED.get(kind))]
    raise ModelError(
        f"joint {quote(name)}: a Pinocchio joint of type {quote(kind)} has no counterpart in a Robot; known are"
        f" revolute, prismatic, helical, free-flyer, planar, translation, universal, spherical ZYX and composite ones"
    )


def _by_subspace(joint: Any, bare: Any, name: str, kind: str | None) -> Motion:
    """Of a joint whose axis Pinocchio tells by its motion subspace S = (v; omega) only, which is
    constant.
    """
    scaling = float(getattr(bare, "scaling", 1.0))
    S = np.asarray(joint.createData().S, dtype=float).ravel()
    v, w = S[:3], S[3:]
    if S.shape != (6,) or not S.any():
        raise ModelError(
            f"joint {quote(name)}: Pinocchio does not tell the axis of this {quote(joint_type(joint))} joint"
            f"{' of multiplier 0' if not scaling else ''}"
        )
    turns = bool(w.any())
    axis = _three((w if turns else v) / scaling)
    return Motion(np.eye(4), kind or ("revolute" if turns else "prismatic"), axis)


def _three(axis: Any) -> tuple[float, ...]:
    x, y, z = (float(a) for a in axis)
    return x + 0.0, y + 0.0, z + 0.0
