"""--format, --mm and --deg of `fk`, `ik`, `follow` and `calibrate`: what goes in and what comes out."""

from __future__ import annotations

import csv as csv_module
import io
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.cli.formats.units import SaidUnits, beyond_limits
from poekin.formats.poses.layout import FORMATS, OF_CONTROLLERS, layout
from poekin.solve.calibration.measurements.simulated import simulated

ARM = pk.load("ur5e").chain(tip="tool0")
UR5E = ("ur5e", "--tip", "tool0")
Q = np.array([0.3, -1.2, 1.1, -0.4, 0.7, 0.2])
DEGREES = [30.0, -60.0, 45.0, 10.0, -20.0, 90.0]


def ordered(format):
    return ("--quaternion", "xyzw") if format in ("quat", "7") else ()


def numbers(T, format):
    return pk.poses.to_numbers(T, format, quaternion="xyzw" if ordered(format) else None)


def table(text):
    header, *rows = csv_module.reader(io.StringIO(text))
    return header, np.array(rows, float)


def test_a_pose_is_printed_as_matrix_position_quaternion_and_rpy(poekin):
    code, out, err = poekin("fk", *UR5E, *Q)
    assert (code, err) == (0, "")
    lines = out.splitlines()
    assert [line.split()[0] for line in lines[-3:]] == ["position", "quaternion", "rpy"]
    T = ARM.fk(Q)
    found = [np.array(line.split("(")[0].split()[1:], float) for line in lines[-3:]]
    rpy = pk.poses.to_numbers(T, "rpy", deg=True)[3:]
    expected = [T[:3, 3], pk.poses.to_numbers(T, "abb")[3:], rpy]
    for got, want in zip(found, expected, strict=True):
        np.testing.assert_allclose(got, want, rtol=1e-8, atol=1e-12)  # nine digits
    assert [line.rpartition("(")[2] for line in lines[-3:]] == [
        "x y z, m)",
        "w x y z)",
        "roll pitch yaw, deg)",
    ]


def test_in_millimetres_and_radians_position_and_rpy_are_so(poekin):
    _, out, _ = poekin("fk", *UR5E, *Q, "--mm", "--rad")
    lines = out.splitlines()
    assert lines[-3].endswith("(x y z, mm)")
    assert lines[-1].endswith("(roll pitch yaw, rad)")
    p = np.array(lines[-3].split("(")[0].split()[1:], float)
    np.testing.assert_allclose(p, 1000 * ARM.fk(Q)[:3, 3], rtol=1e-8)


@pytest.mark.parametrize("format", FORMATS)
def test_fk_prints_what_its_controller_and_ik_read(format, poekin, as_json):
    code, out, err = poekin("fk", *UR5E, *Q, "--format", format, *ordered(format))
    assert (code, err) == (0, "")
    assert f"({layout(format, 'xyzw' if ordered(format) else None).describe()}), at" in out
    text = out.splitlines()[-1].strip()
    order = "xyzw" if ordered(format) else None
    T = pk.poses.read(text, format, quaternion=order)
    np.testing.assert_allclose(T, ARM.fk(Q), rtol=0, atol=1e-11)  # twelve decimals
    start = ",".join(map(str, Q))
    words = ["--format", format, *ordered(format), "--q0", start]
    for given in ([text], text.split() if text[0] in "-0123456789" else [text]):
        found = as_json("ik", *UR5E, *words, *given)
        np.testing.assert_allclose(ARM.fk(found["q"]), ARM.fk(Q), rtol=0, atol=1e-8)


