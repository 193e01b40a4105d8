"""Text of poses in a controller's own notation, to be pasted into its programs."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ...errors import InputError
from ...groups import arrays
from . import pose_rows
from .layout import PoseFormat, PoseLayout, QuaternionOrder, layout

_BRACKETS = {
    "ur": "p[{}]",
    "staubli": "{{{}}}",
    "mitsubishi": "({})",
    "kawasaki": "TRANS({})",
    "doosan": "posx({})",
}
_ROS = "{{position: {{x: {}, y: {}, z: {}}}, orientation: {{x: {}, y: {}, z: {}, w: {}}}}}"


def write(
    T: ArrayLike,
    format: PoseFormat,
    *,
    quaternion: QuaternionOrder | None = None,
    mm: bool | None = None,
    deg: bool | None = None,
) -> str:
    """Text of poses in the notation of a controller, one pose a line, as `read` reads it.

    "ur" `p[...]`, "kuka" `{X 1, Y 2, ...}`, "fanuc" `X = 1 mm, ...`, "abb" `[[...], [...]]`, "ros"
    a geometry_msgs/Pose as YAML, "staubli" `{...}`, "mitsubishi" `(...)`, "kawasaki" `TRANS(...)`,
    "doosan" `posx(...)`; in any other format the numbers with commas between.

    Parameters
    ----------
    T : (..., 4, 4) array_like
        Poses, m, in any frame.
    format, quaternion, mm, deg : optional
        As in `to_numbers`.

    Returns
    -------
    text : str
        A line for each pose, in the frame of T, without a line break at the end. Numbers are the
        shortest that read back as the same float, without exponents, which not all controllers and
        no YAML reader take for numbers.

    Raises
    ------
    InputError
        If the format or the order is none of those, or a pose is not finite.
    PoseError, ShapeError
        If T is no pose.

    Notes
    -----
    Accuracy: read back, the same rotation within 1e-15; held by tests/formats/poses/test_write.py.
    Source: as in `from_numbers`.

    Examples
    --------
    >>> import poekin as pk
    >>> T = pk.poses.from_numbers([500, 0, 300, 0, 0, 90], "wpr")
    >>> print(pk.poses.write(T, "kuka"))
    {X 500, Y 0, Z 300, A 90, B 0, C 0}
    >>> print(pk.poses.write(T, "fanuc"))
    X = 500 mm, Y = 0 mm, Z = 300 mm, W = 0 deg, P = 0 deg, R = 90 deg
    """
    poses = arrays.poses(T)
    if not np.isfinite(poses).all():
        place = arrays.first_place(~np.isfinite(poses).all(axis=(-2, -1)), "T")
        raise InputError(f"{place}: expected a finite pose")
    chosen = layout(format, quaternion, mm=mm, deg=deg)
    rows = pose_rows.to_rows(poses.reshape(-1, 4, 4), chosen)
    return "\n".join(line(row, chosen) for row in rows)


def line(row: arrays.Array, chosen: PoseLayout) -> str:
    """The numbers of one pose in the notation of its format."""
    words = [_word(x) for x in row]
    vendor = chosen.format
    if vendor in _BRACKETS:
        return _BRACKETS[vendor].format(", ".join(words))
    if vendor == "kuka":
        pairs = (f"{key} {word}" for key, word in zip(chosen.columns, words, strict=True))
        return f"{{{', '.join(pairs)}}}"
    if vendor == "fanuc":
        each = zip(chosen.columns, words, chosen.units, strict=True)
        return ", ".join(f"{key} = {word} {unit}" for key, word, unit in each)
    if vendor == "abb":
        return f"[[{', '.join(words[:3])}], [{', '.join(words[3:])}]]"
    if vendor == "ros":
        return _ROS.format(*(f"{word}.0" if "." not in word else word for word in words))
    return ", ".join(words)


def _word(x: float) -> str:
    """The shortest decimal that reads back as x, without an exponent."""
    return np.format_float_positional(x + 0.0, trim="-")
