"""`calibrate`: an arm's true screws from joint readings and measurements."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from ...errors import InputError, safe_repr
from ...groups.arrays import Array
from ...model.chain import Chain
from ...model.provenance import warn
from .calibration import Calibration
from .diagnostics import cross_validation as aside
from .diagnostics import explanation, misfit, units
from .diagnostics.identification import checked, judged
from .fit import noise
from .fit.fitting import frames_only, outliers
from .fit.losses import LOSSES
from .fit.minimise import STEPS
from .fit.refit import settled
from .model.parameters import Arm
from .model.problem import Problem, readings, sets_of
from .model.residuals import Residuals, residuals
from .result import Outlier

_UNITS = ("rad", "m", "1", "m/rad")
_DEFICIENT = ("refuse", "hold")


def calibrate(
    arm: Chain,
    q: Any,
    measurements: Any,
    *,
    parameters: Sequence[str] = ("screws", "home"),
    joints: Sequence[str] | None = None,
    loss: str = "linear",
    prior: Mapping[str, float] | None = None,
    deficient: str = "refuse",
    folds: int = 5,
    seed: int = 0,
    max_iterations: int = STEPS,
    progress: Callable[[int, int], None] | None = None,
) -> Calibration:
    """The arm as measurements say it is: axes and home pose, how well they are known, and what is
    better for it.

        minimise  sum rho(e^T C^-1 e) + sum (p / prior)^2  over p,   A_i <- Ad(e^eta_i) A_i,  M <- M
        e^eta

    Parameters
    ----------
    arm: the nominal Chain. q (N, m): joint readings, rad or m, or a dict. measurements: one set of
    them, a list of sets (`Poses`, `Points`, `Distances`, `EyeInHand`, `EyeToHand`), or an array (N,
    4, 4) of poses or (N, 3) of positions of the tip. Frames that a set does not know, such as board
    and camera, are found along.
    parameters: "screws" (4 a revolute or helical joint, 2 a prismatic one), "home" (6), "offsets"
    and "gains" (one a coordinate: q <- (1 + g) q + o), "pitch" (one a revolute joint). joints:
    names of the joints that may change, all by default. A joint offset tells nothing that screws
    and home pose do not: it is for calibrating offsets alone.
    loss: "linear", or robust: "huber", "cauchy", "tukey" (see `losses`); a measurement counts as
    one.
    prior: standard deviations of the arm's parameters about the nominal model by unit, {"rad":
    1e-3, "m": 1e-3}. What it tells something of is not held.
    deficient: "refuse" measurements that do not see all the parameters that their kind could see,
    or "hold" those at nominal values. What no measurement of that kind sees is always held, and
    `identification.held` says what.
    folds: parts of the readings that are kept aside in turn, to be judged by a calibration from the
    others; 0 for none, as where the others were too few. seed: of the drawing of these parts.
    progress(done, folds).
    max_iterations: of each fit, all rounds in which spreads are estimated together.

    Returns: Calibration; `success` is False where the search did not converge: then it holds the
    best that was found.
    A PoekinWarning, and `warnings`, say where only another tool or another arm explains the
    measurements, such as poses between a camera and a board given as `Poses`, and where residuals
    are larger than a given covariance says.
    Raises: ShapeError, InputError, UnknownName: data that do not fit the arm, are not finite or not
    in SI units, or are explained by no arm near the nominal one; too few measurements, or so few
    without covariances that nothing says how far they scatter; parameters that are not seen.
    Accuracy: with exact data the pose of the calibrated arm is right to 1e-12 m; axes stay unit and
    pitches what they are to 1e-15 (tests/solve/calibration). Where the nominal arm is special, as
    with a measured
    point on its last axis, what the true arm shows in second order only is found too, as far as it
    is more than noise. Source: Park 1994, Section V, the POE as the smooth parametrisation for
    calibration; Okamura and Park 1996 for moving screws by conjugation; 4 r + 2 p + 6 parameters:
    Everett and Hsu 1988.
    """
    if not isinstance(arm, Chain):
        raise InputError(
            f"arm: expected a Chain, such as robot.chain(tip=...), got {type(arm).__name__}"
        )
    q = readings(arm, q)
    sets = sets_of(measurements, len(q))
    _one_of(loss, LOSSES, "loss")
    _one_of(deficient, _DEFICIENT, "deficient")
    if (
        not isinstance(max_iterations, (int, np.integer))
        or isinstance(max_iterations, bool)
        or max_iterations < 1
    ):
        raise InputError(
            f"max_iterations: expected a whole number from 1 on, got {safe_repr(max_iterations)}"
        )
    problem = units.built(Arm(arm, parameters, joints), q, sets)
    spread = _prior(prior, problem)
    identification, free = judged(problem)
    if spread is None:
        checked(identification, deficient)
    else:
        both, free = judged(problem, np.isfinite(spread))
        checked(both, deficient)
    noise.check(sets, problem.numbers, free.shape[1])
    folds = aside.checked(folds, len(q), seed)
    start, _ = frames_only(problem, loss)
    units.check(problem, start)
    before = _residuals(problem, start)
    fit = settled(problem, free, loss, start, spread, max_iterations)
    if fit.free is not free:
        identification, _ = judged(problem, p=fit.p)
    misfit.check(problem, fit)
    kept = None
    if folds and problem.numbers * (folds - 1) // folds > free.shape[1]:
        kept = aside.held_out(problem, free, loss, spread, folds, seed, max_iterations, progress)
    off = [
        Outlier(k, int(i), int(problem.rows[k][i]))
        for k, found in enumerate(outliers(problem, fit.noise, fit.p))
        for i in found
    ]  # fmt: skip
    after = _residuals(problem, fit.p)
    said = explanation.told(problem, before, after)
    doubts = misfit.contradicted(problem, fit)
    warnings = (*said.warnings, *(words for times, words in doubts if times > 1))
    for words in warnings:
        warn(words)
    return Calibration(
        nominal=arm,
        chain=problem.arm.chain(fit.p[: problem.arm_size]),
        parameters=problem.parameters,
        values=fit.p,
        covariance=fit.covariance,
        frames=dict(zip(problem.place_names, problem.placed(fit.p), strict=True)),
        identification=identification,
        success=fit.converged,
        steps=tuple(fit.steps),
        before=before,
        after=after,
        held_out=kept,
        outliers=tuple(off),
        spreads=fit.noise.spreads,
        loss=loss,
        arm=problem.arm,
        warnings=warnings,
        remarks=(*said.remarks, *(words for times, words in doubts if times < 1)),
    )


def _residuals(problem: Problem, p: Array) -> Residuals:
    return residuals(problem.sets, problem.rows, problem.errors(p))


def _one_of(value: object, known: Sequence[str], what: str) -> None:
    if value not in known:
        raise InputError(
            f"{what}: expected one of {', '.join(map(repr, known))}, got {safe_repr(value)}"
        )


def _prior(prior: Mapping[str, float] | None, problem: Problem) -> Array | None:
    """Standard deviations (P,), infinite for unknown frames and units that are not named."""
    if prior is None:
        return None
    if not isinstance(prior, Mapping) or not prior:
        raise InputError(
            f"prior: expected standard deviations by unit, such as {{'rad': 1e-3}}, got {safe_repr(prior)}"
        )
    for unit, sigma in prior.items():
        _one_of(unit, _UNITS, "prior")
        if (
            isinstance(sigma, bool)
            or not isinstance(sigma, (int, float, np.number))
            or not 0 < sigma < np.inf
        ):
            raise InputError(
                f"prior[{unit!r}]: expected a standard deviation above 0, got {safe_repr(sigma)}"
            )
    arms = [prior.get(p.unit, np.inf) for p in problem.arm.parameters]
    return np.array(arms + [np.inf] * (problem.size - len(arms)), float)
