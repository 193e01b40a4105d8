"""Laws of exp, log, the adjoint and the Jacobians of exp, of SO(3) and SE(3), against the truth in
80 digits.

Each law is a plain function of a subject's function with twists (ω; v), and of an argument: it
returns the verdict, and raises LawViolation where that is worse than `at_most`. What float64 can
attain is `error_bounds`'s for exp and log, and a third of `accuracy_laws.JACOBIAN_BAR` for the
Jacobians; in float32, 2²⁹ times as much. Arguments are floats of the precision that the function
computes in; poses are those of a frame in the base frame.
Raises: LawViolation, by the laws alone. Source: Park 1994, Lemmas 1 to 5, in 80 digits (`exact`).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ....groups.arrays import Array
from ...accuracy import error_bounds
from ...accuracy.accuracy_laws import EXP_LOG_BAR, JACOBIAN_BAR, NOISE_BAR, jacobian_errors
from ...oracles import exact
from ..grades import ErrorPart, Grade, Verdict, graded, norm
from ..process.calls import ArrayFunction, called
from ..subjects.precision import DOUBLE, Precision
from ..subjects.subject import JacobianName

ELEMENT_SIZE = {3: 3, 6: 4}
"""Rows of a rotation or pose, by the length of its twist."""
TWIST_SIZE = {3: 3, 4: 6}
"""Length of a twist, by the rows of its rotation or pose."""


def exp_is_e_to_the_xi(
    exp: ArrayFunction,
    xi: Array,
    at_most: Grade = Grade.EXACT,
    precision: Precision = DOUBLE,
) -> Verdict:
    """Law: exp ξ = e^[ξ]; R as it is, t in proportion to |v|.

    Parameters
    ----------
    exp : callable
        Function under test.
    xi : (6,) or (3,) ndarray
        Twist (ω; v) in rad and m, or rotation vector in rad.
    at_most : Grade, optional
        Worst grade that is let pass.
    precision : Precision, optional
        Precision that the function computes in, `conform.DOUBLE` or `conform.SINGLE`.

    Returns
    -------
    verdict : Verdict
        The verdict on the worst part.

    Raises
    ------
    LawViolation
        If the grade is worse than `at_most`.

    Examples
    --------
    >>> import numpy as np
    >>> import poekin as pk
    >>> from poekin.testing.conform.laws import of_groups
    >>> xi = np.array([0.3, 0.0, 0.0, 1.0, 2.0, 3.0])
    >>> of_groups.exp_is_e_to_the_xi(pk.se3.exp, xi).grade.word  # of one's own function
    'exact'
    """
    size = ELEMENT_SIZE.get(len(xi), 4)
    X, fault = called(exp, (size, size), xi)
    parts = fault or exp_parts(xi, X, precision)
    return graded("exp is e to the xi", parts, at_most, xi=xi)


def exp_parts(
    xi: Array,
    X: Array,
    precision: Precision = DOUBLE,
) -> list[ErrorPart]:
    """Errors of R, of t and of the last row of an exponential.

    Parameters
    ----------
    xi : (6,) or (3,) ndarray
        Twist (ω; v) in rad and m, or rotation vector in rad.
    X : (4, 4) or (3, 3) ndarray
        Result under test: pose in the base frame, m, or rotation.
    precision : Precision, optional
        Precision that the function computes in, `conform.DOUBLE` or `conform.SINGLE`.

    Returns
    -------
    parts : list of ErrorPart
        The errors, each with its scale and what floats can attain.
    """
    error = exact.exactly(X) - exact.exp(xi)
    angular = precision.unit * (1 + 2**0.5 * norm(xi[:3]))
    turned = norm(error[:3, :3])
    parts = [ErrorPart("R (rad)", turned, 2**0.5, angular, precision)]
    if len(xi) == 3:
        return parts
    moved = norm(error[:3, 3])
    v = norm(xi[3:])

    def bound() -> float:
        return precision.coarser * float(error_bounds.exp_bound(xi).linear)

    linear = precision.unit * v
    last = norm(error[3])
    parts.append(ErrorPart("t ÷ |v|", moved, v, linear, precision, bound))
    parts.append(ErrorPart("last row", last, 1.0, 0.0, precision))
    return parts


def log_is_the_principal_logarithm(
    log: ArrayFunction,
    X: Array,
    at_most: Grade = Grade.EXACT,
    precision: Precision = DOUBLE,
) -> Verdict:
    """Law: log X is the principal logarithm, 0 ≤ |ω| ≤ π; v in proportion to the lengths.

    Within 8 u of π both signs of ω count as right, each with its v.

    Parameters
    ----------
    log : callable
        Function under test.
    X : (4, 4) or (3, 3) ndarray
        Pose of a frame in the base frame, m, or rotation.
    at_most : Grade, optional
        Worst grade that is let pass.
    precision : Precision, optional
        Precision that the function computes in, `conform.DOUBLE` or `conform.SINGLE`.

    Returns
    -------
    verdict : Verdict
        The verdict on the worst part.

    Raises
    ------
    LawViolation
        If the grade is worse than `at_most`.
    """
    size = TWIST_SIZE.get(len(X), 6)
    xi, fault = called(log, (size,), X)
    parts = fault or log_parts(X, xi, precision)
    return graded("log is the principal logarithm", parts, at_most, X=X)


def log_parts(
    X: Array,
    xi: Array,
    precision: Precision = DOUBLE,
) -> list[ErrorPart]:
    """Errors of ω and v of a logarithm.

    Parameters
    ----------
    X : (4, 4) or (3, 3) ndarray
        Pose of a frame in the base frame, m, or rotation.
    xi : (6,) or (3,) ndarray
        Result under test: twist (ω; v) in rad and m, or rotation vector in rad.
    precision : Precision, optional
        Precision that the function computes in, `conform.DOUBLE` or `conform.SINGLE`.

    Returns
    -------
    parts : list of ErrorPart
        The errors, each with its scale and what floats can attain.
    """
    truth = exact.log(X)
    candidates = [_log_parts(truth, xi, X, precision)]
    short_of_pi = exact.mp.pi - exact.norm(truth[:3])
    if short_of_pi < precision.coarser * error_bounds.BOTH_SIGNS:
        other = error_bounds.other_sign(truth)
        candidates.append(_log_parts(other, xi, X, precision))
    return min(candidates, key=_worst)


def _worst(parts: list[ErrorPart]) -> tuple[Grade, float]:
    return max((part.grade, part.size) for part in parts)


def _log_parts(
    truth: np.ndarray,
    xi: Array,
    X: Array,
    precision: Precision,
) -> list[ErrorPart]:
    error = exact.exactly(xi) - truth
    theta = norm(truth[:3])
    # Below the smallest angle squares underflow: all that is asked for is a small number that is
    # none of the faults.
    least = precision.smallest
    if theta >= precision.smallest:
        least = precision.unit * theta

    def angular() -> float:
        bound = error_bounds.log_bound(truth).angular
        return max(precision.coarser * float(bound), least)

    def linear() -> float:
        return precision.coarser * float(error_bounds.log_bound(truth).linear)

    turned = norm(error[:3])
    parts = [ErrorPart("ω (rad)", turned, 1.0, least, precision, angular)]
    if len(xi) == 6:
        v = norm(truth[3:])
        scale = max(v, norm(X[:3, 3]))
        missed = norm(error[3:])
        attainable = precision.unit * v
        parts.append(ErrorPart("v ÷ |v|", missed, scale, attainable, precision, linear))
    return parts


def log_forgives_noise(
    log: ArrayFunction,
    R: Array,
    at_most: Grade = Grade.EXACT,
    precision: Precision = DOUBLE,
) -> Verdict:
    """Law: log of a rotation with noise is that of the nearest rotation.

    Either sign is right within 8 u of π.

    Parameters
    ----------
    log : callable
        Function under test.
    R : (3, 3) ndarray
        Rotation with noise in its entries.
    at_most : Grade, optional
        Worst grade that is let pass.
    precision : Precision, optional
        Precision that the function computes in, `conform.DOUBLE` or `conform.SINGLE`.

    Returns
    -------
    verdict : Verdict
        The verdict on the worst part.

    Raises
    ------
    LawViolation
        If the grade is worse than `at_most`.
    """
    w, fault = called(log, (3,), R)
    if fault:
        return graded("log forgives noise", fault, at_most, R=R)
    near_pi = precision.coarser * error_bounds.BOTH_SIGNS
    error = error_bounds.log_error(w, exact.log(R), near_pi)
    least = precision.coarser * NOISE_BAR / EXP_LOG_BAR
    parts = [ErrorPart("ω (rad)", error, 1.0, least, precision)]
    return graded("log forgives noise", parts, at_most, R=R)


def adjoint_is_its_matrix(
    adjoint: ArrayFunction,
    T: Array,
    at_most: Grade = Grade.EXACT,
    precision: Precision = DOUBLE,
) -> Verdict:
    """Law: Ad(T) = [R 0; [t] R R]; the lower corner in proportion to |t|.

    Parameters
    ----------
    adjoint : callable
        Function under test.
    T : (4, 4) ndarray
        Pose of a frame in the base frame, m.
    at_most : Grade, optional
        Worst grade that is let pass.
    precision : Precision, optional
        Precision that the function computes in, `conform.DOUBLE` or `conform.SINGLE`.

    Returns
    -------
    verdict : Verdict
        The verdict on the worst part.

    Raises
    ------
    LawViolation
        If the grade is worse than `at_most`.
    """
    X, fault = called(adjoint, (6, 6), T)
    if fault:
        return graded("adjoint is its matrix", fault, at_most, T=T)
    error = exact.exactly(X) - exact.adjoint(T)
    t = norm(T[:3, 3])
    corner = norm(error[3:, :3])
    rest = max(map(norm, (error[:3, :3], error[3:, 3:], error[:3, 3:])))
    # R is there already; of [t] R each entry is a difference of two products.
    u = precision.unit
    parts = [
        ErrorPart("R", rest, 1.0, u, precision),
        ErrorPart("[t] R ÷ |t|", corner, t, 2 * u * t, precision),
    ]
    return graded("adjoint is its matrix", parts, at_most, T=T)


def jacobian_of_exp(name: JacobianName) -> Callable[..., Verdict]:
    """Law of one of the Jacobians of exp: it is that of `exact`, |ω| up to 10 or π.

    3×3 blocks are taken as they are, the Q block in proportion to |v|.

    Parameters
    ----------
    name : {"left_jacobian", "right_jacobian", "left_jacobian_inverse", "right_jacobian_inverse"}
        Name of the Jacobian.

    Returns
    -------
    law : callable
        The law, law(function, xi, at_most, precision), of a twist (6,) or rotation vector (3,).
    """
    truth = getattr(exact, name)

    def law(
        function: ArrayFunction,
        xi: Array,
        at_most: Grade = Grade.EXACT,
        precision: Precision = DOUBLE,
    ) -> Verdict:
        n = len(xi)
        J, fault = called(function, (n, n), xi)
        title = f"{name.replace('_', ' ')} is attained"
        if fault:
            return graded(title, fault, at_most, xi=xi)
        diagonal, corner = jacobian_errors(J, truth(xi), xi)
        least = precision.coarser * JACOBIAN_BAR / EXP_LOG_BAR
        parts = [ErrorPart("3×3 block", diagonal, 1.0, least, precision)]
        if n == 6:
            parts.append(ErrorPart("Q block ÷ |v|", corner, 1.0, least, precision))
        return graded(title, parts, at_most, xi=xi)

    law.__name__ = f"{name}_is_attained"
    law.__doc__ = f"{name} of a twist (6,) or rotation vector (3,): 3×3 blocks as they are, Q in proportion to |v|."
    return law
