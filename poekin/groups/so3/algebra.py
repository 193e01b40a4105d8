"""Rotations and vectors as matrices: hat, vee, inverse and the two adjoints."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array, rotations, shaped

CYCLIC = ((0, 1, 2), (1, 2, 0), (2, 0, 1))


def hat(w: ArrayLike) -> Array:
    """Skew-symmetric matrix [w] with [w] x = w × x (cross product).

    Parameters
    ----------
    w : (..., 3) array_like
        Vector, in rad or any other unit.

    Returns
    -------
    W : (..., 3, 3) ndarray
        Matrix [w] = [0 -w3 w2; w3 0 -w1; -w2 w1 0].

    Raises
    ------
    ShapeError
        If the last axis of w is not 3.
    InputError
        If w holds anything but real numbers.

    Notes
    -----
    Accuracy: exact. Source: Park 1994, Section II.

    Examples
    --------
    >>> import poekin as pk
    >>> pk.so3.hat([1, 2, 3]) @ [0.0, 0.0, 1.0]
    array([ 2., -1.,  0.])
    """
    w = shaped(w, (3,), "w")
    W = np.zeros((*w.shape, 3))
    for i, j, k in CYCLIC:
        W[..., k, j] = w[..., i]
        W[..., j, k] = -w[..., i]
    return W


def vee(W: ArrayLike) -> Array:
    """Vector w with [w] = W, inverse of `hat`.

    Parameters
    ----------
    W : (..., 3, 3) array_like
        Skew-symmetric matrix; of any other matrix the skew-symmetric part counts.

    Returns
    -------
    w : (..., 3) ndarray
        Vector, in the unit of W.

    Raises
    ------
    ShapeError
        If the last axes of W are not (3, 3).
    InputError
        If W holds anything but real numbers.

    Notes
    -----
    Accuracy: one rounding; exact for the result of `hat`. Source: Park 1994, Section II.
    """
    W = shaped(W, (3, 3), "W")
    w = np.empty(W.shape[:-1])
    for i, j, k in CYCLIC:
        w[..., i] = 0.5 * (W[..., k, j] - W[..., j, k])
    return w


def inverse(R_ab: ArrayLike) -> Array:
    """Inverse rotation R_ba = R_abᵀ.

    Parameters
    ----------
    R_ab : (..., 3, 3) array_like
        Rotation of frame b in frame a, orthonormal to 1e-5.

    Returns
    -------
    R_ba : (..., 3, 3) ndarray
        Rotation of frame a in frame b.

    Raises
    ------
    PoseError
        If R_ab is no rotation.
    ShapeError
        If the last axes of R_ab are not (3, 3).
    InputError
        If R_ab holds anything but real numbers.

    Notes
    -----
    Accuracy: exact. Source: Park 1994, Section II.
    """
    return np.swapaxes(rotations(R_ab), -1, -2).copy()


def adjoint(R_ab: ArrayLike) -> Array:
    """Adjoint of a rotation, [Ad(R) w] = R [w] Rᵀ: R itself.

    Parameters
    ----------
    R_ab : (..., 3, 3) array_like
        Rotation of frame b in frame a, orthonormal to 1e-5.

    Returns
    -------
    Ad : (..., 3, 3) ndarray
        Matrix that takes rotation vectors from frame b to frame a.

    Raises
    ------
    PoseError
        If R_ab is no rotation.
    ShapeError
        If the last axes of R_ab are not (3, 3).
    InputError
        If R_ab holds anything but real numbers.

    Notes
    -----
    Accuracy: exact. Source: Park 1994, Section II.
    """
    return rotations(R_ab).copy()


def ad(w: ArrayLike) -> Array:
    """Bracket of so(3) as a matrix, ad(w) x = w × x: `hat` itself.

    Parameters
    ----------
    w : (..., 3) array_like
        Vector, in rad or any other unit.

    Returns
    -------
    W : (..., 3, 3) ndarray
        Matrix [w].

    Raises
    ------
    ShapeError
        If the last axis of w is not 3.
    InputError
        If w holds anything but real numbers.

    Notes
    -----
    Accuracy: exact. Source: Park 1994, Section II.
    """
    return hat(w)
