"""URDF out of a Robot or Chain: text that Pinocchio, ROS and poekin load with the same kinematics."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator
from dataclasses import asdict
from typing import overload

import numpy as np

from ..errors import InputError, join_names, quote, safe_repr
from ..groups.vectors import rotation_part, translation_part
from ..model.chain import Chain
from ..model.joint import Joint
from ..model.kinematics.arm import Arm, chain_of
from ..model.kinematics.compiled import CompiledChain
from ..model.provenance import warn
from ..model.robot import Robot
from . import rpy, urdf, urdf_in_place
from .common.limits import UNBOUNDED
from .common.xml_attribute import quote_attribute
from .content import compressed
from .relink import relinked
from .serial import serial_robot
from .text.atomic_write import FilePath
from .text.numbers import shortest

Into = FilePath | bytes | Robot
"""URDF to be edited: path, content, or a robot that was read from it."""
UNLIMITED = 1e16
"""Stand-in for "no bound" where URDF insists on a number [rad or m].

No reader takes "inf", and a missing bound is 0 to most.
"""
NOT_KNOWN = "effort and velocity 0: not known"
"""Comment of a text that has such limits: URDF insists on both numbers.

Real files write 0 there too, and MoveIt takes a velocity of 0 for "no limit". A large number would
be believed by whoever plans with it.
"""


@overload
def to_urdf(model: Robot | Arm, *, name: str | None = None, into: None = None) -> str: ...


@overload
def to_urdf(model: Robot | Arm, *, name: None = None, into: Into) -> bytes: ...


def to_urdf(
    model: Robot | Arm,
    *,
    name: str | None = None,
    into: Into | None = None,
) -> str | bytes:
    """URDF text of a robot or a chain, without mesh or inertia; or a user's own URDF, edited.

    A `Robot` keeps its tree: links, joints, with all that their fields say, and order. A `Chain` becomes a
    robot of one branch: base, a link after each joint, tip, with the z-aligned link frames of
    `Chain.local`. Of the joints that follow a coordinate, the first one with x = q is its master
    and the others mimic it. With `into`, the text of a URDF comes back in which only <origin> and
    <axis> of joints that moved are changed: meshes, masses, transmissions, comments, names and
    blanks stay as they are.

    Parameters
    ----------
    model : Robot or Chain or CompiledChain
        What to write.
    name : str, optional
        Name of the robot; by default its own, BASE_to_TIP for a chain. Not with `into`.
    into : str or os.PathLike or bytes or Robot, optional
        Path of a URDF, also as .gz or in a .zip, its content, or a robot that was read from it: the
        text to be edited. A `Robot` must have its links and joints; a `Chain` is put between the
        links that its base and tip are called, as by `relinked`. The file itself stays as it is.

    Returns
    -------
    text : str or bytes
        Indented XML, the same for equal models, without any path; encode it as UTF-8. With `into`,
        the content of the edited file, not compressed, bytes in its own encoding.

    Raises
    ------
    InputError
        If a joint is helical or follows several coordinates; if a name has a character that XML
        cannot hold; if `model` is neither Robot nor Chain, or `name` no str; if `into` is given and
        the robot differs from it in more than origins, axes and fixed joints that it has more, or
        `relinked` refuses the chain.
    FileError, ModelError
        If `into` cannot be read, or not be edited byte for byte.
    UnknownName
        If `into` has no link of the chain's base or tip.

    Warns
    -----
    PoekinWarning
        If the coordinates of the written robot are not those of the chain: another scale or order,
        or one left out because no joint follows it; or if its readings are coupled, which a URDF
        cannot say. With `into`, as `relinked`, where a tool link is added or moved.

    Notes
    -----
    In place, only those numbers of a joint change that do: roll, pitch and yaw are, of all that are
    the same rotation, those nearest to the old, and a joint that moved by rounding alone (2e-15 of
    the robot's size) is left. What was not there is inserted with the file's own quotes and
    indents.

    A revolute joint without limits is continuous, as URDF calls that. A helical one without pitch
    is revolute. Where a prismatic joint, or one side of any joint, has no limit, ±1e16 is written;
    `load` reads it back as unlimited, with its warning for such files. Where a <limit> needs an
    effort or a velocity that is not known, 0 is written, and a comment says so; no number is made
    up. `load`, MoveIt and Pinocchio read such files; simulators want numbers there. Three things
    are written that `load` takes for "unlimited": lower = upper, a bound of 1e4 or more, and a
    velocity of 1e4 or more. Limits of fixed and planar joints have no place in the text. A chain
    knows velocity limits, and nothing of effort, damping, friction or a safety controller.

    Accuracy: lengths, axes, limits, mimic, dynamics and safety controllers read back as the same
    floats; the rotation of an origin is the one of its roll, pitch and yaw within 1e-15 rad. In
    place, poses of links and axes are within 1e-13 of the robot's size; the text is read again
    before it is returned (tests/formats/urdf_in_place). Source: the URDF specification.

    Examples
    --------
    >>> import poekin as pk
    >>> text = pk.to_urdf(pk.dh.to_chain(pk.dh.published("puma560")), name="puma")
    >>> print(text[:41])
    <?xml version="1.0"?>
    <robot name="puma">
    >>> text.count("<joint ")
    7

    A UR5e whose tool is 1 mm longer, in its own URDF:

    >>> import difflib
    >>> import numpy as np
    >>> robot = pk.load("ur5e")
    >>> mine = pk.to_urdf(robot).encode()
    >>> longer = robot.chain().retooled([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0.001], [0, 0, 0, 1]])
    >>> edited = pk.to_urdf(longer, into=mine)
    >>> len(edited.splitlines()) == len(mine.splitlines())
    True
    """
    if name is not None and not isinstance(name, str):
        raise InputError(f"name: expected the robot's name, a str, got {safe_repr(name)}")
    if not isinstance(model, (Robot, Chain, CompiledChain)):
        raise InputError(f"to_urdf: expected a Robot or a Chain, got {type(model).__name__}")
    if into is not None:
        return _in_place(model, name, into)
    robot = model
    if not isinstance(robot, Robot):
        robot = serial_robot(robot)
    _warn_of_coupling(robot.name, robot.coupling)
    if name is None:
        name = robot.name
    helical = [joint.name for joint in robot.joints if joint.pitch]
    if helical:
        raise InputError(f"URDF has no helical joints, and these are: {join_names(helical)}")
    lines = [
        '<?xml version="1.0"?>',
        f"<robot name={quote_attribute(name, 'robot')}>",
    ]
    limits = map(_limit, robot.joints)
    if any(0 in (limit.get("effort"), limit.get("velocity")) for limit in limits):
        lines.append(f"  <!-- {NOT_KNOWN} -->")
    lines += [f"  <link name={quote_attribute(link, 'link')}/>" for link in robot.links]
    for joint in robot.joints:
        lines += _joint(joint)
    return "\n".join([*lines, "</robot>", ""])


def own_urdf(robot: Robot) -> bytes:
    """Content of a robot's URDF: edited in place where it was read from one, else `to_urdf`."""
    if has_text(robot):
        return to_urdf(robot, into=robot)
    return to_urdf(robot).encode()


