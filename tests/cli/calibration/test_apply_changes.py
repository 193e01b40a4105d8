"""What `poekin apply` tells of a joint that moved: how far its origin, and by which angle it or its axis."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.cli.calibration import apply

HERE = pk.se3.exp([0.3, -0.2, 0.5, 0.1, 0.2, 0.3])


def joint(origin=HERE, axis=(0.0, 0.0, 1.0)) -> pk.Joint:
    return pk.Joint("turn", "revolute", "base", "arm", origin, axis)


def robot(made: pk.Joint) -> pk.Robot:
    return pk.Robot("r", ["base", "arm"], [made])


@pytest.mark.parametrize(
    ("after", "shift", "turn"),
    [
        (joint(), 0.0, 0.0),
        (joint(HERE @ pk.se3.exp([0, 0, 0, 0.3, 0, -0.4])), 0.5, 0.0),
        (joint(HERE @ pk.se3.exp([0.1, 0, 0, 0, 0, 0])), 0.0, 0.1),
        (joint(axis=(0, np.sin(0.2), np.cos(0.2))), 0.0, 0.2),
        (joint(axis=(0, 0, -1.0)), 0.0, np.pi),
        (joint(HERE @ pk.se3.exp([0.1, 0, 0, 0, 0, 0]), (0, np.sin(0.2), np.cos(0.2))), 0.0, 0.2),
        (joint(HERE @ pk.se3.exp([0.3, 0, 0, 0, 0, 0]), (0, np.sin(0.2), np.cos(0.2))), 0.0, 0.3),
    ],
)
def test_a_change_is_the_way_of_the_origin_and_the_larger_of_two_angles(after, shift, turn):
    """That between the frames, and that between the axes in them."""
    found = apply._change(joint(), after)
    assert found.joint == "turn"
    # products of two rotations, each within a few units of the last place
    assert found.shift == pytest.approx(shift, abs=1e-14)
    assert found.turn == pytest.approx(turn, abs=1e-14)


@pytest.mark.parametrize(("by", "told"), [(0.5e-12, 0), (2e-12, 1), (1e-3, 1)])
@pytest.mark.parametrize("angle", [False, True])
def test_a_joint_is_told_of_from_a_billionth_of_a_millimetre_on(by, told, angle):
    here = np.eye(4)
    moved = pk.se3.exp([by, 0, 0, 0, 0, 0] if angle else [0, 0, 0, 0, by, 0])
    found = apply._changes(robot(joint(here)), robot(joint(moved)))
    assert len(found) == told
    if told:
        np.testing.assert_allclose(found[0][1:], [0, by] if angle else [by, 0], rtol=1e-9)
