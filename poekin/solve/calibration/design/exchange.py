"""The search for the n of K candidates that show the parameters best: a greedy start, then
exchanges.

All on plain arrays: `blocks` (K, r, L), the identification matrix' rows of each candidate, scaled,
on the L directions that can be seen. N = sum of B_k^T B_k over the chosen is their information
matrix; its eigenvalues are the squares of the singular values that the indices are made of.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ....groups.arrays import Array
from ..model.tsqr import triangle

CRITERIA = ("amplification", "O1", "condition", "smallest", "prediction")
"""What a choice may be made by: one of the four indices (`indices.Indices`), or "prediction", the
variance that the calibrated model's errors then have, the mean over all candidates (V-optimality,
Fedorov 1972)."""

# in the logarithm of the criterion: less is rounding, and exchanges for it could go round in
# circles
GAIN = 1e-9
LOWEST, HIGHEST = (
    8,
    2,
)  # eigenvectors for the bounds: more of them make tighter bounds, which cost more
TOGETHER = 32  # exchanges that are valued in full at a time
UNSEEN = 1e-9  # of the information of a mean candidate: stands in for what the first few do not see


def greedy(blocks: Array, n: int, tick: Callable[[], None] = lambda: None) -> list[int]:
    """n rows of blocks (K, r, L), each the one that adds most to log det N; tick() after each."""
    count, rows, size = blocks.shape
    # On axes in which all candidates together show every direction alike: what is best is the same.
    blocks = blocks @ np.linalg.inv(triangle(blocks.reshape(-1, size)))
    N = np.eye(size) * (UNSEEN / count)
    chosen: list[int] = []
    for _ in range(n):
        # det(N + B^T B) = det N det(1 + B N^-1 B^T)
        gains = np.linalg.slogdet(
            np.eye(rows) + blocks @ np.linalg.inv(N) @ blocks.transpose(0, 2, 1)
        )[1]
        gains[chosen] = -np.inf
        chosen.append(int(gains.argmax()))
        N = N + blocks[chosen[-1]].T @ blocks[chosen[-1]]
        tick()
    return chosen


def exchange(
    blocks: Array,
    n: int,
    by: str = "amplification",
    progress: Callable[[int, int], None] | None = None,
) -> np.ndarray:
    """The rows of blocks, ascending, of n candidates of which none can be exchanged for a better
    one.

    Parameters: blocks (K, r, L), of which some n see all L directions, n <= K; by, one of
    `CRITERIA`;
    progress(done, total), called after each step, total an estimate that may grow. Returns: (n,) of
    int, the same at every call: a local best, from the greedy start.
    Accuracy: an exchange counts if it betters the criterion by 1e-9 of it.
    Source: Fedorov 1972 ("Theory of optimal experiments"), one of the chosen after the other; the
    greedy start and the exchange are those of DETMAX (Mitchell 1974), which Daney, Papegay and
    Madeline 2005 use for the poses of robots.
    """
    blocks = np.asarray(np.linalg.qr(blocks, mode="r"))  # the same information in min(r, L) rows
    done, total = 0, 9 * n

    def tick() -> None:
        nonlocal done, total
        done += 1
        total = max(total, done + n)
        if progress is not None:
            progress(done, total)

    chosen = np.array(greedy(blocks, n, tick))
    mean = np.einsum("kri,krj->ij", blocks, blocks) / len(blocks)
    place, idle, state = 0, 0, seen(blocks, chosen, by, mean)
    while idle < n:
        better = best_exchange(blocks, chosen, place, by, state)
        idle += 1
        if better is not None:
            other = np.where(np.arange(n) == place, better, chosen)
            now = seen(blocks, other, by, mean)
            if (
                now.value > state.value
            ):  # where the best is rounding, too: it must not go round in circles
                chosen, state, idle = other, now, 0
        place = (place + 1) % n
        tick()
    if progress is not None:
        progress(done, done)
    return np.sort(chosen)


class Seen(NamedTuple):
    """What the chosen show: information N (L, L), the mean (L, L) of a candidate's, the criterion's
    value, and N^-1, for "O1" and "prediction", or a few eigenvalues (k,) and eigenvectors (L, k) of
    N.
    """

    N: Array
    mean: Array
    value: float
    inverse: np.ndarray | None
    eigenvalues: np.ndarray
    vectors: np.ndarray


def seen(blocks: Array, chosen: np.ndarray, by: str, mean: Array) -> Seen:
    """What the rows `chosen` of blocks show."""
    J = blocks[chosen].reshape(-1, blocks.shape[2])
    N = J.T @ J
    worth = float(value(N, by, mean))
    if by in ("O1", "prediction"):
        return Seen(N, mean, worth, np.linalg.inv(N), np.empty(0), np.empty((len(N), 0)))
    eigenvalues, V = np.linalg.eigh(N)
    some = np.r_[:LOWEST, len(N) - HIGHEST : len(N)] if len(N) > LOWEST + HIGHEST else slice(None)
    return Seen(N, mean, worth, None, eigenvalues[some], V[:, some])


def best_exchange(
    blocks: Array, chosen: np.ndarray, place: int, by: str, state: Seen
) -> int | None:
    """The candidate that betters the criterion most in that place of the chosen; None where none
    does.
    """
    out = blocks[chosen[place]]
    ahead = promise(blocks, out, by, state)
    ahead[chosen] = -np.inf
    left, best, most = state.N - out.T @ out, None, state.value + GAIN
    order = np.argsort(-ahead, kind="stable")
    for start in range(0, len(order), TOGETHER):
        some = order[start : start + TOGETHER]
        some = some[ahead[some] > most]
        if not len(some):
            break
        values = value(left + blocks[some].transpose(0, 2, 1) @ blocks[some], by, state.mean)
        if values.max() > most:
            best, most = int(some[values.argmax()]), float(values.max())
    return best


def value(N: Array, by: str, mean: Array) -> Array:
    """The logarithm of the criterion (...) of information matrices N (..., L, L); larger is better.

    mean (L, L): the mean information of a candidate, for "prediction".
    """
    if by == "prediction":
        # NumPy 1 takes one matrix beside many for a stack of vectors.
        return -_log(
            np.trace(np.linalg.solve(N, np.broadcast_to(mean, N.shape)), axis1=-2, axis2=-1), np.inf
        )
    eigenvalues = np.linalg.eigvalsh(N)
    floor = np.maximum(np.finfo(float).eps * eigenvalues[..., -1:], np.finfo(float).tiny)
    logs = np.log(np.maximum(eigenvalues, floor))
    return logs.sum(-1) if by == "O1" else _of_extremes(logs[..., 0], logs[..., -1], by)


def _of_extremes(low: np.ndarray, high: np.ndarray, by: str) -> Array:
    """The logarithm of the square of an index, of those of the extreme eigenvalues."""
    return low if by == "smallest" else low - high if by == "condition" else 2 * low - high


def _log(x: np.ndarray, otherwise: float) -> Array:
    """log x where x is positive."""
    good = x > 0
    return np.where(good, np.log(np.where(good, x, 1.0)), otherwise)


def promise(blocks: Array, out: Array, by: str, state: Seen) -> Array:
    """What no exchange of the block `out` for candidate j can exceed (K,), so that few need to be
    valued in full.

    Of the extreme eigenvalues: on a few eigenvectors V of N, the eigenvalues of V^T N' V lie
    between the smallest and the largest of N' (Rayleigh and Ritz). Of "O1" and "prediction" it is
    the value itself, with N' = N + W^T S W,
    W = (B_j; B_out), S = diag(1, -1), and the small matrix C = S + W N^-1 W^T:
    det N' = det N det(S C), and tr(Q N'^-1) = tr(Q N^-1) - tr(C^-1 W N^-1 Q N^-1 W^T).
    """
    if state.inverse is None:
        into, gone = blocks @ state.vectors, out @ state.vectors
        diagonal = state.eigenvalues - (gone**2).sum(0) + (into**2).sum(1)
        ahead = _of_extremes(_log(diagonal.min(1), -np.inf), _log(diagonal.max(1), np.inf), by)
        left = np.flatnonzero(ahead > state.value)  # for the others one vector each says enough
        compressed = (
            np.diag(state.eigenvalues) - gone.T @ gone + into[left].transpose(0, 2, 1) @ into[left]
        )
        ritz = np.linalg.eigvalsh(compressed)
        ahead[left] = _of_extremes(_log(ritz[:, 0], -np.inf), _log(ritz[:, -1], np.inf), by)
        return ahead
    inverse, signs = state.inverse, np.repeat([1.0, -1.0], len(out))
    W = np.concatenate([blocks, np.broadcast_to(out, blocks.shape)], axis=1)
    C = np.diag(signs) + W @ inverse @ W.transpose(0, 2, 1)
    sign, log = np.linalg.slogdet(C)
    regular = sign * signs.prod() > 0
    if by == "O1":
        return np.where(regular, state.value + log, -np.inf)
    C[~regular] = np.eye(len(signs))
    spread = W @ (inverse @ state.mean @ inverse) @ W.transpose(0, 2, 1)
    less = np.trace(np.linalg.solve(C, spread), axis1=-2, axis2=-1)
    return np.where(regular, -_log(np.trace(inverse @ state.mean) - less, np.inf), -np.inf)
