"""A calibration as one page of HTML: nothing fetched, no scripts; every name out of a file escaped."""

from __future__ import annotations

import math
import os
from collections.abc import Iterable, Sequence
from html import escape
from string import Template

import numpy as np

from ....analysis.compare.compare import compare
from ....errors import ShapeError, escape_unprintable
from ....formats.text.atomic_write import write_whole
from ....groups import so3
from ..model.residuals import Residuals
from ..result import CalibrationData, pose_covariance
from . import changes, page_style, plots
from .changes import milli
from .plots import Curve

CONFIGURATIONS = 1000
"""How many random configurations the uncertainty of the pose is shown at."""
MOST_ROWS = 60
_HEADS = ("", "position rms (mm)", "median", "largest", "rotation rms (mrad)", "median", "largest")


def write(
    found: CalibrationData,
    path: str | os.PathLike[str],
    title: str | None = None,
    sources: Sequence[str] | None = None,
) -> None:
    """Write the page, whole or not at all; see `Calibration.report`."""
    write_whole(path, html(found, title, sources).encode())


def html(
    found: CalibrationData, title: str | None = None, sources: Sequence[str] | None = None
) -> str:
    """The page as text. Raises: ShapeError where sources do not name all rows; MissingExtra."""
    rows = int(found.after.row.max()) + 1
    if sources is not None and len(sources) < rows:
        raise ShapeError(
            f"sources: expected what each of {rows} rows of q came from, got {len(sources)}"
        )
    named = f"Calibration: {found.chain.base} to {found.chain.tip}" if title is None else title
    parts = [
        _section("Residuals", *_residuals(found)),
        _section("What was measured, and what it can tell", *_measured(found)),
        _section("What changed", *_changed(found)),
        _section("How well the pose is known", *_uncertainty(found)),
        _section("Outliers", *_outliers(found, sources)),
        _section("The search", *_search(found)),
        _section("All parameters", *_parameters(found)),
    ]
    return Template(page_style.PAGE).substitute(
        title=_text(named, 200),
        lead=_text(changes.sentence(found)),
        style=page_style.STYLE,
        sections="\n".join(parts),
    )


def _residuals(found: CalibrationData) -> Iterable[str]:
    aside, rows = found.held_out, changes.errors(found)
    yield from (_p(f"Warning: {words}.") for words in found.warnings)
    yield from (_p(f"{words}.") for words in found.remarks)
    if aside is None:
        yield _p(
            "No data were kept aside: these figures are of the measurements that the arm was fitted to."
        )
    else:
        yield _p(
            f"Each of {aside.folds} parts of the readings was kept aside in turn, and judged by a calibration from the"
            " others. Nominal means: the arm as it is described, with the unknown frames, if there are any, fitted."
        )
    curves = [Curve(name, r) for name, r in rows if aside is None or r is not found.before]
    yield _table(_HEADS, [(name, *_figures(r)) for name, r in rows])
    yield _figure(
        plots.residuals(curves), "The share of measurements with an error of at most so much."
    )
    if len(found.spreads) > 1:
        last = found.after if aside is None else aside.after
        yield _table(
            _HEADS,
            [
                (f"set {k}, calibrated", *_figures(_of_set(last, k)))
                for k in range(len(found.spreads))
            ],
        )


def _figures(r: Residuals) -> list[str]:
    largest = [np.nanmax(x) if not np.isnan(x).all() else math.nan for x in (r.length, r.angle)]
    numbers = (r.rms_length, r.median_length, largest[0], r.rms_angle, r.median_angle, largest[1])
    return [milli(x) for x in numbers]


def _of_set(r: Residuals, k: int) -> Residuals:
    mine = r.set == k
    return Residuals(r.length[mine], r.angle[mine], r.set[mine], r.row[mine])


def _measured(found: CalibrationData) -> Iterable[str]:
    rows = []
    for k, spread in enumerate(found.spreads):
        mine = _of_set(found.after, k)
        what = "lengths" if np.isnan(mine.angle).all() else "positions and rotations"
        scatter = "as given" if spread is None else f"{milli(spread.length)} mm" + (
            "" if spread.angle is None else f", {milli(spread.angle)} mrad"
        )  # fmt: skip
        rows.append((str(k), str(len(mine)), what, scatter))
    yield _table(
        ("set", "measurements", "of", "standard deviation of one number"), rows, words=(2, 3)
    )
    can = found.identification
    yield _p(
        f"{can.numbers} numbers were measured for {can.size} parameters. Measurements of this kind can see"
        f" {can.expected} combinations of them, and these see {can.rank}, with condition {can.condition:.3g} (angles in"
        f" rad, lengths in reaches of {found.nominal.reach:.3g} m; smallest singular value {can.smallest:.3g}, O1"
        f" {can.O1:.3g}, noise amplification index {can.amplification:.3g})."
    )
    for said, words in (
        ("Held, as no measurement of this kind sees it", can.held),
        ("Not seen", can.unseen),
    ):
        yield from (_p(f"{said}: {one}.") for one in words)
    places = [(name, T) for name, T in found.frames.items()]
    if places:
        yield _caption("Unknown frames and points, solved along")
        yield _table(("", "x (m)", "y (m)", "z (m)", "rotation vector (rad)"), [
            (name, *(f"{x:.6f}" for x in (T[:3, 3] if T.ndim == 2 else T)),
             ", ".join(f"{w:.5f}" for w in so3.log(T[:3, :3])) if T.ndim == 2 else "")
            for name, T in places
        ], words=(0, 4))  # fmt: skip


