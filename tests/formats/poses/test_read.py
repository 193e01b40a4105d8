"""Poses out of text and files: rows, controllers' own notation, ROS, and what is refused."""

from __future__ import annotations

import importlib
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.errors import (
    FileError,
    InputError,
    PoekinError,
    PoekinWarning,
    PoseError,
    UnknownName,
)
from poekin.formats.poses import controller_text

UNIT = 2.0**-53
UNTYPED: Any = pk.poses


def pose(numbers, format):
    return pk.poses.from_numbers(numbers, format)


FANUC = """/PROG  DEMO
/POS
P[1]{
   GP1:
\tUF : 1, UT : 1,\t\tCONFIG : 'N U T, 0, 0, 0',
\tX =  -464.787  mm,\tY =   .002  mm,\tZ =   1.  mm,
\tW =   142.550 deg,\tP =    72.302 deg,\tR =  -130.575 deg,
\tE1 =  12.0 mm
};
P[2:"home"]{ GP1: UF : 1, UT : 1, CONFIG : 'N',
 X = 1 mm, Y = 2 mm, Z = -.000 mm, W = 0 deg, P = 0 deg, R = 0 deg };
/END
"""
TEXTS = {
    "UR": ("p[0.2, 0.3, 0.5, 0, 0, 3.14]", "ur", [[0.2, 0.3, 0.5, 0, 0, 3.14]]),
    "UR in a program": ("# a path\n  movej(p[.2,.3,.5,0,0,3.14], a=1.4, v=1.05)\n\nhome = p[1,2,3,0,0,0]", "rotvec",
                        [[0.2, 0.3, 0.5, 0, 0, 3.14], [1, 2, 3, 0, 0, 0]]),
    "KUKA": ("DECL E6POS XP1={X 27.02,Y 1220.2,Z 669.8,A -90.05,B 53.42,C -178.5,S 2,T 35,E1 0.0,E2 0.0}", "kuka",
             [[27.02, 1220.2, 669.8, -90.05, 53.42, -178.5]]),
    "KUKA in another order": ("PTP {A 30, B 90, C 0, Z -10, Y 0, X 280}\n; a comment\nLIN {x 1,y 2,z 3,a 4,b 5,c 6}",
                              "abc", [[280, 0, -10, 30, 90, 0], [1, 2, 3, 4, 5, 6]]),
    "Fanuc LS": (FANUC, "fanuc", [[-464.787, 0.002, 1, 142.55, 72.302, -130.575], [1, 2, 0, 0, 0, 0]]),
    "Fanuc in a line": ("X = 1 mm, Y = 2 mm, Z = 3 mm, W = 4 deg, P = 5 deg, R = 6 deg\nR=6,P=5,W=4,Z=3,Y=2,X=1", "wpr",
                        [[1, 2, 3, 4, 5, 6]] * 2),
    "ABB": ("CONST robtarget p10:=[[449.998977661,699.995788574,240],[0,0.707106781,0.707106781,0],[0,0,0,0],"
            "[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]];", "abb",
            [[449.998977661, 699.995788574, 240, 0, 0.707106781, 0.707106781, 0]]),
    "Stäubli": ("{{1,2,3,23,-41,67},{shoulder}}\n{1,2,3,23,-41,67}", "staubli", [[1, 2, 3, 23, -41, 67]] * 2),
    "Yaskawa": ("C00000=185.000,0.000,85.000,180.0000,0.0000,0.0000", "yaskawa", [[185, 0, 85, 180, 0, 0]]),
    "Mitsubishi": ("P1=(+100.00,0,100,0,-90,0)(7,0)", "mitsubishi", [[100, 0, 100, 0, -90, 0]]),
    "Mitsubishi's tool": ("(0,0,100,0,-90,0)", "mitsubishi", [[0, 0, 100, 0, -90, 0]]),
    "Kawasaki": ("POINT a = TRANS(0,0,0,90,-30,-90)", "kawasaki", [[0, 0, 0, 90, -30, -90]]),
    "Kawasaki in blanks": ("100.000 0 0  90 -30.5 -90\n1 2 3 4 5 6", "kawasaki",
                           [[100, 0, 0, 90, -30.5, -90], [1, 2, 3, 4, 5, 6]]),
    "Doosan": ("posx(1, 2, 3, 0, 90, 90)", "doosan", [[1, 2, 3, 0, 90, 90]]),
    "rows": ("1,2,3,10,20,30\n4,5,6,10,20,30", "abc", [[1, 2, 3, 10, 20, 30], [4, 5, 6, 10, 20, 30]]),
    "a spreadsheet's": ("x;y;z;a;b;c\n1,5;2;3;10;20;30\n", "abc", [[1.5, 2, 3, 10, 20, 30]]),
    "a header with units": ("X [m],Y [m],Z [m],A [rad],B [rad],C [rad]\n.001,.002,.003,0,0,3.141592653589793", "abc",
                            [[1, 2, 3, 0, 0, 180]]),
    "a flat message": ("1 2 3 0 0 0 1", "ros", [[1, 2, 3, 0, 0, 0, 1]]),
}  # fmt: skip


