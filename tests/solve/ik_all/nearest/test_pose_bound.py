"""Bound of the pose difference of two arms: it holds at every q, and is not far above the truth."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import poekin as pk
from poekin.groups.arrays import ROUNDOFF
from poekin.model.chain import Chain
from poekin.solve.ik_all.nearest.pose_bound import pose_bound
from poekin.testing import strategies
from tests.solve.ik_all.perturbed import calibrated_ur10e, largest_differences, perturbed


def configurations(chain: Chain, number: int, seed: int = 0) -> np.ndarray:
    """Configurations at random: whole turns of joints that turn, the sampling range of the others."""
    rng = np.random.default_rng(seed)
    turns = rng.uniform(-np.pi, np.pi, (number, chain.dof))
    only_turns = [
        all(chain.kinds[i] == "revolute" for i in np.flatnonzero(column))
        for column in chain.coupling.T
    ]
    return np.where(only_turns, turns, chain.random(rng, number))


@given(
    chain=strategies.chains(min_joints=1, max_joints=6),
    seed=st.integers(0, 1000),
    angle=strategies.magnitudes(1e-12, 0.5),
    length=strategies.magnitudes(1e-12, 0.5),
)
def test_no_configuration_is_beyond_the_bound(chain, seed, angle, length):
    other = perturbed(chain, seed, angle, length)
    bound = pose_bound(chain, other)
    q = configurations(chain, 30, seed)
    position, rotation = largest_differences(chain, other, q)
    x = np.abs(q @ chain.coupling.T + chain.offset)
    slides = (x * np.abs(chain.local.slides)).sum(axis=1).max()
    # the accuracy of two poses, as `Chain.fk` states it, and of the chord's arcsine at 0
    rounding = 2 * ROUNDOFF * (8 * (len(chain.kinds) + 1) + 4 * x.sum(axis=1).max())
    size = max(chain.reach, other.reach) + np.abs(chain.screws).max() + slides
    assert position <= bound.position + rounding * size
    assert rotation <= bound.rotation + 4 * rounding


@given(chain=strategies.chains(min_joints=1, max_joints=6))
def test_the_bound_of_an_arm_and_itself_is_rounding(chain):
    bound = pose_bound(chain, chain)
    # 16 u a link, of the lengths that the bound adds up
    assert bound.rotation <= 32 * ROUNDOFF * (len(chain.kinds) + 2)


@pytest.mark.parametrize("seed", range(5))
def test_the_bound_is_at_most_twice_what_is_found(seed):
    chain = pk.load("ur5e").chain()
    other = perturbed(chain, seed)
    bound = pose_bound(chain, other)
    q = configurations(chain, 20_000)
    position, rotation = largest_differences(chain, other, q)
    assert position <= bound.position <= 2 * position
    assert rotation <= bound.rotation <= 2 * rotation


def test_what_turns_about_an_axis_and_slides_along_it_costs_nothing():
    chain = calibrated_ur10e()
    S = chain.screws[2]
    screws = chain.screws.copy()
    along = pk.se3.exp(0.3 * S + np.concatenate([np.zeros(3), 0.2 * S[:3]]))
    screws[2] = pk.se3.adjoint(along) @ S
    bound = pose_bound(chain, chain.replace(screws=screws))
    assert bound.position <= 1e-13
    assert bound.rotation <= 1e-13


def test_the_error_of_the_home_pose_alone_is_found_exactly():
    chain = pk.load("ur5e").chain()
    motion = np.array([0.0, 0.0, 2e-3, 1e-3, 0.0, 0.0])
    other = chain.replace(home=chain.home @ pk.se3.exp(motion))
    position, rotation = largest_differences(chain, other, configurations(chain, 3))
    bound = pose_bound(chain, other)
    assert bound.rotation == pytest.approx(rotation, rel=1e-9)
    assert bound.position == pytest.approx(position, rel=1e-9)
