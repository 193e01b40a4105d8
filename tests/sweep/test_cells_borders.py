"""Boxes of as many cells as there may be, and frames whose z axis points straight back."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from poekin.errors import InputError
from poekin.sweep import Cells
from poekin.sweep.cells import _tilts, cells_from
from tests.messages import says


@pytest.mark.parametrize(
    "upper, side, tiles",
    [([2**14, 2**13, 2**13], 0, 1), ([2**13, 2**13, 2**10], 1, 12), ([2**12, 2**12, 2**9], 4, 192)],
)
def test_a_box_has_at_most_2_to_the_40_cells(upper, side, tiles):
    cubes = 2**40 // tiles
    x, y, _ = upper
    most = Cells.box([0, 0, 0], [x, y, cubes // (x * y)], 1.0, side=side)
    assert 2**40 - 2**27 * tiles < most.count <= 2**40
    assert most.tiles == tiles
    with pytest.raises(InputError, match=r"at most 2\^40 cells"):
        Cells.box([0, 0, 0], [x, y, cubes // (x * y) + 1], 1.0, side=side)


def test_a_z_axis_is_turned_the_shortest_way_and_straight_back_about_x():
    rng = np.random.default_rng(0)
    z = np.concatenate([np.eye(3), -np.eye(3), rng.normal(size=(20, 3))])
    z /= np.linalg.norm(z, axis=1, keepdims=True)
    R = _tilts(z)
    # each entry is of a few roundings of numbers up to 1, divided by 1 + z of 0.01 at least
    assert (z[6:, 2] > -0.99).all()
    np.testing.assert_allclose(R @ R.swapaxes(1, 2), np.tile(np.eye(3), (26, 1, 1)), atol=1e-13)
    np.testing.assert_allclose(np.linalg.det(R), 1.0, atol=1e-13)
    np.testing.assert_array_equal(R[:, :, 2], z)
    np.testing.assert_array_equal(R[5], np.diag([1.0, -1.0, -1.0]))
    # the shortest way is about an axis across z: the trace is 1 + 2 cos of the angle between them
    np.testing.assert_allclose(np.trace(R, axis1=1, axis2=2), 1.0 + 2.0 * z[:, 2], atol=1e-13)


def test_a_box_narrower_than_a_rounding_has_a_cube():
    size = 0.6640625000000048  # three times as much lies between two floats, which both are 3 of it
    below, above = 1.9921875000000142, 1.9921875000000144
    assert np.nextafter(below, 2.0) == above
    assert below < 3 * Fraction(size) < above
    assert below / size == above / size == 3
    assert Cells.box([0, 0, below], [1, 2 * size, above], size).shape == (2, 2, 1)


def test_a_box_that_has_too_many_cells_says_how_many_along_each_axis():
    with pytest.raises(InputError) as caught:
        Cells.box([0, 0, 0], [2**17, 2**16, 2**15], 1.0, side=2)
    words = (
        "resolution: expected at most 2^40 cells, got 1.35e+16, 131072 x 65536 x 32768 cubes of 48"
    )
    assert says(caught.value, words)


def test_poses_are_turned_once_where_nobody_says_how_often():
    cells = Cells((0.0, 0.0, 0.0), 2.0, (2, 1, 1))
    assert cells.rotations().tolist() == [[np.eye(3).tolist()]]
    T = cells.poses()
    assert T.shape == (2, 1, 1, 1, 1, 4, 4)
    assert T[1, 0, 0, 0, 0].tolist() == [[1, 0, 0, 3], [0, 1, 0, 1], [0, 0, 1, 1], [0, 0, 0, 1]]
    assert cells.upper == (4.0, 2.0, 2.0)
    assert Cells.box([0] * 3, [1] * 3, 1.0).side == 0
    assert cells_from(cells.describe()) == cells
