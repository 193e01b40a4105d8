"""choose_poses: the configurations to measure at, so that a calibration sees most."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal

import numpy as np

from ....checks import choice, is_whole, whole
from ....errors import InputError, ShapeError, quote, safe_repr
from ....groups.arrays import Array
from ....model.chain import Chain
from ....model.checks import finite
from ....model.coordinates import coordinates
from ....model.kinematics.arm import Arm, chain_of
from ....results import Progress
from ..diagnostics.identification import (
    RANK,
    identification_matrix,
    identify_directions,
    row_space,
    scaled_jacobians,
)
from ..measurements.measurement import Measurement
from ..measurements.points import Points
from ..measurements.poses import Poses
from ..model.error_model import ErrorModel
from ..model.parameters import ParameterKind
from ..model.problem import Problem
from ..model.tsqr import qr_r
from . import observability
from .choice import SMALLER_IS_BETTER, Choice, DesignMetrics
from .exchange import CRITERIA, Criterion, exchange, greedy


def choose_poses(  # noqa: PLR0913 - options by keyword
    chain: Arm,
    n: int,
    candidates: Any,
    *,
    measurements: Measurement | Sequence[Measurement] | Literal["poses", "points"] = "poses",
    parameters: ParameterKind | Sequence[ParameterKind] = ("screws", "home"),
    joints: Sequence[str] | None = None,
    criterion: Criterion = "amplification",
    n_random: int = 100,
    seed: int = 0,
    progress: Progress | None = None,
) -> Choice:
    """Choice of the n candidates at which measuring tells most about the parameters of the arm.

    A greedy start, bettered by exchanging one configuration at a time until no exchange helps: a
    local best. The same arguments give the same choice.

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
        `EyeInHand`, of which points, centre, board and camera count, measured numbers and
        covariances do not. A board or camera has to be given roughly; a device in an unknown frame
        is taken to stand at the base.
    parameters, joints : sequence of str, optional
        As of `calibrate`.
    criterion : {"amplification", "O1", "condition", "smallest", "prediction"}
        Observability index, or "prediction": the least mean variance of the calibrated arm's errors
        over all candidates. The indices look at the worst seen combination of parameters, which
        poses may hardly depend on: where the arm's accuracy is what matters, take "prediction" or
        "O1", and look at `improvement`. Default "amplification", the noise amplification index.
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
        needed), n above K, or an option out of its range.
    ShapeError
        If the candidates are no configurations.
    UnknownName
        If a joint is not there.

    Notes
    -----
    Accuracy: as `observability_indices` on the space that the candidates show; angles in rad,
    lengths in reaches, noise alike in all. Source: indices: `observability_indices`; search:
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
    """
    chain = chain_of(chain)
    whole(n, "n", 1)
    whole(n_random, "n_random", 1)
    whole(seed, "seed", 0)
    choice(criterion, CRITERIA, "criterion")
    q = _candidates(chain, candidates, seed)
    if n > len(q):
        raise InputError(f"n: expected at most the {len(q)} candidates, got {n}")
    sets = _examples(measurements)
    model = ErrorModel(chain, parameters, joints)
    problem = Problem(model, q, sets, _rough_frames(sets))
    identification = identify_directions(problem)[0]
    if not identification.rank:
        raise InputError(
            f"choose_poses: such measurements identify none of the {problem.size} parameters anywhere"
        )
    # of each candidate (K, r, L), on the space that all of them together show
    seen = row_space(identification_matrix(problem)).basis
    blocks = np.concatenate(scaled_jacobians(problem), axis=1) @ seen
    _enough(blocks, n)
    rows = exchange(blocks, n, criterion, progress)
    rng = np.random.default_rng((seed, 1))
    drawn = [rng.choice(len(q), n, replace=False) for _ in range(n_random)]
    others = np.array([design_metrics(blocks, some) for some in drawn])
    smaller = [name in SMALLER_IS_BETTER for name in DesignMetrics._fields]
    best = np.where(smaller, others.min(axis=0), others.max(axis=0))
    return Choice(
        q=q[rows],
        rows=rows,
        criterion=criterion,
        metrics=design_metrics(blocks, rows),
        random_median=DesignMetrics(*np.median(others, axis=0).tolist()),
        random_best=DesignMetrics(*best.tolist()),
        rank=identification.rank,
        identifiable=identification.identifiable,
        unobserved=identification.unobserved,
        candidates=len(q),
        n_random=int(n_random),
    )


def _candidates(chain: Chain, candidates: Any, seed: int) -> Array:
    """The candidates (K, m), finite and within the limits."""
    if is_whole(candidates, 1):
        return chain.random(seed, int(candidates))
    scalar = candidates is None or isinstance(candidates, (str, int, float, np.generic))
    q = np.empty(()) if scalar else coordinates(candidates, chain.q_names, "candidates")
    if q.ndim != 2:
        raise ShapeError(
            f"candidates: expected configurations (K, {chain.dof}), or how many to draw, got "
            f"{safe_repr(candidates)}"
        )
    q = finite(q, "candidates")
    lower, upper = chain.limits.T
    bad = (q < lower) | (q > upper)
    for row, k in np.argwhere(bad).tolist():
        many = int(bad.any(axis=1).sum())
        others = ""
        if many > 1:
            others = f"; {many} of the {len(q)} candidates cannot be taken"
        raise InputError(
            f"candidates[{row}]: {quote(chain.q_names[k])} = {q[row, k]:.6g} is outside its limits "
            f"{lower[k]:.6g} to {upper[k]:.6g}{others}"
        )
    return q


def _examples(measurements: Any) -> list[Measurement]:
    """Examples of what is measured at each configuration."""
    tip = {
        "poses": Poses(np.eye(4)[None]),
        "points": Points(np.zeros((1, 3))),
    }
    if isinstance(measurements, str) and measurements in tip:
        return [tip[measurements]]
    sets: Any = [measurements] if isinstance(measurements, Measurement) else measurements
    several = isinstance(sets, (list, tuple)) and len(sets)
    if not several or not all(isinstance(s, Measurement) and s.sees_arm for s in sets):
        raise InputError(
            "measurements: expected 'poses', 'points', or an example of Poses, Points, Distances, "
            f"EyeInHand or EyeToHand, or a list of them, got {safe_repr(measurements)}"
        )
    return [s.with_rows(None) for s in sets]


def _rough_frames(sets: list[Measurement]) -> list[Array]:
    """Unknown frames as guessed in the examples; a device of `Points` stands at the base."""
    frames = []
    for s in sets:
        for unknown in s.unknown_frames:
            if unknown.guess is None and not (isinstance(s, Points) and unknown.size == 6):
                name = unknown.name.rpartition("_")[2]
                if isinstance(s, Points):
                    name = "points"
                raise InputError(
                    f"measurements: {s.what}: expected {name}=, roughly where it is: nothing is "
                    "measured yet"
                )
            frames.append(np.eye(4) if unknown.guess is None else unknown.guess)
    return frames


def _enough(blocks: Array, n: int) -> None:
    """Raises InputError that says how many configurations show what all candidates show, where n do
    not.
    """
    size = blocks.shape[2]
    most = min(len(blocks), max(n, size))
    start = np.array(greedy(blocks, most))

    def shows(count: int) -> bool:
        return design_metrics(blocks, start[:count]).smallest > 0

    if not shows(n):
        needed = next(filter(shows, range(n, len(start))), len(start))
        raise InputError(
            f"n: {n} configurations of {blocks.shape[1]} equations each are too few for {size} "
            f"parameters: expected at least {needed}, better three times as many; or calibrate less"
            " (parameters=, joints=)"
        )


def design_metrics(blocks: Array, rows: np.ndarray) -> DesignMetrics:
    """The metrics of the candidates `rows`."""
    size = blocks.shape[2]
    J = blocks[rows].reshape(-1, size)
    _, s, Vt = np.linalg.svd(qr_r(J), full_matrices=False)
    if len(s) < size or s[-1] <= RANK * s[0]:
        return DesignMetrics(*observability.UNOBSERVED, np.inf)
    indices = observability.from_singular_values(s, len(rows))
    # the errors at the candidates are B_k dp, and the covariance of dp is (J^T J)^-1 = V s^-2 V^T
    spread = blocks @ (Vt.T / s)
    variances = np.sum(spread**2, axis=2)
    prediction = np.sqrt(np.mean(variances))
    return DesignMetrics(*indices, float(prediction))
