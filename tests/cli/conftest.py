"""One robot with everything in it, as a file, and a way to run the command line in this process."""

from __future__ import annotations

import json
import math

import pytest

from poekin import progress_line
from poekin.cli import run

URDF = """<robot name="crane">
<link name="root"/><link name="a"/><link name="b"/><link name="hook"/><link name="lamp"/>
<joint name="turn" type="continuous"><parent link="root"/><child link="a"/><axis xyz="0 0 1"/></joint>
<joint name="slide" type="prismatic"><parent link="a"/><child link="b"/><origin xyz="0 0 1"/><axis xyz="1 0 0"/>
  <limit lower="0" upper="1" effort="1" velocity="1"/></joint>
<joint name="lower" type="prismatic"><parent link="b"/><child link="hook"/><axis xyz="0 0 -1"/>
  <limit lower="0" upper="1" effort="1" velocity="1"/><mimic joint="slide" multiplier="0.5" offset="0.1"/></joint>
<joint name="bracket" type="fixed"><parent link="a"/><child link="lamp"/><origin xyz="0 0 2"/></joint>
</robot>"""


@pytest.fixture
def crane(tmp_path):
    """The path of a URDF file with a fork, a mimic joint and all the usual kinds of joints."""
    path = tmp_path / "crane.urdf"
    path.write_text(URDF, encoding="utf-8")
    return str(path)


@pytest.fixture
def poekin(capsys, monkeypatch):
    """Run a command line: (exit code, stdout, stderr); on stderr no word of progress, however slow
    the machine is.
    """
    monkeypatch.setattr(progress_line, "PAUSE", math.inf)

    def call(*words):
        code = run([str(w) for w in words])
        captured = capsys.readouterr()
        return code, captured.out, captured.err

    return call


@pytest.fixture
def as_json(poekin):
    """Run a command line that must succeed, with --json, and read what it prints."""

    def call(*words):
        code, out, err = poekin(*words, "--json")
        assert (code, err) == (0, "")
        return json.loads(out)

    return call


@pytest.fixture
def refused(poekin):
    """Run a command line that must be refused: exit code 2, nothing on stdout, one message; the
    message.
    """

    def call(*words):
        code, out, err = poekin(*words)
        assert (code, out) == (2, "")
        assert err.startswith("poekin: error: ")
        assert err.count("poekin: error: ") == 1
        assert "Traceback" not in err
        return err

    return call
