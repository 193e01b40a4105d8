"""The arguments of a chain's laws are those of their kinds."""

from __future__ import annotations

import numpy as np
import pytest

from poekin.errors import InputError
from tests.model.laws.chain_cases import PARTS, chain_cases
from tests.testing.drawing import drawn


def test_an_unknown_kind_of_argument_is_refused():
    with pytest.raises(InputError, match="kinds: there is no 'speed'"):
        chain_cases(("q", "speed"))


def test_the_arguments_of_a_law_are_drawn_by_their_kinds():
    for chain, q, dq, batch, pose, point, joint, frames in drawn(chain_cases(PARTS), 40):
        n, m = len(chain.screws), chain.dof
        assert q.shape == dq.shape == (m,)
        assert batch.shape[-1:] == (m,)
        assert (pose.shape, point.shape, frames.shape) == ((4, 4), (3,), (n, 2, 4, 4))
        assert 0 <= joint < n
        assert np.array_equal(frames[..., 3, :], np.broadcast_to([0, 0, 0, 1], (n, 2, 4)))
    (chain, frames), *_ = drawn(chain_cases(("frames",), min_joints=3, max_joints=3), 1)
    assert frames.shape == (3, 2, 4, 4)
    assert {case[-1] for case in drawn(chain_cases(("joint",), max_joints=3), 60)} == {0, 1, 2}
