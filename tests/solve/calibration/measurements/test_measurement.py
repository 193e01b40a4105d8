"""A set of measurements is one line where it is looked at: how many, of what, and what is unknown."""

from __future__ import annotations

import numpy as np
import pytest

from poekin.solve.calibration.measurements.points import Distances, Points
from poekin.solve.calibration.measurements.poses import EyeInHand, Poses

T = np.tile(np.eye(4), (5, 1, 1))
P = np.zeros((5, 2, 3))
LINES = {
    "<Poses: 5 of 6 numbers each, noise unknown>": Poses(T),
    "<Poses: 5 of 6 numbers each, noise given, at rows of q>": Poses(
        T, np.eye(6), rows=np.arange(5)
    ),
    "<Points: 5 of 6 numbers each, noise unknown>": Points(P, np.eye(3)[:2]),
    "<Distances: 4 of 1 numbers each, noise unknown, centre unknown>": Distances(np.ones(4), None),
    "<EyeInHand: 5 of 6 numbers each, noise unknown, T_base_board and T_tip_camera unknown>": (
        EyeInHand(T)
    ),
}


@pytest.mark.parametrize("line", LINES)
def test_a_set_says_how_many_of_how_many_numbers_its_noise_and_its_unknown_frames(line):
    assert repr(LINES[line]) == line
