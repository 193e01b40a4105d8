"""Text of /robot_description, out of what the tools of ROS print of it.

- `ros2 topic echo /robot_description`: YAML with the URDF in `data:` (plain, or in quotes of either
  kind, as the text has it), then a line `---`. Without --full-length, 128 characters and `...`.
- `ros2 topic echo --field data`: the URDF itself, then the line `---`.
- `ros2 param get NODE robot_description`: `String value is: ` and the URDF.
- `ros2 param dump` and files of parameters: YAML with a key `robot_description`, at any depth.
- `rosparam get /robot_description` of ROS 1: the URDF as one text of YAML.

Source: ros2cli (ros2topic/verb/echo.py, ros2param/verb/get.py), rosidl_runtime_py/convert.py.
"""

from __future__ import annotations

import re

from ...errors import ModelError, quote
from ...model.provenance import Source
from ..content import kinds
from ..text import yaml_text

NAME = "robot_description"
KEYS = ("data", NAME)
COMMAND = f"ros2 topic echo --once --full-length /{NAME}"
"""Command that prints a whole description."""

_PARAMETER = "String value is:"
_MARK = re.compile(r"((?:</[\w:.-]+\s*|/|--)>\s*\n)---[ \t]*\r?(?:\n|$)")
_ENDS = ("---", "...")
"""Ends of a message, whole and cut."""
_LENGTH = re.compile(r"<\w+ length: <?\d+>?>")
_HELD = re.compile(rf"^[ \t]*(?:{'|'.join(KEYS)}):", re.MULTILINE)


def is_in(text: str) -> bool:
    """Whether a text of YAML has a key that a description stands behind."""
    return bool(_HELD.search(text))


def from_yaml(text: str, place: str) -> str:
    """URDF in a message, a parameter or a file of parameters.

    Raises: ModelError, with the line, for a text that is no YAML, without a description, and for a
    description that was cut or left out, with the command that prints it whole; MissingExtra
    without pyyaml. Place: what messages call the text.
    """
    found = yaml_text.find(text, place, KEYS)
    if found is None:
        raise ModelError(
            f"{place}: expected the text of /{NAME} (data: or {NAME}:), there is none in it"
        )
    return _checked(found.text, f"{place}:{found.line}")


def from_parameter(text: str, place: str) -> str:
    """URDF in what `ros2 param get` prints. Raises: as `from_yaml`."""
    return _checked(text.lstrip("\ufeff \t\r\n").removeprefix(_PARAMETER), place)


def without_mark(content: str | bytes, name: str) -> str | bytes:
    """XML up to the line `---` that ends a message; as it is where there is no such line.

    Raises: ModelError for a text that was cut. Name: what messages call the content.
    """
    end = content[-64:]
    if isinstance(end, bytes):
        end = end.replace(b"\0", b"").decode("latin-1")
    if not end.rstrip().endswith(_ENDS):
        return content
    place = Source(name).place()
    text = kinds.decode(content, place)
    mark = _MARK.search(text)
    if mark:
        text = text[: mark.end(1)]
    _refuse_cut(text, place)
    return text


def _checked(text: str, place: str) -> str:
    _refuse_cut(text, place)
    urdf = text.strip()
    if _LENGTH.fullmatch(urdf):
        raise ModelError(f"{place}: expected the text, got its length: {COMMAND}, without --no-str")
    if not urdf.startswith("<"):
        raise ModelError(f"{place}: expected a URDF, which begins with <, got {quote(urdf)}")
    return urdf


def _refuse_cut(text: str, place: str) -> None:
    bare = text.rstrip().removesuffix("---").rstrip()
    if bare.endswith("..."):
        raise ModelError(
            f"{place}: the text was cut by `ros2 topic echo` after {len(bare) - 3} characters: "
            f"add --full-length, as in {COMMAND}"
        )
