"""Who holds which law: poekin and the libraries beside it, held to the laws of
`poekin.testing.conform`.

With it what shows that the judge can be trusted: it catches eight faults that libraries had, and
finds none in subjects that compute in 60 digits (`python -m benchmarks.subjects 100000` does the
latter alone, in so many examples).
"""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from typing import Any

from poekin.testing.conform import LAWS, Grade, Outcome, Report, applicable, conform
from poekin.testing.conform.search import worst
from poekin.testing.conform.subjects.subject import Subject

from .. import peers, subjects
from ..report import Figure, Table, Topic, short

WORDS = (
    "Each library is a small class with those functions that it has, called as its documentation says; its order of "
    "twists and the frame of its Jacobian are declared. Cases draw angles and lengths independently, log-uniformly, "
    "with 0, the neighbourhood of π and π itself on purpose; URDFs of one to three joints are made with one thing in "
    "them that readers get wrong. Grades: exact, at most 3 × the error that float64 cannot avoid; good, at most "
    "1e-10; poor, at most 1e-6; broken: worse, NaN, an exception, another shape. Angles are in rad, lengths in "
    "proportion to those that went in. The truth has 80 digits; what is poor or broken was shrunk, done again, and "
    "confirmed by mpmath's own matrix exponential before it was printed here. "
    "`python -m benchmarks.subjects 100000` looks for false findings alone, in so many examples."
)
BROKEN_WITHIN = 60.0
FALSE_EXAMPLES = 3_000


def topic(quick: bool, say) -> Topic:  # type: ignore[no-untyped-def]
    found = [_held(subjects.Poekin, 60 if quick else 150, 120.0, say)]
    for name, kinds in _libraries():
        for kind in kinds:
            found.append(_held(kind, 60 if quick else 150, 60.0, say, name))
    caught = _caught(say)
    total, false, not_exact = false_findings(1_000 if quick else FALSE_EXAMPLES, say)
    return Topic(
        "Who holds which law",
        WORDS,
        _figures(found, caught, total, false, not_exact),
        _tables(found, caught),
    )


def _libraries() -> list[tuple[str, Sequence[type]]]:
    """The subjects of those peers of this run that can be used."""
    every = peers.STANDARD | peers.OPTIONAL
    names = {id(peer): name for name, peer in every.items()}
    usable = [names[id(found.peer)] for found in peers.chosen() if not found.problem]
    return [(name, subjects.LIBRARIES[name]) for name in usable if name in subjects.LIBRARIES]


def _held(kind: type, examples: int, seconds: float, say, name: str = "") -> Report | str:  # type: ignore[no-untyped-def]
    """The report of a subject, or in one line why there is none."""

    def run() -> Report:
        # By its name: what has threads in this process does not survive a fork.
        own = f"{subjects.__name__}:{kind.__name__}" if kind in vars(subjects).values() else kind
        return conform(own, (), examples, seconds, leave_out=list(getattr(kind, "leaves_out", ())))

    report, problem = peers.attempt(run)
    if report is None:
        say(f"{name}: {problem}")
        return f"{name}: {problem}"
    say(f"{report.subject}: {len(report.outcomes)} laws, {len(report.findings)} poor or broken")
    return report


def _caught(say) -> list[tuple[str, str, Outcome, float]]:  # type: ignore[no-untyped-def]
    """Each fault: its letter and words, what found it, and in how many seconds."""
    rows = []
    for letter, (kind, law) in subjects.FAULTS.items():
        start = time.monotonic()
        outcome = conform(kind, examples=300, seconds=BROKEN_WITHIN - 10)[law]
        rows.append((letter, str(kind.__doc__), outcome, time.monotonic() - start))
    say(
        f"{sum(_holds(outcome, seconds) for _, _, outcome, seconds in rows)} of {len(rows)} faults caught"
    )
    return rows


def _holds(outcome: Outcome, seconds: float) -> bool:
    return outcome.finding and outcome.numbers <= 3 and seconds <= BROKEN_WITHIN


