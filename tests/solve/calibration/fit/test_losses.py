"""Losses by their definitions, their weights and second derivatives by differences, and quantiles of
chi-square by tables.
"""

from __future__ import annotations

import math
from typing import get_args

import numpy as np
import pytest

from poekin.solve.calibration.fit import losses
from poekin.solve.calibration.fit.losses import LossName, chi_square, loss

ROBUST: dict[LossName, float] = {"huber": 1.345, "cauchy": 2.385, "tukey": 4.685}  # thresholds
S = np.array([0.0, 0.3, 0.9, 1.7, 2.5, 4.0, 7.0, 18.0, 40.0])


@pytest.mark.parametrize(("quantile", "of_one", "of_three", "of_six"), [
    (0.0, 0.455, 2.366, 5.348),  # the median
    (1.644854, 3.841, 7.815, 12.592),  # 95 %
    (2.326348, 6.635, 11.345, 16.812),  # 99 %
    (losses.OUTLIER, 15.14, 21.11, 27.86),  # all but one in 10^4
])  # fmt: skip
def test_quantiles_of_chi_square_are_those_of_tables(quantile, of_one, of_three, of_six):
    """To what is said of them: 8 % for one number at the largest, 4 % for more."""
    assert chi_square(1, quantile) == pytest.approx(of_one, rel=0.08)
    assert chi_square(3, quantile) == pytest.approx(of_three, rel=0.04)
    assert chi_square(6, quantile) == pytest.approx(of_six, rel=0.04)
    k = 2 / (9 * 6)
    assert chi_square(6, quantile) == pytest.approx(6 * (1 - k + quantile * math.sqrt(k)) ** 3)


@pytest.mark.parametrize("name", ROBUST)
def test_the_quantile_of_a_threshold_is_that_of_one_normal_number(name):
    """P(|e| < threshold) of a normal number is the quantile's P, to a hundredth of the quantile."""
    inside = math.erf(ROBUST[name] / math.sqrt(2))
    near = losses._QUANTILE[name] + np.array([-0.01, 0.01])
    below, above = (0.5 * (1 + math.erf(q / math.sqrt(2))) for q in near)
    assert below < inside < above


@pytest.mark.parametrize("width", [1, 3])
@pytest.mark.parametrize("name", get_args(LossName))
def test_losses_are_as_defined_and_their_derivatives_as_differences(name, width):
    c = 0.0 if name == "linear" else chi_square(width, losses._QUANTILE[name])
    far = c < S
    expected = {
        "linear": S,
        "huber": np.where(far, 2 * np.sqrt(c * S) - c, S),
        "cauchy": c * np.log1p(S / c) if c else S,
        "tukey": c / 3 * (1 - np.where(far, 0.0, 1 - S / c) ** 3) if c else S,
    }
    found = loss(name, S, width)
    np.testing.assert_allclose(found.rho, expected[name], rtol=1e-13)
    step = 1e-4
    ahead = loss(name, S + step, width)
    behind = loss(name, S - step, width)
    # central differences of functions whose third derivatives are of 1, over rounding of 20
    np.testing.assert_allclose((ahead.rho - behind.rho) / (2 * step), found.weight, atol=1e-8)
    np.testing.assert_allclose(
        (ahead.weight - behind.weight) / (2 * step), found.rho_second, atol=1e-8
    )


def test_at_its_threshold_a_loss_is_that_of_a_small_error():
    c = chi_square(1, losses._QUANTILE["huber"])
    found = loss("huber", np.array([c]), 1)
    assert (found.rho[0], found.weight[0], found.rho_second[0]) == (c, 1.0, 0.0)
