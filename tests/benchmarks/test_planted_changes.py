"""Changes that are planted in arms have the size that is said, and what a comparison may say of
them is judged.
"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from benchmarks import planted_changes
from benchmarks.planted_changes import (
    CHANGES,
    alignment_fault,
    fault,
    moves,
    planted,
    random_arm,
)
from poekin.groups import se3

ARM = random_arm(97)
RNG = np.random.default_rng


def test_random_arms_are_as_asked_within_some_decimetres():
    kinds = ("revolute", "prismatic", "revolute")
    assert random_arm(3, kinds).kinds == kinds
    assert ARM.kinds == ("revolute",) * 6
    points = np.array(
        [np.cross(S[:3], S[3:]) for seed in range(40) for S in random_arm(seed).screws]
    )
    assert np.linalg.norm(points, axis=1).mean() == pytest.approx(
        0.3 * np.sqrt(2) * np.sqrt(np.pi) / 2, rel=0.1
    )
    assert planted_changes.arm("random 7b").dof == 7
    assert np.array_equal(planted_changes.arm("random 6a").screws, ARM.screws)


@pytest.mark.parametrize("k", [0, 3, 5])
def test_one_change_is_planted_in_one_joint(k):
    limits = np.stack([np.arange(6) - 3.0, np.arange(6) + 0.5], axis=1)
    arm = type(ARM).from_space(ARM.screws, ARM.home, limits=limits)
    found = {change: planted(arm, change, k, RNG(k)) for change in CHANGES}
    others = [i for i in range(6) if i != k]
    S = arm.screws[k]
    for change in ("tilt", "shift", "flip"):
        other = found[change]
        assert np.array_equal(other.screws[others], arm.screws[others])
        assert np.array_equal(other.home, arm.home)
        assert np.array_equal(other.limits[others], limits[others])
        assert other.joint_names == arm.joint_names
    assert np.array_equal(found["flip"].screws[k], -S)
    assert np.array_equal(found["flip"].limits[k], -limits[k, ::-1])
    q = np.linspace(-1, 1, 6)
    moved = q + np.radians(0.5) * np.eye(6)[k]
    assert found["zero"].fk(q) == pytest.approx(arm.fk(moved), abs=1e-13)
    w, p = S[:3], np.cross(S[:3], S[3:])
    tilted, shifted = found["tilt"].screws[k], found["shift"].screws[k]
    assert np.degrees(
        np.arctan2(np.linalg.norm(np.cross(w, tilted[:3])), w @ tilted[:3])
    ) == pytest.approx(0.1, rel=1e-9)
    assert np.cross(p, tilted[:3]) == pytest.approx(tilted[3:], abs=1e-12)  # through the same point
    assert shifted[:3] == pytest.approx(w, abs=1e-15)
    step = np.cross(shifted[:3], shifted[3:]) - p
    assert np.linalg.norm(step) == pytest.approx(1e-3, rel=1e-9)
    assert step @ w == pytest.approx(0, abs=1e-15)
    again = planted(arm, "shift", k, RNG(k + 1)).screws[k]
    assert np.abs(again[3:] - shifted[3:]).max() > 1e-5, "across, in any direction"


JOINT = {"number": 3, "axis_differs": False, "zero_differs": False, "reversed": False}
FOUND: dict[str, dict[str, Any]] = {
    "tilt": {"axis_differs": True, "angle": np.radians(0.1), "normal": 1e-6},
    "shift": {"axis_differs": True, "normal": 1e-3},
    "zero": {"zero_differs": True, "zero_offset": -np.radians(0.5)},
    "flip": {"reversed": True},
}


def result(change: str, joint: dict[str, Any] | None = None, **changes: Any) -> Any:
    j = SimpleNamespace(
        **{
            "angle": 0.0,
            "normal": 0.0,
            "zero_offset": 0.0,
            **JOINT,
            **FOUND[change],
            **(joint or {}),
        }
    )
    fields = {
        "differing": [j], "joints": [None, None, j], "same_arm": change in ("zero", "flip"),
        "verdict": "joint 3 differs",
        "base": np.eye(4), "tool": np.eye(4),
    }  # fmt: skip
    return SimpleNamespace(**(fields | changes))


@pytest.mark.parametrize("change", CHANGES)
def test_a_comparison_that_is_right_has_no_fault(change):
    assert fault(result(change), change, 2) == ""
    little = {
        "tilt": {"angle": np.radians(0.1009)},
        "shift": {"normal": 0.991e-3},
        "zero": {"zero_offset": -np.radians(0.5049)},
        "flip": {},
    }[change]
    assert fault(result(change, little), change, 2) == ""


def test_joints_are_counted_from_1():
    for k in range(4):
        j = result("flip", {"number": k + 1}).differing[0]
        found = result(
            "flip", differing=[j], joints=[None] * k + [j], verdict=f"joint {k + 1} is flipped"
        )
        assert fault(found, "flip", k) == ""


def test_an_arm_ends_where_its_link_is_named():
    assert [planted_changes.arm(name).tip for name in ("panda", "ur5e")] == ["panda_hand", "tool0"]
    assert len(planted_changes.ARMS) == 20


@pytest.mark.parametrize("change", CHANGES)
def test_what_is_wrong_with_a_comparison_is_said(change):
    wrong = {
        "tilt": {"angle": np.radians(0.101005)},
        "shift": {"normal": 1.01005e-3},
        "zero": {"zero_offset": -np.radians(0.505025)},
    }.get(change)
    assert fault(result(change), change, 1) == "blames [3]"
    assert fault(result(change, differing=[]), change, 2) == "blames []"
    for name in ("axis_differs", "zero_differs", "reversed"):
        flipped = {name: not FOUND[change].get(name, False)}
        assert fault(result(change, flipped), change, 2) == "says joint 3 differs"
    assert wrong is None or fault(result(change, wrong), change, 2).startswith("size (")
    assert (
        change != "tilt"
        or fault(result(change, {"normal": 1.01e-5}), change, 2) == "tilt shifted by 1.01e-05 m"
    )
    equal = change in ("zero", "flip")
    assert fault(result(change, same_arm=not equal), change, 2) == "verdict joint 3 differs"
    assert (
        fault(result(change, verdict="joint 33 differs"), change, 2) == "verdict joint 33 differs"
    )
    moved = np.eye(4)
    moved[1, 3] = 2e-6
    said: tuple[tuple[Any, str], ...] = ((None, "matches nothing"), (moved, "moves base or tool"))
    for pose, words in said:
        assert fault(result(change, base=pose), change, 2) == words
        assert fault(result(change, tool=pose), change, 2) == words


def test_base_and_tool_are_moved_apart_and_together():
    q = np.linspace(-1, 1, 6)
    found = list(moves(ARM, RNG(0)))
    assert [what for what, *_ in found] == ["base", "tool", "base and tool"]
    for what, arm, base, tool in found:
        assert base @ arm.fk(q) @ tool == pytest.approx(ARM.fk(q), abs=1e-12)
        assert np.array_equal(base, np.eye(4)) == ("base" not in what)
        assert np.array_equal(tool, np.eye(4)) == ("tool" not in what)


def test_what_is_wrong_with_an_alignment_is_said():
    base, tool = se3.exp([0.1, 0, 0, 0, 1, 0]), se3.exp([0, 0.2, 0, 0, 0, 1])

    def aligned(**changes: Any) -> Any:
        fields = {
            "differing": [], "same_arm": True, "verdict": "the same arm, aligned", "base": base, "tool": tool,
            "after": SimpleNamespace(worst_position=0.99e-7),
        }  # fmt: skip
        return SimpleNamespace(**(fields | changes))

    off = np.eye(4) * 1.1e-7
    for changes, said in (
        ({}, ""),
        ({"differing": [SimpleNamespace(number=2)]}, "blames [2]: the same arm, aligned"),
        ({"same_arm": False}, "blames []: the same arm, aligned"),
        ({"verdict": "the same arm"}, "verdict the same arm"),
        ({"base": None}, "matches nothing"),
        ({"tool": None}, "matches nothing"),
        ({"after": None}, "matches nothing"),
        ({"base": base + off}, "alignment off by 1e-07"),
        ({"tool": tool - off}, "alignment off by 1e-07"),
        ({"base": base + off * 0.8, "tool": tool - off * 0.8}, ""),
        ({"after": SimpleNamespace(worst_position=1.1e-7)}, "0.0001 mm are left"),
    ):
        assert alignment_fault(aligned(**changes), base, tool) == said
