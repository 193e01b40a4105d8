"""The hunt for the worst case: how many cases it tries, which one it keeps, and what it makes
simpler.
"""

from __future__ import annotations

import contextlib
import math
from collections.abc import Callable, Iterator
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from poekin.errors import InputError
from poekin.testing.conform import search
from poekin.testing.conform.grades import Grade, Verdict
from poekin.testing.conform.laws.law import Case, Shown, SubjectLaw
from poekin.testing.conform.process.calls import ENDED, LOST, UNANSWERED
from poekin.testing.conform.subjects.precision import DOUBLE, SINGLE
from poekin.testing.strategies.group_strategies import st


class Clock:
    """Seconds that pass only where a test says so."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch):
        self.now = 0.0
        monkeypatch.setattr(search, "time", SimpleNamespace(monotonic=lambda: self.now))


class Stub:
    """A subject, as the hunt sees it."""

    def __init__(self) -> None:
        self.kind, self.limits = DOUBLE, list[float]()
        self.own = self

    def precision(self, name: str) -> Any:
        return self.kind

    @contextlib.contextmanager
    def within(self, seconds: float) -> Iterator[None]:
        self.limits.append(seconds)
        yield


def law(check: Callable[[Case], Verdict], **more: Any) -> SubjectLaw:
    """A law whose cases are a whole number from 1 to 1000."""
    cases = st.integers(1, 1000).map(lambda k: Case(np.array([float(k)])))
    fields: dict[str, Any] = {"triples": lambda case: (), **more}
    return SubjectLaw("a law", "says", "exp", lambda subject: cases, lambda subject, case: check(case),
               lambda subject, case: True, lambda subject, case: Shown("", "", None), **fields)  # fmt: skip


def verdict(grade: Grade, size: float = 1.0, fault: str = "") -> Verdict:
    return Verdict(grade, size, "x", fault)


def worst(
    check: Callable[[Case], Verdict], examples: int, seconds: float = 60.0, **more: Any
) -> search.SearchResult:
    subject: Any = more.pop("subject", Stub())
    return search.worst(law(check, **more), subject, examples, seconds)


def test_what_is_sound_is_tried_on_all_examples_and_what_is_broken_on_100():
    found = worst(lambda case: verdict(Grade.EXACT), 150)
    assert (found.examples, found.shrunk, found.late) == (150, None, False)
    found = worst(lambda case: verdict(Grade.POOR), 150, allowed=lambda case: False)
    assert found.examples == 150
    found = worst(lambda case: verdict(Grade.BROKEN), 150, allowed=lambda case: False)
    assert (found.examples, found.late) == (100, False)
    assert found.shrunk is not None


def test_broken_late_is_enough_at_once():
    tried = 0

    def check(case: Case) -> Verdict:
        nonlocal tried
        tried += 1
        return verdict(Grade.BROKEN if tried > 120 else Grade.GOOD)

    assert worst(check, 150, allowed=lambda case: False).examples == 121


@pytest.mark.parametrize("fault", [ENDED, UNANSWERED, LOST])
def test_a_subject_whose_process_ended_or_cannot_be_made_is_not_asked_again(fault):
    broken = verdict(Grade.BROKEN, fault=f"{fault} x")
    assert worst(lambda case: broken, 50, allowed=lambda case: False).examples == 1


@pytest.mark.parametrize(
    ("each", "seconds", "examples"), [(1.0, 1.0, 10), (1.0, 20.0, 21), (0.5, 20.0, 41)]
)
def test_ten_examples_are_tried_however_long_they_take(each, seconds, examples, monkeypatch):
    clock = Clock(monkeypatch)
    clock.now = 7.0

    def check(case: Case) -> Verdict:
        clock.now += each
        return verdict(Grade.EXACT)

    found = worst(check, 60, seconds)
    assert (found.examples, found.late) == (examples, True)


def test_the_first_of_the_worst_cases_is_kept():
    seen: list[tuple[float, float]] = []

    def check(case: Case) -> Verdict:
        x = float(case.numbers[0])
        seen.append((min(x, 40.0), x))
        return verdict(Grade.GOOD, seen[-1][0])

    found = worst(check, 80)
    assert found.verdict.size == 40
    assert found.case.numbers[0] == next(x for size, x in seen if size == 40)


def test_a_case_is_measured_again_where_its_result_says_another_precision():
    subject: Any = Stub()
    asked: list[float] = []

    def check(case: Case) -> Verdict:
        asked.append(float(case.numbers[0]))
        subject.kind = SINGLE
        return verdict(Grade.EXACT)

    def tenths(subject: Any) -> Any:
        return st.integers(1, 9).map(lambda k: Case(np.array([k / 7])))

    found = search.worst(law(check)._replace(cases=tenths), subject, 5, 60.0)
    assert len(asked) == found.examples + 1
    assert asked[1] == np.float32(asked[0])
    assert asked[0] != asked[1]
    assert found.case.numbers[0] in asked[1:]


def test_the_hunt_is_steered_by_the_order_of_magnitude_of_the_error(monkeypatch):
    sizes = iter([0.0, math.inf, 1e-5, 100.0, 1e-40])
    steered: list[float] = []
    monkeypatch.setattr(search, "target", steered.append)
    worst(lambda case: verdict(Grade.GOOD, next(sizes)), 5)
    assert steered == pytest.approx([-30, 30, -5, 2, -30], rel=1e-12)


def test_no_case_at_all_is_an_error():
    none = law(lambda case: verdict(Grade.EXACT))._replace(cases=lambda subject: st.nothing())
    subject: Any = Stub()
    with pytest.raises(InputError, match=r"^a law: no case of this law could be drawn$"):
        search.worst(none, subject, 5, 60.0)


@pytest.mark.parametrize("at_most", Grade)
def test_what_is_worse_than_good_or_than_was_asked_for_is_made_simpler(at_most):
    subject: Any = Stub()
    for grade in Grade:
        one = law(lambda case, grade=grade: verdict(grade))
        found = search.worst(one, subject, 3, 60.0, at_most)
        assert (found.shrunk is not None) == (grade > at_most or grade > Grade.GOOD)


NINE = Case(np.full(9, 0.123456789))


def simplest(
    check: Callable[[Case], Verdict], of: Verdict, case: Case = NINE, **more: Any
) -> tuple[Case, Stub]:
    subject: Any = Stub()
    return search.simplest(law(check, **more), subject, case, of), subject


def test_a_case_is_made_simpler_for_half_a_minute(monkeypatch):
    clock, tried = Clock(monkeypatch), list[Case]()
    clock.now = 7.0

    def check(case: Case) -> Verdict:
        tried.append(case)
        clock.now += 1.0
        return verdict(Grade.EXACT)

    small, subject = simplest(check, verdict(Grade.BROKEN))
    assert len(tried) == 30
    assert small.numbers.tolist() == NINE.numbers.tolist()
    assert subject.limits == []


@pytest.mark.parametrize("grade", [Grade.GOOD, Grade.POOR, Grade.BROKEN])
def test_a_simpler_case_fails_in_the_same_manner(grade):
    """Cases below 1 are good, below 2 poor, and else broken."""

    def check(case: Case) -> Verdict:
        return verdict(Grade(min(1 + int(np.abs(case.numbers[0])), 3)))

    for start in (0.75, 1.75, 2.75):
        case = Case(np.array([start, 0.123]))
        small, _ = simplest(check, verdict(grade), case)
        if check(case).grade == grade:
            assert small.numbers.tolist() == {0.75: [0, 0], 1.75: [1, 0], 2.75: [3, 0]}[start]
        assert check(small).grade in (grade, check(case).grade)


def test_what_the_law_is_about_stays_where_it_can():
    def check(case: Case) -> Verdict:
        return verdict(Grade.BROKEN)

    small, _ = simplest(check, verdict(Grade.BROKEN), about=lambda case: case.numbers[4] != 0)
    assert np.flatnonzero(small.numbers).size == 0

    def fifth(case: Case) -> bool:
        return bool(case.numbers[4])

    small, _ = simplest(check, verdict(Grade.BROKEN), about=fifth, allowed=fifth)
    assert np.flatnonzero(small.numbers).tolist() == [4]
    # where nothing else can go, it goes
    steps: list[int] = []

    def stays(case: Case) -> bool:
        steps.append(int(np.count_nonzero(case.numbers)))
        return True

    simplest(check, verdict(Grade.BROKEN), about=lambda case: case.numbers[4] != 0, allowed=stays)
    assert steps.index(0) > steps.index(1)


@pytest.mark.parametrize(("answer", "shrinks"), [(Grade.BROKEN, True), (Grade.GOOD, False)])
def test_who_does_not_answer_is_waited_for_two_seconds_while_a_case_is_made_simpler(
    answer, shrinks
):
    late = verdict(Grade.BROKEN, math.inf, f"{UNANSWERED} 60 s")
    subject: Any = Stub()
    short = late._replace(fault=f"{UNANSWERED} 2 s")
    inside = False

    @contextlib.contextmanager
    def within(seconds: float) -> Iterator[None]:
        nonlocal inside
        subject.limits.append(seconds)
        inside = True
        yield
        inside = False

    subject.within = within

    def check(case: Case) -> Verdict:
        return short if inside or shrinks else verdict(answer)

    small = search.simplest(law(check), subject, NINE, late)
    assert subject.limits == [2.0]
    assert (np.count_nonzero(small.numbers) == 0) == shrinks
    assert shrinks or small is NINE