def false_findings(examples: int, say, each=lambda line: None) -> tuple[int, int, int]:  # type: ignore[no-untyped-def]
    """How many examples were tried on subjects without fault, how many were poor or broken, and how
    many not exact.
    """
    total = false = not_exact = 0
    work: list[tuple[Any, Any]] = [
        (law, Subject(kind)) for kind in (subjects.Angular, subjects.Linear) for law in LAWS
    ]
    work = [(law, subject) for law, subject in work if law in applicable(subject)]
    for left, (law, subject) in zip(range(len(work), 0, -1), work, strict=True):
        found = worst(law, subject, math.ceil(max(examples - total, 1) / left), math.inf)
        total += found.examples
        false += found.verdict.grade >= Grade.POOR
        not_exact += found.verdict.grade > Grade.EXACT
        each(f"{total} of {examples}: {found.verdict.grade.word} {law.name} of {subject.title}")
    say(
        f"{total} examples on subjects without fault: {false} laws with a finding, {not_exact} not exact"
    )
    return total, false, not_exact


def _figures(
    found: Sequence[Report | str], caught: Sequence[tuple[str, str, Outcome, float]], total: int, false: int,
    not_exact: int,
) -> list[Figure]:  # fmt: skip
    good = sum(_holds(outcome, seconds) for _, _, outcome, seconds in caught)
    own = found[0]
    below = (
        [outcome.law for outcome in own.outcomes if outcome.grade > Grade.EXACT]
        if isinstance(own, Report)
        else []
    )
    laws = len(own.outcomes) if isinstance(own, Report) else 0
    return [
        Figure(
            "faults of libraries, re-created, that are caught", len(caught) - good, 0,
            shown=f"{good} of {len(caught)}", bar_shown="all",
            note=f"within {BROKEN_WITHIN:g} s each; at most three numbers of the counterexample are not 0",
        ),
        Figure(
            "false findings against subjects that compute in 60 digits", false, 0, note=f"{total} examples; "
            f"{not_exact} laws not exact",
        ),
        Figure(
            "laws that poekin does not hold exactly", len(below) + (not isinstance(own, Report)), 0,
            note=", ".join(below) or f"{laws} laws" if isinstance(own, Report) else own,
        ),
    ]  # fmt: skip


def _tables(
    found: Sequence[Report | str], caught: Sequence[tuple[str, str, Outcome, float]]
) -> list[Table]:
    reports = [report for report in found if isinstance(report, Report)]
    problems = [report for report in found if isinstance(report, str)]
    rows = []
    for law in LAWS:
        cells = [_cell(report, law.name) for report in reports]
        if any(cells):
            rows.append((law.name, law.says, *cells))
    findings = [(report.subject, outcome) for report in reports for outcome in report.findings]
    return [
        Table(
            "The grade of each law, and the largest error met" + "".join(f"; {problem}" for problem in problems),
            ("law", "which says", *(report.subject for report in reports)), rows,
        ),
        Table(
            "Counterexamples to paste", ("library", "law", "grade", "error", "at", "Python", "exact result"),
            [(subject, outcome.law, outcome.word, *_finding(outcome)) for subject, outcome in findings], folded=True,
        ),
        Table(
            "Eight faults re-created", ("", "fault", "grade", "error", "numbers not 0", "seconds", "at"),
            [(letter, words, outcome.word, _size(outcome.error), outcome.numbers, short(seconds), outcome.words)
             for letter, words, outcome, seconds in caught], folded=True,
        ),
    ]  # fmt: skip


def _cell(report: Report, law: str) -> str:
    """A grade and its error; empty where the law was not asked."""
    outcome = next((outcome for outcome in report.outcomes if outcome.law == law), None)
    late = " (the time ran out)" if outcome is not None and outcome.late else ""
    return "" if outcome is None else f"{outcome.word} {_size(outcome.worst)}{late}"


def _finding(outcome: Outcome) -> tuple[str, str, str, str]:
    expected = "" if outcome.expected is None else str(outcome.expected.tolist())
    return outcome.fault or _size(outcome.error), outcome.words, outcome.paste, expected


def _size(value: float) -> str:
    return f"{value:.1g}" if math.isfinite(value) else "none"
