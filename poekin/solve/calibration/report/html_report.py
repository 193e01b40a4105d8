"""A calibration as one page of HTML: nothing fetched, no scripts; every name out of a file escaped."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from itertools import zip_longest

import numpy as np

from .... import html_page
from ....analysis.compare.comparison import JointComparison
from ....errors import ShapeError, escape_unprintable
from ....groups import so3
from ....groups.arrays import Array
from ....groups.vectors import norms, rotation_part, translation_part
from ....html_page import caption, figure, paragraph, text
from ..diagnostics.base_and_tool import FrameEstimate
from ..diagnostics.effects.diagnosis import FitEvidence, ResidualDiagnosis
from ..model.parameters import SHIFT, TILT
from ..model.residual_vectors import ResidualVectors
from ..model.residuals import Residuals, largest, median, rms
from ..result import CalibrationData
from . import changes, pendant, plots, residual_plots
from .changes import milli

MOST_ROWS = 60
_STYLE = "td.typed { white-space: nowrap; }\n"
_HEADS = ("", "position rms (mm)", "median", "largest", "rotation rms (mrad)", "median", "largest")


def html(
    found: CalibrationData,
    title: str | None = None,
    sources: Sequence[str] | None = None,
) -> str:
    """The page as text; see `Calibration.report`. Raises: ShapeError where sources do not name all
    rows; MissingExtra.
    """
    rows = int(found.after.row.max()) + 1
    if sources is not None and len(sources) < rows:
        raise ShapeError(
            f"sources: expected what each of {rows} rows of q came from, got {len(sources)}"
        )
    if title is None:
        title = f"Calibration: {found.chain.base} to {found.chain.tip}"
    sections = {
        "Residuals": _residuals(found),
        "What changed": _changed(found),
        "Base and tool, to be typed in": _frames(found),
        "What the residuals show": _diagnosis(found),
        "What was measured, and what it can tell": _measured(found),
        "How well the pose is known": _uncertainty(found),
        "Outliers": _outliers(found, sources),
        "The search": _search(found),
        "Other parameters": _parameters(found),
    }
    parts = [paragraph(changes.sentence(found), "lead")]
    for head, section in sections.items():
        parts += ["<section>", f"<h2>{text(head)}</h2>", *section, "</section>"]
    return html_page.page(title, parts, _STYLE)


def _residuals(found: CalibrationData) -> Iterator[str]:
    held_out = found.cross_validation
    rows = changes.errors(found)
    yield from (paragraph(f"Do not use it: {words}.") for words in found.verdict)
    yield from (paragraph(f"Warning: {words}.") for words in found.warnings)
    yield from (paragraph(f"{words}.") for words in found.remarks)
    yield from (paragraph(f"{term}.") for term in found.terms)
    if held_out is None:
        yield paragraph(
            "No data were held out: these figures are of the measurements that the arm was fitted "
            "to."
        )
    else:
        yield paragraph(
            f"Each of {held_out.folds} folds of the readings was held out in turn, and predicted by"
            " a calibration from the others. Nominal means: the arm as it is described, with the "
            "unknown frames, if there are any, fitted."
        )
    curves = [r for r in rows if held_out is None or r.residuals is not found.before]
    yield _table(_HEADS, [_residuals_row(name, r) for name, r in rows])
    yield figure(
        plots.residuals(curves),
        "The share of measurements with an error of at most so much.",
    )
    if len(found.noise_std) > 1:
        last = rows[1].residuals
        sets = range(len(found.noise_std))
        lines = [_residuals_row(f"set {k}, calibrated", last.of_set(k)) for k in sets]
        yield _table(_HEADS, lines)


def _residuals_row(name: str, r: Residuals) -> list[str]:
    figures = [f(x) for x in (r.length, r.angle) for f in (rms, median, largest)]
    return [name, *map(milli, figures)]


def _measured(found: CalibrationData) -> Iterator[str]:
    heads = ("set", "measurements", "of", "standard deviation of one number")
    rows = [_noise_row(found, k) for k in range(len(found.noise_std))]
    yield _table(heads, rows, words=(2, 3))
    can = found.identification
    yield paragraph(
        f"{can.n_equations} equations for {can.size} parameters. Measurements of this kind can "
        f"identify {can.identifiable} combinations of them, and these identify {can.rank}, with "
        f"condition {can.condition:.3g} (angles in rad, lengths in reaches of "
        f"{found.nominal.reach:.3g} m; smallest singular value {can.smallest:.3g}, O1 {can.O1:.3g},"
        f" noise amplification index {can.amplification:.3g})."
    )
    for words in can.unidentifiable:
        yield paragraph(f"Unidentifiable from measurements of this kind, fixed: {words}.")
    for words in can.unobserved:
        yield paragraph(f"Unobserved: {words}.")
    if found.frames:
        heads = ("", "x (m)", "y (m)", "z (m)", "rotation vector (rad)")
        yield caption("Unknown frames and points, estimated jointly")
        rows = [_frame_row(*item) for item in found.frames.items()]
        yield _table(heads, rows, words=(0, 4))


def _noise_row(found: CalibrationData, k: int) -> tuple[str, ...]:
    mine = found.after.of_set(k)
    what = "positions and rotations"
    if np.isnan(mine.angle).all():
        what = "lengths"
    estimate = found.noise_std[k]
    noise = "as given"
    if estimate is not None:
        noise = f"{milli(estimate.length)} mm"
        if estimate.angle is not None:
            noise += f", {milli(estimate.angle)} mrad"
    return str(k), str(len(mine)), what, noise


def _frame_row(name: str, frame: Array) -> tuple[str, ...]:
    """A pose (4, 4) or a point (3,)."""
    if frame.ndim == 1:
        return name, *(f"{x:.6f}" for x in frame), ""
    turn = ", ".join(f"{w:.5f}" for w in so3.log(rotation_part(frame)))
    return name, *(f"{x:.6f}" for x in translation_part(frame)), turn


def _changed(found: CalibrationData) -> Iterator[str]:
    yield caption("Nominal and calibrated arm, base and tool aligned (the largest first)")
    lines = sorted(changes.aligned_joints(found), key=_difference, reverse=True)
    yield _table(changes.HEADS, [changes.row(j) for j in lines[:MOST_ROWS]])
    yield paragraph(
        "What depends on where base and tool were put, such as how far an axis is tilted in the base,"
        " is not shown: other choices of these frames have other numbers of the same arm."
    )


def _difference(j: JointComparison) -> float:
    """Largest difference of two axes, in mm or degrees."""
    return max(
        1e3 * (j.shift or 0.0),
        1e3 * (j.normal or 0.0),
        math.degrees(j.angle),
    )


def _diagnosis(found: CalibrationData) -> Iterator[str]:
    diagnosis = found.diagnosis
    if diagnosis is not None:
        yield from _tests(diagnosis)
    if found.residuals is None or not isinstance(found.evidence, FitEvidence):
        yield paragraph("A calibration out of a file has no measurements to be looked at.")
        return
    for picture in residual_plots.pictures(found.residuals, found.evidence):
        if picture.panels:
            yield figure(
                residual_plots.drawn(picture), f"{picture.words} Bars: means ± 2 standard errors."
            )
    yield from _by_point(found.residuals, found.evidence)


def _tests(diagnosis: ResidualDiagnosis) -> Iterator[str]:
    yield from (paragraph(f"{test}.") for test in diagnosis.findings)
    if not diagnosis.findings:
        yield paragraph(f"{diagnosis}.")
    heads = ("residuals against", "chance", "explains (mm)")
    rows = [(test.what, f"{test.p:.2g}", milli(test.size)) for test in diagnosis.tests]
    table = _table(heads, rows)
    yield html_page.details(f"{len(rows)} tests, chances corrected for their number", table)


def _by_point(residuals: ResidualVectors, evidence: FitEvidence) -> Iterator[str]:
    """Means of the residuals of each point and set, in axes of the tool."""
    e = residuals.in_axes("tool").after
    rows = []
    begin = 0
    for k, s in enumerate(evidence.problem.sets):
        if not s.sees_arm:
            continue
        count = max(1, (s.width - s.angular) // 3)
        end = begin + len(s) * count
        for j in range(count):
            mine = e[begin + j : end : count]
            figures = [*mine.mean(axis=0), rms(norms(mine))]
            numbers = map(milli, figures)
            rows.append((str(k), s.what, str(j + 1), *numbers))
        begin = end
    yield caption("Means in axes of the tool, by set of measurements and point")
    heads = ("set", "kind", "point", "x (mm)", "y (mm)", "z (mm)", "rms (mm)")
    yield _table(heads, rows, words=(1,))


def _frames(found: CalibrationData) -> Iterator[str]:
    frames = found.tool_and_base
    if not frames:
        yield paragraph("A calibration out of a file does not say which of their numbers are held.")
        return
    yield paragraph(
        "Base and tool with which a controller that has the nominal arm is nearest to the calibrated"
        " one, with 95 % intervals. What is held stayed as it was, as the measurements do not tell it."
    )
    for frame in frames:
        head = pendant.title(found, frame)
        if pendant.is_held(frame):
            yield paragraph(f"{head}: held, these measurements do not tell it.")
            continue
        yield caption(head)
        yield _typed(frame)


def _typed(frame: FrameEstimate) -> str:
    """Numbers of a frame, a column for each form."""
    heads = [f"{name} ({pendant.units(form)})" for name, form in pendant.FORMS.items()]
    columns = [map(str, pendant.typed(frame, form)) for form in pendant.FORMS.values()]
    kinds = ["typed"] * len(heads)
    lines = [html_page.row(cells, kinds) for cells in zip_longest(*columns, fillvalue="")]
    return html_page.table(heads, kinds, lines)


def _uncertainty(found: CalibrationData) -> Iterator[str]:
    known = found.workspace()
    both = (known.length, known.angle)
    lengths, angles = ([milli(median(x)), milli(largest(x))] for x in both)
    worst = ", ".join(f"{x:.3g}" for x in known.worst)
    yield paragraph(
        f"At {len(known.q)} random configurations within the limits, the tip's position has a "
        f"standard deviation of {lengths[0]} mm in the median and {lengths[1]} mm at most, at q = "
        f"({worst}), its rotation of {angles[0]} and {angles[1]} mrad: what noise of the "
        "measurements leaves. "
        "What was fixed counts as known; what the model leaves out, such as bending, is not in it."
    )
    yield figure(
        plots.uncertainty(known.length, known.angle),
        "Standard deviations over random configurations.",
    )


def _outliers(found: CalibrationData, sources: Sequence[str] | None) -> Iterator[str]:
    if not found.outliers:
        yield paragraph("None: no measurement is off by more than one good one in 10 000 would be.")
        return
    more = "."
    if len(found.outliers) > MOST_ROWS:
        more = f"; the first {MOST_ROWS} of them:"
    yield paragraph(
        f"{len(found.outliers)} of {len(found.after)} measurements are off by more than one good "
        f"one in 10 000 would be{more}"
    )
    heads = ("row", "set", "position error (mm)", "rotation error (mrad)", "from")
    rows = []
    for o in found.outliers[:MOST_ROWS]:
        mine = found.after.of_set(o.set)
        source = ""
        if sources is not None:
            source = sources[o.row]
        row = (
            str(o.row),
            str(o.set),
            milli(mine.length[o.index]),
            milli(mine.angle[o.index]),
            source,
        )
        rows.append(row)
    yield _table(heads, rows, words=(4,))


def _search(found: CalibrationData) -> Iterator[str]:
    state = "did NOT converge"
    if found.success:
        state = "converged"
    yield paragraph(
        f"The search with the loss {found.loss} {state} in {len(found.steps)} steps, counted over "
        "all its rounds."
    )
    if found.steps:
        yield figure(
            plots.steps(found.steps),
            "Each round begins with newly estimated noise, where no covariance was given.",
        )


def _parameters(found: CalibrationData) -> Iterator[str]:
    """All but tilts and shifts of axes, which depend on where base and tool are put."""
    heads = ("of", "what", "value", "standard deviation", "unit")
    rows = [
        (p.owner, p.what, f"{value:.6g}", f"{s:.2g}", p.unit)
        for p, value, s in zip(found.parameters, found.values, found.deviations, strict=True)
        if not p.what.startswith((TILT, SHIFT))
    ]
    table = _table(heads, rows, words=(0, 1, 4))
    yield html_page.details(f"{len(rows)} parameters", table)


def _table(
    heads: Sequence[str],
    rows: Iterable[Sequence[str]],
    words: Sequence[int] = (0,),
) -> str:
    """Columns of numbers, but for those in `words`; a column with nothing in it is left out."""
    rows = list(rows)
    kept = [i for i in range(len(heads)) if not rows or any(row[i] for row in rows)]
    kinds = ["word" if i in words else "number" for i in kept]
    cells = ([escape_unprintable(row[i], 200) for i in kept] for row in rows)
    lines = [html_page.row(line, kinds) for line in cells]
    return html_page.table([heads[i] for i in kept], kinds, lines)
