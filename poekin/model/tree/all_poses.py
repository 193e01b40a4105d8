"""Poses of all links of a robot."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from ...errors import InputError, ShapeError, UnknownName, quote, safe_repr, suggest
from ...groups.arrays import poses as pose_arrays
from ..coordinates import coordinates
from ..joint import FREE
from ..kinematics.degrees import warn_of_degrees
from .robot_parts import RobotParts
from .tree_arrays import link_poses


def all_poses(
    parts: RobotParts,
    q: Any,
    poses: Mapping[str, Any] | None,
) -> dict[str, np.ndarray]:
    """Pose (..., 4, 4) of each link in the root link's frame."""
    names = parts.coupling.q_names
    values = coordinates(q, names, f"robot {quote(parts.name)}")
    joints = [parts.joints[j] for j in parts.coupling.master]
    warn_of_degrees(
        values,
        names,
        parts.limits,
        lambda: np.array([joint.kind != "prismatic" for joint in joints], float),
        f"robot {quote(parts.name)}",
    )
    if parts.readings is not None:
        values = values @ parts.readings.T
    free = _free_poses(parts, {} if poses is None else poses)
    batch = _common_batch(parts, values.shape[:-1], free)
    count = math.prod(batch)  # said, not inferred: -1 means nothing where an axis is empty
    flat = np.broadcast_to(values, (*batch, len(names))).reshape(count, len(names))
    free = {
        joint: np.broadcast_to(T, (*batch, 4, 4)).reshape(count, 4, 4) for joint, T in free.items()
    }
    out = link_poses(parts.layout, flat, free).reshape(*batch, len(parts.links), 4, 4)
    rows = parts.layout.link_row.tolist()
    return {link: out[..., row, :, :] for link, row in zip(parts.links, rows, strict=True)}


def _free_poses(parts: RobotParts, poses: Mapping[str, Any]) -> dict[int, np.ndarray]:
    """The poses of floating and planar joints, checked, by the number of the joint."""
    place = parts.place.place()
    if not isinstance(poses, Mapping):
        raise InputError(
            f"{place}: poses must be a dict from joint to pose (..., 4, 4), got {safe_repr(poses)}"
        )
    free = {joint.name: number for number, joint in enumerate(parts.joints) if joint.kind in FREE}
    checked = {}
    for name, value in poses.items():
        if name not in free:
            raise UnknownName(
                f"{place}: poses names {quote(name)}, which is no floating or planar joint;"
                f" {suggest(str(name), free)}"
            )
        checked[free[name]] = pose_arrays(value, f"pose of joint {quote(name)}")
    return checked


def _common_batch(
    parts: RobotParts,
    q: tuple[int, ...],
    poses: Mapping[int, np.ndarray],
) -> tuple[int, ...]:
    """The leading axes that those of q and of the poses broadcast to."""
    batch = q
    for joint, T in poses.items():
        shape = T.shape[:-2]
        try:
            batch = np.broadcast_shapes(batch, shape)
        except ValueError as fault:
            named = quote(parts.joints[joint].name)
            raise ShapeError(
                f"{parts.place.place()}: the leading axes of q and poses do not broadcast: the pose"
                f" of joint {named} has {shape}, and what comes before it {batch}"
            ) from fault
    return batch
