"""Laws of exp, log, the adjoint and the Jacobians of exp, of SO(3) and SE(3), against the truth in
80 digits.

Each law is a plain function of a subject's function with twists (omega; v), and of an argument: it
returns the verdict, and raises LawViolation where that is worse than `at_most`. What float64 can
attain is `error_bounds`'s for exp and log, and a third of `accuracy_laws.JACOBIAN_BAR` for the
Jacobians; in float32, 2²⁹ times as much.

Parameters: the function under test; xi, the twist (6,), (ω; v) in rad and m, or rotation vector
(3,); X, T, a pose
(4, 4) of a frame in the base frame, or R, X, a rotation (3, 3); at_most, the worst `Grade` that is
let pass; precision that the function computes in (`precision.DOUBLE`, `SINGLE`), and xi, X, T are
floats of; name, of one of `subject.JACOBIANS`. Returns: `Verdict`, or the parts that it is made of.
Raises: LawViolation where the grade is worse than `at_most`. Source: Park 1994, Lemmas 1 to 5, in
80 digits (`exact`).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ...accuracy import error_bounds
from ...accuracy.accuracy_laws import EXP_LOG_BAR, JACOBIAN_BAR, NOISE_BAR, jacobian_errors
from ...oracles import exact
from ..grades import Grade, Part, Verdict, graded
from ..process.calls import called
from ..subjects.precision import DOUBLE, Precision

Function = Callable[[np.ndarray], Any]
ELEMENT_SIZE = {3: 3, 6: 4}
"""Rows of a rotation or pose, by the length of its twist."""
TWIST_SIZE = {3: 3, 4: 6}
"""Length of a twist, by the rows of its rotation or pose."""


def exp_is_e_to_the_xi(
    exp: Function, xi: np.ndarray, at_most: Grade = Grade.EXACT, precision: Precision = DOUBLE
) -> Verdict:
    """exp ξ = e^[ξ], of a twist (6,) or rotation vector (3,); R as it is, t in proportion to |v|."""
    size = ELEMENT_SIZE.get(len(xi), 4)
    X, fault = called(exp, (size, size), xi)
    return graded("exp is e to the xi", fault or exp_parts(xi, X, precision), at_most, xi=xi)


def exp_parts(
    xi: np.ndarray,
    X: np.ndarray,
    precision: Precision = DOUBLE,
) -> list[Part]:
    """The errors of R and t, and of the last row, of X as the exponential of ξ."""
    error = exact.exactly(X) - exact.exp(xi)
    theta = float(exact.norm(exact.exactly(xi[:3])))
    angular = precision.unit * (1 + 2**0.5 * theta)
    parts = [
        Part(
            "R (rad)", float(exact.norm(error[:3, :3])), 2**0.5, angular, lambda: angular, precision
        )
    ]
    if len(xi) == 6:
        v = float(exact.norm(exact.exactly(xi[3:])))
        linear = float(exact.norm(error[:3, 3]))

        def bound() -> float:
            return precision.coarser * float(error_bounds.exp_bound(xi).linear)

        parts.append(Part("t ÷ |v|", linear, v, precision.unit * v, bound, precision))
        parts.append(
            Part("last row", float(exact.norm(error[3])), 1.0, 0.0, lambda: 0.0, precision)
        )
    return parts


def log_is_the_principal_logarithm(
    log: Function, X: np.ndarray, at_most: Grade = Grade.EXACT, precision: Precision = DOUBLE
) -> Verdict:
    """log X of a rotation (3, 3) or pose (4, 4), 0 ≤ |ω| ≤ π; ω in rad, v in proportion to the
    lengths.

    Within 8 u of π both signs of ω count as right, each with its v.
    """
    xi, fault = called(log, (TWIST_SIZE.get(len(X), 6),), X)
    return graded(
        "log is the principal logarithm", fault or log_parts(X, xi, precision), at_most, X=X
    )


def log_parts(
    X: np.ndarray,
    xi: np.ndarray,
    precision: Precision = DOUBLE,
) -> list[Part]:
    """The errors of ω and v of ξ as the logarithm of X."""
    truth = exact.log(X)
    candidates = [_log_parts(truth, xi, X, precision)]
    if exact.mp.pi - exact.norm(truth[:3]) < precision.coarser * error_bounds.BOTH_SIGNS:
        candidates.append(_log_parts(_other_sign(truth, X), xi, X, precision))
    return min(candidates, key=lambda parts: max((part.grade, part.size) for part in parts))


def _other_sign(truth: np.ndarray, X: np.ndarray) -> np.ndarray:
    """The logarithm of X with the opposite ω, one turn the other way round."""
    w = -truth[:3]
    if len(X) == 3:
        return w
    return np.concatenate([w, exact.left_jacobian_inverse(w) @ exact.exactly(X[:3, 3])])


def _log_parts(
    truth: np.ndarray, xi: np.ndarray, X: np.ndarray, precision: Precision
) -> list[Part]:
    error = exact.exactly(xi) - truth
    theta = float(exact.norm(truth[:3]))
    # Below the smallest angle squares underflow: all that is asked for is a small number that is
    # none of the faults.
    least = precision.smallest
    if theta >= precision.smallest:
        least = precision.unit * theta

    def angular() -> float:
        return max(precision.coarser * float(error_bounds.log_bound(truth).angular), least)

    def linear() -> float:
        return precision.coarser * float(error_bounds.log_bound(truth).linear)

    parts = [Part("ω (rad)", float(exact.norm(error[:3])), 1.0, least, angular, precision)]
    if len(xi) == 6:
        v = float(exact.norm(truth[3:]))
        t = float(exact.norm(exact.exactly(X[:3, 3])))
        missed = float(exact.norm(error[3:]))
        parts.append(Part("v ÷ |v|", missed, max(v, t), precision.unit * v, linear, precision))
    return parts


def log_forgives_noise(
    log: Function, R: np.ndarray, at_most: Grade = Grade.EXACT, precision: Precision = DOUBLE
) -> Verdict:
    """log of a rotation (3, 3) with noise is that of the nearest rotation; either sign within 8 u
    of π.
    """
    w, fault = called(log, (3,), R)
    if fault:
        return graded("log forgives noise", fault, at_most, R=R)
    truth = exact.log(R)
    error = error_bounds.log_error(w, truth, precision.coarser * error_bounds.BOTH_SIGNS)
    least = precision.coarser * NOISE_BAR / EXP_LOG_BAR
    return graded(
        "log forgives noise",
        [Part("ω (rad)", error, 1.0, least, lambda: least, precision)],
        at_most,
        R=R,
    )


def adjoint_is_its_matrix(
    adjoint: Function, T: np.ndarray, at_most: Grade = Grade.EXACT, precision: Precision = DOUBLE
) -> Verdict:
    """Ad(T) = [R 0; [t] R R] (6, 6) of a pose (4, 4); the lower corner in proportion to |t|."""
    X, fault = called(adjoint, (6, 6), T)
    if fault:
        return graded("adjoint is its matrix", fault, at_most, T=T)
    error = exact.exactly(X) - exact.adjoint(T)
    t = float(exact.norm(exact.exactly(T[:3, 3])))
    corner = exact.norm(error[3:, :3])
    rest = float(max(map(exact.norm, (error[:3, :3], error[3:, 3:], error[:3, 3:]))))
    # R is there already; of [t] R each entry is a difference of two products.
    u = precision.unit
    parts = [
        Part("R", rest, 1.0, u, lambda: u, precision),
        Part("[t] R ÷ |t|", float(corner), t, 2 * u * t, lambda: 2 * u * t, precision),
    ]
    return graded("adjoint is its matrix", parts, at_most, T=T)


def jacobian_of_exp(name: str) -> Callable[..., Verdict]:
    """The law of one of `subject.JACOBIANS`, as (function, ω or ξ, at_most): it is that of `exact`,
    |ω| up to 10 or π.

    3×3 blocks as they are, the Q block in proportion to |v|.
    """
    truth = getattr(exact, name)

    def law(
        function: Function,
        xi: np.ndarray,
        at_most: Grade = Grade.EXACT,
        precision: Precision = DOUBLE,
    ) -> Verdict:
        J, fault = called(function, (len(xi), len(xi)), xi)
        title = f"{name.replace('_', ' ')} is attained"
        if fault:
            return graded(title, fault, at_most, xi=xi)
        diagonal, corner = jacobian_errors(J, truth(xi), xi)
        least = precision.coarser * JACOBIAN_BAR / EXP_LOG_BAR
        parts = [Part("3×3 block", diagonal, 1.0, least, lambda: least, precision)]
        if len(xi) == 6:
            parts.append(Part("Q block ÷ |v|", corner, 1.0, least, lambda: least, precision))
        return graded(title, parts, at_most, xi=xi)

    law.__name__ = f"{name}_is_attained"
    law.__doc__ = f"{name} of a twist (6,) or rotation vector (3,): 3×3 blocks as they are, Q in proportion to |v|."
    return law
