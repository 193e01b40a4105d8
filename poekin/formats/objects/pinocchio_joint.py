"""Elementary motions of the joints of a Pinocchio model."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ...errors import ModelError, quote
from ...groups.arrays import Array
from ...model.joint import JointKind
from .attributes import has

_PREFIX = "JointModel"
_UNIT = {
    "X": (1.0, 0.0, 0.0),
    "Y": (0.0, 1.0, 0.0),
    "Z": (0.0, 0.0, 1.0),
}
_X, _Y, _Z = _UNIT.values()
# Joints of several degrees of freedom that are elementary motions one after the other, with the
# axes in their order.
_SERIES: dict[str, tuple[tuple[JointKind, tuple[float, ...]], ...]] = {
    "SphericalZYX": (("revolute", _Z), ("revolute", _Y), ("revolute", _X)),
    "Translation": (("prismatic", _X), ("prismatic", _Y), ("prismatic", _Z)),
}
_FREE: dict[str, JointKind] = {"FreeFlyer": "floating", "Planar": "planar"}
_KINDS: dict[str, JointKind] = {
    "R": "revolute",
    "RUB": "continuous",
    "P": "prismatic",
    "H": "helical",
}
_UNALIGNED: dict[str, JointKind] = {
    "RevoluteUnaligned": "revolute",
    "RevoluteUnboundedUnaligned": "continuous",
    "PrismaticUnaligned": "prismatic",
    "HelicalUnaligned": "helical",
}


class ElementaryMotion(NamedTuple):
    """Elementary motion: pose of its frame in the one before, kind, axis, pitch [m per rad]."""

    origin: Array
    kind: JointKind
    axis: tuple[float, ...]
    pitch: float = 0.0


def joint_type(joint: Any) -> str:
    """The type of a joint, as in "RX"."""
    return str(joint.shortname()).removeprefix(_PREFIX)


def extracted(joint: Any) -> Any:
    """The joint itself, out of Pinocchio's variant of all joints where it is in one."""
    if has(joint, "extract"):
        return joint.extract()
    return joint


def motions(joint: Any, name: str) -> list[ElementaryMotion]:
    """The elementary motions of a joint of a model, one after the other.

    Raises: ModelError that names the joint where it has none: spherical (a unit quaternion) and
    ellipsoid joints, and a mimic joint or a type not known here whose axis cannot be read.
    """
    kind = joint_type(joint)
    bare = extracted(joint)
    here = np.eye(4)
    if kind in _FREE:
        return [ElementaryMotion(here, _FREE[kind], _Z)]
    if kind in _SERIES:
        return [ElementaryMotion(here, single, axis) for single, axis in _SERIES[kind]]
    if kind == "Universal":
        axes = (bare.axis1, bare.axis2)
        return [ElementaryMotion(here, "revolute", _three(axis)) for axis in axes]
    if kind == "Composite":
        parts = []
        for placement, part in zip(bare.jointPlacements, bare.joints, strict=True):
            inner = motions(part, name)
            for first in inner[:1]:
                origin = placement.homogeneous @ first.origin
                inner[0] = first._replace(origin=origin)
            parts += inner
        return parts
    pitch = float(getattr(bare, "pitch", 0.0))
    stem = kind[:-1]
    letter = kind[-1:]
    if stem in _KINDS and letter in _UNIT:
        return [ElementaryMotion(here, _KINDS[stem], _UNIT[letter], pitch)]
    if kind in _UNALIGNED and has(bare, "axis"):
        return [ElementaryMotion(here, _UNALIGNED[kind], _three(bare.axis), pitch)]
    if kind in _UNALIGNED or kind == "Mimic":
        return [_by_subspace(joint, bare, name, _UNALIGNED.get(kind))]
    raise ModelError(
        f"joint {quote(name)}: a Pinocchio joint of type {quote(kind)} has no counterpart in a Robot; known are"
        f" revolute, prismatic, helical, free-flyer, planar, translation, universal, spherical ZYX and composite ones"
    )


def _by_subspace(
    joint: Any,
    bare: Any,
    name: str,
    kind: JointKind | None,
) -> ElementaryMotion:
    """Motion of a joint whose axis stands only in its constant motion subspace S = (v; omega)."""
    scaling = float(getattr(bare, "scaling", 1.0))
    S = np.asarray(joint.createData().S, dtype=float).ravel()
    if S.shape != (6,) or not S.any():
        message = (
            f"joint {quote(name)}: Pinocchio does not tell the axis of this"
            f" {quote(joint_type(joint))} joint"
        )
        if not scaling:
            message += " of multiplier 0"
        raise ModelError(message)
    if S[3:].any():
        omega = _three(S[3:] / scaling)
        return ElementaryMotion(np.eye(4), kind or "revolute", omega)
    v = _three(S[:3] / scaling)
    return ElementaryMotion(np.eye(4), kind or "prismatic", v)


def _three(axis: Any) -> tuple[float, ...]:
    x, y, z = (float(a) for a in axis)
    return x + 0.0, y + 0.0, z + 0.0
