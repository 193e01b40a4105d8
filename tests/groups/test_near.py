"""The branch of the logarithm that is asked for: followed through whole turns, refused where there
is none.
"""

import numpy as np
import pytest

from benchmarks.accuracy.worst_errors import REPORT_BAR
from poekin.errors import BranchError
from poekin.groups import se3, so3
from poekin.testing.accuracy import error_bounds
from poekin.testing.oracles import exact

AXIS = np.array([1.0, 2.0, 3.0]) / np.sqrt(14)


def test_a_joint_is_followed_through_two_turns():
    S, xi = np.array([0, 0, 1, 0.2, -0.5, 0]), np.zeros(6)
    for t in np.linspace(0, 4 * np.pi, 401):
        xi = se3.log(se3.exp(S * t), near=xi)
        assert np.abs(xi[:3] - [0, 0, t]).max() < 1e-14
        assert np.abs(se3.exp(xi) - se3.exp(S * t)).max() < 2e-14


def test_a_whole_turn_keeps_the_part_of_v_that_the_pose_does_not_show():
    xi = np.array([0, 0, 2 * np.pi, 1.0, -2.0, 0.5])
    np.testing.assert_allclose(se3.log(se3.exp(xi), near=xi), xi, rtol=0, atol=1e-14)


@pytest.mark.parametrize("gap", [1e-2, 1e-6, -1e-6, 1e-10, 1e-12])
def test_close_to_a_whole_turn_exp_gives_the_pose_back(gap):
    xi = np.r_[AXIS * (2 * np.pi + gap), 2 * np.pi * np.array([0.3, -0.2, 0.5])]
    T = se3.exp(xi)
    np.testing.assert_allclose(se3.exp(se3.log(T, near=xi)), T, rtol=0, atol=4e-15)


@pytest.mark.parametrize("gap", [2.0, 0.1, 1e-2, 1e-6])
def test_beside_a_whole_turn_what_is_near_is_as_exact_as_the_report_allows(gap):
    # At 2 rad omega was off by twice what is attainable, about an axis of the frame.
    rng = np.random.default_rng(0)
    along = np.eye(3)[rng.integers(3, size=60)] + 1e-7 * rng.normal(size=(60, 3))
    for n, v in zip([*along, *rng.normal(size=(20, 3))], rng.normal(size=(80, 3)), strict=True):
        angle = 2 * np.pi - gap * rng.uniform(0.9, 1.1)
        xi = np.r_[n / np.linalg.norm(n) * angle, v]
        T = se3.exp(xi)
        w = exact.log(T)[:3]
        w *= 1 - 2 * exact.mp.pi / exact.norm(w)  # a whole turn on, about the same line
        truth = np.r_[w, exact.left_jacobian_inverse(w) @ exact.exactly(T[:3, 3])]
        off = exact.exactly(se3.log(T, near=xi)) - truth
        bound = error_bounds.log_bound(truth)
        assert exact.norm(off[:3]) <= REPORT_BAR * bound.angular
        assert exact.norm(off[3:]) <= REPORT_BAR * bound.linear


def test_a_translation_across_a_whole_turn_has_no_logarithm():
    T = np.tile(np.eye(4), (2, 3, 1, 1))
    T[1, 2, 0, 3] = 1.0
    with pytest.raises(
        BranchError,
        match=r"T\[1, 2\] has .* near omega = \[0.0, 0.0, 6.0\].* p = \[1.0, 0.0, 0.0\]$",
    ):
        se3.log(T, near=[0, 0, 6, 0, 0, 0])
    np.testing.assert_allclose(
        se3.log(T[1, 2], near=[6, 0, 0, 0, 0, 0]), [2 * np.pi, 0, 0, 1, 0, 0], rtol=0, atol=1e-15
    )


@pytest.mark.parametrize("angle", [1e-8, 1e-20, 1e-160])
@pytest.mark.parametrize("away", [0.0, 1.0, 2.9, 3.1])
def test_a_tiny_rotation_keeps_its_digits_near_a_reference_of_less_than_half_a_turn(angle, away):
    np.testing.assert_allclose(
        so3.log(so3.exp(AXIS * angle), near=[away, 0, 0]), AXIS * angle, rtol=1e-15, atol=0
    )


@pytest.mark.parametrize("away", [0.0, 2.9, 3.1])
def test_the_identity_has_the_logarithm_zero_near_a_reference_of_less_than_half_a_turn(away):
    assert so3.log(np.eye(3), near=[away, 0, 0]).tolist() == [0, 0, 0]


@pytest.mark.parametrize("near", [np.nan, np.inf])
def test_a_reference_that_is_no_number_gives_nan(near):
    assert np.isnan(so3.log(np.eye(3), near=[near, 0, 0])).all()
    assert np.isnan(so3.log(so3.exp([0.1, 0, 0]), near=[near, 0, 0])).all()
    assert np.isnan(se3.log(np.eye(4), near=[near, 0, 0, 0, 0, 0])[:3]).all()


@pytest.mark.parametrize("entry", range(4))
def test_nan_in_the_last_row_of_a_pose_shows_in_the_result(entry):
    T = np.tile(np.eye(4), (3, 1, 1))
    T[1, 3, entry] = np.nan
    for result in (se3.log(T), se3.inverse(T), se3.adjoint(T)):
        assert np.isnan(result[1]).any()
        assert np.isfinite(result[[0, 2]]).all()
