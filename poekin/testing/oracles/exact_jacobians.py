"""Jacobians of the exponential of SO(3) and SE(3) in 80 digits, and their inverses."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .exact_numbers import (
    LEAST_CLOSED,
    coefficients,
    hat,
    identity,
    inverse3,
    least,
    lower_blocks,
    mp,
    vector,
)


def left_jacobian(xi: ArrayLike) -> np.ndarray:
    """Left Jacobian of exp: (d e^ξ) e^-ξ = J dξ.

    J is Σ ad(ξ)^k / (k+1)!.

    Parameters
    ----------
    xi : (3,) or (6,) array_like
        Rotation vector ω in rad, or twist (ω; v) in rad and m.

    Returns
    -------
    J : (3, 3) or (6, 6) ndarray
        The Jacobian, to twists of the base frame.

    Raises
    ------
    ShapeError
        For another shape.
    """
    x = vector(xi)
    s = x[:3] @ x[:3]
    W = hat(x[:3])
    WW = W @ W
    _, b, c = coefficients(s)
    P = identity(3) + W * b + WW * c
    if len(x) == 3:
        return P
    # X = ad(ξ) obeys X⁵ = -2θ² X³ - θ⁴ X, so every power, and the series, is a sum of X, X², X³ and
    # X⁴. These are their lower blocks; [ω]³ = -θ² [ω].
    Q = hat(x[3:])
    QW = Q @ W
    Q2 = W @ Q + QW
    Q3 = W @ Q2 + Q @ WW
    Q4 = W @ Q3 - QW * s
    f1, f2, f3, f4 = _jacobian_series(s)
    return lower_blocks(P, Q * f1 + Q2 * f2 + Q3 * f3 + Q4 * f4)


def left_jacobian_inverse(xi: ArrayLike) -> np.ndarray:
    """Inverse of the left Jacobian of exp, |ω| < 2π.

    Parameters
    ----------
    xi : (3,) or (6,) array_like
        Rotation vector ω in rad, or twist (ω; v) in rad and m.

    Returns
    -------
    J : (3, 3) or (6, 6) ndarray
        The inverse of `left_jacobian`, from twists of the base frame.

    Raises
    ------
    ShapeError
        For another shape.
    """
    J = left_jacobian(xi)
    P = inverse3(J[:3, :3])
    if len(J) == 3:
        return P
    corner = P @ J[3:, :3] @ P
    return lower_blocks(P, -corner)


def right_jacobian(xi: ArrayLike) -> np.ndarray:
    """Right Jacobian of exp: e^-ξ (d e^ξ) = J dξ.

    It is the left Jacobian of -ξ.

    Parameters
    ----------
    xi : (3,) or (6,) array_like
        Rotation vector ω in rad, or twist (ω; v) in rad and m.

    Returns
    -------
    J : (3, 3) or (6, 6) ndarray
        The Jacobian, to twists of the moving frame.

    Raises
    ------
    ShapeError
        For another shape.
    """
    return left_jacobian(-vector(xi))


def right_jacobian_inverse(xi: ArrayLike) -> np.ndarray:
    """Inverse of the right Jacobian of exp, |ω| < 2π.

    Parameters
    ----------
    xi : (3,) or (6,) array_like
        Rotation vector ω in rad, or twist (ω; v) in rad and m.

    Returns
    -------
    J : (3, 3) or (6, 6) ndarray
        The inverse of `right_jacobian`, from twists of the moving frame.

    Raises
    ------
    ShapeError
        For another shape.
    """
    return left_jacobian_inverse(-vector(xi))


def _jacobian_series(s: Any) -> list[Any]:
    """The factors of X, X², X³, X⁴ in Σ X^k / (k+1)!, k >= 1, where X⁵ = -2s X³ - s² X."""
    if s >= LEAST_CLOSED:
        a, b, c = coefficients(s)
        return [2 * b - a / 2, (5 * c - b) / 2, (2 * b - a) / (2 * s), (3 * c - b) / (2 * s)]
    power = [mp.one, mp.zero, mp.zero, mp.zero]
    sums = [mp.zero] * 4
    weight = mp.one / 2
    k = 1
    # The entries of `power` grow as k θ^k, which (k+1)! soon overtakes.
    while max(map(abs, power)) * weight > least():
        sums = [total + weight * p for total, p in zip(sums, power, strict=True)]
        power = [
            -s * s * power[3],
            power[0],
            power[1] - 2 * s * power[3],
            power[2],
        ]
        k += 1
        weight = weight / (k + 1)
    return sums
