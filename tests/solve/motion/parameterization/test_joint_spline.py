"""The spline through configurations, against SciPy's."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from poekin.solve.motion.parameterization.joint_spline import (
    SAME_POINT,
    distinct_points,
    make_joint_spline,
)


@pytest.mark.parametrize("count", [2, 3, 4, 5, 40])
def test_the_spline_and_its_derivatives_are_scipy_s_over_the_chord_length(count):
    q = np.random.default_rng(count).uniform(-2, 2, (count, 6))
    spline = make_joint_spline(q)
    chords = [np.linalg.norm(b - a) for a, b in itertools.pairwise(q)]
    np.testing.assert_allclose(spline.knots, np.append(0, np.cumsum(chords)), rtol=1e-14)
    s = np.linspace(0, spline.knots[-1], 1001)
    expected = CubicSpline(spline.knots, q)
    for order, found in enumerate(spline.at(s)):
        # two tridiagonal solvers, each off by some roundings of numbers up to 100
        np.testing.assert_allclose(found, expected(s, order), rtol=0, atol=1e-12)


def test_the_spline_goes_through_its_points_to_the_last_bit():
    q = np.random.default_rng(1).normal(size=(30, 4))
    spline = make_joint_spline(q)
    np.testing.assert_array_equal(spline.at(spline.knots).q, q)


def test_one_parameter_gives_one_configuration():
    spline = make_joint_spline(np.array([[0.0, 0.0], [3.0, 4.0]]))
    q, first, second = spline.at(np.array(2.5))
    np.testing.assert_allclose(q, [1.5, 2.0], atol=1e-15)
    np.testing.assert_allclose(first, [0.6, 0.8], atol=1e-15)
    np.testing.assert_array_equal(second, [0.0, 0.0])


def test_points_that_repeat_the_one_before_are_left_out():
    q = np.array([0.0, 0.0, 1.0, 1.0 + 0.9 * SAME_POINT, 1.0 + 1.8 * SAME_POINT, 2.0, 1.0])[:, None]
    assert distinct_points(q).tolist() == [0, 2, 4, 5, 6]
    assert distinct_points(np.zeros((3, 2))).tolist() == [0]
