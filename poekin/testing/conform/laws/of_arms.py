"""Laws of an arm's pose and Jacobian against the product of exponentials in 80 digits.

What float64 can attain of a pose of n joints is taken as u (2 + n + √2 Σ |angle|) for R: each
factor and the result are rounded once, and so is each angle, of joints and of the arm's own; and
that times the arm's lengths for t: all that go into it, and what slides. The same holds for the
columns of the Jacobian.

Parameters: fk, jacobian, the functions under test, of q (m,) in rad or m; arm, an `ArmData` or a
`poekin.Chain`; screws
(n, 6), (ω; v), and home (4, 4) in the base frame; q (m,); T (4, 4), J (6, m), what came of it;
frame, "space", "body" or "hybrid"; at_most, the worst `Grade` that is let pass; precision that the
function computes in (`precision.SINGLE`, unit 2⁻²⁴). Returns: `Verdict`, or the parts that it is
made of.
Raises: LawViolation where the grade is worse than `at_most`.
Source: Park 1994, eqs. (1) and (11), in 80 digits (`exact`).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from ....model.kinematics.pose_jacobian import FRAME_NAMES
from ...accuracy.error_bounds import UNIT
from ...laws.measures import size
from ...oracles import exact, exact_chain
from ..grades import Grade, Part, Verdict, graded
from ..process.calls import called
from ..subjects.precision import DOUBLE, Precision

Function = Callable[[np.ndarray], Any]


class ArmData(NamedTuple):
    """An arm as data, in floats or in numbers of `exact`: screws (n, 6) and home (4, 4) in the base
    frame, x = C q + c.

    Further fields: coupling (n, m) and offset (n,), C and c; dof, m.

    It has what is asked of a `poekin.Chain` here. reach: the lengths that went into it, in m; a
    pose's translation may come out much smaller, and then no better than theirs. turned: the angles
    in rad that went into it beside q.
    """

    screws: np.ndarray
    home: np.ndarray
    coupling: np.ndarray
    offset: np.ndarray
    dof: int
    reach: float
    turned: float = 0.0


def arm(screws: np.ndarray, home: np.ndarray) -> ArmData:
    """An arm with a coordinate for each joint, made of these numbers."""
    n = len(screws)
    turns = np.any(screws[:, :3] != 0, axis=1)
    reach = size(home[:3, 3]) + sum(size(v) for v in screws[turns, 3:])
    return ArmData(screws, home, np.eye(n), np.zeros(n), n, reach)


def pose(arm: Any, q: np.ndarray) -> np.ndarray:
    """e^{A_1 x_1} ⋯ e^{A_n x_n} M (4, 4), exactly."""
    return exact_chain.pose(arm, q)


def error_bound(
    arm: Any,
    q: np.ndarray,
    unit: float = UNIT,
) -> tuple[float, float]:
    """Error of R that float64 can attain, and the lengths that the error of t is in proportion to.

    Whoever made a `poekin.Chain` had numbers of his own for it: a radian for each joint, and its
    reach.
    """
    x = exact.rounded(exact_chain.displacements(arm, q))
    A = _floats(arm.screws)
    M = _floats(arm.home)
    turns = np.any(A[:, :3] != 0, axis=1)
    angles = float(np.abs(x[turns]).sum()) + float(getattr(arm, "turned", len(x)))
    lengths = arm.reach + float(np.abs(x[~turns]).sum())
    return unit * (2 + len(x) + 2**0.5 * angles) + size(
        M[:3, :3] @ M[:3, :3].T - np.eye(3)
    ), lengths


def fk_is_the_product_of_exponentials(
    fk: Function,
    arm: Any,
    q: np.ndarray,
    at_most: Grade = Grade.EXACT,
    precision: Precision = DOUBLE,
) -> Verdict:
    """fk(q) (4, 4) = e^{A_1 x_1} ⋯ e^{A_n x_n} M of the arm (`ArmData`, or a `poekin.Chain`)."""
    T, fault = called(fk, (4, 4), q)
    parts = fault or pose_parts(arm, q, T, precision)
    return graded("fk is the product of exponentials", parts, at_most, q=q)


def pose_parts(
    arm: Any,
    q: np.ndarray,
    T: np.ndarray,
    precision: Precision = DOUBLE,
) -> list[Part]:
    """The errors of R and t, and of the last row."""
    error = exact.exactly(T) - pose(arm, q)
    angular, lengths = error_bound(arm, q, precision.unit)
    t = float(exact.norm(error[:3, 3]))
    return [
        Part(
            "R (rad)", float(exact.norm(error[:3, :3])), 2**0.5, angular, lambda: angular, precision
        ),
        Part("t ÷ the arm's lengths", t, lengths, angular * lengths, lambda: 0.0, precision),
        Part("last row", float(exact.norm(error[3])), 1.0, 0.0, lambda: 0.0, precision),
    ]


def jacobian_is_the_derivative(
    jacobian: Function,
    frame: str,
    arm: Any,
    q: np.ndarray,
    at_most: Grade = Grade.EXACT,
    precision: Precision = DOUBLE,
) -> Verdict:
    """jacobian(q) (6, m), rows (omega; v), is the derivative of the product of exponentials, seen
    in `frame`.
    """
    J, fault = called(jacobian, (6, arm.dof), q)
    parts = fault or jacobian_parts(frame, arm, q, J, precision)
    return graded("jacobian is the derivative", parts, at_most, q=q)


def jacobian_parts(
    frame: str, arm: Any, q: np.ndarray, J: np.ndarray, precision: Precision = DOUBLE
) -> list[Part]:
    """The errors of the worst column's ω and v."""
    truth = exact_chain.jacobians(arm, exact.exactly(q))[FRAME_NAMES.index(frame)]
    error = exact.exactly(J) - truth
    angular, lengths = error_bound(arm, q, precision.unit)
    ratios = 1 + size(arm.coupling)
    slides = 0.0 if np.all(np.any(_floats(arm.screws)[:, :3] != 0, axis=1)) else 1.0
    w, v = (
        max((float(exact.norm(column)) for column in half.T), default=0.0)
        for half in (error[:3], error[3:])
    )
    scale = 2 * lengths + slides
    return [
        Part("ω of a column", w, 1.0, ratios * angular, lambda: 0.0, precision),
        Part(
            "v of a column ÷ the arm's lengths",
            v,
            scale,
            ratios * angular * scale,
            lambda: 0.0,
            precision,
        ),
    ]


def _floats(x: np.ndarray) -> np.ndarray:
    return exact.rounded(exact.exactly(x))
