"""`poekin urdf`: a model as URDF text, printed or written."""

from __future__ import annotations

import io
import os
import sys
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.cli import run
from poekin.formats import urdf
from poekin.formats.load import load
from poekin.formats.urdf_text import to_urdf


def test_the_whole_tree_is_printed(crane, poekin):
    code, out, err = poekin("urdf", crane)
    assert (code, err) == (0, "")
    robot = load(crane)
    assert out == to_urdf(robot)
    assert urdf.read_text(out) == robot


def test_one_chain_is_printed(crane, poekin):
    code, out, err = poekin("urdf", crane, "--tip", "hook", "--base", "a")
    assert (code, err) == (0, "")
    back, chain = urdf.read_text(out), load(crane).chain(base="a", tip="hook")
    assert (back.name, back.root, back.leaves, back.q_names) == (
        "crane",
        "a",
        ("hook",),
        ("slide",),
    )
    np.testing.assert_allclose(back.chain().fk([0.4]), chain.fk([0.4]), rtol=0, atol=1e-15)


def test_one_chain_keeps_what_its_joints_can_do(poekin, tmp_path):
    joint: dict[str, Any] = {"effort": 150.0, "velocity": 3.0, "damping": 0.5, "friction": 0.25}
    soft = pk.SafetyController(40.0, 100.0, -0.9, 0.9)
    arm = pk.Joint(
        *("turn", "revolute", "root", "arm"), limits=(-1, 1), safety_controller=soft, **joint
    )
    rod = pk.Joint(
        *("rod", "prismatic", "arm", "hand"),
        limits=(-1, 1),
        mimic=pk.Mimic("turn", -1.0, 0.5),
        safety_controller=soft,
        **joint,
    )
    Path(tmp_path / "a.urdf").write_text(
        to_urdf(pk.Robot("a", ["root", "arm", "hand"], [arm, rod]))
    )
    for ends in (("--tip", "hand"), ("--tip", "root", "--base", "hand"), ("--base", "arm")):
        code, out, _ = poekin("urdf", tmp_path / "a.urdf", *ends)
        assert (code, "not known" in out) == (0, False)
        for found in urdf.read_text(out).joints[:-1]:  # the last one holds the tip
            assert {key: getattr(found, key) for key in joint} == joint
            assert found.safety_controller == (soft if found.name == "turn" else None)


def test_a_warning_about_coordinates_is_on_stderr(crane, poekin):
    code, out, err = poekin("urdf", crane, "--tip", "hook", "--base", "b")
    assert code == 0
    assert err.startswith(
        "poekin: warning: the chain from 'b' to 'hook' has other coordinates as a robot: "
    )
    assert urdf.read_text(out).q_names == ("lower",)


def test_a_file_is_written_whole(crane, poekin, tmp_path):
    target = tmp_path / "out.urdf"
    assert poekin("urdf", crane, "--output", target) == (
        0,
        f"URDF of 'crane' written to '{target}'\n",
        "",
    )
    assert target.read_text(encoding="utf-8") == to_urdf(load(crane))
    assert not list(tmp_path.glob(".*"))


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (
            ["--output", "nowhere/out.urdf"],
            "cannot write 'nowhere/out.urdf': No such file or directory",
        ),
        (["--output", "/"], "cannot write '/'"),
        (["--output", "out.urdf.gz"], "cannot write 'out.urdf.gz': the text is not compressed"),
        (["--output", "out.ZIP"], "without --output it goes into a pipe (| gzip > FILE)"),
        (["--tip", "hok"], "did you mean 'hook'?"),
        (["--base", "a"], "'hook', 'lamp'"),
    ],
)
def test_a_bad_command_line_is_one_message_and_no_file(
    crane, refused, words, message, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    before = list(tmp_path.iterdir())
    assert message in refused("urdf", crane, *words)
    assert list(tmp_path.iterdir()) == before


def test_what_cannot_be_written_leaves_the_file_that_was_there(tmp_path, refused, crane):
    target = tmp_path / "out.urdf"
    target.write_text("precious")
    assert "did you mean" in refused("urdf", crane, "--tip", "hok", "--output", target)
    assert target.read_text() == "precious"
    assert not list(tmp_path.glob(".*"))


@pytest.mark.parametrize(
    "inside, message",
    [
        ('<limit effort="1" velocity="fast"/>', "velocity must be a number, got 'fast'"),
        ('<limit effort="1,5" velocity="1"/>', "effort must be a number, got '1,5'"),
        ('<dynamics damping="inf"/>', "damping must be a finite number, got 'inf'"),
        ('<safety_controller k_velocity=""/>', "k_velocity must be a finite number, got ''"),
    ],
)
def test_a_joint_whose_drive_is_no_number_is_one_message_and_nothing_is_written(
    tmp_path, refused, inside, message
):
    ends = '<parent link="a"/><child link="b"/>'
    joint = f'<joint name="j" type="continuous">{ends}{inside}</joint>'
    path = tmp_path / "bad.urdf"
    path.write_text(f'<robot name="r"><link name="a"/><link name="b"/>{joint}</robot>')
    assert message in refused("urdf", path, "--output", tmp_path / "out.urdf")
    assert not (tmp_path / "out.urdf").exists()


@pytest.mark.parametrize("encoding", ["utf-8", "latin-1", "ascii", "windows-1252"])
def test_names_survive_every_kind_of_terminal(tmp_path, monkeypatch, encoding):
    path = tmp_path / "x.urdf"
    path.write_text('<robot name="ü→&#x9b;"><link name="\u202e腕"/></robot>', encoding="utf-8")
    raw = io.BytesIO()
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(raw, encoding=encoding))
    assert run(["urdf", str(path)]) == 0
    sys.stdout.flush()
    assert urdf.read_text(raw.getvalue()) == load(str(path))
    shown = raw.getvalue().decode(encoding)
    # elsewhere by number
    assert ("腕" in shown) == (encoding == "utf-8")
    assert not set("\u202e\x9b") & set(shown)
    assert urdf.read_text(shown.encode()) == load(str(path))


