"""SE(3), the poses, over arrays.

A pose T_ab (..., 4, 4) takes points from frame b to frame a: p_a = T_ab p_b. A twist xi = (omega;
v) (..., 6) has its angular part first: rad and m. Leading axes are the batch. NaN in an element
gives NaN in that element of the result.
u = 2^-53 below.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ..engine.kernels import group_kernels
from ..errors import BranchError, ShapeError
from . import so3
from .arrays import (
    Array,
    element_name,
    map_kernel,
    numbers,
    poses,
    rotations,
    shaped,
    with_rows,
)

__all__ = [
    "ad",
    "adjoint",
    "exp",
    "hat",
    "inverse",
    "left_jacobian",
    "left_jacobian_inverse",
    "linear_first",
    "log",
    "pose",
    "right_jacobian",
    "right_jacobian_inverse",
    "vee",
]


def pose(R: ArrayLike, p: ArrayLike) -> Array:
    """Pose T = [R p; 0 1] of a rotation and a translation.

    Parameters
    ----------
    R : (..., 3, 3) array_like
        Rotation R_ab, orthonormal to 1e-5.
    p : (..., 3) array_like
        Origin of frame b in frame a, m; broadcast against R.

    Returns
    -------
    T : (..., 4, 4) ndarray
        Pose T_ab: p_a = T_ab p_b.

    Raises
    ------
    PoseError
        If R is no rotation.
    ShapeError
        If R or p has another shape, or one does not broadcast against the other.
    InputError
        If R or p holds anything but real numbers.

    Notes
    -----
    Accuracy: exact, R and p are copied. Source: Park 1994, Section II.

    Examples
    --------
    >>> import poekin as pk
    >>> T = pk.se3.pose([[0, -1, 0], [1, 0, 0], [0, 0, 1]], [0.1, 0.2, 0.3])
    >>> T @ [1.0, 0.0, 0.0, 1.0]
    array([0.1, 1.2, 0.3, 1. ])
    """
    rotation, translation = with_rows(rotations(R), p, 3, "p")
    T = np.zeros((*translation.shape[:-1], 4, 4))
    T[..., :3, :3] = rotation
    T[..., :3, 3] = translation
    T[..., 3, 3] = 1.0
    return T


def hat(xi: ArrayLike) -> Array:
    """The 4x4 matrix [xi] = [[omega] v; 0 0].

    Parameters: xi (..., 6). Returns: (..., 4, 4). Raises: ShapeError, InputError. Accuracy: exact.
    Source: Park 1994, Section II.
    """
    xi = shaped(xi, (6,), "xi")
    X = np.zeros((*xi.shape[:-1], 4, 4))
    X[..., :3, :3] = so3.hat(xi[..., :3])
    X[..., :3, 3] = xi[..., 3:]
    return X


def vee(X: ArrayLike) -> Array:
    """The twist xi with [xi] = X, inverse of `hat`.

    Parameters: X (..., 4, 4); of its 3x3 corner the skew-symmetric part counts. Returns: (..., 6).
    Raises: ShapeError, InputError. Accuracy: one rounding; exact for `hat`'s result. Source: Park
    1994, Section II.
    """
    X = shaped(X, (4, 4), "X")
    return np.concatenate([so3.vee(X[..., :3, :3]), X[..., :3, 3]], axis=-1)


def exp(xi: ArrayLike) -> Array:
    """T = exp [xi]: the screw motion along the twist xi for one unit of time.

    Parameters: xi (..., 6). Returns: T (..., 4, 4). Raises: ShapeError, InputError.
    Accuracy: rotation within 3 u (1 + sqrt(2) theta) in the Frobenius norm, translation p within
    3 u (|p| + |v| + theta |dp/domega|), theta = |omega| <= 10 (tests/groups/test_accuracy.py).
    Source: Park 1994, Lemma 2 for any |omega|.
    """
    return map_kernel(group_kernels.se3_exp, 1, (4, 4), shaped(xi, (6,), "xi"))


def log(T: ArrayLike, near: ArrayLike | None = None) -> Array:
    """The twist xi with exp [xi] = T.

    On the principal branch 0 <= |omega| <= pi; at pi the component of omega of largest magnitude is
    positive. With `near` (a twist, of which omega counts) the xi whose omega is closest to it, of
    all omega + 2 pi k omega/|omega|.

    Parameters: T (..., 4, 4), poses to 1e-5 (a larger defect is refused; a smaller one enters
    squared);
    near (..., 6), broadcast against T. Returns: xi (..., 6), rad and m.
    Raises: PoseError, ShapeError, InputError; BranchError where the branch asked for has no
    logarithm, that is
    |omega| = 2 pi k, k != 0, and a translation that is not along omega.
    Accuracy: omega as `so3.log`; v within 3 u (|v| + k |p| + theta |dv/domega|), k =
    (theta/2)/sin(theta/2) (tests/groups/test_accuracy.py). Source: Park 1994, Lemma 4 and Remark 1,
    through the quaternion.
    """
    T = poses(T)
    if near is None:
        return map_kernel(group_kernels.se3_log, 2, (6,), T)
    T, rows = with_rows(T, near, 6, "near")
    xi = map_kernel(group_kernels.se3_log_near, 2, (6,), T, rows)
    no_v = np.isnan(xi[..., 3:]).any(-1)
    finite = np.isfinite(T).all((-1, -2)) & np.isfinite(xi[..., :3]).all(-1)
    without_log = np.argwhere(no_v & finite)
    if len(without_log):
        index = tuple(without_log[0])
        raise BranchError(
            f"{element_name('T', index)} has no logarithm near omega = {rows[index][:3].tolist()}:"
            " at |omega| = 2 pi k, k != 0, only a translation along omega has one,"
            f" got p = {T[index][:3, 3].tolist()}"
        )
    return xi


def inverse(T_ab: ArrayLike) -> Array:
    """T_ba = (R^T, -R^T p).

    Parameters: T_ab (..., 4, 4). Returns: (..., 4, 4). Raises: PoseError, ShapeError, InputError.
    Accuracy: rotation exact, translation within 3 u |p|. Source: Park 1994, Section II.
    """
    return map_kernel(group_kernels.se3_inverse, 2, (4, 4), poses(T_ab))


def adjoint(T_ab: ArrayLike) -> Array:
    """Ad(T_ab) = [R 0; [p] R R]: V_a = Ad(T_ab) V_b of twists (omega; v).

    Parameters: T_ab (..., 4, 4). Returns: (..., 6, 6). Raises: PoseError, ShapeError, InputError.
    Accuracy: within 2 u |p| in each entry. Source: Park 1994, eq. (3).
    """
    return map_kernel(group_kernels.se3_adjoint, 2, (6, 6), poses(T_ab))


def ad(xi: ArrayLike) -> Array:
    """ad(xi) = [[omega] 0; [v] [omega]], the bracket of se(3): ad(xi) eta = vee([xi][eta] -
    [eta][xi]).

    Parameters: xi (..., 6). Returns: (..., 6, 6). Raises: ShapeError, InputError. Accuracy: exact.
    Source: Park 1994, Section II.
    """
    xi = shaped(xi, (6,), "xi")
    matrix = np.zeros((*xi.shape, 6))
    matrix[..., :3, :3] = matrix[..., 3:, 3:] = so3.hat(xi[..., :3])
    matrix[..., 3:, :3] = so3.hat(xi[..., 3:])
    return matrix


def left_jacobian(xi: ArrayLike) -> Array:
    """J(xi) with exp[xi + dxi] = exp[J dxi] exp[xi] to first order: [J(omega) 0; Q J(omega)].

    Parameters: xi (..., 6). Returns: (..., 6, 6). Raises: ShapeError, InputError.
    Accuracy: for |omega| <= 10 the 3x3 blocks within 1e-15, Q within 1e-15 |v|, Frobenius
    (tests/groups/test_accuracy.py). Source: Park 1994, Lemma 5; Q is the dual part of J(omega + eps
    v).
    """
    return map_kernel(group_kernels.se3_left, 1, (6, 6), shaped(xi, (6,), "xi"))


def right_jacobian(xi: ArrayLike) -> Array:
    """J_r(xi) with exp[xi + dxi] = exp[xi] exp[J_r dxi] to first order: J_r(xi) = J(-xi).

    Parameters, returns, errors, accuracy and source: those of `left_jacobian`.
    """
    return left_jacobian(-numbers(xi, "xi"))


def left_jacobian_inverse(xi: ArrayLike) -> Array:
    """J(xi)^-1, for |omega| < 2 pi.

    Parameters: xi (..., 6). Returns: (..., 6, 6). Raises: ShapeError, InputError.
    Accuracy: for |omega| <= pi as `left_jacobian`; J is singular at 2 pi.
    Source: Park 1994, Lemma 4; its lower left block is the dual part of J(omega + eps v)^-1.
    """
    return map_kernel(group_kernels.se3_left_inverse, 1, (6, 6), shaped(xi, (6,), "xi"))


def right_jacobian_inverse(xi: ArrayLike) -> Array:
    """J_r(xi)^-1 = J(-xi)^-1.

    Parameters, returns, errors, accuracy and source: those of `left_jacobian_inverse`.
    """
    return left_jacobian_inverse(-numbers(xi, "xi"))


def linear_first(x: ArrayLike, axis: int = -1) -> Array:
    """The one permutation between (omega; v) and (v; omega): swaps the two halves of an axis of
    length 6.

    It is its own inverse. Rows of a Jacobian: axis=-2; both axes of a 6x6 matrix: apply it twice.

    Parameters: x, an array of any shape with x.shape[axis] == 6; axis. Returns: the same shape.
    Raises: ShapeError, InputError. Accuracy: exact.
    Source: Pinocchio and Robotics Toolbox write (v; omega); see the README.
    """
    x = numbers(x, "x")
    if not -x.ndim <= axis < x.ndim or x.shape[axis] != 6:
        raise ShapeError(f"x: expected length 6 along axis {axis}, got shape {x.shape}")
    return np.roll(x, 3, axis)
