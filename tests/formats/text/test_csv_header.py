"""Headers of CSV files: names in another case, units, and what contradicts itself or the user."""

from __future__ import annotations

import io

import numpy as np
import pytest

from poekin.errors import InputError, UnknownName
from poekin.formats.text import csv_rows
from poekin.formats.text.csv_header import (
    Columns,
    Heading,
    coordinate_names,
    headings,
    numbered,
    numbered_coordinates,
    order,
)

POSE = Columns(("X", "Y", "A", "q"), "column", ("mm", "mm", "deg", ""))


def read(text, columns=POSE):
    rows, _ = csv_rows.read(io.StringIO(text, newline=""), columns, "f.csv")
    return rows


@pytest.mark.parametrize(
    ("word", "expected"),
    [
        ("X", ("X", "")),
        ("x", ("X", "")),
        ("X [mm]", ("X", "mm")),
        ("x(MM)", ("X", "mm")),
        ("X_mm", ("X", "mm")),
        ("x_MM", ("X", "mm")),
        ("X\nY_mm", ("X\nY", "mm")),
        ("A_deg", ("A", "deg")),
        ("a_Deg", ("A", "deg")),
        ("a [ degrees ]", ("A", "deg")),
        ("A (°)", ("A", "deg")),
        ("A [Rad]", ("A", "rad")),
        ("X [metres]", ("X", "m")),
        ("X_m", ("X", "m")),
        ("X [inch]", ("X [inch]", "")),
        ("X_in", ("X_in", "")),
        ("other [mm]", ("other", "mm")),
        ("arm_rad", ("arm_rad", "")),
        ("X\n[ mm ]", ("X", "mm")),
        ("X [mm] [deg]", ("X [mm]", "deg")),
    ],
)
def test_a_word_of_a_header_is_a_name_and_a_unit(word, expected):
    assert headings([word], (*POSE.names, "arm_rad")) == [Heading(*expected)]


def test_another_case_is_taken_where_one_name_fits_only():
    assert headings(["a"], ("A", "b"))[0].name == "A"
    assert headings(["a"], ("A", "a"))[0].name == "a"
    assert headings(["é"], ("É", "e"))[0].name == "É"
    assert headings(["joint_a"], ("JOINT_A", "Joint_a"))[0].name == "joint_a"


def test_units_of_a_header_are_made_those_that_are_wanted():
    rows = read("X [m],y (m),A_rad,q\n0.1,0.2,3.141592653589793,4\n")
    np.testing.assert_array_equal(rows, [[100, 200, 180, 4]])
    back = POSE._replace(units=("m", "m", "rad", ""))
    rows = read("Y [mm];X [mm];q;A [deg]\n200,5;100;4;180\n", back)
    np.testing.assert_array_equal(rows, [[0.1, 0.2005, np.pi, 4]])
    same = read("X [mm],Y [mm],A [deg],q\n1,2,3,4\n")
    np.testing.assert_array_equal(same, [[1, 2, 3, 4]])


