"""Measurements in CSV files: what is written is read, columns say what they are, and bad cells are
named.
"""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import FileError, InputError, PoseError, ShapeError, UnknownName
from poekin.formats.text import csv_rows
from poekin.solve.calibration.measurements import columns, data
from poekin.solve.calibration.measurements.points import Distances, Points
from poekin.solve.calibration.measurements.poses import EyeInHand, EyeToHand, Poses
from poekin.solve.calibration.measurements.simulated import simulated
from poekin.testing.strategies import chain_strategies

UP = pk.screw.revolute([0, 0, 1], [0, 0, 0])
ONE = pk.Chain.from_space([UP], np.eye(4), joint_names=["shoulder"])
TWO = pk.Chain.from_space(
    [UP, pk.screw.prismatic([1, 0, 0])], np.eye(4), joint_names=["shoulder", "slide"]
)
GANTRY = pk.Chain.from_space(
    [pk.screw.prismatic(axis) for axis in np.eye(3)], np.eye(4), joint_names=["x", "y", "z"]
)
T_COLUMNS = ",".join(f"T{i}{j}" for i in range(3) for j in range(4))
T_ROW = "1,0,0,4,0,1,0,5,0,0,1,6"
TOOL = np.array([[0.1, 0, 0], [0, 0.1, 0.0]])


def file(tmp_path, text: str):
    path = tmp_path / "a.csv"
    path.write_text(text, encoding="utf-8")
    return path


WAYS = [
    ("poses", {}, {}),
    ("eye-in-hand", {}, {}),
    ("eye-to-hand", {}, {}),
    ("points", {}, {}),
    ("points", {"points": TOOL, "unknown": True}, {"points": TOOL, "frame": "unknown"}),
    ("distances", {}, {"centre": [1, 2, 3]}),
]


@given(way=st.sampled_from(WAYS), arm=chain_strategies.chains(max_joints=8), n=st.integers(1, 5))
def test_what_is_written_is_read_to_the_last_bit(way, arm, n, tmp_path_factory):
    kind, options, known = way
    made = simulated(arm, n, kind=kind, **options)
    path = tmp_path_factory.mktemp("csv") / "a.csv"
    data.write(path, arm, made.q, made.measurements)
    q, measurement = data.read(
        path, arm, kind=kind, covariance=made.measurements.covariance, **known
    )
    np.testing.assert_array_equal(q, made.q)
    assert type(measurement) is type(made.measurements)
    name = {"points": "p", "distances": "d"}.get(kind, "T")
    np.testing.assert_array_equal(getattr(measurement, name), getattr(made.measurements, name))
    np.testing.assert_array_equal(measurement.covariance, made.measurements.covariance)


@pytest.mark.parametrize(
    ("columns", "row", "expected"),
    [
        (T_COLUMNS, T_ROW, Poses),
        (T_COLUMNS + ",T30,T31,T32,T33", T_ROW + ",0,0,0,1", Poses),
        ("qx,qy,qz,qw,z,y,x", "0,0,0,1,6,5,4", Poses),
        ("x,y,z", "4,5,6", Points),
        ("pz,py,px", "6,5,4", Points),
        ("z1,x1,y1", "6,4,5", Points),
        ("distance", "4", Distances),
    ],
    ids=["12", "16", "7", "x", "p", "x1", "distance"],
)
def test_the_columns_say_what_was_measured_in_any_order(columns, row, expected, tmp_path):
    q, measurement = data.read(file(tmp_path, f"slide,{columns},shoulder\n0.5,{row},0.25\n"), TWO)
    np.testing.assert_array_equal(q, [[0.25, 0.5]])
    assert type(measurement) is expected
    if isinstance(measurement, Poses):
        np.testing.assert_array_equal(
            np.asarray(measurement.T)[0], [[1, 0, 0, 4], [0, 1, 0, 5], [0, 0, 1, 6], [0, 0, 0, 1]]
        )
    elif isinstance(measurement, Points):
        np.testing.assert_array_equal(measurement.p, [[[4, 5, 6]]])


def test_a_quaternion_is_read_by_its_names(tmp_path):
    half = np.sqrt(0.5)
    for names, row in (("qw,qx,qy,qz", [half, 0, 0, half]), ("qx,qy,qz,qw", [0, 0, half, half])):
        text = f"q1,x,y,z,{names}\n0,0,0,0,{','.join(map(str, row))}\n"
        T = np.asarray(data.read(file(tmp_path, text), ONE)[1].T)  # type: ignore[attr-defined]
        np.testing.assert_allclose(
            T[0, :3, :3], [[0, -1, 0], [1, 0, 0], [0, 0, 1]], rtol=0, atol=1e-15
        )


