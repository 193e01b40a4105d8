"""The numbers that make a pose: their order, their units, and what the rotation's are.

A format names the whole convention, and none is guessed: KUKA's A, B, C and Fanuc's W, P, R are the
same turns with the numbers reversed, and no row of numbers says which of the two it is.
"""

from __future__ import annotations

from typing import Any, Literal, NamedTuple, get_args

from ...checks import true_or_false
from ...errors import InputError, safe_repr

PoseFormat = Literal[
    "matrix",
    "quat",
    "rotvec",
    "rpy",
    "abc",
    "wpr",
    "zyz",
    "ros",
    "ur",
    "kuka",
    "fanuc",
    "abb",
    "staubli",
    "yaskawa",
    "mitsubishi",
    "kawasaki",
    "doosan",
    "12",
    "16",
    "7",
]
QuaternionOrder = Literal["wxyz", "xyzw"]
LengthUnit = Literal["m", "mm"]
AngleUnit = Literal["rad", "deg"]
Rotation = Literal["matrix", "wxyz", "xyzw", "vector", "zyx", "xyz", "zyz"]
FORMATS: tuple[PoseFormat, ...] = get_args(PoseFormat)
ORDERS: tuple[QuaternionOrder, ...] = get_args(QuaternionOrder)
NAMED = ", ".join(FORMATS[: FORMATS.index("12")])
"""The formats as messages list them; 12, 16 and 7 count the numbers of matrix and quat."""

_ENTRIES = tuple(f"T{i}{j}" for i in range(4) for j in range(4))
_TRANSLATION = ("T03", "T13", "T23")


class PoseLayout(NamedTuple):
    """Names of a pose's numbers, in order; what the rotation's are, the last first if `reverse`;
    and the units of lengths and of angles.
    """

    format: str
    columns: tuple[str, ...]
    rotation: Rotation
    reverse: bool = False
    length: LengthUnit = "m"
    angle: AngleUnit = "rad"

    @property
    def units(self) -> tuple[str, ...]:
        """Unit of each number, "" of what has none."""
        if self.rotation == "matrix":
            return tuple(self.length * (name in _TRANSLATION) for name in self.columns)
        angle = self.angle
        if self.rotation in ORDERS:
            return (self.length,) * 3 + ("",) * 4
        return (self.length,) * 3 + (angle,) * 3

    def describe(self) -> str:
        """The format with the units of its lengths and angles."""
        units: list[str] = list(dict.fromkeys(filter(None, self.units)))
        return f"{self.format}: {', '.join(units)}"


def layout(
    format: Any,
    quaternion: Any = None,
    *,
    mm: bool | None = None,
    deg: bool | None = None,
    joints: bool = False,
) -> PoseLayout:
    """Layout of a format.

    Parameters: those of `poekin.poses.from_numbers`; joints, whether `deg` is said of joints too: a
    controller's format then keeps its own angles. Raises: InputError.
    """
    if not isinstance(format, str) or format not in _LAYOUTS:
        raise InputError(f"format: expected one of {NAMED}; got {safe_repr(format)}")
    for name, value in (("mm", mm), ("deg", deg)):
        if value is not None:
            true_or_false(value, name)
    found = _LAYOUTS[format]
    if format in ("quat", "7"):
        found = _with_order(found, quaternion)
    elif quaternion is not None:
        raise InputError(
            f"quaternion: the format {format} does not take an order; expected with quat only"
        )
    asked = found
    if mm is not None:
        asked = asked._replace(length="mm" if mm else "m")
    if deg is not None and not (joints and format in OF_CONTROLLERS):
        asked = asked._replace(angle="deg" if deg else "rad")
    if format in OF_CONTROLLERS:
        _check_units(asked, found)
    return asked


def _check_units(asked: PoseLayout, found: PoseLayout) -> None:
    """Refuse units that a controller does not have."""
    for unit, own in zip(asked.units, found.units, strict=True):
        if unit != own:
            free = OF_CONTROLLERS[found.format]
            cure = f"; the format {free} takes other units" if free else ""
            raise InputError(
                f"format: {found.format} is in {' and '.join(dict.fromkeys(filter(None, found.units)))},"
                f" {unit} was said{cure}"
            )


def _with_order(layout: PoseLayout, quaternion: Any) -> PoseLayout:
    """Layout with the order of its quaternion, which has to be said."""
    if not isinstance(quaternion, str) or quaternion not in ORDERS:
        asked = f"got {safe_repr(quaternion)}"
        if quaternion is None:
            asked = "none was given"
        raise InputError(
            f"quaternion: the format {layout.format} needs the order of its quaternion,"
            f" {' or '.join(ORDERS)}; {asked}"
        )
    parts = (f"q{letter}" for letter in quaternion)
    return layout._replace(columns=("x", "y", "z", *parts), rotation=quaternion)


def _robot(
    format: str,
    columns: str,
    rotation: Rotation,
    *,
    reverse: bool = False,
) -> PoseLayout:
    """Layout of a controller in mm and degrees."""
    names = tuple(columns.split())
    return PoseLayout(format, names, rotation, reverse, "mm", "deg")


OF_CONTROLLERS: dict[str, str] = {
    "ur": "rotvec",
    "ros": "quat",
    "kuka": "abc",
    "fanuc": "wpr",
    "abb": "quat",
    "staubli": "",
    "yaskawa": "wpr",
    "mitsubishi": "wpr",
    "kawasaki": "zyz",
    "doosan": "zyz",
}
"""Formats whose units are their controller's, with the format of the same numbers in any units."""

_VECTOR = ("x", "y", "z", "rx", "ry", "rz")
_TABLE = (
    PoseLayout("matrix", _ENTRIES, "matrix"),
    PoseLayout("12", _ENTRIES[:12], "matrix"),
    PoseLayout("16", _ENTRIES, "matrix"),
    PoseLayout("quat", (), "wxyz"),
    PoseLayout("7", (), "wxyz"),
    PoseLayout("ros", ("x", "y", "z", "qx", "qy", "qz", "qw"), "xyzw"),
    PoseLayout("rotvec", _VECTOR, "vector"),
    PoseLayout("ur", _VECTOR, "vector"),
    PoseLayout("rpy", ("x", "y", "z", "roll", "pitch", "yaw"), "zyx", True),
    _robot("abc", "X Y Z A B C", "zyx"),
    _robot("kuka", "X Y Z A B C", "zyx"),
    _robot("wpr", "X Y Z W P R", "zyx", reverse=True),
    _robot("fanuc", "X Y Z W P R", "zyx", reverse=True),
    _robot("yaskawa", "X Y Z Rx Ry Rz", "zyx", reverse=True),
    _robot("mitsubishi", "X Y Z A B C", "zyx", reverse=True),
    _robot("staubli", "x y z rx ry rz", "xyz"),
    _robot("zyz", "X Y Z A B C", "zyz"),
    _robot("doosan", "X Y Z A B C", "zyz"),
    _robot("kawasaki", "X Y Z O A T", "zyz"),
    _robot("abb", "x y z q1 q2 q3 q4", "wxyz"),
)
_LAYOUTS = {layout.format: layout for layout in _TABLE}
