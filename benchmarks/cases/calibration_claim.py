"""The paper's claim for calibration: Denavit-Hartenberg, Hayati's form and screws where two axes
are parallel.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from poekin import Chain, dh

from ..draw import lines
from ..parametrisations import SHOULDER, Elementary, link_parameters, table_with, tilted
from ..parametrisations_fit import (
    Descent,
    Found,
    Sample,
    calibrated,
    condition,
    gauss_newton,
    levenberg_marquardt,
)
from ..report import Figure, Picture, Table, Topic, short

STEPS_BAR, CONDITION_BAR, EXACT, REACHED = 5, 20, 1e-12, 1e-9
D_OF_SHOULDER, BETA = (
    9,
    11,
)  # numbers of the parameters: four of the base and four of link 1 stand before link 2
TILTS_OF_THE_BAR = (1e-2, 3e-3, 1e-3, 3e-4, 1e-4)
TILTS = (1e-1, 3e-2, *TILTS_OF_THE_BAR, *(10.0**-k for k in range(5, 9)))
TWISTS = (0.3, *(10.0**-k for k in np.arange(1, 8.1, 0.5)))
MEASURED, FRESH, SEEN = 40, 200, 60  # poses: to fit, to judge by, and of a condition
PATIENCE, EVALUATIONS = (
    50,
    300,
)  # steps that plain DH may take, and of poses that Levenberg-Marquardt may compute

WORDS = (
    "A Puma 560 of which shoulder and elbow are parallel, written in three ways, each complete and minimal (4 a joint "
    "and 6: 30 parameters): Denavit-Hartenberg (Rz Tz Tx Rx a link), the same with Hayati's link between the two "
    "parallel axes (Rz Tx Rx Ry), and the product of exponentials, POE, whose axes are moved by conjugation, by "
    "poekin's own calibration. Angles are in rad, lengths in units of the arm's R, in rows and columns alike; "
    f"condition: largest ÷ smallest singular value over {SEEN} seeded poses.\n\n"
    "The true arm is the nominal one with the elbow's axis tilted by δ in the plane of the two axes, so that they meet "
    f"at a ÷ tan δ. {MEASURED} noise-free poses, start at the nominal parameters, full Gauss–Newton steps, the same "
    f"for all three; after each step the largest error of the tool's position over {FRESH} fresh poses. At the start "
    "plain DH cannot tell d of the two joints apart, so there singular values below 1e-10 of the largest are left out "
    "of a step.\n\n"
    "Where Hayati's link applies it ties with the screws, in condition and in steps. It is another link for another "
    "case: at right angles, where DH is at its best, its own condition grows without bound. The screws need no case "
    "distinction. Plain DH is not lost for every method: Levenberg–Marquardt may find the far solution, and where it "
    "does, that describes the arm to the rounding of its own large numbers."
)


class Tilt(NamedTuple):
    """What was found for one tilt delta: by three forms, and by Levenberg-Marquardt from several
    sets of poses.
    """

    delta: float
    dh: Found[Elementary]
    hayati: Found[Elementary]
    screws: Found[Chain]
    table: dh.FromChain
    rounding: float
    descents: list[Descent]
    conditions: Sequence[float]

    @property
    def found(self) -> tuple[Found[Elementary], Found[Elementary], Found[Chain]]:
        return self.dh, self.hayati, self.screws


def topic(quick: bool, say) -> Topic:  # type: ignore[no-untyped-def]
    twists = [conditions(forms_with(twist)) for twist in TWISTS]
    say(f"condition at {len(TWISTS)} twists")
    right = [conditions(forms_with(math.pi / 2 - twist)) for twist in TWISTS]
    tilts = []
    for delta in TILTS[:: 3 if quick else 1]:
        tilts.append(at_tilt(delta, 1 if quick else 5))
        say(
            f"tilt {delta:g}: steps {', '.join(_steps(found) for found in tilts[-1].found)} (DH, Hayati, POE)"
        )
    return report(twists, right, tilts)


def forms_with(twist: float) -> tuple[Elementary, Elementary, Chain]:
    """Plain DH, Hayati's and the screws of the arm whose link between the parallel axes has this
    alpha (rad).
    """
    table = table_with(twist)
    return link_parameters(table), link_parameters(table, (SHOULDER,)), dh.to_chain(table)


def conditions(forms: Sequence[Elementary | Chain]) -> tuple[float, ...]:
    """The condition of each form's identification at the same seeded poses."""
    nominal = dh.to_chain(table_with(0.0))
    return tuple(condition(arm, nominal.random(0, SEEN), nominal.reach) for arm in forms)


