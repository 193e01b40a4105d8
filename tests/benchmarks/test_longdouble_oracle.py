"""Extended precision against 60 digits: as good as it says, so that what it picks out is worth
judging.
"""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.accuracy import longdouble_oracle
from poekin.testing.oracles import exact

ANGLES = [0.05, 0.7, 1.49, 1.51, 2.2, 3.1, np.pi - 1e-9, np.pi]
N = np.array([0.6, -0.64, 0.48])
M = np.array([0.48, 0.6, 0.64])
V = np.array([0.3, 2.0, -1.1])
TWISTS = np.array([np.concatenate([angle * n, V]) for n in (N, M, -M) for angle in ANGLES])
POSES = np.stack([exact.rounded(exact.exp(xi)) for xi in TWISTS])
# Sixteen roundings; 53 bits where a long double is a double.
CLOSE = 32 * float(np.finfo(np.longdouble).eps)


def error(result: np.ndarray, truth: list[np.ndarray]) -> float:
    expected = np.array([[np.longdouble(str(x)) for x in np.ravel(t)] for t in truth])
    return float(np.abs(result.reshape(len(truth), -1) - expected).max())


@pytest.mark.parametrize("name", ["exp", "left_jacobian", "left_jacobian_inverse"])
def test_functions_of_twists_are_right_to_a_few_roundings(name):
    assert (
        error(getattr(longdouble_oracle, name)(TWISTS), [getattr(exact, name)(xi) for xi in TWISTS])
        < CLOSE
    )


def test_log_is_right_to_a_few_roundings():
    assert error(longdouble_oracle.log(POSES), [exact.log(T) for T in POSES]) < 4 * CLOSE


def test_log_is_that_of_the_rotation_next_to_a_noisy_one():
    noisy = POSES.copy()
    noisy[:, :3, :3] += 1e-2 * np.sin(np.arange(9.0)).reshape(3, 3)
    assert error(longdouble_oracle.log(noisy), [exact.log(T) for T in noisy]) < 4 * CLOSE


def test_log_of_a_half_turn_about_an_axis_of_the_frame_is_that_axis():
    T = np.diag([-1.0, 1.0, -1.0, 1.0])
    T[:3, 3] = [0, 2.0, 0]
    pi = np.longdouble(str(exact.mp.pi))
    assert np.abs(longdouble_oracle.log(T) - [0, pi, 0, 0, 2, 0]).max() < CLOSE


def test_far_twists_keep_their_digits():
    far = np.array([np.concatenate([angle * N, V]) for angle in (5.0, 7.0, 10.0)])
    for name in ("exp", "left_jacobian"):
        assert (
            error(getattr(longdouble_oracle, name)(far), [getattr(exact, name)(xi) for xi in far])
            < 4 * CLOSE
        )


def test_a_batch_is_made_of_single_cases():
    batch = TWISTS[:6].reshape(3, 1, 2, 6)
    for name, of, tail in (
        ("exp", batch, (4, 4)),
        ("left_jacobian", batch, (6, 6)),
        ("left_jacobian_inverse", batch, (6, 6)),
        ("log", POSES[:6].reshape(3, 1, 2, 4, 4), (6,)),
    ):
        function = getattr(longdouble_oracle, name)
        found = function(of)
        assert found.shape == (3, 1, 2, *tail)
        for index in np.ndindex(3, 1, 2):
            assert np.abs(found[index] - function(of[index])).max() < CLOSE
