"""Branches of a spherical wrist, uncompiled: the configuration is among them, and where it is lost."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from poekin.engine.kernels.branches import wrist_branches as module
from tests.engine.kernels.branches.test_parallel_branches import Q, filled
from tests.formulas.ik.slides.test_position import arm, place
from tests.solve.ik_all import closed_form_arms as arms


@pytest.mark.parametrize("first", [0, 1, 2, 3])
@pytest.mark.parametrize("others", ["RRR", "PRR", "RPR", "RRP", "PPR"])
def test_the_configuration_of_a_pose_is_among_its_branches(first, others):
    chain = arms.arm(5, "wrist", first, others)
    q = np.where(arms.sliding(chain), 0.2 * Q, Q)
    rows, margins = filled(chain, q)
    assert (margins > -np.inf).all()
    # some 100 roundings of numbers up to 1, over how far from singular the arm is
    limit = 100 * np.finfo(float).eps / arms.clearance(chain, q)
    assert arms.apart(chain, rows[None][:, margins > 0], q[None])[0] <= limit
    reached = chain.fk(rows[margins > 0])
    np.testing.assert_allclose(reached, np.broadcast_to(chain.fk(q), reached.shape), atol=1e-8)


@pytest.mark.parametrize("slides", list(product([False, True], repeat=3)), ids=str)
@given(st.integers(0, 2**32 - 1))
def test_joints_are_lost_where_their_determinant_is_small_and_they_reach_the_place(slides, seed):
    h, P, q = arm(seed, False)
    steps = 1e-6 * np.eye(3)
    J = [(place(slides, h, P, q + d) - place(slides, h, P, q - d)) / 2e-6 for d in steps]
    size = np.sqrt((P**2).sum())
    share = abs(np.linalg.det(J)) / size ** (3 - sum(slides))
    x = [
        n
        for t, slide in zip(q, slides, strict=True)
        for n in ((t, 0.0) if slide else (np.cos(t), np.sin(t)))
    ]
    there = place(slides, h, P, q)

    def lost(limit: float, target=there) -> bool:
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(module, "LOST", limit)
            return bool(module._lost(slides, h, P, x, target))

    # differences of numbers up to 10 over 1e-6 are off by 1e-8
    assert lost(share + 1e-6)
    assert not lost(share - 1e-6)
    way = h[1] / np.linalg.norm(h[1])
    assert lost(np.inf, there + 0.9 * module.NEAR * size * way)
    assert not lost(np.inf, there + 1.1 * module.NEAR * size * way)
