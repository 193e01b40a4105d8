"""`poekin urdf`: a model as URDF text."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path
from typing import Annotated

from typer import Option

from ...errors import FileError, quote
from ...formats.serial import serial_robot
from ...formats.text.atomic_write import write_whole
from ...formats.urdf_text import to_urdf
from ...model.chain import Chain
from ...model.joint import MOVING, Joint
from ...model.robot import Robot
from .. import array_files
from ..kinematics.arm import Base, File
from ..model import model
from ..output import path_text, say

Tip = Annotated[str | None, Option("--tip", help="The last link of the one chain to write.")]
Output = Annotated[
    Path | None,
    Option("-o", "--output", help="Where the text goes (default: it is printed)."),
]
Into = Annotated[
    str | None,
    Option(
        "--into",
        metavar="URDF",
        help="Your own URDF: its text, with origins and axes of joints that moved changed to FILE's.",
    ),
]


def command(
    file: File,
    tip: Tip = None,
    base: Base = None,
    into: Into = None,
    output: Output = None,
) -> None:
    """URDF of the whole tree, or with --tip or --base of one chain, whose links are called after
    its joints; kinematics only, no meshes or masses. With --into, a URDF that is there, edited.
    """
    if output is not None and output.suffix.lower() in (".gz", ".zip"):
        raise FileError(
            f"cannot write {path_text(output)}: the text is not compressed; without --output it goes "
            "into a pipe (| gzip > FILE)"
        )
    array_files.check_apart([output], model=file, URDF=into)
    robot = model(file)
    written: Robot | Chain = robot
    if tip is not None or base is not None:
        written = robot.chain(base=base, tip=tip)
    if into is not None:
        content = to_urdf(written, into=model(into))
    else:
        if isinstance(written, Chain):
            written = _branch(written, robot)
        content = to_urdf(written, name=robot.name).encode()
    if output is not None:
        write_whole(output, content)
        say(f"URDF of {quote(robot.name)} written to {path_text(output)}")
        return
    if into is None and (sys.stdout.encoding or "").lower().replace("-", "") != "utf8":
        # A stream that is not UTF-8 gets other characters by number: XML means the same by that.
        content = content.decode().encode("ascii", "xmlcharrefreplace")
    sys.stdout.flush()
    sys.stdout.buffer.write(content)


def _branch(chain: Chain, robot: Robot) -> Robot:
    """Robot of one branch with what its joints say in the robot that the chain was taken from."""
    branch = serial_robot(chain)
    joints = [_as_in(robot, joint) for joint in branch.joints]
    return Robot(branch.name, branch.links, joints, coupling=branch.coupling)


def _as_in(robot: Robot, joint: Joint) -> Joint:
    """Joint with the effort, damping and friction of the robot's joint of that name; with its
    safety controller too where both have one value, as of a joint that mimics none.
    """
    if joint.kind not in MOVING:
        return joint
    own = robot.joint(joint.name)
    joint = replace(joint, effort=own.effort, damping=own.damping, friction=own.friction)
    if own.mimic is None:
        joint = replace(joint, safety_controller=own.safety_controller)
    return joint
