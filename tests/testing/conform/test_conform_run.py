"""A run over all laws: which apply, what is said of the others, and what is reported of a hunt."""

from __future__ import annotations

import inspect
import itertools
import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from poekin.errors import InputError, UnknownName, suggest
from poekin.testing.conform import FUNCTIONS, LAWS, Subject, run
from poekin.testing.conform.grades import NO_RESULT, Grade, Verdict
from poekin.testing.conform.laws.law import Case, Shown, SubjectLaw
from poekin.testing.conform.process.calls import ENDED, LOST, UNANSWERED, Undeclared
from poekin.testing.conform.search import SearchResult
from poekin.testing.conform.subjects.precision import SINGLE
from poekin.testing.strategies.group_strategies import st


class Mine:
    def so3_exp(self, w: np.ndarray) -> np.ndarray:
        return np.eye(3)

    def so3_log(self, R: np.ndarray) -> np.ndarray:
        return np.zeros(3)


NAMES = [law.name for law in LAWS]


def refused(error: type[Exception], said: str, *words: Any, **options: Any) -> None:
    with pytest.raises(error) as raised:
        run.conform(Mine, *words, limits=None, **options)
    assert str(raised.value) == said


def test_a_law_that_is_none_or_does_not_apply_is_told_with_those_that_do():
    refused(UnknownName, f"there is no law 'so3_ex'; {suggest('so3_ex', NAMES)}", ["so3_ex"])
    refused(UnknownName, f"there is no law 'lgo'; {suggest('lgo', NAMES)}", leave_out="lgo")
    those = "those that do: so3_exp, so3_log"
    refused(
        InputError,
        f"Mine: the law log does not apply: there is no log; {those}",
        ["so3_exp", "log"],
    )
    refused(
        InputError, f"Mine: the law noise does not apply: noise is not declared; {those}", "noise"
    )
    refused(
        InputError, f"Mine: no law that applies is left; {those}", leave_out=["so3_exp", "so3_log"]
    )
    refused(
        InputError, f"Mine: no law that applies is left; {those}", "so3_exp", leave_out="so3_exp"
    )


def test_laws_are_those_that_are_named_without_those_that_are_left_out():
    subject = Subject(Mine)
    for names, without, expected in (
        ((), (), ["so3_exp", "so3_log"]), (("so3_log",), (), ["so3_log"]), ((), ("so3_log",), ["so3_exp"]),
        (("so3_log", "so3_exp"), ("so3_log",), ["so3_exp"]),
    ):  # fmt: skip
        assert [law.name for law in run.applicable(subject, names, without)] == expected
    assert run.law_names(Mine, "so3_exp", None) == ["so3_log"]


def test_what_a_subject_is_not_held_to_is_said_where_nobody_chose():
    subject = Subject(type("Mine", (Mine,), {"helper": lambda self: None}))
    absent = ", ".join(name for name in FUNCTIONS if not name.startswith("so3_") or "jac" in name)
    helper = "no function of a subject's, and held to nothing: 'helper'"
    assert run.remarks(subject, ["so3_exp"], ["fk", "log"]) == [
        "left out, as asked for: fk, log",
        helper,
    ]
    assert run.remarks(subject, [], []) == [
        helper, f"no law of what is not there: {absent}", "noise is not declared, so there is no law of noise",
        "batch = True is not declared, so there is no law of so3_exp of batches, so3_log of batches",
    ]  # fmt: skip


@pytest.fixture
def hunted(monkeypatch):
    """The hunts that are asked for; each finds a sound subject."""
    asked: list[tuple[str, int]] = []

    def worst(
        law: SubjectLaw, subject: Subject, examples: int, seconds: float, at_most: Grade
    ) -> SearchResult:
        asked.append((law.name, examples))
        if law.name == "so3_exp" and examples == 3:
            raise Undeclared("it has no such thing")
        return SearchResult(
            examples, Case(np.zeros(3)), Verdict(Grade.EXACT, 0.5, "x"), None, examples == 2
        )

    monkeypatch.setattr(run, "worst", worst)
    return asked


