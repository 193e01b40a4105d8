"""The laws of accuracy refuse what is wrong by just more than their bars, and let pass what is
wrong by less.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from poekin.testing.accuracy import accuracy_laws
from poekin.testing.accuracy.accuracy_laws import ACCURACY_LAWS
from poekin.testing.accuracy.error_bounds import BOTH_SIGNS, UNIT
from poekin.testing.laws.group import Group
from poekin.testing.laws.laws import LawViolation
from poekin.testing.oracles import exact

N = np.array([2.0, 3.0, -6.0]) / 7
XI = np.concatenate([0.7 * N, [2.0, 3.0, 6.0]])  # |v| = 7
JACOBIANS = ["left_jacobian", "right_jacobian", "left_jacobian_inverse", "right_jacobian_inverse"]
LAWS = {law.name: law.check for law in ACCURACY_LAWS}


def keeps(law: str, group: Group, argument: np.ndarray) -> bool:
    try:
        return 0 <= LAWS[law](group, argument) <= 1
    except LawViolation:
        return False


def element(w: Any, size: int) -> np.ndarray:
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = exact.rounded(exact.exp(w)), [1.0, -2.0, 0.5]
    return T[: 4 if size == 6 else 3, : 4 if size == 6 else 3]


def test_the_bars_are_those_that_are_stated():
    bars = accuracy_laws.EXP_LOG_BAR, accuracy_laws.JACOBIAN_BAR, accuracy_laws.NOISE_BAR
    assert bars == (3, 1e-15, 2e-15)


@pytest.mark.parametrize("size", [3, 6])
@pytest.mark.parametrize("k", range(3))
def test_of_the_smallest_rotations_the_logarithm_is_some_rotation_and_finite(k, size):
    tiny = 1e-160 * np.eye(3)[k]
    right = np.concatenate([tiny, [1.0, -2.0, 0.5]])[:size]
    for value, wanted in (
        (1e-160, True),
        (-3e-200, True),
        (0.0, False),
        (math.nan, False),
        (math.inf, False),
    ):
        found = right.copy()
        found[k] = value
        assert (
            keeps("log_is_attained", Group(size, log=lambda X, w=found: w), element(tiny, size))
            == wanted
        )
    # of a rotation so small only this is asked
    assert LAWS["log_is_attained"](Group(size, log=lambda X: right), element(tiny, size)) == 0
    nothing = np.zeros(size)
    nothing[3:] = 1.0
    assert not keeps("log_is_attained", Group(size, log=lambda X: nothing), element(tiny, size))
    if size == 6:
        infinite = right.copy()
        infinite[5] = math.inf
        assert not keeps("log_is_attained", Group(6, log=lambda X: infinite), element(tiny, 6))


@pytest.mark.parametrize("size", [3, 6])
@pytest.mark.parametrize("angle", [0.0, 1.5e-150, 0.7])
def test_from_1e_150_on_and_at_the_identity_every_digit_counts(angle, size):
    X = element(angle * N, size)
    right = exact.rounded(exact.log(X))
    assert keeps("log_is_attained", Group(size, log=lambda X: right), X)
    wrong = right.copy()
    wrong[:3] = 1.1 * right[:3] if angle else 1e-300
    assert not keeps("log_is_attained", Group(size, log=lambda X: wrong), X)


@pytest.mark.parametrize("size", [3, 6])
@pytest.mark.parametrize(("gap", "either"), [(BOTH_SIGNS / 2, True), (1e-10, False), (2.0, False)])
def test_either_sign_is_right_within_8_u_of_pi_and_noise_is_forgiven(gap, either, size):
    n = np.array([0.6, 0, 0.8])
    X = element(exact.exactly(n) * (exact.mp.pi - exact.mp.mpf(gap)), size)
    X[:3, :3] += (
        1e-9 * X[:3, :3] @ np.array([[1.0, 2, 3], [2, -1, 0], [3, 0, 2]])
    )  # a stretch before the rotation
    w = exact.rounded(exact.log(X[:3, :3]))
    tail = np.full(size - 3, math.nan)
    for sign in (1, -1):
        for off, wanted in ((0.0, True), (1.4e-15, True), (2.6e-15, False)):
            found = np.concatenate([sign * w + off * np.array([0.8, 0, -0.6]), tail])
            kept = keeps("log_forgives_noise", Group(size, log=lambda X, w=found: w), X)
            assert kept == (wanted and (either or sign == 1))


@pytest.mark.parametrize("name", JACOBIANS)
@pytest.mark.parametrize("size", [3, 6])
def test_a_jacobian_may_be_off_by_its_bar_in_each_block_and_times_v_in_q(name, size):
    xi = XI[:size]
    truth = exact.rounded(getattr(exact, name)(xi))
    for i, j in np.ndindex(size, size):
        bar = 7e-15 if i >= 3 > j else 1e-15
        for factor in (0.5, 1.5):
            J = truth.copy()
            J[i, j] += math.copysign(factor * bar, J[i, j])
            assert keeps(f"{name}_is_attained", Group(size, **{name: lambda xi, J=J: J}), xi) == (
                factor < 1
            ), (i, j)


def test_without_a_translation_q_is_nothing():
    xi = np.concatenate([0.7 * N, np.zeros(3)])
    J = exact.rounded(exact.left_jacobian(xi))
    assert keeps("left_jacobian_is_attained", Group(6, left_jacobian=lambda xi: J), xi)
    J[4, 1] = 5 * UNIT**3
    assert not keeps("left_jacobian_is_attained", Group(6, left_jacobian=lambda xi: J), xi)
