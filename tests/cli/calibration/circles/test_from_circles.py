"""`poekin from-circles`: sweeps of one joint each in files, the arm out, and faults by file and line."""

from __future__ import annotations

import json

import numpy as np
import pytest

import poekin as pk
from poekin.errors import PoekinWarning
from poekin.formats.text.csv_header import numbered_coordinates
from poekin.groups import se3
from tests.solve.calibration.circles.sweeps import SCARA, sweep_all

HELD = np.array([0.1, 0.2, 0.05, -0.1])
NAMES = ["q1", "q2", "q3", "q4"]
ARM = ["from-circles", "--prismatic", "q3"]


def written(folder, sweeps, names=NAMES, scale=1.0):
    """A file of each sweep, with lengths in multiples of a metre."""
    paths = []
    for k, sweep in enumerate(sweeps):
        values = sweep.measured
        columns = ["x", "y", "z"]
        if sweep.has_poses:
            values = sweep.measured[:, :3].reshape(len(values), 12)
            columns = [f"T{i}{j}" for i in range(3) for j in range(4)]
        rows = np.column_stack([sweep.q, values * scale])
        path = folder / f"sweep{k}.csv"
        head = ",".join([*names, *columns])
        np.savetxt(path, rows, delimiter=",", header=head, comments="", fmt="%.17g")
        paths.append(path)
    return paths


@pytest.fixture
def files(tmp_path):
    return written(tmp_path, sweep_all(SCARA, HELD))


def change(path, line, column, value):
    lines = path.read_text().splitlines()
    cells = lines[line - 1].split(",")
    cells[column] = value
    lines[line - 1] = ",".join(cells)
    path.write_text("\n".join(lines))


def said(message):
    return message.replace("poekin: error: ", "").strip()


def test_files_in_any_order_make_the_arm_and_a_model_of_it(poekin, files, tmp_path):
    out = tmp_path / "arm.urdf"
    code, text, err = poekin(*ARM, *reversed(files), "-o", out)
    assert (code, err) == (0, "")
    lines = text.splitlines()
    assert lines[0] == "4 axes from sweeps of one joint each"
    assert [line.partition(": direction ± ")[0] for line in lines[1:5]] == NAMES
    assert lines[5:] == [f"written: '{out}'"]
    with pytest.warns(PoekinWarning, match="taken as unlimited: 'q3'"):
        arm = pk.load(out).chain()
    assert (arm.q_names, arm.base) == (tuple(NAMES), "device")
    q = np.random.default_rng(0).normal(size=(20, 4))
    places = [chain.fk(q)[:, :3, 3] for chain in (arm, SCARA)]
    # exact data: 1e-12 as of the library, and as much for rpy angles in the file
    np.testing.assert_allclose(*places, rtol=0, atol=1e-11)


def test_json_lists_what_was_written(as_json, files, tmp_path):
    out = tmp_path / "arm.urdf"
    assert as_json(*ARM, *files, "-o", out)["written"] == [str(out)]


def test_names_units_and_poses_are_as_said(as_json, tmp_path):
    sweeps = sweep_all(SCARA, HELD, poses=True)
    paths = written(tmp_path, sweeps, ["a", "b", "c", "d"])
    found = as_json("from-circles", *paths, "--joints", "a,b,c, d", "--prismatic", "c")
    assert found["chain"]["joint_names"] == ["a", "b", "c", "d"]
    assert (found["warnings"], found["written"]) == ([], [])
    np.testing.assert_allclose(found["chain"]["screws"], SCARA.screws, rtol=0, atol=1e-11)
    np.testing.assert_allclose(found["chain"]["home"], SCARA.home, rtol=0, atol=1e-11)
    points = written(tmp_path, sweep_all(SCARA, HELD), scale=1e3)
    for path in points:  # the joint that slides, too
        rows = np.loadtxt(path, delimiter=",", skiprows=1)
        rows[:, 2] *= 1e3
        head = path.read_text().partition("\n")[0]
        np.savetxt(path, rows, delimiter=",", header=head, comments="", fmt="%.17g")
    found = as_json(*ARM, *points, "--mm")
    np.testing.assert_allclose(found["chain"]["screws"], SCARA.screws, rtol=0, atol=1e-11)


def test_a_column_that_is_ignored_changes_nothing(as_json, refused, files):
    expected = as_json(*ARM, *files)
    for path in files:
        head, *rows = path.read_text().splitlines()
        path.write_text("\n".join([f"{head},note", *(f"{row},warm" for row in rows)]))
    assert as_json(*ARM, *files, "--ignore", "note") == expected
    assert "'note'" in refused(*ARM, *files)


