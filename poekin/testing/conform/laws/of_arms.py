"""Laws of an arm's pose and Jacobian against the product of exponentials in 80 digits.

What float64 can attain of a pose of n joints is taken as u (2 + n + √2 Σ |angle|) for R: each
factor and the result are rounded once, and so is each angle, of joints and of the arm's own; and
that times the arm's lengths for t: all that go into it, and what slides. The same holds for the
columns of the Jacobian.

An arm is an `ArmData` or a `poekin.Chain`. Raises: LawViolation, by the laws alone.
Source: Park 1994, eqs. (1) and (11), in 80 digits (`exact`).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ....groups.arrays import Array
from ....model.kinematics.pose_jacobian import FRAME_NAMES
from ...accuracy.error_bounds import UNIT
from ...laws.measures import size
from ...oracles import exact, exact_chain
from ...oracles.differences import NamedFrame
from ..grades import ErrorPart, Grade, Verdict, graded, norm
from ..process.calls import ArrayFunction, called
from ..subjects.precision import DOUBLE, Precision


class ArmData(NamedTuple):
    """Arm as data, in floats or in numbers of `exact`, with what is asked of a `poekin.Chain` here.

    Parameters
    ----------
    screws : (n, 6) ndarray
        Screws (ω; v) of the joints in the base frame, rad and m.
    home : (4, 4) ndarray
        Home pose in the base frame.
    coupling, offset : ndarray
        C (n, m) and c (n,) of x = C q + c.
    dof : int
        Number m of coordinates.
    reach : float
        Lengths that went into it, m; a pose's translation may come out much smaller, and then no
        better than theirs.
    turned : float, default 0.0
        Angles that went into it beside q, rad.
    """

    screws: Array
    home: Array
    coupling: Array
    offset: Array
    dof: int
    reach: float
    turned: float = 0.0


def arm(screws: Array, home: Array) -> ArmData:
    """Arm with a coordinate for each joint.

    Parameters
    ----------
    screws : (n, 6) ndarray
        Screws (ω; v) of the joints in the base frame, rad and m.
    home : (4, 4) ndarray
        Home pose in the base frame.

    Returns
    -------
    arm : ArmData
        The arm.
    """
    n = len(screws)
    turns = np.any(screws[:, :3] != 0, axis=1)
    moments = sum(size(v) for v in screws[turns, 3:])
    reach = size(home[:3, 3]) + moments
    return ArmData(screws, home, np.eye(n), np.zeros(n), n, reach)


def error_bound(
    arm: Any,
    q: Array,
    unit: float = UNIT,
) -> tuple[float, float]:
    """Error of a pose that float64 can attain.

    Whoever made a `poekin.Chain` had numbers of his own for it: a radian for each joint, and its
    reach.

    Parameters
    ----------
    arm : ArmData or Chain
        The arm.
    q : (m,) ndarray
        Coordinates, rad or m.
    unit : float, optional
        Half the distance from 1 to the next float.

    Returns
    -------
    angular : float
        Attainable Frobenius norm of the error of R, rad.
    lengths : float
        Lengths that the error of t is in proportion to, m.
    """
    x = exact.rounded(exact_chain.displacements(arm, q))
    turns = _turning(arm)
    home = exact.rounded(exact.exactly(arm.home))
    R = home[:3, :3]
    own = float(getattr(arm, "turned", len(x)))
    angles = float(np.abs(x[turns]).sum()) + own
    lengths = arm.reach + float(np.abs(x[~turns]).sum())
    angular = unit * (2 + len(x) + 2**0.5 * angles)
    defect = size(R @ R.T - np.eye(3))
    return angular + defect, lengths


def fk_is_the_product_of_exponentials(
    fk: ArrayFunction,
    arm: Any,
    q: Array,
    at_most: Grade = Grade.EXACT,
    precision: Precision = DOUBLE,
) -> Verdict:
    """Law: fk(q) = e^{A_1 x_1} ⋯ e^{A_n x_n} M of the arm.

    Parameters
    ----------
    fk : callable
        Function of q (m,) under test, that returns a pose (4, 4) in the base frame.
    arm : ArmData or Chain
        The arm.
    q : (m,) ndarray
        Coordinates, rad or m.
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
    >>> from poekin.testing.conform.laws import of_arms
    >>> arm = pk.load("ur5e").chain(tip="tool0")
    >>> of_arms.fk_is_the_product_of_exponentials(arm.fk, arm, np.full(6, 0.3)).grade.word
    'exact'
    """
    T, fault = called(fk, (4, 4), q)
    parts = fault or pose_parts(arm, q, T, precision)
    return graded("fk is the product of exponentials", parts, at_most, q=q)


def pose_parts(
    arm: Any,
    q: Array,
    T: Array,
    precision: Precision = DOUBLE,
) -> list[ErrorPart]:
    """Errors of R, of t and of the last row of a pose.

    Parameters
    ----------
    arm : ArmData or Chain
        The arm.
    q : (m,) ndarray
        Coordinates, rad or m.
    T : (4, 4) ndarray
        Result under test, in the base frame.
    precision : Precision, optional
        Precision that the function computes in, `conform.DOUBLE` or `conform.SINGLE`.

    Returns
    -------
    parts : list of ErrorPart
        The errors, each with its scale and what floats can attain.
    """
    error = exact.exactly(T) - exact_chain.pose(arm, q)
    angular, lengths = error_bound(arm, q, precision.unit)
    turned = norm(error[:3, :3])
    moved = norm(error[:3, 3])
    linear = angular * lengths
    return [
        ErrorPart("R (rad)", turned, 2**0.5, angular, precision),
        ErrorPart("t ÷ the arm's lengths", moved, lengths, linear, precision),
        ErrorPart("last row", norm(error[3]), 1.0, 0.0, precision),
    ]


def jacobian_is_the_derivative(
    jacobian: ArrayFunction,
    frame: NamedFrame,
    arm: Any,
    q: Array,
    at_most: Grade = Grade.EXACT,
    precision: Precision = DOUBLE,
) -> Verdict:
    """Law: jacobian(q) is the derivative of the product of exponentials.

    Parameters
    ----------
    jacobian : callable
        Function of q (m,) under test, that returns (6, m), rows (ω; v).
    frame : {"space", "body", "hybrid"}
        Frame of the rows.
    arm : ArmData or Chain
        The arm.
    q : (m,) ndarray
        Coordinates, rad or m.
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
    J, fault = called(jacobian, (6, arm.dof), q)
    parts = fault or jacobian_parts(frame, arm, q, J, precision)
    return graded("jacobian is the derivative", parts, at_most, q=q)


