"""A report in words and as plain data: each word of an outcome, and what of it is printed when."""

from __future__ import annotations

import math
from dataclasses import FrozenInstanceError
from typing import Any

import numpy as np
import pytest

from poekin.testing.conform.grades import Grade
from poekin.testing.conform.laws.law import Case
from poekin.testing.conform.report import Outcome, Report

CASE = Case(np.array([0.0, 2.0, -1.0]))
SOUND: dict[str, Any] = {
    "law": "exp", "says": "exp is exp", "grade": Grade.GOOD, "worst": 1.234e-12, "what": "R (rad)", "examples": 100,
}  # fmt: skip
FOUND: dict[str, Any] = {
    **SOUND, "grade": Grade.POOR, "error": 2.5e-7, "error_of": "t", "case": CASE, "words": "ω = 2", "paste": "print(1)",
    "expected": np.array([[0.0, -0.0, 0.5]]), "hint": "look there", "names": ("a", "b"),
}  # fmt: skip
INDENT = "\n           "


def told(before: dict[str, str] | None = None, **fields: Any) -> str:
    return Outcome(**fields).summary(before or {})


@pytest.mark.parametrize(
    ("more", "second"),
    [
        ({}, "worst 1.2e-12 of R (rad); 100 examples"),
        ({"examples": 99}, "worst 1.2e-12 of R (rad); 99 examples, which say little"),
        (
            {"examples": 400, "late": True},
            "worst 1.2e-12 of R (rad); 400 examples; the time ran out",
        ),
        ({"precision": "float32"}, "worst 1.2e-12 of R (rad); 100 examples in float32"),
        ({"worst": math.inf}, "worst: R (rad) is not 0, and must be; 100 examples"),
        ({"worst": math.inf, "what": "no result"}, "worst: no result; 100 examples"),
        ({"unconfirmed": "they do not agree"}, "they do not agree"),
        ({"unconfirmed": "they do not agree", "case": CASE}, "they do not agree"),
    ],
)
def test_what_was_not_found_wanting_is_two_lines(more, second):
    word = "not judged" if "unconfirmed" in more else "good      "
    outcome = Outcome(**{**SOUND, **more})
    assert str(outcome) == outcome.summary() == f"{word} exp: exp is exp{INDENT}{second}"
    assert not outcome.finding


def test_a_finding_says_its_error_its_case_the_python_and_what_is_exact():
    lines = ["exp is exp", "worst 1.2e-12 of R (rad); 100 examples", "2.5e-07 of t at ω = 2"]
    tail = ["print(1)", "# names: a, b, or more", "# exact: [[0.0, 0.0, 0.5]]"]
    assert told(**FOUND) == "poor       exp: " + INDENT.join([*lines, *tail, "look there"])
    above = "# the Python is that of log, above"
    assert told({"print(1)": "log"}, **FOUND) == "poor       exp: " + INDENT.join(
        [*lines, above, "look there"]
    )
    bare = {**FOUND, "names": (), "expected": None, "hint": "", "examples": 5, "late": True}
    lines[1] = "worst 1.2e-12 of R (rad); 5 examples"
    assert told(**bare) == "poor       exp: " + INDENT.join([*lines, "print(1)"])
    for more, third in (
        ({"fault": "NaN"}, "NaN"),
        ({"error": math.inf}, "t is not 0, and must be"),
    ):
        assert told(**{**bare, **more}) == "poor       exp: " + INDENT.join(
            [*lines[:2], f"{third} at ω = 2", "print(1)"]
        )


def test_a_finding_counts_the_numbers_that_are_not_zero():
    assert Outcome(**FOUND).numbers == 2
    assert Outcome(**SOUND).numbers == 0
    assert Outcome(**FOUND).finding


def test_plain_data_has_what_is_known():
    plain: dict[str, Any] = {
        "law": "exp", "says": "exp is exp", "grade": "good", "worst": 1.234e-12, "of": "R (rad)", "examples": 100,
        "time_ran_out": False, "precision": "float64",
    }  # fmt: skip
    assert Outcome(**SOUND).to_dict() == plain
    late = Outcome(**SOUND, late=True, unconfirmed="why", precision="float32").to_dict()
    assert late == plain | {
        "grade": "not judged", "time_ran_out": True, "unconfirmed": "why", "precision": "float32"
    }  # fmt: skip
    found = Outcome(**FOUND).to_dict()
    assert found.pop("numbers") == [0, 2, -1]
    assert found.pop("expected") == [[0, 0, 0.5]]
    assert found == plain | {
        "grade": "poor", "error": 2.5e-7, "error_of": "t", "fault": "", "counterexample": "ω = 2",
        "python": "print(1)", "names": ["a", "b"], "hint": "look there",
    }  # fmt: skip
    failed = {**SOUND, "grade": Grade.BROKEN, "fault": "NaN", "case": CASE}
    assert Outcome(**failed).to_dict()["error"] == 0.0


def outcomes(*grades: Grade, **more: Any) -> tuple[Outcome, ...]:
    return tuple(
        Outcome(**{**SOUND, "law": f"law {grade.word}", "grade": grade, **more}) for grade in grades
    )


@pytest.mark.parametrize("at_most", Grade)
def test_a_report_conforms_where_nothing_confirmed_is_worse_than_what_was_asked_for(at_most):
    for grade in Grade:
        assert Report("Mine", outcomes(Grade.EXACT, grade), at_most=at_most).conforms == (
            grade <= at_most
        )
        assert Report("Mine", outcomes(grade, unconfirmed="why"), at_most=at_most).conforms
    assert not Report("Mine", outcomes(Grade.POOR)).conforms
    assert Report("Mine", outcomes(Grade.GOOD)).conforms


def test_a_report_is_printed_with_each_python_once_and_its_notes():
    found = Outcome(**{**FOUND, "names": (), "expected": None, "hint": ""})
    twin = Outcome(**{**FOUND, "law": "log", "names": (), "expected": None, "hint": ""})
    third = Outcome(**{**FOUND, "law": "fk", "names": (), "expected": None, "hint": ""})
    report = Report("Mine 1.0", (found, *outcomes(Grade.EXACT), twin, third), ("one", "two\x1b"))
    text = str(report)
    assert text.splitlines()[0] == "Mine 1.0"
    assert text.count("print(1)") == 1
    assert text.count("# the Python is that of exp, above") == 2
    assert text.splitlines()[-2:] == ["note: one", r"note: two\x1b"]
    assert report.findings == (found, twin, third)
    assert report["log"] is twin
    assert report["law exact"].grade is Grade.EXACT
    with pytest.raises(KeyError, match="'nothing'"):
        report["nothing"]
    plain = report.to_dict()
    assert (plain["subject"], plain["conforms"], plain["notes"]) == (
        "Mine 1.0",
        False,
        ["one", "two\x1b"],
    )
    laws = plain["laws"]
    assert isinstance(laws, list)
    assert [law["law"] for law in laws] == ["exp", "law exact", "log", "fk"]


def test_outcomes_and_reports_do_not_change():
    for thing, name in ((Outcome(**SOUND), "grade"), (Report("Mine", ()), "subject")):
        with pytest.raises(FrozenInstanceError):
            setattr(thing, name, None)
