"""The laws of the groups by themselves: which of two results at π are right, and how errors go in
proportion.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from benchmarks.subjects import Poekin
from poekin.testing.conform import Grade
from poekin.testing.conform.laws import of_groups
from poekin.testing.oracles import exact

V = np.array([0.3, -2.0, 0.7])


def other_sign(X: np.ndarray) -> np.ndarray:
    """The logarithm of a pose with the opposite ω, rounded."""
    w = -exact.log(X)[:3]
    return exact.rounded(
        np.concatenate([w, exact.left_jacobian_inverse(w) @ exact.exactly(X[:3, 3])])
    )


@pytest.mark.parametrize(("gap", "grade"), [(0.0, Grade.EXACT), (1e-14, Grade.BROKEN)])
def test_within_rounding_of_pi_both_signs_are_right_each_with_its_v_and_further_away_one_is(
    gap, grade
):
    X = exact.rounded(exact.exp(np.array([0, math.pi - gap, 0, *V])))
    law = of_groups.log_is_the_principal_logarithm
    assert law(Poekin.log, X, Grade.BROKEN).grade is Grade.EXACT
    assert law(lambda X: other_sign(X), X, Grade.BROKEN).grade is grade
    assert law(lambda R: other_sign(X)[:3], X[:3, :3], Grade.BROKEN).grade is grade
    mixed = np.concatenate([other_sign(X)[:3], Poekin.log(X)[3:]])
    assert law(lambda X: mixed, X, Grade.BROKEN).grade is Grade.BROKEN


def test_noise_at_pi_leaves_both_signs_right():
    R = exact.rounded(exact.exp(np.array([0, math.pi, 0])))
    w = Poekin.so3_log(R)
    for one in (w, -w):
        assert (
            of_groups.log_forgives_noise(lambda R, one=one: one, R, Grade.BROKEN).grade
            is Grade.EXACT
        )
    assert of_groups.log_forgives_noise(lambda R: w + 1e-9, R, Grade.BROKEN).grade is Grade.POOR


def test_the_blocks_of_an_adjoint_are_measured_each_by_itself():
    T = Poekin.exp(np.array([0.3, -0.2, 0.5, *V]))
    wrong = Poekin.adjoint(T)
    wrong[0, 2] += 3e-5
    wrong[0, 3] += 4e-5
    verdict = of_groups.adjoint_is_its_matrix(lambda T: wrong, T, Grade.BROKEN)
    assert verdict.what == "R"
    assert verdict.size == pytest.approx(4e-5, rel=1e-6)


def test_angles_are_in_rad_and_lengths_in_proportion():
    xi = np.array([0.3, 0, 0, 1e3, 0, 0])
    turned = Poekin.exp(xi + np.array([1e-8, 0, 0, 0, 0, 0]))
    assert of_groups.exp_is_e_to_the_xi(lambda xi: turned, xi, Grade.BROKEN).size == pytest.approx(
        1e-8, rel=1e-6
    )
    moved = Poekin.exp(xi)
    moved[0, 3] += 1e-4
    verdict = of_groups.exp_is_e_to_the_xi(lambda xi: moved, xi, Grade.BROKEN)
    assert (verdict.what, verdict.grade) == ("t ÷ |v|", Grade.POOR)
    assert verdict.size == pytest.approx(1e-7, rel=1e-6)


def test_the_last_row_of_a_pose_must_be_exact():
    T = Poekin.exp(np.zeros(6))
    T[3, 0] = 1e-300
    verdict = of_groups.exp_is_e_to_the_xi(lambda xi: T, np.zeros(6), Grade.BROKEN)
    assert (verdict.what, verdict.grade) == ("last row", Grade.GOOD)


def test_an_adjoint_is_judged_by_its_corner_too():
    T = Poekin.exp(np.array([0.3, 0, 0, 5.0, 0, 0]))
    wrong = Poekin.adjoint(T)
    wrong[5, 0] += 5e-8
    verdict = of_groups.adjoint_is_its_matrix(lambda T: wrong, T, Grade.BROKEN)
    assert (verdict.what, verdict.grade) == ("[t] R ÷ |t|", Grade.POOR)
    assert of_groups.adjoint_is_its_matrix(Poekin.adjoint, T, Grade.BROKEN).grade is Grade.EXACT
