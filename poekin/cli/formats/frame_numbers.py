"""Base and tool that `poekin compare` aligned by, as a controller takes them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...analysis.compare.comparison import Comparison
from ...formats.poses import pose_rows
from ...formats.poses.layout import PoseLayout
from ...formats.poses.write import line
from ...groups.arrays import Array
from ..kinematics.poses import pose_layout
from .units import SaidUnits

DECIMALS = 12
"""Of printed numbers: what is left of 0 is noise there."""


def frame_layout(
    format: str | None,
    quaternion: str | None,
    mm: bool | None,
    deg: bool | None,
) -> PoseLayout | None:
    """Layout of --format, None without one. Raises: InputError."""
    if {format, quaternion, mm, deg} == {None}:
        return None
    return pose_layout(format, quaternion, SaidUnits(mm, deg), joints=False)


def frame_lines(result: Comparison, chosen: PoseLayout) -> list[str]:
    """Sentences that name the frames, with their numbers."""
    return [
        f"{title} ({chosen.describe()}): {line(np.round(row, DECIMALS), chosen)}"
        for title, _, row in _frames(result, chosen)
    ]


def frame_numbers(result: Comparison, chosen: PoseLayout) -> dict[str, object]:
    """JSON keys of the frames' numbers and their units."""
    named = {key: row.tolist() for _, key, row in _frames(result, chosen)}
    about = {
        "format": chosen.format,
        "columns": list(chosen.columns),
        "units": list(chosen.units),
    }
    return about | named


def _frames(result: Comparison, chosen: PoseLayout) -> Iterator[tuple[str, str, Array]]:
    for title, key, T in (
        ("base of B in the base of A", "base_numbers", result.base),
        ("tool of A in the tool of B", "tool_numbers", result.tool),
    ):
        if T is not None:
            yield title, key, pose_rows.to_rows(np.asarray(T)[None], chosen).ravel()
