"""Grades: where one ends and the next begins, and what is no number is broken."""

from __future__ import annotations

import math

import pytest

from poekin.testing.conform.grades import ErrorPart, Grade, graded
from poekin.testing.conform.subjects.precision import SINGLE
from poekin.testing.laws.laws import LawViolation


def part(error, scale=1.0, least=0.0, error_bound=1e-16):
    return ErrorPart("x", error, scale, least, error_bound=lambda: error_bound)


@pytest.mark.parametrize(
    ("error", "grade"),
    [
        (0.0, Grade.EXACT), (3e-16, Grade.EXACT), (3.1e-16, Grade.GOOD), (1e-10, Grade.GOOD), (1.1e-10, Grade.POOR),
        (1e-6, Grade.POOR), (1.1e-6, Grade.BROKEN), (math.inf, Grade.BROKEN), (math.nan, Grade.BROKEN),
    ],
)  # fmt: skip
def test_a_grade_ends_where_it_is_said_to(error, grade):
    assert part(error).grade is grade
    assert graded("law", [part(0.0), part(error)]).grade is grade


def test_what_float64_can_attain_is_asked_only_where_the_lower_bound_does_not_do():
    def never():
        raise AssertionError

    for error in (0.0, 2e-16, 3e-16):
        assert ErrorPart("x", error, 1.0, 1e-16, error_bound=never).grade is Grade.EXACT


def test_an_error_goes_in_proportion_to_its_scale_and_no_scale_allows_no_error():
    assert part(1e-8, scale=1e3).grade is Grade.GOOD
    assert part(1e-8, scale=0.0, error_bound=0.0).size == math.inf
    assert part(0.0, scale=0.0, error_bound=0.0).grade is Grade.EXACT
    assert part(0.0, scale=0.0).size == 0.0
    assert part(math.nan, scale=0.0).size == math.inf


def test_a_violation_carries_the_error_and_the_bound_of_the_grade_asked_for():
    for at_most, error, bound in [
        (Grade.EXACT, 1e-7, 3e-16),
        (Grade.GOOD, 1e-7, 1e-10),
        (Grade.POOR, 1e-5, 1e-6),
    ]:
        with pytest.raises(LawViolation, match=r"^law: x: error") as caught:
            graded("law", [part(error)], at_most, x=1)
        assert (caught.value.error, caught.value.bound) == pytest.approx(
            (error, bound), rel=1e-12, abs=0
        )
    with pytest.raises(LawViolation, match=r"fault = 'NaN'") as caught:
        graded("law", "NaN", Grade.POOR)
    # No error is small enough for what gave no result.
    assert (caught.value.error, caught.value.bound) == (math.inf, 0.0)
    assert graded("law", "NaN").fault == "NaN"


@pytest.mark.parametrize(("at_most", "bound"), [(Grade.GOOD, 1e-5), (Grade.POOR, 1e-3)])
def test_a_violation_of_what_computes_in_float32_carries_the_bound_of_float32(at_most, bound):
    with pytest.raises(LawViolation, match=f"exceeds {bound:g}") as caught:
        graded("law", [ErrorPart("x", 1e-2, 1.0, 0.0, SINGLE)], at_most)
    assert caught.value.bound == bound