def at_tilt(delta: float, sets: int) -> Tilt:
    """What the three forms find of an arm with this tilt."""
    nominal, true = dh.to_chain(table_with(0.0)), tilted(delta)

    def poses(seed: int, count: int) -> Sample:
        q = nominal.random(seed, count)
        return Sample(q, true.fk(q))

    measured, fresh = poses(1, MEASURED), poses(2, FRESH)
    plain, hayati, screws = forms_with(0.0)
    by_dh = gauss_newton(plain, measured, fresh, nominal.reach, PATIENCE)
    by_hayati = gauss_newton(hayati, measured, fresh, nominal.reach, STEPS_BAR + 1)
    by_screws = calibrated(screws, measured, fresh, STEPS_BAR + 1)
    table = dh.from_chain(true, convention="standard")
    exact = link_parameters(table.table)
    return Tilt(
        delta,
        by_dh,
        by_hayati,
        by_screws,
        table,
        fresh.error(exact.poses(fresh.q)),
        [
            levenberg_marquardt(plain, poses(10 + k, MEASURED), fresh, nominal.reach, EVALUATIONS)
            for k in range(sets)
        ],
        conditions((exact, by_hayati.arm, true)),
    )


def report(
    twists: Sequence[Sequence[float]], right: Sequence[Sequence[float]], tilts: Sequence[Tilt]
) -> Topic:
    """The topic of what was measured: conditions (DH, Hayati, POE) at each twist, and so far from a
    right angle.
    """
    return Topic(
        "The paper's claim: calibration by DH, by Hayati's form and by screws",
        WORDS,
        figures=figures(twists, right, tilts),
        pictures=[
            _curves("Condition of the identification as two axes become parallel: α turns about their common normal. "
                    "DH grows as 1 ÷ α²; Hayati's form and POE do not", TWISTS, twists, "α (rad)", "condition"),
            _curves("The same for a tilt δ in the axes' common plane, each at the arm's true parameters: DH grows as "
                    "1 ÷ δ³", [t.delta for t in tilts], [t.conditions for t in tilts], "δ (rad)", "condition"),
            _curves("The same as two axes become perpendicular: now Hayati's link is the wrong one", TWISTS, right,
                    "90° − α (rad)", "condition"),
            _curves("The largest difference between the tilted arm's parameters and the nominal ones",
                    [t.delta for t in tilts], [changes(t) for t in tilts], "δ (rad)", "largest change (rad, m)"),
            _curves("Calibration of an arm whose elbow is tilted by δ: error on fresh poses where Gauss–Newton ends",
                    [t.delta for t in tilts], [[max(f.errors[-1], 1e-16) for f in t.found] for t in tilts],
                    "δ (rad)", "error (m)").answering("solve"),
        ],
        tables=[solutions(tilts), descents(tilts), steps(tilts)],
    )  # fmt: skip


def figures(
    twists: Sequence[Sequence[float]], right: Sequence[Sequence[float]], tilts: Sequence[Tilt]
) -> list[Figure]:
    judged = [t for t in tilts if t.delta in TILTS_OF_THE_BAR]
    plain, hayati, screws = (np.array(twists)[:, k] for k in range(3))
    small = [k for k, twist in enumerate(TWISTS) if 1e-6 <= twist <= 1e-2]
    power = np.polyfit(np.log([TWISTS[k] for k in small]), np.log(plain[small]), 1)[0]
    ends = [t.dh.errors[-1] for t in judged]
    span = f"{short(judged[-1].delta)} to {short(judged[0].delta)}"
    return [
        _most_steps(f"Puma, elbow tilted by {span}: Gauss–Newton steps of POE to 1e-12 m on fresh poses, most",
                    [t.screws for t in judged], STEPS_BAR),
        _most_steps("the same, Hayati's form", [t.hayati for t in judged], None),
        Figure(f"the same, plain DH: error on fresh poses after {PATIENCE} steps, least … largest", max(ends),
               shown=f"{short(min(ends))} … {short(max(ends))} m",
               note="best of all steps: " + _list(min(t.dh.errors[1:]) for t in judged)),
        Figure("condition on the identifiable space, α from 0.3 to 1e-8: POE, worst", float(screws.max()),
               CONDITION_BAR, note=f"Hayati's form {short(float(hayati.max()))}"),
        Figure("condition of plain DH: the power of α with which it grows, 1e-2 to 1e-6", float(power),
               bar_shown="−2 ± 0.05", holds=bool(abs(power + 2) <= 0.05),
               note=f"at 1e-2 rad {short(float(plain[small[0]]))}"),
        Figure("condition of POE where the tilt is in the axes' plane, and near the right angle, worst",
               float(np.max([*np.array(right)[:, 2], *(t.conditions[2] for t in tilts)])), CONDITION_BAR,
               note=f"Hayati's form at 1e-4 rad from the right angle {short(float(_at(right, 1e-4)[1]))}"),
    ]  # fmt: skip


