"""A law that a subject can be held to, and the cases it is tried on: numbers that shrink towards
zero.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...laws.measures import size
from ...strategies.group_strategies import st
from ..grades import Verdict

if TYPE_CHECKING:
    from ..subjects.subject import Subject


class Case(NamedTuple):
    """Arguments of a law as float64 numbers (k,), 0 where nothing is, and the layout that says what
    they belong to.

    Of a group's law the numbers are exponential coordinates, ω or (ω; v).
    """

    numbers: np.ndarray
    layout: Hashable = ()


class Shown(NamedTuple):
    """A case for people: in words, as Python to paste, and what ought to come of it (None where it
    is no one array).

    names: of the coordinates that a URDF has to be read with, which the Python prints first.
    """

    words: str
    paste: str
    expected: np.ndarray | None
    names: tuple[str, ...] = ()


def nothing_simpler(case: Case) -> Iterable[Case]:
    """For cases that have no parts which could be left out."""
    return ()


class SubjectLaw(NamedTuple):
    """One law: `check(subject, case)` measures, `confirm(subject, case)` asks the second oracle
    about the truth.

    name: as on the command line; says: what is held, in words; needs: the function of the subject
    that it is about; cases(subject): what it is tried on; show(subject, case): for people;
    simpler(case): cases with a part left out; triples: where among the numbers three are a vector,
    each one's first place; directions: the same of unit vectors; allowed(case): whether the law
    could have drawn it; about(case): whether what the law is about is in it at all;
    applies(subject): whether it is to be held to it; unless, why it is not; examples, how many
    cases it is tried on.
    """

    name: str
    says: str
    needs: str
    cases: Callable[[Subject], st.SearchStrategy[Case]]
    check: Callable[[Subject, Case], Verdict]
    confirm: Callable[[Subject, Case], bool]
    show: Callable[[Subject, Case], Shown]
    simpler: Callable[[Case], Iterable[Case]] = nothing_simpler
    triples: Callable[[Case], Iterable[int]] = lambda case: range(0, len(case.numbers) - 2, 3)
    directions: Callable[[Case], Iterable[int]] = lambda case: ()
    allowed: Callable[[Case], bool] = lambda case: True
    applies: Callable[[Subject], bool] = lambda subject: True
    about: Callable[[Case], bool] = lambda case: True
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
