"""How long one calibration takes: exact jacobian in poekin against SciPy's least squares with finite
differences.
"""

from __future__ import annotations

import json
from typing import Any, NamedTuple

import numpy as np
from scipy.optimize import least_squares

from poekin import Chain, load
from poekin.solve import calibration as cal
from poekin.solve.calibration.diagnostics.identification import identify_directions
from poekin.solve.calibration.fit.covariance import covariance_of
from poekin.solve.calibration.fit.fitting import fit_parameters
from poekin.solve.calibration.fit.minimise import FitOptions
from poekin.solve.calibration.model.error_model import ErrorModel
from poekin.solve.calibration.model.problem import Problem

from .. import simulated
from ..fresh import run
from ..harness import Case, Timed, in_turn, ratio, spread
from ..report import Figure, Table, Topic, short
from ..workers import THREADS

OBSERVATIONS, FRESH, BAR = 114, 200, 0.1
REST = 0.06  # s: OpenBLAS's threads wait for work for 2^26 ticks, 0.03 s
METHODS = {"lm": "MINPACK's Levenberg–Marquardt", "trf": "trust region, by singular values"}

WORDS = (
    f"A Panda with all screws and the home pose off by {short(1e3 * simulated.OFF)} mm and mrad each (34 parameters), "
    f"{OBSERVATIONS} full poses that scatter by {short(1e3 * simulated.LENGTH)} mm and "
    f"{short(1e3 * simulated.ANGLE)} mrad, covariance given, start at the nominal arm, linear loss. SciPy's "
    "`least_squares` has the same parameters, start and whitened residuals, all poses at once by poekin's own "
    'vectorised functions, Jacobian by "2-point" differences, tolerances as they are by default. Both of its '
    "methods for it are measured, and the faster one counts. poekin's fit ends with the covariance; the whole of "
    "`calibrate(folds=0)`, with checks, identification, residuals and outliers, is shown beside it. Time is the "
    "processor's, over all threads: those of the library for linear algebra as it starts them by itself, and, below, "
    "in a process where it may start none; "
    "cases run in turn, with a rest before each, as threads go on waiting for work after the case that started them. "
    f"Error: the calibrated arm's position, rms over {FRESH} fresh poses of the true arm; the noise decides it."
)


class Task(NamedTuple):
    """What is to be fitted: readings and measurements of an arm, and fresh readings of the true arm
    to judge by.
    """

    nominal: Chain
    true: Chain
    q: np.ndarray
    poses: cal.Poses
    fresh: np.ndarray


def topic(quick: bool, say) -> Topic:  # type: ignore[no-untyped-def]
    task = simulated_task()
    found = calibrated(task)
    apart = [
        np.abs(minimised(method)(residuals(task)).x - found.values).max() for method in METHODS
    ]
    as_usual = measured(quick)
    say(", ".join(f"{t.name}: {short(1e3 * t.time.median)} ms" for t in as_usual))
    alone = in_one_thread(quick)
    say(
        "linear algebra in one thread: "
        + ", ".join(f"{short(1e3 * t.time.median)} ms" for t in alone)
    )
    return Topic(
        "Time of one calibration",
        WORDS,
        figures=[
            figure(f"{OBSERVATIONS} observations, 7 joints, one fit ÷ the same by SciPy", as_usual[1], as_usual, BAR),
            figure("the whole of `calibrate` ÷ SciPy's fit", as_usual[0], as_usual, BAR),
            figure("linear algebra in one thread: one fit ÷ the same by SciPy", alone[1], alone, BAR),
            figure("linear algebra in one thread: the whole of `calibrate` ÷ SciPy's fit", alone[0], alone),
            Figure("largest difference between poekin's parameters and SciPy's", float(max(apart)), 1e-8, "rad, m",
                   note=f"{len(found.steps)} steps; SciPy's Jacobians by {len(found.values)} differences each"),
        ],
        tables=[
            Table("Time of each", ("linear algebra", "what", "time (ms)", "lower quartile", "upper quartile",
                                   "rms error (mm)"),
                  [_row(threads, t) for threads, every in (("as it comes", as_usual), ("one thread", alone))
                   for t in every]),
        ],
    )  # fmt: skip


