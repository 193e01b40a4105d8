"""Factory calibrations as YAML files of Universal Robots' ROS driver and ur_description.

Under `kinematics:` there are six links, each with x, y, z [m], roll, pitch, yaw [rad] of its frame
in the one before, and a `hash`. Writer and reader do not mean the same by the three angles. The
driver takes them from Eigen's eulerAngles(0, 1, 2): turns about moving axes, R = Rx(roll) Ry(pitch)
Rz(yaw) (ur_calibration/src/calibration.cpp). ur_description puts them into the rpy of a URDF: turns
about fixed axes, R = Rz(yaw) Ry(pitch) Rx(roll). Where pitch and yaw are tiny, so is the
difference: at the flange 3 micrometres for the UR10e of the driver's documentation, 0.14 mm for a
UR10 whose calibration.conf its owner published (tests/formats/test_ur.py). Here a file means what
its writer meant; one that poekin writes for ur_description says `rpy: fixed` beside `kinematics:`,
where other readers pass it over.
"""

from __future__ import annotations

import math
import re
from typing import Literal, get_args

import numpy as np

from ...checks import choice
from ...errors import InputError, ModelError, PoekinError, quote, suggest
from ...groups import se3
from ...groups.arrays import Array
from .. import rpy as angles
from ..text import xml, yaml_text
from ..text.atomic_write import FilePath, write_whole
from ..text.numbers import real
from .calibration import LINKS, FactoryCalibration
from .conf import LARGEST

KEYS = ("x", "y", "z", "roll", "pitch", "yaw")
RpyAxes = Literal["moving", "fixed"]
CONVENTIONS: tuple[RpyAxes, ...] = get_args(RpyAxes)
_MEANING = ", the axes that roll, pitch and yaw turn about"


def read(path: FilePath, *, rpy: RpyAxes | None = None) -> FactoryCalibration:
    """Calibration in a YAML file of the ROS driver of Universal Robots (extra `formats`).

    Parameters
    ----------
    path : str or os.PathLike
        Path of the file.
    rpy : {"moving", "fixed"}, optional
        Axes that roll, pitch and yaw turn about: by default what the file says, and "moving", as
        the driver writes it, where it says nothing. With "fixed" a file of the driver becomes the
        arm that a URDF of ur_description has.

    Returns
    -------
    calibration : FactoryCalibration
        Poses [m] and hash of the file.

    Raises
    ------
    FileError
        If the file cannot be read or is larger than 64 KiB.
    ModelError
        If the text is no YAML, has no `kinematics:`, or a link or key is missing, misspelt, there
        twice or no finite number; with file and line.
    MissingExtra
        If pyyaml is not installed.
    InputError
        If `rpy` is unknown.

    Notes
    -----
    Accuracy: lengths as written, rotations to 1e-15 rad.
    """
    return read_text(*xml.read_text(path, LARGEST), rpy=rpy)


def read_text(
    text: str,
    place: str = "<text>",
    *,
    rpy: RpyAxes | None = None,
) -> FactoryCalibration:
    """The calibration in a text; place stands for the file in messages. Otherwise as `read`."""
    if rpy is not None:
        choice(rpy, CONVENTIONS, "rpy", _MEANING)
    top = yaml_text.parse(text, place)
    _names(top, ("kinematics",), ("rpy",), place, "the file")
    kinematics = top.items["kinematics"]
    if not isinstance(kinematics, yaml_text.MappingNode):
        raise ModelError(
            f"{place}:{kinematics.line}: kinematics: expected {', '.join(LINKS)} and hash below it"
        )
    said = top.items.get("rpy")
    if said is not None and (
        not isinstance(said, yaml_text.TextNode) or said.text not in CONVENTIONS
    ):
        raise ModelError(f"{place}:{said.line}: rpy: expected {' or '.join(CONVENTIONS)}")
    written = "moving"
    if said is not None:
        written = said.text
    _names(kinematics, LINKS, ("hash",), place, "kinematics")
    mark = kinematics.items.get("hash", yaml_text.TextNode("", 0))
    if not isinstance(mark, yaml_text.TextNode):
        raise ModelError(f"{place}:{mark.line}: hash: expected a text")
    poses = [_pose(kinematics.items[link], link, place, rpy or written) for link in LINKS]
    try:
        return FactoryCalibration(np.array(poses), mark.text)
    except PoekinError as fault:
        raise ModelError(f"{place}: {fault}") from fault