@pytest.mark.parametrize("format", FORMATS)
def test_many_poses_go_through_files_in_every_format(format, poekin, tmp_path):
    q = np.random.default_rng(1).uniform(-1, 1, (4, 6))
    np.save(tmp_path / "q.npy", q)
    words = ["--format", format, *ordered(format)]
    expected = numbers(ARM.fk(q), format)
    code, out, _ = poekin("fk", *UR5E, "--input", tmp_path / "q.npy", *words)
    header, rows = table(out)
    assert code == 0
    assert header == list(layout(format, "xyzw" if ordered(format) else None).columns)
    np.testing.assert_allclose(rows, expected, rtol=0, atol=1e-12)
    (tmp_path / "T.csv").write_text(out)
    for name in ("T.npy", "T.json"):
        assert (
            poekin("fk", *UR5E, "--input", tmp_path / "q.npy", *words, "--output", tmp_path / name)[
                0
            ]
            == 0
        )
    document = json.loads((tmp_path / "T.json").read_text())
    assert document["format"] == format
    np.testing.assert_array_equal(document["numbers"], np.load(tmp_path / "T.npy"))
    np.testing.assert_allclose(document["T"], ARM.fk(q), rtol=0, atol=1e-12)
    for name in ("T.csv", "T.npy"):
        code, out, _ = poekin("ik", *UR5E, "--input", tmp_path / name, *words, "--json")
        assert code == 0
        np.testing.assert_allclose(ARM.fk(json.loads(out)["q"]), ARM.fk(q), rtol=0, atol=1e-8)


def test_degrees_and_millimetres_of_joints_go_in_and_out(crane, poekin, as_json, tmp_path):
    chain = pk.load(crane).chain(tip="hook")
    q = [np.radians(30), 0.25]
    given = as_json("fk", crane, "--tip", "hook", "--deg", "--mm", 30, 250)
    np.testing.assert_allclose(given["q"], q, rtol=0, atol=2e-16)
    np.testing.assert_allclose(given["T"], chain.fk(q), rtol=0, atol=1e-15)
    _, out, _ = poekin("fk", crane, "--tip", "hook", "--deg", "--mm", 30, 250)
    assert out.splitlines()[1:3] == ["  turn = 30 deg", "  slide = 250 mm"]
    (tmp_path / "q.csv").write_text("turn,slide\n30,250\n")
    (tmp_path / "units.csv").write_text("Slide [mm];turn_deg\n250;30,0\n")
    for name, said in (("q.csv", ["--deg", "--mm"]), ("units.csv", []), ("units.csv", ["--deg"])):
        _, out, err = poekin("fk", crane, "--tip", "hook", "--input", tmp_path / name, *said)
        assert err == ""
        np.testing.assert_allclose(table(out)[1].reshape(4, 4), chain.fk(q), rtol=0, atol=1e-15)


def test_json_of_many_configurations_is_in_radians_and_metres(crane, as_json, tmp_path):
    (tmp_path / "q.csv").write_text("180,500\n90,250\n")
    found = as_json("fk", crane, "--tip", "hook", "--deg", "--mm", "--input", tmp_path / "q.csv")
    np.testing.assert_array_equal(found["q"], [[np.pi, 0.5], [np.pi / 2, 0.25]])


def test_ik_gives_joints_in_the_units_that_are_said_and_fk_reads_them(poekin, tmp_path):
    T = ARM.fk(np.radians(DEGREES))
    text = pk.poses.write(T, "kuka")
    start = ",".join(map(str, DEGREES))
    words = [*UR5E, "--format", "kuka", "--deg", "--q0", start]
    code, out, _ = poekin("ik", *words, text)
    assert code == 0
    found = [line.split(" = ")[1].split() for line in out.splitlines()[1:]]
    assert {unit for _, unit in found} == {"deg"}
    np.testing.assert_allclose([float(x) for x, _ in found], DEGREES, rtol=0, atol=1e-6)
    (tmp_path / "T.txt").write_text(text)
    code, out, _ = poekin(
        "ik", *words, "--input", tmp_path / "T.txt", "--output", tmp_path / "q.csv"
    )
    header, rows = table((tmp_path / "q.csv").read_text())
    assert header[:6] == [f"{name} [deg]" for name in ARM.q_names]
    np.testing.assert_allclose(rows[0, :6], DEGREES, rtol=0, atol=1e-6)
    for said in ([], ["--deg"]):
        _, out, err = poekin("fk", *UR5E, "--input", tmp_path / "q.csv", *said)
        assert err == ""
        np.testing.assert_allclose(table(out)[1].reshape(4, 4), T, rtol=0, atol=1e-8)
    code, _, err = poekin("fk", *UR5E, "--input", tmp_path / "q.csv", "--rad")
    assert code == 2
    assert (
        "the header says that 'shoulder_pan_joint' is in deg, and it was said to be in rad" in err
    )