@pytest.mark.parametrize("case", TEXTS)
def test_a_text_is_the_poses_that_stand_in_it(case, tmp_path):
    text, format, rows = TEXTS[case]
    expected = pose(rows, format)
    found = pk.poses.read(text, format)
    assert found.shape == ((4, 4) if len(rows) == 1 else (len(rows), 4, 4))
    np.testing.assert_allclose(found.reshape(-1, 4, 4), expected, rtol=0, atol=4 * UNIT)
    path = tmp_path / "poses.txt"
    path.write_text(text, encoding="utf-8")
    for source in (path, str(path)):
        whole = pk.poses.read(source, format)
        assert whole.shape == (len(rows), 4, 4)
        np.testing.assert_array_equal(whole, found.reshape(-1, 4, 4))


@pytest.mark.parametrize("format", ["kuka", "staubli", "ur"])
def test_blocks_are_read_of_fanuc_s_files_alone(format):
    texts = {
        "kuka": "; P[1]{X 9, Y 9, Z 9, A 9, B 9, C 9}\n{X 1, Y 2, Z 3, A 4, B 5, C 6}",
        "staubli": "// P[1]{9, 9, 9, 9, 9, 9}\n{1, 2, 3, 4, 5, 6}",
        "ur": "# P[1]{9, 9, 9, 9, 9, 9}\np[1, 2, 3, 4, 5, 6]",
    }
    found = pk.poses.read(texts[format], format)
    np.testing.assert_array_equal(found, pose([1, 2, 3, 4, 5, 6], format))


def test_every_notation_has_a_text():
    held = {controller_text._SAME.get(f, f) for _, f, _ in TEXTS.values()}
    assert set(controller_text._PATTERNS) <= held


