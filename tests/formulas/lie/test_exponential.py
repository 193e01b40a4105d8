"""exp on SO(3) and SE(3) and a joint's exponential against matrix functions, the coefficients
against 60 digits; exp itself is held to 60 digits in tests/groups/test_accuracy.py.
"""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from scipy.linalg import expm

from poekin.algebra import dot
from poekin.formulas.lie import exponential, logarithm
from poekin.testing.oracles import exact
from poekin.testing.oracles.exact import mp
from tests.formulas.matrices import exp, flat, hat
from tests.formulas.on_both_sides import TURN, VECTORS, V, same

UNIT = 2.0**-53


def errors(w):
    """Of theta A, theta^2 B and cos theta, in units of 2^-53."""
    w = tuple(map(float, w))
    a, b, cosine = exponential.closed_form(w, dot(w, w))
    t = exact.norm(exact.exactly(w))
    return [
        abs(float(e)) / UNIT
        for e in (t * a - mp.sin(t), t * t * b - (1 - mp.cos(t)), cosine - mp.cos(t))
    ]


def test_what_rounding_takes_from_the_angle_does_not_count_in_a_b_and_the_cosine():
    rng = np.random.default_rng(5)
    vectors = rng.normal(size=(400, 3))
    vectors *= (rng.uniform(1, 10, 400) / np.linalg.norm(vectors, axis=1))[:, None]
    worst = np.max([errors(w) for w in vectors], axis=0)
    # sin and cos to 1 u, a sum and a quotient to u each of what is at most 1, or 2 of 1 - cos
    # theta, and u of the rest that is put back. An angle that is off by u theta alone would count
    # 10.
    assert (worst <= [3, 5, 2]).all(), worst


@pytest.mark.parametrize("off", [1e-6, -1e-6])
@pytest.mark.parametrize("t", [1.1, 2.3, 3.1, 5.0, 9.0])
def test_a_square_of_the_angle_that_is_off_counts_to_second_order_alone(t, off):
    w = (0.48 * t, -0.6 * t, 0.64 * t)
    found = exponential.closed_form(w, t * t * (1.0 + off))
    expected = (np.sin(t) / t, (1.0 - np.cos(t)) / t**2, np.cos(t))
    # the angle is off by half as much
    assert np.abs(np.subtract(found, expected)).max() <= (off * t) ** 2


@pytest.mark.parametrize(
    "w", VECTORS, ids=lambda w: f"{np.linalg.norm(w):.3g} about {np.round(w, 2)}"
)
def test_exp_is_that_of_matrices(w):
    same(exponential.so3(w), expm(hat(w)).ravel())
    same(exponential.se3(w, V), flat(exp((*w, *V))))


@pytest.mark.parametrize(
    "t", [1e-9, 0.1, 0.3, 0.5, 0.61, 0.7, 0.91, 0.99, *np.linspace(0.05, 0.95, 7).tolist()]
)
def test_below_one_radian_a_shift_along_the_axis_is_kept_to_the_last_bit(t):
    for length in (0.7, 1.3, 1e-3, 1e3):
        for T in (
            exponential.se3((0.0, 0.0, t), (0.0, 0.0, length)),
            exponential.se3((t, 0.0, 0.0), (length, 0.0, 0.0)),
        ):
            assert sorted(T[9:]) == [0.0, 0.0, length]
            assert sorted(map(abs, logarithm.se3(T)[3:])) == [0.0, 0.0, length]


@pytest.mark.parametrize("t", [1.1, 3.0, 6.2, TURN - 1e-3, TURN - 1e-9, TURN + 1e-6])
def test_beyond_one_radian_what_is_left_of_a_shift_across_the_axis_has_all_its_digits(t):
    """p = v sin t / t and v (1 - cos t) / t, of which near a whole turn nearly nothing is left."""
    p = exponential.se3((0.0, 0.0, t), (0.7, 0.0, 0.0))[9:]
    with mpmath.workdps(40):
        exact = 0.7 * mpmath.sin(t) / t, 0.7 * (1 - mpmath.cos(t)) / t
        assert abs(p[0] / exact[0] - 1) < 6e-16
        # 1 - cos t itself is good to the rounding of cos t
        assert abs(p[1] - exact[1]) < 2e-16
    assert p[2] == 0.0


@pytest.mark.parametrize("w", [(0.6, 0.0, -0.8), (0.0, 0.0, 0.0)], ids=["axis", "no axis"])
def test_a_joint_moves_by_the_exponential_of_its_screw(w):
    for v, q in (((0.3, -0.2, 0.7), 1.9), ((0.1, 0.4, -0.5), -0.6)):
        same(exponential.joint(w, v, q, np.sin(q), np.cos(q)), flat(exp(np.r_[w, v] * q)))


def test_the_forms_that_exp_and_its_jacobians_share_are_sums_of_matrices():
    rng = np.random.default_rng(11)
    w, u, p = rng.normal(size=(3, 3))
    W = hat(w)
    same(exponential.rotation(w, 0.37, 0.2), (np.eye(3) + 0.37 * W + 0.2 * W @ W).ravel())
    turned = 0.1 * np.eye(3) + 0.37 * W + (1 - 0.1) / (w @ w) * np.outer(w, w)
    same(exponential.rotation_by_cosine(w, 0.37, (1 - 0.1) / (w @ w), 0.1), turned.ravel())
    same(exponential.linear_combination(0.3, w, 0.37, u, 0.2, p), 0.3 * w + 0.37 * u + 0.2 * p)
