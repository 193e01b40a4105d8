"""Grades: how well a function of somebody else's keeps a law, from its measured errors.

    exact    every error ≤ 3 × what float64 can attain
    good     ≤ 1e-10
    poor     ≤ 1e-6
    broken   worse; NaN or infinite; an exception; a wrong shape

Of a subject in float32: 3 × what float32 can attain, 1e-5, and 1e-3 (`precision`).

Rotations are judged by their angle in rad (‖ΔR‖ ÷ √2, Frobenius); rotation vectors and 3×3 blocks
are taken as they are; translations, v and Q blocks in proportion to the lengths that went in. Which
of two signs at π, or which branch, is an error like any other.
"""

from __future__ import annotations

import enum
import math
import re
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from ..accuracy import error_bounds
from ..accuracy.accuracy_laws import EXP_LOG_BAR
from ..laws.laws import LawViolation
from ..oracles import exact
from .process.calls import ENDED, LOST, UNANSWERED
from .subjects.precision import DOUBLE, Precision

NO_RESULT = "no result"
"""What a verdict is of where there is nothing to measure."""


class Grade(enum.IntEnum):
    """Grade of a result, the larger, the worse: EXACT, GOOD, POOR, BROKEN."""

    EXACT = 0
    GOOD = 1
    POOR = 2
    BROKEN = 3

    @property
    def word(self) -> str:
        """Word of the grade, as it is printed."""
        return self.name.lower()


class ErrorPart(NamedTuple):
    """Measured error, with its scale and what floats can attain.

    Parameters
    ----------
    what : str
        Quantity in error.
    error : float
        Size of the error, in the quantity's own unit.
    scale : float
        Size that the error is in proportion to.
    least : float
        Lower bound of what floats can attain, which costs nothing.
    precision : Precision, optional
        Precision that the subject computes in.
    error_bound : callable, optional
        Function that computes what floats can attain; called only if the error exceeds 3 × `least`. By
        default it is `least`.
    """

    what: str
    error: float
    scale: float
    least: float
    precision: Precision = DOUBLE
    error_bound: Callable[[], float] | None = None

    @property
    def size(self) -> float:
        """Error ÷ scale; where the scale is 0, an error of 0 is 0 and any other infinite."""
        return error_bounds.ratio(self.error, self.scale)

    @property
    def bound(self) -> float:
        """Largest error that is exact."""
        cheap = EXP_LOG_BAR * self.least
        if self.error <= cheap or self.error_bound is None:
            return cheap
        return max(cheap, EXP_LOG_BAR * self.error_bound())

    @property
    def grade(self) -> Grade:
        """Grade of this error alone; NaN is broken."""
        if self.error <= self.bound:
            return Grade.EXACT
        if self.size <= self.precision.good:
            return Grade.GOOD
        if self.size <= self.precision.poor:
            return Grade.POOR
        return Grade.BROKEN


class Verdict(NamedTuple):
    """Verdict on one case.

    Attributes
    ----------
    grade : Grade
        Grade of the worst part.
    size : float
        Error ÷ scale that decided it.
    what : str
        Quantity in error.
    fault : str
        Fault, where there is no result; "" else.
    """

    grade: Grade
    size: float
    what: str
    fault: str = ""

    @property
    def manner(self) -> tuple[Grade, str]:
        """Manner of failing: the grade, and the kind of fault without its particulars."""
        fault = re.sub(r"^of link \w+: ", "", self.fault)
        return self.grade, " ".join(re.split(r"[:(]", fault)[0].split()[:2])

    @property
    def ended(self) -> bool:
        """Whether the subject's process ended, or had to be ended: nothing is worse."""
        return self.fault.startswith((ENDED, UNANSWERED, LOST))

    @property
    def rank(self) -> tuple[int, float]:
        """Grade and size, to find the worst of many."""
        return self.grade, self.size


def norm(x: np.ndarray) -> float:
    """Euclidean or Frobenius norm of floats or of numbers of `exact`, rounded once."""
    return float(exact.norm(exact.exactly(x)))


def largest_size(grade: Grade, precision: Precision) -> float:
    """Largest error ÷ scale of a grade, where only the size decides; else 0."""
    return {Grade.GOOD: precision.good, Grade.POOR: precision.poor}.get(grade, 0.0)


def graded(
    law: str,
    parts: Sequence[ErrorPart] | str,
    at_most: Grade = Grade.BROKEN,
    **seen: object,
) -> Verdict:
    """The verdict on a case: that of the worst of its parts, or on a fault (a text: no result at
    all).

    Raises: LawViolation, with the error and its bound, where the grade is worse than `at_most`; so
    `at_most` broken measures, and never raises.
    """
    if isinstance(parts, str):
        verdict = Verdict(Grade.BROKEN, math.inf, NO_RESULT, parts)
        error = math.inf
        bound = 0.0
        seen = {"fault": parts, **seen}
    else:
        worst = max(parts, key=lambda part: (part.grade, part.size))
        verdict = Verdict(worst.grade, worst.size, worst.what)
        error = worst.size
        bound = largest_size(at_most, worst.precision)
        if at_most is Grade.EXACT:
            error = worst.error
            bound = worst.bound
    if verdict.grade > at_most:
        raise LawViolation(f"{law}: {verdict.what}", error, bound, seen)
    return verdict
