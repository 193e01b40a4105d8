"""The hunt for the worst case of one law, within a number of examples and seconds; the same cases in every run."""

from __future__ import annotations

import math
import time
from typing import NamedTuple

from ...errors import InputError
from ..hunting import repeatable
from .grades import Grade, Verdict
from .law import Case, Law
from .shrink import shrunk
from .subject import Subject

# `law` has said what to install where hypothesis is missing.
from hypothesis import given, target  # isort: skip

ENOUGH = 100
"""Examples after which nothing is gained by more, once something is broken."""
LEAST = 10
"""So many examples are tried however long they take."""
SHRINKING = 30.0
"""Seconds that shrinking may take."""


class Found(NamedTuple):
    """How many cases of a law were tried, the worst one, its verdict, and the shrunk case where it is a finding."""

    examples: int
    case: Case
    verdict: Verdict
    shrunk: Case | None = None


class _Over(Exception):
    """The time is up, or enough was seen."""


def worst(law: Law, subject: Subject, examples: int, seconds: float) -> Found:
    """Hunt the worst case, towards larger errors, and shrink it where its grade is poor or broken (`simplest`)."""
    end, count = time.monotonic() + seconds, 0
    top: tuple[Case, Verdict] | None = None

    @repeatable(examples)
    @given(law.cases(subject))
    def one(case: Case) -> None:
        nonlocal count, top
        broken = top is not None and top[1].grade is Grade.BROKEN
        if (time.monotonic() > end and count >= LEAST) or (broken and count >= ENOUGH):
            raise _Over
        verdict = law.check(subject, case)
        count += 1
        if top is None or verdict.rank > top[1].rank:
            top = case, verdict
        target(math.log10(min(max(verdict.size, 1e-30), 1e30)))

    try:
        one()
    except _Over:
        pass
    if top is None:
        raise InputError(f"{law.name}: no case of this law could be drawn")
    case, verdict = top
    if verdict.grade < Grade.POOR:
        return Found(count, case, verdict)
    return Found(count, case, verdict, simplest(law, subject, case, verdict))


def simplest(law: Law, subject: Subject, case: Case, verdict: Verdict) -> Case:
    """The simplest case found that fails in the manner of this one.

    It has the grade and the kind of fault of the verdict, on what the law could have drawn. What the law is about stays
    in it as long as anything else can go: who errs in two ways shows the one that is the law's.
    """
    end = time.monotonic() + SHRINKING

    def fails(other: Case) -> bool:
        return time.monotonic() < end and law.check(subject, other).manner == verdict.manner

    own = law._replace(allowed=lambda other: law.allowed(other) and law.about(other))
    return shrunk(law, shrunk(own, case, fails), fails)
