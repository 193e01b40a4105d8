"""so(3), SO(3), se(3) and SE(3) in 60 digits and more: the oracle. It shares no code with what it
judges.

Arrays are NumPy arrays of mpmath numbers (dtype object); a float64 that comes in is taken as the
exact number that it is. Coefficients are power series below |ω| = 1e-3, so no digit is lost towards
0, and closed forms from there on; the 6×6 Jacobians of exp are Σ ad(ξ)^k / (k+1)!; log first
projects onto the rotations (polar factor), with 640 digits where sin |ω| < 1e-10.

Twists are (ω; v) in rad and m, poses those of a frame in the base frame, and none of the functions
takes a batch. NaN in gives NaN out. Raises: ShapeError for another shape; InputError for what is no
number.
Accuracy: 60 digits relative to the norm of each result (of ω and of v separately), held by
tests/testing/oracles/test_exact.py against mpmath's own matrix exponential. Source: Park 1994,
Lemmas 1 to 4, as series.
"""

from __future__ import annotations

import functools
from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from poekin.errors import InputError, ShapeError

from .exact_jacobians import (
    left_jacobian,
    left_jacobian_inverse,
    right_jacobian,
    right_jacobian_inverse,
)
from .exact_numbers import (
    DIGITS,
    coefficients,
    cross,
    determinant,
    exactly,
    hat,
    homogeneous,
    identity,
    inverse3,
    least,
    lower_blocks,
    mp,
    norm,
    rounded,
    shaped,
    skew_part,
    vector,
)

__all__ = [
    "DIGITS",
    "ad",
    "adjoint",
    "cross",
    "exactly",
    "exp",
    "forward",
    "hat",
    "inverse",
    "left_jacobian",
    "left_jacobian_inverse",
    "log",
    "mp",
    "norm",
    "polar",
    "product",
    "right_jacobian",
    "right_jacobian_inverse",
    "rounded",
]


def ad(xi: ArrayLike) -> np.ndarray:
    """Matrix of the Lie bracket with a twist.

    ad(ξ) = [[ω] 0; [v] [ω]]; of a rotation vector, [ω].

    Parameters
    ----------
    xi : (3,) or (6,) array_like
        Rotation vector ω in rad, or twist (ω; v) in rad and m.

    Returns
    -------
    X : (3, 3) or (6, 6) ndarray
        The matrix, in the frame of the twist.

    Raises
    ------
    ShapeError
        For another shape.
    """
    x = vector(xi)
    if len(x) == 3:
        return hat(x)
    return lower_blocks(hat(x[:3]), hat(x[3:]))


def adjoint(T: ArrayLike) -> np.ndarray:
    """Adjoint matrix of a rotation or pose.

    Ad(T) = [R 0; [t] R R]; of a rotation, R itself.

    Parameters
    ----------
    T : (3, 3) or (4, 4) array_like
        Rotation, or pose of a frame in the base frame, m.

    Returns
    -------
    X : (3, 3) or (6, 6) ndarray
        Matrix from twists of the frame to those of the base frame.

    Raises
    ------
    ShapeError
        For another shape.
    """
    X = _element(T)
    if len(X) == 3:
        return X
    return lower_blocks(X[:3, :3], hat(X[:3, 3]) @ X[:3, :3])


def inverse(T: ArrayLike) -> np.ndarray:
    """Inverse of a rotation or pose as it stands, orthonormal or not.

    Parameters
    ----------
    T : (3, 3) or (4, 4) array_like
        Rotation, or pose of a frame in the base frame, m.

    Returns
    -------
    X : (3, 3) or (4, 4) ndarray
        The inverse.

    Raises
    ------
    ShapeError
        For another shape.
    """
    X = _element(T)
    if len(X) == 3:
        return inverse3(X)
    R = inverse3(X[:3, :3])
    return homogeneous(R, -(R @ X[:3, 3]), last=1)


def exp(xi: ArrayLike) -> np.ndarray:
    """Exponential e^[ω] of a rotation vector, or e^[ξ] of a twist.

    Parameters
    ----------
    xi : (3,) or (6,) array_like
        Rotation vector ω in rad, or twist (ω; v) in rad and m.

    Returns
    -------
    T : (3, 3) or (4, 4) ndarray
        Rotation, or pose in the base frame.

    Raises
    ------
    ShapeError
        For another shape.

    Examples
    --------
    >>> from poekin.testing.oracles import exact
    >>> T = exact.exp([0.3, 0, 0, 1, 2, 3])  # each number in 80 digits
    >>> print(exact.rounded(T)[:3, 3].round(6))  # the floats next to the truth
    [1.       1.5235   3.252959]
    """
    x = vector(xi)
    w = x[:3]
    W = hat(w)
    a, b, c = coefficients(w @ w)
    R = identity(3) + W * a + (W @ W) * b
    if len(x) == 3:
        return R
    v = x[3:]
    wv = cross(w, v)
    return homogeneous(R, v + wv * b + cross(w, wv) * c, last=1)


