"""Separations: the table they come in, the order of those that are known, and their derivatives."""

from __future__ import annotations

import numpy as np
import pytest

from poekin.errors import InputError, ShapeError
from poekin.solve.calibration import Separations

NAN = np.nan
TABLE = np.array([[0, 0.2, NAN, 0.4], [0.2, 0, 0.3, NAN], [NAN, 0.3, 0, 0.5], [0.4, NAN, 0.5, 0]])
PAIRS = [(0, 1), (0, 3), (1, 2), (2, 3)]
EYE = np.tile(np.eye(4), (4, 1, 1))


@pytest.mark.parametrize("shape", [(), (4,), (2, 3), (3, 2), (2, 2, 2), (1, 1), (0, 0)])
def test_a_table_has_as_many_rows_as_columns_and_two_of_them_or_more(shape):
    with pytest.raises(ShapeError) as caught:
        Separations(np.full(shape, 0.1), "plate", 1.0)
    words = f"d: expected a table (k, k) of distances between points, got shape {shape}"
    assert str(caught.value) == words


def test_two_points_are_enough():
    found = Separations([[0, 0.3], [0.3, 0]], "plate", 1.0)
    assert len(found) == 1
    assert found.measured.tolist() == [0.3]


@pytest.mark.parametrize("scale", [1.0, 1e3])
@pytest.mark.parametrize(("off", "even"), [(0.8e-9, True), (1.2e-9, False), (-1.2e-9, False)])
def test_halves_of_a_table_may_differ_by_a_billionth_of_a_metre(scale, off, even):
    table = scale * TABLE
    table[3, 2] += off
    if even:
        np.testing.assert_array_equal(Separations(table, "plate", 1.0).measured[3], table[2, 3])
        return
    with pytest.raises(InputError, match=r"^d\[2, 3\] is \S+ and d\[3, 2\] \S+$"):
        Separations(table, "plate", 1.0)


def test_the_known_distances_are_in_the_order_of_the_rows_above_the_diagonal():
    found = Separations(TABLE, "plate", [1.0, 2.0, 3.0, 4.0])
    assert list(map(tuple, found.pairs.tolist())) == PAIRS
    assert found.measured.tolist() == [TABLE[pair] for pair in PAIRS]
    assert found.covariance[:, 0, 0].tolist() == [1, 2, 3, 4]
    assert found.rows.tolist() == [0, 0, 0, 0]
    assert [(f.name, f.size, f.shared) for f in found.unknown_frames] == [
        (f"point {k}", 3, "plate") for k in (1, 2, 3, 4)
    ]
    part = found.subset(np.array([3, 1]))
    assert isinstance(part, Separations)
    assert list(map(tuple, part.pairs.tolist())) == [PAIRS[3], PAIRS[1]]
    assert part.measured.tolist() == [0.5, 0.4]


@pytest.mark.parametrize("bad", [0.0, -0.2, np.inf])
def test_a_distance_is_above_nothing_and_finite(bad):
    table = TABLE.copy()
    table[1, 2] = table[2, 1] = bad
    with pytest.raises(InputError) as caught:
        Separations(table, "plate", 1.0)
    assert str(caught.value) == f"d[1, 2]: expected a distance above 0, got {bad:g}"


def test_errors_are_what_points_are_too_far_apart_and_move_with_the_points_alone():
    y = np.random.default_rng(0).normal(size=(4, 3))
    s = Separations(TABLE, "plate", 1.0)
    errors = s.errors(EYE, list(y))
    expected = [np.linalg.norm(y[i] - y[j]) - TABLE[i, j] for i, j in PAIRS]
    np.testing.assert_allclose(errors[:, 0], expected, rtol=0, atol=1e-15)
    of_arm, of_points = s.jacobian(EYE, list(y), errors, np.ones((4, 6, 7)))
    assert of_arm.shape == (4, 1, 7)
    assert not of_arm.any()
    assert [one.shape for one in of_points] == [(4, 1, 3)] * 4
    h = 1e-6
    for k in range(4):
        for axis in range(3):
            ends = []
            for sign in (1, -1):
                moved = y.copy()
                moved[k, axis] += sign * h
                ends.append(s.errors(EYE, list(moved))[:, 0])
            slope = (ends[0] - ends[1]) / (2 * h)
            # h^2 of third derivatives of some 1 / m^2, and rounding of 1e-16 m over h
            np.testing.assert_allclose(of_points[k][:, 0, axis], slope, rtol=0, atol=1e-9)


def test_points_at_one_place_have_no_direction_to_part_in():
    y = [np.zeros(3), np.zeros(3), np.ones(3), np.ones(3)]
    s = Separations(TABLE, "plate", 1.0)
    _, of_points = s.jacobian(EYE, y, s.errors(EYE, y), np.zeros((4, 6, 1)))
    assert not of_points[0][0].any()
    assert not of_points[3][3].any()
    np.testing.assert_allclose(np.linalg.norm(of_points[0][1, 0]), 1.0)


def test_points_that_another_set_shows_are_guessed_and_others_are_named():
    s = Separations(TABLE[:2, :2], "plate", 1.0)
    known = [frame._replace(guess=np.full(3, k)) for k, frame in enumerate(s.unknown_frames)]
    np.testing.assert_array_equal(s.with_unknown_frames(known).guesses(EYE), [[0] * 3, [1] * 3])
    with pytest.raises(InputError) as caught:
        s.with_unknown_frames([known[0], s.unknown_frames[1]]).guesses(EYE)
    assert str(caught.value) == "Separations: no Points with points='plate' measure point 2"
