"""Redundant arms: the coordinate that is given values, its values, and the curves of self-motion."""

from __future__ import annotations

import numpy as np

from ...analysis.axes import axes
from ...errors import InputError, UnknownName, join_names, quote, suggest
from ...groups.arrays import Array
from ...model.chain import Chain
from ...model.sampling import sampling_range
from ..joint_units import bounds, joint_units, period, periods
from ..lock import free_chain

N_SWIVEL = 64
"""Values of the redundant coordinate where only its name is given."""

_DRAWS = 64  # configurations at which it is seen which coordinate moves most
_EDGE = 1e-9  # rad or m
_CONTINUES = 0.5  # largest error of the step that two tangents foretell, of the step itself


def redundant_coordinate(chain: Chain, values: Array, asked: str | None) -> int:
    """Number of the coordinate of an arm to be given values; `values` (m,) are those of what is
    locked, NaN of the seven coordinates that may move.

    That which is `asked`, else joint 3 of an arm with a spherical shoulder and a spherical wrist
    (S-R-S), where it gives the arm angle, else the last joint without which the arm has three axes
    that meet in a point or are parallel, and so a closed form (Pieper), else the coordinate that
    moves most along self-motions. Raises: InputError, UnknownName.
    """
    names = chain.q_names
    if asked is not None and asked not in names:
        raise UnknownName(f"redundant: no coordinate {quote(asked)}; {suggest(str(asked), names)}")
    free = np.isnan(values)
    if free.sum() != 7:
        raise InputError(
            f"n_swivel: expected an arm with seven coordinates that may move, got {free.sum()} "
            f"({join_names(np.array(names)[free])}); `lock` keeps others at given values"
        )
    if asked is not None:
        if not free[names.index(asked)]:
            raise InputError(
                f"redundant: expected a coordinate that is free, {quote(asked)} is locked"
            )
        return names.index(asked)
    arm = free_chain(chain, values)
    best = _by_shape(arm)
    if best is None:
        best = _most_moving(arm)
    return int(np.flatnonzero(free)[best])


def _by_shape(arm: Chain) -> int | None:
    if arm.nontrivial_coupling is not None:
        return None
    if axes(arm).has("S-R-S"):
        return 2
    middle = np.mean(sampling_range(arm), axis=0)
    for k in reversed(range(arm.dof)):
        only = np.full(arm.dof, np.nan)
        only[k] = middle[k]
        if axes(free_chain(arm, only)).has("Pieper"):
            return k
    return None


def _most_moving(arm: Chain) -> int:
    J = arm.jacobian(arm.random(0, _DRAWS), frame="hybrid")
    moves = np.abs(_null_vectors(J))
    return int(np.argmax(np.median(moves, axis=0)))


def _null_vectors(J: Array) -> Array:
    """Unit vectors (N, m) that Jacobians (N, 6, m) take nearest to zero."""
    _, _, rows = np.linalg.svd(J)
    return rows[:, -1]


def sample_values(chain: Chain, k: int, count: int, limits: bool) -> Array:
    """Values (count,) of coordinate k, evenly over its limits, or over a period where these are
    wider, its end left out.
    """
    low, high = bounds(chain, limits)[k]
    turn = period(chain, k)
    if turn and high - low >= turn:
        start = np.clip(-0.5 * turn, low, high - turn)
        step = turn / count
        return start + step * np.arange(count)
    if not np.isfinite(high - low):
        low, high = (ends[k] for ends in sampling_range(chain))
    if count == 1:
        return np.array([0.5 * (low + high)])
    return np.linspace(low, high, count)


def curves(
    chain: Chain,
    q: Array,
    sample: np.ndarray,
    redundant: str,
    limits: Array,
) -> list[Array]:
    """Solutions (s, m) of one target as curves of self-motion (l, m) along the samples (s,) of the
    redundant coordinate, the longest first; none leaves the limits (m, 2) of the coordinates.
    """
    k = chain.q_names.index(redundant)
    units = joint_units(chain.compile(), locked=True)
    arm = units.fast.chain
    u = units.of(q)
    turn = periods(arm)
    v = _null_vectors(arm.jacobian(u, frame="hybrid"))
    with np.errstate(divide="ignore", invalid="ignore"):
        tangent = v / v[:, k : k + 1]  # du / du_k
    following = np.full(len(q), -1)
    for number in np.unique(sample):
        here = np.flatnonzero(sample == number)
        there = np.flatnonzero(sample == number + 1)
        if len(there):
            tangents = (tangent[here], tangent[there])
            i, j = _links(u[here], u[there], *tangents, k, turn)
            stays = _stays(q[here[i]], q[there[j]], periods(chain), limits)
            following[here[i[stays]]] = there[j[stays]]
    first = np.setdiff1d(np.arange(len(q)), following)
    found = [q[_chained(row, following)] for row in first.tolist()]
    return sorted(found, key=len, reverse=True)


def _stays(a: Array, b: Array, turn: Array, limits: Array) -> np.ndarray:
    """Whether the shortest ways from a (s, m) to b lead to within the limits (m, 2), and not to whole
    turns beyond them.
    """
    period = np.where(turn > 0, turn, np.inf)
    step = b - a
    end = a + step - turn * np.round(step / period)
    lower, upper = limits.T
    return np.all((lower - _EDGE <= end) & (end <= upper + _EDGE), axis=1)


def _chained(row: int, following: np.ndarray) -> list[int]:
    rows = []
    while row >= 0:
        rows.append(row)
        row = int(following[row])
    return rows


def _links(
    a: Array,
    b: Array,
    tangent_a: Array,
    tangent_b: Array,
    k: int,
    turn: Array,
) -> tuple[np.ndarray, np.ndarray]:
    """Numbers of solutions of a (s, m), and of those of b (t, m) that continue them: each other's
    nearest to the step which the trapezoidal rule foretells, q_b - q_a = h (q_a' + q_b') / 2.
    """
    step = b[None] - a[:, None]
    period = np.where(turn > 0, turn, np.inf)
    step = step - turn * np.round(step / period)
    tangents = tangent_a[:, None] + tangent_b[None]
    expected = 0.5 * step[..., k : k + 1] * tangents
    off = np.abs(step - expected).max(axis=-1)
    size = np.abs(step).max(axis=-1)
    off = np.where(off <= _CONTINUES * size, off, np.inf)
    nearest = off.argmin(axis=1)
    i = np.arange(len(a))
    best_of_nearest = off.argmin(axis=0)[nearest]
    mutual = (best_of_nearest == i) & np.isfinite(off[i, nearest])
    return i[mutual], nearest[mutual]
