"""SO(3) and SE(3) over arrays in NumPy's extended precision: to look for the worst among many
cases.

What is found here is judged by `exact`; so nothing depends on how long a long double is (64 bits on
most processors, but 53 on some). Good to a few units of 2⁻⁶⁴ for |ω| from about 0.05 to 10, and for
log to π.
Shapes: twists (..., 6), poses (..., 4, 4), Jacobians (..., 6, 6); all are returned as long doubles.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

LongDouble = np.longdouble
_TERMS = 26
_SERIES_BELOW = 2.25  # θ²: there the closed forms begin to cancel


def hat(w: np.ndarray) -> np.ndarray:
    """[ω] of vectors (..., 3)."""
    W = np.zeros((*w.shape, 3), LongDouble)
    W[..., 2, 1], W[..., 0, 2], W[..., 1, 0] = w[..., 0], w[..., 1], w[..., 2]
    return W - np.swapaxes(W, -1, -2)


def exp(xi: np.ndarray) -> np.ndarray:
    """e^ξ (..., 4, 4)."""
    w, v = _halves(xi)
    W, WW, A, B, C = _powers(w)
    T = np.zeros((*xi.shape[:-1], 4, 4), LongDouble)
    T[..., :3, :3] = np.eye(3) + A * W + B * WW
    T[..., :3, 3] = ((np.eye(3) + B * W + C * WW) @ v[..., None])[..., 0]
    T[..., 3, 3] = 1
    return T


def left_jacobian(xi: np.ndarray) -> np.ndarray:
    """Σ ad(ξ)^k / (k+1)!, as [P 0; Q P]: P = I + B [ω] + C [ω]², and Q its derivative along v."""
    w, v = _halves(xi)
    V = hat(v)
    W, WW, A, B, C = _powers(w)
    dB, dC = _slopes(w, A, B, C)
    along = np.sum(w * v, axis=-1)[..., None, None]
    Q = B * V + C * (W @ V + V @ W) + 2 * along * (dB * W + dC * WW)
    return _lower(np.eye(3) + B * W + C * WW, Q)


def left_jacobian_inverse(xi: np.ndarray) -> np.ndarray:
    """The inverse of `left_jacobian`, |ω| up to π."""
    J = left_jacobian(xi)
    P = _inverse(J[..., :3, :3])
    return _lower(P, -(P @ J[..., 3:, :3] @ P))


def log(T: np.ndarray) -> np.ndarray:
    """The principal logarithm (..., 6) of the polar projection of poses."""
    R = T[..., :3, :3].astype(LongDouble)
    for _ in range(4):
        before, R = R, (R + np.swapaxes(_inverse(R), -1, -2)) / 2
        # A step leaves half its square: here less than 2⁻⁶⁷.
        if np.all(np.abs(R - before) < 1e-10):
            break
    s = (
        np.stack(
            [R[..., 2, 1] - R[..., 1, 2], R[..., 0, 2] - R[..., 2, 0], R[..., 1, 0] - R[..., 0, 1]],
            -1,
        )
        / 2
    )
    cosine = (np.trace(R, axis1=-2, axis2=-1) - 1) / 2
    angle = np.arctan2(_norm(s), cosine)
    # (R + Rᵀ)/2 - cos θ I = (1 - cos θ) n nᵀ: its largest column is the axis.
    N = (R + np.swapaxes(R, -1, -2)) / 2 - cosine[..., None, None] * np.eye(3)
    largest = np.argmax(np.diagonal(N, axis1=-2, axis2=-1), axis=-1)
    n = np.take_along_axis(N, largest[..., None, None], axis=-1)[..., 0]
    n = n * (np.where(np.sum(n * s, axis=-1) < 0, -angle, angle) / _norm(n))[..., None]
    w = np.where(
        (cosine > 0)[..., None], s * (angle / np.where(_norm(s) > 0, _norm(s), 1))[..., None], n
    )
    W, WW, _, B, C = _powers(w)
    P = np.eye(3) + B * W + C * WW
    return np.concatenate([w, (_inverse(P) @ T[..., :3, 3:].astype(LongDouble))[..., 0]], axis=-1)


def _halves(xi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    x = xi.astype(LongDouble)
    return x[..., :3], x[..., 3:]


def _powers(w: np.ndarray) -> tuple[np.ndarray, ...]:
    """[ω], [ω]² and what multiplies them: A = sin θ/θ, B = (1 - cos θ)/θ², C = (θ - sin θ)/θ³."""
    W = hat(w)
    s = np.sum(w * w, axis=-1)
    t = np.sqrt(s)

    def closed(s: np.ndarray, t: np.ndarray) -> tuple[np.ndarray, ...]:
        A = np.sin(t) / t
        return A, 2 * (np.sin(t / 2) / t) ** 2, (1 - A) / s

    return W, W @ W, *_chosen(s, lambda s: tuple(_series(s, f) for f in (1, 2, 3)), closed, t)


def _slopes(w: np.ndarray, A: np.ndarray, B: np.ndarray, C: np.ndarray) -> tuple[np.ndarray, ...]:
    """dB/ds, dC/ds of s = θ²."""

    def closed(
        s: np.ndarray, A: np.ndarray, B: np.ndarray, C: np.ndarray
    ) -> tuple[np.ndarray, ...]:
        return (A - 2 * B) / (2 * s), (B - 3 * C) / (2 * s)

    s = np.sum(w * w, axis=-1)
    others = (x[..., 0, 0] for x in (A, B, C))
    return _chosen(s, lambda s: (_slope(s, 2), _slope(s, 3)), closed, *others)


def _chosen(
    s: np.ndarray,
    series: Callable[[np.ndarray], tuple[np.ndarray, ...]],
    closed: Callable[..., tuple[np.ndarray, ...]],
    *others: np.ndarray,
) -> tuple[np.ndarray, ...]:
    """Series where s = θ² is small and closed forms elsewhere, shaped to multiply matrices."""
    small = s < _SERIES_BELOW
    near, far = series(s[small]), closed(*(x[~small] for x in (s, *others)))
    found = []
    for part, rest in zip(near, far, strict=True):
        whole = np.empty(s.shape, LongDouble)
        whole[small], whole[~small] = part, rest
        found.append(whole[..., None, None])
    return tuple(found)


def _series(s: np.ndarray, first: int) -> np.ndarray:
    """Σ (-s)^k / (2k + first)!."""
    total = np.zeros_like(s)
    for k in range(_TERMS, -1, -1):
        total = 1 / LongDouble(math.factorial(2 * k + first)) - s * total
    return total


def _slope(s: np.ndarray, first: int) -> np.ndarray:
    """The derivative of `_series` by s."""
    total = np.zeros_like(s)
    for k in range(_TERMS, 0, -1):
        total = -k / LongDouble(math.factorial(2 * k + first)) - s * total
    return total


def _inverse(X: np.ndarray) -> np.ndarray:
    x, y, z = X[..., 0, :], X[..., 1, :], X[..., 2, :]
    columns = np.stack([np.cross(y, z), np.cross(z, x), np.cross(x, y)], axis=-1)
    return columns / np.sum(x * columns[..., 0], axis=-1)[..., None, None]


def _lower(P: np.ndarray, Q: np.ndarray) -> np.ndarray:
    return np.concatenate(
        [np.concatenate([P, np.zeros_like(P)], -1), np.concatenate([Q, P], -1)], -2
    )


def _norm(x: np.ndarray) -> np.ndarray:
    return np.sqrt(np.sum(x * x, axis=-1))
