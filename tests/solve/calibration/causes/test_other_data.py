"""Measurements taken otherwise: the rows, orders and frames that the words say."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from poekin.groups import se3, so3
from poekin.solve.calibration import Distances, EyeInHand, Points, Poses, Separations
from poekin.solve.calibration.causes.other_data import other_frames, other_numbers, other_rows

RNG = np.random.default_rng(0)
T = se3.exp(RNG.normal(size=(4, 6)))
Q = np.arange(4.0)[:, None]


def test_measurements_are_some_rows_further_on_and_in_reverse_order():
    s = Distances([10.0, 11, 12, 13])
    found = {other.words: other for other in other_rows(Q, [s])}
    expected = {
        "each measurement +1 rows of q further on": ([10, 11, 12], [1, 2, 3]),
        "each measurement -1 rows of q further on": ([11, 12, 13], [0, 1, 2]),
        "each measurement +2 rows of q further on": ([10, 11], [2, 3]),
        "each measurement -2 rows of q further on": ([12, 13], [0, 1]),
        "the rows of q in reverse order": ([10, 11, 12, 13], [3, 2, 1, 0]),
    }
    assert list(found) == list(expected)
    for words, (d, rows) in expected.items():
        other = found[words]
        (moved,) = other.sets
        np.testing.assert_array_equal(moved.measured.ravel(), d)
        assert moved.rows is not None
        assert moved.rows.tolist() == rows
        assert other.handicap == 1.0
        np.testing.assert_array_equal(other.q, Q)


def test_a_set_of_which_nothing_would_be_left_is_not_moved_and_separations_never_are():
    plate = Separations([[0, 1.0], [1.0, 0]], "plate", 1e-6)
    found = list(other_rows(Q, [plate, Distances([1.0], rows=[3])]))
    assert [o.words for o in found] == [
        "each measurement -1 rows of q further on",
        "each measurement -2 rows of q further on",
        "the rows of q in reverse order",
    ]
    assert found[0].sets[0] is plate
    assert len(found[0].sets) == 2


@pytest.mark.parametrize("count", [1, 2, 4, 5])
def test_all_orders_of_up_to_four_points_are_tried_and_exchanges_of_more(count):
    p = RNG.normal(size=(3, count, 3))
    found = dict(other_numbers(Points(p, RNG.normal(size=(count, 3)))))
    orders = list(itertools.permutations(range(count)))[1:]
    if count > 4:
        orders = [o for o in orders if sum(a != b for a, b in enumerate(o)) == 2]
    assert len(found) == len(orders)
    for order in orders:
        words = "the points in the order " + ", ".join(str(i + 1) for i in order)
        np.testing.assert_array_equal(found[words].measured.reshape(p.shape), p[:, order])


def quaternion(axis, angle):
    """w x y z, by its definition."""
    return np.array([np.cos(angle / 2), *(np.sin(angle / 2) * np.asarray(axis))])


@pytest.mark.parametrize("kind", [Poses, EyeInHand])
def test_poses_are_inverted_and_their_quaternions_taken_in_another_order(kind):
    axis, angle = np.array([2.0, -1, 2]) / 3, 1.1
    one = se3.pose(so3.exp(angle * axis), [1.0, 2, 3])
    found = dict(other_numbers(kind(one[None])))
    inverse, first, last = (s.measured[0] for s in found.values())
    np.testing.assert_allclose(inverse, np.linalg.inv(one), atol=1e-14)
    assert list(found)[1:] == [
        "quaternions in the order x y z w", "quaternions in the order w x y z"
    ]  # fmt: skip
    w, x, y, z = quaternion(axis, angle)
    for T_, (a, *v) in ((first, (z, w, x, y)), (last, (x, y, z, w))):
        v = np.array(v)
        K = np.cross(np.eye(3), v)
        # of a unit quaternion (a, v): R = 1 + 2 a [v] + 2 [v]^2
        np.testing.assert_allclose(T_[:3, :3], np.eye(3) + 2 * a * K + 2 * K @ K, atol=1e-13)
        np.testing.assert_array_equal(T_[:3, 3], [1, 2, 3])


def test_another_base_tool_device_or_point_is_the_one_that_moved_the_data():
    X, Z = se3.exp([0.1, -0.2, 0.3, 0.05, -0.1, 0.2]), se3.exp([0.2, 0.1, 0.0, 0.1, 0.0, 0.1])
    base = dict(other_frames(Poses(X @ T), T))
    tool = dict(other_frames(Poses(T @ Z), T))
    (of_base, moved), _ = base.items()
    np.testing.assert_allclose(moved.measured, T, atol=1e-13)
    assert of_base.startswith("the base moved by ")
    _, (of_tool, moved) = tool.items()
    np.testing.assert_allclose(moved.measured, T, atol=1e-13)
    assert of_tool.startswith("the tool moved by ")
    assert of_tool.endswith(": another tip, or a tool that is to be put on (retooled)")
    point = np.array([[0.1, 0.2, 0.3]])
    seen = np.einsum("nij,kj->nki", T[:, :3, :3], point) + T[:, None, :3, 3]
    device = dict(other_frames(Points(seen @ X[:3, :3].T + X[:3, 3], point), T))
    words, moved = next(iter(device.items()))
    assert words.startswith("frame='unknown', a device moved by ")
    np.testing.assert_allclose(moved.measured.reshape(-1, 3), seen[:, 0], atol=1e-13)
    other = dict(other_frames(Points(seen, [[0.0, 0.0, 0.0]]), T))
    np.testing.assert_allclose(other["points=(0.1, 0.2, 0.3) m"].points, point, atol=1e-14)  # type: ignore[attr-defined]
    ((words, away),) = other_frames(Distances([1.0, 2, 3, 4], [0.0, 0, 0]), T)
    assert words == "the centre not known: centre=None"
    assert len(away.unknown_frames) == 1
    assert list(other_frames(away, T)) == []


def test_another_base_is_that_of_the_rows_of_q_that_a_set_names():
    X, rows = se3.exp([0.1, -0.2, 0.3, 0.05, -0.1, 0.2]), [2, 0, 3]
    (_, moved), _ = other_frames(Poses(X @ T[rows], rows=rows), T)
    np.testing.assert_allclose(moved.measured, T[rows], atol=1e-13)
