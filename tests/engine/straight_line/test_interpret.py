"""A program run statement by statement: what the chain's general kernels compute."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from poekin.engine.straight_line import interpret
from poekin.testing.strategies import chain_strategies
from tests.model.kinematics.test_compiled import near


def apart(chain, frame, q):
    """Largest difference of the program's outputs from the chain's ÷ `near` in each row of q,
    lengths in reaches.
    """
    outputs = interpret.evaluate(chain.compile().program(frame, pose=True), q)
    T, J = chain.fk_jacobian(q, frame)
    wanted = np.concatenate(
        [T[:, :3, :3].reshape(len(q), 9), T[:, :3, 3], J.reshape(len(q), -1)], axis=1
    )
    assert outputs.shape == wanted.shape
    size = np.repeat([1.0, chain.reach, 1.0, chain.reach], [9, 3, 3 * chain.dof, 3 * chain.dof])
    return (np.abs(outputs - wanted) / size).max(axis=1) / near(chain, q)


@settings(max_examples=max(settings().max_examples // 3, 20))
@given(data=st.data())
def test_a_program_run_by_statements_is_the_chain(data):
    chain = data.draw(chain_strategies.chains(max_joints=7))
    frame = data.draw(st.sampled_from(["space", "body", "hybrid", *range(len(chain.kinds))]))
    assert apart(chain, frame, data.draw(chain_strategies.coordinates(chain, (3,)))).max() <= 1


@pytest.mark.parametrize("size", [0, 1, 2])
def test_there_may_be_any_number_of_configurations(size):
    import poekin as pk

    chain = pk.load("panda").chain(tip="panda_hand")
    assert interpret.evaluate(chain.compile().program(None), np.zeros((size, 7))).shape == (
        size,
        12,
    )