def _changed(found: CalibrationData) -> Iterable[str]:
    moved = changes.joints(found)
    if moved:
        yield _p(
            "How far each joint's axis was tilted and shifted across itself; bars are 95 % intervals."
        )
        yield _figure(
            plots.joints(moved),
            "Which two directions across an axis these are stands in the table of all parameters.",
        )
        yield _table(("joint", "tilt (mrad)", "± 95 %", "shift (mm)", "± 95 %"), [
            (j.name, *(milli(x) for c in (j.tilt, j.shift) for x in (c.size, c.margin)))
            for j in moved
        ])  # fmt: skip
    compared = compare(found.nominal, found.chain)
    yield _caption("Nominal and calibrated arm, aligned and compared (the largest first)")
    lines = sorted(compared.joints, key=lambda j: -max(j.shift or 0.0, j.normal or 0.0, j.angle))
    yield _table(("joint", "angle of the axes (°)", "common normal (mm)", "at the arm (mm)", "zero"), [
        (j.name_a, *map(_seen, (j.angle, j.normal, j.shift)),
         f"{_seen(j.zero_offset)} {'mm' if j.unit == 'mm' else '°'}")
        for j in lines[:MOST_ROWS]
    ])  # fmt: skip
    if (e := compared.before) is not None:
        yield _p(
            f"As they stand, the two differ by up to {e.worst_mm:.3g} mm and {e.worst_deg:.3g}° over"
            f" {compared.samples} random configurations, on average by {e.mean_mm:.3g} mm and {e.mean_deg:.3g}°."
        )


def _uncertainty(found: CalibrationData) -> Iterable[str]:
    C = pose_covariance(found, found.nominal.random(0, CONFIGURATIONS))
    angle, length = (
        np.sqrt(np.maximum(np.trace(C[:, k, k], axis1=1, axis2=2), 0.0))
        for k in (np.s_[:3], np.s_[3:])
    )
    mm, mrad = (
        [milli(float(x)) for x in (np.median(values), values.max())] for values in (length, angle)
    )
    yield _p(
        f"At {CONFIGURATIONS} random configurations within the limits, the tip's position has a standard deviation of"
        f" {mm[0]} mm in the median and {mm[1]} mm at most, its rotation of {mrad[0]} and {mrad[1]} mrad: what noise of"
        " the measurements leaves. What was held counts as known; what the model leaves out, such as bending, is not in"
        " it."
    )
    yield _figure(
        plots.uncertainty(length, angle), "Standard deviations over random configurations."
    )


def _outliers(found: CalibrationData, sources: Sequence[str] | None) -> Iterable[str]:
    if not found.outliers:
        yield _p("None: no measurement is off by more than one good one in 10 000 would be.")
        return
    yield _p(
        f"{len(found.outliers)} of {len(found.after)} measurements are off by more than one good one in 10 000 would be"
        + (f"; the first {MOST_ROWS} of them:" if len(found.outliers) > MOST_ROWS else ".")
    )
    heads = ("row", "set", "position error (mm)", "rotation error (mrad)")
    rows = []
    for o in found.outliers[:MOST_ROWS]:
        k = np.flatnonzero(found.after.set == o.set)[o.index]
        angle = float(found.after.angle[k])
        row = (str(o.row), str(o.set), milli(float(found.after.length[k])), milli(angle))
        rows.append(row if sources is None else (*row, sources[o.row]))
    yield _table(heads if sources is None else (*heads, "from"), rows, words=(4,))


def _search(found: CalibrationData) -> Iterable[str]:
    state = "converged" if found.success else "did NOT converge"
    yield _p(
        f"The search with the loss {found.loss} {state} in {len(found.steps)} steps, counted over all its rounds."
    )
    if found.steps:
        yield _figure(
            plots.steps(found.steps),
            "Each round begins with newly estimated spreads, where none were given.",
        )


def _parameters(found: CalibrationData) -> Iterable[str]:
    rows = [
        (p.owner, p.what, f"{v:.6g}", f"{d:.2g}", p.unit)
        for p, v, d in zip(
            found.parameters, found.values.tolist(), found.deviations.tolist(), strict=True
        )
    ]
    table = _table(("of", "what", "value", "standard deviation", "unit"), rows, words=(0, 1, 4))
    yield f"<details><summary>{len(rows)} parameters</summary>{table}</details>"


def _seen(value: float | None) -> str:
    """A figure in mm or degrees; what is far below them is rounding."""
    return "" if value is None else f"{0.0 if abs(value) < 1e-9 else value:.3g}"


def _text(words: object, width: int | None = None) -> str:
    return escape(escape_unprintable(words, width))


def _section(title: str, *parts: str) -> str:
    return "\n".join(["<section>", f"<h2>{_text(title)}</h2>", *parts, "</section>"])


def _p(words: str) -> str:
    return f"<p>{_text(words)}</p>"


def _caption(words: str) -> str:
    return f'<p class="caption">{_text(words)}</p>'


def _figure(svg: str, caption: str) -> str:
    return f"<figure>{svg}<figcaption>{_text(caption)}</figcaption></figure>"


def _table(heads: Sequence[str], rows: Iterable[Sequence[str]], words: Sequence[int] = (0,)) -> str:
    """Columns of numbers, but for those in `words`; a column with nothing in it is left out."""
    rows = list(rows)
    kept = [i for i in range(len(heads)) if not rows or any(row[i] for row in rows)]
    kinds = ["word" if i in words else "number" for i in kept]
    head = "".join(
        f'<th class="{kind}">{_text(heads[i])}</th>' for kind, i in zip(kinds, kept, strict=True)
    )
    body = "".join(
        f"<tr>{''.join(map(_cell, kinds, [row[i] for i in kept]))}</tr>\n" for row in rows
    )
    return f'<div class="wide"><table><thead><tr>{head}</tr></thead><tbody>\n{body}</tbody></table></div>'


def _cell(kind: str, words: str) -> str:
    return f'<td class="{kind}">{_text(words, 200)}</td>'
