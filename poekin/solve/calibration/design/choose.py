"""choose_poses: the configurations to measure at, so that a calibration sees most."""

from __future__ import annotations

import copy
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ....errors import InputError, ShapeError, quote, safe_repr
from ....groups.arrays import Array
from ....model.chain import Chain
from ....model.coordinates import coordinates
from ..diagnostics.identification import RANK, judged, normalised
from ..measurements.measurement import Measurement
from ..measurements.points import Points
from ..measurements.poses import Poses
from ..model.parameters import Arm
from ..model.problem import Problem
from ..model.tsqr import triangle
from . import indices
from .choice import SMALLER, Choice, Figures
from .exchange import CRITERIA, exchange, greedy


def choose_poses(
    arm: Chain,
    n: int,
    candidates: Any,
    *,
    measurements: Any = "poses",
    parameters: Sequence[str] = ("screws", "home"),
    joints: Sequence[str] | None = None,
    by: str = "amplification",
    compare: int = 100,
    seed: int = 0,
    progress: Callable[[int, int], None] | None = None,
) -> Choice:
    """The n of the candidates at which measuring tells most about the parameters of the arm.

    A greedy start, bettered by exchanging one configuration at a time until no exchange helps: a
    local best.

    Parameters
    ----------
    arm: nominal. n: how many configurations. candidates (K, m), rad or m, within the limits, or how
        many of them to draw within the limits.
    measurements: what will be measured at each: "poses" or "points" of the tip; or `Points`,
        `EyeInHand`, ..., or a list of them, as an example: the points, centre, board and camera
        count, measured numbers and covariances do not. A board or camera has to be given roughly; a
        device in an unknown frame is taken to stand at the base.
    parameters, joints: what will be calibrated, as `calibrate`.
    by: "amplification" (noise amplification index), "O1", "condition", "smallest" (singular value),
        or "prediction": the least mean variance of the calibrated arm's errors over all candidates.
        The indices look at the worst seen combination of parameters, which poses may hardly depend
        on: where the arm's accuracy is what matters, take "prediction" or "O1", and look at
        `gains`.
    compare: random choices to compare with. seed: of what is drawn. progress(done, total): called
    after each step.

    Returns: Choice; `print` of it says by how much it beats random choices. The same arguments give
    the same choice. Raises: InputError, ShapeError: a candidate outside the limits (its row), n too
    small for the parameters (how many are needed), n above K.
    Accuracy: as `indices` on the space that the candidates show; angles in rad, lengths in reaches,
    noise alike in all. Source: indices: see `indices`; search: see `exchange`; prediction:
    V-optimality, Fedorov 1972, as the test poses of Wu, Klimchik, Pashkevich, Caro and Furet 2013
    ("Efficiency improvement of measurement pose selection techniques in robot calibration").
    """
    if not isinstance(arm, Chain):
        raise InputError(f"choose_poses: expected a Chain, got {safe_repr(arm)}")
    for value, what in ((n, "n"), (compare, "compare")):
        if not _is_count(value):
            raise InputError(f"{what}: expected a whole number above 0, got {safe_repr(value)}")
    if not (_is_count(seed) or seed == 0):
        raise InputError(f"seed: expected a whole number from 0 up, got {safe_repr(seed)}")
    if by not in CRITERIA:
        raise InputError(
            f"by: expected one of {', '.join(map(repr, CRITERIA))}, got {safe_repr(by)}"
        )
    q = _candidates(arm, candidates, seed)
    if n > len(q):
        raise InputError(f"n: expected at most the {len(q)} candidates, got {n}")
    sets = _sets(measurements)
    problem = Problem(Arm(arm, parameters, joints), q, sets, _places(sets))
    identification = judged(problem)[0]
    if not identification.rank:
        raise InputError(
            f"choose_poses: such measurements show none of the {problem.size} parameters anywhere"
        )
    blocks = _blocks(problem, identification.rank)
    _enough(blocks, n)
    rows = exchange(blocks, n, by, progress)
    rng = np.random.default_rng((seed, 1))
    others = np.array(
        [_figures(blocks, rng.choice(len(q), n, replace=False)) for _ in range(compare)]
    )
    best = [
        others[:, k].min() if name in SMALLER else others[:, k].max()
        for k, name in enumerate(Figures._fields)
    ]
    return Choice(
        q=q[rows],
        rows=rows,
        by=by,
        figures=_figures(blocks, rows),
        random=Figures(*np.median(others, axis=0).tolist()),
        best=Figures(*map(float, best)),
        rank=identification.rank,
        expected=identification.expected,
        unseen=identification.unseen,
        candidates=len(q),
        compare=int(compare),
    )


def _is_count(value: Any) -> bool:
    return isinstance(value, (int, np.integer)) and not isinstance(value, bool) and bool(value > 0)


