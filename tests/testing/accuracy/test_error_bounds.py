"""The attainable errors, against differences in high precision, and how results are judged by them."""

from __future__ import annotations

import math

import numpy as np
import pytest

from poekin.errors import ShapeError
from poekin.testing.accuracy import error_bounds
from poekin.testing.accuracy.error_bounds import UNIT
from poekin.testing.oracles import exact
from poekin.testing.oracles.exact import mp, norm

N = np.array([0.6, -0.64, 0.48])
V = np.array([0.3, 2.0, -1.1])
ANGLES = [0.0, 1e-150, 1e-6, 0.7, 2.0, math.pi - 1e-9, math.pi]


def twist(angle: float) -> np.ndarray:
    return np.concatenate([angle * N, V])


def slope(f, w: np.ndarray) -> np.ndarray:
    """The derivative (3, 3) of f at w, by central differences of step 1e-25: right to 1e-50."""
    step = mp.mpf(10) ** -25
    columns = [(f(w + step * e) - f(w - step * e)) / (2 * step) for e in exact.exactly(np.eye(3))]
    return np.stack(columns, axis=1)


@pytest.mark.parametrize("angle", [*ANGLES, 10.0])
def test_the_bound_of_exp_is_the_stated_formula(angle):
    x = exact.exactly(twist(angle))
    theta, t = norm(x[:3]), exact.exp(x)[:3, 3]
    dt = norm(slope(lambda w: exact.exp(np.concatenate([w, x[3:]]))[:3, 3], x[:3]))
    bound = error_bounds.exp_bound(x)
    assert float(bound.angular / UNIT) == pytest.approx(float(1 + mp.sqrt(2) * theta), rel=1e-12)
    assert float(bound.linear / UNIT) == pytest.approx(
        float(norm(t) + norm(x[3:]) + theta * dt), rel=1e-12
    )


@pytest.mark.parametrize("angle", ANGLES)
def test_the_bound_of_log_is_the_stated_formula(angle):
    x = exact.exactly(twist(angle))
    theta, t = norm(x[:3]), exact.exp(x)[:3, 3]
    kappa = theta / 2 / mp.sin(theta / 2) if theta else mp.one
    dv = norm(slope(lambda w: exact.left_jacobian_inverse(w) @ t, x[:3]))
    bound = error_bounds.log_bound(x)
    relative = 1 + 1.22 * float(kappa) * min(1, 1 / angle if angle else 1)
    assert float(bound.angular / UNIT) == pytest.approx(relative * angle, rel=1e-12)
    assert float(bound.linear / UNIT) == pytest.approx(
        float(norm(x[3:]) + kappa * norm(t) + theta * dv), rel=1e-12
    )


@pytest.mark.parametrize("size", [3, 6])
@pytest.mark.parametrize("angle", ANGLES)
def test_the_nearest_floats_are_attainable(angle, size):
    xi = twist(angle)[:size]
    T = exact.rounded(exact.exp(xi))
    assert error_bounds.ratio_exp(xi, T) <= 1
    assert error_bounds.ratio_log(T, exact.rounded(exact.log(T))) <= 1


@pytest.mark.parametrize("place", [(i, j) for i in range(3) for j in range(4)])
def test_a_small_error_in_any_entry_is_seen(place):
    xi = twist(1.0)
    T = exact.rounded(exact.exp(xi))
    T[place] += 1e-14
    assert error_bounds.ratio_exp(xi, T) > 3
    w = exact.rounded(exact.log(T))
    w[[place[0] if place[1] < 3 else 4]] += 3e-14
    assert error_bounds.ratio_log(T, w) > 3


@pytest.mark.parametrize(
    ("place", "value"),
    [(0, 1e-300), (1, -1e-300), (2, 1.0), (3, np.nextafter(1, 0)), (3, np.nextafter(1, 2))],
)
def test_the_last_row_must_be_exact(place, value):
    T = exact.rounded(exact.exp(twist(1.0)))
    T[3, place] = value
    assert error_bounds.ratio_exp(twist(1.0), T) == math.inf


@pytest.mark.parametrize("wrong", [math.nan, math.inf])
def test_what_is_not_finite_is_infinitely_wrong(wrong):
    T = exact.rounded(exact.exp(twist(1.0)))
    assert error_bounds.ratio_log(T, np.full(6, wrong)) == math.inf
    assert error_bounds.ratio_exp(twist(1.0), np.full((4, 4), wrong)) == math.inf


def test_log_of_the_identity_must_be_zero():
    assert error_bounds.ratio_log(np.eye(4), np.zeros(6)) == 0
    assert error_bounds.ratio_log(np.eye(4), np.array([1e-300, 0, 0, 0, 0, 0])) == math.inf


@pytest.mark.parametrize("size", [3, 6])
@pytest.mark.parametrize(
    ("gap", "both"), [(0.0, True), (7 * UNIT, True), (1e-15, False), (1e-9, False)]
)
def test_both_signs_are_right_within_8_u_of_pi_only(gap, both, size):
    # n = (0, 0, 1), so that R and its logarithm are known to the last digit: sin(π - gap) is gap to
    # 1e-48.
    with mp.workdps(100):
        w = mp.pi - mp.mpf(gap)
    xi = exact.exactly([0, 0, 0, 1, 2, 3])
    xi[2] = w
    T = exact.rounded(exact.exp(xi))
    gap_of_T = float(mp.pi - norm(exact.log(T[:3, :3])))
    assert (gap_of_T < error_bounds.BOTH_SIGNS) == both
    truth = exact.log(T)
    other = np.concatenate(
        [-truth[:3], exact.left_jacobian_inverse(-truth[:3]) @ exact.exactly(T[:3, 3])]
    )
    element = T if size == 6 else T[:3, :3]
    assert error_bounds.ratio_log(element, exact.rounded(truth[:size])) <= 1
    ratio = error_bounds.ratio_log(element, exact.rounded(other[:size]))
    assert ratio <= 1 if both else ratio > 1e14


@pytest.mark.parametrize(
    ("xi", "T"), [(np.zeros(6), np.eye(3)), (np.zeros(3), np.eye(4)), (np.zeros((1, 6)), np.eye(4))]
)
def test_a_twist_and_an_element_that_do_not_go_together_are_refused(xi, T):
    for call in (lambda: error_bounds.ratio_exp(xi, T), lambda: error_bounds.ratio_log(T, xi)):
        with pytest.raises(ShapeError) as caught:
            call()
        assert str(caught.value) == (
            "expected xi (6,) with T (4, 4), or xi (3,) with T (3, 3),"
            f" got {xi.shape} with {T.shape}"
        )
