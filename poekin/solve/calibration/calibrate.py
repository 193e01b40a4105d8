"""`calibrate`: the true screws of an arm from joint readings and measurements."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from ...errors import InputError, safe_repr
from ...groups.arrays import Array
from ...model.chain import Chain
from ...model.provenance import warn
from ..option_checks import one_of, whole
from .calibration import Calibration
from .diagnostics import cross_validation, explanation, misfit, units
from .diagnostics.cross_validation import CrossValidation
from .diagnostics.identification import Identification, check_rank, identify_directions
from .fit import noise
from .fit.fitting import Fit, fit_frames, outliers
from .fit.losses import LOSSES
from .fit.minimise import STEPS
from .fit.refit import fit_with_refit
from .measurements.inputs import parse_measurements, parse_readings
from .model.error_model import ErrorModel
from .model.problem import Problem
from .model.residuals import Residuals, residuals
from .result import Outlier

_UNITS = ("rad", "m", "1", "m/rad")
_ON_RANK_DEFICIENCY = ("raise", "fix")


def calibrate(
    chain: Chain,
    q: Any,
    measurements: Any,
    *,
    parameters: Sequence[str] = ("screws", "home"),
    joints: Sequence[str] | None = None,
    loss: str = "linear",
    prior: Mapping[str, float] | None = None,
    on_rank_deficiency: str = "raise",
    folds: int = 5,
    seed: int = 0,
    max_iterations: int = STEPS,
    progress: Callable[[int, int], None] | None = None,
) -> Calibration:
    """Calibration of an arm from measurements: axes and home pose, how well they are known, and
    what is better for it.

        minimise  sum rho(e^T C^-1 e) + sum (p / prior)^2  over p
        A_i <- Ad(e^eta_i) A_i,  M <- M e^eta

    Parameters
    ----------
    chain: the nominal arm. q (N, m): joint readings, rad or m, or a dict. measurements: one set of
    them, a list of sets (`Poses`, `Points`, `Distances`, `EyeInHand`, `EyeToHand`), or an array (N,
    4, 4) of poses or (N, 3) of positions of the tip. Frames that a set does not know, such as board
    and camera, are estimated jointly.
    parameters: "screws" (4 a revolute or helical joint, 2 a prismatic one), "home" (6), "offsets"
    and "gains" (one a coordinate: q <- (1 + g) q + o), "pitch" (one a revolute joint). joints:
    names of the joints that may change, all by default. A joint offset tells nothing that screws
    and home pose do not: it is for calibrating offsets alone.
    loss: "linear", or robust: "huber", "cauchy", "tukey" (see `losses`); a measurement counts as
    one.
    prior: standard deviations of the arm's parameters about the nominal model by unit, {"rad":
    1e-3, "m": 1e-3}. What it tells something of is not fixed.
    on_rank_deficiency: "raise" an error where the measurements leave directions unobserved that
    others of their kind would identify, or "fix" these at nominal values. Unidentifiable
    directions, which no measurement of that kind sees, are always fixed, and
    `identification.unidentifiable` names them.
    folds: parts of the readings that are held out in turn, to be predicted by a calibration from
    the others; 0 for none, as where the others were too few. seed: of the drawing of the folds.
    progress(done, folds).
    max_iterations: of each fit, all rounds in which the noise is estimated together.

    Returns: Calibration; `success` is False where the search did not converge: then it holds the
    best that was found.
    A PoekinWarning, and `warnings`, say where only another tool or another arm explains the
    measurements, such as poses between a camera and a board given as `Poses`, and where residuals
    are larger than a given covariance says.
    Raises: ShapeError, InputError, UnknownName: data that do not fit the arm, are not finite or not
    in SI units, or are explained by no arm near the nominal one; too few measurements, or so few
    without covariances that nothing says how far they scatter; parameters that are unobserved.
    Accuracy: with exact data the pose of the calibrated arm is right to 1e-12 m; axes stay unit and
    pitches what they are to 1e-15 (tests/solve/calibration). Where the nominal arm is special, as
    with a measured point on its last axis, what the true arm shows in second order only is found
    too, as far as it is more than noise. Source: Park 1994, Section V, the POE as the smooth parametrisation for
    calibration; Okamura and Park 1996 for moving screws by conjugation; 4 r + 2 p + 6 parameters:
    Everett and Hsu 1988.
    """
    if not isinstance(chain, Chain):
        raise InputError(
            f"chain: expected a Chain, such as robot.chain(tip=...), got {type(chain).__name__}"
        )
    q = parse_readings(chain, q)
    sets = parse_measurements(measurements, len(q))
    one_of(loss, LOSSES, "loss")
    one_of(on_rank_deficiency, _ON_RANK_DEFICIENCY, "on_rank_deficiency")
    whole(max_iterations, "max_iterations", 1)
    problem = units.build_problem(ErrorModel(chain, parameters, joints), q, sets)
    sigma = _prior(prior, problem)
    identification, free = identify_directions(problem)
    if sigma is None:
        check_rank(identification, on_rank_deficiency)
    else:
        with_prior, free = identify_directions(problem, np.isfinite(sigma))
        check_rank(with_prior, on_rank_deficiency)
    noise.check(sets, problem.n_equations, free.shape[1])
    folds = cross_validation.check_folds(folds, len(q), seed)
    start, _ = fit_frames(problem, loss)
    units.check(problem, start)
    before = _residuals(problem, start)  # now, while the problem has these errors
    fit = fit_with_refit(problem, free, loss, start, sigma, max_iterations)
    if fit.free is not free:
        identification, _ = identify_directions(problem, p=fit.p)
    misfit.check(problem, fit)
    held_out = None
    if folds and problem.n_equations * (folds - 1) // folds > free.shape[1]:
        held_out = cross_validation.cross_validate(
            problem, free, loss, sigma, folds, seed, max_iterations, progress
        )
    found = _result(problem, before, fit, identification, held_out, loss)
    for words in found.warnings:
        warn(words)
    return found


def _result(
    problem: Problem,
    before: Residuals,
    fit: Fit,
    identification: Identification,
    held_out: CrossValidation | None,
    loss: str,
) -> Calibration:
    """The calibration that a fit makes, with warnings and remarks."""
    after = _residuals(problem, fit.p)
    remarks = explanation.explain(problem, before, after)
    doubts = misfit.contradicted(problem, fit)
    frames = zip(problem.frame_names, problem.frame_values(fit.p), strict=True)
    return Calibration(
        nominal=problem.model.nominal,
        chain=problem.model.chain(fit.p[: problem.model_size]),
        parameters=problem.parameters,
        values=fit.p,
        covariance=fit.covariance,
        frames=dict(frames),
        identification=identification,
        success=fit.converged,
        steps=tuple(fit.steps),
        before=before,
        after=after,
        cross_validation=held_out,
        outliers=_outliers(problem, fit),
        noise_std=fit.noise.noise_std,
        loss=loss,
        error_model=problem.model,
        warnings=(*remarks.warnings, *(doubt.words for doubt in doubts if doubt.ratio > 1)),
        remarks=(*remarks.remarks, *(doubt.words for doubt in doubts if doubt.ratio < 1)),
    )


def _outliers(problem: Problem, fit: Fit) -> tuple[Outlier, ...]:
    found = []
    for k, indices in enumerate(outliers(problem, fit.noise, fit.p)):
        found += [Outlier(k, int(i), int(problem.rows[k][i])) for i in indices]
    return tuple(found)


def _residuals(problem: Problem, p: Array) -> Residuals:
    return residuals(problem.sets, problem.rows, problem.errors(p))


def _prior(prior: Mapping[str, float] | None, problem: Problem) -> Array | None:
    """Standard deviations (P,), infinite for unknown frames and units that are not named."""
    if prior is None:
        return None
    if not isinstance(prior, Mapping) or not prior:
        raise InputError(
            "prior: expected standard deviations by unit, such as {'rad': 1e-3}, got "
            f"{safe_repr(prior)}"
        )
    for unit, sigma in prior.items():
        one_of(unit, _UNITS, "prior")
        number = isinstance(sigma, (int, float, np.number)) and not isinstance(sigma, bool)
        if not number or not 0 < sigma < np.inf:
            raise InputError(
                f"prior[{unit!r}]: expected a standard deviation above 0, got {safe_repr(sigma)}"
            )
    sigmas = np.full(problem.size, np.inf)
    sigmas[: problem.model_size] = [prior.get(p.unit, np.inf) for p in problem.model.parameters]
    return sigmas
