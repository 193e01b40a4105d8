"""log on SO(3) and SE(3) against matrix functions at angles on both sides of every switch."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.linalg import expm

from poekin.formulas.lie import logarithm
from tests.formulas.matrices import exp, flat, hat
from tests.formulas.on_both_sides import AXES, NEAR_V, TURN, VECTORS, V, same


@pytest.mark.parametrize(
    "w", VECTORS, ids=lambda w: f"{np.linalg.norm(w):.3g} about {np.round(w, 2)}"
)
def test_log_is_that_of_matrices(w):
    same(logarithm.so3(expm(hat(w)).ravel()), w)
    # near pi the linear part answers to w by a factor of some units
    same(logarithm.se3(flat(exp((*w, *V)))), np.r_[w, V], 10)


@pytest.mark.parametrize("turns", [-2, -1, 0, 1, 2])
@pytest.mark.parametrize("t", [0.3, 0.97, 1.03, 2.5, 3.1])
def test_the_logarithm_asked_for_is_found(turns, t):
    for axis in AXES:
        w = axis * (t + turns * TURN)
        R, T = expm(hat(w)), exp((*w, *V))
        near = w + 0.4 * np.cross(axis, V) + 0.9 * axis  # nearer to w than to w + 2 pi k, k != 0
        same(logarithm.so3_near(R.ravel(), tuple(near)), w, 30)
        same(logarithm.se3_near(flat(T), tuple(near), tuple(NEAR_V)), np.r_[w, V], 300)


@pytest.mark.parametrize(
    "n", [(1, -1, 0), (1, 0, -1), (0, 1, -1), (1, -1, -1), (1, -1, 0.5)], ids=str
)
def test_of_components_equally_large_the_first_is_positive_at_pi(n):
    n = np.array(n) / np.linalg.norm(n)
    same(logarithm.so3((2 * np.outer(n, n) - np.eye(3)).ravel()), math.pi * n)


def test_a_rotation_that_is_none_quite_enters_squared():
    """log of R + dR, dR orthogonal to the rotations, is log of R but for dR^2."""
    for axis in AXES:
        for t in (0.4, 1.5, 3.0):
            R = expm(hat(axis * t))
            for d in np.eye(3):
                S = np.outer(d, d) + 0.3 * np.diag(d[[1, 2, 0]])
                same(logarithm.so3((R + 1e-7 * R @ S).ravel()), axis * t, 30)


def test_at_half_a_turn_nothing_of_a_shift_across_the_axis_stays_along_itself():
    """(theta/2) cot(theta/2) = 0: v is across the axis and across p, exactly."""
    half_turn = (-1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 1.0)
    for length in (0.7, 1.3, 5.1):
        v = logarithm.se3((*half_turn, length, 0.0, 0.0))[3:]
        assert v[0] == v[2] == 0.0
        assert v[1] == pytest.approx(-math.pi / 2 * length, rel=1e-15)


@pytest.mark.parametrize(
    "along, push",
    [(0.0, 0.0), (50.0, 0.0), (0.0, 30.0), (0.5, 0.3)],
    ids=["rounding of 1", "long", "pushed", "mixed"],
)
@pytest.mark.parametrize("turns", [1, 3])
def test_a_whole_turn_takes_a_shift_across_its_axis_for_rounding_up_to_1e_15_and_no_further(
    turns, along, push
):
    """1e-15 sqrt(1 + |p|^2 + |theta v|^2): what exp at (w; v) may leave there."""
    identity, phi = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0), TURN * turns
    limit = 1e-15 * math.sqrt(1.0 + along**2 + (phi * push) ** 2)
    w, v = (0.0, 0.0, phi), (push, 0.0, 0.0)
    found = logarithm.se3_near((*identity, 0.0, 0.98 * limit, along), w, v)
    same(found, (*w, *v[:2], along))
    lost = logarithm.se3_near((*identity, 0.0, 1.02 * limit, along), w, v)
    assert np.isnan(lost[3:]).all()
    same(lost[:3], w)
