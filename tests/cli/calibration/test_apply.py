"""`poekin apply`: a calibration in, the user's own URDF out, with other origins and axes."""

from __future__ import annotations

import re

import numpy as np
import pytest

import poekin as pk
from poekin.solve.calibration.measurements.simulated import simulated
from tests.formats.urdf_in_place.in_place_cases import (
    ARM,
    moved_joints,
    quietly,
    read,
    without,
)

pytest.importorskip("tomli_w")


@pytest.fixture
def arm(tmp_path):
    path = tmp_path / "mine.urdf"
    path.write_bytes(ARM.encode())
    return path


def calibration(path, nominal, seed=0):
    """A file with a calibration of a chain, whose poses were measured, and the chain that was found."""
    made = simulated(nominal, 20, tilt=1e-3, shift=1e-3, noise=(1e-5, 1e-5), seed=seed)
    found = pk.calibrate(nominal, made.q, made.measurements, folds=0)
    found.save(path)
    return found.chain


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A calibration of the arm to its hand: file and chain."""
    path = tmp_path_factory.mktemp("made") / "c.toml"
    return path, calibration(path, read(ARM).chain(tip="hand"))


@pytest.fixture
def chain(made):
    return made[1]


@pytest.fixture
def toml(made, tmp_path):
    path = tmp_path / "c.toml"
    path.write_bytes(made[0].read_bytes())
    return path


def test_a_calibration_goes_into_the_user_s_own_text(poekin, arm, toml, chain, tmp_path):
    out = tmp_path / "out.urdf"
    code, said, err = poekin("apply", arm, toml, "-o", out)
    assert (code, err) == (0, "")
    assert out.read_bytes() == pk.to_urdf(chain, into=arm)
    moved = moved_joints(ARM.encode(), out.read_bytes())
    assert moved == {"turn", "lift", "flange"}
    assert without(out.read_bytes(), moved) == without(ARM.encode(), moved)
    assert arm.read_bytes() == ARM.encode()
    lines = said.splitlines()
    assert lines[0] == f"arm with '{toml}': 3 joints moved"
    assert lines[-2:] == [
        f"written: '{out}'",
        "the URDF is the model's own text with other origins and axes of joints that moved: all else is"
        " as it was",
    ]
    rows = {cells[0]: cells[1:] for line in lines if len(cells := line.split()) == 3}
    assert rows.keys() == moved
    before, after = read(ARM), read(out.read_bytes())
    for name, (shift, turn) in rows.items():
        a, b = before.joint(name), after.joint(name)
        p = np.linalg.norm(a.origin[:3, 3] - b.origin[:3, 3])
        assert float(shift) == pytest.approx(1e3 * p, rel=1e-3)
        frame = np.linalg.norm(pk.so3.log(a.origin[:3, :3].T @ b.origin[:3, :3]))
        axis = np.arcsin(np.linalg.norm(np.cross(a.axis, b.axis)))
        assert float(turn) == pytest.approx(1e3 * max(frame, axis), rel=1e-3)


def test_json_says_what_moved_in_si(as_json, arm, toml, tmp_path):
    said = as_json("apply", arm, toml, "-o", tmp_path / "out.urdf")
    assert said["robot"] == "arm"
    assert said["written"] == [str(tmp_path / "out.urdf")]
    assert [joint["joint"] for joint in said["joints"]] == ["turn", "lift", "flange"]
    assert all(1e-4 < joint["shift"] < 1e-2 for joint in said["joints"])


def test_what_is_calibrated_already_stays_as_it_is(poekin, arm, toml, tmp_path):
    once, twice = tmp_path / "once.urdf", tmp_path / "twice.urdf"
    assert poekin("apply", arm, toml, "-o", once)[0] == 0
    code, said, _ = poekin("apply", once, toml, "-o", twice)
    assert code == 0
    assert said.startswith(f"arm with '{toml}': 0 joints moved\nwritten: ")
    assert twice.read_bytes() == once.read_bytes()


def test_links_of_other_names_are_said(poekin, arm, tmp_path):
    path = tmp_path / "c.toml"
    other = read(ARM).chain(tip="hand").replace(base="floor", tip="tracker")
    chain = calibration(path, other).replace(base="base", tip="hand")
    words = ["apply", arm, path, "-o", tmp_path / "out.urdf", "--base", "base", "--tip", "hand"]
    assert poekin(*words)[0] == 0
    assert (tmp_path / "out.urdf").read_bytes() == pk.to_urdf(chain, into=arm)


def test_a_tip_that_is_the_last_moving_link_is_told_where_it_is(poekin, arm, tmp_path):
    path = tmp_path / "c.toml"
    chain = calibration(path, read(ARM).chain(tip="two"))
    code, said, err = poekin("apply", arm, path, "-o", tmp_path / "out.urdf")
    assert code == 0
    assert "two_tool" not in said  # the warning says it
    assert re.fullmatch(
        r"poekin: warning: link 'two' stays on the axis of joint 'lift', .*: the tip is the new link"
        r" 'two_tool', fixed to it\n",
        err,
    )
    assert (tmp_path / "out.urdf").read_bytes() == quietly(pk.to_urdf, chain, into=arm)


def test_a_factory_calibration_goes_by_its_own_links(poekin, tmp_path):
    nominal = pk.dh.published("ur5e")
    own = pk.ur.add_deltas(nominal, delta_a=[0, 1e-3, 0, 0, 0, 0])
    made = pk.ur.from_dh(own, nominal=nominal)
    pk.vendors.write(made, tmp_path / "c.yaml")
    out = tmp_path / "out.urdf"
    code, said, err = poekin("apply", "ur5e", tmp_path / "c.yaml", "-o", out)
    assert (code, err) == (0, "")
    assert "the URDF is the model's own text with other origins" in said
    q = np.full(6, 0.3)
    # the file keeps every digit, and the poses are products of seven on an arm of 1.2 m
    assert np.abs(pk.load(out).chain().fk(q) - made.to_chain().fk(q)).max() <= 1e-14


def test_a_model_that_came_from_no_urdf_is_written_anew(poekin, tmp_path):
    table = pk.dh.published("puma560")
    pk.dh.write(table, tmp_path / "arm.csv")
    robot = pk.load(tmp_path / "arm.csv")
    path = tmp_path / "c.toml"
    chain = calibration(path, robot.chain())
    code, said, _ = poekin("apply", tmp_path / "arm.csv", path, "-o", tmp_path / "out.urdf")
    assert code == 0
    assert said.splitlines()[-1] == (
        "the URDF is a new text, as the model came from none: no meshes, no masses"
    )
    assert np.abs(pk.load(tmp_path / "out.urdf").chain().home - chain.home).max() <= 1e-14


def test_an_evaluated_xacro_is_edited_as_its_own_urdf_would_be(poekin, chain, toml, tmp_path):
    pytest.importorskip("xacrodoc")
    path = tmp_path / "arm.urdf.xacro"
    text = ARM.replace(
        '<robot name="arm">', '<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">'
    )
    path.write_text(text.replace('value="2.5"', 'value="${5 / 2}"'), encoding="utf-8")
    out = tmp_path / "out.urdf"
    code, said, err = poekin("apply", path, toml, "--xacro", "-o", out)
    assert (code, err) == (0, "")
    assert "the URDF is the model's own text with other origins" in said
    assert '<mass value="2.5"/>' in out.read_text(encoding="utf-8")
    assert read(out.read_bytes()) == read(pk.to_urdf(chain, into=ARM.encode()))


def test_another_arm_s_calibration_is_put_on_when_forced(poekin, arm, tmp_path):
    path = tmp_path / "c.toml"
    moved = read(ARM).chain(tip="hand").rebased(pk.se3.exp([0, 0, 0, 0.5, 0, 0]))
    chain = calibration(path, moved)
    assert poekin("apply", arm, path, "-o", tmp_path / "out.urdf", "--force")[0] == 0
    assert (tmp_path / "out.urdf").read_bytes() == pk.to_urdf(chain, into=arm)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["c.csv", "-o", "out.urdf"], "'c.csv': expected a calibration, a .toml of"),
        (
            ["far.toml", "-o", "out.urdf"],
            "the calibration is not of the arm 'arm', from 'base' to 'hand'",
        ),
        (["far.toml", "-o", "far.urdf"], "; force=True (--force) puts it on all the same"),
        (["none.toml", "-o", "out.urdf"], "none.toml: cannot be read: No such file or directory"),
        (["bad.toml", "-o", "out.urdf"], "bad.toml"),
        (["other.toml", "-o", "out.urdf"], "the robot has 2 joints from 'base' to 'hand'"),
        (["c.toml", "-o", "out.urdf", "--tip", "hnd"], "did you mean 'hand'?"),
        (
            ["c.toml", "-o", "out.toml"],
            "cannot write 'out.toml': a name that ends in .urdf expected",
        ),
        (["c.toml", "-o", "none/out.urdf"], "there is no directory 'none'"),
        (["c.toml", "-o", "mine.urdf"], "it is the file of the model"),
        (["c.toml"], "Missing option '-o'"),
    ],
    ids=lambda x: " ".join(x) if isinstance(x, list) else "",
)
def test_what_cannot_be_applied_is_one_message_and_no_file(
    words, message, arm, toml, chain, refused, monkeypatch, tmp_path
):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "bad.toml").write_text("format = 'poekin calibration'\nversion = 1\n")
    calibration(tmp_path / "other.toml", pk.load("ur5e").chain().replace(base="base", tip="hand"))
    turned = pk.se3.exp([0, 0, 0, 0.5, 0, 0])
    calibration(tmp_path / "far.toml", read(ARM).chain(tip="hand").rebased(turned))
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    assert message in refused("apply", "mine.urdf", *words)
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before
