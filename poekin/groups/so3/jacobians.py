"""Left and right Jacobians of exp on SO(3), and their inverses."""

from __future__ import annotations

from numpy.typing import ArrayLike

from ...engine.kernels import group_kernels
from ..arrays import Array, map_kernel, numbers, shaped


def left_jacobian(w: ArrayLike) -> Array:
    """Left Jacobian of exp, exp[w + dw] = exp[J(w) dw] exp[w] to first order.

    Parameters
    ----------
    w : (..., 3) array_like
        Rotation vector, rad.

    Returns
    -------
    J : (..., 3, 3) ndarray
        Matrix J(w) = I + B [w] + C [w]².

    Raises
    ------
    ShapeError
        If the last axis of w is not 3.
    InputError
        If w holds anything but real numbers.

    Notes
    -----
    Accuracy: Frobenius error at most 1e-15 for |w| ≤ 10, held by tests/groups/test_accuracy.py.
    Source: Park 1994, Lemma 5.

    Examples
    --------
    Angular velocity in the fixed frame, of a rotation vector that changes at a rate:

    >>> import poekin as pk
    >>> w, rate = [0.3, 0, 0], [1.0, 0, 0]
    >>> print(pk.so3.left_jacobian(w) @ rate)
    [1. 0. 0.]
    """
    return map_kernel(group_kernels.so3_left, 1, (3, 3), shaped(w, (3,), "w"))


def right_jacobian(w: ArrayLike) -> Array:
    """Right Jacobian of exp, exp[w + dw] = exp[w] exp[J_r(w) dw] to first order.

    Parameters
    ----------
    w : (..., 3) array_like
        Rotation vector, rad.

    Returns
    -------
    J_r : (..., 3, 3) ndarray
        Matrix J_r(w) = J(-w) = J(w)ᵀ of `left_jacobian`.

    Raises
    ------
    ShapeError
        If the last axis of w is not 3.
    InputError
        If w holds anything but real numbers.

    Notes
    -----
    Accuracy: that of `left_jacobian`. Source: Park 1994, Lemma 5.
    """
    return left_jacobian(-numbers(w, "w"))


def left_jacobian_inverse(w: ArrayLike) -> Array:
    """Inverse of the left Jacobian of exp, for |w| < 2π.

    Parameters
    ----------
    w : (..., 3) array_like
        Rotation vector, rad; J is singular at |w| = 2π.

    Returns
    -------
    J_inverse : (..., 3, 3) ndarray
        Matrix J(w)⁻¹ = I - [w]/2 + D [w]².

    Raises
    ------
    ShapeError
        If the last axis of w is not 3.
    InputError
        If w holds anything but real numbers.

    Notes
    -----
    Accuracy: Frobenius error at most 1e-15 for |w| ≤ π, held by tests/groups/test_accuracy.py.
    Source: Park 1994, Lemma 4.
    """
    return map_kernel(group_kernels.so3_left_inverse, 1, (3, 3), shaped(w, (3,), "w"))


def right_jacobian_inverse(w: ArrayLike) -> Array:
    """Inverse of the right Jacobian of exp, for |w| < 2π.

    Parameters
    ----------
    w : (..., 3) array_like
        Rotation vector, rad; J_r is singular at |w| = 2π.

    Returns
    -------
    J_r_inverse : (..., 3, 3) ndarray
        Matrix J_r(w)⁻¹ = J(-w)⁻¹.

    Raises
    ------
    ShapeError
        If the last axis of w is not 3.
    InputError
        If w holds anything but real numbers.

    Notes
    -----
    Accuracy: that of `left_jacobian_inverse`. Source: Park 1994, Lemma 4.
    """
    return left_jacobian_inverse(-numbers(w, "w"))