def polar(R: ArrayLike) -> np.ndarray:
    """Rotation nearest to a matrix: its polar factor, by Newton's X <- (X + X⁻ᵀ)/2.

    Parameters
    ----------
    R : (3, 3) array_like
        Matrix of positive determinant.

    Returns
    -------
    R : (3, 3) ndarray
        The rotation.

    Raises
    ------
    ShapeError
        For another shape.
    InputError
        If the determinant is not positive, or NaN, or the matrix too close to a singular one.
    """
    X = shaped(R, (3, 3))
    if not (size := determinant(X)) > 0:
        raise InputError(
            f"only a matrix of positive determinant has a rotation as its polar factor, got {float(size):.3g}"
        )
    for _ in range(60):
        step = (inverse3(X).T - X) / 2
        X = X + step
        if norm(step) ** 2 < least():
            return X
    raise InputError("the matrix is too close to a singular one to have a polar factor")


def log(T: ArrayLike) -> np.ndarray:
    """Principal logarithm of the polar projection, 0 ≤ |ω| ≤ π.

    At |ω| = π exactly both signs are logarithms, and this returns either.

    Parameters
    ----------
    T : (3, 3) or (4, 4) array_like
        Rotation, or pose of a frame in the base frame, m.

    Returns
    -------
    xi : (3,) or (6,) ndarray
        Rotation vector ω in rad, or twist (ω; v) in rad and m.

    Raises
    ------
    ShapeError
        For another shape.
    InputError
        As `polar`.
    """
    X = _element(T)
    w = _log3(X[:3, :3])
    if len(X) == 3:
        return w
    return np.concatenate([w, left_jacobian_inverse(w) @ X[:3, 3]])


def forward(
    screws: ArrayLike,
    home: ArrayLike,
    x: ArrayLike,
) -> np.ndarray:
    """Product of exponentials e^{A_1 x_1} ⋯ e^{A_n x_n} M.

    Parameters
    ----------
    screws : (n, 6) array_like
        Screws A of the joints, (ω; v) in the base frame, rad and m.
    home : (4, 4) array_like
        Home pose M in the base frame.
    x : (n,) array_like
        Displacements of the joints, rad or m.

    Returns
    -------
    T : (4, 4) ndarray
        Pose of the tool in the base frame.

    Raises
    ------
    ShapeError
        For other shapes.
    """
    A = exactly(screws)
    shift = exactly(x)
    if A.shape != (len(shift), 6):
        raise ShapeError(f"expected screws (n, 6) and x (n,), got {A.shape} and {shift.shape}")
    factors = (exp(screw * amount) for screw, amount in zip(A, shift, strict=True))
    return product(factors) @ shaped(home, (4, 4))


def product(poses: Iterable[np.ndarray]) -> np.ndarray:
    """Product T_1 T_2 ⋯ T_k of poses; the identity where there is none.

    Parameters
    ----------
    poses : iterable of (4, 4) array_like
        Poses, each in the frame of the one before it, m.

    Returns
    -------
    T : (4, 4) ndarray
        Pose of the last frame in the base frame.
    """
    return functools.reduce(np.matmul, map(exactly, poses), identity(4))


def _element(x: ArrayLike) -> np.ndarray:
    return shaped(x, (3, 3), (4, 4))


def _log3(X: np.ndarray, digits: int = DIGITS) -> np.ndarray:
    with mp.workdps(digits):
        R = polar(X)
        s = skew_part(R)
        # The polar factor of a symmetric matrix is symmetric: θ = 0 or θ = π.
        s = 0 * s if np.array_equal(X, X.T) else s
        sine = norm(s)
        cosine = (R[0, 0] + R[1, 1] + R[2, 2] - 1) / 2
        # A smaller sine is a difference that has lost too many digits.
        if sine > mp.mpf("1e-10") or digits > DIGITS:
            return _axis_angle(R, s, sine, cosine)
    return _log3(X, 8 * DIGITS)


def _axis_angle(
    R: np.ndarray,
    s: np.ndarray,
    sine: Any,
    cosine: Any,
) -> np.ndarray:
    angle = mp.atan2(sine, cosine)
    if cosine >= 0:
        return s * (angle / sine) if sine else s
    # (R + Rᵀ)/2 - cos θ I = (1 - cos θ) n nᵀ: its largest column is the axis, also where the sine
    # vanishes.
    N = (R + R.T) / 2 - identity(3) * cosine
    column = N[:, int(np.argmax(rounded(np.diag(N))))]
    if s @ column < 0:
        column = -column
    return column * (angle / norm(column))
