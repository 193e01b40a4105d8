"""Measurements in a controller's numbers and units: the same readings and poses as in rad and m."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError, UnknownName
from poekin.formats.poses.layout import FORMATS, OF_CONTROLLERS, layout
from poekin.formats.text import csv_rows
from poekin.solve.calibration.measurements import data

ARM = pk.Chain.from_space(
    [pk.screw.revolute([0, 0, 1], [0, 0, 0]), pk.screw.prismatic([1, 0, 0])],
    np.eye(4),
    joint_names=["shoulder", "slide"],
)
rng = np.random.default_rng(2)
read: Any = data.read
Q = rng.uniform(-1, 1, (5, 2))
T = pk.se3.exp(rng.normal(size=(5, 6)))


def write(path, names, *parts):
    path.write_text(csv_rows.text(names, np.column_stack(parts)))
    return path


@pytest.mark.parametrize("deg", [None, False, True])
@pytest.mark.parametrize("mm", [None, False, True])
@pytest.mark.parametrize("format", FORMATS)
def test_poses_are_read_in_every_format_with_joints_in_the_units_that_are_said(
    format, mm, deg, tmp_path
):
    order = "wxyz" if format in ("quat", "7") else None
    plain = layout(format, order)
    free = {"mm": mm, "deg": deg} if format not in OF_CONTROLLERS else {}
    if not free and mm is (plain.length == "m"):
        with pytest.raises(InputError, match=f"^format: {format} is in "):
            read(tmp_path / "none.csv", ARM, format=format, mm=mm, deg=deg)
        return
    chosen = layout(format, order, **free)
    numbers = pk.poses.to_numbers(T, format, quaternion=order, **free)
    q = Q * [np.degrees(1) if deg else 1, 1000 if mm else 1]
    path = write(tmp_path / "a.csv", [*chosen.columns, "slide", "shoulder"], numbers, q[:, ::-1])
    found, measured = read(path, ARM, format=format, mm=mm, deg=deg)
    # two conversions of each number, one of them by 180 / pi
    np.testing.assert_allclose(found, Q, rtol=4e-16, atol=0)
    np.testing.assert_allclose(measured.T, T, rtol=0, atol=2e-15)


def test_a_header_says_units_of_joints_and_poses_apart(tmp_path):
    numbers = pk.poses.to_numbers(T, "rpy", mm=True)
    names = ["X [mm]", "y_mm", "z (mm)", "roll [rad]", "pitch [rad]", "yaw [rad]"]
    q = Q * [np.degrees(1), 1]
    path = write(tmp_path / "a.csv", [*names, "Shoulder [deg]", "slide [m]"], numbers, q)
    found, measured = read(path, ARM, format="rpy")
    np.testing.assert_allclose(found, Q, rtol=4e-16, atol=0)
    np.testing.assert_allclose(measured.T, T, rtol=0, atol=2e-15)


@pytest.mark.parametrize(
    ("names", "scale"),
    [(["x", "y", "z"], 1.0), (["x1", "y1", "z1"], 1.0), (["px [m]", "py [m]", "pz [m]"], 1e-3)],
)
def test_points_beside_poses_of_a_format_are_in_the_unit_of_lengths(names, scale, tmp_path):
    p = rng.normal(size=(5, 3))
    path = write(tmp_path / "a.csv", ["q1", "q2", *names], Q, 1000 * scale * p)
    mm = True if scale == 1 else None
    q, points = read(path, ARM, format="abc", mm=mm)
    np.testing.assert_allclose(np.asarray(points.p)[:, 0], p, rtol=4e-16, atol=0)
    np.testing.assert_array_equal(q, Q / [1, 1000] if mm else Q)


def test_distances_are_in_the_unit_of_lengths(tmp_path):
    path = write(tmp_path / "a.csv", ["q1", "q2", "distance"], Q, [[500.0]] * 5)
    _, distances = read(path, ARM, mm=True)
    np.testing.assert_array_equal(np.asarray(distances.d), [0.5] * 5)
    assert read(path, ARM)[1].d[0] == 500


def test_semicolons_and_decimal_commas_are_read(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("shoulder;slide;X;Y;Z;A;B;C;\n90;0,25;500,5;0;0;0;0;180;\n")
    q, measured = read(path, ARM, format="kuka", deg=True)
    np.testing.assert_array_equal(q, [[np.pi / 2, 0.25]])
    np.testing.assert_array_equal(
        measured.T[0], pk.poses.from_numbers([500.5, 0, 0, 0, 0, 180], "abc")
    )


REFUSED = {
    "format": ("", {"format": "xyz"}, InputError, "format: expected one of matrix"),
    "a joint's unit against what was said": ("q1 [rad],q2,X,Y,Z,A,B,C", {"format": "abc", "deg": True}, InputError,
        "{}:1: the header says that 'q1' is in rad, and it was said to be in deg; leave one of the two out"),
    "a joint in mm": ("q1 [mm],q2,X,Y,Z,A,B,C", {"format": "abc"}, InputError, "{}:1: 'q1' in mm; expected rad or deg"),
    "a column of another format": ("q1,q2,X,Y,Z,W,P,R", {"format": "abc"}, InputError,
        "{}:1: the columns X Y Z W P R make a pose of 'fanuc' (angles, mm and deg): format= (--format) "
        "says of which"),
    "no format": ("q1,q2,x,y,z,w,p,R [deg],time", {}, InputError,
                  "{}:1: the columns X Y Z W P R make a pose of 'fanuc' (angles, mm and deg): format= (--format) "
        "says of which"),
    "numbers, two of them alike": ("0.5,0,0,1", {}, InputError,
                                   "{}:1: a first line that names the columns expected, it has numbers alone"),
    "a column more": ("q1,q2,X,Y,Z,time", {}, UnknownName,
                      "{}:1: the column 'time' is neither a coordinate nor one of x y z; ignore=['time'] passes"),
    "a column missing": ("q1,q2,X,Y,Z,A,B", {"format": "abc"}, InputError,
                         "{}:1: of the columns X Y Z A B C, 'C' is missing"),
    "nothing": ("q1,q2", {"format": "abc"}, InputError, "{}:1: no column of a measurement; expected X Y Z A B C"),
    "something else": ("q1,q2,u,v", {"format": "abc"}, UnknownName,
                       "{}:1: 'u' is neither a coordinate nor part of a measurement (X Y Z A B C)"),
    "a unit of a quaternion": ("q1,q2,x,y,z,qw [rad],qx,qy,qz", {}, InputError, "{}:1: 'qw' in rad; expected no unit"),
    "mixed units": ("q1,q2,x [mm],y [m],z [m]", {}, InputError, "{}:1: 'x' is in mm and 'y' in m"),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_a_header_that_does_not_fit_is_refused(case, tmp_path):
    header, said, kind, message = REFUSED[case]
    path = tmp_path / "a.csv"
    path.write_text(f"{header}\n" + ",".join("1" * (header.count(",") + 1)) + "\n")
    with pytest.raises(kind) as caught:
        read(path, ARM, **said)
    assert str(caught.value).startswith(message.format(path))
