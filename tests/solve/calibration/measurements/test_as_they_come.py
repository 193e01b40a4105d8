"""Files as devices and programs write them: names, comments, units, separators."""

from __future__ import annotations

import re

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError, UnknownName
from poekin.solve.calibration import Poses, read

ARM = pk.Chain.from_space(
    [pk.screw.revolute([0, 0, 1], [0, 0, 0]), pk.screw.prismatic([1, 0, 0])],
    np.eye(4),
    joint_names=["shoulder", "slide"],
)


@pytest.fixture
def file(tmp_path):
    def write(text):  # type: ignore[no-untyped-def]
        path = tmp_path / "a.csv"
        path.write_text(text, encoding="utf-8")
        return path

    return write


@pytest.mark.parametrize(
    "names",
    [
        *(
            "q1,q2",
            "Q1,Q2",
            "J1,J2",
            "j0,j1",
            "joint_1,joint_2",
            "Joint_0,Joint_1",
            "joint1,joint2",
        ),
        *("axis1,axis2", "AXIS_1,AXIS_2", "theta1,theta2", "theta0,theta1", "Shoulder,SLIDE"),
    ],
)
def test_coordinates_may_be_numbered_in_the_words_of_controllers(names, file):
    q, points = read(file(f"{names},x,y,z\n0.25,0.5,1,2,3\n"), ARM)
    np.testing.assert_array_equal(q, [[0.25, 0.5]])
    np.testing.assert_array_equal(points.p, [[[1, 2, 3]]])  # type: ignore[attr-defined]


def test_numbers_from_one_are_not_taken_for_numbers_from_nought(file):
    with pytest.raises(
        UnknownName, match="the column 'j0' is neither a coordinate nor one of x y z"
    ):
        read(file("j0,j1,j2,x,y,z\n0,1,2,1,2,3\n"), ARM)
    swapped, _ = read(file("joint_2,joint_1,distance\n0.5,0.25,1\n"), ARM)
    np.testing.assert_array_equal(swapped, [[0.25, 0.5]])


def test_an_arm_s_own_names_are_stronger_than_numbers(file):
    own = ARM.replace(q_names=("j1", "j0"), joint_names=("j1", "j0"))
    q, _ = read(file("j0,j1,distance\n0.5,0.25,1\n"), own)
    np.testing.assert_array_equal(q, [[0.25, 0.5]])


def test_a_word_of_another_case_is_the_arm_s_own_name_where_a_numbered_one_is_alike(file):
    own = ARM.replace(q_names=("Joint1", "Joint2"), joint_names=("Joint1", "Joint2"))
    q, _ = read(file("JOINT1,JOINT2,distance\n0.25,0.5,1\n"), own)
    np.testing.assert_array_equal(q, [[0.25, 0.5]])


@pytest.mark.parametrize("unit", ["", " [deg]", " (rad)"])
def test_roll_pitch_yaw_need_no_format(unit, file):
    angles = np.array([0.1, -0.2, 0.3])
    written = np.degrees(angles) if "deg" in unit else angles
    head = ",".join(f"{name}{unit}" for name in ("yaw", "roll", "pitch"))
    row = ",".join(map(repr, written[[2, 0, 1]].tolist()))
    _, poses = read(file(f"q1,q2,{head},x,y,z\n0,0,{row},1,2,3\n"), ARM)
    assert isinstance(poses, Poses)
    expected = pk.poses.from_numbers([1, 2, 3, *angles], "rpy")
    np.testing.assert_allclose(poses.T, [expected], atol=1e-15)
    if not unit:
        _, in_degrees = read(file(f"q1,q2,{head},x,y,z\n0,0,{row},1,2,3\n"), ARM, deg=True, mm=True)
        expected = pk.poses.from_numbers([1, 2, 3, *angles], "rpy", deg=True, mm=True)
        np.testing.assert_allclose(in_degrees.T, [expected], atol=1e-15)  # type: ignore[attr-defined]


def test_rx_ry_rz_are_never_guessed_and_a_format_takes_them_for_a_rotation_vector(file):
    path = file("q1,q2,x,y,z,rx,ry,rz\n0,0,1,2,3,0.1,0.2,0.3\n")
    with pytest.raises(InputError, match=r"make a pose of 'rotvec' \(a rotation vector, m and"):
        read(path, ARM)
    _, poses = read(path, ARM, format="rotvec")
    np.testing.assert_allclose(poses.T[0, :3, :3], pk.so3.exp([0.1, 0.2, 0.3]), atol=1e-15)  # type: ignore[attr-defined]


def test_columns_of_other_names_are_renamed_with_their_units(file):
    path = file("n;joint_1;joint_2;x_t;y_t;z_t\n1;0,25;0,5;1000,5;2000;3000\n")
    names = {"x_t": "x [mm]", "y_t": "y [mm]", "z_t": "z [mm]"}
    q, points = read(path, ARM, rename=names, ignore="n")
    np.testing.assert_array_equal(q, [[0.25, 0.5]])
    np.testing.assert_array_equal(points.p, [[[1.0005, 2, 3]]])  # type: ignore[attr-defined]
    said = f"{path}:1: rename: no column 'x_'; did you mean 'x_t'?"
    with pytest.raises(UnknownName, match=f"^{re.escape(said)}"):
        read(path, ARM, rename={"x_": "x [mm]"})


NUMBERS = "0.25 0.5 1 2 3\n"


@pytest.mark.parametrize(
    ("text", "line"),
    [
        (f"# tracker 7, 20.5 C\n\n// point 1\nq1 q2 x y z\n{NUMBERS}", 5),
        (f"# a b\n# q1 q2 x y z\n{NUMBERS}", 3),
        (f"#q1 q2 x y z\n{NUMBERS}", 2),
        ("% made by hand\n# q1,q2,x,y,z\n0.25,0.5,1,2,3\n", 3),
        ("// q1;q2;x;y;z\n\n0,25;0,5;1;2;3;\n", 3),
        ("## q1\tq2\tx\ty\tz\n0.25\t0.5\t1\t2\t3\n", 2),
    ],
)
def test_comments_above_the_names_are_passed_over_and_may_hold_them(text, line, file):
    path = file(text)
    q, points = read(path, ARM)
    np.testing.assert_array_equal(q, [[0.25, 0.5]])
    np.testing.assert_array_equal(points.p, [[[1, 2, 3]]])  # type: ignore[attr-defined]
    path.write_text(path.read_text() + path.read_text().splitlines()[-1].replace("3", "a"))
    with pytest.raises(InputError, match=f"a.csv:{line + 1}, column 5: a number expected, got 'a'"):
        read(path, ARM)


def test_a_column_may_be_called_by_a_number_sign(file):
    q, _ = read(file("#,q1,q2,x,y,z\n7,0.25,0.5,1,2,3\n"), ARM, ignore="#")
    np.testing.assert_array_equal(q, [[0.25, 0.5]])


@pytest.mark.parametrize("text", ["# q1,q2,x,y,z\n", "# nothing\n\n# at all\n"])
def test_comments_alone_are_no_measurements(text, file):
    with pytest.raises(InputError, match=r"a\.csv:1: "):
        read(file(text), ARM)


def test_missing_coordinates_are_named_with_what_the_file_has(file):
    said = (
        "a.csv:1: no column for the coordinate 'joint_2'; expected 'shoulder', 'slide', or q1 ... q2; available: "
        "'joint_1', 'A2', 'x', 'y', 'z', of which rename= says what they are"
    )
    with pytest.raises(InputError, match=f"{re.escape(said)}$"):
        read(file("joint_1,A2,x,y,z\n1,2,3,4,5\n"), ARM)
