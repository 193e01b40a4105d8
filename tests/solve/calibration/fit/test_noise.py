"""Losses, spreads and residuals by their definitions."""

from __future__ import annotations

import math
import warnings

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import InputError
from poekin.solve.calibration import calibrate
from poekin.solve.calibration.fit.losses import LOSSES, OUTLIER, chi_square, loss
from poekin.solve.calibration.fit.noise import (
    EVEN,
    LEAST,
    Noise,
    NoiseEstimate,
    check,
    estimate_noise,
)
from poekin.solve.calibration.measurements.points import Points
from poekin.solve.calibration.measurements.poses import Poses

# Table of chi-square: degrees of freedom, probability as a quantile of the normal distribution, the
# point.
TABLE = [
    (1, 1.959964, 5.02389), (3, 1.959964, 9.34840), (6, 1.644854, 12.59159), (6, 3.0902323, 22.45774),
    (1, 0.0, 0.454936), (3, 0.0, 2.365974), (6, 0.0, 5.348121),
]  # fmt: skip
FAR = [(1, 3.719, 15.1366, 0.08), (3, 3.719, 21.1075, 0.04), (1, 4.536, 21.9042, 0.14)]
ARM = pk.load("puma560").chain()


@pytest.mark.parametrize("name", LOSSES)
@given(s=st.floats(0, 1e6), width=st.sampled_from([1, 3, 6]))
def test_weight_and_bend_are_the_slopes_of_rho(name, s, width):
    step = 1e-6 * max(1.0, s)
    ahead, here, back = (
        loss(name, np.array([max(x, 0.0)]), width) for x in (s + step, s, s - step)
    )
    between = here.weight[0] * step + here.rho[0]
    # second order; at Huber's and Tukey's thresholds rho'' jumps, which makes it the first order of
    # rho'
    assert abs(ahead.rho[0] - between) <= 1e-5 * step + 1e-9 * abs(between)
    if s > 2 * step and np.sign(back.rho_second[0]) == np.sign(ahead.rho_second[0]):
        slope = (ahead.weight[0] - back.weight[0]) / (2 * step)
        assert abs(here.rho_second[0] - slope) <= 1e-4 * max(abs(slope), 1e-3)


@pytest.mark.parametrize("name", LOSSES)
def test_a_loss_is_the_square_for_small_errors_and_never_more(name):
    s = np.geomspace(1e-12, 1e6, 200)
    rho = loss(name, s, 6)
    assert (rho.rho <= s * (1 + 1e-12)).all()
    assert (rho.weight <= 1).all()
    np.testing.assert_allclose(rho.rho[:10], s[:10], rtol=1e-9)
    none = loss(name, np.zeros(1), 6)
    assert (none.rho[0], none.weight[0]) == (0.0, 1.0)


@pytest.mark.parametrize(("width", "quantile", "point"), TABLE, ids=lambda x: f"{x:g}")
def test_chi_square_agrees_with_the_table_to_its_accuracy(width, quantile, point):
    assert chi_square(width, quantile) == pytest.approx(point, rel=0.04 if width == 1 else 0.01)


@pytest.mark.parametrize(("width", "quantile", "point", "accuracy"), FAR, ids=lambda x: f"{x:g}")
def test_far_out_chi_square_is_less_exact_and_never_too_small(width, quantile, point, accuracy):
    assert point < chi_square(width, quantile) < (1 + accuracy) * point


@pytest.mark.parametrize("robust", [False, True], ids=["rms", "median"])
def test_spreads_are_those_of_normal_errors(robust):
    rng = np.random.default_rng(0)
    q = ARM.random(0, 4000)
    errors = rng.normal(size=(4000, 6)) * ([2e-3] * 3 + [5e-4] * 3)
    (found,) = estimate_noise([Poses(ARM.fk(q))], [errors], 0, robust, 1.0)
    assert found is not None
    # 12 000 numbers: the rms is known to 0.65 %, the median to 1.1 %; four deviations
    assert found.angle == pytest.approx(2e-3, rel=0.045)
    assert found.length == pytest.approx(5e-4, rel=0.045)


def test_outliers_do_not_move_the_robust_spread_much():
    rng = np.random.default_rng(0)
    errors = rng.normal(size=(1000, 6)) * 1e-3
    errors[:50] += 1.0
    (found,) = estimate_noise([Poses(ARM.fk(ARM.random(0, 1000)))], [errors], 0, True, 1.0)
    assert found is not None
    assert found.length == pytest.approx(1e-3, rel=0.15)


