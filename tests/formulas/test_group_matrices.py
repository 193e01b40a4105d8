"""exp, log and their Jacobians as plain formulas: against matrix functions at angles on both sides
of every switch.
"""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest
from scipy.linalg import expm

from poekin.formulas.lie import exp_jacobian, exponential, logarithm, quaternion

AXES = [np.array(a) / np.linalg.norm(a) for a in ((3, 2, 1), (1, -3, 2), (-2, 1, 3), (1, 1, -0.2))]
V, NEAR_V = np.array([0.7, -1.1, 0.4]), np.array([0.2, 0.5, -0.3])
ANGLES = (1e-9, 0.3, 0.97, 1.03, 1.97, 2.03, 3.1)
FEW = 1e-13  # of matrix functions at arguments of norm up to 7: SciPy's own accuracy, not poekin's
TURN = 2 * math.pi


def hat(w):
    return np.cross(np.eye(3), w)


def brackets(w, v):
    X = np.zeros((4, 4))
    X[:3, :3], X[:3, 3] = hat(w), v
    return X


def ad(w, v):
    return np.block([[hat(w), np.zeros((3, 3))], [hat(v), hat(w)]])


def integral(M):
    """The integral of exp(M s) over s in 0..1, which is a corner of an exponential."""
    n = len(M)
    return expm(np.block([[M, np.eye(n)], [np.zeros((n, 2 * n))]]))[:n, n:]


def flat(T):
    return (*T[:3, :3].ravel().tolist(), *T[:3, 3].tolist())


VECTORS = [tuple((t * a).tolist()) for t in ANGLES for a in AXES]


def same(got, expected, far=1.0):
    np.testing.assert_allclose(got, expected, rtol=0, atol=FEW * far)


@pytest.mark.parametrize(
    "w", VECTORS, ids=lambda w: f"{np.linalg.norm(w):.3g} about {np.round(w, 2)}"
)
def test_exp_log_and_jacobians_are_those_of_matrices(w):
    w = tuple(w)
    R, T = expm(hat(w)), expm(brackets(w, V))
    same(exponential.so3(w), R.ravel())
    same(exponential.se3(w, V), flat(T))
    same(logarithm.so3(R.ravel()), w)
    same(
        logarithm.se3(flat(T)), np.r_[w, V], 10
    )  # near pi the linear part answers to w by a factor of some units
    J = integral(ad(w, V))
    same(exp_jacobian.left(w), J[:3, :3].ravel())
    same(exp_jacobian.left_dual(w, V), J[3:, :3].ravel())
    inverse = np.linalg.inv(J)
    same(exp_jacobian.left_inverse(w), inverse[:3, :3].ravel())
    same(exp_jacobian.left_inverse_dual(w, V), inverse[3:, :3].ravel())


@pytest.mark.parametrize("turns", [-2, -1, 0, 1, 2])
@pytest.mark.parametrize("t", [0.3, 0.97, 1.03, 2.5, 3.1])
def test_the_logarithm_asked_for_is_found(turns, t):
    for axis in AXES:
        w = axis * (t + turns * TURN)
        R, T = expm(hat(w)), expm(brackets(w, V))
        near = w + 0.4 * np.cross(axis, V) + 0.9 * axis  # nearer to w than to w + 2 pi k, k != 0
        same(logarithm.so3_near(R.ravel(), tuple(near)), w, 30)
        same(logarithm.se3_near(flat(T), tuple(near), tuple(NEAR_V)), np.r_[w, V], 300)


def test_the_quaternion_is_that_of_the_angle_and_at_pi_its_largest_component_is_positive():
    for axis in AXES:
        for t in ANGLES:
            q = np.array(quaternion.quaternion(expm(hat(axis * t)).ravel()))
            same(q / np.linalg.norm(q), np.r_[math.cos(t / 2), math.sin(t / 2) * axis])
        half_turn = 2 * np.outer(axis, axis) - np.eye(3)
        q = np.array(quaternion.quaternion(half_turn.ravel()))
        same(q / np.linalg.norm(q), np.r_[0.0, axis * np.sign(axis[np.abs(axis).argmax()])])


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