def has_text(robot: Robot) -> bool:
    """Whether a robot was read from a URDF, and its text is known."""
    return robot.source is not None and bool(robot.source.text)


def _in_place(
    model: Robot | Arm,
    name: str | None,
    into: Into,
) -> bytes:
    """Content of a URDF with the origins and axes of a robot or chain."""
    if name is not None:
        raise InputError(
            "to_urdf: expected name or into, got both: in place, the robot keeps its name"
        )
    place = "<text>"
    if isinstance(into, Robot):
        if into.source is None or not into.source.text:
            raise InputError(f"into: the robot {quote(into.name)} was not read from a URDF")
        place = into.source.name
        text = into.source.text
    elif isinstance(into, bytes):
        text = compressed.decompress(into, place)
    elif not isinstance(into, (str, os.PathLike)):
        raise InputError(f"into: expected a path, bytes or a Robot, got {safe_repr(into)}")
    else:
        text = compressed.read(into)
        place = os.fsdecode(into)
    if not isinstance(model, Robot):
        chain = chain_of(model)
        robot = urdf.read_text(text, place, tell=False)
        model = relinked(robot, chain, base=chain.base, tip=chain.tip)
    _warn_of_coupling(model.name, model.coupling)
    return urdf_in_place.edit(text, model, place)


def _warn_of_coupling(name: str, coupling: tuple[str, ...]) -> None:
    """Warn that a URDF does not say how readings are coupled."""
    if coupling:
        warn(
            f"robot {quote(name)}: a URDF has the joints' own values, without the coupling of its "
            f"readings: {'; '.join(coupling)}"
        )


def _joint(joint: Joint) -> Iterator[str]:
    kind = _kind(joint)
    yield f'  <joint name={quote_attribute(joint.name, "joint")} type="{kind}">'
    yield f"    <parent link={quote_attribute(joint.parent, 'link')}/>"
    yield f"    <child link={quote_attribute(joint.child, 'link')}/>"
    T = joint.origin
    yield f'    <origin xyz="{_numbers(*translation_part(T))}" rpy="{_numbers(*rpy.angles(rotation_part(T)))}"/>'
    if kind not in ("fixed", "floating"):
        yield f'    <axis xyz="{_numbers(*joint.axis)}"/>'
    limit = _limit(joint)
    if limit:
        yield f"    <limit {_attributes(limit)}/>"
    if joint.damping or joint.friction:
        dynamics = {"damping": joint.damping, "friction": joint.friction}
        yield f"    <dynamics {_attributes(dynamics)}/>"
    if joint.safety_controller is not None:
        yield f"    <safety_controller {_attributes(asdict(joint.safety_controller))}/>"
    if joint.mimic is not None:
        mimic = joint.mimic
        multiplier, offset = map(_numbers, (mimic.multiplier, mimic.offset))
        master = quote_attribute(joint.mimic.joint, "joint")
        yield f'    <mimic joint={master} multiplier="{multiplier}" offset="{offset}"/>'
    yield "  </joint>"


def _kind(joint: Joint) -> str:
    """Kind of a joint as URDF calls it."""
    if joint.kind in ("revolute", "helical"):
        return "continuous" if joint.limits == UNBOUNDED else "revolute"
    return joint.kind


def _limit(joint: Joint) -> dict[str, float]:
    """Attributes of <limit>; none where URDF demands none and none is known."""
    limit = {"effort": joint.effort, "velocity": joint.velocity}
    bounded = _kind(joint) in ("revolute", "prismatic")
    if not bounded and all(map(math.isinf, limit.values())):
        return {}
    limit = {name: 0.0 if math.isinf(value) else value for name, value in limit.items()}
    if bounded:
        limit = dict(zip(("lower", "upper"), joint.limits, strict=True)) | limit
    return limit


def _attributes(values: dict[str, float]) -> str:
    return " ".join(f'{name}="{_numbers(value)}"' for name, value in values.items())


def _numbers(*values: float) -> str:
    """Numbers in the shortest form that reads back as the same floats, an infinite one as ±1e16."""
    return shortest(np.nan_to_num(values, nan=math.nan, posinf=UNLIMITED, neginf=-UNLIMITED))
