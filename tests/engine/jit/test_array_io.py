"""Numbers of matrices, each at its place."""

from __future__ import annotations

import numpy as np

from poekin.engine.jit import array_io

NUMBERS = np.arange(16.0).reshape(4, 4) + 100
ROTATION = (100, 101, 102, 104, 105, 106, 108, 109, 110)
PLACE = (103, 107, 111)


def test_a_rotation_is_read_row_by_row_and_a_pose_has_its_place_behind_it():
    assert array_io.load_rotation(NUMBERS) == ROTATION
    assert array_io.load_rotation(NUMBERS[:3, :3]) == ROTATION
    assert array_io.load_matrix(NUMBERS) == (*ROTATION, *PLACE)


def test_a_rotation_is_written_into_the_corner_and_a_pose_with_its_last_row():
    M = np.full((5, 5), 77.0)
    array_io.store_rotation(M, (*ROTATION, 1, 2, 3))
    assert M[:3, :3].tolist() == NUMBERS[:3, :3].tolist()
    assert (M[3:] == 77).all()
    assert (M[:, 3:] == 77).all()
    array_io.store_matrix(M, (*ROTATION, *PLACE))
    assert M[:3, :4].tolist() == NUMBERS[:3].tolist()
    assert M[3, :4].tolist() == [0, 0, 0, 1]
    assert (M[4] == 77).all()
    assert (M[:, 4] == 77).all()


def test_an_array_without_a_count_of_references_is_the_array_where_nothing_is_compiled():
    assert array_io.without_refcount(NUMBERS) is NUMBERS