def jacobian_parts(
    frame: NamedFrame,
    arm: Any,
    q: Array,
    J: Array,
    precision: Precision = DOUBLE,
) -> list[ErrorPart]:
    """Errors of ω and v of the worst column of a Jacobian.

    Parameters
    ----------
    frame : {"space", "body", "hybrid"}
        Frame of the rows.
    arm : ArmData or Chain
        The arm.
    q : (m,) ndarray
        Coordinates, rad or m.
    J : (6, m) ndarray
        Result under test, rows (ω; v), rad and m per unit of q.
    precision : Precision, optional
        Precision that the function computes in, `conform.DOUBLE` or `conform.SINGLE`.

    Returns
    -------
    parts : list of ErrorPart
        The errors, each with its scale and what floats can attain.
    """
    truths = exact_chain.jacobians(arm, exact.exactly(q))
    truth = truths[FRAME_NAMES.index(frame)]
    error = exact.exactly(J) - truth
    angular, lengths = error_bound(arm, q, precision.unit)
    ratios = 1 + size(arm.coupling)
    slides = not np.all(_turning(arm))
    scale = 2 * lengths + float(slides)
    w = max(map(norm, error[:3].T), default=0.0)
    v = max(map(norm, error[3:].T), default=0.0)
    least = ratios * angular * scale
    return [
        ErrorPart("ω of a column", w, 1.0, ratios * angular, precision),
        ErrorPart("v of a column ÷ the arm's lengths", v, scale, least, precision),
    ]


def _turning(arm: Any) -> np.ndarray:
    """Whether each joint turns."""
    screws = exact.rounded(exact.exactly(arm.screws))
    return np.any(screws[:, :3] != 0, axis=1)