def test_follow_reads_what_a_controller_prints_and_gives_joints_in_degrees(poekin, tmp_path):
    q = np.linspace(Q, Q + 0.05, 4)
    (tmp_path / "path.src").write_text(
        "\n".join(f"LIN {line}" for line in pk.poses.write(ARM.fk(q), "kuka").split("\n"))
    )
    start = ",".join(map(str, np.degrees(Q)))
    words = [*UR5E, "--input", tmp_path / "path.src", "--format", "kuka", "--deg", "--q0", start]
    code, out, _ = poekin("follow", *words, "--duration", 2, "--speed", 60)
    header, rows = table(out)
    assert code == 0
    assert header == ["time", *(f"{name} [deg]" for name in ARM.q_names)]
    np.testing.assert_allclose(ARM.fk(np.radians(rows[:, 1:])), ARM.fk(q), rtol=0, atol=1e-8)
    code, out, err = poekin("follow", *words, "--duration", 2, "--speed", 0.1)
    assert code == 1
    assert "exceeds its speed" in err


def test_calibrate_reads_a_controllers_file_as_its_own(poekin, tmp_path):
    made: Any = simulated(ARM, 40, noise=(1e-4, 1e-4), seed=1)
    pk.calibration.write(tmp_path / "si.csv", ARM, made.q, made.measurements)
    rows = np.column_stack([np.degrees(made.q), numbers(made.measurements.T, "kuka")])
    names = [f"{name} (deg)" for name in ARM.q_names]
    lines = [";".join([*names, *"XYZABC"])]
    lines += [";".join(repr(x).replace(".", ",") for x in row) for row in rows.tolist()]
    (tmp_path / "kuka.csv").write_text("\n".join(lines))
    words = ["calibrate", *UR5E, "--folds", 0]
    assert poekin(*words, tmp_path / "si.csv", "-o", tmp_path / "si.toml")[0] == 0
    code, _, err = poekin(
        *words, tmp_path / "kuka.csv", "--format", "kuka", "-o", tmp_path / "kuka.toml"
    )
    assert (code, err) == (0, "")
    a, b = (pk.calibration.load(tmp_path / name).chain for name in ("si.toml", "kuka.toml"))
    # the same least squares, of numbers that differ in their last digit
    np.testing.assert_allclose(a.screws, b.screws, rtol=0, atol=1e-9)
    np.testing.assert_allclose(a.home, b.home, rtol=0, atol=1e-9)


def test_joints_beyond_their_limits_are_told_with_the_cure(poekin):
    code, out, err = poekin("fk", *UR5E, 0, -90, 90, 0, 0, 0)
    assert code == 0
    assert out.startswith("pose of tool0 in base (m), at")
    assert err == (
        "poekin: warning: shoulder_lift_joint = -90 rad is outside its limits, -6.28319 to 6.28319;"
        " are these degrees? --deg says so\n"
    )
    assert poekin("fk", *UR5E, "--deg", 0, -90, 90, 0, 0, 0)[2] == ""
    _, _, err = poekin("fk", *UR5E, "--deg", 0, -400, 90, 0, 0, 0)
    assert (
        err
        == "poekin: warning: shoulder_lift_joint = -400 deg is outside its limits, -360 to 360\n"
    )


