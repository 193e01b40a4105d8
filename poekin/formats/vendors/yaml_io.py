"""Factory calibrations as YAML files of the vendors' ROS drivers and robot descriptions.

Under `kinematics:` there is an entry a joint, each with x, y, z [m], roll, pitch, yaw [rad] of its
frame in the one before. Universal Robots call them shoulder, ..., wrist_3 and add a `hash`,
UFACTORY and Flexiv joint1, ..., jointN; Flexiv add the joints' axes, the flange and
`calibration_metadata:`.

Of Universal Robots' files, writer and reader do not mean the same by the three angles. The driver
takes them from Eigen's eulerAngles(0, 1, 2): turns about moving axes, R = Rx(roll) Ry(pitch)
Rz(yaw) (ur_calibration/src/calibration.cpp). ur_description puts them into the rpy of a URDF: turns
about fixed axes, R = Rz(yaw) Ry(pitch) Rx(roll). Where pitch and yaw are tiny, so is the
difference: at the flange 3 micrometres for the UR10e of the driver's documentation, 0.14 mm for a
UR10 whose calibration.conf its owner published (tests/formats/vendors/test_ur.py). Here a file
means what its writer meant; one that poekin writes for ur_description says `rpy: fixed` beside
`kinematics:`, where other readers pass it over. UFACTORY's and Flexiv's angles are a URDF's: the
joints of a lite6 would lie elsewhere with the other reading.
"""

from __future__ import annotations

import os
import re
from typing import Literal, get_args

import numpy as np

from ...checks import choice
from ...errors import InputError, ModelError, PoekinError, join_names, quote
from ...groups.vectors import rotation_part, translation_part
from .. import rpy as angles
from ..text import xml, yaml_text
from ..text.atomic_write import FilePath, write_whole
from . import numbered, staubli, yaml_keys
from .calibration import FactoryCalibration
from .naming import LINKS, UR, VENDORS, Vendor
from .ur.conf import LARGEST
from .yaml_keys import KEYS

RpyAxes = Literal["moving", "fixed"]
CONVENTIONS: tuple[RpyAxes, ...] = get_args(RpyAxes)
_MEANING = ", the axes that roll, pitch and yaw turn about"
_ARM = re.compile(r"ARM_\d+")
METADATA = "calibration_metadata"
ENDINGS = (".yaml", ".yml", staubli.ENDING)
"""Endings of files that are read here, or refused with what else to do."""


def read(
    path: FilePath,
    *,
    rpy: RpyAxes | None = None,
    vendor: Vendor | None = None,
    arm: str | None = None,
) -> FactoryCalibration:
    """Factory calibration in a YAML file of Universal Robots, UFACTORY or Flexiv.

    The names of the entries say whose it is, the extra `formats` is needed, and `poekin.load`
    reads the same files.

    Parameters
    ----------
    path : str or os.PathLike
        Path of the file: what Universal Robots' ROS driver extracts (ur_calibration), UFACTORY's
        gen_kinematics_params.py reads out of the controller, or Flexiv's flexiv_calibration writes.
    rpy : {"moving", "fixed"}, optional
        Axes that roll, pitch and yaw turn about: by default what the file says; where it says
        nothing, "moving" for Universal Robots, as their driver writes it, and "fixed" for the
        others. With "fixed" a file of Universal Robots' driver becomes the arm that a URDF of
        ur_description has.
    vendor : {"Universal Robots", "UFACTORY", "Flexiv"}, optional
        Vendor, where a file of seven joints fits no arm that is known.
    arm : str, optional
        Arm of a file that holds several, as "ARM_1".

    Returns
    -------
    calibration : FactoryCalibration
        Poses [m], axes, flange and hash of the file.

    Raises
    ------
    FileError
        If the file cannot be read or is larger than 64 KiB.
    ModelError
        If the text is no YAML, has no `kinematics:`, or an entry or key is missing, misspelt, there
        twice or no finite number; with file and line. If it holds several arms, or is of a vendor
        or has axes that cannot be told; if it is Stäubli's arm.cfx.
    MissingExtra
        If pyyaml is not installed.
    InputError
        If `rpy` or `vendor` is unknown, or `vendor` another than the one that the file is of.

    Warns
    -----
    PoekinWarning
        If Flexiv's metadata say that not all joints are measured.

    Notes
    -----
    A file of seven joints is Flexiv's where it has an axis, a flange or metadata, else the vendor's
    whose arm it fits within 20 mm and 3°. A Flexiv file without any axis has those of the arm that
    it fits, z y z y z y z for a Rizon and z for an Enlight. The adapters of dual arms (EXT_AXIS)
    are passed over.

    Accuracy: lengths as written, rotations to 1e-15 rad. Source: ur_calibration; xarm_description,
    config/kinematics; flexiv_description, urdf/common/flexiv_common.xacro.

    Examples
    --------
    >>> import poekin as pk
    >>> table = pk.dh.published("ur10e")
    >>> pk.vendors.write(pk.ur.from_dh(table, nominal=table, hash="calib_1"), "ur10e.yaml")
    >>> pk.vendors.read("ur10e.yaml").hash
    'calib_1'
    """
    text, place = xml.read_text(path, LARGEST)
    if os.fsdecode(path).lower().endswith(staubli.ENDING):
        raise staubli.refusal(text, place)
    return read_text(
        text,
        place,
        rpy=rpy,
        vendor=vendor,
        arm=arm,
    )