@pytest.mark.parametrize("count", [12, 16])
def test_a_matrix_has_three_rows_or_four(count):
    T = pk.se3.exp([[0.1, 0.2, 0.3, 1, 2, 3], [3, 2, 1, 0, 0, 1]])
    flat = T.reshape(2, 16)[:, :count]
    text = "\n".join(" ".join(map(repr, row)) for row in flat.tolist())
    np.testing.assert_array_equal(pk.poses.read(text, "matrix"), T)
    header = ",".join(f"T{i}{j}" for i in range(count // 4) for j in range(4))
    rows = "\n".join(",".join(map(repr, row)) for row in flat.tolist())
    np.testing.assert_array_equal(pk.poses.read(f"{header}\n{rows}", "matrix"), T)


STAMPED = """header:
  stamp:
    sec: 1700000000
    nanosec: 5
  frame_id: base_link
pose:
  position:
    x: 1.0e-05
    y: -0.25
    z: 1.5
  orientation:
    x: 0.0
    y: 0.0
    z: 0.7071067811865476
    w: 0.7071067811865476
---
"""
TRANSFORM = """transform:
  translation:
    x: 1.0
    y: 2.0
    z: 3.0
  rotation:
    x: 0.0
    y: 0.0
    z: 0.0
    w: 1.0
"""


def test_messages_are_read_as_ros2_topic_echo_prints_them():
    one = pose([1e-5, -0.25, 1.5, 0, 0, 0.5**0.5, 0.5**0.5], "ros")
    np.testing.assert_allclose(pk.poses.read(STAMPED, "ros"), one, rtol=0, atol=4 * UNIT)
    many = pk.poses.read(STAMPED + TRANSFORM + STAMPED, "ros")
    np.testing.assert_allclose(many[[0, 2]], [one, one], rtol=0, atol=4 * UNIT)
    np.testing.assert_array_equal(many[1], pose([1, 2, 3, 0, 0, 0, 1], "ros"))


@pytest.mark.parametrize("deg", [True, False])
def test_what_ros_prints_has_no_angles_that_a_unit_could_contradict(deg):
    joints = {"mm": False, "deg": deg}  # of a command line, where the joints have units
    np.testing.assert_array_equal(
        pk.poses.read(STAMPED, "ros", **joints), pk.poses.read(STAMPED, "ros")
    )
    with pytest.warns(PoekinWarning, match="decimals"):
        T = pk.poses.read(block(0), "ros", **joints)
    with pytest.warns(PoekinWarning, match="decimals"):
        plain = pk.poses.read(block(0), "ros")
    np.testing.assert_array_equal(T, plain)
    with pytest.raises(InputError, match=r"^format: ros is in m, mm was said"):
        pk.poses.read(STAMPED, "ros", mm=True)


# Blocks as tf2_echo printed them, of three decimals, and the rows of the matrix it prints below.
TF2 = (
    ("0.659, 0.459, 1.550", "-0.604, 0.696, 0.293, 0.254", "171.830, 45.092, -101.471",
     [[-0.140, -0.990, 0.000], [-0.692, 0.098, 0.715], [-0.708, 0.100, -0.699]]),
    ("-2.087, -0.785, 0.000", "0.000, 0.000, -0.222, 0.975", "0.000, 0.000, -25.706",
     [[0.901, 0.434, 0], [-0.434, 0.901, 0], [0, 0, 1]]),
    ("0.300, 0.015, 0.220", "-0.500, 0.501, -0.498, 0.501", "-90.137, 0.167, -89.877",
     [[0.002, -0.002, 1], [-1, 0.003, 0.002], [-0.003, -1, -0.002]]),
)  # fmt: skip


def test_a_file_with_a_header_alone_has_no_poses(tmp_path):
    path = tmp_path / "poses.csv"
    path.write_text("X;Y;Z;A;B;C\n")
    assert pk.poses.read(path, "kuka").shape == (0, 4, 4)


def block(k, order=" (xyzw)", degrees=True):
    p, q, rpy, _ = TF2[k]
    lines = [
        "At time 1700000000.12345",
        f"- Translation: [{p}]",
        f"- Rotation: in Quaternion{order} [{q}]",
        "- Rotation: in RPY (radian) [2.999, 0.787, -1.771]",
    ]
    if degrees:
        lines.append(f"- Rotation: in RPY (degree) [{rpy}]")
    return "\n".join([*lines, "- Matrix:", " -0.140 -0.990 0.000 0.659"]) + "\n"


@pytest.mark.parametrize("order", ["", " (xyzw)"])
@pytest.mark.parametrize("k", range(3))
def test_the_degrees_of_tf2_echo_are_read_and_not_its_quaternion(k, order):
    before = "[INFO] [1.2] [tf2_echo]: Waiting for transform base ->  tool: Invalid frame ID\n"
    with pytest.warns(PoekinWarning) as told:
        T = pk.poses.read(before + block((k + 1) % 3, order) + block(k, order), "ros")
    p, q, rpy, R = TF2[k]
    assert T.shape == (4, 4)
    expected = pk.poses.from_numbers([float(x) for x in f"{p},{rpy}".split(",")], "rpy", deg=True)
    np.testing.assert_array_equal(T, expected)
    # its matrix has three decimals, and so have three angles of degrees: 1e-5 more
    np.testing.assert_allclose(T[:3, :3], R, rtol=0, atol=5.3e-4)
    assert str(told[0].message) == (
        "text:10: tf2_echo prints 3 decimals: each coordinate is known to 0.5 mm, the rotation to 0.0015°"
    )
    Q = pk.poses.from_numbers([float(x) for x in f"{p},{q}".split(",")], "ros")
    angle = np.degrees(np.linalg.norm(pk.so3.log(Q[:3, :3].T @ T[:3, :3])))
    assert angle <= 0.115 + 0.0015  # what is said where only the quaternion is there


def test_a_block_that_is_cut_gives_way_to_the_one_before_it():
    with pytest.warns(PoekinWarning, match=r"^text:2: .* 0\.0015°$"):
        T = pk.poses.read(block(0) + block(1).partition("- Rotation: in RPY (degree)")[0], "ros")
    assert T[0, 3] == 0.659
    with pytest.warns(PoekinWarning, match=r"^text:2: .* rotation to 0\.11°$"):
        T = pk.poses.read(block(0, degrees=False), "ros")
    np.testing.assert_array_equal(
        T, pose([0.659, 0.459, 1.550, -0.604, 0.696, 0.293, 0.254], "ros")
    )


REFUSED = {
    "no text": (lambda: UNTYPED.read(5, "abc"), InputError, "source: expected a path or a text, got 5"),
    "no file": (lambda: pk.poses.read("poses.csv", "abc"), InputError,
                "text: expected poses or the name of a file that is there, got 'poses.csv'"),
    "a long name of no file": (lambda: pk.poses.read("p" * 59 + "xyz", "abc"), InputError,
                "text: expected poses or the name of a file that is there, got '" + "p" * 59 + "x'"),
    "no such path": (lambda: pk.poses.read(__import__("pathlib").Path("poses.csv"), "abc"), FileError,
                     "cannot read poses.csv: No such file or directory"),
    "two in a line": (lambda: pk.poses.read("p[1,2,3,0,0,0] p[1,2,3,0,0,0]", "ur"), InputError,
                      "text:1: expected one pose a line, p[x, y, z, rx, ry, rz]; got 2 of them"),
    "another line": (lambda: pk.poses.read("p[1,2,3,0,0,0]\nq = 3", "ur"), InputError,
                     "text:2: expected one pose a line, p[x, y, z, rx, ry, rz]; got 'q = 3'"),
    "too few": (lambda: pk.poses.read("p[1,2,3,0,0]", "ur"), InputError,
                "text:1: 6 numbers expected (x y z rx ry rz), got 5"),
    "no number": (lambda: pk.poses.read("p[1,2,3,0,0,d2r(90)]", "ur"), InputError,
                  "text:1: a number expected, got 'd2r(90)'"),
    "a key twice": (lambda: pk.poses.read("{X 1, Y 2, Z 3, A 4, B 5, C 6, X 1}", "kuka"), InputError,
                    "text:1: X is there twice"),
    "a part of the keys": (lambda: pk.poses.read("{A 30}", "kuka"), InputError,
                           "text:1: expected X, Y, Z, A, B, C; X is missing"),
    "joints": (lambda: pk.poses.read("{A1 1, A2 2, A3 3, A4 4, A5 5, A6 6}", "kuka"), InputError,
               "text:1: 'A1' is none of X, Y, Z, A, B, C"),
    "Fanuc's joints": (lambda: pk.poses.read("P[1]{\n J1= 0 deg, X = 1 mm };", "fanuc"), InputError,
                       "text:1: a pose expected, got joints (J1)"),
    "joints of an LS file": (lambda: pk.poses.read("P[1]{\n GP1:\n J1= 0 deg, J2= 1 deg\n};", "fanuc"), InputError,
                             "text:1: a pose expected, got joints (J1)"),
    "another unit": (lambda: pk.poses.read("X = 1 in, Y=2, Z=3, W=4, P=5, R=6", "fanuc"), InputError,
                     "text:1: X is in 'in', expected mm"),
    "a unit against what was said": (lambda: pk.poses.read("X = 1 mm, Y=2, Z=3, W=4, P=5, R=6", "wpr", mm=False),
                                     InputError, "text:1: X is in 'mm', expected m"),
    "a header against what was said": (lambda: pk.poses.read("X [m],Y [m],Z [m],A,B,C\n1,2,3,0,0,0", "abc", mm=True),
        InputError, "text:1: the header says that 'X' is in m, and it was said to be in mm; leave one of the two out"),
    "a format's columns in a header of another": (lambda: pk.poses.read("X,Y,Z,W,P,R\n1,2,3,4,5,6", "abc"), UnknownName,
                                                  "text:1: 'W' is neither a number nor a column"),
    "a long quaternion": (lambda: pk.poses.read("[[1,2,3],[1,1,0,0]]", "abb"), PoseError,
                          "text:1: the quaternion's length is 1.41421, expected 1 within 0.001"),
    "a message that is cut": (lambda: pk.poses.read(STAMPED.partition("    w:")[0], "ros"), InputError,
                              "text:7: expected position: x, y, z and then orientation: x, y, z, w"),
    "a message of another kind": (lambda: pk.poses.read("position:\n- 0.5\n- 0.25\n", "ros"), InputError,
                                  "text:1: expected position: x, y, z and then orientation"),
    "no number in a message": (lambda: pk.poses.read(STAMPED.replace("1.5", "z"), "ros"), InputError,
                               "text:7: a number expected, got 'z'"),
    "no whole block": (lambda: pk.poses.read(block(0).partition("- Rotation")[0], "ros"), InputError,
                       "text: expected a block of tf2_echo, Translation and then Rotation; the text is cut"),
    "a cut line": (lambda: pk.poses.read(block(0).replace("0.659, ", ""), "ros"), InputError,
                   "text:2: the block of tf2_echo is cut"),
    "a cut number": (lambda: pk.poses.read("1 2 3 4 5 6\n1 2 3 4 5 -\n", "abc"), InputError,
                     "text:2, column 6: a number expected, got '-'"),
    "not a number format": (lambda: UNTYPED.read("1 2 3 0 0 0", "euler"), InputError,
                            "format: expected one of matrix"),
    "no file of a number": (lambda: pk.poses.read("run 1/poses2.csv", "abc"), InputError,
                            "text: expected poses or the name of a file that is there, got 'run 1/poses2.csv'"),
    "no truth value": (lambda: UNTYPED.read("1 2 3 4 5 6", "abc", mm="no"), InputError,
                       "mm: expected True or False, got 'no'"),
    "no truth value of angles": (lambda: UNTYPED.from_numbers([1, 2, 3, 4, 5, 6], "abc", deg=[1]), InputError,
                                 "deg: expected True or False, got [1]"),
    "a zero byte": (lambda: pk.poses.read("a\0b", "abc"), InputError, "text: expected poses or the name of a file"),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_what_is_refused_is_said_with_line_and_cure(case, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    call, kind, message = REFUSED[case]
    with pytest.raises(kind) as caught:
        call()
    assert str(caught.value).startswith(message)
    assert "\n" not in str(caught.value)


def test_an_empty_text_is_refused_and_one_of_names_alone_has_no_poses(tmp_path):
    path = tmp_path / "none.csv"
    path.write_text("")
    for empty in (path, "\n \n"):
        with pytest.raises(
            pk.errors.InputError, match="rows of numbers expected, the file is empty"
        ):
            pk.poses.read(empty, "abc")
    assert pk.poses.read("X,Y,Z,A,B,C\n", "abc").shape == (0, 4, 4)


def test_a_text_is_of_bounded_length(tmp_path, monkeypatch):
    module = importlib.import_module("poekin.formats.poses.read")
    assert module.LARGEST == 268_435_456
    monkeypatch.setattr(module, "LARGEST", 20)
    path = tmp_path / "long.csv"
    path.write_text("1 2 3 4 5 6\n" * 2)
    with pytest.raises(FileError, match=r"long\.csv: at most 20 characters expected$"):
        pk.poses.read(path, "abc")


def test_the_wrong_order_of_a_quaternion_is_another_pose_and_never_guessed():
    T = pk.poses.read(
        "0 0 0 0.1825741858350554 0.3651483716701107 0.5477225575051661 0.7302967433402214", "ros"
    )
    W = pk.poses.read(
        "0 0 0 0.1825741858350554 0.3651483716701107 0.5477225575051661 0.7302967433402214",
        "quat",
        quaternion="wxyz",
    )
    assert np.abs(T - W).max() > 0.5


LONG = 100_000
HOSTILE = {
    "blanks after a key": ("fanuc", "X=" + " " * LONG),
    "blanks in brackets": ("staubli", "{" + " " * LONG + "1"),
    "blocks without an end": ("fanuc", "X = 1 " + "P[1" * LONG),
    "brackets without an end": ("doosan", "(1," * LONG),
    "commas without an end": ("doosan", "(1" + "," * LONG),
    "messages": ("ros", "position: x: 1" + " " * LONG),
    "braces": ("ros", "position: {" + " " * LONG),
    "the beginnings of messages": ("ros", "position:" * LONG),
    "blocks of tf2_echo": ("ros", "Translation: [1,2,3] " + "in Quaternion " * LONG),
    "tabs": ("abc", "1" + "\t" * LONG + "2"),
    "blanks in a header": ("abc", "X" + " " * LONG + "[;Y1"),
    "keys": ("kuka", "{A 1" * LONG),
    "a word of one letter": ("ur", "p" * LONG + "[1"),
}


@pytest.mark.parametrize("case", HOSTILE)
def test_a_long_text_that_is_no_pose_is_refused_without_going_over_it_again_and_again(case):
    # a search that began anew at each letter would take minutes
    format, text = HOSTILE[case]
    with pytest.raises(PoekinError) as caught:
        UNTYPED.read(text, format)
    assert len(str(caught.value)) < 1000


def test_many_messages_know_their_lines():
    wrong = STAMPED.replace("w: 0.7071067811865476", "w: 2")
    text = STAMPED * 2998 + wrong + STAMPED
    line = 2998 * STAMPED.count("\n") + 7
    with pytest.raises(PoseError, match=rf"^text:{line}: the quaternion's length is 2\.1"):
        pk.poses.read(text, "ros")