def test_a_covariance_whitens_errors_that_have_it():
    rng = np.random.default_rng(0)
    L = np.tril(rng.normal(size=(6, 6))) + 3 * np.eye(6)
    poses = Poses(ARM.fk(ARM.random(0, 5000)), L @ L.T)
    errors = rng.normal(size=(5000, 6)) @ L.T
    white = Noise([poses], [None]).whitened(0, errors[..., None])[..., 0]
    # 5000 samples: variances to 2 %, correlations to 1.4 %; four deviations
    np.testing.assert_allclose(np.cov(white.T), np.eye(6), rtol=0, atol=0.08)


@pytest.mark.parametrize("loss", ["linear", "huber"])
@pytest.mark.parametrize(
    ("times", "said"), [(0.1, "remark"), (1.0, None), (1.5, None), (10.0, "warning")]
)
def test_a_covariance_that_the_residuals_contradict_is_named(times, said, loss):
    arm, rng = pk.load("puma560").chain(), np.random.default_rng(3)
    q = arm.random(rng, 60)
    noise = 1e-4 * rng.normal(size=(60, 6))
    T = arm.fk(q) @ pk.se3.exp(noise)
    measured = Poses(T, covariance=(1e-4 / times) ** 2 * np.eye(6))
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always")
        found = calibrate(arm, q, measured, loss=loss, folds=0)
    words = [w for w in (*found.warnings, *found.remarks) if "covariance=" in w]
    assert len(words) == bool(said)
    assert (
        [w for w in found.warnings if "covariance=" in w]
        == words * (said == "warning")
        == [str(w.message) for w in heard if "covariance=" in str(w.message)]
    )
    if said:
        stated = float(words[0].split("residuals are ")[1].split(" times")[0])
        assert stated == pytest.approx(times, rel=0.25)  # of 60 measurements


def test_few_numbers_contradict_no_covariance():
    arm, rng = pk.load("puma560").chain(), np.random.default_rng(3)
    q = arm.random(rng, 9)
    T = arm.fk(q) @ pk.se3.exp(1e-4 * rng.normal(size=(9, 6)))
    found = calibrate(
        arm, q, Poses(T, covariance=1e-10 * np.eye(6)), folds=0
    )  # 54 numbers for 30 parameters
    assert not found.warnings


ONE = np.tile(np.eye(4), (2, 1, 1))


def test_a_spread_is_the_root_mean_square_or_the_median_of_all_numbers_of_its_kind_for_each_parameter_fitted():
    errors = np.array([[1.0, -2, 3, 10, 20, -30], [-4, 5, 6, -40, 50, 60]])
    measured, rms = [Poses(ONE)], np.sqrt(91 / 6)
    assert estimate_noise(measured, [errors], 0, False, 7.0) == [
        pytest.approx(NoiseEstimate(rms, 10 * rms))
    ]
    # 12 numbers for 9 parameters: each of the residuals is half as large as the noise.
    assert estimate_noise(measured, [errors], 9, False, 7.0) == [
        pytest.approx(NoiseEstimate(2 * rms, 20 * rms))
    ]
    all_fitted = 12**0.5 * rms
    assert estimate_noise(measured, [errors], 12, False, 7.0) == [
        pytest.approx(NoiseEstimate(all_fitted, 10 * all_fitted))
    ]
    median = 3.5 / 0.6744897501960817
    assert estimate_noise(measured, [errors], 0, True, 7.0) == [
        pytest.approx(NoiseEstimate(median, 10 * median))
    ]
    points = [Points(np.zeros((2, 3))), Poses(ONE, np.eye(6)), Poses(ONE)]
    lengths, given, poses = estimate_noise(points, [errors[:, :3], errors, errors], 12, False, 7.0)
    more = (30 / 18) ** 0.5  # 30 numbers for 12 parameters
    assert lengths == (None, pytest.approx(more * rms))
    assert given is None
    assert poses == pytest.approx((more * rms, 10 * more * rms))


