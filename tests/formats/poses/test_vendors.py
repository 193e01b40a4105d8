"""Every format against the vendor's own convention, SciPy, and numbers out of manuals and files."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import poekin as pk
from poekin.formats.poses.layout import FORMATS, PoseFormat, QuaternionOrder, layout
from tests.formats.poses.vendors import ALIASES, EXAMPLES, ONE_ROTATION, VENDORS, about

UNIT = 2.0**-53
rng = np.random.default_rng(16)
RANDOM = np.concatenate([rng.uniform(-180, 180, (60, 3)), rng.uniform(-400, 400, (20, 3))])
RIGHT = np.array([[0, 0, 0], [90, 0, -90], [30, 90, 50], [30, -90, 50], [180, 0, 180], [1, 180, 2]])
SCIPY = {
    "kuka": lambda a: Rotation.from_euler("ZYX", a, degrees=True),
    "fanuc": lambda a: Rotation.from_euler("xyz", a, degrees=True),
    "yaskawa": lambda a: Rotation.from_euler("xyz", a, degrees=True),
    "mitsubishi": lambda a: Rotation.from_euler("xyz", a, degrees=True),
    "staubli": lambda a: Rotation.from_euler("XYZ", a, degrees=True),
    "doosan": lambda a: Rotation.from_euler("ZYZ", a, degrees=True),
    "kawasaki": lambda a: Rotation.from_euler("ZYZ", a, degrees=True),
}


@pytest.mark.parametrize("vendor", VENDORS, ids=lambda v: v.format)
def test_angles_are_the_rotation_of_the_vendors_own_convention(vendor):
    angles = np.concatenate([RANDOM, RIGHT])
    rows = np.column_stack([np.tile([100.0, -200.0, 300.0], (len(angles), 1)), angles])
    T = pk.poses.from_numbers(rows, vendor.format)
    with mpmath.workdps(50):
        expected = np.array(
            [np.array(vendor.rotation(*row).tolist(), dtype=float) for row in angles.tolist()]
        )
    # sine and cosine right to u each, products of three of them, four roundings
    np.testing.assert_allclose(T[:, :3, :3], expected, rtol=0, atol=8 * UNIT)
    np.testing.assert_array_equal(T[:, :3, 3], np.tile([0.1, -0.2, 0.3], (len(T), 1)))
    # SciPy goes by a quaternion: some twenty roundings of numbers up to 1
    scipy = SCIPY[vendor.format](angles).as_matrix()
    np.testing.assert_allclose(T[:, :3, :3], scipy, rtol=0, atol=20 * UNIT)


@pytest.mark.parametrize("format", ALIASES)
def test_a_format_named_after_its_letters_is_that_of_the_vendor(format):
    rows = np.column_stack([np.zeros((len(RANDOM), 3)), RANDOM])
    np.testing.assert_array_equal(
        pk.poses.from_numbers(rows, format), pk.poses.from_numbers(rows, ALIASES[format])
    )
    T = pk.poses.from_numbers(rows, format)
    np.testing.assert_array_equal(
        pk.poses.to_numbers(T, format), pk.poses.to_numbers(T, ALIASES[format])
    )


def test_rotation_vectors_and_quaternions_are_those_of_scipy():
    turns = Rotation.from_quat(np.random.default_rng(3).normal(size=(200, 4)))
    p = np.zeros((200, 3))
    Q = turns.as_quat()
    cases: list[tuple[np.ndarray, PoseFormat, QuaternionOrder | None]] = [
        (np.column_stack([p, turns.as_rotvec()]), "ur", None),
        (np.column_stack([p, Q]), "ros", None),
        (np.column_stack([p, Q]), "quat", "xyzw"),
        (np.column_stack([p, np.roll(Q, 1, axis=1)]), "quat", "wxyz"),
        (np.column_stack([p, np.roll(Q, 1, axis=1)]), "abb", None),
    ]
    for rows, format, order in cases:
        T = pk.poses.from_numbers(rows, format, quaternion=order)
        np.testing.assert_allclose(T[:, :3, :3], turns.as_matrix(), rtol=0, atol=20 * UNIT)


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda e: e.source)
def test_numbers_out_of_manuals_and_files_are_the_rotation_that_stands_there(example):
    T = pk.poses.from_numbers(example.numbers, example.format)
    np.testing.assert_allclose(T[:3, :3], example.R, rtol=0, atol=1.5 * example.digits)
    scale = 1.0 if example.format in ("ur", "rpy") else 1000.0
    np.testing.assert_allclose(scale * T[:3, 3], example.numbers[:3], rtol=4 * UNIT, atol=0)


@pytest.mark.parametrize("format", ONE_ROTATION)
def test_one_rotation_has_the_numbers_of_every_format(format):
    with mpmath.workdps(50):
        R = about("z", 30) * about("y", 20) * about("x", 10)
        T = np.eye(4)
        T[:3, :3] = np.array(R.tolist(), dtype=float)
    T[:3, 3] = 1, 2, 3
    scale = 1000 if layout(format).length == "mm" else 1
    numbers = (1 * scale, 2 * scale, 3 * scale, *ONE_ROTATION[format])
    # thirteen digits of what is printed, at most 2600 u
    np.testing.assert_allclose(pk.poses.to_numbers(T, format), numbers, rtol=0, atol=6e-13)
    back = pk.poses.from_numbers(numbers, format)
    np.testing.assert_allclose(back, T, rtol=0, atol=2e-13)


def test_every_format_is_among_those_that_are_held():
    counted = {"matrix", "12", "16", "quat", "7"}
    assert set(ONE_ROTATION) | counted == set(FORMATS)
    assert {vendor.format for vendor in VENDORS} | set(ALIASES) | {
        "ur",
        "rotvec",
        "abb",
        "ros",
        "rpy",
    } | counted == set(FORMATS)


# The trap: the same three numbers are another rotation to another vendor.
APART: dict[tuple[PoseFormat, PoseFormat], float] = {
    ("kuka", "fanuc"): 32.7,
    ("kuka", "mitsubishi"): 32.7,
    ("fanuc", "staubli"): 12.0,
}


@pytest.mark.parametrize(("one", "other"), APART)
def test_the_numbers_of_one_vendor_are_another_rotation_to_another(one, other):
    numbers = [0, 0, 0, 10, 20, 30]
    R, Q = (pk.poses.from_numbers(numbers, format)[:3, :3] for format in (one, other))
    angle = np.degrees(np.linalg.norm(pk.so3.log(R.T @ Q)))
    assert abs(angle - APART[one, other]) < 0.05


def test_a_planted_convention_is_seen():
    numbers = np.array([0, 0, 0, 10.0, 20.0, 30.0])
    with mpmath.workdps(50):
        right = np.array(VENDORS[0].rotation(10, 20, 30).tolist(), dtype=float)
    for wrong in (numbers[[0, 1, 2, 5, 4, 3]], numbers * [1, 1, 1, 1, -1, 1]):
        assert np.abs(pk.poses.from_numbers(wrong, "kuka")[:3, :3] - right).max() > 0.1
    assert np.abs(pk.poses.from_numbers(numbers, "kuka")[:3, :3].T - right).max() > 0.1
