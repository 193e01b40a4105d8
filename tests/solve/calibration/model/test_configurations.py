"""Repeated rows: their mean, at the mean of the readings, and its covariance."""

from __future__ import annotations

import re

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError, ShapeError
from poekin.solve.calibration import (
    Distances,
    EyeInHand,
    Points,
    Poses,
    average_repeats,
    read,
    write,
)
from poekin.solve.calibration.model.configurations import Folds, configurations

Q = np.array([[0.5, 0.1], [0.1, 0.2], [0.5, 0.1], [0.1, 0.9], [0.5004, 0.1], [0.1, 0.2]])
WHOSE = [[0, 2, 4], [1, 5], [3]]
RNG = np.random.default_rng(4)
ARM = pk.Chain.from_space(
    [pk.screw.revolute([0, 0, 1], [0, 0, 0]), pk.screw.revolute([0, 1, 0], [0.3, 0, 0.5])],
    np.eye(4),
)


def spd(n, count):  # type: ignore[no-untyped-def]
    A = RNG.normal(size=(count, n, n))
    return A @ np.swapaxes(A, 1, 2) + np.eye(n)


@pytest.mark.parametrize(("q", "labels"), [
    (Q, [0, 1, 0, 2, 0, 1]),
    ([[3.0], [1.0], [2.0], [1.0]], [0, 1, 2, 1]),
    ([[0.0], [0.9e-3]], [0, 0]),
    ([[0.0], [1.1e-3]], [0, 1]),
    ([[1.8e-3], [0.0], [0.9e-3]], [0, 0, 0]),  # a chain of near ones
    ([[0.0, 0.0], [0.9e-3, 1.0], [1.8e-3, 0.0]], [0, 1, 2]),  # a chain whose middle is elsewhere
    ([[0.0, 1.0], [0.0, 0.0], [1.0, 0.0], [1.0, 1.0]], [0, 1, 2, 3]),
    # twice and no more: a third time would part the first two, by what the second has shown
    (0.9e-3 * np.array([[0, 0], [2, 0], [1, 2], [4, 1], [3, 50]]), [0, 0, 1, 2, 3]),
    (np.zeros((1, 2)), [0]),
    (np.zeros((0, 2)), []),
])  # fmt: skip
def test_readings_are_of_one_configuration_where_no_gap_of_a_millimetre_parts_them(q, labels):
    np.testing.assert_array_equal(configurations(np.array(q, float)), labels)


def test_folds_are_of_whole_configurations_of_even_sizes_and_drawn_by_the_seed():
    label = np.array([0, 0, 1, 2, 1, 3, 4, 4, 5, 6])
    fold = Folds(3, 1).of(label)
    assert all(len(set(fold[label == k])) == 1 for k in range(7))
    of_each = [fold[label == k][0] for k in range(7)]
    assert sorted(np.bincount(of_each)) == [2, 2, 3]
    np.testing.assert_array_equal(Folds(3, 1).of(label), fold)
    assert any((Folds(3, seed).of(label) != fold).any() for seed in range(2, 5))


def test_lengths_and_readings_are_their_means_and_covariances_those_of_a_mean():
    C = spd(6, 6)
    p = RNG.normal(size=(6, 2, 3))
    points = Points(p, points=np.eye(3)[:2], covariance=C, frame="unknown")
    q, means = average_repeats(Q, points)
    assert isinstance(means, Points)
    np.testing.assert_allclose(q, [Q[rows].mean(axis=0) for rows in WHOSE], rtol=1e-15)
    np.testing.assert_allclose(means.p, [p[rows].mean(axis=0) for rows in WHOSE], atol=1e-15)
    expected = [C[rows].sum(axis=0) / len(rows) ** 2 for rows in WHOSE]
    np.testing.assert_allclose(means.covariance, expected, rtol=1e-14)
    assert means.rows is None
    assert means.unknown_frames == points.unknown_frames
    np.testing.assert_array_equal(means.points, points.points)


def test_distances_of_unknown_noise_stay_so_and_rows_may_say_which_readings():
    d = Distances(np.arange(1.0, 5), rows=[0, 2, 1, 3])
    q, means = average_repeats(Q, d)
    assert isinstance(means, Distances)
    np.testing.assert_array_equal(means.d, [1.5, 3, 4])
    assert means.covariance is None
    np.testing.assert_array_equal(q, Q[[0, 1, 3]])


def test_of_one_row_none_and_many_points_the_means_are_those_of_the_numbers():
    one = Points([[1.0, 2, 3]])
    _, means = average_repeats([[0.5, 0.1]], one)
    np.testing.assert_array_equal(means.measured, one.measured)
    q, means = average_repeats(np.zeros((0, 2)), Points(np.zeros((0, 3))))
    assert (q.shape, len(means)) == ((0, 2), 0)
    p = RNG.normal(size=(6, 5, 3))
    _, means = average_repeats(Q, Points(p, points=RNG.normal(size=(5, 3))))
    np.testing.assert_allclose(means.measured, [p[k].mean(axis=0) for k in WHOSE], atol=1e-15)


