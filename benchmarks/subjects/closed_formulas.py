"""The textbooks' closed formulas of SO(3) and SE(3), evaluated with so many digits that nothing
cancels.

log is by the largest eigenvector of a symmetric 4×4. Nothing is shared with
`poekin.testing.oracles.exact`, which is made of series towards 0 and Newton's method.
"""

from __future__ import annotations

import math
from typing import Any

import mpmath
import numpy as np

mp: Any = mpmath.mp.clone()
DIGITS = 60

_to_mpf = np.frompyfunc(mp.mpf, 1, 1)


def numbers(x: Any) -> np.ndarray:
    """Floats as mpmath numbers."""
    return np.asarray(_to_mpf(np.asarray(x)), dtype=object)


def floats(x: np.ndarray) -> np.ndarray:
    """The nearest floats."""
    return np.asarray(np.frompyfunc(float, 1, 1)(x), dtype=float)


def hat(w: np.ndarray) -> np.ndarray:
    """[w]."""
    x, y, z = w
    nought = mp.mpf(0)
    return np.array([[nought, -z, y], [z, nought, -x], [-y, x, nought]], dtype=object)


def eye(n: int) -> np.ndarray:
    """The identity."""
    return numbers(np.eye(n))


def precision(w: Any) -> Any:
    """So many digits that θ^-5 times a difference of terms near 1 keeps DIGITS of them."""
    largest = max(abs(float(x)) for x in w)
    return mp.workdps(DIGITS + (6 * max(0, -math.floor(math.log10(largest))) if largest else 0))


def rotation(w: np.ndarray) -> np.ndarray:
    """Rodrigues' formula."""
    theta = mp.sqrt(w @ w)
    if theta == 0:
        return eye(3)
    W = hat(w / theta)
    return eye(3) + mp.sin(theta) * W + (1 - mp.cos(theta)) * (W @ W)


def P(w: np.ndarray) -> np.ndarray:
    """The left Jacobian of SO(3), in closed form."""
    theta = mp.sqrt(w @ w)
    if theta == 0:
        return eye(3)
    W = hat(w / theta)
    return eye(3) + (1 - mp.cos(theta)) / theta * W + (1 - mp.sin(theta) / theta) * (W @ W)


def P_inverse(w: np.ndarray) -> np.ndarray:
    """Its inverse, in closed form."""
    theta = mp.sqrt(w @ w)
    if theta == 0:
        return eye(3)
    W = hat(w / theta)
    return eye(3) - theta / 2 * W + (1 - theta / 2 * mp.cot(theta / 2)) * (W @ W)


def Q(w: np.ndarray, v: np.ndarray) -> np.ndarray:
    """The lower block of the left Jacobian of SE(3), in closed form (Barfoot, State Estimation for
    Robotics).
    """
    theta, W, V = mp.sqrt(w @ w), hat(w), hat(v)
    if theta == 0:
        return V / 2
    s, c, t2 = mp.sin(theta), mp.cos(theta), theta**2
    first, second = (theta - s) / theta**3, (1 - t2 / 2 - c) / t2**2
    third = (second - 3 * (theta - s - theta**3 / 6) / theta**5) / 2
    WV, VW = W @ V, V @ W
    WVW = W @ VW
    Q = V / 2 + first * (WV + VW + WVW) - second * (W @ WV + VW @ W - 3 * WVW)
    return Q - third * (WVW @ W + W @ WVW)


def lower(P: np.ndarray, Q: np.ndarray) -> np.ndarray:
    """[P 0; Q P]."""
    return np.block([[P, numbers(np.zeros((3, 3)))], [Q, P]])


def pose(R: np.ndarray, t: np.ndarray) -> np.ndarray:
    """[R t; 0 1]."""
    T = eye(4)
    T[:3, :3], T[:3, 3] = R, t
    return T


def exp(xi: np.ndarray) -> np.ndarray:
    """e^ξ."""
    return pose(rotation(xi[:3]), P(xi[:3]) @ xi[3:])


def rotation_vector(R: np.ndarray) -> np.ndarray:
    """ω of the rotation nearest to R: the quaternion is the eigenvector of the largest eigenvalue
    (Horn 1987).
    """
    a = R.T.ravel()  # by columns
    xx, yx, zx, xy, yy, zy, xz, yz, zz = a
    K = [
        [xx + yy + zz, zy - yz, xz - zx, yx - xy],
        [zy - yz, xx - yy - zz, xy + yx, xz + zx],
        [xz - zx, xy + yx, yy - xx - zz, yz + zy],
        [yx - xy, xz + zx, yz + zy, zz - xx - yy],
    ]
    values, vectors = mp.eigsy(mp.matrix(K))
    q = np.array(list(vectors[:, max(range(4), key=lambda k: values[k])]), dtype=object)
    q = -q if q[0] < 0 else q
    sine = mp.sqrt(q[1:] @ q[1:])
    return q[1:] * 0 if sine == 0 else q[1:] / sine * (2 * mp.atan2(sine, q[0]))


def skew_size(R: np.ndarray) -> np.ndarray:
    """The entries of R - Rᵀ: how small the rotation is, or how near π."""
    skew = np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]], dtype=float)
    return skew if np.any(skew) else np.ones(3)


def moved(screws: np.ndarray, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The product of exponentials and the space Jacobian."""
    T, columns = eye(4), []
    for S, x in zip(screws, q, strict=True):
        R, t = T[:3, :3], T[:3, 3]
        columns.append(lower(R, hat(t) @ R) @ S)
        T = T @ exp(S * x)
    return T, np.array(columns, dtype=object).reshape(-1, 6).T
