"""The hunt for the worst case of one law, within a number of examples and seconds; the same cases in every run."""

from __future__ import annotations

import math
import time
from typing import NamedTuple

from ...errors import InputError
from ..hunting import _UNCHECKED
from .grades import Grade, Verdict
from .law import Case, Law
from .shrink import shrunk
from .subject import Subject

# `law` has said what to install where hypothesis is missing.
from hypothesis import Phase, Verbosity, given, settings, target  # isort: skip

ENOUGH = 100
"""Examples after which nothing is gained by more, once something is broken."""
LEAST = 10
"""So many examples are tried however long they take."""
SHRINKING = 30.0
"""Seconds that shrinking may take."""


class Found(NamedTuple):
    """How many cases of a law were tried, the worst one, its verdict, and both shrunk where it is a finding."""

    examples: int
    case: Case
    verdict: Verdict
    shrunk: Case | None = None
    shrunk_verdict: Verdict | None = None


class _Over(Exception):
    """The time is up, or enough was seen."""


def worst(law: Law, subject: Subject, examples: int, seconds: float) -> Found:
    """Hunt the worst case, towards larger errors, and shrink it where its grade is poor or broken.

    A shrunk case has the grade of the worst one.
    """
    end, count = time.monotonic() + seconds, 0
    top: tuple[Case, Verdict] | None = None

    @settings(
        max_examples=examples,
        database=None,
        deadline=None,
        derandomize=True,
        phases=(Phase.generate, Phase.target),
        report_multiple_bugs=False,
        print_blob=False,
        verbosity=Verbosity.quiet,
        suppress_health_check=_UNCHECKED,
    )
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
    end = time.monotonic() + SHRINKING

    def fails(other: Case) -> bool:
        return time.monotonic() < end and law.check(subject, other).grade >= verdict.grade

    small = shrunk(law, case, fails)
    return Found(count, case, verdict, small, law.check(subject, small))
