"""Summary of a calibration as text: what was found, how well, and what to be wary of."""

from __future__ import annotations

import numpy as np

from ....errors import escape_unprintable
from ..model.residuals import largest, median
from ..result import CalibrationData
from . import changes, pendant
from .changes import milli

MOST_OUTLIERS = 12


def text_of(found: CalibrationData) -> str:
    """Lines that `print` of a calibration shows."""
    state = "NOT converged: the best that was found"
    if found.success:
        state = "converged"
    outliers = []
    if found.outliers:
        rows = ", ".join(str(o.row) for o in found.outliers[:MOST_OUTLIERS])
        more = len(found.outliers) - MOST_OUTLIERS
        outliers = [f"outliers: rows {rows}"]
        if more > 0:
            outliers[0] += f" and {more} more"
    lines = [
        f"{len(found.parameters)} parameters, {len(found.after)} measurements, {state} in "
        f"{len(found.steps)} steps",
        str(found.identification),
        *_table(found),
        _known(found),
        *_joints(found),
        *pendant.lines(found),
        *_diagnosis(found),
        *map(str, found.terms),
        *outliers,
        *(f"do not use it: {words}" for words in found.verdict),
        *(f"warning: {words}" for words in found.warnings),
        *found.remarks,
    ]
    return "\n".join(escape_unprintable(line, keep="\n") for line in lines)


def _joints(found: CalibrationData) -> list[str]:
    """Changes of each joint, base and tool aligned."""
    return [str(joint) for joint in changes.aligned_joints(found)]


def _diagnosis(found: CalibrationData) -> list[str]:
    diagnosis = found.diagnosis
    return [] if diagnosis is None else [str(diagnosis)]


def _known(found: CalibrationData) -> str:
    """Uncertainty of the tool over the workspace, in words."""
    known = found.workspace()
    worst = ", ".join(f"{x:.3g}" for x in known.worst)
    return (
        f"the tool is known to {milli(median(known.length))} mm and {milli(median(known.angle))} "
        f"mrad over the workspace (standard deviation, median), worst "
        f"{milli(largest(known.length))} mm at q = ({worst})"
    )


def _table(found: CalibrationData) -> list[str]:
    """Residuals before and after, on all measurements and on held-out data."""
    rows = [("before", found.before), ("after", found.after)]
    held_out = found.cross_validation
    if held_out is not None:
        rows.append((f"held out ({held_out.folds} folds), before", held_out.before))
        rows.append(("held out, after", held_out.after))
    heads = ["median mm", "rms mm", "median mrad", "rms mrad"]
    if np.isnan(found.before.angle).all():
        heads = heads[:2]
    lines = [" " * 29 + "".join(f"{head:>13}" for head in heads)]
    for name, r in rows:
        values = (r.median_length, r.rms_length, r.median_angle, r.rms_angle)
        cells = (f"{1e3 * value:13.3g}" for value in values[: len(heads)])
        lines.append(f"{name:29}" + "".join(cells))
    return lines
