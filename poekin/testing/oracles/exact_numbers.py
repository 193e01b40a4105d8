"""Arrays of mpmath numbers with 80 digits, and the few operations on 3×3 matrices that `exact` needs.

Its context is its own: nobody else's precision is changed, and nobody changes its.
"""

from __future__ import annotations

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
"""The oracle's own mpmath context."""
mp.dps = DIGITS
LEAST_CLOSED = 1e-6
"""Least θ² in rad² for closed forms, which are many times as fast as series and lose up to 7 digits of 80 here."""


def _mpf(x: Any) -> Any:
    if isinstance(x, mp.mpf):
        return x
    return mp.mpf(x)


# Below, array times number in this order: an mpmath number asked first writes the whole array into
# an error of its own.
_to_mpf = np.frompyfunc(_mpf, 1, 1)
_to_float = np.frompyfunc(float, 1, 1)


def exactly(x: ArrayLike) -> np.ndarray:
    """Numbers as mpmath numbers of the oracle's context, without rounding.

    Parameters
    ----------
    x : (...) array_like
        Floats, integers or numbers of the oracle, in any unit.

    Returns
    -------
    x : (...) ndarray
        Array of mpmath numbers (dtype object).

    Raises
    ------
    InputError
        If an entry is no number.
    """
    try:
        # A NaN among them is no reason to warn.
        with np.errstate(invalid="ignore"):
            numbers = _to_mpf(np.asarray(x))
            return np.asarray(numbers, dtype=object)
    except (TypeError, ValueError) as fault:
        raise InputError(f"expected numbers, got {safe_repr(x)}") from fault


def rounded(x: np.ndarray) -> np.ndarray:
    """Nearest float64 of each number.

    Parameters
    ----------
    x : (...) ndarray
        Numbers of the oracle, in any unit.

    Returns
    -------
    x : (...) ndarray
        Array of float64.
    """
    with np.errstate(invalid="ignore"):
        return np.asarray(_to_float(x), dtype=float)


def norm(x: np.ndarray) -> Any:
    """Euclidean norm of a vector, or Frobenius norm of a matrix.

    Parameters
    ----------
    x : (...) ndarray
        Numbers of the oracle, in any unit.

    Returns
    -------
    norm : mpf
        √Σ x² over all entries.
    """
    squares = mp.fsum(np.ravel(x), squared=True)
    return mp.sqrt(squares)


def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Cross product a × b.

    Parameters
    ----------
    a, b : (3,) ndarray
        Vectors of the oracle's numbers, in any unit.

    Returns
    -------
    c : (3,) ndarray
        The product.
    """
    return np.array(
        [
            a[1] * b[2] - a[2] * b[1],
            a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0],
        ],
        dtype=object,
    )


def shaped(x: ArrayLike, *shapes: tuple[int, ...]) -> np.ndarray:
    """Numbers of the oracle in one of these shapes; ShapeError for another shape."""
    X = exactly(x)
    if X.shape not in shapes:
        raise ShapeError(
            f"expected shape {' or '.join(map(str, shapes))}, got {X.shape}; of a batch, one at a time"
        )
    return X


def least() -> Any:
    """Size up to which a term of a series is of no account."""
    return mp.mpf(10) ** -mp.dps


def identity(n: int) -> np.ndarray:
    """Identity matrix (n, n)."""
    return exactly(np.eye(n))


def determinant(X: np.ndarray) -> Any:
    """Determinant of a 3×3 matrix."""
    return X[0] @ cross(X[1], X[2])


def inverse3(X: np.ndarray) -> np.ndarray:
    """Inverse of a 3×3 matrix, by its cofactors."""
    a, b, c = X
    rows = [
        cross(b, c),
        cross(c, a),
        cross(a, b),
    ]
    cofactors = np.array(rows, dtype=object)
    return cofactors.T / determinant(X)


def skew_part(X: np.ndarray) -> np.ndarray:
    """Vector of the skew part of a matrix, of its upper left 3×3 block."""
    K = X[:3, :3] - X[:3, :3].T
    w = [
        K[2, 1],
        K[0, 2],
        K[1, 0],
    ]
    return np.array(w, dtype=object) / 2


def lower_blocks(P: np.ndarray, Q: np.ndarray) -> np.ndarray:
    """Matrix [P 0; Q P] (6, 6)."""
    zero = exactly(np.zeros((3, 3)))
    return np.block([[P, zero], [Q, P]])


def homogeneous(
    R: np.ndarray,
    t: np.ndarray,
    last: int,
) -> np.ndarray:
    """Matrix [R t; 0 last] (4, 4)."""
    T = exactly(np.zeros((4, 4)))
    T[:3, :3] = R
    T[:3, 3] = t
    T[3, 3] = mp.mpf(last)
    return T


def vector(x: ArrayLike) -> np.ndarray:
    """Rotation vector (3,) or twist (6,) in the oracle's numbers."""
    return shaped(x, (3,), (6,))


def hat(w: ArrayLike) -> np.ndarray:
    """Matrix of a rotation vector or twist.

    [ω] is the matrix of ω ×; [ξ] = [[ω] v; 0 0].

    Parameters
    ----------
    w : (3,) or (6,) array_like
        Rotation vector ω in rad, or twist (ω; v) in rad and m.

    Returns
    -------
    X : (3, 3) or (4, 4) ndarray
        The matrix, in the frame of the twist.

    Raises
    ------
    ShapeError
        For another shape.
    """
    x = vector(w)
    if len(x) == 6:
        return homogeneous(hat(x[:3]), x[3:], last=0)
    zero = mp.zero
    a, b, c = x
    rows = [
        [zero, -c, b],
        [c, zero, -a],
        [-b, a, zero],
    ]
    return np.array(rows, dtype=object)


def coefficients(s: Any) -> tuple[Any, Any, Any]:
    """Coefficients sin θ/θ, (1 - cos θ)/θ², (θ - sin θ)/θ³ as functions of s = θ²."""
    if s >= LEAST_CLOSED:
        t = mp.sqrt(s)
        cosine, sine = mp.cos_sin(t)
        return sine / t, (1 - cosine) / s, (t - sine) / (s * t)
    sums = []
    small = least()
    for first in (1, 2, 3):
        term = mp.one / mp.factorial(first)
        total = term
        k = first
        while abs(term) > small:
            divisor = (k + 1) * (k + 2)
            term = -term * s / divisor
            total = total + term
            k = k + 2
        sums.append(total)
    return sums[0], sums[1], sums[2]