REFUSED = {
    "mixed": ("X [mm],Y [m],A,q\n", (), InputError,
              "f.csv:1: 'X' is in mm and 'Y' in m; expected one unit, said with each of them or with none"),
    "mixed, the longer one first": ("X [m],Y [mm],A,q\n", (), InputError,
              "f.csv:1: 'X' is in m and 'Y' in mm; expected one unit, said with each of them or with none"),
    "half": ("X [mm],Y,A,q\n", (), InputError,
             "f.csv:1: 'X' is in mm and 'Y' in no unit; expected one unit, said with each of them or with none"),
    "contradicted length": ("X [m],Y [m],A,q\n", ("mm",), InputError,
        "f.csv:1: the header says that 'X' is in m, and it was said to be in mm; leave one of the two out"),
    "contradicted angle": ("X,Y,A [rad],q\n", ("mm", "deg"), InputError,
        "f.csv:1: the header says that 'A' is in rad, and it was said to be in deg; leave one of the two out"),
    "another kind": ("X,Y,A [mm],q\n", (), InputError, "f.csv:1: 'A' in mm; expected deg or rad"),
    "no unit": ("X,Y,A,q [mm]\n", (), InputError, "f.csv:1: 'q' in mm; expected no unit"),
    "twice": ("X,Y,A,q,x\n", (), InputError,
              "f.csv:1: the header has to name each of the 4 columns once; a name appears twice"),
    "unknown with a unit": ("X,Y,A,qq [mm]\n", (), UnknownName,
                            "f.csv:1: 'qq' is neither a number nor a column; did you mean 'q'?"),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_a_header_that_contradicts_itself_or_the_user_is_refused(case):
    text, said, kind, message = REFUSED[case]
    with pytest.raises(kind) as caught:
        read(text, POSE._replace(said=said))
    assert str(caught.value) == message


def test_a_unit_that_was_said_and_stands_in_the_header_is_no_contradiction():
    rows = read("X [mm],Y [mm],A,q\n1,2,3,4\n", POSE._replace(said=("mm", "deg")))
    np.testing.assert_array_equal(rows, [[1, 2, 3, 4]])


def test_columns_that_come_first_have_no_unit_and_others_keep_theirs():
    columns = POSE._replace(first=("time",))
    rows = read("X [m],Y [m],A,q,time\n1,2,3,4,5\n", columns)
    np.testing.assert_array_equal(rows, [[5, 1000, 2000, 3, 4]])
    rows = read("X,Y,A,q,Time [s]\n1,2,3,4,5\n", columns._replace(units=()))
    np.testing.assert_array_equal(rows, [[5, 1, 2, 3, 4]])
    for text in ("q,A,Y,X\n4,3,2,1\n", "1,2,3,4\n"):
        np.testing.assert_array_equal(read(text, columns), [[1, 2, 3, 4]])
    with pytest.raises(InputError, match=r"^f\.csv:1: 'time' in deg; expected s$"):
        read("X,Y,A,q,time [deg]\n1,2,3,4,5\n", columns)


def test_a_unit_is_refused_where_nobody_knows_which_it_should_be():
    with pytest.raises(InputError, match=r"^f\.csv:1: 'X' in m; expected no unit$"):
        read("X [m],Y [m],A,q\n1,2,3,4\n", POSE._replace(units=()))


def test_columns_at_the_end_may_be_left_out_together():
    columns = POSE._replace(last=("A", "q"))
    np.testing.assert_array_equal(read("1,2\n", columns), [[1, 2]])
    np.testing.assert_array_equal(read("y,x\n1,2\n", columns), [[2, 1]])
    np.testing.assert_array_equal(read("1,2,3,4\n", columns), [[1, 2, 3, 4]])
    with pytest.raises(InputError, match="'q' is missing"):
        read("x,y,a\n", columns)
    for count in (1, 3, 5):
        words = rf"^f\.csv:1: 4 values expected \(X, Y, A, q\), got {count}$"
        with pytest.raises(InputError, match=words):
            read(",".join("1" * count) + "\n", columns)


def test_the_time_that_a_word_takes_grows_as_its_length():
    blanks = " " * 2**18  # three times after each other in a pattern, they would take days
    for word in (f"{blanks}({blanks}", f"X{blanks}[{blanks}mm", "(" * 2**18, "_" * 2**18):
        assert headings([word], POSE.names) == [(word, "")]
    assert headings([f"X{blanks}[{blanks}mm{blanks}]"], POSE.names) == [("X", "mm")]


def test_the_time_that_a_header_takes_grows_as_its_number_of_words():
    # each word held against each name, a hundred thousand would take minutes
    names = tuple(f"x{k}" for k in range(100_000))
    found = headings(names, names)
    assert [one.name for one in found] == list(names)
    assert order(found, Columns(names, "column"), "here") == list(range(len(names)))


JOINTS = Columns(("pan", "lift"), "coordinate", ("rad", "m"))


@pytest.mark.parametrize("header", ["q1,q2", "Q1,Q2", "joint_1,joint_2", "J0,J1"])
def test_coordinates_may_be_numbered_from_1_or_0(header):
    np.testing.assert_array_equal(read(f"{header}\n1,2\n", JOINTS), [[1, 2]])
    second_first = ",".join(reversed(header.split(",")))
    np.testing.assert_array_equal(read(f"{second_first}\n1,2\n", JOINTS), [[2, 1]])


def test_names_of_coordinates_are_numbered_from_1_and_then_from_0():
    assert numbered(0) == ()
    assert numbered(4) == ("q1", "q2", "q3", "q4")
    found = coordinate_names(("pan", "J1"))
    assert found[:3] == (("q1", "q2"), ("pan", "J1"), ("q0", "q1"))
    for stem in ("j", "joint", "joint_", "axis", "axis_", "theta"):
        for start in (1, 0):
            names = (f"{stem}{start}", f"{stem}{start + 1}")
            # j1 is a name of the chain's own, in another case
            assert (names in found) == (stem != "j")
    assert len(found) == 3 + 5 * 2


@pytest.mark.parametrize(
    ("words", "count"),
    [
        ("x y", 0),
        ("q1 q2 q3", 3),
        ("Q1 q1 q2 time", 2),
        ("joint_1_deg joint_2[rad] joint_3x q1", 2),
        ("axis1 axis2 theta1", 2),
        ("j10 j11 j1", 3),
    ],
)
def test_coordinates_that_a_header_numbers_are_counted_by_their_most_frequent_stem(words, count):
    assert numbered_coordinates(words.split()) == count


def test_numbered_coordinates_say_their_units():
    rows = read("joint_2 [mm],joint_1_deg\n5,180\n", JOINTS)
    np.testing.assert_array_equal(rows, [[np.pi, 0.005]])


def test_a_chain_s_own_names_come_before_numbers():
    own = JOINTS._replace(names=("q2", "q1"))
    np.testing.assert_array_equal(read("q1,q2\n1,2\n", own), [[2, 1]])
    np.testing.assert_array_equal(read("pan,lift\n1,2\n", JOINTS), [[1, 2]])


def test_numbers_of_two_kinds_and_other_columns_are_refused():
    with pytest.raises(UnknownName, match="'theta1' is neither a number nor a coordinate"):
        read("theta1,axis2\n1,2\n", JOINTS)
    with pytest.raises(UnknownName, match="'q1' is neither a number nor a column"):
        read("q1,q2\n1,2\n", JOINTS._replace(what="column"))
