"""F-test: whether directions explain more of an error than chance does."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .....groups.arrays import Array
from ...model.tsqr import qr_r
from ...selection.jackknife import Jackknife
from ...selection.spans import RANK, beside, column_sizes, directions_beside, spanned

_CONVERGED = 1e-15
_TINY = 1e-300


class Left(NamedTuple):
    """Whitened errors e (M,) that a fit left, orthonormal columns Q (M, k) of what was fitted, and
    the jackknife of its clusters, None where numbers are independent.
    """

    e: Array
    Q: Array
    jackknife: Jackknife | None


class Tested(NamedTuple):
    """Orthonormal directions U (M, d) beside what was fitted, the errors' part s (d,) along these, and
    its chance where there is nothing.
    """

    U: Array
    s: Array
    p: float


def left_of(
    errors: Array,
    fitted: Array,
    clusters: NDArray[np.intp] | None,
) -> Left:
    """Rest that a fit of these columns (M, P) leaves of errors (M,)."""
    Q, _ = spanned(fitted)
    jackknife = None if clusters is None else Jackknife(Q, clusters)
    return Left(beside(Q, errors), Q, jackknife)


def coefficients(
    columns: Array,
    errors: Array,
) -> Array:
    """Least squares (P,) of errors (M,), of columns of any sizes; those that are not told are 0."""
    sizes = column_sizes(columns)
    R = qr_r(np.column_stack([columns / sizes, errors]))
    z: Any = np.linalg.lstsq(R[:, :-1], R[:, -1], rcond=RANK)[0]
    return np.asarray(z / sizes, float)


def f_test(
    left: Left,
    columns: Array,
) -> Tested | None:
    """Test of columns (M, d); None where what was fitted has them, or no numbers are left.

    F = (|s|^2 / d) / (|e - U s|^2 / (M - k - d)), where numbers are independent. Where they depend
    on each other in clusters, Hotelling's T^2 = s^T V^-1 s with the jackknife's covariance V.
    Source: Fisher 1924; Bell and McCaffrey 2002 for V, Pustejovsky and Tipton 2018 for the test.
    """
    U = directions_beside(left.Q, columns)
    d = U.shape[1]
    s = U.T @ left.e
    unexplained = left.e - U @ s
    if left.jackknife is None:
        freedom = len(left.e) - left.Q.shape[1] - d
        if d == 0 or freedom < 1:
            return None
        variance = float(unexplained @ unexplained) / freedom
        F = float(s @ s) / max(d * variance, _TINY)
        return Tested(U, s, f_survival(F, d, freedom))
    count = left.jackknife.count
    freedom = count - d
    if d == 0 or freedom < 1:
        return None
    V = left.jackknife.meat_beside(U, unexplained)
    T = float(s @ np.linalg.solve(V, s))
    F = T * freedom / (d * (count - 1))
    return Tested(U, s, f_survival(F, d, freedom))


def f_survival(
    F: float,
    d: float,
    freedom: float,
) -> float:
    """Chance of a larger value of the F distribution with d and `freedom` degrees of freedom.

    Source: Abramowitz and Stegun 1964, 26.6.2 and 26.5.8, the continued fraction of the incomplete
    beta function, by the algorithm of Lentz 1976. Accuracy: 1e-10 of its size.
    """
    x = freedom / (freedom + d * F)
    a = 0.5 * freedom
    b = 0.5 * d
    if x > (a + 1.0) / (a + b + 2.0):
        return 1.0 - _incomplete_beta(b, a, 1.0 - x)
    return _incomplete_beta(a, b, x)


def _incomplete_beta(
    a: float,
    b: float,
    x: float,
) -> float:
    """I_x(a, b), x below (a + 1) / (a + b + 2)."""
    if x <= 0.0:
        return 0.0
    logarithm = math.lgamma(a + b) - math.lgamma(a) - math.lgamma(b)
    logarithm += a * math.log(x) + b * math.log1p(-x)
    c = 1.0
    below = 1.0 / (1.0 - (a + b) * x / (a + 1.0))
    fraction = below
    for m in range(1, 10_000):
        i = a + 2.0 * m
        even = m * (b - m) * x / ((i - 1.0) * i)
        odd = -(a + m) * (a + b + m) * x / (i * (i + 1.0))
        for term in (even, odd):
            below = 1.0 / (1.0 + term * below)
            c = 1.0 + term / c
            fraction *= below * c
        if abs(below * c - 1.0) < _CONVERGED:
            break
    return math.exp(logarithm) * fraction / a