def test_a_mean_pose_has_the_rotation_between_two_and_stays_a_pose():
    way = np.array([0.01, -0.02, 0.03])
    T = np.tile(pk.se3.exp([0.3, 2.0, -1.0, 1, 2, 3]), (6, 1, 1))
    T[1, :3, :3] = T[1, :3, :3] @ pk.so3.exp(way)
    T[5, :3, :3] = T[5, :3, :3] @ pk.so3.exp(-way)
    T[5, :3, 3] += [0.1, 0, 0]
    for made in (Poses(T), EyeInHand(T, camera="wrist")):
        _, means = average_repeats(Q, made)
        assert type(means) is type(made)
        # the two turns cancel: what is left is rounding of some sums
        np.testing.assert_allclose(means.T[1, :3, :3], T[0, :3, :3], atol=1e-15)
        np.testing.assert_allclose(means.T[1, :3, 3], T[0, :3, 3] + [0.05, 0, 0], atol=1e-15)
        R = means.T[:, :3, :3]
        np.testing.assert_allclose(
            R @ np.swapaxes(R, 1, 2), np.tile(np.eye(3), (3, 1, 1)), atol=1e-15
        )


def test_a_file_s_repeated_rows_are_kept_unless_their_mean_is_asked_for(tmp_path):
    path = tmp_path / "a.csv"
    points = Points(RNG.normal(size=(6, 3)))
    write(path, ARM, Q, points)
    q, kept = read(path, ARM)
    np.testing.assert_array_equal(q, Q)
    assert len(kept) == 6
    q, means = read(path, ARM, repeats="average")
    mean_q, expected = average_repeats(Q, points)
    assert isinstance(means, Points)
    assert isinstance(expected, Points)
    np.testing.assert_array_equal(q, mean_q)
    np.testing.assert_array_equal(means.p, expected.p)
    said = "repeats: expected 'keep' or 'average', got 'mean'"
    with pytest.raises(InputError, match=f"^{re.escape(said)}$"):
        read(path, ARM, repeats="mean")  # type: ignore[arg-type]


def test_what_is_no_measurement_or_not_finite_has_no_mean():
    said = "measurements: expected Poses, Points, Distances, EyeInHand or EyeToHand, got [1, 2]"
    with pytest.raises(InputError, match=f"^{re.escape(said)}$"):
        average_repeats(Q, [1, 2])  # type: ignore[arg-type]
    with pytest.raises(InputError, match=r"^q\[0, 0\]: expected a finite number, got nan$"):
        average_repeats([[np.nan]], Distances([1.0]))
    for q, made in (
        (Q[0], Distances([1.0, 2.0])),
        (Q[:1], Distances([1.0, 2.0])),
        (Q, Distances([1.0], rows=[6])),
        (Q, Distances([1.0], rows=[9])),
        (Q[None], Distances([1.0])),
    ):
        said = f"q: expected readings (N, m) with a row for each of {len(made)} Distances, got shape {q.shape}"
        with pytest.raises(ShapeError, match=f"^{re.escape(said)}$"):
            average_repeats(q, made)


@pytest.mark.parametrize(
    ("made", "said"),
    [
        (Poses(np.tile(np.eye(4), (60, 1, 1))), "<Poses: 60 of 6 numbers each, noise unknown>"),
        (
            Points(np.ones((9, 2, 3)), points=np.eye(3)[:2], covariance=np.eye(6), frame="unknown"),
            "<Points: 9 of 6 numbers each, noise given, T_base_device unknown>",
        ),
        (
            Distances([1.0, 2.0], rows=[3, 1]),
            "<Distances: 2 of 1 numbers each, noise unknown, at rows of q, centre unknown>",
        ),
        (
            EyeInHand(np.eye(4)[None]),
            "<EyeInHand: 1 of 6 numbers each, noise unknown, T_base_board and T_tip_camera unknown>",
        ),
    ],
)
def test_a_set_of_measurements_is_one_line(made, said):
    assert repr(made) == str(made) == said


def test_means_of_conditions_come_with_those_of_the_measurements():
    q = np.zeros((4, 2))
    points = Points(np.arange(12.0).reshape(4, 3), rows=[3, 2, 1, 0])
    conditions = {"payload": [0.0, 5, 5.0005, 0], "time": np.array([1.0, 2, 4, 8])}
    mean_q, means, found = average_repeats(q, points, conditions)
    assert mean_q.shape == (2, 2)
    np.testing.assert_allclose(means.measured[:, 0], [[4.5, 5.5, 6.5], [4.5, 5.5, 6.5]])
    np.testing.assert_allclose(found["payload"], [0, 5.00025])
    np.testing.assert_allclose(found["time"], [4.5, 3])
    assert len(average_repeats(q, points)[0]) == 1
    assert average_repeats(q, points, {})[2] == {}


def test_means_of_conditions_are_of_the_rows_of_q_that_were_measured():
    q = np.array([[0.1], [0.5], [0.1], [0.9]])
    points = Points(np.arange(9.0).reshape(3, 3), rows=[2, 0, 3])
    mean_q, means, found = average_repeats(q, points, {"time": [1.0, 2, 4, 8]})
    assert mean_q.ravel().tolist() == pytest.approx([0.1, 0.9])
    np.testing.assert_allclose(means.measured[:, 0], [[1.5, 2.5, 3.5], [6, 7, 8]])
    np.testing.assert_allclose(found["time"], [2.5, 8])


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ([0.0, 1.0], r"^conditions\['payload'\]: expected a number for each of 4 rows of q, got shape \(2,\)$"),
        ([0.0] * 5, r"^conditions\['payload'\]: expected a number for each of 4 rows of q, got shape \(5,\)$"),
        ([0.0, np.nan, 1.0, 1.0], r"^conditions\['payload'\]"),
    ],
)  # fmt: skip
def test_a_condition_without_a_number_for_each_row_is_refused(values, message):
    with pytest.raises((ShapeError, InputError), match=message):
        average_repeats(np.zeros((4, 2)), Points(np.ones((4, 3))), {"payload": values})
