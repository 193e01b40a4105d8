"""Robots by the name of a file, of a built-in arm, or of a robot of example-robot-data."""

from __future__ import annotations

import os

from ..errors import (
    FileError,
    InputError,
    MissingExtra,
    ModelError,
    UnknownName,
    close_names,
    escape_unprintable,
    quote,
)
from ..model.robot import Robot
from . import catalogue, chain_toml, dh, erd, urdf, vendors
from .content import compressed, kinds, pipes, robots
from .dh.published_tables import NAMES as TABLES
from .mjcf import mjcf
from .ros import description, packages
from .text import xml
from .text.atomic_write import FilePath

PREFIX = "erd:"
BUILT_IN = tuple(sorted({*catalogue.NAMES, *TABLES}))
ENDINGS = (".urdf", ".xml", ".xacro", ".toml", ".csv", *vendors.yaml_io.ENDINGS)
"""Endings of a name that means a file, whether there is one or not."""


def load(name: FilePath) -> Robot:
    """Robot of a file, of a built-in arm, or of example-robot-data.

    Parameters
    ----------
    name : str or os.PathLike
        The path of an existing file: a URDF; an MJCF (.xml with the root <mujoco>, extra `mjcf`); a
        DH table (.toml, .csv); a file of `Calibration.save` (.toml, the calibrated chain); a
        factory calibration of a vendor (.yaml, .yml; see `poekin.vendors.read`); the text of
        /robot_description as ROS prints it; one of these as .gz; a .zip with one .urdf in it, or
        "models.zip/arm.urdf"; or a pipe. "package://NAME/PATH" is a file in a package of ROS, which
        AMENT_PREFIX_PATH or ROS_PACKAGE_PATH leads to. Else the name of a built-in arm ("panda",
        "ur5e", "puma560", ...). Else "erd:" and the name of a robot of the package
        example-robot-data, as in
        "erd:talos_left_arm". A path object is always a path.

    Returns
    -------
    robot : Robot
        Its links, joints and limits, rad and m.

    Raises
    ------
    FileError
        If the path does not exist, is a directory, is empty or cannot be read.
    UnknownName
        If there is no built-in arm and no robot of that name; the closest names are listed.
    MissingExtra
        If the package that reads the file or holds the robot is not installed.
    ModelError
        If the file cannot be understood, with file and line; or if it is xacro, see `poekin.xacro`.
    InputError
        If `name` is neither a str nor a path.

    Warns
    -----
    PoekinWarning
        For what was repaired in the file, with file and line; where a calibration has terms that a
        robot has not.

    Notes
    -----
    A file of the working directory comes before a built-in arm of the same name.

    Examples
    --------
    >>> import poekin as pk
    >>> robot = pk.load("panda")
    >>> robot
    Robot('panda': 12 links, 11 joints, dof 8, root 'panda_link0', 2 leaves: ...)
    >>> robot.chain(tip="panda_hand")
    <Chain 'panda_link0' -> 'panda_hand': 7 revolute joints, reach ... m>
    """
    if isinstance(name, os.PathLike):
        return _read(name)
    if not isinstance(name, str):
        raise InputError(f"load: expected a name or a path, got {type(name).__name__}")
    if name.startswith(packages.SCHEME):
        return _read(packages.local_path(name))
    if (os.path.exists(name) and not os.path.isdir(name)) or compressed.split(name)[1]:
        return _read(name)
    if name in catalogue.NAMES:
        return catalogue.read(name)
    if name in TABLES:
        return dh.to_robot(dh.published(name))
    if name.startswith(PREFIX):
        return erd.read(name.removeprefix(PREFIX))
    if os.path.exists(name):
        return urdf.read(name)
    if "/" in name or os.sep in name or name.lower().endswith(ENDINGS):
        raise FileError(f"{escape_unprintable(name, 400)}: no such file{_guess(name)}")
    raise UnknownName(
        f"no file and no built-in arm is named {quote(name)}{_guess(name)}"
        f' (built in: {", ".join(BUILT_IN)}; "{PREFIX}NAME" is for example-robot-data)'
    )


def _guess(name: str) -> str:
    """End of a message: the names closest to one that nothing has."""
    stem = os.path.splitext(os.path.basename(name))[0]
    close: list[str] = []
    if not name.casefold().startswith(PREFIX):
        close = close_names(stem, BUILT_IN)
    close = close or close_names(name, _example_robots())
    if close:
        return f"; did you mean {' or '.join(map(quote, close))}?"
    return ""


def _example_robots() -> list[str]:
    try:
        return [f"{PREFIX}{name}" for name in erd.available()]
    except MissingExtra:
        return []


def _read(path: FilePath) -> Robot:
    name = os.fsdecode(path)
    if pipes.is_pipe(path):
        return robots.from_content(pipes.read(path), name)
    archive, member = compressed.split(path)
    if member:
        content = xml.read_bytes(archive)
        return robots.from_content(content, archive, member=member)
    lower = name.lower()
    if lower.endswith(".toml") and chain_toml.is_calibration(path):
        return chain_toml.read(path)
    if lower.endswith((".toml", ".csv")):
        return dh.to_robot(dh.read(path))
    if lower.endswith(vendors.yaml_io.ENDINGS) and not _holds_description(path):
        return vendors.read(path).to_robot()
    if lower.endswith(".xml") and mjcf.is_mjcf(path):
        return mjcf.read(path)
    if lower.endswith(".xacro"):
        raise ModelError(
            f"{escape_unprintable(name, 400)}: xacro evaluates expressions that are in the file,"
            " which load never does: pk.xacro(path) does, and --xacro on the command line"
        )
    return _read_by_content(path)


def _holds_description(path: FilePath) -> bool:
    content = xml.read_bytes(path)
    return description.is_in(content.decode("utf-8", "replace"))


def _read_by_content(path: FilePath) -> Robot:
    """Robot of a file whose ending does not say what it is: a URDF where its beginning does not."""
    content = xml.read_bytes(path)
    name = os.fsdecode(path)
    if compressed.is_compressed(content) or kinds.kind_of(content) not in (None, "xml"):
        return robots.from_content(content, name)
    return urdf.read_text(description.without_mark(content, name), name)
