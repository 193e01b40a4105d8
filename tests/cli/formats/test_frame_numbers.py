"""`poekin compare --format`: the base and tool of the alignment in a controller's numbers."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.cli.formats import frame_numbers

ARM = pk.load("ur5e").chain(tip="tool0")
BASE = pk.poses.from_numbers([100, 200, 50, 10, 20, 30], "kuka")
TOOL = pk.poses.from_numbers([0, 0, 80, 0, 0, 45], "kuka")


@pytest.fixture
def urdf(tmp_path):
    path = tmp_path / "moved.urdf"
    chain = ARM.rebased(pk.se3.inverse(BASE)).retooled(pk.se3.inverse(TOOL))
    path.write_text(pk.to_urdf(chain))
    return path


def test_base_and_tool_are_printed_as_the_controller_takes_them(urdf, poekin):
    words = ["compare", "ur5e", urdf, "--tip", "tool0", "--same", ""]
    code, out, err = poekin(*words, "--format", "kuka")
    assert err == ""
    assert code in (0, 3)
    assert out.endswith("\nThe models are the same but for what may differ\n")
    lines = [line for line in out.splitlines() if " (kuka: " in line]
    found = []
    for line, title in zip(
        lines, ("base of B in the base of A", "tool of A in the tool of B"), strict=True
    ):
        assert line.startswith(f"{title} (kuka: mm, deg): ")
        found.append(pk.poses.read("{" + line.partition("): {")[2], "kuka"))
    _, out, _ = poekin(*words, "--format", "kuka", "--json")
    document = json.loads(out)
    assert document["units"] == ["mm", "mm", "mm", "deg", "deg", "deg"]
    for T, key in zip(found, ("base", "tool"), strict=True):
        np.testing.assert_allclose(T, document[key], rtol=0, atol=1e-12)
        numbers = pk.poses.from_numbers(document[f"{key}_numbers"], "kuka")
        np.testing.assert_allclose(numbers, document[key], rtol=0, atol=1e-14)


def test_numbers_are_printed_to_twelve_decimals(monkeypatch):
    row = [2 / 3, -1 / 7, 4e-13, 6e-13, 0.25, 1000 / 3]
    monkeypatch.setattr(frame_numbers, "_frames", lambda result, chosen: [("base", "", row)])
    chosen = frame_numbers.frame_layout("kuka", None, None, None)
    assert chosen is not None
    nothing: Any = None
    assert frame_numbers.frame_lines(nothing, chosen) == [
        "base (kuka: mm, deg): {X 0.666666666667, Y -0.142857142857, Z 0, A 0.000000000001, "
        "B 0.25, C 333.333333333333}"
    ]


WRONG = {
    "format": (["--format", "euler"], "--format: expected one of matrix, quat"),
    "no order": (["--format", "quat"], "--quaternion: the format quat needs the order"),
    "no format": (["--mm"], "--format: expected one of matrix, quat"),
    "degrees alone": (["--deg"], "--format: expected one of matrix, quat"),
    "order alone": (["--quaternion", "wxyz"], "--format: expected one of matrix, quat"),
    "units": (["--format", "ur", "--mm"], "--format: ur is in m and rad, mm was said"),
}


@pytest.mark.parametrize("case", WRONG)
def test_a_wrong_format_is_exit_code_2_with_one_message(case, refused):
    words, message = WRONG[case]
    assert message in refused("compare", "ur5e", "ur5e", "--tip", "tool0", *words)
