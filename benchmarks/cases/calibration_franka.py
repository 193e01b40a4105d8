"""A real arm: the Franka's observations of a fixed board by the camera on its hand, data kept
aside.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import NamedTuple

import numpy as np

from poekin import Chain, load
from poekin.solve import calibration as cal
from poekin.solve.calibration.fit.losses import LossName
from poekin.solve.calibration.measurements import data

from ..report import Figure, Table, Topic, short

VARIABLE = "POEKIN_FRANKA_DATA"
PLACE = (
    Path(__file__).resolve().parents[3]
    / "shared"
    / "data"
    / "franka_eye_in_hand"
    / "observations.csv"
)
POSITION, ROTATION = 1.0, 4.0  # bars: median in mm, root mean square in mrad
LOSSES: tuple[LossName, ...] = ("linear", "huber", "cauchy", "tukey")
LOSS: LossName = "cauchy"
FOLDS = 5
SEEDS = 5

WORDS = (
    "114 observations of a Franka arm, camera on the hand, board that stands still, their poses unknown (P. Nadeau, "
    "robot-arm-kinematic-calibration, MIT licence; as CSV, values unchanged; some observations are outliers). "
    f"Each of {FOLDS} parts, drawn at random, is foretold by a calibration from the other four, and the errors of all "
    "are pooled: outliers among them count. Before: board and camera fitted only; after: the seven screws too. "
    f"The bar is for the {LOSS.capitalize()} loss and the first draw of the parts; all losses and {SEEDS} draws are "
    "in the tables. Board and camera take up the home pose and where the base stands: those are held. The data is not "
    f"part of the repository: {VARIABLE} names its file, `observations.csv`, or it stands in shared/data beside the "
    "repository."
)


class Kept(NamedTuple):
    """Residuals on held-out data, mm and mrad: median and root mean square of each."""

    position: float
    position_rms: float
    rotation: float
    rotation_rms: float


def topic(quick: bool, say) -> Topic:  # type: ignore[no-untyped-def]
    place = data_file()
    if not place.is_file():
        say(f"{place.name} is not there")
        return absent(place)
    arm = load("panda").chain(tip="panda_link8")
    q, measured = data.read(place, arm, kind="eye-in-hand")
    seeds = range(2 if quick else SEEDS)
    after, before = {}, {}
    for loss in LOSSES:
        for seed in seeds:
            after[loss, seed], before[loss, seed] = kept_aside(arm, q, measured, loss, seed)
        say(
            f"{loss}: {short(after[loss, 0].position)} mm, {short(after[loss, 0].rotation_rms)} mrad"
        )
    whole = cal.calibrate(arm, q, measured, loss=LOSS, folds=0)
    return report(whole, after, before)


def data_file() -> Path:
    """Where the observations ought to be."""
    return Path(os.environ.get(VARIABLE) or PLACE)


def absent(place: Path) -> Topic:
    """The rows of a report without the data: they say so, and no bar is held or missed."""
    note = f"not measured: the data is outside the repository; {VARIABLE} names its file, which is not there"
    return Topic(
        "A real Franka, held-out data", WORDS,
        [Figure("median position error, screws fitted", None, bar_shown=f"≤ {short(POSITION)} mm", note=note),
         Figure("rms rotation error, screws fitted", None, bar_shown=f"≤ {short(ROTATION)} mrad", note=note)],
    )  # fmt: skip


def kept_aside(
    arm: Chain, q: np.ndarray, measured: cal.Measurement, loss: LossName, seed: int
) -> tuple[Kept, Kept]:
    """Pooled over the folds: with the screws fitted, and before."""
    held = cal.calibrate(arm, q, measured, loss=loss, folds=FOLDS, seed=seed).cross_validation
    if held is None:
        raise RuntimeError(f"{len(q)} observations were too few to keep some aside")
    return _kept(held.after), _kept(held.before)


def _kept(found: cal.Residuals) -> Kept:
    lengths, angles = (found.median_length, found.rms_length), (found.median_angle, found.rms_angle)
    return Kept(*(1e3 * x for x in (*lengths, *angles)))


Results = dict[tuple[str, int], Kept]


def report(whole: cal.Calibration, after: Results, before: Results) -> Topic:
    """The topic of what was found, by loss and seed."""
    first, nominal = after[LOSS, 0], before[LOSS, 0]
    seeds = [seed for loss, seed in after if loss == LOSS]
    said = whole.identification
    return Topic(
        "A real Franka, held-out data",
        WORDS,
        figures=[
            Figure("median position error, board and camera fitted only", nominal.position, unit="mm",
                   note=f"rms {short(nominal.position_rms)} mm"),
            Figure("median position error, screws fitted", first.position, POSITION, "mm",
                   note=f"rms {short(first.position_rms)} mm; {_draws(after, 'position', POSITION, 'mm')}"),
            Figure("rms rotation error, board and camera fitted only", nominal.rotation_rms, unit="mrad",
                   note=f"median {short(nominal.rotation)} mrad"),
            Figure("rms rotation error, screws fitted", first.rotation_rms, ROTATION, "mrad",
                   note=f"median {short(first.rotation)} mrad; {_draws(after, 'rotation_rms', ROTATION, 'mrad')}"),
            Figure("both bars at once: draws of the folds of which not", _misses(after, LOSS), shown=
                   f"{_misses(after, LOSS)} of {len(seeds)}", note=f"{LOSS} loss; linear {_misses(after, 'linear')}"),
            Figure("identification from all: rank", said.rank, shown=f"{said.rank} of {said.identifiable}",
                   note=f"{said.size} parameters, condition {short(float(said.condition))}; residuals of the fit "
                        f"{whole.after}; {len(whole.outliers)} outliers named"),
        ],
        tables=[by_loss(after, before), by_seed(after)],
    )  # fmt: skip


def _misses(found: Results, loss: str) -> int:
    return sum(
        kept.position > POSITION or kept.rotation_rms > ROTATION
        for (name, _), kept in found.items()
        if name == loss
    )


def _draws(found: Results, what: str, bar: float, unit: str) -> str:
    values = [getattr(kept, what) for (loss, _), kept in found.items() if loss == LOSS]
    return (
        f"over {len(values)} draws of the folds {short(min(values))} … {short(max(values))} {unit}, "
        f"{sum(value <= bar for value in values)} within the bar"
    )


def by_loss(after: Results, before: Results) -> Table:
    """The draws of each loss."""
    rows = []
    for what, found in (("before", before), ("after", after)):
        for loss in LOSSES:
            mine = np.array([kept for (name, _), kept in found.items() if name == loss])
            median, worst = np.median(mine, axis=0), mine.max(axis=0)
            good = f"{len(mine) - _misses(found, loss)} of {len(mine)}"
            rows.append(
                (
                    what,
                    loss,
                    *(f"{short(m)} ({short(w)})" for m, w in zip(median, worst, strict=True)),
                    good,
                )
            )
    return Table(
        "By loss: median over the draws of the folds (and the worst); both bars hold",
        ("screws", "loss", "position, median (mm)", "position, rms (mm)", "rotation, median (mrad)",
         "rotation, rms (mrad)", "draws that hold"),
        rows,
    )  # fmt: skip


def by_seed(after: Results) -> Table:
    """Each draw of each loss."""
    return Table(
        "Screws fitted, each draw of the folds",
        ("loss", "draw", "position, median (mm)", "position, rms (mm)", "rotation, median (mrad)",
         "rotation, rms (mrad)"),
        [(loss, seed, *(short(x) for x in kept)) for (loss, seed), kept in after.items()],
        folded=True,
    )  # fmt: skip