def test_sweeps_that_do_not_agree_are_the_first_line_and_exit_code_1(poekin, tmp_path):
    other = SCARA.retooled(se3.pose(np.eye(3), [0.0, 0.0, 0.01]))
    sweeps = sweep_all(SCARA, HELD, noise=1e-6)
    sweeps[1] = sweep_all(other, HELD, noise=1e-6)[1]
    paths = written(tmp_path, sweeps)
    code, text, err = poekin(*ARM, *paths)
    assert (code, err) == (1, "")
    first, second, *_ = text.splitlines()
    where = f"'{paths[1]}', q2: its point is 10 mm from that of the others: "
    assert first.startswith(f"Do NOT use this arm: {where}")
    assert second == "4 axes from sweeps of one joint each"
    assert text.count("its point is") == 1
    code, text, _ = poekin(*ARM, *paths, "--json")
    assert code == 1
    (warning,) = json.loads(text)["warnings"]
    assert warning.startswith(where)


def test_a_joint_that_moved_too_is_named_with_file_and_line(refused, files):
    change(files[1], 6, 0, "0.3")
    expected = (
        f"'{files[1]}':6: q1 is off by 0.2 rad from where it stands; expected q2 alone to move, the others "
        "within 0.0001"
    )
    assert said(refused(*ARM, *files)) == expected.replace("'", "")
    change(files[1], 6, 0, "0.1")
    change(files[1], 6, 2, "0.0502")
    assert ":6: q3 is off by 0.0002 m from" in refused(*ARM, *files)


def test_a_cell_that_is_no_number_is_named_with_file_and_line(refused, files):
    change(files[2], 4, 4, "abc")
    assert f"{files[2]}:4" in refused(*ARM, *files)


@pytest.mark.parametrize(
    ("which", "message"),
    [
        ([0, 1, 2], "expected a sweep of each joint, there is none of 'q4'"),
        ([0, 1, 4, 2, 3], "{4}: q2 moves, as in {1}; one file a joint expected"),
    ],
)
def test_a_sweep_of_each_joint_is_expected_and_one(refused, files, which, message):
    files = [*files, files[1].with_name("again.csv")]
    files[4].write_bytes(files[1].read_bytes())
    places = [f"'{path}'" for path in files]
    assert said(refused(*ARM, *(files[k] for k in which))) == message.format(*places)


def test_files_of_another_kind_are_refused(refused, files, tmp_path):
    place = f"'{files[1]}'"
    files[1].write_text("q1,q2,x,y,z\n" + "".join(f"0.{k},0,{k},1,1\n" for k in range(5)))
    assert "--prismatic: no joint 'q3'" in refused(*ARM, *files)
    message = said(refused("from-circles", *files))
    assert message == f"{place}: columns of 2 joints, and of 4 in '{files[0]}'"
    message = said(refused("from-circles", files[1], *files[2:], files[0]))
    assert message == f"'{files[2]}': columns of 4 joints, and of 2 in {place}"
    files[1].write_text("q1,q2,q3,q4,x1,y1,z1,x2,y2,z2\n0,0,0,0,1,1,1,1,1,1\n")
    message = said(refused(*ARM, *files))
    assert message == f"{place}: expected one point a line, or poses, got x1, y1, z1, x2, y2, z2"
    files[1].write_text("q1,q2,q3,q4,x,y,z\n")
    assert said(refused(*ARM, *files)) == f"{place}: expected readings of a sweep, got none"
    files[1].write_text("x,y,z\n1,1,1\n")
    message = said(refused("from-circles", *files))
    assert message.endswith(
        ":1: expected columns of joints, q1, q2, ..., or --joints with their names, got 'x', 'y', 'z'"
    )
    assert "--prismatic: no joint 'q5'" in refused("from-circles", "--prismatic", "q5", *files[:1])


def test_degrees_and_sliding_joints_that_nobody_told_of_are_guessed(refused, files):
    for path in files[:1]:
        rows = np.loadtxt(path, delimiter=",", skiprows=1)
        rows[:, 0] = np.rad2deg(rows[:, 0])
        head = path.read_text().partition("\n")[0]
        np.savetxt(path, rows, delimiter=",", header=head, comments="", fmt="%.17g")
    message = said(refused(*ARM, *files))
    assert message.startswith(
        f"'{files[0]}', q1: its readings span 115 rad: are they in degrees? --deg"
    )


def test_a_joint_of_another_kind_is_told_with_the_option(refused, files):
    message = said(refused("from-circles", *files))
    assert message.startswith(f"'{files[2]}', q3: ")
    assert "kind of joint that it is said to be (--prismatic)" in message


def test_a_file_is_not_written_over_nor_another_kind_of_file(refused, files, tmp_path):
    assert "ends in .urdf" in refused(*ARM, *files, "-o", tmp_path / "a.toml")
    files[0].rename(tmp_path / "a.urdf")
    said_ = refused(*ARM, tmp_path / "a.urdf", *files[1:], "-o", tmp_path / "a.urdf")
    assert "it is the file of the sweeps" in said_


@pytest.mark.parametrize(
    ("words", "count"),
    [
        (["q1", "q2", "x", "y", "z"], 2),
        (["J1 [deg]", "j2_deg", "J3", "x1"], 3),
        (["joint_1", "joint_2", "q1"], 2),
        (["axis0", "axis1", "time"], 2),
        (["q1x", "T00", "distance"], 0),
    ],
)
def test_coordinates_are_counted_by_their_numbers(words, count):
    assert numbered_coordinates(words) == count
