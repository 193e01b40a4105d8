"""so(3), SO(3), se(3) and SE(3) in 60 digits and more: the oracle. It shares no code with what it
judges.

Arrays are NumPy arrays of mpmath numbers (dtype object); a float64 that comes in is taken as the
exact number that it is. Coefficients are power series below |ω| = 1, so no digit is lost towards 0;
the 6×6 Jacobians of exp are the series Σ ad(ξ)^k / (k+1)!; log first projects onto the rotations
(polar factor), with 640 digits where sin |ω| < 1e-10.

    exact.rounded(exact.exp([0.3, 0, 0, 1, 2, 3]))     the pose (4, 4), each number the float next
    to the truth

Twists are (ω; v) in rad and m, poses those of a frame in the base frame, and none of the functions
takes a batch. Returns: arrays of mpmath numbers, but for `rounded`. Raises: ShapeError for another
shape; InputError for what is no number. NaN in gives NaN out.
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

from poekin.errors import InputError, MissingExtra, ShapeError, safe_repr

try:
    import mpmath
except ImportError as error:
    raise MissingExtra("mpmath", "testing", "poekin.testing.oracles.exact") from error

DIGITS = 80
mp: Any = mpmath.mp.clone()
"""The oracle's own mpmath context: nobody else's precision is changed, and nobody changes its."""
mp.dps = DIGITS

# Below, array times number in this order: an mpmath number asked first writes the whole array into
# an error of its own.
_to_mpf = np.frompyfunc(lambda x: x if isinstance(x, mp.mpf) else mp.mpf(x), 1, 1)
_to_float = np.frompyfunc(float, 1, 1)


def exactly(x: ArrayLike) -> np.ndarray:
    """Numbers x, of any shape (...), as this context's mpmath numbers; floats and its own are not
    rounded.
    """
    try:
        # A NaN among them is no reason to warn.
        with np.errstate(invalid="ignore"):
            return np.asarray(_to_mpf(np.asarray(x)), dtype=object)
    except (TypeError, ValueError) as fault:
        raise InputError(f"expected numbers, got {safe_repr(x)}") from fault


def rounded(x: np.ndarray) -> np.ndarray:
    """The nearest float64 of each number of x, any shape (...)."""
    with np.errstate(invalid="ignore"):
        return np.asarray(_to_float(x), dtype=float)


def norm(x: np.ndarray) -> Any:
    """√Σ x², over all entries of x (...) (Euclidean for vectors, Frobenius for matrices), as an
    mpmath number.
    """
    return mp.sqrt(mp.fsum(np.ravel(x), squared=True))


def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """The cross product a × b of a, b (3,)."""
    return np.array(
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]],
        dtype=object,
    )


def hat(w: ArrayLike) -> np.ndarray:
    """[ω], the matrix of w ×: w (3,) -> (3, 3); and [[ω] v; 0 0] of a twist: w (6,) -> (4, 4)."""
    x = _vector(w)
    if len(x) == 6:
        return _stack(hat(x[:3]), x[3:], last=0)
    zero = mp.zero
    return np.array([[zero, -x[2], x[1]], [x[2], zero, -x[0]], [-x[1], x[0], zero]], dtype=object)


def ad(xi: ArrayLike) -> np.ndarray:
    """ad(ξ) = [[ω] 0; [v] [ω]]: xi (6,) -> (6, 6), or [ω] of a rotation vector: xi (3,) -> (3, 3)."""
    x = _vector(xi)
    if len(x) == 3:
        return hat(x)
    return _lower(hat(x[:3]), hat(x[3:]))


def adjoint(T: ArrayLike) -> np.ndarray:
    """Ad(T) = [R 0; [t] R R]: T (4, 4) -> (6, 6), or R itself: T (3, 3) -> (3, 3)."""
    X = _element(T)
    if len(X) == 3:
        return X
    return _lower(X[:3, :3], hat(X[:3, 3]) @ X[:3, :3])


def inverse(T: ArrayLike) -> np.ndarray:
    """The inverse of a rotation or pose as it stands, orthonormal or not: T (3, 3) or (4, 4) -> the
    same.
    """
    X = _element(T)
    if len(X) == 3:
        return _inverse3(X)
    R = _inverse3(X[:3, :3])
    return _stack(R, -(R @ X[:3, 3]), last=1)


def exp(xi: ArrayLike) -> np.ndarray:
    """e^[ω], xi (3,) -> (3, 3), or e^ξ, xi (6,) -> (4, 4)."""
    x = _vector(xi)
    w = x[:3]
    W = hat(x[:3])
    a, b, c = _coefficients(w @ w)
    R = _identity(3) + W * a + (W @ W) * b
    if len(x) == 3:
        return R
    v = x[3:]
    wv = cross(w, v)
    return _stack(R, v + wv * b + cross(w, wv) * c, last=1)


def polar(R: ArrayLike) -> np.ndarray:
    """The rotation nearest to a matrix (its polar factor), by Newton's X <- (X + X⁻ᵀ)/2: R (3, 3)
    -> (3, 3).

    Raises: ShapeError; InputError where the determinant is not positive, or is NaN.
    """
    X = _shaped(R, (3, 3))
    if not (determinant := _determinant(X)) > 0:
        raise InputError(
            f"only a matrix of positive determinant has a rotation as its polar factor, got {float(determinant):.3g}"
        )
    for _ in range(60):
        step = (_inverse3(X).T - X) / 2
        X = X + step
        if norm(step) ** 2 < _least():
            return X
    raise InputError("the matrix is too close to a singular one to have a polar factor")


def log(T: ArrayLike) -> np.ndarray:
    """The principal logarithm of the polar projection: T (3, 3) -> (3,), or T (4, 4) -> (6,); 0 <=
    |ω| <= π.

    At |ω| = π exactly both signs are logarithms, and this returns either. Raises: as `polar`.
    """
    X = _element(T)
    w = _log3(X[:3, :3])
    if len(X) == 3:
        return w
    return np.concatenate([w, left_jacobian_inverse(w) @ X[:3, 3]])


def left_jacobian(xi: ArrayLike) -> np.ndarray:
    """J with (d e^ξ) e^-ξ = J dξ, which is Σ ad(ξ)^k / (k+1)!: xi (3,) -> (3, 3) or xi (6,) -> (6,
    6).
    """
    x = _vector(xi)
    W = hat(x[:3])
    if len(x) == 3:
        _, b, c = _coefficients(x @ x)
        return _identity(3) + W * b + (W @ W) * c
    # X = ad(ξ) obeys X⁵ = -2θ² X³ - θ⁴ X, so every power, and the series, is a sum of X, X², X³ and
    # X⁴.
    V = hat(x[3:])
    sum_P = _identity(3)
    sum_Q = 0 * V
    P = W
    Q = V
    for factor in _jacobian_series(x[:3] @ x[:3]):
        sum_P = sum_P + P * factor
        sum_Q = sum_Q + Q * factor
        P, Q = W @ P, W @ Q + V @ P
    return _lower(sum_P, sum_Q)


def left_jacobian_inverse(xi: ArrayLike) -> np.ndarray:
    """The inverse of `left_jacobian`, |ω| < 2π: xi (3,) -> (3, 3) or xi (6,) -> (6, 6)."""
    J = left_jacobian(xi)
    P = _inverse3(J[:3, :3])
    if len(J) == 3:
        return P
    return _lower(P, -(P @ J[3:, :3] @ P))


def right_jacobian(xi: ArrayLike) -> np.ndarray:
    """J with e^-ξ (d e^ξ) = J dξ, which is the left Jacobian of -ξ: xi (3,) -> (3, 3) or xi (6,) ->
    (6, 6).
    """
    return left_jacobian(-_vector(xi))


def right_jacobian_inverse(xi: ArrayLike) -> np.ndarray:
    """The inverse of `right_jacobian`, |ω| < 2π: xi (3,) -> (3, 3) or xi (6,) -> (6, 6)."""
    return left_jacobian_inverse(-_vector(xi))


def forward(
    screws: ArrayLike,
    home: ArrayLike,
    x: ArrayLike,
) -> np.ndarray:
    """e^{A1 x1} ⋯ e^{An xn} M: screws (n, 6) in the base frame, home (4, 4), displacements x (n,)
    -> (4, 4).
    """
    A = exactly(screws)
    shift = exactly(x)
    if A.shape != (len(shift), 6):
        raise ShapeError(f"expected screws (n, 6) and x (n,), got {A.shape} and {shift.shape}")
    factors = (exp(screw * amount) for screw, amount in zip(A, shift, strict=True))
    return product(factors) @ _shaped(home, (4, 4))


def product(poses: Iterable[np.ndarray]) -> np.ndarray:
    """T_1 T_2 ⋯ T_k (4, 4) of poses (4, 4), in this order; the identity where there is none."""
    return functools.reduce(np.matmul, map(exactly, poses), _identity(4))


def _vector(x: ArrayLike) -> np.ndarray:
    return _shaped(x, (3,), (6,))


def _element(x: ArrayLike) -> np.ndarray:
    return _shaped(x, (3, 3), (4, 4))


def _shaped(x: ArrayLike, *shapes: tuple[int, ...]) -> np.ndarray:
    X = exactly(x)
    if X.shape not in shapes:
        raise ShapeError(
            f"expected shape {' or '.join(map(str, shapes))}, got {X.shape}; of a batch, one at a time"
        )
    return X


def _coefficients(s: Any) -> tuple[Any, Any, Any]:
    """The coefficients sin θ/θ, (1 - cos θ)/θ², (θ - sin θ)/θ³ as functions of s = θ²."""
    if s >= 1:
        t = mp.sqrt(s)
        return mp.sin(t) / t, (1 - mp.cos(t)) / s, (t - mp.sin(t)) / (s * t)
    sums = []
    for first in (1, 2, 3):
        term = mp.one / mp.factorial(first)
        total = term
        k = first
        while abs(term) > _least():
            term = -term * s / ((k + 1) * (k + 2))
            total = total + term
            k = k + 2
        sums.append(total)
    return sums[0], sums[1], sums[2]


def _least() -> Any:
    """Up to here a term is of no account."""
    return mp.mpf(10) ** -mp.dps


def _jacobian_series(s: Any) -> list[Any]:
    """The factors of X, X², X³, X⁴ in Σ X^k / (k+1)!, k >= 1, where X⁵ = -2s X³ - s² X."""
    power = [mp.one, mp.zero, mp.zero, mp.zero]
    sums = [mp.zero] * 4
    weight = mp.one / 2
    k = 1
    # The entries of `power` grow as k θ^k, which (k+1)! soon overtakes.
    while max(map(abs, power)) * weight > _least():
        sums = [total + weight * p for total, p in zip(sums, power, strict=True)]
        power = [-s * s * power[3], power[0], power[1] - 2 * s * power[3], power[2]]
        k += 1
        weight = weight / (k + 1)
    return sums


def _log3(X: np.ndarray, digits: int = DIGITS) -> np.ndarray:
    with mp.workdps(digits):
        R = polar(X)
        s = np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]], dtype=object) / 2
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
    N = (R + R.T) / 2 - _identity(3) * cosine
    column = N[:, int(np.argmax(rounded(np.diag(N))))]
    if s @ column < 0:
        column = -column
    return column * (angle / norm(column))


def _identity(n: int) -> np.ndarray:
    return exactly(np.eye(n))


def _determinant(X: np.ndarray) -> Any:
    return X[0] @ cross(X[1], X[2])


def _inverse3(X: np.ndarray) -> np.ndarray:
    cofactors = np.array([cross(X[1], X[2]), cross(X[2], X[0]), cross(X[0], X[1])], dtype=object)
    return cofactors.T / _determinant(X)


def _lower(P: np.ndarray, Q: np.ndarray) -> np.ndarray:
    """[P 0; Q P]."""
    return np.block([[P, exactly(np.zeros((3, 3)))], [Q, P]])


def _stack(
    R: np.ndarray,
    t: np.ndarray,
    last: int,
) -> np.ndarray:
    """[R t; 0 last]."""
    T = exactly(np.zeros((4, 4)))
    T[:3, :3] = R
    T[:3, 3] = t
    T[3, 3] = mp.mpf(last)
    return T