def measured(quick: bool) -> list[Timed]:
    """A calibration, its fit alone, and SciPy's methods, in turn."""
    task = simulated_task()
    own = Case("pk.calibrate(folds=0)", lambda: task, calibrated, lambda t, c: off(t, c.values))
    bare = Case(
        "its fit and covariance alone",
        lambda: prepared(task),
        fit_alone,
        lambda s, fit: off(task, fit.p),
    )
    peers = [
        Case(
            f"SciPy, {method!r}: {words}",
            lambda: residuals(task),
            minimised(method),
            lambda s, x: off(task, x.x),
        )
        for method, words in METHODS.items()
    ]
    return in_turn([own, bare, *peers], rounds=5 if quick else 11, rest_s=REST)


def in_one_thread(quick: bool) -> list[Timed]:
    """The same in a process whose libraries of linear algebra start no threads."""
    script = f"from {__name__} import measured; import json; print(json.dumps([(t.name, t.each, t.error) for t in "
    outcome = run(f"{script}measured({quick})]))", dict.fromkeys(THREADS, "1"))
    if outcome.code:
        raise RuntimeError(outcome.err)
    return [
        Timed(name, spread(each), tuple(each), error)
        for name, each, error in json.loads(outcome.out)
    ]


def simulated_task(seed: int = 0) -> Task:
    """The Panda, seeded."""
    nominal, rng = load("panda").chain(tip="panda_link8"), np.random.default_rng(seed)
    true, _ = simulated.displaced(nominal, rng)
    q = nominal.random(rng, OBSERVATIONS)
    T = simulated.noisy(true.fk(q), simulated.white(rng, OBSERVATIONS))
    poses = cal.Poses(T, covariance=np.diag(simulated.SPREADS**2))
    return Task(nominal, true, q, poses, nominal.random(rng, FRESH))


def calibrated(task: Task) -> cal.Calibration:
    """By poekin, whole."""
    return cal.calibrate(task.nominal, task.q, task.poses, folds=0)


def problem_of(task: Task) -> Problem:
    """The same errors and parameters as `calibrate` has."""
    return Problem(ErrorModel(task.nominal, simulated.KINDS, None), task.q, [task.poses])


def prepared(task: Task) -> tuple[Problem, np.ndarray]:
    """The problem and its free directions."""
    problem = problem_of(task)
    return problem, identify_directions(problem)[1]


def fit_alone(state: tuple[Problem, np.ndarray]):  # type: ignore[no-untyped-def]
    """The fit from the nominal arm on, with its covariance."""
    problem, free = state
    options = FitOptions("linear")
    fit = fit_parameters(problem, free, np.zeros(problem.size), options)
    covariance_of(problem, fit, options)
    return fit


def residuals(task: Task):  # type: ignore[no-untyped-def]
    """What SciPy minimises: whitened residuals of p, and the start."""
    problem = problem_of(task)

    def function(p: np.ndarray) -> np.ndarray:
        return (problem.errors(p)[0] / simulated.SPREADS).ravel()

    return function, np.zeros(problem.size)


def minimised(method: str):  # type: ignore[no-untyped-def]
    """SciPy's least squares by this method, of `residuals`."""

    def run(state: tuple[Any, np.ndarray]):  # type: ignore[no-untyped-def]
        function, start = state
        return least_squares(function, start, jac="2-point", method=method, x_scale=1.0)

    return run


def off(task: Task, p: np.ndarray) -> float:
    """The rms error of position (mm) on the fresh poses, of the arm with these parameters."""
    arm = ErrorModel(task.nominal, simulated.KINDS, None).chain(p)
    return 1e3 * simulated.errors(arm, task.true, task.fresh)[0]


def figure(what: str, own: Timed, every: list[Timed], bar: float | None = None) -> Figure:
    """poekin's time ÷ that of the faster of SciPy's methods, which come last."""
    other = min(every[-len(METHODS) :], key=lambda t: t.time.median)
    found = ratio(own, other)
    return Figure(
        what, found.median, bar, spread=(found.lower, found.upper),
        error=f"{short(own.error)} mm (SciPy {short(other.error)} mm)", bar_shown="≤ 1/10" if bar else "",
        note=f"{short(1e3 * own.time.median)} ms ÷ {short(1e3 * other.time.median)} ms; {other.name}",
    )  # fmt: skip


def _row(threads: str, t: Timed) -> tuple[str | float, ...]:
    return (
        threads,
        t.name,
        *(1e3 * x for x in (t.time.median, t.time.lower, t.time.upper)),
        short(t.error),
    )
