"""What the columns of a header are taken for, and what is said of those that make nothing."""

from __future__ import annotations

import re
from typing import Any

import pytest

from poekin.errors import InputError, UnknownName
from poekin.formats.poses.layout import layout
from poekin.solve.calibration.measurements import columns
from poekin.solve.calibration.measurements.columns import (
    STANDARD,
    ColumnLayout,
    describe,
    of_poses,
    parse_header,
    point_columns,
)

OWN = ("shoulder", "elbow")
T = [f"T{i}{j}" for i in range(3) for j in range(4)]
THREE = ["x1", "y1", "z1", "x2", "y2", "z2", "x3", "y3", "z3"]
POSES = ("poses", "eye-in-hand", "eye-to-hand")


def parsed(words: str, fixed: Any = STANDARD, ignore: tuple[str, ...] = ()) -> Any:
    return parse_header(words.split(), OWN, ignore, "a.csv:1", fixed)


@pytest.mark.parametrize(("words", "kinds", "format"), [
    (" ".join([*T, "T30", "T31", "T32", "T33"]), POSES, "16"),
    (" ".join(T), POSES, "12"),
    ("x y z qw qx qy qz", POSES, "quat"),
    ("x y z roll pitch yaw", POSES, "rpy"),
    ("px py pz", ("points",), None),
    ("x y z", ("points",), None),
    ("x1 y1 z1", ("points",), None),
    (" ".join(THREE), ("points",), None),
    ("distance", ("distances",), None),
])  # fmt: skip
@pytest.mark.parametrize("names", ["shoulder elbow", "q1 q2"])
def test_columns_in_any_order_are_what_their_names_say(names, words, kinds, format):
    measured = words.split()
    q_names, found = parsed(" ".join([*measured[::-1], *names.split()[::-1]]))
    assert q_names == tuple(names.split())
    assert found.columns == tuple(measured)
    assert found.kinds == kinds
    assert (found.pose and found.pose.format) == format


def test_points_are_counted_by_their_largest_number_and_are_no_more_than_the_columns():
    for words, count in (
        ("a b", 0),
        ("x0 y01 z1234567 x2a", 0),
        ("x1 y1 z1", 1),
        ("x1 y2 z1 a b", 2),
        ("z123456 a b", 3),
    ):
        assert columns._points(set(words.split())) == ColumnLayout(
            point_columns(count), ("points",)
        )
    assert point_columns(3) == tuple(THREE)


def test_seven_columns_are_named_and_of_more_the_first_and_the_last():
    assert describe(ColumnLayout(tuple("abcdefg"), ())) == "a b c d e f g"
    assert describe(ColumnLayout(tuple("abcdefgh"), ())) == "a ... h"


KUKA = of_poses((layout("kuka"),))
OF_KUKA = "X Y Z A B C, or px py pz, or x y z, or distance"
EXPECTED = (
    "T00 ... T23, or x y z qw qx qy qz, or x y z roll pitch yaw, or x y z, or x1 y1 z1 x2 ..., or "
    "distance"
)
MISSING = (
    "no column for the coordinate '{}'; expected 'shoulder', 'elbow', or q1 ... q2; available: {}, "
    "of which rename= says what they are"
)


@pytest.mark.parametrize(("words", "fixed", "kind", "message"), [
    ("1 2 3", STANDARD, InputError, "a first line that names the columns expected, it has numbers alone"),
    ("q1 q1 distance", STANDARD, InputError, "the column 'q1' is there 2 times"),
    ("q1 q2 x x x", STANDARD, InputError, "the column 'x' is there 3 times"),
    ("q2 x y z", STANDARD, InputError, MISSING.format("q1", "'q2', 'x', 'y', 'z'")),
    ("distance", STANDARD, InputError, MISSING.format("q1", "'distance'")),
    ("shoulder x", STANDARD, InputError, MISSING.format("elbow", "'shoulder', 'x'")),
    ("q1 q2", STANDARD, InputError, f"no column of a measurement; expected {EXPECTED}"),
    ("q1 q2", KUKA, InputError, f"no column of a measurement; expected {OF_KUKA}"),
    # of layouts that were begun the one of which the largest part is there
    ("q1 q2 x y roll", STANDARD, InputError, "of the columns x y z, 'z' is missing"),
    ("q1 q2 x roll yaw pitch", STANDARD, InputError, "of the columns x y z roll pitch yaw, 'y' is missing"),
    ("q1 q2 px pz", STANDARD, InputError, "of the columns px py pz, 'py' is missing"),
    ("q1 q2 x1 y1", STANDARD, InputError, "of the columns x1 y1 z1, 'z1' is missing"),
    # of those that are whole the largest, and of what is left the first
    ("q1 q2 b distance a x y z", STANDARD, UnknownName,
     "the column 'b' is neither a coordinate nor one of x y z; ignore=['b'] passes it over"),
    ("q1 q2 x1 y1 z1 t", STANDARD, UnknownName,
     "the column 't' is neither a coordinate nor one of x1 y1 z1; ignore=['t'] passes it over"),
    ("q1 q2 distanze u", KUKA, UnknownName,
     f"'distanze' is neither a coordinate nor part of a measurement ({OF_KUKA}); did you mean "
     "'distance'?; rename= says what it is, ignore=['distanze'] passes it over"),
    ("q1 q2 u", KUKA, UnknownName,
     f"'u' is neither a coordinate nor part of a measurement ({OF_KUKA}); available: 'X', 'Y', 'Z' and "
     "10 more; rename= says what it is, ignore=['u'] passes it over"),
    ("q1 q2 x y z qx qy qz qw", KUKA, UnknownName,
     "the column 'qx' is neither a coordinate nor one of x y z; ignore=['qx'] passes it over"),
    ("q1 q2 X Y Z W P R", STANDARD, InputError,
     "the columns X Y Z W P R make a pose of 'fanuc' (angles, mm and deg): format= (--format) says of which"),
    ("q1 q2 x y z RX RY RZ", STANDARD, InputError,
     "the columns x y z rx ry rz make a pose of 'rotvec' (a rotation vector, m and rad), 'ur' (a "
     "rotation vector, m and rad), 'staubli' (angles, mm and deg), 'yaskawa' (angles, mm and deg): "
     "format= (--format) says of which"),
])  # fmt: skip
def test_what_makes_no_measurement_is_said_with_what_would(words, fixed, kind, message):
    with pytest.raises(kind, match=f"^{re.escape(f'a.csv:1: {message}')}$"):
        parsed(words, fixed)


def test_what_is_ignored_may_be_there_twice_or_be_all_numbers():
    names, found = parsed("t q1 7 q2 distance t", ignore=("t", "7"))
    assert (names, found.columns) == (("q1", "q2"), ("distance",))
    with pytest.raises(InputError, match="no column for the coordinate"):
        parsed("t", ignore=("t",))
