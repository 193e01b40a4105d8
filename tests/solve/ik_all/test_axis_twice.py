"""An arm two of whose joints turn about one axis: it has a continuum of solutions everywhere."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.model import screw


@pytest.mark.parametrize("seed", range(3))
def test_it_is_said_which_two_coordinates_move_along_it(seed):
    axes = [([0, 0, 1], [0, 0, 0]), ([0, 0, 1], [0, 0, 0]), ([0, 1, 0], [0, 0, 0.3])]
    axes += [([0, 1, 0], [0, 0, 0.4]), ([1, 0, 0], [0, 0, 0.4])]
    arm = pk.Chain.from_space([screw.revolute(w, p) for w, p in axes], np.eye(4))
    every = pk.ik_all(arm, arm.fk(arm.random(seed)))
    assert every.continuum
    assert not every.complete
    assert every.self_motion_coordinates == {0: arm.q_names[:2]}
    assert "infinitely many solutions" in every.explanation