def read_text(
    text: str,
    place: str = "<text>",
    *,
    rpy: RpyAxes | None = None,
    vendor: Vendor | None = None,
    arm: str | None = None,
) -> FactoryCalibration:
    """The calibration in a text; place stands for the file in messages. Otherwise as `read`."""
    if rpy is not None:
        choice(rpy, CONVENTIONS, "rpy", _MEANING)
    if vendor is not None:
        choice(vendor, VENDORS, "vendor")
    top = yaml_text.parse(text, place)
    yaml_keys.check(top, ("kinematics",), ("rpy", METADATA), place, "the file")
    rpy = rpy or _written_axes(top, place)
    metadata = top.items.get(METADATA)
    if isinstance(metadata, yaml_text.TextNode):
        raise ModelError(f"{place}:{metadata.line}: {METADATA}: expected keys below it")
    entries = _entries(top.items["kinematics"], arm, place)
    is_numbered = numbered.is_numbered(entries)
    known = VENDORS[:1]
    if is_numbered:
        known = VENDORS[1:]
    if vendor is not None and vendor not in known:
        raise InputError(f"vendor: {place} is of {' or '.join(known)}, got {quote(vendor)}")
    try:
        if is_numbered:
            return numbered.calibration(entries, place, rpy or "fixed", metadata, vendor)
        return _ur(entries, place, rpy or "moving")
    except ModelError:
        raise
    except PoekinError as fault:
        raise ModelError(f"{place}: {fault}") from fault


def _written_axes(top: yaml_text.MappingNode, place: str) -> RpyAxes | None:
    """Axes of the angles that the file states, None where it does not."""
    said = top.items.get("rpy")
    if said is None:
        return None
    for known in CONVENTIONS:
        if isinstance(said, yaml_text.TextNode) and said.text == known:
            return known
    raise ModelError(f"{place}:{said.line}: rpy: expected {' or '.join(CONVENTIONS)}")


def _ur(
    entries: yaml_text.MappingNode,
    place: str,
    rpy: str,
) -> FactoryCalibration:
    yaml_keys.check(entries, LINKS, ("hash",), place, "kinematics")
    mark = yaml_keys.text(entries, "hash", place)
    poses = [yaml_keys.pose(entries, link, place, rpy) for link in LINKS]
    return FactoryCalibration(np.array(poses), mark)


def _entries(
    kinematics: yaml_text.MappingNode | yaml_text.TextNode,
    arm: str | None,
    place: str,
) -> yaml_text.MappingNode:
    """The mapping whose keys are the joints: that of one arm where there are several."""
    where = f"{place}:{kinematics.line}: kinematics"
    unknown = ModelError(
        f"{where}: expected {', '.join(LINKS)} and hash, or joint1, joint2, ... below it"
    )
    if not isinstance(kinematics, yaml_text.MappingNode):
        raise unknown
    arms = {
        key: value
        for key, value in kinematics.items.items()
        if _ARM.fullmatch(key) and isinstance(value, yaml_text.MappingNode)
    }
    if not arms:
        if arm is not None:
            raise ModelError(f"{where}: expected the arm {quote(arm)}, and it has one arm, unnamed")
        if not (numbered.is_numbered(kinematics) or set(LINKS) & set(kinematics.items)):
            raise unknown
        return kinematics
    if arm not in arms:
        got = "none was named"
        if arm is not None:
            got = f"got {quote(arm)}"
        raise ModelError(
            f"{where}: it has the arms {join_names(arms)}, and {got}: arm= of pk.vendors.read says which,"
            " --arm on the command line"
        )
    return arms[arm]


