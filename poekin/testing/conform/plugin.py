"""For pytest: the fixture `conform` holds a subject to the laws, and its test fails with the
counterexamples.

In the conftest.py at the top of the tests, or with -p on the command line:

    pytest_plugins = ["poekin.testing.conform.plugin"]

and then

    def test_my_kinematics_keep_the_laws(conform):
        conform(Mine)

It is not loaded unasked, so that `conform` means nothing in a project that does not ask for it.
Only pytest loads it, and nothing else of poekin imports pytest.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import pytest

from ..laws.laws import LawViolation
from .grades import Grade
from .report import Report
from .run import SECONDS, conform
from .subjects.precision import PRECISIONS


def check_conformance(
    thing: Any,
    laws: Sequence[str] = (),
    examples: int | None = None,
    seconds: float = SECONDS,
    at_most: Grade = Grade.GOOD,
    leave_out: Sequence[str] = (),
) -> Report:
    """Hold a subject to the laws, as `run.conform` does, and return the report.

    Parameters: thing, laws, examples, seconds, leave_out, as of `run.conform`; at_most, the worst
    `Grade` let pass. Returns: Report.
    Raises: LawViolation, with every counterexample, where a confirmed grade is worse than
    `at_most`; as `run.conform`.
    """
    report = conform(thing, laws, examples, seconds, leave_out=leave_out, at_most=at_most)
    wrong = tuple(
        outcome
        for outcome in report.outcomes
        if outcome.grade > at_most and not outcome.unconfirmed
    )
    if wrong:
        worst = max(wrong, key=lambda outcome: (outcome.grade, outcome.worst))
        precision = PRECISIONS[worst.precision]
        bound = {Grade.GOOD: precision.good, Grade.POOR: precision.poor}.get(at_most, 0.0)
        seen = {outcome.law: outcome.words or "see the report" for outcome in wrong}
        violation = LawViolation(f"{report.subject} does not conform", worst.worst, bound, seen)
        violation.add_note(str(Report(report.subject, wrong)))
        raise violation
    return report


@pytest.fixture(name="conform", scope="session")
def _conform() -> Callable[..., Report]:
    """`check_conformance`: call it with a subject, and it fails the test where the subject does not keep the
    laws.
    """
    return check_conformance
