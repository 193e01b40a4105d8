"""Eight faults that libraries had, re-created: each is found, confirmed, and shrunk to at most three numbers."""

from __future__ import annotations

import contextlib
import functools
import io
import warnings

import numpy as np
import pytest

from benchmarks.subjects import FAULTS, Poekin
from poekin.testing.conform import LAWS, Grade, conform
from poekin.testing.laws import LawViolation

# Of the sound laws only some are run: tests/benchmarks runs none, the report all of them.
EXAMPLES = 250


@functools.cache
def report_of(letter):
    kind, law = FAULTS[letter]
    return conform(kind, [law], examples=EXAMPLES, seconds=50.0)


@pytest.mark.parametrize("letter", FAULTS)
def test_a_fault_is_found_with_at_most_three_numbers(letter):
    report = report_of(letter)
    (outcome,) = report.findings
    assert outcome.grade >= Grade.POOR
    assert outcome.numbers <= 3
    assert not report.conforms


@pytest.mark.parametrize("letter", FAULTS)
def test_the_same_subject_without_its_fault_has_no_finding(letter):
    _, law = FAULTS[letter]
    report = conform(Poekin, [law], examples=20, seconds=50.0)
    assert report.conforms
    assert report[law].grade is Grade.EXACT


@pytest.mark.parametrize("letter", ["a", "c", "e", "h"])
def test_a_counterexample_runs_where_it_is_pasted_and_shows_the_error(letter):
    (outcome,) = report_of(letter).findings
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(outcome.paste, {})
    got = np.array([float(x) for x in printed.getvalue().replace("[", " ").replace("]", " ").split()])
    assert outcome.expected is not None
    error = np.linalg.norm(got - outcome.expected.ravel())
    # NumPy prints eight digits, and a part of the error in proportion to a length is not the whole.
    assert error > 0.1 * outcome.error - 1e-8


def test_what_is_swapped_is_broken_and_the_other_order_is_said_not_assumed():
    class Swapped:
        twist_order = "linear first"
        exp = staticmethod(Poekin.exp)

    (outcome,) = conform(Swapped, examples=100).findings
    assert outcome.grade is Grade.BROKEN
    assert 'twist_order = "angular first"' in outcome.hint


class Raises:
    def so3_exp(self, w):
        raise RuntimeError("not\nyet \x1b[31m")


class Nothing:
    def so3_exp(self, w):
        return None


class Shape:
    def so3_exp(self, w):
        return np.eye(4)


class NotANumber:
    def so3_exp(self, w):
        return Poekin.so3_exp(w) if w @ w < 4 else np.full((3, 3), np.nan)


class Writes:
    def so3_exp(self, w):
        R = Poekin.so3_exp(w)
        w[:] = 7.0
        return R


@pytest.mark.parametrize(
    ("kind", "words"),
    [
        (Raises, r"RuntimeError: not yet \x1b[31m"),
        (Nothing, "shape () where (3, 3) was expected"),
        (Shape, "shape (4, 4)"),
        (NotANumber, "NaN"),
    ],
    ids=["exception", "nothing", "shape", "NaN"],
)
def test_what_is_no_result_is_broken_and_says_what_it_was(kind, words):
    (outcome,) = conform(kind, examples=50).findings
    assert outcome.grade is Grade.BROKEN
    assert outcome.fault.startswith(words)
    assert outcome.numbers <= 1


def test_a_subject_that_writes_into_its_argument_harms_nobody_else():
    assert conform(Writes, examples=50).conforms


def test_a_warning_is_no_fault_even_where_warnings_are_errors():
    class Warns:
        def so3_exp(self, w):
            warnings.warn("deprecated", DeprecationWarning, stacklevel=1)
            return Poekin.so3_exp(w) + 0 * np.log(np.zeros(1) + 1e-300)

        def read_urdf(self, text, base, tip):
            warnings.warn("deprecated", DeprecationWarning, stacklevel=1)
            return Poekin().read_urdf(text, base, tip)

    assert conform(Warns, ["so3_exp", "urdf"], examples=5).conforms


def test_a_subject_that_does_not_repeat_its_fault_is_not_blamed():
    class Once:
        calls = 0

        def so3_exp(self, w):
            Once.calls += 1
            return np.zeros((3, 3)) if Once.calls % 2 else Poekin.so3_exp(w)

    report = conform(Once, examples=20)
    assert report.findings == () or all(o.unconfirmed == "" for o in report.findings)
    flaky = report["so3_exp"]
    assert flaky.unconfirmed
    assert flaky.word == "not judged"


def test_a_finding_that_the_second_oracle_does_not_confirm_is_not_printed(monkeypatch):
    from poekin.testing.conform import confirm

    monkeypatch.setattr(confirm, "of_exp", lambda xi: False)
    report = conform(FAULTS["d"][0], examples=200)
    assert report.conforms
    assert "do not agree" in str(report)
    assert report["so3_exp"].as_dict()["grade"] == "not judged"


def test_keyboard_interrupts_pass():
    class Slow:
        def so3_exp(self, w):
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        conform(Slow, examples=10)


def test_laws_are_plain_functions_that_raise_with_error_and_bound():
    from poekin.testing.conform import of_arms, of_groups

    xi = np.array([1e-6, 0, 0, 0, 1.0, 0])
    of_groups.exp_is_e_to_the_xi(Poekin.exp, xi)
    with pytest.raises(LawViolation, match=r"exp is e to the xi: error 5e-07 exceeds") as caught:
        of_groups.exp_is_e_to_the_xi(FAULTS["a"][0]().exp, xi)
    assert caught.value.error == pytest.approx(5e-7, rel=1e-3)
    # Good as far as 1e-6.
    of_groups.exp_is_e_to_the_xi(FAULTS["a"][0]().exp, xi, at_most=Grade.POOR)
    arm = of_arms.arm(np.array([[0, 0, 1.0, 0, 0, 0]]), np.eye(4))
    with pytest.raises(LawViolation, match=r"fk is the product of exponentials"):
        of_arms.fk_is_the_product_of_exponentials(lambda q: np.eye(4), arm, np.array([0.5]))


def test_every_law_has_its_own_name():
    assert len({law.name for law in LAWS}) == len(LAWS)
