"""`calibrate`: the true screws of an arm from joint readings and measurements."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any, Literal, get_args

import numpy as np

from ...checks import choice, whole
from ...errors import InputError
from ...model.kinematics.arm import Arm, chain_of
from ...model.provenance import warn
from ...results import Progress
from .calibration import Calibration
from .causes.most_likely import build_problem
from .diagnostics import cross_validation, explanation, misfit, verdict
from .diagnostics.cross_validation import CrossValidation
from .diagnostics.effects.diagnosis import FitEvidence
from .diagnostics.identification import OnRankDeficiency
from .fit.covariance import covariance_of
from .fit.fitting import Fit
from .fit.losses import LOSSES, OUTLIER, LossName, chi_square
from .fit.minimise import STEPS
from .fitted_problem import FittedProblem, fit_problem
from .measurements.inputs import parse_measurements, parse_readings
from .model.configurations import Folds, configurations
from .model.error_model import ErrorModel
from .model.parameters import ParameterKind, Unit
from .model.problem import Problem
from .result import Outlier
from .selection import choose_terms
from .selection.choose_terms import CANDIDATES
from .selection.term_gain import TermGain
from .terms import gravity
from .terms.conditions import parse_conditions
from .terms.named import TermName
from .terms.term import Term, name_of

Kind = ParameterKind | TermName | Literal["auto"]
GEOMETRY: tuple[Kind, ...] = ("screws", "home")


def calibrate(  # noqa: PLR0913 - options by keyword
    chain: Arm,
    q: Any,
    measurements: Any,
    *,
    parameters: Kind | Sequence[Kind | Term] = GEOMETRY,
    joints: Sequence[str] | None = None,
    conditions: Mapping[str, Any] | None = None,
    loss: LossName = "linear",
    prior: Mapping[Unit, float] | None = None,
    on_rank_deficiency: OnRankDeficiency = "raise",
    folds: int = 5,
    seed: int = 0,
    iterations: int = STEPS,
    progress: Progress | None = None,
) -> Calibration:
    """Calibration of an arm from measurements: its axes and home pose, and how well they are known.

    The sum of ρ(eᵀ C⁻¹ e) + (p / prior)² is minimised over the parameters p, with A_i <- Ad(e^[η_i])
    A_i and M <- M e^[η]. Frames that a set does not know, such as board and camera, are estimated
    jointly.

    Parameters
    ----------
    chain : Chain or CompiledChain
        The nominal arm.
    q : (N, m) array_like or dict
        Joint readings, rad or m.
    measurements : Measurement, sequence of Measurement, or array_like
        One set of them, several (`Poses`, `Points`, `Distances`, `EyeInHand`, `EyeToHand`), or an
        array (N, 4, 4) of poses or (N, 3) of positions of the tip in the base frame, m.
    parameters : "auto" or sequence of str or Term
        What may change: "screws" (4 a revolute or helical joint, 2 a prismatic one), "home" (6),
        "offsets" and "gains" (one a coordinate: q <- (1 + g) q + o), "pitch" (one a revolute
        joint). A joint offset tells nothing that screws and home pose do not: it is for calibrating
        offsets alone. Default ("screws", "home"). Non-geometric terms, q <- q + B(q, conditions) c:
        "compliance" (one a joint that carries, per N m of the gravity torque of `chain.masses`, or,
        where they are not known, per metre of lever of a weight at the wrist; and one per N m of
        the payload's torque), "coupling" (to the readings of the neighbours),
        "harmonics" and "second harmonics" (sine and cosine of q, of 2 q), "backlash" (its width),
        "lag" (per rad of the move before), "drift" (per K, s, or run), and any `Term`. "auto" takes
        "screws", "home" and those terms that make the error on held-out readings smaller: of the
        sets that adding the best one at a time leads to, the smallest within one standard error.
    joints : sequence of str, optional
        Names of the joints that may change, all by default.
    conditions : dict of str to array_like, optional
        Conditions of the rows of q: "payload" (N,), kg at the tip; "gravity" (3,) or (N, 3), its
        direction in the base frame, by default -z; "approach" (N, m), signs of the last moves, or
        "previous" (N, m), the readings before them, by default the row before; "temperature" (N,)
        or "time" (N,), K or s, which a drift follows, by default the row's number.
    loss : {"linear", "huber", "cauchy", "tukey"}, default "linear"
        Loss ρ; the last three are robust. A measurement counts as one.
    prior : dict of {"rad", "m", "1", "m/rad"} to float, optional
        Standard deviations of the arm's parameters about the nominal model by unit, such as
        {"rad": 1e-3, "m": 1e-3}. What it tells something of is not fixed.
    on_rank_deficiency : {"raise", "fix"}, default "raise"
        Raise an error where the measurements leave directions unobserved that others of their kind
        would identify, or fix these at nominal values. Unidentifiable directions, which no
        measurement of that kind sees, are always fixed, and `identification.unidentifiable` names
        them.
    folds : int, default 5
        Parts of the readings that are held out in turn, to be predicted by a calibration from the
        others; equal and nearly equal readings (to 1e-3 rad and m) stay together. 0 for none, as
        where the others were too few.
    seed : int, default 0
        Seed of the drawing of the folds.
    iterations : int, default 100
        Most steps of each fit, all rounds in which the noise is estimated together.
    progress : callable, optional
        Called as progress(done, folds).

    Returns
    -------
    found : Calibration
        `success` is False where the search did not converge: then it holds the best that was found.
        `verdict` has the reasons not to use it, none where it is sound.

    Raises
    ------
    ShapeError, InputError, UnknownName
        If the data do not fit the arm, are not finite or not in SI units, or are explained by no
        arm near the nominal one; if they are too few, or so few without covariances that nothing
        says how far they scatter; if parameters are unobserved.

    Warns
    -----
    PoekinWarning
        Where only another tool or another arm explains the measurements, such as poses between a
        camera and a board given as `Poses`, and where residuals are larger than a given covariance
        says; `warnings` holds the same.

    Notes
    -----
    Accuracy: with exact data the pose of the calibrated arm is right to 1e-12 m; axes stay unit and
    pitches what they are to 1e-15 (tests/solve/calibration). Where the nominal arm is special, as
    with a measured point on its last axis, what the true arm shows in second order only is found
    too, as far as it is more than noise. Where a configuration carries more than three numbers of
    unknown covariance, the covariance is the jackknife's by configuration (Bell and McCaffrey 2002,
    CR3); one that is given is believed. Source: Park 1994, Section V, the POE as the smooth
    parametrisation for calibration; Okamura and Park 1996 for moving screws by conjugation; 4 r +
    2 p + 6 parameters: Everett and Hsu 1988.

    Examples
    --------
    >>> import poekin as pk
    >>> arm = pk.load("ur5").chain()
    >>> made = pk.calibration.simulated(arm, 40, seed=2)
    >>> found = pk.calibrate(arm, made.q, made.measurements)
    >>> found.success, found.identification.rank
    (True, 30)
    >>> held_out = found.cross_validation
    >>> held_out.after.rms_length < 0.1 * held_out.before.rms_length
    True
    >>> pk.calibrate(arm, made.q, made.measurements, parameters="auto", folds=4).error_model.kinds
    ('screws', 'home')
    """
    chain = chain_of(chain)
    q = parse_readings(chain, q)
    sets = parse_measurements(measurements, len(q))
    choice(loss, LOSSES, "loss")
    choice(on_rank_deficiency, get_args(OnRankDeficiency), "on_rank_deficiency")
    whole(iterations, "iterations", 1)
    given, reference = parse_conditions(conditions, q)
    auto = isinstance(parameters, str) and parameters == "auto"
    kinds = GEOMETRY if auto else parameters
    folds = cross_validation.check_folds(folds, len(q), seed)
    to_hold_out = folds > 0
    if folds:
        folds = min(folds, int(configurations(q).max()) + 1)
    if auto and folds < 2:
        raise InputError(
            f"parameters: 'auto' judges by held-out readings, expected folds >= 2, got {folds}"
        )
    model = ErrorModel(chain, kinds, joints, reference)
    problem = build_problem(model, q, sets).under(given)
    solve = partial(
        fit_problem,
        loss=loss,
        prior=prior,
        iterations=iterations,
        on_rank_deficiency=on_rank_deficiency,
    )
    solved = solve(problem)
    terms: tuple[TermGain, ...] = ()
    if folds > 1 and (names := CANDIDATES if auto else model.judged):
        drawn = Folds(folds, seed)
        tried = choose_terms.candidates(problem, solved.fit, names, given, loss, drawn)
        chosen = choose_terms.choose(tried) if auto else [name_of(kind) for kind in names]
        terms = choose_terms.gains(tried, chosen)
        if auto and chosen:
            model = ErrorModel(chain, (*GEOMETRY, *chosen), joints, reference)
            problem = Problem(model, q, sets, problem.initial_frames).under(given)
            solved = solve(problem)
    fit = solved.fit
    held_out = None
    if folds > 1 and problem.n_equations * (folds - 1) // folds > solved.free.shape[1]:
        held_out = cross_validation.cross_validate(
            problem, solved.free, solved.options, folds, seed, progress
        )
    doubts = misfit.contradicted(problem, fit)
    found = _result(problem, solved, held_out, doubts)
    vectors = problem.residual_vectors(solved.points, fit.p, given.previous)
    evidence = FitEvidence(problem, fit, loss, given)
    outliers = found.outliers
    if outliers and evidence.search.findings:
        gross = evidence.search.gross()
        outliers = tuple(o for o in outliers if gross[o.set][o.index])
    found = replace(found, residuals=vectors, terms=terms, evidence=evidence, outliers=outliers)
    reasons = verdict.judge(found, problem, doubts, prior is not None, to_hold_out)
    found = replace(found, verdict=reasons)
    for words in found.warnings:
        warn(words)
    return found


def _result(
    problem: Problem,
    solved: FittedProblem,
    held_out: CrossValidation | None,
    doubts: Sequence[misfit.Contradiction],
) -> Calibration:
    """The calibration that a fit makes, with warnings and remarks."""
    fit = solved.fit
    options = solved.options
    after = problem.residuals(fit.p)
    remarks = explanation.explain(problem, solved.before, after)
    return Calibration(
        nominal=problem.model.nominal,
        chain=problem.model.chain(fit.p[: problem.model_size]),
        parameters=problem.parameters,
        values=fit.p,
        covariance=covariance_of(problem, fit, options),
        frames=problem.frame_values(fit.p),
        identification=solved.identification,
        success=fit.converged,
        steps=tuple(fit.steps),
        before=solved.before,
        after=after,
        cross_validation=held_out,
        outliers=_outliers(problem, fit),
        noise_std=fit.noise.noise_std,
        loss=options.loss,
        error_model=problem.model,
        warnings=(*remarks.warnings, *(doubt.words for doubt in doubts if doubt.ratio > 1)),
        remarks=(
            *remarks.remarks,
            *(doubt.words for doubt in doubts if doubt.ratio < 1),
            *_of_terms(problem),
        ),
    )


def _of_terms(problem: Problem) -> tuple[str, ...]:
    if not problem.model.terms:
        return ()
    said: tuple[str, ...] = ()
    if any(term.name == "compliance" for term in problem.model.terms):
        said = gravity.remarks(problem.model.nominal)
    return (
        "non-geometric terms were fitted: the calibrated chain takes true_joints(q), not the readings",
        *said,
    )


def _outliers(problem: Problem, fit: Fit) -> tuple[Outlier, ...]:
    """The measurements that are off by more than one good one in 10^4 would be."""
    found = []
    for k, squares in enumerate(fit.noise.squares(problem.errors(fit.p))):
        gross = squares > chi_square(problem.sets[k].width, OUTLIER)
        rows = problem.rows[k].tolist()
        found += [Outlier(k, i, rows[i]) for i in np.flatnonzero(gross).tolist()]
    return tuple(found)
