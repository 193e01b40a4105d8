"""Who holds which law: poekin and the libraries beside it, held to the laws of
`poekin.testing.conform`.

With it what shows that the judge can be trusted: it catches eight faults that libraries had, and
finds none in subjects that compute in 60 digits (`python -m benchmarks.subjects 100000` does the
latter alone, in so many examples).
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from poekin.testing.conform import LAWS, Grade, Outcome, Report

from .. import peers, subjects
from ..report import Figure, Table, Topic, short
from ..subjects.held import (
    BROKEN_WITHIN,
    FALSE_EXAMPLES,
    Caught,
    caught,
    false_findings,
    held,
    tries,
)
from ..workers import workers

EXAMPLES = 150
OF_PEERS = 100
QUICK = 60

WORDS = (
    "Each library is a small class with those functions that it has, called as its documentation says; its order of "
    "twists and the frame of its Jacobian are declared. Cases draw angles and lengths independently, log-uniformly, "
    "with 0, the neighbourhood of π and π itself on purpose; URDFs of one to three joints are made with one thing in "
    "them that readers get wrong. Grades: exact, at most 3 × the error that float64 cannot avoid; good, at most "
    "1e-10; poor, at most 1e-6; broken: worse, NaN, an exception, another shape. Angles are in rad, lengths in "
    "proportion to those that went in. poekin is tried in {own} examples of each law, the others in {of_peers}. "
    "The truth has 80 digits; what is poor or broken was shrunk, done again, and "
    "confirmed by mpmath's own matrix exponential before it was printed here. "
    "`python -m benchmarks.subjects 100000` looks for false findings alone, in so many examples."
)


def topic(quick: bool, say) -> Topic:  # type: ignore[no-untyped-def]
    libraries = [(name, kind) for name, kinds in _libraries() for kind in kinds]
    names, kinds = zip(("", subjects.Poekin), *libraries, strict=True)
    seconds = [120.0] + [60.0] * len(libraries)
    own, of_peers = (QUICK, QUICK) if quick else (EXAMPLES, OF_PEERS)
    counts = [own] + [of_peers] * len(libraries)
    # No time is measured here but that of a fault, which its process has a processor for.
    with workers() as share:
        reports = share(held, kinds, counts, seconds, names)
        faults = share(caught, subjects.FAULTS)
        sound = tries(1_000 if quick else FALSE_EXAMPLES, share)
        found = [_said(report, say) for report in reports]
        faults = list(faults)
        say(f"{sum(one.holds for one in faults)} of {len(faults)} faults caught")
        total, false, not_exact = false_findings(sound, lambda line: None)
    say(
        f"{total} examples on subjects without fault: {false} laws with a finding, {not_exact} not exact"
    )
    return Topic(
        "Who holds which law",
        WORDS.format(own=own, of_peers=of_peers),
        _figures(found, faults, total, false, not_exact),
        _tables(found, faults),
    )


def _said(report: Report | str, say) -> Report | str:  # type: ignore[no-untyped-def]
    if isinstance(report, str):
        say(report)
    else:
        count = len(report.findings)
        say(f"{report.subject}: {len(report.outcomes)} laws, {count} poor or broken")
    return report


def _libraries() -> list[tuple[str, Sequence[type]]]:
    """The subjects of those peers of this run that can be used."""
    every = peers.STANDARD | peers.OPTIONAL
    names = {id(peer): name for name, peer in every.items()}
    usable = [names[id(found.peer)] for found in peers.chosen() if not found.problem]
    return [(name, subjects.LIBRARIES[name]) for name in usable if name in subjects.LIBRARIES]


def _figures(
    found: Sequence[Report | str], faults: Sequence[Caught], total: int, false: int, not_exact: int
) -> list[Figure]:  # fmt: skip
    good = sum(one.holds for one in faults)
    own = found[0]
    below = (
        [outcome.law for outcome in own.outcomes if outcome.grade > Grade.EXACT]
        if isinstance(own, Report)
        else []
    )
    laws = len(own.outcomes) if isinstance(own, Report) else 0
    return [
        Figure(
            "faults of libraries, re-created, that are caught", len(faults) - good, 0,
            shown=f"{good} of {len(faults)}", bar_shown="all",
            note=f"each by the law that it breaks, within {BROKEN_WITHIN:g} s; at most three numbers of the "
            "counterexample are not 0",
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


def _tables(found: Sequence[Report | str], faults: Sequence[Caught]) -> list[Table]:
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
             for letter, words, outcome, seconds in faults], folded=True,
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