def _at(rows: Sequence[Sequence[float]], twist: float) -> Sequence[float]:
    return rows[int(np.argmin(np.abs(np.log(np.array(TWISTS) / twist))))]


def _most_steps(what: str, found: Sequence[Found], bar: float | None) -> Figure:
    counts = [f.steps_to(EXACT) for f in found]
    value = max((math.inf if k is None else k) for k in counts)
    return Figure(what, value, bar, note="by δ, the largest first: " + ", ".join(map(_steps, found)),
                  shown="" if math.isfinite(value) else "not reached")  # fmt: skip


def _steps(found: Found) -> str:
    count = found.steps_to(EXACT)
    return "never" if count is None else str(count)


def _list(values: Iterable[float]) -> str:
    return ", ".join(short(float(value)) for value in values)


def _curves(
    caption: str, x: Sequence[float], rows: Sequence[Sequence[float]], x_label: str, y_label: str
) -> Picture:
    curves: dict[str, Sequence[float]] = dict(
        zip(("DH", "Hayati", "POE"), zip(*rows, strict=True), strict=True)
    )
    return lines(caption, x, curves, x_label=x_label, y_label=y_label, log=True)


def changes(tilt: Tilt) -> tuple[float, float, float]:
    """The largest change (rad, m) of a parameter from the nominal arm's: d of the exact table,
    Hayati's, screws.
    """
    nominal = dh.to_chain(table_with(0.0))
    arm = tilt.screws.arm
    hayati = tilt.hayati.arm.values - link_parameters(table_with(0.0), (SHOULDER,)).values
    screws = np.concatenate(
        [(arm.screws - nominal.screws).ravel(), (arm.home - nominal.home).ravel()]
    )
    lengths = tilt.table.table.d - table_with(0.0).d
    return tuple(float(np.abs(x).max()) for x in (lengths, hayati, screws))  # type: ignore[return-value]


def solutions(tilts: Sequence[Tilt]) -> Table:
    """The parameters that are right, and the errors with which each form ends."""
    rows = []
    for tilt in tilts:
        table = tilt.table.table
        rows.append((
            tilt.delta, float(table.d[SHOULDER]), float(np.degrees(table.theta[SHOULDER])), tilt.rounding,
            *(f"{_steps(found)}; {short(found.errors[-1])}" for found in tilt.found),
            float(tilt.hayati.arm.values[BETA]), float(np.abs(tilt.screws.arm.screws).max()),
            float(np.abs(tilt.screws.arm.screws - tilted(tilt.delta).screws).max()),
        ))  # fmt: skip
    return Table(
        "What is to be found, and what Gauss–Newton finds: steps to 1e-12 m; error on fresh poses where it ends (m)",
        ("δ (rad)", "DH's d₂ (m)", "DH's θ₂ (°)", "error of that table, rounded to float64 (m)", "DH", "Hayati", "POE",
         "Hayati's β (rad)", "largest entry of POE's screws",
         "their largest difference from the true arm's"),
        rows,
    )  # fmt: skip


def descents(tilts: Sequence[Tilt]) -> Table:
    """Plain DH by Levenberg-Marquardt."""
    rows = []
    for tilt in tilts:
        found, errors = tilt.descents, [d.error for d in tilt.descents]
        reached = sum(error <= REACHED for error in errors)
        rows.append((
            tilt.delta, f"{reached} of {len(found)}", float(np.median([d.evaluations for d in found])), min(errors),
            max(errors), _list(d.arm.values[D_OF_SHOULDER] for d in found),
        ))  # fmt: skip
    return Table(
        f"Plain DH by Levenberg–Marquardt (SciPy, exact derivatives), from several sets of {MEASURED} poses, at most "
        f"{EVALUATIONS} evaluations of the poses",
        ("δ (rad)", f"within {short(REACHED)} m", "evaluations, median", "least error (m)", "largest error (m)",
         "d₂ of each (m)"),
        rows,
    )  # fmt: skip


def steps(tilts: Sequence[Tilt]) -> Table:
    """The error at the start and after each of the first steps."""
    rows = [
        (tilt.delta, name, *(found.errors[: STEPS_BAR + 1] + [""] * STEPS_BAR)[: STEPS_BAR + 1])
        for tilt in tilts
        for name, found in zip(("DH", "Hayati", "POE"), tilt.found, strict=True)
    ]
    heads = [f"step {k + 1}" for k in range(STEPS_BAR)]
    return Table(
        "Error on fresh poses (m) after each step; empty: poekin's calibration had ended",
        ("δ (rad)", "form", "start", *heads),
        rows,
        folded=True,
    )