def _candidates(arm: Chain, candidates: Any, seed: int) -> Array:
    """The candidates (K, m), finite and within the limits."""
    if _is_count(candidates):
        return arm.random(seed, int(candidates))
    scalar = candidates is None or isinstance(candidates, (str, int, float, np.generic))
    q = np.empty(()) if scalar else coordinates(candidates, arm.q_names, "candidates")
    if q.ndim != 2:
        raise ShapeError(
            f"candidates: expected configurations (K, {arm.dof}), or how many to draw, got {safe_repr(candidates)}"
        )
    finite = np.isfinite(q)
    lower, upper = arm.limits.T
    bad = ~(finite & (q >= lower) & (q <= upper))
    if bad.any():
        row, k = (int(x) for x in np.argwhere(bad)[0])
        where, many = (
            f"candidates[{row}]: {quote(arm.q_names[k])} = {q[row, k]:.6g}",
            int(bad.any(axis=1).sum()),
        )
        what = (
            f"is outside its limits {lower[k]:.6g} to {upper[k]:.6g}"
            if finite[row, k]
            else "is no finite number"
        )
        raise InputError(
            f"{where} {what}"
            + (f"; {many} of the {len(q)} candidates cannot be taken" if many > 1 else "")
        )
    return q


def _sets(measurements: Any) -> list[Measurement]:
    """Examples of what is measured at each configuration."""
    if isinstance(measurements, str) and measurements in ("poses", "points"):
        return [Poses(np.eye(4)[None]) if measurements == "poses" else Points(np.zeros((1, 3)))]
    sets = [measurements] if isinstance(measurements, Measurement) else measurements
    if (
        not isinstance(sets, (list, tuple))
        or not sets
        or not all(isinstance(s, Measurement) for s in sets)
    ):
        raise InputError(
            "measurements: expected 'poses', 'points', or an example of Poses, Points, Distances, EyeInHand or"
            f" EyeToHand, or a list of them, got {safe_repr(measurements)}"
        )
    return [_everywhere(s) for s in sets]


def _everywhere(example: Measurement) -> Measurement:
    """The same kind of measurement, made at every configuration."""
    other = copy.copy(example)
    object.__setattr__(other, "rows", None)
    return other


def _places(sets: list[Measurement]) -> list[Array]:
    """Where the unknown frames are: as guessed in the examples; a device of `Points` at the base."""
    places = []
    for s in sets:
        for unknown in s.unknowns:
            if unknown.guess is None and not isinstance(s, Points):
                name = unknown.name.rpartition("_")[2]
                raise InputError(
                    f"measurements: {s.what}: expected {name}=, roughly where it is: nothing is measured yet"
                )
            places.append(np.eye(4) if unknown.guess is None else unknown.guess)
    return places


def _blocks(problem: Problem, rank: int) -> Array:
    """The identification matrix of each candidate (K, r, L), on the space that all of them together
    show.
    """
    J, count = normalised(problem), len(problem.q)
    ends = np.cumsum([count * s.width for s in problem.sets])[:-1]
    blocks = np.concatenate(
        [part.reshape(count, -1, problem.size) for part in np.split(J, ends)], axis=1
    )
    return blocks @ np.linalg.svd(triangle(J), full_matrices=False)[2][:rank].T


def _enough(blocks: Array, n: int) -> None:
    """Raises InputError that says how many configurations show what all candidates show, where n do
    not.
    """
    size = blocks.shape[2]
    start = greedy(blocks, min(len(blocks), max(n, size)))

    def shows(count: int) -> bool:
        s = np.linalg.svd(triangle(blocks[start[:count]].reshape(-1, size)), compute_uv=False)
        return len(s) == size and s[-1] > RANK * s[0]

    if not shows(n):
        needed = next(filter(shows, range(n, len(start))), len(start))
        raise InputError(
            f"n: {n} configurations of {blocks.shape[1]} numbers each are too few for {size} parameters: expected at"
            f" least {needed}, better three times as many; or calibrate less (parameters=, joints=)"
        )


def _figures(blocks: Array, rows: np.ndarray) -> Figures:
    """The figures of the candidates `rows`."""
    J = blocks[rows].reshape(-1, blocks.shape[2])
    _, s, Vt = np.linalg.svd(triangle(J), full_matrices=False)
    if len(s) < J.shape[1] or s[-1] <= RANK * s[0]:
        return _with(indices.of_singular_values(np.zeros(J.shape[1]), len(rows)), np.inf)
    # the errors at the candidates are B_k dp, and the covariance of dp is (J^T J)^-1 = V s^-2 V^T
    spread = blocks @ (Vt.T / s)
    return _with(
        indices.of_singular_values(s, len(rows)), float(np.sqrt(np.mean(np.sum(spread**2, axis=2))))
    )


def _with(found: indices.Indices, prediction: float) -> Figures:
    return Figures(*map(float, found), prediction)  # type: ignore[call-arg]
