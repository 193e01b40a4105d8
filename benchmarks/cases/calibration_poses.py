"""choose_poses: 30 of 2000 configurations against random ones, by each criterion, for arms of the
catalogue; and the true error of simulated calibrations.
"""

from __future__ import annotations

import time
from typing import Any

import numpy as np

from poekin import load, so3
from poekin.model.chain import Chain
from poekin.solve.calibration import Points, Poses, calibrate, simulated
from poekin.solve.calibration.design.choice import DesignMetrics
from poekin.solve.calibration.design.choose import Choice, choose_poses
from poekin.solve.calibration.design.exchange import CRITERIA

from ..report import Figure, Table, Topic, short

CHOSEN, CANDIDATES, BAR = 30, 2000, 1.5
NOISE = 1e-4  # rad, and reaches
ARMS = (
    ("puma560", None),
    ("panda", "panda_hand"),
    ("ur5e", None),
    ("iiwa14", None),
    ("jaco", None),
    ("stanford", None),
)
EVERY = ("puma560", "panda")
"""Arms for which configurations are chosen by every criterion."""
TOOL = (
    0.05,
    0.0,
    0.1,
)  # m, in the tip frame: off the last axis, so that all of the arm can be seen
KINDS = {"full poses": "poses", "one point of the tool": Points([[0, 0, 0]], points=TOOL)}
ALWAYS = ("prediction", "amplification")
FEW, TRIALS, TRUE_BAR = 12, 24, 0.9
SETTINGS = tuple(
    (name, tip or "", kind)
    for name, tip in (("puma560", None), ("panda", "panda_hand"), ("ur5e", None), ("iiwa14", None))
    for kind in ("poses", "points")
)
"""Arms, tips and kinds of measurements of the trials against random choices."""
MANY, MANY_BAR = 10_000, 2.0

TEXT = (
    f"poekin chooses {CHOSEN} of {CANDIDATES} configurations, drawn within the limits, for calibrating all screws and "
    "the home pose, from full poses and from the positions of one point, by the predicted error, "
    "the noise amplification index and, for "
    f"{' and '.join(EVERY)}, by every other criterion too. Each is compared with the median "
    f"of 100 random choices of {CHOSEN} of the same candidates: how many times better, for the condition and for the "
    "errors how many times smaller. Angles in rad, lengths in reaches.\n\n"
    "The noise amplification index (Nahvi and Hollerbach 1996) judges by the combination of parameters that is seen "
    "worst, against the one that is seen best: configurations that show all the others less better it too, and the "
    "poses may hardly depend on the worst. The prediction is how much smaller the error is that noise leaves in the "
    "calibrated arm, over all candidates; below 1 it is larger than after a random choice. Where the accuracy of the "
    "arm is what matters, choose by the prediction or by O1."
)


def topic(quick: bool, say) -> Topic:  # type: ignore[no-untyped-def]
    figures: list[Figure] = []
    rows: list[tuple[Any, ...]] = []
    slowest = 0.0
    for name, tip in ARMS:
        arm = load(name).chain(tip=tip)
        for kind, example in KINDS.items():
            for criterion in CRITERIA if name in EVERY and not quick else ALWAYS:
                start = time.process_time()
                choice = choose_poses(
                    arm, CHOSEN, CANDIDATES, measurements=example, criterion=criterion
                )
                slowest = max(slowest, seconds := time.process_time() - start)
                rows.append(
                    (
                        name,
                        kind,
                        choice.rank,
                        criterion,
                        *(f"{gain:.2f}" for gain in choice.improvement),
                        short(seconds),
                    )
                )
                if criterion == "amplification":
                    figures.append(_figure(f"{name}, {kind}", choice))
        say(f"{name}: × {figures[-2].shown} and × {figures[-1].shown}")
    figures.append(Figure("a choice and the 100 random ones it is compared with, the slowest", slowest, unit="s",
                          note="processor time, beside other topics"))  # fmt: skip
    figures += _true_figures(quick, say)
    table = _simulated(*ARMS[0], repeats=5 if quick else 40, say=say)
    return Topic(
        "The configurations that see most",
        TEXT,
        figures=figures,
        tables=[
            Table("By how much a choice is better than the median random choice",
                  ("arm", "measured", "parameters", "chosen by", *(f"{name} ×" for name in DesignMetrics._fields),
                   "time (s)"), rows),
            Table(f"{ARMS[0][0]}, calibrated from {CHOSEN} full poses with noise of {NOISE:g} rad and {NOISE:g} "
                  "reaches: error over 500 fresh configurations, rms of all calibrations",
                  ("configurations", "position (mm)", "rotation (mrad)", "foretold ÷ random", "found ÷ random"),
                  table),
        ],
    )  # fmt: skip


