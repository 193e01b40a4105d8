"""Visuals of a robot, out of what it was read from."""

from __future__ import annotations

from ...model.robot import Robot
from ..mjcf import mjcf_visuals
from . import urdf_visuals
from .visual import Visuals


def visuals_of(robot: Robot) -> Visuals:
    """Shapes on the links of a robot that was read from a URDF or MJCF; none for another one.

    They are read when they are asked for, out of the text that the robot's source keeps, which
    goes with it wherever it is calibrated, coupled, copied or pickled. What hangs on a link stays
    there when joints are moved.
    """
    source = robot.source
    if source is None:
        return Visuals()
    if source.text:
        found = urdf_visuals.read(source.text, source.name)
    elif source.mjcf:
        found = mjcf_visuals.read(source.mjcf, source.name)
    else:
        return Visuals()
    links = set(robot.links)
    return Visuals(
        tuple(visual for visual in found.found if visual.link in links),
        tuple(left for left in found.left_out if left.link in links),
    )