def test_examples_are_one_or_more_and_seconds_more_than_none(hunted):
    for examples, seconds in ((0, 1.0), (-1, 1.0), (1, 0), (1, -1.0), (None, math.nan)):
        said = f"examples ≥ 1 and seconds > 0 expected, got {examples} and {seconds}"
        refused(InputError, said, (), examples, seconds)
    assert hunted == []
    run.conform(Mine, "so3_exp", 1, 0.5, limits=None)
    run.conform(Mine, "so3_exp", limits=None)
    assert hunted == [("so3_exp", 1), ("so3_exp", 400)]
    given = inspect.signature(run.conform).parameters
    assert (given["seconds"].default, given["at_most"].default) == (600.0, Grade.GOOD)


def test_a_law_of_what_is_not_there_is_not_judged_and_the_others_go_on(hunted):
    report = run.conform(Mine, (), 3, limits=None)
    first, second = report.outcomes
    assert (first.law, first.unconfirmed, first.word) == (
        "so3_exp",
        "it has no such thing",
        "not judged",
    )
    assert (first.grade, first.worst, first.what, first.examples) == (
        Grade.EXACT,
        0.0,
        NO_RESULT,
        0,
    )
    assert (second.law, second.worst, second.what, second.examples) == ("so3_log", 0.5, "x", 3)
    late = run.conform(Mine, ["so3_exp", "so3_log"], 2, limits=None)
    assert late.notes == (
        "the time ran out: fewer examples than there should be of so3_exp, so3_log",
    )
    assert all(outcome.late for outcome in late.outcomes)


def test_a_subject_that_shares_this_process_is_said_to(hunted, monkeypatch):
    monkeypatch.setattr(run, "obstacle", lambda thing: "it has threads")
    report = run.conform(Mine, "so3_exp", 1)
    said = "run in this process, with no limit on its calls: it has threads; MODULE:CLASS is run in its own"
    assert report.notes == (said,)
    assert run.conform(Mine, "so3_exp", 1, limits=None).notes == ()


WORST, SMALL = Case(np.array([3.0])), Case(np.array([1.0]))


def law(check: Any, about: bool = True, confirm: bool = True) -> SubjectLaw:
    return SubjectLaw(
        "a law", "says", "so3_exp", lambda subject: st.nothing(), check, lambda subject, case: confirm,
        lambda subject, case: Shown("words", "paste", np.ones(1), ("a",)), about=lambda case: about,
    )  # fmt: skip


def stub(linear: bool = False, frame: str = "") -> Any:
    return SimpleNamespace(precision=lambda name: SINGLE, linear_first=linear, frame=frame)


def verdict(grade: Grade, size: float = 1.0, fault: str = "", what: str = "x") -> Verdict:
    return Verdict(grade, size, what, fault)


P, B, G = Grade.POOR, Grade.BROKEN, Grade.GOOD
MISSING = "a package that the subject imports is not installed: nothing was judged"
ELSE = "nothing that this law is about is in it: what is wrong is something else"
ANOTHER = "another result from one call to the next"
CALLED_AGAIN = [
    (verdict(P, 2), verdict(P, 1), True, (P, 2, 1, "", "")),
    (verdict(P, 1), verdict(B, 3, what="y"), True, (B, 3, 3, "", "")),
    (verdict(B, 2), verdict(P, 1), True, (B, 2, 1, f"{ANOTHER}: broken once, then poor", "")),
    (verdict(B, 2), verdict(B, 1, "NaN"), False, (B, 2, 1, "NaN", ELSE)),
    (verdict(B, 2), verdict(B, 1, "ModuleNotFoundError: x"), False, (B, 2, 1, "ModuleNotFoundError: x", MISSING)),
    (verdict(B, 2, f"{UNANSWERED} 2 s"), verdict(G, 0), True, (B, 2, 2, f"{UNANSWERED} 2 s", "")),
    (verdict(B, 2), verdict(B, 1, f"{LOST}: x"), True, (B, 2, 2, "", "")),
    (verdict(B, 2), verdict(B, 1, f"{ENDED} (SIGSEGV)"), True, (B, 2, 1, f"{ENDED} (SIGSEGV)", "")),
]  # fmt: skip


