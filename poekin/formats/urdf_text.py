"""URDF out of a Robot or Chain: text that Pinocchio, ROS and poekin load with the same kinematics."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator

import numpy as np

from ..errors import InputError, join_names, quote, safe_repr
from ..model.chain import Chain
from ..model.joint import Joint
from ..model.kinematics.arm import Arm
from ..model.kinematics.compiled import CompiledChain
from ..model.robot import Robot
from . import rpy
from .common.limits import UNBOUNDED
from .serial import serial_robot

UNLIMITED = 1e16
"""Stand-in for "no limit" where URDF insists on a number [rad, m, N, N m, rad/s or m/s].

No reader takes "inf", a missing bound is 0 to most, and an effort or velocity of 0 would hold the
joint still in some.
"""

# What XML 1.0 can hold at all; and what of that could disappear, break the markup, or be obeyed by
# a terminal.
_IMPOSSIBLE = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_MARKUP = '&<>"'


def to_urdf(
    model: Robot | Arm,
    *,
    name: str | None = None,
) -> str:
    """URDF text of a robot or a chain: kinematics, names and limits, without mesh or inertia.

    A `Robot` keeps its tree: links, joints, origins, axes, mimic and order. A `Chain` becomes a
    robot of one branch: base, a link after each joint, tip, with the z-aligned link frames of
    `Chain.local`. Of the joints that follow a coordinate, the first one with x = q is its master
    and the others mimic it.

    Parameters
    ----------
    model : Robot or Chain or CompiledChain
        What to write.
    name : str, optional
        Name of the robot; by default its own, BASE_to_TIP for a chain.

    Returns
    -------
    text : str
        Indented XML, the same for equal models, without any path. Encode it as UTF-8.

    Raises
    ------
    InputError
        If a joint is helical or follows several coordinates; if a name has a character that XML
        cannot hold; if `model` is neither Robot nor Chain, or `name` no str.

    Warns
    -----
    PoekinWarning
        If the coordinates of the written robot are not those of the chain: another scale or order,
        or one left out because no joint follows it.

    Notes
    -----
    A revolute joint without limits is continuous, as URDF calls that. A helical one without pitch
    is revolute. Where a prismatic joint, or one side of any joint, has no limit, ±1e16 is written;
    `load` reads it back as unlimited, with its warning for such files. Likewise effort and
    velocity, which URDF demands and a model here does not have. Two things are written that `load`
    takes for "unlimited": lower = upper, and a bound of 1e4 or more. Limits of fixed and planar
    joints have no place in the text.

    Accuracy: lengths, axes, limits and mimic read back as the same floats; the rotation of an
    origin is the one of its roll, pitch and yaw within 1e-15 rad. Source: the URDF specification.

    Examples
    --------
    >>> import poekin as pk
    >>> text = pk.to_urdf(pk.dh.to_chain(pk.dh.published("puma560")), name="puma")
    >>> print(text[:41])
    <?xml version="1.0"?>
    <robot name="puma">
    >>> text.count("<joint ")
    7
    """
    if name is not None and not isinstance(name, str):
        raise InputError(f"name: expected the robot's name, a str, got {safe_repr(name)}")
    if not isinstance(model, (Robot, Chain, CompiledChain)):
        raise InputError(f"to_urdf: expected a Robot or a Chain, got {type(model).__name__}")
    robot = model
    if not isinstance(robot, Robot):
        robot = serial_robot(robot)
    if name is None:
        name = robot.name
    helical = [joint.name for joint in robot.joints if joint.pitch]
    if helical:
        raise InputError(f"URDF has no helical joints, and these are: {join_names(helical)}")
    lines = [
        '<?xml version="1.0"?>',
        f"<robot name={quote_attribute(name, 'robot')}>",
    ]
    lines += [f"  <link name={quote_attribute(link, 'link')}/>" for link in robot.links]
    for joint in robot.joints:
        lines += _joint(joint)
    return "\n".join([*lines, "</robot>", ""])


def _joint(joint: Joint) -> Iterator[str]:
    kind = joint.kind.replace("helical", "revolute")
    if kind == "revolute" and joint.limits == UNBOUNDED:
        kind = "continuous"
    yield f'  <joint name={quote_attribute(joint.name, "joint")} type="{kind}">'
    yield f"    <parent link={quote_attribute(joint.parent, 'link')}/>"
    yield f"    <child link={quote_attribute(joint.child, 'link')}/>"
    T = joint.origin
    yield f'    <origin xyz="{_numbers(*T[:3, 3])}" rpy="{_numbers(*rpy.angles(T[:3, :3]))}"/>'
    if kind not in ("fixed", "floating"):
        yield f'    <axis xyz="{_numbers(*joint.axis)}"/>'
    if kind in ("revolute", "prismatic"):
        lower, upper, most = map(_numbers, (*joint.limits, UNLIMITED))
        yield f'    <limit lower="{lower}" upper="{upper}" effort="{most}" velocity="{most}"/>'
    if joint.mimic is not None:
        mimic = joint.mimic
        multiplier, offset = map(_numbers, (mimic.multiplier, mimic.offset))
        master = quote_attribute(joint.mimic.joint, "joint")
        yield f'    <mimic joint={master} multiplier="{multiplier}" offset="{offset}"/>'
    yield "  </joint>"


def _numbers(*values: float) -> str:
    """Numbers in the shortest form that reads back as the same floats, an infinite one as ±1e16."""
    finite = np.nan_to_num(values, nan=math.nan, posinf=UNLIMITED, neginf=-UNLIMITED)
    words = (repr(value).removesuffix(".0") for value in finite.tolist())
    return " ".join(words)


def quote_attribute(name: str, what: str) -> str:
    """Name as the value of an attribute; markup and unprintable characters by their numbers."""
    bad = _IMPOSSIBLE.search(name)
    if bad:
        raise InputError(
            f"{what} {quote(name)}: XML cannot hold the character U+{ord(bad[0]):04X} of its name"
        )
    escaped = "".join(map(_escaped, name))
    return f'"{escaped}"'


def _escaped(c: str) -> str:
    if c.isprintable() and c not in _MARKUP:
        return c
    return f"&#{ord(c)};"
