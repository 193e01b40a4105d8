"""Rows of numbers are poses by their format; what is none is refused, however large the numbers
are.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import poekin as pk
from poekin.errors import InputError, PoseError
from poekin.formats.poses import pose_rows
from poekin.formats.poses.layout import NAMED, ORDERS, layout


@pytest.mark.parametrize("size", [1e-200, 1e154, 1e308, np.finfo(float).max], ids=str)
@pytest.mark.parametrize("order", ORDERS)
def test_a_quaternion_whose_square_is_no_number_is_refused(size, order):
    rows = np.array([[0, 0, 0, 1, 0, 0, 0], [0, 0, 0, size, 0, 0, size]], float)
    with pytest.raises(
        PoseError, match=r"row 1: the quaternion's length is .*, expected 1 within 0\.001"
    ):
        pose_rows.to_poses(rows, layout("7", order), lambda i: f"row {i}")


@pytest.mark.parametrize("order", ORDERS)
def test_a_row_that_is_not_finite_gives_nan(order):
    rows = np.array([[0, 0, 0, 1e308, np.inf, 0, 0], [0, 0, np.nan, 1, 0, 0, 0]], float)
    assert np.isnan(pose_rows.to_poses(rows, layout("7", order), str)).all()


COLUMNS = {
    ("12", None): "T00 T01 T02 T03 T10 T11 T12 T13 T20 T21 T22 T23",
    ("16", None): "T00 T01 T02 T03 T10 T11 T12 T13 T20 T21 T22 T23 T30 T31 T32 T33",
    ("7", "wxyz"): "x y z qw qx qy qz",
    ("7", "xyzw"): "x y z qx qy qz qw",
}


@pytest.mark.parametrize("form", COLUMNS, ids=str)
def test_the_columns_of_a_format_are_in_the_order_of_its_numbers(form):
    assert " ".join(layout(*form).columns) == COLUMNS[form]
    T = pk.se3.exp(np.random.default_rng(0).uniform(-1, 1, (20, 6)) * [3, 1, 1, 1, 2, 3])
    Q = Rotation.from_matrix(T[:, :3, :3]).as_quat()  # x y z w
    Q *= np.sign(Q[:, 3:])
    there = {f"T{i}{j}": T[:, i, j] for i in range(4) for j in range(4)}
    there |= dict(zip("xyz", T[:, :3, 3].T, strict=True)) | dict(
        zip(("qx", "qy", "qz", "qw"), Q.T, strict=True)
    )
    rows = np.column_stack([there[name] for name in COLUMNS[form].split()])
    # SciPy and poekin each round some ten times on the way between R and a quaternion, by 2^-53 of
    # numbers below 4
    np.testing.assert_allclose(pose_rows.to_rows(T, layout(*form)), rows, rtol=0, atol=4e-15)
    np.testing.assert_allclose(pose_rows.to_poses(rows, layout(*form), str), T, rtol=0, atol=4e-15)


REFUSED = {
    "format": (lambda: layout("9"), f"format: expected one of {NAMED}; got '9'"),
    "no text": (lambda: layout(12), f"format: expected one of {NAMED}; got 12"),
    "no quaternion": (lambda: layout("16", "wxyz"),
                      "quaternion: the format 16 does not take an order; expected with quat only"),
    "no order": (lambda: layout("7"),
                 "quaternion: the format 7 needs the order of its quaternion, wxyz or xyzw; none was given"),
    "another order": (lambda: layout("7", "zyxw"),
                      "quaternion: the format 7 needs the order of its quaternion, wxyz or xyzw; got 'zyxw'"),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_a_format_that_is_none_is_refused_with_those_that_are(case):
    call, message = REFUSED[case]
    with pytest.raises(InputError) as caught:
        call()
    assert str(caught.value) == message


@pytest.mark.parametrize("off", [-9e-4, 9e-4, -1.1e-3, 1.1e-3])
def test_a_quaternion_is_divided_by_its_length_which_is_one_within_a_thousandth(off):
    row = np.array([[1, 2, 3, 1 + off, 0, 0, 0]])
    if abs(off) < 1e-3:
        np.testing.assert_array_equal(
            pose_rows.to_poses(row, layout("7", "wxyz"), str)[0, :3], np.c_[np.eye(3), [1, 2, 3]]
        )
        return
    with pytest.raises(
        PoseError, match=rf"^4: the quaternion's length is {1 + off:.6g}, expected 1 within 0\.001$"
    ):
        pose_rows.to_poses(row, layout("7", "wxyz"), lambda i: f"{i + 4}")


def test_of_several_matrices_the_first_that_is_no_pose_is_named():
    rows = np.tile([1.0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0], (4, 1))
    rows[0, 3], rows[2, 0], rows[3, 0] = np.nan, 1.1, 1.2
    with pytest.raises(
        PoseError,
        match=(
            r"^row 2: its rotation misses orthonormality, max abs\(R R\^T - I\) = 0\.21, accepted up "
            r"to 1e-05$"
        ),
    ):
        pose_rows.to_poses(rows, layout("12"), lambda i: f"row {i}")
    good = pose_rows.to_poses(rows[:2], layout("12"), str)
    assert np.isnan(good[0]).all()
    np.testing.assert_array_equal(good[1], np.eye(4))