@pytest.mark.parametrize(("first", "again", "about", "expected"), CALLED_AGAIN)
def test_a_finding_is_measured_again_and_the_worse_of_both_is_reported(
    first, again, about, expected
):
    found = run.outcome(
        law(lambda subject, case: again, about), stub(), SearchResult(7, WORST, first, SMALL, True)
    )  # fmt: skip
    assert (found.grade, found.worst, found.error, found.fault, found.hint) == expected
    assert (found.case, found.words, found.paste, found.names, found.precision) == (
        SMALL, "words", "paste", ("a",), "float32"
    )  # fmt: skip
    assert (found.examples, found.late, found.unconfirmed) == (7, True, "")
    assert (found.law, found.says) == ("a law", "says")
    doubted = run.outcome(
        law(lambda subject, case: again, about, False),
        stub(),
        SearchResult(7, WORST, first, SMALL, True),
    )
    assert doubted.unconfirmed == "the two oracles do not agree on the exact result"


def test_what_is_no_finding_is_not_measured_again():
    found = run.outcome(law(None), stub(), SearchResult(7, WORST, verdict(G, 2.0), None, True))
    assert (found.grade, found.worst, found.what, found.examples, found.late) == (
        G,
        2.0,
        "x",
        7,
        True,
    )
    assert (found.case, found.fault, found.precision) == (None, "", "float32")


ANGULAR, LINEAR = 'twist_order = "angular first"', 'twist_order = "linear first"'
FRAMES = {frame: f'jacobian_frame = "{frame}"' for frame in ("space", "body", "hybrid")}


@pytest.mark.parametrize(
    ("linear", "frame", "holds", "declared"),
    [
        (False, "body", {(True, "space")}, f"{LINEAR} and {FRAMES['space']}"),
        (False, "body", {(True, "hybrid")}, f"{LINEAR} and {FRAMES['hybrid']}"),
        (False, "body", {(True, "body")}, LINEAR),
        (True, "space", {(False, "space")}, ANGULAR),
        (True, "space", {(True, "body")}, FRAMES["body"]),
        (True, "hybrid", {(True, "space"), (True, "body")}, FRAMES["space"]),
        (True, "", {(False, "")}, ANGULAR),
        (True, "", {(True, "space"), (False, "space")}, ""),
        (False, "space", set(), ""),
    ],
)
def test_other_declarations_with_which_it_would_hold_are_said_and_not_assumed(
    linear, frame, holds, declared
):
    subject = stub(linear, frame)

    def check(subject: Any, case: Case) -> Verdict:
        sound = (subject.linear_first, subject.frame) in holds
        return verdict(P if sound else B)

    found = run._declared_otherwise(law(check), subject, WORST, SMALL)
    assert found == (f"with {declared} it would hold" if declared else "")
    assert (subject.linear_first, subject.frame) == (linear, frame)
    report = run.outcome(law(check), subject, SearchResult(1, WORST, verdict(B), SMALL, False))
    assert report.hint == found
    for one in (WORST, SMALL):  # it has to hold of both cases

        def only(subject: Any, case: Case, one: Case = one) -> Verdict:
            return check(subject, case) if case is one else verdict(B)

        assert run._declared_otherwise(law(only), subject, WORST, SMALL) == ""


def test_a_poor_finding_is_not_asked_of_other_declarations():
    asked = itertools.count()

    def check(subject: Any, case: Case) -> Verdict:
        next(asked)
        return verdict(P)

    assert (
        run.outcome(law(check), stub(), SearchResult(1, WORST, verdict(P), SMALL, False)).hint == ""
    )
    assert next(asked) == 1
