"""Chain between two links of a robot, along the tree or against it."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...algebra import IDENTITY, adjoint, compose, inverse
from ...errors import InputError, ModelError, join_names, quote
from ..chain_data import ChainOptions
from ..joint import FREE
from .coupling import shared_limits, shared_velocity_limits
from .link_masses import TWELVE, moved_masses
from .robot_parts import RobotParts, link_number
from .tree import path

# Entries of the largest coupling matrix that is made, half a gigabyte.
LARGEST = 64_000_000


def only_leaf(parts: RobotParts, leaves: tuple[str, ...], base: str) -> str:
    """Leaf of a robot that has no other, to which a chain from base leads. Raises: InputError."""
    fault = ""
    if len(leaves) != 1:
        fault = f"there are several leaves: {join_names(leaves, 20)}"
    elif leaves == (base,) and len(parts.links) > 1:
        fault = "the base is the only leaf"
    if not fault:
        return leaves[0]
    if base in leaves:
        fault += f"; the base is {quote(base)}: chain(tip={quote(base)}) ends there"
    raise InputError(f"{parts.place.place()}: tip must be given, {fault}")


def chain_between(
    parts: RobotParts,
    base: str,
    tip: str,
) -> tuple[np.ndarray, np.ndarray, ChainOptions]:
    """Screws (n, 6) in the base link's frame, home pose (4, 4) and options of the chain to a tip."""
    screws = []
    moving = []
    H: Any = IDENTITY
    ends = link_number(parts, base, "base"), link_number(parts, tip, "tip")
    for number, forward in path(parts.tree, *ends):
        joint = parts.joints[number]
        if joint.kind in FREE:
            raise ModelError(
                f"{parts.place.of_joint(number)}: the way from {quote(base)} to {quote(tip)} crosses"
                f" the {joint.kind} joint {quote(joint.name)}; a chain cannot"
            )
        origin = joint.origin.ravel()[TWELVE].tolist()
        if forward:
            H = compose(H, origin)
        if joint.kind != "fixed":
            moved = np.array(adjoint(H, joint.screw))
            screws.append(moved if forward else -moved)
            moving.append(number)
        if not forward:
            H = compose(H, inverse(origin))
    home = np.eye(4)
    home.ravel()[TWELVE] = H
    options = _options(parts, np.array(moving, dtype=np.int64), base, tip)
    masses = {parts.numbers[own.link]: own for own in parts.masses}
    options["masses"] = moved_masses(parts.tree, parts.joints, masses, *ends)
    return np.reshape(screws, (-1, 6)), home, options


def _options(
    parts: RobotParts,
    moving: np.ndarray,
    base: str,
    tip: str,
) -> ChainOptions:
    """Names, limits, C and c of x = C q + c, and pitches of the joints that move between two links."""
    whole = parts.coupling
    followed = whole.coordinate[moving]
    used = list(dict.fromkeys(followed[followed >= 0].tolist()))
    joints = [parts.joints[j] for j in moving]
    names = tuple(joint.name for joint in joints)
    q_names = tuple(whole.q_names[k] for k in used)
    velocities = np.array([joint.velocity for joint in joints])
    limits, *_ = shared_limits(whole, parts.bounds, moving)
    options: ChainOptions = {
        "joint_names": names,
        "q_names": q_names,
        "limits": limits[used],
        "base": base,
        "tip": tip,
        "velocity_limits": shared_velocity_limits(whole, velocities, moving)[used],
        "pitches": [joint.pitch for joint in joints],
    }
    if names == q_names:
        return options
    if len(names) * len(q_names) > LARGEST:
        raise InputError(
            f"{parts.place.place()}: the chain from {quote(base)} to {quote(tip)} has joints that"
            f" follow others, and its coupling matrix of {len(names)} x {len(q_names)} would be too"
            f" large: at most {LARGEST} entries are made (Robot.fk needs none)"
        )
    C = np.array(used) == followed[:, None]
    options["coupling"] = np.where(C, whole.ratio[moving, None], 0.0)
    options["offset"] = whole.shift[moving]
    return options