def test_of_many_configurations_the_first_beyond_the_limits_is_named(crane, poekin, tmp_path):
    (tmp_path / "q.csv").write_text("0.1,0.5\n0.2,250\n0.2,500\n")
    _, _, err = poekin("fk", crane, "--tip", "hook", "--input", tmp_path / "q.csv")
    assert err == (
        "poekin: warning: 2 of 3 configurations are beyond limits; in the first, row 1, slide ="
        " 250 m is outside its limits, 0 to 1; are these mm? --mm says so\n"
    )
    chain = pk.load(crane).chain(tip="hook")
    assert beyond_limits(chain, np.array([[100.0, 1 + 1e-10]]), SaidUnits()) == ""  # of rounding
    assert beyond_limits(chain, np.array([[0.0, 1.1]]), SaidUnits(mm=True)).endswith("0 to 1000")
    assert beyond_limits(chain, np.empty((0, 2)), SaidUnits()) == ""


def test_a_target_in_millimetres_is_told_to_be(poekin, tmp_path):
    code, _, err = poekin("ik", *UR5E, "--format", "rpy", "--", 400, 100, 300, 0, 0, 0)
    assert code == 1
    assert "as one in millimetres would be; poses are in m (of files in mm, --mm says so)" in err
    code, _, _ = poekin("ik", *UR5E, "--format", "rpy", "--mm", "--", 400, 100, 300, 0, 0, 0)
    assert code == 0
    (tmp_path / "T.csv").write_text("400,100,300,0,0,0\n" * 3)
    code, _, err = poekin("follow", *UR5E, "--format", "rpy", "--input", tmp_path / "T.csv")
    assert code == 1
    assert "millimetres" in err


def test_a_pose_out_of_a_pipe_is_read_as_ros_prints_it(poekin, monkeypatch, tmp_path):
    text = pk.poses.write(ARM.fk(Q), "ros")
    (tmp_path / "in").write_text(text)
    with open(tmp_path / "in") as stream:
        monkeypatch.setattr("sys.stdin", stream)
        code, out, _ = poekin("ik", *UR5E, "--format", "ros", "--input", "-", "--json")
    assert code == 0
    np.testing.assert_allclose(ARM.fk(json.loads(out)["q"])[0], ARM.fk(Q), rtol=0, atol=1e-8)


WRONG = {
    "fk: no format": (["fk", *UR5E, *Q, "--format", "euler"], "--format: expected one of matrix, quat"),
    "fk: no order": (["fk", *UR5E, *Q, "--format", "quat"], "--quaternion: the format quat needs the order"),
    "fk: an order of nothing": (["fk", *UR5E, *Q, "--quaternion", "wxyz"],
                                "--format: expected one of matrix, quat"),
    "fk: an order for kuka": (["fk", *UR5E, *Q, "--format", "kuka", "--quaternion", "wxyz"],
                              "--quaternion: the format kuka does not take an order"),
    "fk: a header in rad": (["fk", *UR5E, "--input", "rad.csv", "--deg"],
                            "the header says that 'shoulder_pan_joint' is in rad"),
    "ik: metres for kuka": (["ik", *UR5E, "--format", "kuka", "--m", *range(6)],
                            "--format: kuka is in mm and deg, m was said"),
    "fk: millimetres for ur": (["fk", *UR5E, *Q, "--format", "ur", "--mm"],
                               "--format: ur is in m and rad, mm was said; the format rotvec takes other units"),
    "ik: two poses": (["ik", *UR5E, "--format", "ur", "p[1,2,3,0,0,0]\np[1,2,3,0,0,0]"], "one pose expected, got 2"),
    "ik: a part": (["ik", *UR5E, "--format", "kuka", "{A 30}"], "the pose:1: expected X, Y, Z, A, B, C; X is missing"),
    "ik: seven": (["ik", *UR5E, "--format", "abc", *range(7)],
                  "the pose:1: 6 values expected (X, Y, Z, A, B, C), got 7"),
    "ik: commas": (["ik", *UR5E, "--format", "abc", "--input", "commas.csv"],
                   "with decimal commas, write ; between the columns"),
    "follow: no file": (["follow", *UR5E, "--format", "abc", "--input", "none.csv"], "cannot read 'none.csv'"),
    "follow: another header": (["follow", *UR5E, "--format", "abc", "--input", "wpr.csv"],
                               "'W' is neither a number nor a column"),
    "follow: units": (["follow", *UR5E, "--format", "wpr", "--m", "--input", "wpr.csv"],
                      "the header says that 'X' is in mm"),
    "calibrate: no format": (["calibrate", *UR5E, "rad.csv", "--format", "KUKA"], "--format: expected one of matrix"),
    "calibrate: units": (["calibrate", *UR5E, "rad.csv", "--format", "abc", "--deg"],
                         "the header says that 'shoulder_pan_joint' is in rad"),
    "calibrate: another format": (["calibrate", *UR5E, "wpr.csv", "--format", "abc"], "no column for the coordinate"),
}  # fmt: skip