def true_errors(name: str, tip: str, kind: str, n: int, repeats: int) -> np.ndarray:
    """Rms errors (2, repeats), m, of the tool over fresh configurations: of arms that are calibrated
    at the n configurations that were chosen, and at random ones.
    """
    arm = load(name).chain(tip=tip or None)
    point = TOOL if kind == "points" else (0.0, 0.0, 0.0)
    example: Any = Points([[0, 0, 0]], points=TOOL) if kind == "points" else kind
    candidates, fresh = arm.random(5, 1000), arm.random(77, 300)
    chosen = choose_poses(arm, n, candidates, measurements=example, n_random=1).q
    errors = np.empty((2, repeats))
    for seed in range(repeats):
        some = np.random.default_rng((9, seed)).choice(len(candidates), n, replace=False)
        for k, q in enumerate((chosen, candidates[some])):
            made = simulated(arm, n, kind=kind, q=q, points=point, seed=seed)  # type: ignore[arg-type]
            found = calibrate(arm, q, made.measurements, folds=0).chain
            off = (found.fk(fresh) - made.truth.fk(fresh)) @ np.append(point, 1.0)
            errors[k, seed] = np.sqrt(np.mean(np.sum(off[:, :3] ** 2, axis=1)))
    return errors


def _true_figures(quick: bool, say) -> list[Figure]:  # type: ignore[no-untyped-def]
    figures = []
    for setting in SETTINGS[:2] if quick else SETTINGS:
        chosen, at_random = true_errors(*setting, n=FEW, repeats=TRIALS)
        ratio = float(chosen.mean() / at_random.mean())
        arm, _, kind = setting
        figures.append(
            Figure(
                f"{arm}, {kind}: true error after {FEW} chosen of 1000 configurations ÷ after random ones",
                ratio,
                shown=f"{ratio:.2f}",
                bar_shown=f"≤ {TRUE_BAR}",
                holds=ratio <= TRUE_BAR,
                note=f"mean of {TRIALS} simulated calibrations, errors of 2 mrad and 1 mm, noise of 0.1 mrad and mm",
            )
        )
    say(f"true error: {', '.join(figure.shown for figure in figures)} of that after random choices")
    arm = load("panda").chain(tip="panda_hand")
    start = time.process_time()
    choose_poses(arm, CHOSEN, MANY)
    seconds = time.process_time() - start
    figures.append(
        Figure(f"{CHOSEN} of {MANY} configurations of the panda, full poses", seconds, MANY_BAR, unit="s",
               note="processor time, beside other topics")
    )  # fmt: skip
    return figures


def _figure(what: str, choice: Choice) -> Figure:
    gain = choice.criterion_improvement
    best = choice.random_best.amplification / choice.random_median.amplification
    left = 1 / choice.improvement.prediction
    return Figure(
        f"{what}: noise amplification index, times better than the median of {choice.n_random} random choices",
        1 / gain, shown=f"{gain:.2f}", bar_shown=f"≥ {BAR}", holds=gain >= BAR,
        note=f"the best random choice: {best:.2f}; the error that noise leaves over all candidates: {left:.2f} times "
        "that of a random choice",
    )  # fmt: skip


def _simulated(name: str, tip: str | None, repeats: int, say) -> list[tuple[Any, ...]]:  # type: ignore[no-untyped-def]
    """Errors of calibrated arms that noise alone makes wrong, after random and chosen
    configurations.
    """
    arm = load(name).chain(tip=tip)
    candidates, fresh, rng = arm.random(0, CANDIDATES), arm.random(1, 500), np.random.default_rng(2)
    chosen = {
        f"chosen by {by}": choose_poses(arm, CHOSEN, candidates, criterion=by)
        for by in ("amplification", "O1", "prediction")
    }
    found = {}
    for what in ("random, new each time", *chosen):
        squares = []
        for _ in range(repeats):
            at_random = candidates[rng.choice(CANDIDATES, CHOSEN, replace=False)]
            squares.append(_off(arm, chosen[what].q if what in chosen else at_random, fresh, rng))
        found[what] = np.sqrt(np.mean(squares, axis=0))
        say(f"{what}: {short(1e3 * found[what][0])} mm on fresh configurations")
    whole = {what: float(np.hypot(p / arm.reach, r)) for what, (p, r) in found.items()}
    return [
        (what, short(1e3 * p), short(1e3 * r),
         short(1 / chosen[what].improvement.prediction) if what in chosen else "1",
         short(whole[what] / whole["random, new each time"]))
        for what, (p, r) in found.items()
    ]  # fmt: skip


def _off(arm: Chain, q: np.ndarray, fresh: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Mean squares of the position's (m^2) and the rotation's errors (rad^2) of an arm calibrated
    from noisy poses.
    """
    T = arm.fk(q)
    T[:, :3, :3] = so3.exp(NOISE * rng.normal(size=(len(q), 3))) @ T[:, :3, :3]
    T[:, :3, 3] += NOISE * arm.reach * rng.normal(size=(len(q), 3))
    covariance = np.diag(np.repeat([NOISE, NOISE * arm.reach], 3) ** 2)
    found, true = (
        calibrate(arm, q, Poses(T, covariance=covariance), folds=0).chain.fk(fresh),
        arm.fk(fresh),
    )
    turns = so3.log(found[:, :3, :3] @ np.swapaxes(true[:, :3, :3], 1, 2))
    shifts = found[:, :3, 3] - true[:, :3, 3]
    return np.array([np.mean(np.sum(shifts**2, axis=1)), np.mean(np.sum(turns**2, axis=1))])
