"""Arms that are calibrated where choose_poses says are nearer to the truth than others."""

from __future__ import annotations

import pytest

from benchmarks.cases.calibration_poses import FEW, SETTINGS, true_errors


@pytest.mark.parametrize("setting", SETTINGS, ids=" ".join)
def test_the_true_error_of_24_calibrations_is_nine_tenths_of_that_after_random_choices(setting):
    chosen, at_random = true_errors(*setting, n=FEW, repeats=24)
    assert chosen.mean() / at_random.mean() <= 0.9
