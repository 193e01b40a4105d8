"""The arms that come with poekin: URDF files in this folder, each with its source in a comment."""

from __future__ import annotations

import pkgutil

from ...model.robot import Robot
from .. import urdf

NAMES = ("panda", "stanford", "ur5e")


def read(name: str) -> Robot:
    """The arm of that name, one of `NAMES`."""
    return urdf.read_text(text(name), f"catalogue/{name}.urdf")


def text(name: str) -> bytes:
    """The URDF of the arm of that name, one of `NAMES`."""
    return pkgutil.get_data(__name__, f"{name}.urdf") or b""
