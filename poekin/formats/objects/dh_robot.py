"""Robotics Toolbox's DHRobot: links with alpha, a, d, theta, offset, sigma, mdh, isflip and qlim."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from ...errors import InputError
from ..dh.table import Row, Table
from .attributes import as_list, has, type_name

_LINK = ("alpha", "a", "d", "theta", "offset", "sigma", "mdh")


def fits(obj: Any) -> bool:
    """Whether an object has links with Denavit-Hartenberg parameters."""
    links = as_list(getattr(obj, "links", None))
    return bool(links) and all(has(link, *_LINK) for link in links)


def make_table(robot: Any) -> Table:
    """The table of a Robotics Toolbox DHRobot: convention, rows, directions, limits, base, tool and
    name.

    As its `fkine` does: a revolute joint's angle is q + offset, its `theta` does not count; a
    prismatic joint's length is q + offset, its `d` does not; -q in place of q where `isflip` is
    true.

    Parameters: robot, a DHRobot or whatever has its attributes. Returns: `pk.dh.Table`, joints
    joint1, joint2, ... Raises: InputError for an object without such links, for links of both
    conventions and for symbols in place of numbers; ShapeError, PoseError for base and tool.
    Accuracy: the numbers as they are.
    Source: the toolbox's documentation of DHLink.
    """
    if not fits(robot):
        raise InputError(
            f"expected a DHRobot with links that have {', '.join(_LINK)}, got {type_name(robot)}"
        )
    links = as_list(robot.links)
    modified, *others = {bool(link.mdh) for link in links}
    if others:
        raise InputError(
            f"{type_name(robot)}: its links mix the standard and the modified convention"
        )
    return Table(
        "modified" if modified else "standard",
        [_row(link) for link in links],
        base=getattr(robot, "base", None),
        tool=getattr(robot, "tool", None),
        name=str(getattr(robot, "name", "") or "arm"),
    )


def _row(link: Any) -> Row:
    row = Row(link.offset, link.d, link.a, link.alpha, flip=bool(getattr(link, "isflip", False)))
    if link.sigma:
        row = replace(row, theta=link.theta, d=link.offset, kind="prismatic")
    qlim = getattr(link, "qlim", None)
    if qlim is not None:
        row = replace(row, limits=tuple(qlim))
    return row
