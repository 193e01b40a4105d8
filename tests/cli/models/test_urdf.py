"""`poekin urdf`: a model as URDF text, printed or written."""

from __future__ import annotations

import io
import sys

import numpy as np
import pytest

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
        (["--tip", "hok"], "did you mean 'hook'?"),
        (["--base", "a"], "'hook', 'lamp'"),
    ],
)
def test_a_bad_command_line_is_one_message(crane, refused, words, message):
    assert message in refused("urdf", crane, *words)


def test_what_cannot_be_written_leaves_the_file_that_was_there(tmp_path, refused, crane):
    target = tmp_path / "out.urdf"
    target.write_text("precious")
    assert "did you mean" in refused("urdf", crane, "--tip", "hok", "--output", target)
    assert target.read_text() == "precious"
    assert not list(tmp_path.glob(".*"))


@pytest.mark.parametrize("encoding", ["utf-8", "latin-1", "ascii"])
def test_names_survive_every_kind_of_terminal(tmp_path, monkeypatch, encoding):
    path = tmp_path / "x.urdf"
    path.write_text('<robot name="ü→&#x9b;"><link name="\u202e腕"/></robot>', encoding="utf-8")
    raw = io.BytesIO()
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(raw, encoding=encoding))
    assert run(["urdf", str(path)]) == 0
    sys.stdout.flush()
    assert urdf.read_text(raw.getvalue()) == load(str(path))
    assert not set("\u202e\x9b") & set(raw.getvalue().decode(encoding))
