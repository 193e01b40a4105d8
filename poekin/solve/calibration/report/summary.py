"""Summary of a calibration as text: what was found, how well, and what to be wary of."""

from __future__ import annotations

import numpy as np

from ....errors import escape_unprintable
from ..result import CalibrationData

MOST_OUTLIERS = 12


def text_of(found: CalibrationData) -> str:
    """Lines that `print` of a calibration shows."""
    state = "converged" if found.success else "NOT converged: the best that was found"
    lines = [
        f"{len(found.parameters)} parameters, {len(found.after)} measurements, {state} in "
        f"{len(found.steps)} steps",
        str(found.identification),
        *_table(found),
        *_outliers(found),
        *(f"warning: {words}" for words in found.warnings),
        *found.remarks,
    ]
    return "\n".join(escape_unprintable(line, keep="\n") for line in lines)


def _outliers(found: CalibrationData) -> list[str]:
    if not found.outliers:
        return []
    rows = ", ".join(str(o.row) for o in found.outliers[:MOST_OUTLIERS])
    more = len(found.outliers) - MOST_OUTLIERS
    rest = f" and {more} more" if more > 0 else ""
    return [f"outliers: rows {rows}{rest}"]


def _table(found: CalibrationData) -> list[str]:
    """Residuals before and after, on all measurements and on those kept aside."""
    kept = found.held_out
    rows = [("before", found.before), ("after", found.after)]
    if kept is not None:
        rows += [
            (f"kept aside ({kept.folds} folds), before", kept.before),
            ("kept aside, after", kept.after),
        ]
    angles = not np.isnan(found.before.angle).all()
    heads = ["median mm", "rms mm"] + ["median mrad", "rms mrad"] * angles
    lines = [" " * 29 + "".join(f"{head:>13}" for head in heads)]
    for name, r in rows:
        values = [r.median_length, r.rms_length] + [r.median_angle, r.rms_angle] * angles
        lines.append(f"{name:29}" + "".join(f"{1e3 * value:13.3g}" for value in values))
    return lines
