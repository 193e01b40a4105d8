"""A program run statement by statement: what the chain's general kernels compute."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from poekin.engine.straight_line import interpret
from poekin.engine.straight_line.program import Angles, program
from poekin.engine.straight_line.specialise import manipulability_program
from poekin.engine.straight_line.trace import Graph
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


def test_one_may_be_divided_by_what_is_known_later():
    graph = Graph()
    x = graph.input(-1)
    made = program(graph, Angles(graph), [1.0 / x, 3.0 / -x, x * (1.0 / x)])
    (values,) = interpret.evaluate(made, np.array([[4.0]]))
    assert values.tolist() == [0.25, -0.75, 1.0]
    assert made.count.divisions == 1


@pytest.mark.parametrize("frame", ["space", "body", "hybrid"])
def test_the_program_of_manipulability_is_the_pose_and_the_determinant(frame):
    import poekin as pk

    chain = pk.load("panda").chain(tip="panda_hand")
    q = chain.random(0, size=5)
    made = manipulability_program(chain.compile().structure, frame)
    values = interpret.evaluate(made, q)
    T = chain.fk(q)
    np.testing.assert_allclose(values[:, :9], T[:, :3, :3].reshape(5, 9), atol=1e-14)
    np.testing.assert_allclose(values[:, 9:12], T[:, :3, 3], atol=1e-14)
    own = pk.manipulability(chain, q).pose.yoshikawa
    np.testing.assert_allclose(np.sqrt(values[:, 12]), own, rtol=1e-9)
