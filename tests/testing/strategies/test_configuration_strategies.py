"""Configurations within the limits, at the limits, and singular ones, as they are drawn."""

from __future__ import annotations

import math

import numpy as np
import pytest

import poekin as pk
from poekin.testing.strategies import configuration_strategies as strategies
from poekin.testing.strategies.configuration_strategies import bounds
from poekin.testing.strategies.decoding.bytes_reader import BytesReader
from tests.testing.drawing import drawn

PANDA = pk.load("panda").chain(tip="panda_hand")
FREE = pk.Chain.from_space(
    [pk.screw.revolute([0, 0, 1], [0, 0, 0])] * 2,
    np.eye(4),
    limits=[[-np.inf, np.inf], [-1e16, 1e16]],
)


@pytest.mark.parametrize(
    "draw", [strategies.within_limits, strategies.at_limits], ids=lambda draw: draw.__name__
)
def test_no_configuration_is_beyond_a_limit(draw):
    q = np.array(drawn(draw(PANDA), 300))
    assert np.all(q >= PANDA.limits[:, 0])
    assert np.all(q <= PANDA.limits[:, 1])
    # All of the range is drawn.
    assert np.all(np.ptp(q, axis=0) > 0.9 * np.ptp(PANDA.limits, axis=1))


def test_within_limits_0_is_drawn_where_it_lies_within_and_at_limits_both_limits():
    within, at = (
        np.array(drawn(s(PANDA), 300)) for s in (strategies.within_limits, strategies.at_limits)
    )
    around_0 = (PANDA.limits[:, 0] <= 0) & (PANDA.limits[:, 1] >= 0)
    assert np.all(np.any(within == 0, axis=0) == around_0)
    for side in PANDA.limits.T:
        assert np.all(np.mean(at == side, axis=0) > 0.2)


def test_a_coordinate_without_limits_turns_once():
    np.testing.assert_array_equal(bounds(FREE), [[-math.pi, math.pi]] * 2)
    assert np.abs(np.array(drawn(strategies.within_limits(FREE), 100))).max() <= math.pi


def test_a_limit_up_to_a_million_is_one():
    for far in (999_999.5, -999_999.5, 1_000_000.5, -1_000_000.5):
        chain = pk.Chain.from_space(
            FREE.screws, np.eye(4), limits=[[min(far, 0), max(far, 0)], [-1, 2]]
        )
        wide = [-math.pi, 0.0] if far < 0 else [0.0, math.pi]
        expected = sorted((far, 0.0)) if abs(far) < 1e6 else wide
        np.testing.assert_array_equal(bounds(chain), [expected, [-1, 2]])


def inside(lower: float, upper: float, *values: int) -> float:
    return strategies._inside(BytesReader(bytes(values)), lower, upper)


def test_a_coordinate_within_is_0_for_one_byte_in_eight_else_evenly_spread():
    for lower, upper in ((0.0, 0.5), (-0.5, 0.0), (-0.5, 0.5), (0.0, 0.0)):
        assert inside(lower, upper, 31, 0, 0, 0) == 0
        assert inside(lower, upper, 31, 0, 255, 255) == 0
        assert inside(lower, upper, 32, 0, 255, 255) == upper
        assert inside(lower, upper, 32) == lower
        assert inside(lower, upper, 255, 0, 128, 0) == pytest.approx(
            lower + (upper - lower) * 32768 / 65535
        )
    assert [inside(2.0, 5.0, 0, 0, x, x) for x in (0, 255)] == [2, 5]
    assert [inside(-5.0, -2.0, 0, 0, x, x) for x in (0, 255)] == [-5, -2]
    assert 0.3 + (0.9 - 0.3) > 0.9
    assert inside(0.3, 0.9, 32, 0, 255, 255) == 0.9


def test_a_singular_case_is_one():
    cases = drawn(strategies.singular_cases(), 150)
    for chain, q in cases:
        J = chain.jacobian(q, "space")
        columns = np.abs(J[:, :, None] - J[:, None, :]).max(axis=0) + np.eye(chain.dof) * 9
        # The screw is put in its place with the rounding of its neighbours' exponentials.
        assert columns.min() <= 1e-13 * (1 + np.abs(J).max())
    assert {chain.dof for chain, _ in cases} >= {2, 5}
