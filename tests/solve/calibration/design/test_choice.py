"""What a choice of configurations says of itself."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from poekin.solve.calibration.design.choice import Choice, DesignMetrics

MEDIAN = DesignMetrics(O1=0.5, condition=60.0, smallest=0.1, amplification=0.01, prediction=9.0)
BEST = DesignMetrics(O1=6, condition=7, smallest=8, amplification=9, prediction=10)
OWN = DesignMetrics(O1=1.0, condition=20.0, smallest=0.4, amplification=0.05, prediction=6.0)


def choice(criterion: Any, measured: int | None = None, median: DesignMetrics = MEDIAN) -> Choice:
    said = {} if measured is None else {"measured": measured}
    q = np.zeros((3, 2))
    return Choice(q, np.arange(3), criterion, OWN, median, BEST, 12, 13, (), 40, 7, **said)


@pytest.mark.parametrize(
    ("criterion", "figure", "times", "others"),
    [
        ("O1", "observability index O1 1", 2, "0.5, the best of them 6"),
        ("condition", "condition 20", 3, "60, the best of them 7"),
        ("smallest", "smallest singular value 0.4", 4, "0.1, the best of them 8"),
        ("amplification", "noise amplification index 0.05", 5, "0.01, the best of them 9"),
    ],
)
def test_a_choice_is_called_by_its_criterion_and_tells_what_it_leaves(
    criterion, figure, times, others
):
    assert str(choice(criterion)) == (
        f"3 of 40 configurations for 12 parameters: {figure}, {times}.00 times better than the "
        f"median of 7 random choices ({others}); noise leaves 0.67 times the error in the "
        "calibrated arm that it leaves after those"
    )


def test_the_predicted_error_is_what_is_left_in_the_arm_and_is_not_said_twice():
    assert str(choice("prediction")) == (
        "3 of 40 configurations for 12 parameters: predicted error 6, 1.50 times better than the "
        "median of 7 random choices (9, the best of them 10)"
    )


@pytest.mark.parametrize(
    ("measured", "words"), [(None, ""), (0, ""), (5, " beside 5 measured ones")]
)
def test_what_was_measured_before_is_counted_beside_the_choice(measured, words):
    found = choice("prediction", measured)
    assert found.measured == (measured or 0)
    assert str(found).startswith(f"3 of 40 configurations{words} for 12 parameters: ")


def test_a_choice_is_without_end_better_than_random_ones_that_show_nothing():
    nothing = DesignMetrics(0.0, np.inf, 0.0, 0.0, np.inf)
    found = choice("condition", median=nothing)
    assert found.improvement == (np.inf,) * 5
    assert str(found).endswith(
        "; noise leaves 0.00 times the error in the calibrated arm that it leaves after those"
    )


def test_the_document_of_a_choice_has_how_much_better_it_is():
    found = choice("smallest").to_dict()
    assert found["criterion_improvement"] == pytest.approx(4.0)
    better = {"O1": 2.0, "condition": 3.0, "smallest": 4.0, "amplification": 5.0, "prediction": 1.5}
    assert found["improvement"] == pytest.approx(better)
