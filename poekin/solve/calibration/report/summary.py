"""Summary of a calibration as text: what was found, how well, and what to be wary of."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ....errors import escape_unprintable, quote
from ....groups.arrays import Array
from ..result import CalibrationData
from . import changes, pendant

MOST_OUTLIERS = 12


def text_of(found: CalibrationData) -> str:
    """Lines that `print` of a calibration shows."""
    outliers = []
    if found.outliers:
        rows = ", ".join(str(o.row) for o in found.outliers[:MOST_OUTLIERS])
        more = len(found.outliers) - MOST_OUTLIERS
        outliers = [f"outliers: rows {rows}"]
        if more > 0:
            outliers[0] += f" and {more} more"
    lines = [
        headline(found),
        str(found.identification),
        *_table(found),
        found.workspace().summary(),
        *map(str, changes.aligned_joints(found)),
        *pendant.lines(found),
        *_places(found),
        *_diagnosis(found),
        *map(str, found.terms),
        *outliers,
        *(f"do not use it: {words}" for words in found.verdict),
        *(f"warning: {words}" for words in found.warnings),
        *found.remarks,
    ]
    return "\n".join(escape_unprintable(line, keep="\n") for line in lines)


def headline(found: CalibrationData) -> str:
    """Size of the fit, and whether it converged."""
    state = "NOT converged: the best that was found"
    if found.success:
        state = "converged"
    return (
        f"{len(found.parameters)} parameters, {len(found.after)} measurements, {state} in "
        f"{len(found.steps)} steps"
    )


def _places(found: CalibrationData) -> Iterator[str]:
    """Points that were not known, each with its standard deviations."""
    for name, place in found.frames.items():
        if place.shape != (3,):
            continue
        mine = [k for k, p in enumerate(found.parameters) if p.owner == name]
        sigma = np.sqrt(np.diag(found.covariance)[mine])
        frame = found.nominal.tip if name.startswith("point") else found.nominal.base
        told = f"{name} at ({_in_mm(place, 3)}) mm in {quote(frame)}, standard deviations ({_in_mm(sigma, 4)}) mm"
        if any(name in words for words in found.identification.unidentifiable):
            told += " while what is unidentifiable is fixed"
        yield told


def _in_mm(lengths: Array, digits: int) -> str:
    return ", ".join(f"{1e3 * x + 0.0:.{digits}f}" for x in lengths)


def _diagnosis(found: CalibrationData) -> list[str]:
    diagnosis = found.diagnosis
    return [] if diagnosis is None else [str(diagnosis)]


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