@pytest.mark.parametrize("angle, length, expected", [
    (1.0, 1e-7, (1.0, EVEN)), (1e-7, 1.0, (EVEN, 1.0)), (1.0, 0.5, (1.0, 0.5)), (0.0, 0.0, (LEAST, LEAST)),
    (1e-20, 1e-20, (LEAST, LEAST)),
])  # fmt: skip
def test_angles_and_lengths_in_reaches_are_not_taken_to_be_more_uneven_than_that(
    angle, length, expected
):
    reach = 7.0
    errors = np.repeat([[angle, length * reach]], 3, axis=1).repeat(2, axis=0)
    (found,) = estimate_noise([Poses(ONE)], [errors], 0, False, reach)
    assert found == pytest.approx((expected[0], expected[1] * reach), rel=1e-12, abs=0)
    (even,) = estimate_noise([Poses(ONE)], [errors], 0, False, reach, even=0.5)
    assert even is not None
    assert even.length / reach >= 0.5 * (even.angle or 0)
    assert (even.angle or 0) >= 0.5 * even.length / reach
    (lengths,) = estimate_noise([Points(np.zeros((2, 3)))], [errors[:, 3:]], 0, False, reach)
    assert lengths == (None, pytest.approx(max(length, LEAST) * reach, rel=1e-12, abs=0))


def test_errors_are_whitened_by_their_spreads_or_their_covariance():
    C = np.diag([1.0, 4, 9, 16, 25, 36])
    noise = Noise(
        [Poses(ONE), Points(np.zeros((2, 3))), Poses(ONE, C)],
        [NoiseEstimate(2.0, 5.0), NoiseEstimate(None, 4.0), None],
    )
    ones = np.ones((2, 6, 1))
    assert noise.whitened(0, ones)[1, :, 0] == pytest.approx([1 / 2] * 3 + [1 / 5] * 3)
    assert noise.whitened(1, ones[:, :3])[0, :, 0] == pytest.approx([1 / 4] * 3)
    assert noise.whitened(2, ones)[1, :, 0] == pytest.approx(1 / np.arange(1, 7))
    spreads = ([2.0] * 3 + [5.0] * 3, [4.0] * 3, np.arange(1.0, 7.0))
    for k, spread in enumerate(spreads):
        white = np.array([0.5, -3.0])[:, None] * np.ones(len(spread))
        assert noise.unwhitened(k, white) == pytest.approx(white * spread)
        assert noise.whitened_errors(k, white * spread) == pytest.approx(white)


def test_spreads_are_not_estimated_from_no_more_numbers_than_parameters():
    both = [Poses(ONE, np.eye(6)), Poses(ONE)]
    check(both, 13, 12)
    check(both[:1], 12, 12)
    for numbers in (11, 12):
        with pytest.raises(
            InputError,
            match=f"^{numbers} equations for 12 parameters leave no residuals to estimate",
        ):
            check(both, numbers, 12)


# Holland and Welsch 1977, table 1: where each begins to doubt for 95 % efficiency, as the square of
# a normal number.
DOUBTS = {"huber": 1.345**2, "cauchy": 2.385**2, "tukey": 4.685**2}


@pytest.mark.parametrize("name", DOUBTS)
def test_a_loss_of_one_number_doubts_from_where_it_is_95_percent_efficient(name):
    c = chi_square(1, {"huber": 0.917, "cauchy": 2.121, "tukey": 4.536}[name])
    assert c == pytest.approx(
        DOUBTS[name], rel=0.14 if name == "tukey" else 0.03
    )  # as exact as chi_square is there
    s = np.array([0.0, 0.5 * c, c, 1.5 * c, 4 * c])
    found = loss(name, s, 1)
    u = s / c
    inside = np.minimum(u, 1)
    expected = {
        "huber": (np.where(u <= 1, s, 2 * np.sqrt(s * c) - c), 1 / np.sqrt(np.maximum(u, 1))),
        "cauchy": (c * np.log(1 + u), 1 / (1 + u)),
        "tukey": (c / 3 * (1 - (1 - inside) ** 3), (1 - inside) ** 2),
    }[name]
    np.testing.assert_allclose(found.rho, expected[0], rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(found.weight, expected[1], rtol=1e-12, atol=1e-12)
    kinks = {"huber": [0, 0, 0, -0.5 / (c * 1.5**1.5), -0.5 / (8 * c)], "cauchy": -(1 / c) / (1 + u) ** 2,
             "tukey": [-2 / c, -1 / c, 0, 0, 0]}[name]  # fmt: skip
    np.testing.assert_allclose(found.rho_second, kinks, rtol=1e-12, atol=1e-15)
    squares = loss("linear", s, 1)
    assert (squares.rho.tolist(), squares.weight.tolist(), squares.rho_second.tolist()) == (
        s.tolist(),
        [1.0] * 5,
        [0.0] * 5,
    )


def test_one_good_measurement_in_ten_thousand_is_called_an_outlier():
    assert math.erfc(OUTLIER / math.sqrt(2)) / 2 == pytest.approx(1e-4, rel=1e-3)
