"""Text of poses in each controller's notation: what it looks like, and that it is read back."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError, PoseError
from poekin.formats.poses.layout import FORMATS

T = pk.poses.from_numbers([500, -20.5, 300, 90, 0, 180], "abc")
TEXTS = {
    "ur": "p[0.5, -0.0205, 0.3, 2.221441469079183, 2.221441469079183, 0]",
    "rotvec": "0.5, -0.0205, 0.3, 2.221441469079183, 2.221441469079183, 0",
    "kuka": "{X 500, Y -20.5, Z 300, A 90, B 0, C 180}",
    "abc": "500, -20.5, 300, 90, 0, 180",
    "fanuc": "X = 500 mm, Y = -20.5 mm, Z = 300 mm, W = 180 deg, P = 0 deg, R = 90 deg",
    "wpr": "500, -20.5, 300, 180, 0, 90",
    "abb": "[[500, -20.5, 300], [0, 0.7071067811865476, 0.7071067811865476, 0]]",
    "ros": "{position: {x: 0.5, y: -0.0205, z: 0.3}, "
    "orientation: {x: 0.7071067811865476, y: 0.7071067811865476, z: 0.0, w: 0.0}}",
    "staubli": "{500, -20.5, 300, 180, 0, -90}",
    "yaskawa": "500, -20.5, 300, 180, 0, 90",
    "mitsubishi": "(500, -20.5, 300, 180, 0, 90)",
    "kawasaki": "TRANS(500, -20.5, 300, -90, 180, 0)",
    "doosan": "posx(500, -20.5, 300, -90, 180, 0)",
    "12": "0, 1, 0, 0.5, 1, 0, 0, -0.0205, 0, 0, -1, 0.3",
}


@pytest.mark.parametrize("format", TEXTS)
def test_a_pose_is_written_as_its_controller_reads_it(format):
    # the last digit of a square root is the processor's
    text = pk.poses.write(T, format)
    assert text.replace("0.7071067811865475", "0.7071067811865476") == TEXTS[format]


@pytest.mark.parametrize("format", FORMATS)
def test_what_is_written_is_read_back_in_every_format(format):
    order = "xyzw" if format in ("quat", "7") else None
    poses = pk.se3.exp(np.random.default_rng(4).normal(size=(300, 6)) * [2, 2, 2, 1e-9, 1, 1e6])
    text = pk.poses.write(poses.reshape(3, 100, 4, 4), format, quaternion=order)
    assert text.count("\n") == 299
    assert "e" not in text.replace("deg", "").replace("orientation", "").lower()
    assert "-0," not in text
    back = pk.poses.read(text, format, quaternion=order)
    np.testing.assert_allclose(back[:, :3, :3], poses[:, :3, :3], rtol=0, atol=1e-15)
    # of mm, two roundings
    np.testing.assert_allclose(back[:, :3, 3], poses[:, :3, 3], rtol=2.0**-52, atol=0)


def test_yaml_takes_every_number_for_a_number():
    yaml = pytest.importorskip("yaml")
    small = pk.se3.exp([1e-5, 0, 0, 1e-7, 1, 1e16])
    read = yaml.safe_load(pk.poses.write(small, "ros"))
    assert all(isinstance(x, float) for part in read.values() for x in part.values())


def test_units_are_those_that_are_said():
    assert pk.poses.write(T, "abc", mm=False, deg=True).startswith("0.5, -0.0205, 0.3, 90, 0, 180")
    assert pk.poses.write(T, "rpy", mm=True, deg=True) == "500, -20.5, 300, 180, 0, 90"


def test_nothing_is_written_of_no_pose():
    with pytest.raises(PoseError, match=r"^T is no pose"):
        pk.poses.write(np.ones((4, 4)), "ur")
    with pytest.raises(InputError, match=r"^T\[1\]: expected a finite pose$"):
        pk.poses.write([np.eye(4), np.full((4, 4), np.nan)], "ur")
    with pytest.raises(InputError, match=r"^format: expected one of matrix"):
        pk.poses.write(np.eye(4), "utf")  # type: ignore[arg-type]
    assert pk.poses.write(np.empty((0, 4, 4)), "ur") == ""