@pytest.mark.parametrize("case", WRONG)
def test_a_wrong_format_or_unit_is_exit_code_2_with_one_message_and_nothing_written(
    case, poekin, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    names = ",".join(f"{name} [rad]" for name in ARM.q_names)
    texts = {
        "rad.csv": f"{names},X,Y,Z,A,B,C\n" + ",".join("0" * 12) + "\n",
        "commas.csv": "1,5,2,5,3,5,0,1,0,1,0,1\n",
        "wpr.csv": "X [mm],Y [mm],Z [mm],W,P,R\n500,0,300,0,0,0\n",
    }
    words, message = WRONG[case]
    if words[0] == "fk":
        texts["rad.csv"] = f"{names}\n0,0,0,0,0,0\n"
    for name, text in texts.items():
        Path(name).write_text(text)
    output = "out.toml" if words[0] == "calibrate" else "out.csv"
    code, out, err = poekin(*words, "--output", output)
    assert (code, out) == (2, "")
    assert message in err
    assert err.count("\n") == 1
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(texts)


def test_a_controllers_units_are_its_own_and_degrees_of_fk_those_of_the_joints(as_json):
    for format in OF_CONTROLLERS:
        found = as_json("fk", *UR5E, "--deg", *DEGREES, "--format", format)
        assert found["units"] == list(layout(format).units)
        np.testing.assert_allclose(
            found["numbers"], numbers(ARM.fk(np.radians(DEGREES)), format), rtol=0, atol=1e-12
        )
    found = as_json("fk", *UR5E, "--deg", *DEGREES, "--format", "rpy")
    assert found["units"] == ["m", "m", "m", "deg", "deg", "deg"]


@pytest.mark.parametrize("format", OF_CONTROLLERS)
def test_degrees_are_those_of_the_joints_where_poses_of_a_controller_come_in(
    format, poekin, tmp_path
):
    text = pk.poses.write(ARM.fk(np.radians([DEGREES, DEGREES])), format)
    (tmp_path / "path.txt").write_text(text)
    words = [*UR5E, "--format", format, "--deg", "--q0", ",".join(map(str, DEGREES))]
    for command in ("ik", "follow"):
        code, out, _ = poekin(command, *words, "--input", tmp_path / "path.txt")
        header, rows = table(out)
        assert code == 0
        assert header[0] == f"{ARM.q_names[0]} [deg]"
        # rx ry rz of ur are written in rad, to as many digits as a float has; abb's are quaternions
        np.testing.assert_allclose(rows[0, :6], DEGREES, rtol=0, atol=1e-4)


@pytest.mark.parametrize("command", ["ik", "follow"])
def test_joints_in_an_array_are_in_the_units_that_are_said(command, poekin, tmp_path):
    (tmp_path / "path.txt").write_text(pk.poses.write(ARM.fk(np.radians([DEGREES] * 2)), "kuka"))
    words = [*UR5E, "--format", "kuka", "--deg", "--q0", ",".join(map(str, DEGREES))]
    given = ["--input", tmp_path / "path.txt", "--output", tmp_path / "q.npy"]
    assert poekin(command, *words, *given)[0] == 0
    np.testing.assert_allclose(np.load(tmp_path / "q.npy"), [DEGREES] * 2, rtol=0, atol=1e-4)