@pytest.mark.parametrize(
    ("kind", "expected"), [("eye-in-hand", EyeInHand), ("eye-to-hand", EyeToHand)]
)
def test_poses_are_those_of_a_camera_where_it_is_said(kind, expected, tmp_path):
    _, measurement = data.read(file(tmp_path, f"q1,{T_COLUMNS}\n0,{T_ROW}\n"), ONE, kind=kind)
    assert type(measurement) is expected


def test_coordinates_go_by_their_names_or_by_number(tmp_path):
    for names in ("shoulder,slide", "q1,q2"):
        q, _ = data.read(file(tmp_path, f"{names},distance\n1,2,3\n"), TWO)
        np.testing.assert_array_equal(q, [[1, 2]])


@pytest.mark.parametrize(
    ("header", "kind"),
    [("x,y,z,px,py,pz", Points), ("q1,q2,q3,x,y,z", Points), ("x,y,z,distance,t,u", Distances)],
    ids=["own", "numbered", "distance"],
)
def test_coordinates_named_x_y_z_are_no_measured_point(header, kind, tmp_path):
    q, measurement = data.read(
        file(tmp_path, f"{header}\n1,2,3,4,5,6\n"), GANTRY, ignore=["t", "u"]
    )
    np.testing.assert_array_equal(q, [[1, 2, 3]])
    assert type(measurement) is kind


def test_a_gantry_is_written_so_that_it_can_be_read(tmp_path):
    path = tmp_path / "a.csv"
    data.write(path, GANTRY, [[1, 2, 3]], Points(np.array([[4.0, 5, 6]])))
    assert path.read_text(encoding="utf-8") == "q1,q2,q3,x,y,z\n1.0,2.0,3.0,4.0,5.0,6.0\n"


def test_coordinates_are_written_under_the_arms_own_names(tmp_path):
    path = tmp_path / "a.csv"
    data.write(path, TWO, [[1, 2]], Distances([3.0]))
    assert path.read_text(encoding="utf-8") == "shoulder,slide,distance\n1.0,2.0,3.0\n"


def test_of_q_the_rows_are_written_that_were_measured(tmp_path):
    path = tmp_path / "a.csv"
    data.write(path, ONE, [[1], [2], [3]], Distances([7.0, 8.0], rows=[2, 0]))
    q, measurement = data.read(path, ONE)
    np.testing.assert_array_equal(q, [[3], [1]])
    np.testing.assert_array_equal(measurement.d, [7, 8])  # type: ignore[attr-defined]


def test_ignored_columns_may_hold_anything(tmp_path):
    text = 'time,q1,distance,picture\n,1,2,"a\nb"\nnan,3,4,\n'
    q, _ = data.read(file(tmp_path, text), ONE, ignore=("time", "picture"))
    np.testing.assert_array_equal(q, [[1], [3]])
    q, _ = data.read(file(tmp_path, "q1,distance,note\n1,2,x\n"), ONE, ignore="note")
    np.testing.assert_array_equal(q, [[1]])


POSE = f"q1,{T_COLUMNS}"


