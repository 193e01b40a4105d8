"""Cubic interpolation of points with rates, against SciPy's, and its largest rates."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline

from poekin.solve.motion.trajectory.hermite import peaks, sample

RNG = np.random.default_rng(0)
TIMES = np.cumsum(RNG.uniform(0.1, 0.5, 30))
Q = RNG.normal(size=(30, 3))
DQ = RNG.normal(size=(30, 3))


def test_samples_are_scipy_s():
    t = np.append(TIMES, RNG.uniform(TIMES[0], TIMES[-1], 500)).reshape(2, -1)
    expected = CubicHermiteSpline(TIMES, Q, DQ)
    for order, found in enumerate(sample(TIMES, Q, DQ, t)):
        # roundings of q/h² with h >= 0.1, in two forms
        np.testing.assert_allclose(found, expected(t, order), rtol=0, atol=1e-11)


def test_a_point_is_met_to_the_last_bit():
    np.testing.assert_array_equal(sample(TIMES, Q, DQ, TIMES)[0], Q)


def test_peaks_are_the_largest_of_dense_samples():
    speed, acceleration = peaks(TIMES, Q, DQ)
    spline = CubicHermiteSpline(TIMES, Q, DQ)
    h = np.diff(TIMES)[:, None]
    parts = np.linspace(1e-12, 1 - 1e-12, 10_001)
    for k in range(len(h)):
        t = TIMES[k] + parts * h[k]
        dense = np.abs(spline(t, 1)).max(axis=0)
        # between two samples a parabola is higher by ddq' dt²/8 at most: 1e-8 of its own size
        np.testing.assert_allclose(speed[k], dense, rtol=1e-6)
        np.testing.assert_allclose(acceleration[k], np.abs(spline(t, 2)).max(axis=0), rtol=1e-6)


@pytest.mark.parametrize("T", [2.0, 64.0])
def test_a_rate_that_peaks_within_a_step_is_seen(T):
    speed, acceleration = peaks(np.array([0.0, T]), np.array([[0.0], [1.0]]), np.zeros((2, 1)))
    np.testing.assert_allclose(speed, [[1.5 / T]], rtol=1e-15)
    np.testing.assert_allclose(acceleration, [[6 / T**2]], rtol=1e-15)