@pytest.fixture
def mine(crane, tmp_path):
    """A user's own URDF of the crane, with Windows line ends, and one of it with another hook."""
    path = tmp_path / "mine.urdf"
    text = Path(crane).read_text(encoding="utf-8").replace("\n", "\r\n")
    path.write_bytes(text.encode())
    other = tmp_path / "other.urdf"
    other.write_bytes(
        text.replace('xyz="0 0 1"/><axis xyz="1 0 0"', 'xyz="0 0 2"/><axis xyz="1 0 0"').encode()
    )
    return path, other


def test_a_robot_goes_into_the_user_s_own_text(mine, poekin, tmp_path):
    path, other = mine
    out = tmp_path / "out.urdf"
    assert poekin("urdf", other, "--into", path, "--output", out) == (
        0,
        f"URDF of 'crane' written to '{out}'\n",
        "",
    )
    assert out.read_bytes() == other.read_bytes()
    assert path.read_bytes() != other.read_bytes()


def test_a_chain_goes_into_the_user_s_own_text_and_out_of_a_pipe_byte_for_byte(
    mine, monkeypatch, tmp_path
):
    path, _ = mine
    chain = pk.load(path).chain(tip="hook")
    raw = io.BytesIO()
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(raw, encoding="ascii"))
    assert run(["urdf", str(path), "--tip", "hook", "--into", str(path)]) == 0
    assert raw.getvalue() == path.read_bytes() == pk.to_urdf(chain, into=path)


def test_what_is_to_be_said_of_a_file_is_said_once(mine, poekin, tmp_path):
    path, _ = mine
    path.write_bytes(path.read_bytes().replace(b'<axis xyz="0 0 -1"/>', b'<axis xyz="0 0 -2"/>'))
    code, _, err = poekin("urdf", path, "--into", path, "--output", tmp_path / "out.urdf")
    assert (code, err.count("has length 2 and was normalised")) == (0, 1)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no named pipes here")
def test_the_user_s_own_text_may_come_out_of_a_pipe(mine, poekin, tmp_path):
    path, other = mine
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    writer = threading.Thread(target=pipe.write_bytes, args=(path.read_bytes(),))
    writer.start()
    out = tmp_path / "out.urdf"
    assert poekin("urdf", other, "--into", pipe, "--output", out)[0] == 0
    writer.join()
    assert out.read_bytes() == other.read_bytes()


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--into", "none.urdf"], "none.urdf: no such file\n"),
        (["--into", "puma560"], "error: --into: the robot 'puma560' was not read from a URDF"),
        (["--into", "bad.urdf"], "bad.urdf:1: malformed XML"),
        (["--into", "ur.urdf"], "ur.urdf has joints that the robot has not: 'turn2'"),
        (["--into", "ur.urdf", "--output", "crane.urdf"], "it is the file of the model"),
        (["--into", "ur.urdf", "--output", "ur.urdf"], "it is the file of the URDF"),
    ],
    ids=lambda x: " ".join(x) if isinstance(x, list) else "",
)
def test_what_cannot_be_put_into_a_file_is_one_message_and_no_file(
    words, message, crane, refused, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "bad.urdf").write_text("<robot")
    text = Path(crane).read_text(encoding="utf-8")
    (tmp_path / "ur.urdf").write_text(text.replace('name="turn"', 'name="turn2"'), encoding="utf-8")
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    assert message in refused("urdf", "crane.urdf", *words)
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before
