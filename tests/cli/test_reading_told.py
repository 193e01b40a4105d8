"""While a file of rows is read, the line of progress says which one."""

from __future__ import annotations

import sys

import pytest

from poekin import progress_line
from poekin.formats.text import csv_rows

FILES = {
    "q.csv": "0.1,0.2\n" * 3,
    "T.csv": "1,0,0,0.5,0,1,0,0,0,0,1,0.65\n" * 3,
    "p.csv": "turn,slide,x,y,z\n" + "0.1,0.2,0.3,0.4,0.5\n" * 3,
    "s.csv": "q1,x,y,z\n" + "0.1,0.2,0.3,0.4\n" * 3,
}
HOOK = ("--tip", "hook")
COMMANDS = {
    "fk": ("q.csv", ("CRANE", *HOOK, "--input", "FILE")),
    "ik": ("T.csv", ("CRANE", "--tip", "none", "--format", "12", "--input", "FILE")),
    "choose-poses": ("q.csv", ("CRANE", "99", *HOOK, "--candidates", "FILE")),
    "calibrate": ("p.csv", ("CRANE", "FILE", *HOOK, "--centre", "0,0,0")),
    "from-circles": ("s.csv", ("FILE", "-o", "arm.urdf")),
}


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("place", ["FILE", "-"])
def test_the_file_that_is_read_is_named(command, place, poekin, crane, tmp_path, monkeypatch):
    """Most of these are refused after that: what is told until then is asked for."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(csv_rows, "AT_ONCE", 1)
    monkeypatch.setattr(progress_line, "PAUSE", 0.0)
    file, words = COMMANDS[command]
    (tmp_path / file).write_text(FILES[file])
    names = {"CRANE": crane, "FILE": place.replace("FILE", file)}
    with (tmp_path / file).open(encoding="utf-8") as stream:
        monkeypatch.setattr(sys, "stdin", stream)
        _, _, err = poekin(command, *(names.get(word, word) for word in words))
    called = f"'{file}'" if place == "FILE" else "standard input"
    told = [line for line in err.splitlines() if line.startswith("reading ")]
    assert len(told) == 3
    assert all(line.startswith(f"reading {called}: ") for line in told)
