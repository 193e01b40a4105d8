"""Where what `poekin follow` finds goes: the report to stdout, the joints to the file that -o names."""

from __future__ import annotations

import json

import numpy as np
import pytest

import poekin as pk
from poekin.solve import motion

PANDA = ["follow", "panda", "--tip", "panda_hand", "--format", "12"]
Q0 = np.array([0, -0.5, 0, -2.0, 0, 1.6, 0.8])
HEADING = {"robot", "base", "tip", "q_names"}


@pytest.fixture
def words(tmp_path):
    T = pk.load("panda").chain(tip="panda_hand").fk(Q0) + np.zeros((3, 1, 1))
    T[:, 1, 3] += [0.0, 0.01, 0.02]
    motion.write_poses(tmp_path / "T.csv", T, "12")
    return [*PANDA, "--input", tmp_path / "T.csv", "--q0", ",".join(map(str, Q0))]


def test_beside_a_file_the_report_says_where_the_joints_are_and_leaves_them_out(
    poekin, as_json, words, tmp_path
):
    whole = as_json(*words, "--duration", 4)
    out = tmp_path / "q.json"
    said = as_json(*words, "--duration", 4, "-o", out)
    assert json.loads(out.read_text()) == whole
    assert said == {"written": str(out)} | {
        key: value for key, value in whole.items() if key not in {"q", *HEADING}
    }
    assert (whole["poses"], whole["solved"], whole["times"]) == (3, 3, [0.0, 2.0, 4.0])


def test_a_sheet_has_the_time_first_where_there_is_one(poekin, as_json, words, tmp_path):
    out = tmp_path / "q.csv"
    for more, times in (([], None), (["--duration", 4], [0, 2, 4])):
        whole = as_json(*words, *more)
        printed = poekin(*words, *more)[1]
        code, said, err = poekin(*words, *more, "-o", out)
        assert (code, err) == (0, "")
        assert said.splitlines()[:2] == [f"3 × q written to '{out}'", whole["words"][0]]
        assert out.read_text() == printed
        head, *rows = printed.splitlines()
        columns = whole["q_names"]
        values = np.array(whole["q"])
        if times is not None:
            columns = ["time", *columns]
            values = np.column_stack([times, values])
        assert head.split(",") == columns
        np.testing.assert_array_equal(np.array([row.split(",") for row in rows], float), values)
