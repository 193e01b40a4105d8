"""Numbers of poses and poses of numbers: there and back in every format, units, batches, refusals."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest
from hypothesis import given

import poekin as pk
from poekin.errors import InputError, PoseError, ShapeError
from poekin.formats.poses.layout import FORMATS, NAMED, OF_CONTROLLERS, layout
from poekin.groups import euler
from poekin.testing.strategies.group_strategies import rotations

UNIT = 2.0**-53
UNTYPED: Any = pk.poses
FORMS = [(f, q) for f in FORMATS for q in (("wxyz", "xyzw") if f in ("quat", "7") else (None,))]


def there_and_back(T, form, **units):
    format, order = form
    numbers = pk.poses.to_numbers(T, format, quaternion=order, **units)
    return pk.poses.from_numbers(numbers, format, quaternion=order, **units)


def random_poses(count=2000):
    rng = np.random.default_rng(5)
    xi = rng.normal(size=(count, 6)) * 10.0 ** rng.uniform(-9, 0.5, (count, 1))
    T = pk.se3.exp(xi)
    T[:, :3, 3] = rng.normal(size=(count, 3))
    return T


def locked_poses():
    """Poses in the lock of either kind and at distances from it, and half turns about many axes."""
    outer = [-180.0, -90.0, 0.0, 12.0, 90.0, 177.0]
    off = [0.0, 1e-13, 1e-10, 1e-7, 1e-5, 1e-3]
    middle = [m + s * d for m in (-90, 0, 90, 180) for s in (-1, 1) for d in off]
    angles = np.array(list(itertools.product(outer, middle, outer)))
    R = np.concatenate([euler.rotations(angles, s, degrees=True) for s in ("zyx", "zyz")])
    return pk.se3.pose(R, np.tile([0.3, -0.2, 0.7], (len(R), 1)))


@pytest.mark.parametrize("form", FORMS, ids=str)
@pytest.mark.parametrize("poses", [random_poses, locked_poses])
def test_there_and_back_a_pose_keeps_its_digits_in_every_format(form, poses):
    # Matrices whose entries are right to a few u. Angles: 8 u of the rotation at most, in degrees
    # 12 u (tests/groups/test_euler.py), rotation vectors and quaternions less, and some 6 u to make
    # R again; they never add up so. Lengths: two roundings, of mm.
    T = poses()
    back = there_and_back(T, form)
    assert np.abs(back[:, :3, :3] - T[:, :3, :3]).max() <= 1e-15
    np.testing.assert_allclose(back[:, :3, 3], T[:, :3, 3], rtol=2 * UNIT, atol=0)


@given(rotations())
def test_there_and_back_any_rotation_keeps_its_digits(R):
    T = pk.se3.pose(R, [0.1, 0.2, 0.3])
    defect = np.abs(R @ R.T - np.eye(3)).max()
    for form in FORMS:
        assert np.abs(there_and_back(T, form) - T).max() <= 1e-15 + defect


FREE = [form for form in FORMS if form[0] not in OF_CONTROLLERS]


@pytest.mark.parametrize("form", FREE, ids=str)
@pytest.mark.parametrize("units", list(itertools.product((False, True), repeat=2)))
def test_units_change_the_numbers_and_not_the_pose(form, units):
    T = random_poses(50)
    mm, deg = units
    back = there_and_back(T, form, mm=mm, deg=deg)
    np.testing.assert_allclose(back, T, rtol=0, atol=2e-15)
    chosen = layout(*form, mm=mm, deg=deg)
    base = layout(*form, mm=False, deg=False)
    factors = [{"mm": 1000.0, "deg": 180 / np.pi}.get(unit, 1.0) for unit in chosen.units]
    numbers = pk.poses.to_numbers(T, *form[:1], quaternion=form[1], mm=mm, deg=deg)
    plain = pk.poses.to_numbers(T, *form[:1], quaternion=form[1], mm=False, deg=False)
    np.testing.assert_allclose(numbers, plain * factors, rtol=1e-14, atol=2e-13)
    assert base.columns == chosen.columns


@pytest.mark.parametrize("format", ["abc", "kuka", "wpr", "abb", "staubli", "kawasaki"])
def test_a_unit_that_the_format_has_anyway_changes_nothing(format):
    T = random_poses(3)
    np.testing.assert_array_equal(
        pk.poses.to_numbers(T, format, mm=True, deg=True), pk.poses.to_numbers(T, format)
    )


WRONG_UNITS = {
    "ur": ({"deg": True}, "ur is in m and rad, deg was said; the format rotvec takes other units"),
    "kuka": ({"mm": False}, "kuka is in mm and deg, m was said; the format abc takes other units"),
    "fanuc": ({"deg": False}, "fanuc is in mm and deg, rad was said; the format wpr takes other units"),
    "yaskawa": ({"deg": False}, "yaskawa is in mm and deg, rad was said; the format wpr takes other units"),
    "mitsubishi": ({"mm": False}, "mitsubishi is in mm and deg, m was said; the format wpr takes other units"),
    "kawasaki": ({"mm": False}, "kawasaki is in mm and deg, m was said; the format zyz takes other units"),
    "doosan": ({"deg": False}, "doosan is in mm and deg, rad was said; the format zyz takes other units"),
    "abb": ({"mm": False}, "abb is in mm, m was said; the format quat takes other units"),
    "ros": ({"mm": True}, "ros is in m, mm was said; the format quat takes other units"),
    "staubli": ({"deg": False}, "staubli is in mm and deg, rad was said"),
}  # fmt: skip


@pytest.mark.parametrize("format", WRONG_UNITS)
def test_a_controllers_format_has_no_units_but_its_own(format):
    units, message = WRONG_UNITS[format]
    assert set(WRONG_UNITS) == set(OF_CONTROLLERS)
    for call in (
        lambda: UNTYPED.to_numbers(np.eye(4), format, **units),
        lambda: UNTYPED.read("1 2 3 0 0 0 1", format, **units),
        lambda: UNTYPED.write(np.eye(4), format, **units),
    ):
        with pytest.raises(InputError) as caught:
            call()
        assert str(caught.value) == f"format: {message}"


def test_degrees_say_nothing_of_quaternions():
    T = random_poses(3)
    np.testing.assert_array_equal(
        pk.poses.to_numbers(T, "ros", deg=True, mm=False), pk.poses.to_numbers(T, "ros")
    )


def test_radians_in_a_format_of_degrees_are_said():
    # KUKA's iiwa gives A, B, C in rad
    numbers = [500, 0, 300, np.pi / 2, 0, np.pi]
    T = pk.poses.from_numbers(numbers, "abc", deg=False)
    np.testing.assert_allclose(
        T, pk.poses.from_numbers([500, 0, 300, 90, 0, 180], "abc"), rtol=0, atol=2 * UNIT
    )


@pytest.mark.parametrize("shape", [(), (0,), (1,), (3, 1, 2)])
@pytest.mark.parametrize("form", FORMS, ids=str)
def test_leading_axes_are_a_batch(form, shape):
    T = pk.se3.exp(np.random.default_rng(2).uniform(-1, 1, (*shape, 6)))
    numbers = pk.poses.to_numbers(T, form[0], quaternion=form[1])
    columns = layout(*form).columns
    assert numbers.shape == (*shape, len(columns))
    back = pk.poses.from_numbers(numbers, form[0], quaternion=form[1])
    assert back.shape == T.shape
    for index in np.ndindex(shape):
        np.testing.assert_array_equal(
            pk.poses.to_numbers(T[index], form[0], quaternion=form[1]), numbers[index]
        )


@pytest.mark.parametrize("form", FORMS, ids=str)
def test_no_zero_has_a_sign_and_what_is_not_finite_is_nan(form):
    half_turn = np.diag([-1.0, -1.0, 1.0, 1.0])
    half_turn[:3, 3] = -0.0
    numbers = pk.poses.to_numbers(half_turn, form[0], quaternion=form[1])
    assert not np.signbit(numbers[numbers == 0]).any()
    numbers[0] = np.nan
    assert np.isnan(pk.poses.from_numbers(numbers, form[0], quaternion=form[1])).all()


def test_twelve_numbers_are_three_rows_of_the_matrix():
    T = random_poses(4)
    np.testing.assert_array_equal(pk.poses.from_numbers(T[:, :3].reshape(4, 12), "matrix"), T)
    assert pk.poses.to_numbers(T, "matrix").shape == (4, 16)


def test_a_fourth_row_is_not_in_millimetres():
    T = random_poses(2)
    numbers = pk.poses.to_numbers(T, "matrix", mm=True)
    np.testing.assert_array_equal(numbers[:, 12:], [[0, 0, 0, 1]] * 2)
    np.testing.assert_array_equal(numbers[:, [3, 7, 11]], 1000 * T[:, :3, 3])


REFUSED = {
    "format": (lambda: UNTYPED.from_numbers([0] * 6, "acb"), InputError,
               f"format: expected one of {NAMED}; got 'acb'"),
    "no text": (lambda: UNTYPED.to_numbers(np.eye(4), 6), InputError,
                f"format: expected one of {NAMED}; got 6"),
    "count": (lambda: pk.poses.from_numbers([0] * 7, "abc"), ShapeError,
              "numbers: expected shape (..., 6) of X Y Z A B C, got (7,)"),
    "scalar": (lambda: pk.poses.from_numbers(1.0, "abc"), ShapeError,
               "numbers: expected shape (..., 6) of X Y Z A B C, got ()"),
    "no order": (lambda: pk.poses.from_numbers([0] * 7, "quat"), InputError,
                 "quaternion: the format quat needs the order of its quaternion, wxyz or xyzw; none was given"),
    "order": (lambda: pk.poses.from_numbers([0] * 7, "abb", quaternion="xyzw"), InputError,
              "quaternion: the format abb does not take an order; expected with quat only"),
    "no numbers": (lambda: pk.poses.from_numbers(["a"] * 6, "abc"), InputError,
                   "numbers: expected real numbers, got text (list)"),
    "long": (lambda: pk.poses.from_numbers([[[0, 0, 0, 1, 0, 0, 0], [0, 0, 0, 1, 1, 0, 0]]], "abb"), PoseError,
             "numbers[0, 1]: the quaternion's length is 1.41421, expected 1 within 0.001"),
    "no pose": (lambda: pk.poses.to_numbers(np.ones((4, 4)), "abc"), PoseError, "T is no pose: "),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_what_is_refused_is_said_with_what_was_expected_and_what_arrived(case):
    call, kind, message = REFUSED[case]
    with pytest.raises(kind) as caught:
        call()
    assert str(caught.value).startswith(message)
