"""A law that a subject can be held to, and the cases it is tried on: numbers that shrink towards
zero.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...laws.measures import size
from ...strategies.group_strategies import st
from ..grades import Verdict

if TYPE_CHECKING:
    from ..subjects.subject import Subject


class Case(NamedTuple):
    """Case that a law is tried on: numbers that shrink towards zero.

    Parameters
    ----------
    numbers : (k,) ndarray
        Arguments of the law, 0 where nothing is; of a group's law exponential coordinates ω or (ω; v).
    layout : hashable, default ()
        Record of what the numbers belong to.
    """

    numbers: np.ndarray
    layout: Any = ()


Cases = st.SearchStrategy[Case]


class Shown(NamedTuple):
    """Case for people.

    Parameters
    ----------
    words : str
        The case in words.
    paste : str
        Python that makes the call and prints its result.
    expected : ndarray or None
        Exact result; None where it is no one array.
    names : tuple of str, optional
        Coordinates that a URDF has to be read with, which the Python prints first.
    """

    words: str
    paste: str
    expected: np.ndarray | None
    names: tuple[str, ...] = ()


def nothing(_: Case) -> Iterable[Any]:
    """Neither parts that could be left out, nor places."""
    return ()


def always(_: object) -> bool:
    """Whether a law holds of any case or subject: it does."""
    return True


class SubjectLaw(NamedTuple):
    """Law that a subject can be held to, with the cases that it is tried on.

    Parameters
    ----------
    name : str
        Name on the command line.
    says : str
        Claim in words.
    needs : str
        Function of the subject that the law is about.
    cases : callable
        Strategy of the cases for a subject.
    check : callable
        Measurement, check(subject, case), which returns a verdict.
    confirm : callable
        Whether the truth of a case stands against the second oracle, confirm(subject, case).
    show : callable
        The case for people, show(subject, case).
    simpler : callable, optional
        Cases with a part left out.
    triples : callable, optional
        First places of those three numbers that are a vector.
    directions : callable, optional
        First places of those three numbers that are a unit vector.
    allowed : callable, optional
        Whether the law could have drawn a case.
    applies : callable, optional
        Whether a subject is held to the law.
    about : callable, optional
        Whether what the law is about is in a case at all.
    unless : str, optional
        Reason why a subject is not held to it.
    examples : int, default 100
        Number of cases.
    """

    name: str
    says: str
    needs: str
    cases: Callable[[Subject], Cases]
    check: Callable[[Subject, Case], Verdict]
    confirm: Callable[[Subject, Case], bool]
    show: Callable[[Subject, Case], Shown]
    simpler: Callable[[Case], Iterable[Case]] = nothing
    triples: Callable[[Case], Iterable[int]] = lambda case: range(0, len(case.numbers) - 2, 3)
    directions: Callable[[Case], Iterable[int]] = nothing
    allowed: Callable[[Case], bool] = always
    applies: Callable[[Subject], bool] = always
    about: Callable[[Case], bool] = always
    unless: str = ""
    examples: int = 100


SLACK = 1e-9
"""By how much in proportion a number may lie beyond what is drawn: a length comes from rounded
components.
"""


def drawable(x: float, bounds: tuple[float, float]) -> bool:
    """Whether a magnitude is 0 or lies within the bounds of what is drawn."""
    return x == 0 or bounds[0] * (1 - SLACK) <= abs(x) <= bounds[1] * (1 + SLACK)


def unit(x: np.ndarray) -> bool:
    """Whether a vector has length 1, to rounding."""
    return abs(size(x) - 1) <= SLACK


def typed(x: Any) -> str:
    """An array as Python text, to the last digit; zeros short, but never all of them: it is an
    array of floats.
    """
    text = repr((np.asarray(x, dtype=float) + 0.0).tolist())
    short = text.replace("0.0,", "0,").replace("0.0]", "0]")
    if "." in short or "e" in short:
        return short
    return text
