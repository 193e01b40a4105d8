"""Left and right Jacobians of exp on SE(3), and their inverses."""

from __future__ import annotations

from numpy.typing import ArrayLike

from ...engine.kernels import group_kernels
from ..arrays import Array, map_kernel, numbers, shaped


def left_jacobian(xi: ArrayLike) -> Array:
    """Left Jacobian of exp, exp[xi + dxi] = exp[J(xi) dxi] exp[xi] to first order.

    Parameters
    ----------
    xi : (..., 6) array_like
        Twist (ω; v), rad and m.

    Returns
    -------
    J : (..., 6, 6) ndarray
        Matrix J(xi) = [J(ω) 0; Q J(ω)].

    Raises
    ------
    ShapeError
        If the last axis of xi is not 6.
    InputError
        If xi holds anything but real numbers.

    Notes
    -----
    Accuracy: for |ω| ≤ 10 the 3x3 blocks within 1e-15, Q within 1e-15 |v|, Frobenius, held by
    tests/groups/test_accuracy.py. Source: Park 1994, Lemma 5; Q is the dual part of J(ω + ε v).
    """
    return map_kernel(group_kernels.se3_left, 1, (6, 6), shaped(xi, (6,), "xi"))


def right_jacobian(xi: ArrayLike) -> Array:
    """Right Jacobian of exp, exp[xi + dxi] = exp[xi] exp[J_r(xi) dxi] to first order.

    Parameters
    ----------
    xi : (..., 6) array_like
        Twist (ω; v), rad and m.

    Returns
    -------
    J_r : (..., 6, 6) ndarray
        Matrix J_r(xi) = J(-xi) of `left_jacobian`.

    Raises
    ------
    ShapeError
        If the last axis of xi is not 6.
    InputError
        If xi holds anything but real numbers.

    Notes
    -----
    Accuracy: that of `left_jacobian`. Source: Park 1994, Lemma 5.
    """
    return left_jacobian(-numbers(xi, "xi"))


def left_jacobian_inverse(xi: ArrayLike) -> Array:
    """Inverse of the left Jacobian of exp, for |ω| < 2π.

    Parameters
    ----------
    xi : (..., 6) array_like
        Twist (ω; v), rad and m; J is singular at |ω| = 2π.

    Returns
    -------
    J_inverse : (..., 6, 6) ndarray
        Matrix J(xi)⁻¹.

    Raises
    ------
    ShapeError
        If the last axis of xi is not 6.
    InputError
        If xi holds anything but real numbers.

    Notes
    -----
    Accuracy: for |ω| ≤ π that of `left_jacobian`. Source: Park 1994, Lemma 4; the lower left block
    is the dual part of J(ω + ε v)⁻¹.
    """
    return map_kernel(group_kernels.se3_left_inverse, 1, (6, 6), shaped(xi, (6,), "xi"))


def right_jacobian_inverse(xi: ArrayLike) -> Array:
    """Inverse of the right Jacobian of exp, for |ω| < 2π.

    Parameters
    ----------
    xi : (..., 6) array_like
        Twist (ω; v), rad and m; J_r is singular at |ω| = 2π.

    Returns
    -------
    J_r_inverse : (..., 6, 6) ndarray
        Matrix J_r(xi)⁻¹ = J(-xi)⁻¹.

    Raises
    ------
    ShapeError
        If the last axis of xi is not 6.
    InputError
        If xi holds anything but real numbers.

    Notes
    -----
    Accuracy: that of `left_jacobian_inverse`. Source: Park 1994, Lemma 4.
    """
    return left_jacobian_inverse(-numbers(xi, "xi"))
