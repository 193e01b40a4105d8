"""One subject held to the laws, for a process of its own to run: a library, a re-created fault, a
subject without fault.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

from poekin.testing.conform import LAWS, Grade, Outcome, Report, applicable, conform
from poekin.testing.conform.search import worst
from poekin.testing.conform.subjects.subject import Subject

from .. import peers, subjects

BROKEN_WITHIN = 60.0
FALSE_EXAMPLES = 2_000


class Caught(NamedTuple):
    """A fault: its letter and words, what found it, and in how many seconds."""

    letter: str
    words: str
    outcome: Outcome
    seconds: float

    @property
    def holds(self) -> bool:
        """Whether it was found soon, and with few numbers."""
        small = self.outcome.finding and self.outcome.numbers <= 3
        return small and self.seconds <= BROKEN_WITHIN


class Tried(NamedTuple):
    """A law that a subject without fault was held to, and the worst of so many examples."""

    law: str
    subject: str
    examples: int
    grade: Grade


def held(kind: type, examples: int, seconds: float, name: str) -> Report | str:
    """The report of a library's subject, or in one line why there is none."""

    def run() -> Report:
        # By its name: what has threads in this process does not survive a fork.
        own = f"{subjects.__name__}:{kind.__name__}" if kind in vars(subjects).values() else kind
        return conform(own, (), examples, seconds, leave_out=list(getattr(kind, "leaves_out", ())))

    report, problem = peers.attempt(run)
    return f"{name}: {problem}" if report is None else report


def caught(letter: str) -> Caught:
    """What the law that must find a fault of `subjects.FAULTS` finds."""
    kind, law = subjects.FAULTS[letter]
    start = time.monotonic()
    outcome = conform(kind, law, examples=300, seconds=BROKEN_WITHIN - 10)[law]
    return Caught(letter, str(kind.__doc__), outcome, time.monotonic() - start)


def tries(examples: int, share: Callable[..., Iterable[Any]] = map) -> Iterable[Tried]:
    """The laws on the subjects without fault, each in its part of the examples.

    share: `map`, or one of several processes.
    """
    work = [
        (kind, law.name)
        for kind in (subjects.Angular, subjects.Linear)
        for law in applicable(Subject(kind))
    ]
    part = math.ceil(examples / len(work))
    return share(tried, *zip(*work, strict=True), [part] * len(work))


def tried(kind: type, name: str, examples: int) -> Tried:
    """A law on a subject without fault."""
    subject = Subject(kind)
    law = next(law for law in LAWS if law.name == name)
    found = worst(law, subject, examples, math.inf)
    return Tried(name, subject.title, found.examples, found.verdict.grade)


def false_findings(found: Iterable[Tried], say: Callable[[str], object]) -> tuple[int, int, int]:
    """How many examples were tried on subjects without fault, how many laws were poor or broken, and
    how many not exact; each law is said as it is done.
    """
    total = false = not_exact = 0
    for one in found:
        total += one.examples
        false += one.grade >= Grade.POOR
        not_exact += one.grade > Grade.EXACT
        say(f"{total} examples: {one.grade.word} {one.law} of {one.subject}")
    return total, false, not_exact