@pytest.mark.parametrize(
    ("text", "options", "error", "message"),
    [
        (
            "",
            {},
            InputError,
            "a.csv: a first line that names the columns expected, the file is empty",
        ),
        (
            "1,2\n",
            {},
            InputError,
            "a.csv:1: a first line that names the columns expected, it has numbers alone",
        ),
        (
            "distance\n1\n",
            {},
            InputError,
            "a.csv:1: no column for the coordinate 'q1'; expected 'shoulder', or q1 ... q1; available: 'distance', "
            "of which rename= says what they are",
        ),
        (
            "q1\n1\n",
            {},
            InputError,
            (
                "a.csv:1: no column of a measurement; expected T00 ... T23, or x y z qw qx qy qz, or "
                "x y z roll pitch yaw, or x y z, or x1 y1 z1 x2 ..., or distance"
            ),
        ),
        (
            "q1,force\n1,2\n",
            {},
            UnknownName,
            (
                "a.csv:1: 'force' is neither a coordinate nor part of a measurement (T00 ... T23, or "
                "x y z qw qx qy qz, or x y z roll pitch yaw, or x y z, or x1 y1 z1 x2 ..., or distance); "
                "available: 'T00', 'T01', 'T02' and 45 more; rename= says what it is, ignore=['force'] passes it over"
            ),
        ),
        (
            "q1,distanse\n1,2\n",
            {},
            UnknownName,
            (
                "a.csv:1: 'distanse' is neither a coordinate nor part of a measurement (T00 ... T23, "
                "or x y z qw qx qy qz, or x y z roll pitch yaw, or x y z, or x1 y1 z1 x2 ..., or distance); "
                "did you mean 'distance'?; rename= says what it is, ignore=['distanse'] passes it over"
            ),
        ),
        (
            "q1,distance,t\n1,2,3\n",
            {},
            UnknownName,
            "a.csv:1: the column 't' is neither a coordinate nor one of distance; ignore=['t'] passes it over",
        ),
        (
            "q1,distance,x,y,z\n1,2,3,4,5\n",
            {},
            UnknownName,
            (
                "a.csv:1: the column 'distance' is neither a coordinate nor one of x y z; "
                "ignore=['distance'] passes it over"
            ),
        ),
        ("q1,q1,distance\n1,1,2\n", {}, InputError, "a.csv:1: the column 'q1' is there 2 times"),
        (POSE[:-4] + "\n", {}, InputError, "a.csv:1: of the columns T00 ... T23, 'T23' is missing"),
        ("q1,x,y\n1,2,3\n", {}, InputError, "a.csv:1: of the columns x y z, 'z' is missing"),
        (
            "q1,x1,y1,z1,x2,y2\n1,2,3,4,5,6\n",
            {},
            InputError,
            "a.csv:1: of the columns x1 y1 z1 x2 y2 z2, 'z2' is missing",
        ),
        (
            "q1,x99999,y1,z1\n1,2,3,4\n",
            {},
            InputError,
            "a.csv:1: of the columns x1 ... z3, 'x1' is missing",
        ),
        ("q1,distance\n\n1,\n", {}, InputError, "a.csv:3, column 2: a number expected, got ''"),
        ("q1,distance\n1,far\n", {}, InputError, "a.csv:2, column 2: a number expected, got 'far'"),
        (
            "q1,distance\n1,2\nnan,2\n",
            {},
            InputError,
            "a.csv:3, column 'q1': expected a finite number, got nan; leave the line out where nothing was measured",
        ),
        (
            "q1,distance\n1,inf\n",
            {},
            InputError,
            (
                "a.csv:2, column 'distance': expected a finite number, got inf; leave the line out "
                "where nothing was measured"
            ),
        ),
        (
            "q1,distance\n1,2\n1,2,3\n",
            {},
            InputError,
            "a.csv:3: 2 values expected, as the header has, got 3",
        ),
        (
            "q1,distance\n1,2\n\n1,-2\n",
            {},
            InputError,
            "a.csv:4: expected a distance above 0, got -2",
        ),
        (
            POSE + "\n0," + T_ROW.replace("1", "2") + "\n",
            {},
            PoseError,
            "a.csv:2: its rotation misses orthonormality, max abs(R R^T - I) = 3, accepted up to 1e-05",
        ),
        (
            "q1,x,y,z,qw,qx,qy,qz\n0,0,0,0,2,0,0,0\n",
            {},
            PoseError,
            "a.csv:2: the quaternion's length is 2, expected 1 within 0.001",
        ),
        (
            "q1,distance\n1,2\n",
            {"kind": "poses"},
            InputError,
            "a.csv:1: the columns distance are those of distances, and kind is 'poses'",
        ),
        (
            POSE + "\n",
            {"kind": "points"},
            InputError,
            "a.csv:1: the columns T00 ... T23 are those of poses or eye-in-hand or eye-to-hand, and kind is 'points'",
        ),
        (
            POSE + "\n",
            {"kind": "pose"},
            InputError,
            "kind: expected 'poses', 'eye-in-hand', 'eye-to-hand', 'points' or 'distances', got 'pose'",
        ),
        (
            "q1,x1,y1,z1,x2,y2,z2\n1,2,3,4,5,6,7\n",
            {},
            InputError,
            "points: the file has 2 points a line; say where they are in the tip frame, (k, 3), or points=None",
        ),
        (
            "q1,distance\n1,2\n",
            {"points": TOOL},
            UnknownName,
            "'points' is nothing that distances have; did you mean 'point'?",
        ),
        (
            "q1,distance\n1,2\n",
            {"rows": [0]},
            UnknownName,
            "'rows' is nothing that distances have; available: 'centre', 'point', 'covariance', 'guess'",
        ),
    ],
    ids=[
        *(
            "empty",
            "no header",
            "no coordinate",
            "no measurement",
            "unknown",
            "near",
            "extra",
            "two kinds",
            "twice",
        ),
        *(
            "T23",
            "xy",
            "z2",
            "many",
            "blank",
            "word",
            "nan",
            "inf",
            "long",
            "negative",
            "matrix",
            "quaternion",
            "kind",
        ),
        *("kind of poses", "no kind", "no points", "not known", "rows"),
    ],
)
def test_a_bad_file_is_refused_with_its_line(text, options, error, message, tmp_path):
    with pytest.raises(error) as caught:
        data.read(file(tmp_path, text), ONE, **options)
    assert str(caught.value).replace(f"{tmp_path}/", "") == message


