"""SO(3), the rotations, over arrays.

A rotation R_ab (..., 3, 3) takes vectors from frame b to frame a. A rotation vector w (..., 3) is
axis times angle, in rad. Leading axes are the batch. NaN in an element gives NaN in that element of
the result. u = 2^-53 below.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ..engine.kernels import group_kernels
from .arrays import Array, map_kernel, numbers, rotations, shaped, with_rows

__all__ = [
    "ad",
    "adjoint",
    "exp",
    "hat",
    "inverse",
    "left_jacobian",
    "left_jacobian_inverse",
    "log",
    "right_jacobian",
    "right_jacobian_inverse",
    "vee",
]

CYCLIC = ((0, 1, 2), (1, 2, 0), (2, 0, 1))


def hat(w: ArrayLike) -> Array:
    """The skew-symmetric matrix [w] with [w] x = w x x (cross product).

    Parameters: w (..., 3). Returns: (..., 3, 3). Raises: ShapeError, InputError. Accuracy: exact.
    Source: Park 1994, Section II.
    """
    w = shaped(w, (3,), "w")
    W = np.zeros((*w.shape, 3))
    for i, j, k in CYCLIC:
        W[..., k, j] = w[..., i]
        W[..., j, k] = -w[..., i]
    return W


def vee(W: ArrayLike) -> Array:
    """The vector w with [w] = W, inverse of `hat`.

    Parameters: W (..., 3, 3); of a matrix that is not skew-symmetric the skew-symmetric part
    counts.
    Returns: (..., 3). Raises: ShapeError, InputError. Accuracy: one rounding; exact for `hat`'s
    result.
    Source: Park 1994, Section II.
    """
    W = shaped(W, (3, 3), "W")
    w = np.empty(W.shape[:-1])
    for i, j, k in CYCLIC:
        w[..., i] = 0.5 * (W[..., k, j] - W[..., j, k])
    return w


def exp(w: ArrayLike) -> Array:
    """R = exp [w] = I + A [w] + B [w]^2, the rotation by |w| about w.

    Parameters: w (..., 3), rad. Returns: R (..., 3, 3). Raises: ShapeError, InputError.
    Accuracy: Frobenius error at most 3 u (1 + sqrt(2) theta) for theta = |w| <= 10
    (tests/groups/test_accuracy.py). Source: Park 1994, Lemma 1.
    """
    return map_kernel(group_kernels.so3_exp, 1, (3, 3), shaped(w, (3,), "w"))


def log(R: ArrayLike, near: ArrayLike | None = None) -> Array:
    """The rotation vector w with exp [w] = R.

    On the principal branch 0 <= |w| <= pi; at |w| = pi, where w and -w both serve, the component of
    largest magnitude is positive. With `near`, of all w + 2 pi k w/|w| the one closest to `near`.

    Parameters: R (..., 3, 3), rotations to 1e-5 (a larger defect is refused; a smaller one enters
    squared);
    near (..., 3), rad, broadcast against R. Returns: w (..., 3), rad. Raises: PoseError,
    ShapeError, InputError. Accuracy: relative error at most 3 u (1 + 1.22 k min(1, 1/theta)), k =
    (theta/2)/sin(theta/2) (tests/groups/test_accuracy.py). Source: Park 1994, Lemma 3 and Remark 1,
    through the quaternion.
    """
    R = rotations(R)
    if near is None:
        return map_kernel(group_kernels.so3_log, 2, (3,), R)
    R, rows = with_rows(R, near, 3, "near")
    return map_kernel(group_kernels.so3_log_near, 2, (3,), R, rows)


def inverse(R_ab: ArrayLike) -> Array:
    """R_ba = R_ab^T.

    Parameters: R_ab (..., 3, 3). Returns: (..., 3, 3). Raises: PoseError, ShapeError, InputError.
    Accuracy: exact. Source: Park 1994, Section II.
    """
    return np.swapaxes(rotations(R_ab), -1, -2).copy()


def adjoint(R_ab: ArrayLike) -> Array:
    """Ad(R_ab) with [Ad(R) w] = R [w] R^T: R itself.

    Parameters: R_ab (..., 3, 3). Returns: (..., 3, 3). Raises: PoseError, ShapeError, InputError.
    Accuracy: exact. Source: Park 1994, Section II.
    """
    return rotations(R_ab).copy()


def ad(w: ArrayLike) -> Array:
    """ad(w) with ad(w) x = w x x (cross product), the bracket of so(3): `hat` itself.

    Parameters: w (..., 3). Returns: (..., 3, 3). Raises: ShapeError, InputError. Accuracy: exact.
    Source: Park 1994, Section II.
    """
    return hat(w)


def left_jacobian(w: ArrayLike) -> Array:
    """J(w) with exp[w + dw] = exp[J dw] exp[w] to first order: J = I + B [w] + C [w]^2.

    Parameters: w (..., 3), rad. Returns: (..., 3, 3). Raises: ShapeError, InputError.
    Accuracy: Frobenius error at most 1e-15 for |w| <= 10 (tests/groups/test_accuracy.py).
    Source: Park 1994, Lemma 5.
    """
    return map_kernel(group_kernels.so3_left, 1, (3, 3), shaped(w, (3,), "w"))


def right_jacobian(w: ArrayLike) -> Array:
    """J_r(w) with exp[w + dw] = exp[w] exp[J_r dw] to first order: J_r(w) = J(-w) = J(w)^T.

    Parameters, returns, errors, accuracy and source: those of `left_jacobian`.
    """
    return left_jacobian(-numbers(w, "w"))


def left_jacobian_inverse(w: ArrayLike) -> Array:
    """J(w)^-1 = I - [w]/2 + D [w]^2, for |w| < 2 pi.

    Parameters: w (..., 3), rad. Returns: (..., 3, 3). Raises: ShapeError, InputError.
    Accuracy: Frobenius error at most 1e-15 for |w| <= pi (tests/groups/test_accuracy.py); J is
    singular at 2 pi. Source: Park 1994, Lemma 4.
    """
    return map_kernel(group_kernels.so3_left_inverse, 1, (3, 3), shaped(w, (3,), "w"))


def right_jacobian_inverse(w: ArrayLike) -> Array:
    """J_r(w)^-1 = J(-w)^-1.

    Parameters, returns, errors, accuracy and source: those of `left_jacobian_inverse`.
    """
    return left_jacobian_inverse(-numbers(w, "w"))
