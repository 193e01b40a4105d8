"""Programs of errors, interpreted, against `Chain.screw_derivatives` in NumPy."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.engine.straight_line.interpret import evaluate
from poekin.sweep import PoseUncertainty
from tests.sweep.measures.first_order import effects

SCREWS = [
    pk.screw.revolute([0, 0, 1], [0.1, 0, 0]),
    pk.screw.prismatic([1, 0, 0]),
    pk.screw.revolute([0.6, 0, 0.8], [0.3, 0.2, 0]),
    pk.screw.helical([0, 1, 0], [0.2, 0, 0.4], 0.1),
]
HOME = pk.se3.exp([0.3, -0.2, 0.5, 0.7, 0.1, 0.4])


@pytest.mark.parametrize("n", [1, 2, 3, 4])
@pytest.mark.parametrize("bound", [False, True])
@pytest.mark.parametrize("part", ["position", "orientation"])
def test_outputs_are_the_pose_and_squares_of_what_each_source_does_or_their_sum(
    n, bound, part: Any
):
    chain = pk.Chain(np.array(SCREWS[:n]), HOME, frame="space", limits=[[-1, 1]] * n)
    error = PoseUncertainty.by_tolerances(
        chain, tilt=0.1, shift=0.2, offset=0.3, home_rotation=0.4, home_position=0.5,
        part=part, bound=bound,
    )  # fmt: skip
    q = chain.random(1, 5)
    found = evaluate(error.program(chain), q)
    T = chain.fk(q)
    # a few products of numbers below 2
    np.testing.assert_allclose(found[:, :9], T[:, :3, :3].reshape(5, 9), rtol=0, atol=1e-14)
    np.testing.assert_allclose(found[:, 9:12], T[:, :3, 3], rtol=0, atol=1e-14)
    squares = np.square(effects(chain, q, error, part))
    expected = squares if bound else squares.sum(axis=1, keepdims=True)
    assert found.shape == (5, 12 + error.outputs(chain))
    np.testing.assert_allclose(found[:, 12:], expected, rtol=0, atol=1e-13)
