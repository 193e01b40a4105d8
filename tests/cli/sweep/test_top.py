"""`poekin sweep top` and `histogram`: what the functions of those names find."""

from __future__ import annotations

import json

import numpy as np
import pytest

import poekin as pk
from poekin.sweep import PoseSamples, Random
from tests.sweep.masks.arm_of_all_shapes import robot_in

FEW = ("--samples", "2000", "--tip", "tool0", "--seed", "3")
ARM = pk.load("ur5e").chain(tip="tool0")
SAMPLES = Random.of(ARM, 2000, 3)


def cells(out):
    """Numbers of a table's rows."""
    return [[float(x) for x in line.split()] for line in out.split("─\n")[1].strip().split("\n")]


def test_the_worst_are_listed_with_their_configurations(poekin):
    words = ("--measure", "travel", "--count", "4", "--keep", "worst", "--workers", "1")
    code, out, _ = poekin("sweep", "top", "ur5e", *FEW, *words)
    own = pk.sweep.top(ARM, "travel", 4, keep="worst", samples=SAMPLES)
    assert (code, out.startswith(f"{own.summary()}\n\n")) == (0, True)
    listed = np.column_stack([own.values, own.q])
    np.testing.assert_allclose(cells(out), listed, rtol=5e-6)
    code, out, _ = poekin("sweep", "top", "ur5e", *FEW, "--json")
    assert json.loads(out) == pk.sweep.top(ARM, "manipulability", samples=SAMPLES).to_dict()


def test_bins_are_counted_between_the_ends(poekin):
    words = ("--measure", "orientation_error", "--sigma-angle", "1e-3", "--workers", "1")
    ends = ("--bins", "3", "--ends", "1e-3", "6e-3")
    code, out, _ = poekin("sweep", "histogram", "ur5e", *FEW, *words, *ends)
    error = pk.sweep.PoseUncertainty.by_tolerances(ARM, tilt=1e-3, offset=1e-3, part="orientation")
    own = pk.sweep.histogram(ARM, error, bins=3, ends=(1e-3, 6e-3), samples=SAMPLES)
    assert (code, out.startswith(f"{own.summary()}\n\n")) == (0, True)
    rows = np.column_stack([own.edges[:-1], own.edges[1:], own.counts])
    np.testing.assert_allclose(cells(out), rows, rtol=5e-6)
    code, out, _ = poekin("sweep", "histogram", "ur5e", *FEW, "--json")
    own = pk.sweep.histogram(ARM, "manipulability", bins=20, samples=SAMPLES)
    assert json.loads(out) == own.to_dict()


def test_poses_are_drawn_where_they_are_asked_for(poekin):
    poses = PoseSamples.of(ARM, 2000, 3)
    words = ("--by", "poses", "--measure", "manipulability")
    code, out, _ = poekin("sweep", "top", "ur5e", *FEW, *words, "--json")
    own = pk.sweep.top(ARM, "manipulability", samples=poses)
    assert (code, json.loads(out)) == (0, own.to_dict())
    code, out, _ = poekin("sweep", "histogram", "ur5e", *FEW, *words)
    own = pk.sweep.histogram(ARM, "manipulability", bins=20, samples=poses)
    assert (code, out.startswith(f"{own.summary()}\n\n")) == (0, True)
    assert out.split("─")[0].split()[-3:] == ["from", "to", "poses"]


def test_both_leave_out_configurations_in_which_the_arm_touches_itself(tmp_path, poekin):
    robot = robot_in(tmp_path)
    arm = robot.chain(tip="hand")
    mask = pk.sweep.SelfCollision.of_robot(robot, arm)
    words = (str(tmp_path / "r.urdf"), "--samples", "1000", "--self-collision", "--json")
    drawn = Random.of(arm, 1000)
    expected = {
        "top": pk.sweep.top(arm, "travel", samples=drawn, mask=mask),
        "histogram": pk.sweep.histogram(arm, "travel", bins=20, samples=drawn, mask=mask),
    }
    for name, found in expected.items():
        code, out, _ = poekin("sweep", name, *words, "--measure", "travel")
        assert (code, json.loads(out)) == (0, found.to_dict())


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("top", "--measure", "reach"), "--measure: expected a measure to keep, got 'reach'"),
        (("top", "--keep", "mean"), "--keep: expected 'best' or 'worst', got 'mean'"),
        (
            ("top", "--samples", "1.5"),
            "--samples: expected a whole number from 1 on, as 10000000 or 1e8",
        ),
        (("histogram", "--ends", "1", "0"), "--ends: "),
        (("histogram", "--sigma-angle", "1"), "--sigma-angle, --sigma-length: expected"),
    ],
)
def test_what_cannot_be_asked_is_refused(words, said, poekin):
    name, *options = words
    code, _, err = poekin("sweep", name, "ur5e", "--tip", "tool0", *options)
    assert code == 2
    assert f"poekin: error: {said}" in err
