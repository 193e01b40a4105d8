"""choose_poses: the configurations to measure at, so that a calibration sees most."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal

import numpy as np

from ....checks import choice, whole
from ....errors import InputError, safe_repr
from ....groups.arrays import Array
from ....model.kinematics.arm import Arm, chain_of
from ....results import Progress
from ..diagnostics.identification import (
    identification_matrix,
    identify_directions,
    row_space,
    scaled_jacobians,
)
from ..measurements.measurement import Measurement, per_error
from ..measurements.points import Points
from ..measurements.poses import Poses
from ..model.error_model import ErrorModel
from ..model.parameters import ParameterKind
from ..model.problem import Problem
from .candidates import (
    Predicate,
    parse_candidates,
    parse_measured,
    parse_workspace,
)
from .choice import SMALLER_IS_BETTER, Choice, DesignMetrics
from .exchange import CRITERIA, Criterion, exchange
from .metrics import Design, check_enough, design_metrics, root_information


def choose_poses(  # noqa: PLR0913 - options by keyword
    chain: Arm,
    n: int,
    candidates: Any,
    *,
    measurements: Measurement | Sequence[Measurement] | Literal["poses", "points"] = "poses",
    parameters: ParameterKind | Sequence[ParameterKind] = ("screws", "home"),
    joints: Sequence[str] | None = None,
    criterion: Criterion = "prediction",
    measured: Any = None,
    allowed: Predicate | Sequence[Predicate] | None = None,
    workspace: Any = None,
    n_random: int = 100,
    seed: int = 0,
    progress: Progress | None = None,
) -> Choice:
    """Choice of the n candidates at which measuring tells most about the parameters of the arm.

    A greedy start, bettered by exchanging one configuration at a time, for those that promise most,
    until no exchange helps: a local best. The same arguments give the same choice.

    Parameters
    ----------
    chain : Chain or CompiledChain
        The nominal arm.
    n : int
        Number of configurations.
    candidates : (K, m) array_like or int
        Configurations, rad or m, within the limits, or how many of them to draw within the limits.
    measurements : {"poses", "points"} or Measurement or sequence of Measurement, default "poses"
        What will be measured at each: poses or points of the tip, or examples such as `Points` or
        `EyeInHand`, of which points, centre, board, camera and the first covariance count, measured
        numbers do not. A board or camera has to be given roughly; a device in an unknown frame is
        taken to stand at the base, an unknown probe to be at the tip.
    parameters, joints : sequence of str, optional
        As of `calibrate`.
    criterion : {"prediction", "O1", "amplification", "condition", "smallest"}
        "prediction", the default: the least expected squared error of what the calibrated arm
        predicts over the workspace. Else an observability index: they look at parameters, and but for
        "O1" at the worst seen combination of them, which poses may hardly depend on: the noise
        amplification index may well do worse than random choices.
    measured : (M, m) array_like, optional
        Configurations at which the same was measured before: the n that help most beside them.
    allowed : callable or sequence of callable, optional
        Where measuring is possible: functions of q (K, m) and T_base_tip (K, 4, 4) that return K
        booleans, such as `WorkspaceBox`, `ViewCone`, or a check for collisions. All have to agree.
    workspace : (W, m) array_like, callable or sequence of callable, optional
        Configurations over which "prediction" is meant, or predicates of those that are drawn; the
        candidates by default.
    n_random : int, default 100
        Number of random choices to compare with.
    seed : int, default 0
        Seed of what is drawn.
    progress : callable, optional
        Called as progress(done, total) after each step.

    Returns
    -------
    choice : Choice
        The configurations, and by how much they beat random choices.

    Raises
    ------
    InputError
        If a candidate is outside the limits (its row), n too small for the parameters (how many are
        needed), n above what is allowed of K, or an option out of its range.
    ShapeError
        If configurations are none, or a predicate returns no booleans.
    UnknownName
        If a joint is not there.

    Notes
    -----
    Accuracy: as `observability_indices` on the space that the candidates show; where not all
    measurements have a covariance, angles in rad, lengths in reaches, noise alike in all. Source:
    indices: `observability_indices`; search:
    Fedorov 1972 ("Theory of optimal experiments"), Mitchell 1974 (DETMAX); prediction:
    V-optimality, Fedorov 1972, as the test poses of Wu, Klimchik, Pashkevich, Caro and Furet 2013
    ("Efficiency improvement of measurement pose selection techniques in robot calibration").

    Examples
    --------
    >>> import poekin as pk
    >>> arm = pk.load("ur5").chain()
    >>> choice = pk.choose_poses(arm, 15, 60, n_random=20)
    >>> choice.q.shape, choice.rank
    ((15, 6), 30)
    >>> choice.criterion_improvement > 1
    True
    >>> more = pk.choose_poses(arm, 3, 60, measured=choice.q, n_random=20)
    >>> more.metrics.prediction < choice.metrics.prediction
    True
    """
    chain = chain_of(chain)
    whole(n, "n", 1)
    n_random = whole(n_random, "n_random", 1)
    whole(seed, "seed", 0)
    choice(criterion, CRITERIA, "criterion")
    every, rows = parse_candidates(chain, candidates, seed, allowed)
    q = every[rows]
    if n > len(q):
        those = f"{len(q)} candidates"
        if len(rows) < len(every):
            those = f"{len(q)} of {len(every)} candidates that are allowed"
        raise InputError(f"n: expected at most the {those}, got {n}")
    before = parse_measured(chain, measured)
    sets = _examples(measurements)
    model = ErrorModel(chain, parameters, joints)
    both = np.concatenate([q, before])
    problem = Problem(model, both, sets, _rough_frames(sets))
    identification = identify_directions(problem)[0]
    if not identification.rank:
        raise InputError(
            f"choose_poses: such measurements identify none of the {problem.size} parameters anywhere"
        )
    # of each configuration (K, r, L), on the space that all of them together show
    seen = row_space(identification_matrix(problem)).basis
    blocks, given = np.split(_information(problem, both) @ seen, [len(q)])
    where = blocks
    if workspace is not None:
        where = _information(problem, parse_workspace(chain, workspace, seed)) @ seen
    design = Design(blocks, given, root_information(where))
    check_enough(design, n)
    chosen = exchange(
        blocks,
        n,
        criterion,
        progress,
        mean=design.root.T @ design.root,
        given=design.given_rows,
    )
    rng = np.random.default_rng((seed, 1))
    drawn = [rng.choice(len(q), n, replace=False) for _ in range(n_random)]
    others = np.array([design_metrics(design, some) for some in drawn])
    smaller = np.isin(DesignMetrics._fields, SMALLER_IS_BETTER)
    best = np.where(smaller, others.min(axis=0), others.max(axis=0))
    return Choice(
        q=q[chosen],
        rows=rows[chosen],
        criterion=criterion,
        metrics=design_metrics(design, chosen),
        random_median=DesignMetrics(*np.median(others, axis=0).tolist()),
        random_best=DesignMetrics(*best.tolist()),
        rank=identification.rank,
        identifiable=identification.identifiable,
        unobserved=identification.unobserved,
        candidates=len(q),
        n_random=n_random,
        measured=len(before),
    )


def _examples(measurements: Any) -> list[Measurement]:
    """Examples of what is measured at each configuration."""
    tip = {
        "poses": Poses(np.eye(4)[None]),
        "points": Points(np.zeros((1, 3))),
    }
    sets: Any = measurements if isinstance(measurements, (list, tuple)) else [measurements]
    if isinstance(measurements, str):
        sets = [tip.get(measurements)]
    if not sets or not all(isinstance(s, Measurement) and s.sees_arm for s in sets):
        raise InputError(
            "measurements: expected 'poses', 'points', or an example of Poses, Points, Distances, "
            f"EyeInHand or EyeToHand, or a list of them, got {safe_repr(measurements)}"
        )
    for s in sets:
        if not len(s):
            raise InputError(
                f"measurements: {s.what}: expected one or more as an example, got none"
            )
    return [s.with_rows(None) for s in sets]


def _rough_frames(sets: list[Measurement]) -> list[Array]:
    """Unknown frames as guessed in the examples; a device stands at the base, a probe at the tip."""
    frames = []
    for s in sets:
        for unknown in s.unknown_frames:
            # no argument says where a device or a probe is
            if unknown.guess is None and unknown.name not in Poses.frames:
                name = unknown.name.rpartition("_")[2]
                if isinstance(s, Points):
                    name = "points"
                raise InputError(
                    f"measurements: {s.what}: expected {name}=, roughly where it is: nothing is "
                    "measured yet"
                )
            frames.append(np.eye(4) if unknown.guess is None else unknown.guess)
    return frames


def _information(problem: Problem, q: Array) -> Array:
    """Rows (K, r, P) of what each set of measurements tells at configurations (K, m), by its
    covariance where all sets have one, else in rad and reaches.
    """
    parts = scaled_jacobians(problem, q)
    if all(s.covariance is not None for s in problem.sets):
        for k, s in enumerate(problem.sets):
            unit = per_error(s, 1.0, problem.model.nominal.reach)
            L = np.linalg.cholesky(s.covariance[0] / np.outer(unit, unit))
            parts[k] = np.linalg.solve(L, parts[k])
    return np.concatenate(parts, axis=1)