def write(
    calibration: FactoryCalibration,
    path: FilePath,
    *,
    rpy: RpyAxes = "fixed",
) -> None:
    """Write a calibration as a YAML file, for the vendor's robot description or as its driver would.

    For Universal Robots: with "fixed", ur_description's URDF is this calibration to the last
    digits, as one made from the driver's own file is not: its writer means moving axes, its reader
    fixed ones. A file of either kind reads back as the same calibration.

    Parameters
    ----------
    calibration : FactoryCalibration
        Calibration to write.
    path : str or os.PathLike
        Path of the file.
    rpy : {"fixed", "moving"}, default "fixed"
        Axes that roll, pitch and yaw turn about: "fixed" for robot descriptions, "moving" as the
        driver of Universal Robots writes them.

    Raises
    ------
    FileError
        If the file cannot be written, and then nothing is.
    InputError
        If `rpy` is unknown or `calibration` no FactoryCalibration, or one with axes or a flange for
        which the vendor's form has no place.

    Notes
    -----
    Accuracy: lengths keep all their digits, rotations come back within 1e-15 rad. A hash is written
    as it is: the driver compares it with the arm's.

    Examples
    --------
    >>> import poekin as pk
    >>> table = pk.dh.published("ur10e")
    >>> pk.vendors.write(pk.ur.from_dh(table, nominal=table, hash="calib_1"), "ur10e.yaml")
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
    naming = calibration.naming
    entries = dict(zip(naming.entries, calibration.poses, strict=True))
    flexiv = naming.vendor == "Flexiv"
    if flexiv and naming.tip is not None:
        entries[naming.tip_joint] = calibration.flange
    elif not flexiv:
        _check_plain(calibration)
    lines = ["kinematics:"]
    if (rpy == "moving") != (naming.vendor == UR.vendor):
        lines.insert(0, f"rpy: {rpy}")
    for i, (entry, T) in enumerate(entries.items()):
        # R of moving axes, turned round, is R of fixed axes with all signs turned: (Rx Ry Rz)^T =
        # Rz' Ry' Rx'.
        turns = angles.angles(rotation_part(T))
        if rpy == "moving":
            roll, pitch, yaw = angles.angles(rotation_part(T).T)
            turns = (-roll + 0.0, -pitch + 0.0, -yaw + 0.0)
        lines.append(f"  {entry}:")
        lines += [
            f"    {key}: {float(value)!r}"
            for key, value in zip(KEYS, (*translation_part(T), *turns), strict=True)
        ]
        if flexiv and i < len(calibration.axes):
            lines.append(f"    axis: {' '.join(map(repr, calibration.axes[i].tolist()))}")
    if calibration.hash or naming.vendor == UR.vendor:
        lines.append(f"  hash: {_quoted(calibration.hash)}")
    return "\n".join([*lines, ""])


def _check_plain(calibration: FactoryCalibration) -> None:
    """Refuse axes and a flange that only Flexiv's form has a place for. Raises: InputError."""
    plain = FactoryCalibration(calibration.poses, calibration.hash, calibration.naming)
    if calibration != plain:
        raise InputError(
            f"write: the form of {calibration.vendor} has no place for axes other than z, nor for a flange"
        )


def _quoted(text: str) -> str:
    """A text for YAML: as it is where no reader could take it for anything else, else in quotes,
    all in ASCII.
    """
    if re.fullmatch(r"calib_\w+", text, re.ASCII):
        return text
    plain = "".join(c if " " <= c <= "~" and c not in '"\\' else f"\\U{ord(c):08x}" for c in text)
    return f'"{plain}"'
