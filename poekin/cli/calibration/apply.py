"""`poekin apply`: a calibration put into a robot, in the robot's own URDF."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated, NamedTuple

import numpy as np
from typer import Argument, Option

from ...formats.text.atomic_write import write_whole
from ...formats.urdf_text import own_urdf
from ...groups import se3, so3
from ...groups.vectors import norm, rotation_part, translation_part
from ...model.joint import Joint
from ...model.robot import Robot
from ...solve.calibration.apply import apply
from ..array_files import check_apart, check_place
from ..kinematics.arm import File, Json
from ..model import arm_calibration, model
from ..output import as_json, name, number, path_text, say, table
from .outputs import say_written

MOVED = 1e-12
"""Smallest change [rad or m] of a joint that is told."""
Given = Annotated[
    Path,
    Argument(
        metavar="CALIBRATION",
        help="A file of poekin calibrate (.toml), or of Universal Robots, UFACTORY or Flexiv (.yaml).",
    ),
]
Base = Annotated[
    str | None,
    Option("--base", help="The link that it begins at (default: as the calibration says)."),
]
Tip = Annotated[
    str | None,
    Option("--tip", help="The link that it ends at (default: as the calibration says)."),
]
Force = Annotated[bool, Option("--force", help="Put it on, whatever arm it is of.")]
Output = Annotated[Path, Option("-o", "--output", help="Where the calibrated URDF goes.")]


class Change(NamedTuple):
    """Change of a joint: of its origin [m], and of its axis's direction and its frame [rad]."""

    joint: str
    shift: float
    turn: float


def command(
    file: File,
    calibration: Given,
    output: Output,
    base: Base = None,
    tip: Tip = None,
    force: Force = False,
    json: Json = False,
) -> None:
    """URDF of a robot with the joints of a calibration: its own text, where it was read from a URDF,
    with other origins and axes.
    """
    check_place(output, (".urdf",))
    check_apart([output], model=file, calibration=str(calibration))
    robot = model(file)
    given = arm_calibration(str(calibration)) or calibration
    calibrated = apply(robot, given, base=base, tip=tip, force=force)
    write_whole(output, own_urdf(calibrated))
    moved = _changes(robot, calibrated)
    if json:
        joints = [change._asdict() for change in moved]
        print(as_json({"robot": robot.name, "joints": joints, "written": [str(output)]}))
        return
    say(f"{name(robot.name)} with {path_text(calibration)}: {len(moved)} joints moved")
    if moved:
        rows = [(c.joint, number(1e3 * c.shift, 4), number(1e3 * c.turn, 4)) for c in moved]
        table(("joint", "origin (mm)", "turn (mrad)"), rows)
    say_written([str(output)], robot)


def _changes(robot: Robot, calibrated: Robot) -> list[Change]:
    """Changes of the robot's joints, those that moved."""
    changes = map(_change, robot.joints, calibrated.joints)
    return [change for change in changes if max(change.shift, change.turn) > MOVED]


def _change(before: Joint, after: Joint) -> Change:
    relative = se3.inverse(before.origin) @ after.origin
    a = np.array(before.axis)
    b = np.array(after.axis)
    tilt = math.atan2(np.linalg.norm(np.cross(a, b)), a @ b)
    turn = norm(so3.log(rotation_part(relative)))
    return Change(before.name, norm(translation_part(relative)), max(turn, tilt))
