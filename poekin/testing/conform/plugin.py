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
from .grades import Grade, largest_size
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
    """Hold a subject to the laws, and fail where it does not keep them.

    Parameters
    ----------
    thing : type, object or str
        Class or object of functions, as `Subject` takes it, or "MODULE:NAME" of one.
    laws : sequence of str, optional
        Names of the laws, or one name; by default all that apply.
    examples : int, optional
        Cases of each law; by default as many as are its own, so that a grade does not depend on the
        machine.
    seconds : float, default 600.0
        Time for all laws together, s; shrinking (half a minute a finding at most) and confirming is not
        counted. A law for which it does not suffice is graded by ten examples at least, and the report
        says so.
    at_most : Grade, optional
        Worst grade that conforms.
    leave_out : sequence of str, optional
        Names of laws that it is not held to.

    Returns
    -------
    report : Report
        Outcome of each law.

    Raises
    ------
    LawViolation
        With every counterexample, if a confirmed grade is worse than `at_most`.
    InputError
        If the subject cannot be used or does not declare what is needed, or a law does not apply.
    UnknownName
        For a name that is no law.
    """
    report = conform(thing, laws, examples, seconds, leave_out=leave_out, at_most=at_most)
    wrong = tuple(
        outcome
        for outcome in report.outcomes
        if outcome.grade > at_most and not outcome.unconfirmed
    )
    if wrong:
        worst = max(wrong, key=lambda outcome: (outcome.grade, outcome.worst))
        bound = largest_size(at_most, PRECISIONS[worst.precision])
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
