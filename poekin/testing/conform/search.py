"""The hunt for the worst case of one law, within a number of examples and seconds; the same cases
in every run.
"""

from __future__ import annotations

import math
import time
from typing import NamedTuple

from ...errors import InputError
from ..accuracy.falsify import for_each
from .grades import Grade, Verdict
from .laws.law import Case, SubjectLaw
from .process.calls import UNANSWERED
from .shrink import shrunk
from .subjects.subject import Subject

# `law` has said what to install where hypothesis is missing.
from hypothesis import target  # isort: skip
from hypothesis.errors import Flaky, Unsatisfiable  # isort: skip

ENOUGH = 100
"""Examples after which nothing is gained by more, once something is broken."""
LEAST = 10
"""So many examples are tried however long they take."""
SHRINKING = 30.0
"""Seconds that shrinking may take."""
SHORT = 2.0
"""Seconds after which a call that is not answered is given up while shrinking."""


class SearchResult(NamedTuple):
    """Result of a search: the number of cases tried, the worst one, its verdict, and the shrunk case
    where it is a finding.

    late: whether there was no time for the others.
    """

    examples: int
    case: Case
    verdict: Verdict
    shrunk: Case | None
    late: bool


class _Over(Exception):
    """The time is up, or enough was seen."""


def worst(
    law: SubjectLaw,
    subject: Subject,
    examples: int,
    seconds: float,
    at_most: Grade = Grade.GOOD,
) -> SearchResult:
    """Hunt the worst case, towards larger errors; shrink it where it is poor or broken, or worse
    than `at_most`.
    """
    end = time.monotonic() + seconds
    count = 0
    late = False
    top: tuple[Case, Verdict] | None = None

    def one(case: Case) -> None:
        nonlocal count, late, top
        late = late or (time.monotonic() > end and count >= LEAST)
        broken = top is not None and top[1].grade is Grade.BROKEN
        if late or (broken and count >= ENOUGH) or (top and top[1].ended):
            raise _Over
        precision = subject.precision(law.needs)
        case = rounded(law, subject, case)
        verdict = law.check(subject, case)
        if subject.precision(law.needs) is not precision:  # as the result said
            case = rounded(law, subject, case)
            verdict = law.check(subject, case)
        count += 1
        if top is None or verdict.rank > top[1].rank:
            top = case, verdict
        target(math.log10(min(max(verdict.size, 1e-30), 1e30)))

    try:
        for_each(law.cases(subject), examples, one)
    except (_Over, Flaky, Unsatisfiable):
        # a case that there had been time for is tried again, or there is none, as is said below
        pass
    if top is None:
        raise InputError(f"{law.name}: no case of this law could be drawn")
    case, verdict = top
    small = None
    if verdict.grade > min(at_most, Grade.GOOD):
        small = simplest(law, subject, case, verdict)
    return SearchResult(count, case, verdict, small, late)


def rounded(
    law: SubjectLaw,
    subject: Subject,
    case: Case,
) -> Case:
    """The case in floats of the precision that the law's function computes in, which can tell no
    others apart.
    """
    return case._replace(numbers=subject.precision(law.needs).rounded(case.numbers))


def simplest(
    law: SubjectLaw,
    subject: Subject,
    case: Case,
    verdict: Verdict,
) -> Case:
    """The simplest case found that fails in the manner of this one.

    It has the grade and the kind of fault of the verdict, on what the law could have drawn. What
    the law is about stays in it as long as anything else can go: who errs in two ways shows the one
    that is the law's.
    """
    end = time.monotonic() + SHRINKING

    def fails(other: Case) -> bool:
        if time.monotonic() >= end:
            return False
        return law.check(subject, rounded(law, subject, other)).manner == verdict.manner

    own = law._replace(allowed=lambda other: law.allowed(other) and law.about(other))

    def smallest() -> Case:
        first = shrunk(own, case, fails)
        return rounded(law, subject, shrunk(law, first, fails))

    if not verdict.fault.startswith(UNANSWERED):
        return smallest()
    with subject.own.within(SHORT):
        small = smallest()
    # What takes longer than that may still be answered.
    if law.check(subject, small).manner == verdict.manner:
        return small
    return case
