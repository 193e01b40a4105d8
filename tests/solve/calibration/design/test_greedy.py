"""The greedy design: each configuration is the one that adds most to what those before it show."""

from __future__ import annotations

import numpy as np
import pytest

from poekin.solve.calibration.design.greedy import greedy, rows_before


def information(blocks: np.ndarray, rows: list[int], before: np.ndarray) -> np.ndarray:
    J = np.concatenate([blocks[rows].reshape(-1, blocks.shape[2]), before])
    return J.T @ J


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("measured", [0, 5])
def test_each_makes_the_determinant_largest_once_all_is_seen(seed, measured):
    rng = np.random.default_rng(seed)
    blocks = rng.normal(size=(12, 2, 3))
    before = rng.normal(size=(measured, 3))
    found = greedy(blocks, 8, given=before if measured else None)
    assert len(set(found)) == 8
    for k in range(0 if measured else 2, 8):
        left = [row for row in range(12) if row not in found[:k]]
        dets = [np.linalg.det(information(blocks, [*found[:k], row], before)) for row in left]
        assert found[k] == left[int(np.argmax(dets))]


def test_two_directions_seen_faintly_come_before_one_seen_well():
    blocks = np.zeros((4, 2, 2))
    blocks[0] = [[2.0, 0.0], [0.0, 0.0]]
    blocks[1] = [[0.0, 0.0], [0.0, 1.0]]
    blocks[2] = 0.01 * np.eye(2)
    assert greedy(blocks, 3) == [2, 0, 1]


def test_none_is_taken_twice_though_it_shows_most():
    blocks = np.array([[[3.0]], [[1.0]], [[2.0]]])
    assert greedy(blocks, 3) == [0, 2, 1]


def test_alike_candidates_are_taken_in_their_order_with_one_tick_each():
    ticks: list[int] = []
    assert greedy(np.ones((5, 1, 1)), 4, tick=lambda: ticks.append(1)) == [0, 1, 2, 3]
    assert len(ticks) == 4


def test_no_configuration_is_chosen_where_none_is_asked_for():
    assert greedy(np.ones((5, 1, 1)), 0) == []


def test_where_nothing_was_measured_before_there_are_no_rows_of_it():
    assert rows_before(None, 7).shape == (0, 7)
    given = np.ones((2, 7))
    assert rows_before(given, 7) is given
