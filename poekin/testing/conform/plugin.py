"""For pytest: a test with the argument `conform` holds a subject to the laws, and fails with the counterexamples.

In conftest.py, or with -p on the command line:

    pytest_plugins = ["poekin.testing.conform.plugin"]

and then

    def test_my_kinematics_keep_the_laws(conform):
        conform(Mine)

It is not loaded unasked, so that `conform` means nothing in a project that does not ask for it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ..laws import LawViolation
from .grades import GOOD, POOR, Grade
from .report import Report
from .run import EXAMPLES, SECONDS
from .run import conform as graded


def conform(
    thing: Any,
    laws: Sequence[str] = (),
    examples: int = EXAMPLES,
    seconds: float = SECONDS,
    at_most: Grade = Grade.GOOD,
) -> Report:
    """Hold a subject to the laws, as `run.conform` does, and return the report.

    Raises: LawViolation, with every counterexample, where a confirmed grade is worse than `at_most`; as `run.conform`.
    """
    report = graded(thing, laws, examples, seconds)
    wrong = [outcome for outcome in report.outcomes if outcome.grade > at_most and not outcome.unconfirmed]
    if wrong:
        bound = {Grade.GOOD: GOOD, Grade.POOR: POOR}.get(at_most, 0.0)
        worst = max(wrong, key=lambda outcome: (outcome.grade, outcome.worst))
        seen = {outcome.law: outcome.words or "see the report" for outcome in wrong}
        violation = LawViolation(f"{report.subject} does not conform", worst.worst, bound, seen)
        violation.add_note("\n".join(map(str, wrong)))
        raise violation
    return report


def pytest_generate_tests(metafunc: Any) -> None:
    """Give `conform` to each test that has it as an argument."""
    if "conform" in metafunc.fixturenames:
        metafunc.parametrize("conform", [conform], ids=["laws"])
