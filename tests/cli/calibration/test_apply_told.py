"""Whole output of `poekin apply`: each number in its unit and to its digits, and the same in JSON, SI."""

from __future__ import annotations

import json

import pytest

from poekin.cli.calibration import apply as command
from tests.formats.urdf_in_place.in_place_cases import ARM

CHANGES = [command.Change("turn", 0.00123456, 0.0234567), command.Change("lift", 0.345678, 1e-9)]
TABLE = """\
joint origin (mm) turn (mrad)
turn 1.235 23.46
lift 345.7 1e-06
""".splitlines()


@pytest.fixture
def words(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.urdf").write_text(ARM)
    monkeypatch.setattr(command, "apply", lambda robot, given, **_: robot)
    monkeypatch.setattr(command, "_changes", lambda before, after: CHANGES)
    return ["apply", "mine.urdf", "c.toml", "-o", "out.urdf"]


def test_what_moved_is_told_in_mm_and_mrad_to_four_digits(poekin, words):
    code, said, err = poekin(*words)
    assert (code, err) == (0, "")
    lines = [" ".join(line.split()) for line in said.splitlines() if set(line) - set(" ─")]
    assert lines == [
        "arm with 'c.toml': 2 joints moved",
        *TABLE,
        "written: 'out.urdf'",
        "the URDF is the model's own text with other origins and axes of joints that moved: all else is"
        " as it was",
    ]


def test_the_document_is_in_m_and_rad(poekin, words):
    code, said, err = poekin(*words, "--json")
    assert (code, err) == (0, "")
    assert json.loads(said) == {
        "robot": "arm",
        "joints": [
            {"joint": "turn", "shift": 0.00123456, "turn": 0.0234567},
            {"joint": "lift", "shift": 0.345678, "turn": 1e-9},
        ],
        "written": ["out.urdf"],
    }


def test_where_nothing_moved_there_is_no_table(poekin, words, monkeypatch):
    monkeypatch.setattr(command, "_changes", lambda before, after: [])
    assert poekin(*words)[1].splitlines()[:2] == [
        "arm with 'c.toml': 0 joints moved",
        "written: 'out.urdf'",
    ]
