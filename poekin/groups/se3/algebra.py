"""Poses and twists as matrices: pose, hat, vee, inverse, the two adjoints, and the twist's order."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ...engine.kernels import group_kernels
from ...errors import ShapeError
from .. import so3
from ..arrays import Array, map_kernel, numbers, poses, rotations, shaped, with_rows


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
    """Matrix [xi] = [[ω] v; 0 0] of a twist.

    Parameters
    ----------
    xi : (..., 6) array_like
        Twist (ω; v), rad and m.

    Returns
    -------
    X : (..., 4, 4) ndarray
        Matrix [xi], an element of se(3).

    Raises
    ------
    ShapeError
        If the last axis of xi is not 6.
    InputError
        If xi holds anything but real numbers.

    Notes
    -----
    Accuracy: exact. Source: Park 1994, Section II.
    """
    xi = shaped(xi, (6,), "xi")
    X = np.zeros((*xi.shape[:-1], 4, 4))
    X[..., :3, :3] = so3.hat(xi[..., :3])
    X[..., :3, 3] = xi[..., 3:]
    return X


def vee(X: ArrayLike) -> Array:
    """Twist xi with [xi] = X, inverse of `hat`.

    Parameters
    ----------
    X : (..., 4, 4) array_like
        Matrix [xi]; of its 3x3 corner the skew-symmetric part counts, and its last row does not.

    Returns
    -------
    xi : (..., 6) ndarray
        Twist (ω; v), rad and m.

    Raises
    ------
    ShapeError
        If the last axes of X are not (4, 4).
    InputError
        If X holds anything but real numbers.

    Notes
    -----
    Accuracy: one rounding; exact for the result of `hat`. Source: Park 1994, Section II.
    """
    X = shaped(X, (4, 4), "X")
    return np.concatenate(
        [
            so3.vee(X[..., :3, :3]),
            X[..., :3, 3],
        ],
        axis=-1,
    )


def inverse(T_ab: ArrayLike) -> Array:
    """Inverse pose T_ba = [Rᵀ -Rᵀp; 0 1].

    Parameters
    ----------
    T_ab : (..., 4, 4) array_like
        Pose of frame b in frame a, its rotation orthonormal to 1e-5.

    Returns
    -------
    T_ba : (..., 4, 4) ndarray
        Pose of frame a in frame b, lengths in m.

    Raises
    ------
    PoseError
        If T_ab is no pose.
    ShapeError
        If the last axes of T_ab are not (4, 4).
    InputError
        If T_ab holds anything but real numbers.

    Notes
    -----
    Accuracy: rotation exact, translation within 3 u |p|. Source: Park 1994, Section II.

    Examples
    --------
    >>> import numpy as np
    >>> import poekin as pk
    >>> T_ab = pk.se3.exp([0.1, 0.2, 0.3, 1, 2, 3])
    >>> bool(np.allclose(pk.se3.inverse(T_ab) @ T_ab, np.eye(4)))
    True
    """
    return map_kernel(group_kernels.se3_inverse, 2, (4, 4), poses(T_ab))


def adjoint(T_ab: ArrayLike) -> Array:
    """Adjoint of a pose, V_a = Ad(T_ab) V_b of twists (ω; v).

    Parameters
    ----------
    T_ab : (..., 4, 4) array_like
        Pose of frame b in frame a, its rotation orthonormal to 1e-5.

    Returns
    -------
    Ad : (..., 6, 6) ndarray
        Matrix [R 0; [p] R R], lengths in m.

    Raises
    ------
    PoseError
        If T_ab is no pose.
    ShapeError
        If the last axes of T_ab are not (4, 4).
    InputError
        If T_ab holds anything but real numbers.

    Notes
    -----
    Accuracy: within 2 u |p| in each entry. Source: Park 1994, eq. (3).

    Examples
    --------
    Twist of a turn about the z axis of frame b, seen from frame a:

    >>> import numpy as np
    >>> import poekin as pk
    >>> T_ab = pk.se3.pose(np.eye(3), [1, 0, 0])
    >>> print(pk.se3.adjoint(T_ab) @ [0, 0, 1, 0, 0, 0] + 0.0)
    [ 0.  0.  1.  0. -1.  0.]
    """
    return map_kernel(group_kernels.se3_adjoint, 2, (6, 6), poses(T_ab))


def ad(xi: ArrayLike) -> Array:
    """Bracket of se(3) as a matrix, [ad(xi) eta] = [xi][eta] - [eta][xi].

    Parameters
    ----------
    xi : (..., 6) array_like
        Twist (ω; v), rad and m.

    Returns
    -------
    ad : (..., 6, 6) ndarray
        Matrix [[ω] 0; [v] [ω]].

    Raises
    ------
    ShapeError
        If the last axis of xi is not 6.
    InputError
        If xi holds anything but real numbers.

    Notes
    -----
    Accuracy: exact. Source: Park 1994, Section II.
    """
    xi = shaped(xi, (6,), "xi")
    matrix = np.zeros((*xi.shape, 6))
    matrix[..., :3, :3] = matrix[..., 3:, 3:] = so3.hat(xi[..., :3])
    matrix[..., 3:, :3] = so3.hat(xi[..., 3:])
    return matrix


def linear_first(x: ArrayLike, axis: int = -1) -> Array:
    """Permutation between (ω; v) and (v; ω): the two halves of an axis are swapped.

    It is its own inverse. Rows of a Jacobian need axis=-2, both axes of a 6x6 matrix two calls.

    Parameters
    ----------
    x : (...) array_like
        Array of any shape with x.shape[axis] == 6, rad and m.
    axis : int, default -1
        Axis of the six numbers.

    Returns
    -------
    y : (...) ndarray
        Array of the same shape, a copy.

    Raises
    ------
    ShapeError
        If x has no such axis, or its length is not 6.
    InputError
        If x holds anything but real numbers.

    Notes
    -----
    Pinocchio, Robotics Toolbox and MuJoCo write twists as (v; ω).

    Accuracy: exact. Source: the order of twists in Park 1994, Section II.

    Examples
    --------
    >>> import poekin as pk
    >>> print(pk.se3.linear_first([1, 2, 3, 4, 5, 6]))
    [4. 5. 6. 1. 2. 3.]
    """
    x = numbers(x, "x")
    if not -x.ndim <= axis < x.ndim or x.shape[axis] != 6:
        raise ShapeError(f"x: expected length 6 along axis {axis}, got shape {x.shape}")
    return np.roll(x, 3, axis)