def write(
    calibration: FactoryCalibration,
    path: FilePath,
    *,
    rpy: RpyAxes = "fixed",
) -> None:
    """Write a calibration as a YAML file, for ur_description or as the ROS driver would.

    With "fixed", ur_description's URDF is this calibration to the last digits, as one made from the
    driver's own file is not: its writer means moving axes, its reader fixed ones. A file of either
    kind reads back as the same calibration.

    Parameters
    ----------
    calibration : FactoryCalibration
        Calibration to write.
    path : str or os.PathLike
        Path of the file.
    rpy : {"fixed", "moving"}, default "fixed"
        Axes that roll, pitch and yaw turn about: "fixed" for ur_description, "moving" as the driver
        writes them.

    Raises
    ------
    FileError
        If the file cannot be written, and then nothing is.
    InputError
        If `rpy` is unknown or `calibration` no FactoryCalibration.

    Notes
    -----
    Accuracy: lengths keep all their digits, rotations come back within 1e-15 rad. A hash is written
    as it is: the driver compares it with the arm's.

    Examples
    --------
    >>> import poekin as pk
    >>> table = pk.dh.published("ur10e")
    >>> pk.ur.write(pk.ur.from_dh(table, nominal=table, hash="calib_1"), "ur10e.yaml")
    >>> with open("ur10e.yaml") as file:
    ...     print(file.readline(), end="")
    rpy: fixed
    """
    write_whole(path, make_text(calibration, rpy=rpy).encode())


def make_text(calibration: FactoryCalibration, *, rpy: RpyAxes = "fixed") -> str:
    """The text of a calibration's file. Otherwise as `write`."""
    choice(rpy, CONVENTIONS, "rpy", _MEANING)
    if not isinstance(calibration, FactoryCalibration):
        raise InputError(f"write: expected a FactoryCalibration, got {type(calibration).__name__}")
    lines = ["kinematics:"]
    if rpy == "fixed":
        lines.insert(0, "rpy: fixed")
    for link, T in zip(LINKS, calibration.poses, strict=True):
        # R of moving axes, turned round, is R of fixed axes with all signs turned: (Rx Ry Rz)^T =
        # Rz' Ry' Rx'.
        turns = angles.angles(T[:3, :3])
        if rpy == "moving":
            roll, pitch, yaw = angles.angles(T[:3, :3].T)
            turns = (-roll + 0.0, -pitch + 0.0, -yaw + 0.0)
        lines.append(f"  {link}:")
        lines += [
            f"    {key}: {float(value)!r}"
            for key, value in zip(KEYS, (*T[:3, 3], *turns), strict=True)
        ]
    return "\n".join([*lines, f"  hash: {_quoted(calibration.hash)}", ""])


def _pose(
    link: yaml_text.MappingNode | yaml_text.TextNode,
    name: str,
    place: str,
    rpy: str,
) -> Array:
    if not isinstance(link, yaml_text.MappingNode):
        raise ModelError(
            f"{place}:{link.line}: {name}: expected {', '.join(KEYS)} below it, got {quote(link.text)}"
        )
    _names(link, KEYS, (), place, name)
    x, y, z, *turns = (_number(link.items[key], f"{name}: {key}", place) for key in KEYS)
    if rpy == "fixed":
        return angles.pose((x, y, z), turns)
    R = angles.pose((0.0, 0.0, 0.0), [-a for a in turns])[:3, :3].T
    return se3.pose(R, (x, y, z))


def _number(
    value: yaml_text.MappingNode | yaml_text.TextNode,
    what: str,
    place: str,
) -> float:
    text = "more keys"
    if isinstance(value, yaml_text.TextNode):
        text = value.text
    number = real(text)
    if number is None or not math.isfinite(number):
        raise ModelError(
            f"{place}:{value.line}: {what}: expected a finite number, got {quote(text)}"
        )
    return number


def _names(
    mapping: yaml_text.MappingNode,
    needed: tuple[str, ...],
    others: tuple[str, ...],
    place: str,
    what: str,
) -> None:
    """Check that a mapping has all these keys and no other."""
    known = (*needed, *others)
    every = ", ".join(known)
    for key, line in mapping.key_lines.items():
        if key not in known:
            raise ModelError(
                f"{place}:{line}: {what}: {quote(key)} is not expected, only {every}; {suggest(key, known)}"
            )
    missing = [key for key in needed if key not in mapping.items]
    if missing:
        raise ModelError(
            f"{place}:{mapping.line}: {what}: {', '.join(missing)} missing; expected are {every}"
        )


def _quoted(text: str) -> str:
    """A text for YAML: as it is where no reader could take it for anything else, else in quotes,
    all in ASCII.
    """
    if re.fullmatch(r"calib_\w+", text, re.ASCII):
        return text
    plain = "".join(c if " " <= c <= "~" and c not in '"\\' else f"\\U{ord(c):08x}" for c in text)
    return f'"{plain}"'
