"""What fails a test, and with which numbers: the outcomes of a report, made up here."""

from __future__ import annotations

import math

import pytest

from poekin.testing.conform import plugin
from poekin.testing.conform.grades import Grade
from poekin.testing.conform.report import Outcome, Report
from poekin.testing.laws.laws import LawViolation

POOR = Outcome("exp", "exp is exp", Grade.POOR, 2e-7, "R", 100, words="at 1")
BROKEN = Outcome("log", "log is log", Grade.BROKEN, math.inf, "no result", 9)
SINGLE = Outcome("fk", "fk is fk", Grade.POOR, 2e-4, "t", 100, words="at 2", precision="float32")
UNJUDGED = Outcome("ad", "ad is ad", Grade.BROKEN, math.inf, "Ad", 9, unconfirmed="they differ")


@pytest.fixture
def judged(monkeypatch):
    def judge(*outcomes: Outcome, at_most: Grade = Grade.GOOD) -> Report:
        report = Report("Mine", outcomes, at_most=at_most)
        monkeypatch.setattr(plugin, "conform", lambda *_, **__: report)
        return plugin.check_conformance(object, at_most=at_most)

    return judge


def test_what_was_not_confirmed_fails_no_test(judged):
    assert judged(UNJUDGED).conforms
    with pytest.raises(LawViolation) as caught:
        judged(UNJUDGED, POOR)
    assert caught.value.seen == {"exp": "at 1"}
    assert "ad is ad" not in "".join(caught.value.__notes__)


@pytest.mark.parametrize(
    ("outcomes", "error", "bound"),
    [
        ([POOR], 2e-7, 1e-10),
        ([POOR, SINGLE], 2e-4, 1e-5),  # what float32 is held to
        ([BROKEN, SINGLE], math.inf, 1e-10),
    ],
)
def test_the_error_and_its_bound_are_those_of_the_worst_outcome(judged, outcomes, error, bound):
    with pytest.raises(LawViolation, match=r"^Mine does not conform: ") as caught:
        judged(*outcomes)
    assert (caught.value.error, caught.value.bound) == (error, bound)


def test_each_outcome_that_fails_is_named_and_the_report_says_the_rest(judged):
    with pytest.raises(LawViolation) as caught:
        judged(POOR, BROKEN)
    assert caught.value.seen == {"exp": "at 1", "log": "see the report"}
    with pytest.raises(LawViolation) as caught:
        judged(POOR, BROKEN, at_most=Grade.POOR)
    assert caught.value.seen == {"log": "see the report"}
