"""Extended precision against 60 digits: as good as it says, so that what it picks out is worth judging."""

from __future__ import annotations

import numpy as np
import pytest

from poekin.testing import exact, extended

ANGLES = [0.05, 0.7, 1.49, 1.51, 2.2, 3.1, np.pi - 1e-9, np.pi]
N = np.array([0.6, -0.64, 0.48])
V = np.array([0.3, 2.0, -1.1])
TWISTS = np.array([np.concatenate([angle * N, V]) for angle in ANGLES])
POSES = np.stack([exact.rounded(exact.exp(xi)) for xi in TWISTS])
# Sixteen roundings; 53 bits where a long double is a double.
CLOSE = 32 * float(np.finfo(np.longdouble).eps)


def error(result: np.ndarray, truth: list[np.ndarray]) -> float:
    expected = np.array([[np.longdouble(str(x)) for x in np.ravel(t)] for t in truth])
    return float(np.abs(result.reshape(len(truth), -1) - expected).max())


@pytest.mark.parametrize("name", ["exp", "left_jacobian", "left_jacobian_inverse"])
def test_functions_of_twists_are_right_to_a_few_roundings(name):
    assert error(getattr(extended, name)(TWISTS), [getattr(exact, name)(xi) for xi in TWISTS]) < CLOSE


def test_log_is_right_to_a_few_roundings():
    assert error(extended.log(POSES), [exact.log(T) for T in POSES]) < 4 * CLOSE


def test_far_twists_keep_their_digits():
    far = np.array([np.concatenate([angle * N, V]) for angle in (5.0, 7.0, 10.0)])
    for name in ("exp", "left_jacobian"):
        assert error(getattr(extended, name)(far), [getattr(exact, name)(xi) for xi in far]) < 4 * CLOSE


def test_shapes_are_those_of_the_batch():
    batch = np.broadcast_to(TWISTS[0], (3, 1, 2, 6))
    assert extended.exp(batch).shape == (3, 1, 2, 4, 4)
    assert extended.left_jacobian_inverse(batch).shape == (3, 1, 2, 6, 6)
    assert extended.log(extended.exp(batch)).shape == (3, 1, 2, 6)
