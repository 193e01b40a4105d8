"""The search for the n of K candidates that show the parameters best: a greedy start, then
exchanges.

All on plain arrays: `blocks` (K, r, L), the identification matrix' rows of each candidate, scaled,
on the L directions that can be seen. N = sum of B_k^T B_k over the chosen is their information
matrix, with that of what was measured before; its eigenvalues are the squares of the singular values
that the indices are made of.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal, NamedTuple, get_args

import numpy as np

from ....groups.arrays import Array
from ....results import Progress
from ..model.tsqr import blocked_product
from .greedy import greedy, rows_before

Criterion = Literal["prediction", "O1", "amplification", "condition", "smallest"]
CRITERIA: tuple[Criterion, ...] = get_args(Criterion)
"""Criteria of a choice: "prediction", the variance that the calibrated model's errors then have, the
mean over the workspace (V-optimality, Fedorov 1972), or one of the four `ObservabilityIndices`.
"""
WITH_INVERSE = ("prediction", "O1")
"""Criteria that are functions of N^-1; the others are of its extreme eigenvalues."""
SHORTLIST = 250
"""Candidates that exchanges are tried with, of those criteria: the ones that promise most."""
LISTS = 4
"""Times at most that a list is made anew, where exchanges have changed what promises most."""

# in the logarithm of the criterion: less is rounding, and exchanges for it could go round in
# circles
MIN_IMPROVEMENT = 1e-9
# eigenvectors for the bounds: more of them make tighter bounds, which cost more
LOWEST = 8
HIGHEST = 2
TOGETHER = 32  # exchanges that are evaluated in full at a time


def exchange(
    blocks: Array,
    n: int,
    criterion: Criterion = "prediction",
    progress: Progress | None = None,
    *,
    mean: Any = None,
    given: Array | None = None,
) -> np.ndarray:
    """The rows of blocks, ascending, of n candidates of which none can be exchanged for a better
    one of those that promise most.

    Parameters: blocks (K, r, L), of which some n, with those before, see all L directions, n <= K;
    criterion, one of `CRITERIA`; progress(done, total), called after each step, total an estimate
    that may grow; mean (L, L), the mean information of a measurement in the workspace (default: of a
    candidate), for "prediction"; given (k, L), rows of what was measured before.
    Returns: (n,) of int, the same at every call: a local best, from the greedy start.
    Accuracy: an exchange counts if it improves the criterion by 1e-9 of it; those are tried that
    promise most.
    Source: Fedorov 1972 ("Theory of optimal experiments"), one of the chosen after the other; the
    greedy start and the exchange are those of DETMAX (Mitchell 1974), which Daney, Papegay and
    Madeline 2005 use for the poses of robots.
    """
    _, rows, size = blocks.shape
    if rows > size:  # the same information in L rows
        blocks = np.asarray(np.linalg.qr(blocks, mode="r"))
    done = 0
    total = 9 * n

    def tick() -> None:
        nonlocal done, total
        done += 1
        total = max(total, done + n)
        if progress is not None:
            progress(done, total)

    chosen = np.array(greedy(blocks, n, tick, given))
    if mean is None:
        mean = np.einsum("kri,krj->ij", blocks, blocks) / len(blocks)
    search = Search(blocks, criterion, mean, rows_before(given, size))
    for _ in range(LISTS):
        listed = promising(search, chosen)
        found = listed[_exchanged(search._replace(blocks=blocks[listed]), n, tick)]
        is_last = len(listed) == len(blocks) or np.array_equal(found, chosen)
        chosen = found
        if is_last:
            break
    if progress is not None:
        progress(done, done)
    return np.sort(chosen)


def _exchanged(search: Search, n: int, tick: Callable[[], None]) -> np.ndarray:
    """The first n of the candidates, exchanged for others until no exchange helps."""
    chosen = np.arange(n)
    state = design_state(search, chosen)
    place = 0
    idle = 0
    while idle < n:
        idle += 1
        better = best_exchange(search, state, chosen, place)
        if better is not None:
            other = np.where(np.arange(n) == place, better, chosen)
            now = design_state(search, other)
            # where the best is rounding, too: it must not go round in circles
            if now.value > state.value:
                chosen = other
                state = now
                idle = 0
        place = (place + 1) % n
        tick()
    return chosen


class Search(NamedTuple):
    """Rows (K, r, L) of each candidate, the criterion, the mean information (L, L) of a measurement
    in the workspace, and the rows (k, L) of what was measured before.
    """

    blocks: Array
    criterion: Criterion
    mean: Array
    given: Array


class DesignState(NamedTuple):
    """Information N (L, L) of the chosen, the criterion's value, and N^-1, for "O1" and
    "prediction", or a few eigenvalues (k,) and eigenvectors (L, k) of N.
    """

    N: Array
    value: float
    inverse: Any = None
    eigenvalues: Any = None
    vectors: Any = None


def design_state(search: Search, chosen: np.ndarray) -> DesignState:
    """State of the rows `chosen` of the candidates."""
    size = search.blocks.shape[2]
    J = np.concatenate([search.blocks[chosen].reshape(-1, size), search.given])
    N = J.T @ J
    worth = float(value(N, search.criterion, search.mean))
    if search.criterion in WITH_INVERSE:
        inverse = np.linalg.inv(N)
        return DesignState(N, worth, inverse)
    eigenvalues, V = np.linalg.eigh(N)
    some = np.arange(len(N))
    if len(N) > LOWEST + HIGHEST:
        lowest = some[:LOWEST]
        some = np.concatenate([lowest, some[-HIGHEST:]])
    return DesignState(
        N,
        worth,
        eigenvalues=eigenvalues[some],
        vectors=V[:, some],
    )


def promising(search: Search, chosen: np.ndarray) -> np.ndarray:
    """The candidates to try: the chosen ones, in their order, and then what promises most: the
    derivative of the criterion by the weight of each, tr(B N^-1 B^T) or tr(B N^-1 Q N^-1 B^T).
    """
    blocks = search.blocks
    count, _, size = blocks.shape
    others = np.setdiff1d(np.arange(count), chosen)
    if search.criterion in WITH_INVERSE and len(others) > SHORTLIST:
        weight = design_state(search, chosen).inverse
        if search.criterion == "prediction":
            weight = weight @ search.mean @ weight
        flat = blocks.reshape(-1, size)
        products = blocked_product(flat, weight) * flat
        promise = products.reshape(count, -1).sum(axis=1)
        order = np.argsort(-promise[others], kind="stable")
        others = others[order[:SHORTLIST]]
    return np.concatenate([chosen, others])


def best_exchange(
    search: Search,
    state: DesignState,
    chosen: np.ndarray,
    place: int,
) -> int | None:
    """The candidate that improves the criterion most in that place of the chosen; None where none
    does.
    """
    blocks = search.blocks
    out = blocks[chosen[place]]
    ahead = upper_bound(search, state, out)
    ahead[chosen] = -np.inf
    left = state.N - out.T @ out
    best = None
    most = state.value + MIN_IMPROVEMENT
    order = np.argsort(-ahead, kind="stable")
    for start in range(0, len(order), TOGETHER):
        some = order[start : start + TOGETHER]
        some = some[ahead[some] > most]
        if not len(some):
            break
        N = left + blocks[some].transpose(0, 2, 1) @ blocks[some]
        values = value(N, search.criterion, search.mean)
        if values.max() > most:
            best = int(some[values.argmax()])
            most = float(values.max())
    return best


def value(N: Array, criterion: Criterion, mean: Array) -> Array:
    """The logarithm of the criterion (...) of information matrices N (..., L, L); larger is better.

    mean (L, L): the mean information of a measurement in the workspace, for "prediction".
    """
    if criterion == "prediction":
        # NumPy 1 takes one matrix beside many for a stack of vectors.
        means = np.broadcast_to(mean, N.shape)
        spread = np.linalg.solve(N, means)
        return -_log(_trace(spread), np.inf)
    eigenvalues = np.linalg.eigvalsh(N)
    double = np.finfo(float)
    rounding = double.eps * eigenvalues[..., -1:]
    floor = np.maximum(rounding, double.tiny)
    logs = np.log(np.maximum(eigenvalues, floor))
    if criterion == "O1":
        return logs.sum(-1)
    return _of_extremes(logs[..., 0], logs[..., -1], criterion)


def _trace(M: np.ndarray) -> Array:
    """Traces (...) of matrices (..., k, k)."""
    return np.trace(M, axis1=-2, axis2=-1)


def _of_extremes(
    low: np.ndarray,
    high: np.ndarray,
    criterion: Criterion,
) -> Array:
    """The logarithm of the square of an index, of those of the extreme eigenvalues."""
    if criterion == "smallest":
        return low
    if criterion == "condition":
        return low - high
    return 2 * low - high


def _log(x: np.ndarray, otherwise: float) -> Array:
    """log x where x is positive."""
    good = x > 0
    logs = np.log(np.where(good, x, 1.0))
    return np.where(good, logs, otherwise)


def upper_bound(search: Search, state: DesignState, out: Array) -> Array:
    """Upper bound (K,) of the criterion after each exchange of the block `out` for candidate j, so
    that few need to be evaluated in full.
    """
    if state.inverse is None:
        return _bound_by_ritz_values(search, state, out)
    return _exact_update(search, state, out)


def _bound_by_ritz_values(search: Search, state: DesignState, out: Array) -> Array:
    """Bound of the extreme eigenvalues: on a few eigenvectors V of N, the eigenvalues of V^T N' V
    lie between the smallest and the largest of N' (Rayleigh and Ritz).
    """
    into = search.blocks @ state.vectors
    gone = out @ state.vectors
    remaining = state.eigenvalues - (gone**2).sum(0)
    diagonal = remaining + (into**2).sum(1)
    ahead = _between(diagonal.min(1), diagonal.max(1), search.criterion)
    left = np.flatnonzero(ahead > state.value)  # for the others one vector each says enough
    some = into[left]
    left_over = np.diag(state.eigenvalues) - gone.T @ gone
    projected = left_over + some.transpose(0, 2, 1) @ some
    ritz = np.linalg.eigvalsh(projected)
    ahead[left] = _between(ritz[:, 0], ritz[:, -1], search.criterion)
    return ahead


def _between(
    low: np.ndarray,
    high: np.ndarray,
    criterion: Criterion,
) -> Array:
    """Bound (K,) of the criterion where all eigenvalues span from low to high at least."""
    return _of_extremes(
        _log(low, -np.inf),
        _log(high, np.inf),
        criterion,
    )


def _exact_update(search: Search, state: DesignState, out: Array) -> Array:
    """Values of "O1" and "prediction" after each exchange: with N' = N + W^T S W, W = (B_j; B_out),
    S = diag(1, -1), and the small matrix C = S + W N^-1 W^T: det N' = det N det(S C), and tr(Q
    N'^-1) = tr(Q N^-1) - tr(C^-1 W N^-1 Q N^-1 W^T).
    """
    blocks = search.blocks
    signs = np.repeat([1.0, -1.0], len(out))
    outs = np.broadcast_to(out, blocks.shape)
    W = np.concatenate([blocks, outs], axis=1)
    C = np.diag(signs) + W @ state.inverse @ W.transpose(0, 2, 1)
    sign, log = np.linalg.slogdet(C)
    regular = sign * signs.prod() > 0
    if search.criterion == "O1":
        return np.where(regular, state.value + log, -np.inf)
    C[~regular] = np.eye(len(signs))
    weighted = state.inverse @ search.mean
    spread = W @ (weighted @ state.inverse) @ W.transpose(0, 2, 1)
    less = _trace(np.linalg.solve(C, spread))
    left = np.trace(weighted) - less
    return np.where(regular, -_log(left, np.inf), -np.inf)
