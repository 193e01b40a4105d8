"""`poekin fk`: the pose of a link."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np
from typer import Option

from ...formats.poses import pose_rows
from ...formats.poses.layout import PoseLayout, layout
from ...formats.poses.write import line
from .. import array_files
from ..formats.units import SI, Deg, Mm, SaidUnits
from ..output import name, number, say
from . import poses
from .arm import (
    Base,
    ChainArguments,
    File,
    Input,
    Json,
    Numbers,
    Output,
    Results,
    Tip,
    compute,
    give,
    show_coordinates,
    take,
)

DECIMALS = 12
"""Of printed numbers other than the matrix: what is left of 0 is noise there."""
Format = Annotated[
    str | None,
    Option(
        "--format",
        metavar="FORMAT",
        help="The pose as a controller or ROS writes it: matrix, quat, rotvec, rpy, abc, wpr, ..., as in ik.",
    ),
]


def command(
    file: File,
    q: Numbers = None,
    tip: Tip = None,
    base: Base = None,
    given: Input = None,
    format: Format = None,
    quaternion: poses.Quaternion = None,
    mm: Mm = None,
    deg: Deg = None,
    output: Output = None,
    json: Json = False,
) -> None:
    """Pose (4×4, in m) of the link --tip in the link --base, at Q or at every line of --input."""
    array_files.check_place(output)
    array_files.check_apart([output], model=file, configurations=given)
    units = SaidUnits(mm, deg)
    chosen = None
    if format is not None or quaternion is not None:
        chosen = poses.pose_layout(format, quaternion, units)
    arm = take(file, tip, base, q, given, units=units)
    T = compute(arm, arm.chain.fk, (4, 4))
    title = f"pose of {name(arm.chain.tip)} in {name(arm.chain.base)} (m)"
    entries = layout("matrix").columns
    give(arm, PoseResults(T, "T", title, entries, units=units, layout=chosen), output, json)


@dataclass(frozen=True)
class PoseResults(Results):
    """Poses, as 4x4 matrices or, with a layout, as rows of its numbers."""

    units: SaidUnits = SI
    layout: PoseLayout | None = None

    def array(self) -> np.ndarray:
        """Poses (N, 4, 4), or rows (N, k) of their numbers."""
        if self.layout is None:
            return self.values
        return pose_rows.to_rows(self.values, self.layout)

    def csv(self) -> str:
        """CSV with a line for each pose; units in the header where they were said."""
        if self.layout is None:
            return super().csv()
        columns = _with_units(self.layout, self.units.said())
        return replace(self, values=self.array(), rows=columns, layout=None).csv()

    def json(self, arm: ChainArguments, single: bool) -> str:
        """JSON with configurations, matrices in m and, with a layout, the numbers and their units."""
        if self.layout is None:
            return super().json(arm, single)
        rows = self.array()
        extra = {
            "format": self.layout.format,
            "columns": list(self.layout.columns),
            "units": list(self.layout.units),
            "numbers": rows.ravel() if single else rows,
        }
        return replace(self, layout=None, extra=extra).json(arm, single)

    def show(self, arm: ChainArguments) -> None:
        """Print the pose of a single configuration: the matrix, position, quaternion and rpy; with
        a layout, the text that its controller reads.
        """
        chosen = self.layout
        if chosen is None:
            super().show(arm)
            _show_numbers(self.values, self.units)
            return
        (q,), (row,) = arm.q, self.array()
        say(f"{self.title.removesuffix(' (m)')} ({chosen.describe()}), at")
        show_coordinates(arm.chain, q, self.units)
        say()
        say("  " + line(np.round(row, DECIMALS), chosen))


def _with_units(chosen: PoseLayout, said: Sequence[str]) -> list[str]:
    pairs = zip(chosen.columns, chosen.units, strict=True)
    return [f"{column} [{unit}]" if unit in said else column for column, unit in pairs]


def _show_numbers(T: np.ndarray, units: SaidUnits) -> None:
    """Print position, quaternion and roll, pitch, yaw of a single pose (1, 4, 4)."""
    turned = layout("quat", "wxyz", mm=units.mm)
    p, wxyz = np.split(pose_rows.to_rows(T, turned).ravel(), [3])
    angles = layout("rpy", deg=units.deg is not False)
    rpy = pose_rows.to_rows(T, angles)[:, 3:].ravel()
    say()
    rows = (
        ("position", p, f"x y z, {turned.length}"),
        ("quaternion", wxyz, "w x y z"),
        ("rpy", rpy, f"roll pitch yaw, {angles.angle}"),
    )
    for label, values, unit in rows:
        words = (number(round(v, DECIMALS), 9) for v in values)
        say(f"  {label:<10} {' '.join(words)}  ({unit})")