def test_what_cannot_be_read_is_said(tmp_path):
    with pytest.raises(FileError, match=r"cannot read .*no\.csv: No such file"):
        data.read(tmp_path / "no.csv", ONE)
    (tmp_path / "b.csv").write_bytes(b"q1,distance\n\xff")
    with pytest.raises(FileError, match=r"b\.csv is no text file: byte 12 is not UTF-8"):
        data.read(tmp_path / "b.csv", ONE)
    with pytest.raises(FileError, match=r"a\.csv:2: not CSV: field larger than"):
        data.read(file(tmp_path, "q1,distance\n" + "1" * 200_000), ONE)


def test_what_does_not_fit_is_not_written(tmp_path):
    d, path = Distances([1.0, 2.0]), tmp_path / "a.csv"
    for q, rows in (([[1]], None), ([[1], [2], [3]], None), ([1, 2], None), ([[1]], [0, 1])):
        with pytest.raises(ShapeError, match=r"q: expected .*, got"):
            data.write(path, ONE, q, Distances([1.0, 2.0], rows=rows))
    with pytest.raises(InputError, match=r"^q\[1, 0\]: expected a finite number, got nan$"):
        data.write(path, ONE, [[1], [np.nan]], d)
    with pytest.raises(
        InputError,
        match=r"^measurement: expected one of Poses, EyeInHand, EyeToHand, Points, Distances, got 'd'$",
    ):
        data.write(path, ONE, [[1]], "d")  # type: ignore[arg-type]
    assert not path.exists()


def test_a_long_file_is_read_in_parts_in_its_order(tmp_path):
    count, told = 3 * csv_rows.AT_ONCE // 2, []
    path = tmp_path / "a.csv"
    d = np.arange(1.0, count + 1)
    data.write(path, ONE, d[:, None], Distances(d))
    q, measurement = data.read(path, ONE, progress=lambda done, size: told.append((done, size)))
    np.testing.assert_array_equal(q[:, 0], d)
    np.testing.assert_array_equal(measurement.d, d)  # type: ignore[attr-defined]
    size = path.stat().st_size
    assert [total for _, total in told] == [size]
    assert 0 < told[0][0] < size


@pytest.mark.parametrize("count, said", [
    (1, "x1 y1 z1"), (2, "x1 y1 z1 x2 y2 z2"), (3, "x1 ... z3"),
])  # fmt: skip
def test_up_to_seven_columns_are_named_and_of_more_the_first_and_last(count, said):
    assert columns.describe(columns._points({f"x{count}", *"abcdefgh"})) == said
    assert columns.describe(columns.STANDARD[2]) == "x y z qw qx qy qz"


def test_the_coordinates_that_are_missing_are_those_of_the_names_that_are_there(tmp_path):
    """By the chain's own names where more of these are there than of q1, q2; by number where none
    or as many are.
    """
    for header, missing in (("shoulder,distance", "slide"), ("q1,distance", "q2"), ("distance", "q1"),
                            ("shoulder,q1,distance", "q2")):  # fmt: skip
        with pytest.raises(InputError, match=f"no column for the coordinate '{missing}'; expected 'shoulder', 'slide', "
                           "or q1 ... q2; available: "):  # fmt: skip
            data.read(file(tmp_path, f"{header}\n"), TWO)


def test_of_the_columns_that_make_a_measurement_the_most_are_taken_for_it(tmp_path):
    for rest, said in (
        ("x,y,z,distance", "x y z"),
        ("distance,px,py,pz,x", "px py pz"),
        ("x1,y1,z1,distance", "x1 y1 z1"),
    ):
        with pytest.raises(
            UnknownName, match=f"is neither a coordinate nor one of {said}; ignore="
        ):
            data.read(file(tmp_path, f"q1,{rest}\n"), ONE)
