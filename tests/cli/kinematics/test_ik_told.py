"""What `poekin ik` says of poses that are not solved: which, and of very many how many more."""

from __future__ import annotations

import json
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.cli.formats.units import SI
from poekin.cli.kinematics import ik as command
from poekin.solve import motion


@pytest.mark.parametrize(
    ("count", "told", "more"),
    [
        (1, 1, None),
        (20, 20, None),
        (21, 20, "and 1 more poses; --json tells of each"),
        (47, 20, "and 27 more poses; --json tells of each"),
    ],
)
def test_the_first_twenty_reasons_are_told_and_how_many_more_there_are(count, told, more, capsys):
    reasons = {3 * k: f"reason {k}" for k in range(count)}
    command._complain(reasons, count, False)
    out, err = capsys.readouterr()
    expected = [f"poekin: pose {3 * k}: reason {k}" for k in range(told)]
    if more is not None:
        expected.append(f"poekin: {more}")
    assert (out, err.splitlines()) == ("", expected)


def test_of_one_pose_no_number_is_told(capsys):
    command._complain({0: "too far"}, 1, True)
    assert capsys.readouterr().err == "poekin: the pose: too far\n"


def test_a_document_has_the_reason_of_every_pose_and_stderr_has_none(poekin, tmp_path):
    far = np.tile([0, 0, 0, 9.0, 0, 0], (23, 1))
    motion.write_poses(tmp_path / "T.csv", pk.se3.exp(far), "12")
    words = ["--tip", "panda_hand", "--format", "12", "--input", tmp_path / "T.csv"]
    code, out, err = poekin("ik", "panda", *words, "--json")
    assert (code, err) == (1, "")
    why = json.loads(out)["why"]
    assert len(why) == 23
    assert {words.partition(" by ")[0] for words in why} == {
        "unreachable: the target is farther than the arm's reach"
    }
    code, said, err = poekin("ik", "panda", *words, "-o", tmp_path / "q.json")
    assert said == f"23 × q written to '{tmp_path}/q.json', 0 of 23 solved\n"
    assert json.loads((tmp_path / "q.json").read_text()) == json.loads(out)
    told = [f"poekin: pose {k}: {words}" for k, words in enumerate(why[:20])]
    assert err.splitlines() == [*told, "poekin: and 3 more poses; --json tells of each"]
    code, said, err = poekin("ik", "panda", *words, "-o", tmp_path / "q.npy", "--json")
    assert json.loads(said) == {"written": f"{tmp_path}/q.npy", "poses": 23, "solved": 0}
    assert (code, err) == (1, "")


@pytest.mark.parametrize(
    ("metres", "radians", "told"),
    [
        (0.0012499, 0.0012499, "solved, 1.2 mm and 0.072° off"),  # 0.071614 degrees
        (0.0012501, 0.00126536, "solved, 1.3 mm and 0.072° off"),  # 0.0724998
        (0.0000101, 0.00126538, "solved, 0.01 mm and 0.073° off"),  # 0.0725009
        (2e-12, 0.0, "solved, 2e-09 mm and 0° off"),
    ],
)
def test_how_far_off_a_pose_is_has_two_digits(metres, radians, told, capsys):
    chain = pk.Chain.from_space(
        [pk.screw.prismatic([0, 0, 1])], np.eye(4), base="floor", tip="hand"
    )
    found: Any = SimpleNamespace(
        success=np.array([True]),
        position_error=np.array([metres]),
        rotation_error=np.array([radians]),
        q=np.array([[0.1234567894]]),
    )
    command._show(chain, found, SI)
    lines = capsys.readouterr().out.splitlines()
    assert lines == [f"hand in floor: {told}", "  joint1 = 0.123456789"]
    found.success = np.array([False])
    command._show(chain, found, SI)
    assert capsys.readouterr().out.splitlines() == ["hand in floor: not solved", lines[1]]
