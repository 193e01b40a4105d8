"""The second oracle: whether the truth that a finding was judged by stands against mpmath's own
matrix exponential.

No formula of `exact` is used: exp is mpmath's `expm`, which squares and sums; the Jacobians of exp
are blocks of the exponential of a larger matrix; derivatives of an arm are differences; log is
judged by its exponential. To 60 digits, in proportion to what is compared.
"""

from __future__ import annotations

import functools
from collections.abc import Sequence
from typing import Any

import numpy as np

from ..oracles import exact

_mp: Any = exact.mp.clone()
_mp.dps = 100
AGREE = 1e-60


def of_exp(xi: np.ndarray) -> bool:
    """Whether `exact.exp` of ω (3,) or (ω; v) (6,) is mpmath's."""
    return is_exp(xi, exact.exp(xi))


def is_exp(
    xi: np.ndarray,
    truth: np.ndarray,
) -> bool:
    """Whether a matrix is mpmath's exponential of ω (3,) or (ω; v) (6,)."""
    return near(_expm(tuple(xi)), truth)


def of_log(X: np.ndarray) -> bool:
    """Whether `is_log` holds of `exact.log` X."""
    return is_log(X, exact.log(X))


def is_log(
    X: np.ndarray,
    truth: np.ndarray,
) -> bool:
    """Whether e^truth has X's translation and X's polar factor P for rotation, |ω| ≤ π.

    P is the polar factor where Pᵀ R is symmetric and P is near R: the other rotations with a
    symmetric Pᵀ R are half turns of P, and some entry is off by 0.94 or more.
    """
    E = _expm(tuple(truth))
    given = _matrix(exact.exactly(X))
    S = E[:3, :3].T * given[:3, :3]
    if not _largest(S - S.T) < AGREE:
        return False
    if not _largest(E[:3, :3] - given[:3, :3]) < 0.5:
        return False
    if len(X) == 4:
        length = max(_largest(given[:3, 3]), _largest(truth[3:]))
        scale = 1 + length
        if not _largest(E[:3, 3] - given[:3, 3]) < AGREE * scale:
            return False
    angle = _mp.norm([_mp.mpf(w) for w in truth[:3]])
    return bool(angle <= _mp.pi + AGREE)


def of_adjoint(
    T: np.ndarray,
    within: float = 1e-14,
) -> bool:
    """Whether T [ξ] = [Ad(T) ξ] T for each unit twist ξ, to 14 digits, or `within`: T is a pose to
    no more.
    """
    X = _matrix(exact.exactly(T))
    Ad = exact.adjoint(T)
    # T's rotation is one only to rounding, and so is the identity.
    scale = 1 + _largest(X)
    twists = zip(np.eye(6), Ad.T, strict=True)
    errors = [_largest(X * _hat(unit) - _hat(carried) * X) for unit, carried in twists]
    return bool(max(errors) < within * scale**2)


def of_jacobian(
    name: str,
    xi: np.ndarray,
) -> bool:
    """Whether a Jacobian of exp of `exact` is ∫ e^{± s ad ξ} ds, 0 ≤ s ≤ 1, or the inverse of that."""
    sign = 1
    if name.startswith("right"):
        sign = -1
    J = _integral(tuple(sign * xi))
    truth = _matrix(getattr(exact, name)(xi))
    scale = 1 + float(np.abs(xi).max())
    if name.endswith("_inverse"):
        return bool(_largest(J * truth - _mp.eye(len(xi))) < AGREE * scale**2)
    return bool(_largest(J - truth) < AGREE * scale)


def of_pose(
    screws: Any,
    home: Any,
    x: Any,
) -> bool:
    """Whether `exact.forward` is the product of mpmath's exponentials."""
    truth = exact.forward(screws, home, x)
    return near(product(screws, home, x), truth)


def of_velocities(
    screws: Any,
    home: Any,
    x: Any,
    columns: np.ndarray,
) -> bool:
    """Whether space twists (6, n) are Ṫ T⁻¹ of the product of exponentials, by a difference of step
    1e-30.
    """
    T = product(screws, home, x)
    step = _mp.mpf(10) ** -30
    back = _mp.inverse(T)
    truth = exact.exactly(columns)
    for k in range(len(x)):
        ahead = product(screws, home, _shifted(x, k, step))
        behind = product(screws, home, _shifted(x, k, -step))
        X = (ahead - behind) / (2 * step) * back
        twist = truth[:, k]
        scale = 1 + _largest(twist)
        if not _largest(X - _hat(twist)) < 1e-50 * scale**2:
            return False
    return True


def product(
    screws: Any,
    home: Any,
    x: Any,
) -> Any:
    """e^{A_1 x_1} ⋯ e^{A_n x_n} M as an mpmath matrix."""
    joints = zip(exact.exactly(screws), exact.exactly(x), strict=True)
    motions = chain_of([screw * amount for screw, amount in joints])
    return motions * _matrix(exact.exactly(home))


def chain_of(factors: Sequence[Any]) -> Any:
    """The product of exponentials of twists (6,), as an mpmath matrix."""
    T = _mp.eye(4)
    for xi in factors:
        T = T * _expm(tuple(xi))
    return T


def _shifted(
    x: Any,
    k: int,
    by: Any,
) -> np.ndarray:
    moved = exact.exactly(x).copy()
    moved[k] = moved[k] + exact.mp.mpf(by)
    return moved


def near(
    X: Any,
    truth: np.ndarray,
) -> bool:
    """Whether an mpmath matrix and an array of `exact` are the same to 60 digits of the largest
    entry.
    """
    other = _matrix(truth)
    scale = 1 + _largest(other)
    return bool(_largest(X - other) < AGREE * scale)


# A difference moves one joint of many, and the links of a tree share most of their joints.
@functools.lru_cache(maxsize=256)
def _expm(xi: tuple[Any, ...]) -> Any:
    return _mp.expm(_hat(xi))


@functools.lru_cache(maxsize=16)
def _integral(xi: tuple[Any, ...]) -> Any:
    """∫ e^{s ad ξ} ds, 0 ≤ s ≤ 1: the upper right block of the exponential of [ad ξ, I; 0, 0]."""
    n = len(xi)
    big = _mp.zeros(2 * n)
    big[:n, :n] = _ad(xi)
    big[:n, n:] = _mp.eye(n)
    return _mp.expm(big)[:n, n:]


def _hat(xi: Any) -> Any:
    x, y, z = (_mp.mpf(c) for c in list(xi)[:3])
    rows = [
        [0, -z, y],
        [z, 0, -x],
        [-y, x, 0],
    ]
    if len(xi) == 6:
        for row, v in zip(rows, list(xi)[3:], strict=True):
            row.append(_mp.mpf(v))
        rows.append([0, 0, 0, 0])
    return _mp.matrix(rows)


def _ad(xi: Any) -> Any:
    if len(xi) == 3:
        return _hat(xi)
    A = _mp.zeros(6)
    A[:3, :3] = A[3:, 3:] = _hat(xi[:3])
    A[3:, :3] = _hat(xi[3:])
    return A


def _matrix(X: np.ndarray) -> Any:
    rows = [[_mp.mpf(x) for x in row] for row in X.tolist()]
    return _mp.matrix(rows)


def _largest(M: Any) -> Any:
    return max(abs(x) for x in M)
