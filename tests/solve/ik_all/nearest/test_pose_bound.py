"""Bound of the pose difference of two arms: it holds at every q, and is not far above the truth."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import poekin as pk
from poekin.groups.arrays import ROUNDOFF
from poekin.model.chain import Chain
from poekin.solve.ik_all.nearest.pose_bound import (
    _differences,
    _links,
    _shortest_way,
    pose_bound,
)
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


@pytest.mark.parametrize("n", [1, 2, 5, 6])
def test_the_way_through_all_axes_has_the_least_sum_of_squares(n):
    rng = np.random.default_rng(n)
    w = rng.normal(size=(n, 3))
    w /= np.linalg.norm(w, axis=1, keepdims=True)
    points, tip = rng.normal(size=(n, 3)), rng.normal(size=3)
    feet = points - np.sum(points * w, axis=1, keepdims=True) * w
    found = _shortest_way(w, feet, np.zeros(n, bool), tip)
    # the way o_i = feet_i + t_i w_i of the t of least |o_2 - o_1|^2 + ... + |tip - o_n|^2
    ends = np.concatenate([feet, tip[None]])
    A = np.zeros((n, 3, n))
    for i in range(n):
        A[i, :, i] = -w[i]
        if i + 1 < n:
            A[i, :, i + 1] = w[i + 1]
    t = np.linalg.lstsq(A.reshape(-1, n), -np.diff(ends, axis=0).ravel(), rcond=None)[0]
    # springs of 1e6 hold the points to their axes
    np.testing.assert_allclose(found[1:-1], feet + t[:, None] * w, rtol=0, atol=1e-4)
    np.testing.assert_array_equal(found[0], found[1])
    np.testing.assert_array_equal(found[-1], tip)


def least_sum(scale: np.ndarray, constant: np.ndarray, rows: np.ndarray) -> float:
    """Least sum of scale |constant + rows x| over x, by Weiszfeld's iteration.

    Source: Weiszfeld 1937; scale (k, 2), constant (k, 2, 3), rows (k, 2, 3, u).
    """
    A, b = rows.reshape(-1, rows.shape[-1]), -constant.ravel()
    weight = scale
    sums = []
    for _ in range(100):
        root = np.repeat(np.sqrt(weight).ravel(), 3)
        x = np.linalg.lstsq(root[:, None] * A, root * b, rcond=1e-12)[0]
        size = np.linalg.norm(constant + (rows @ x), axis=-1)
        sums.append(float((scale * size).sum()))
        weight = scale / np.maximum(size, 1e-9 * size.max())
    return min(sums)


@pytest.mark.parametrize("name", ["ur5e", "puma560", "stanford"])
def test_turns_and_slides_are_chosen_that_make_the_sums_least(name):
    chain = pk.load(name).chain()
    for seed in range(2):
        other = perturbed(chain, seed)
        links = _links(chain, other)
        first_order = _differences(links)
        ones = np.ones(len(links.lever))
        position = least_sum(np.stack([links.lever, ones], axis=1), *first_order)
        rotation = least_sum(np.stack([ones, 0 * ones], axis=1), *first_order)
        bound = pose_bound(chain, other)
        # a few thousandths: what is of second order in 0.5 deg, and six rounds in place of all
        assert bound.position == pytest.approx(position, rel=5e-3)
        assert bound.rotation == pytest.approx(rotation, rel=5e-3)
