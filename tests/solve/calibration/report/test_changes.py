"""What a calibration changed, in words: in mm, mrad and degrees, to three digits."""

from __future__ import annotations

from math import erf, sqrt
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from poekin.solve.calibration.report import changes


def test_a_95_percent_interval_is_so_many_deviations_that_one_in_20_normal_numbers_lies_outside():
    assert erf(changes.TWO_SIGMA / sqrt(2)) == pytest.approx(0.95, rel=1e-14)


@pytest.mark.parametrize(
    ("value", "said"),
    [(1.23456e-3, "1.23"), (12.0, "1.2e+04"), (-0.0, "0"), (-2e-5, "-0.02"), (np.nan, "")],
)
def test_lengths_and_angles_are_told_as_thousandths_to_three_digits(value, said):
    assert changes.milli(value) == said


def medians(length: float, angle: float) -> SimpleNamespace:
    return SimpleNamespace(median_length=length, median_angle=angle)


def of(held_out: bool, success: bool, angle: float = 2e-3) -> Any:
    kept = SimpleNamespace(before=medians(3e-3, angle), after=medians(4e-4, angle / 4))
    return SimpleNamespace(
        before=medians(5e-3, angle),
        after=medians(1e-4, angle / 5),
        cross_validation=kept if held_out else None,
        success=success,
    )


def test_held_out_data_come_first_and_each_is_named():
    found = of(held_out=True, success=True)
    kept = found.cross_validation
    assert [tuple(some) for some in changes.errors(found)] == [
        ("nominal, held out", kept.before),
        ("calibrated, held out", kept.after),
        ("nominal, all data", found.before),
        ("calibrated, all data", found.after),
    ]
    assert [name for name, _ in changes.errors(of(False, True))] == [
        "nominal, all data",
        "calibrated, all data",
    ]


@pytest.mark.parametrize(
    ("found", "said"),
    [
        (
            of(True, True),
            "On held-out data, the median position error goes from 3 to 0.4 mm, the rotation error "
            "from 2 to 0.5 mrad.",
        ),
        (
            of(False, True, np.nan),
            "On the data it was fitted to, the median position error goes from 5 to 0.1 mm.",
        ),
        (
            of(False, False),
            "The search did NOT converge: this is the best that was found. On the data it was "
            "fitted to, the median position error goes from 5 to 0.1 mm, the rotation error from 2 "
            "to 0.4 mrad.",
        ),
    ],
)
def test_a_sentence_says_on_what_data_and_by_how_much_the_arm_is_better(found, said):
    assert changes.sentence(found) == said


@pytest.mark.parametrize(
    ("unit", "angle", "normal", "shift", "zero", "cells"),
    [
        ("rad", np.pi / 6, 2e-3, 1.5e-4, np.pi / 180, ("30", "2", "0.15", "1 °")),
        ("m", 0.0, None, None, 2.5e-3, ("0", "", "", "2.5 mm")),
        ("rad", 1e-12, 1e-13, -2e-12, -1e-12, ("0", "0", "-2e-09", "0 °")),
    ],
)
def test_a_row_has_degrees_and_millimetres_and_no_rounding(unit, angle, normal, shift, zero, cells):
    joint: Any = SimpleNamespace(
        name_a="elbow", unit=unit, angle=angle, normal=normal, shift=shift, zero_offset=zero
    )
    assert changes.row(joint) == ("elbow", *cells)
    assert len(changes.HEADS) == len(changes.row(joint))
