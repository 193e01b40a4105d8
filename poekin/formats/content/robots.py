"""Robots out of content of whatever kind: text, bytes, what came through a pipe."""

from __future__ import annotations

import re
from collections.abc import Callable

from ...errors import InputError, ModelError, quote, safe_repr
from ...model.provenance import Source
from ...model.robot import Robot
from .. import chain_toml, dh, urdf
from ..dh import table_io
from ..mjcf import mjcf
from ..ros import description
from ..text import toml_text, xml
from ..vendors import yaml_io
from ..vendors.calibration import FactoryCalibration
from . import compressed, kinds

_WORD = re.compile(r"[\w./\\:~-]+")
_CALIBRATION = re.compile(r"^kinematics\w*:", re.MULTILINE)


def from_text(text: str | bytes, name: str = "<text>") -> Robot:
    """Robot in a text, whose kind is seen by how it begins.

    Parameters
    ----------
    text : str or bytes
        A URDF or MJCF; what `ros2 topic echo` or `ros2 param get` print of /robot_description, or a
        file of parameters that holds it (extra `formats`); a DH table as TOML or CSV; a calibration
        as TOML or YAML; bytes also one of these by gzip, or a zip with one .urdf in it.
    name : str, optional
        Name that stands for the text in messages.

    Returns
    -------
    robot : Robot
        Its links, joints and limits, rad and m.

    Raises
    ------
    InputError
        If `text` is neither str nor bytes, or `name` no str.
    ModelError
        If the text begins as no model does, was cut by ROS, or cannot be understood; with the line.
    FileError
        If compressed bytes are damaged, hold no model, or more than 64 MiB.
    MissingExtra
        If the package that reads such a text is not installed.

    Warns
    -----
    PoekinWarning
        For what was repaired in the text, with the line.

    Notes
    -----
    Files that an MJCF includes are looked for from the working directory. Accuracy: as written.

    Examples
    --------
    >>> import poekin as pk
    >>> pk.from_text("data: <robot name='a'><link name='b'/></robot>")
    Robot('a': 1 links, 0 joints, dof 0, root 'b', 1 leaf: 'b')
    """
    if not isinstance(name, str):
        raise InputError(f"from_text: name: expected a str, got {safe_repr(name)}")
    if not isinstance(text, (str, bytes, bytearray)):
        raise InputError(f"from_text: expected a text, str or bytes, got {safe_repr(text)}")
    if isinstance(text, str):
        return from_content(text, name)
    return from_content(bytes(text), name)


def from_content(
    content: str | bytes,
    name: str,
    member: str = "",
) -> Robot:
    """Robot of a content of whatever kind.

    Parameters: content; name, what messages call it; member, the name of a file in it where it is
    an archive. Raises and warns: as `from_text`.
    """
    if isinstance(content, bytes):
        content = compressed.decompress(content, Source(name).place(), member)
    if member:
        name = f"{name}/{member}"
    place = Source(name).place()
    if len(content) > xml.MAX_BYTES:
        size = len(content) / 2**20
        raise ModelError(f"{place}: expected at most 64 MiB, got {size:.1f} MiB")
    kind = kinds.kind_of(content)
    if kind == "xml":
        return _from_xml(content, name)
    text = kinds.decode(content, place)
    if not text.strip():
        raise ModelError(f"{place}: the text is empty")
    if kind is None:
        raise ModelError(_unknown(text, place))
    return _READERS[kind](text, name)


def _from_xml(content: str | bytes, name: str) -> Robot:
    content = description.without_mark(content, name)
    if isinstance(content, bytes):
        is_mjcf = b"<mujoco" in content
    else:
        is_mjcf = "<mujoco" in content
    if is_mjcf and xml.parse(content, name, tell=False).tag == "mujoco":
        return mjcf.read_text(content, name)
    return urdf.read_text(content, name)


def calibration_text(content: bytes, name: str) -> str | None:
    """Text of a vendor's calibration, None of any other content. Raises: ModelError."""
    if kinds.kind_of(content) not in ("yaml", None):
        return None
    text = kinds.decode(content, Source(name).place())
    return text if _is_calibration(text) else None


def read_calibration(text: str, name: str, arm: str | None = None) -> FactoryCalibration:
    """Calibration, of one arm where there are several, in a vendor's text. Raises: ModelError."""
    place = Source(name).place()
    if len(text) > yaml_io.LARGEST:
        raise ModelError(
            f"{place}: expected a calibration of at most {yaml_io.LARGEST} characters, got {len(text)}"
        )
    return yaml_io.read_text(text, place, arm=arm)


def _is_calibration(text: str) -> bool:
    return not description.is_in(text) and _CALIBRATION.search(text) is not None


def _from_yaml(text: str, name: str) -> Robot:
    if _is_calibration(text):
        return read_calibration(text, name).to_robot()
    found = description.from_yaml(text, Source(name).place())
    return urdf.read_text(found, f"{name} ({description.NAME})")


def _from_parameter(text: str, name: str) -> Robot:
    found = description.from_parameter(text, Source(name).place())
    return urdf.read_text(found, f"{name} ({description.NAME})")


def _from_toml(text: str, name: str) -> Robot:
    place = Source(name).place()
    if toml_text.parse(text, place).get("format") == chain_toml.FORMAT:
        return chain_toml.read_text(text, place)
    return dh.to_robot(table_io.read_text(text, name, ".toml"))


def _from_csv(text: str, name: str) -> Robot:
    return dh.to_robot(table_io.read_text(text, name, ".csv"))


_READERS: dict[kinds.Kind, Callable[[str, str], Robot]] = {
    "parameter": _from_parameter,
    "yaml": _from_yaml,
    "toml": _from_toml,
    "csv": _from_csv,
}


def _unknown(text: str, place: str) -> str:
    lines = text.split("\n")
    number, first = next((k, line) for k, line in enumerate(lines, 1) if line.strip())
    message = (
        f"{place}:{number}: expected a URDF, an MJCF, /{description.NAME} as ROS prints it, "
        f"a DH table or a calibration, got {quote(first)}"
    )
    if _WORD.fullmatch(text.strip()):
        return f"{message}; the name of a robot or file is for load"
    for k, line in enumerate(lines[number:], number + 1):
        if line.startswith(("<", "data:", "String value is:")):
            return (
                f"{message}; a model may begin on line {k}: what stands before it is another "
                f"program's word (2>/dev/null keeps errors out of a pipe; for a topic: {description.COMMAND})"
            )
    return message
