"""How far poses of arms may differ whose axes agree within tolerance: the sums that the docstring
states.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from poekin.analysis.axis_lines import Tolerances
from poekin.analysis.compare.alignment.hypotheses import Hypothesis
from poekin.analysis.compare.alignment.lines import sides
from poekin.analysis.compare.reached import _bounds, near, poses_agree
from poekin.groups import se3
from poekin.model import screw
from poekin.model.chain import Chain

TOL_M, TOL_RAD = 1e-5, 3e-5
Z, X = [0, 0, 1], [1, 0, 0]
ROUNDING = 1e-12


def planar(last, limits=((-1, 2), (-1, 1), (-1, 1)), tip=6.0):
    """A joint about z at 0, another joint, one about z at 2 on the way to a tip at `tip`, along x."""
    home = np.eye(4)
    home[0, 3] = tip
    return Chain.from_space(
        [screw.revolute(Z, [0, 0, 0]), last, screw.revolute(Z, [2, 0, 0])], home, limits=limits
    )


def bounds(a, b=None):
    b = a if b is None else b
    return _bounds(sides(a, b, Tolerances(TOL_M, TOL_RAD)), a, b)


def expected(places, behind, travel=0.0, turns=0.0, reach=1.0):
    moved = 2 * (places * TOL_M + TOL_RAD * behind) + TOL_RAD * travel + TOL_M * turns
    return 1.001 * moved + ROUNDING * reach, 1.001 * 2 * TOL_RAD * places + ROUNDING


def test_each_turning_axis_counts_its_place_and_its_distance_from_the_tip_along_the_links():
    chain = planar(screw.revolute(Z, [-1, 0, 0]))
    # From -1 on to 2 and 6 it is 3 + 4, and from 0 back to -1 one more.
    assert bounds(chain) == pytest.approx(expected(3, 4 + 7 + 8, reach=chain.reach), rel=1e-12)


def test_a_slide_lengthens_what_turns_and_adds_what_its_own_direction_is_off():
    chain = planar(screw.prismatic(X), limits=[[-1, 2], [-3, 1], [-1, 1]])
    # The two axes stand 2 m apart, the tip 4 m behind the last; each may be 3 m farther.
    assert bounds(chain) == pytest.approx(
        expected(2, (4 + 3) + (6 + 3), travel=3, reach=chain.reach), rel=1e-12
    )


def test_a_helical_joint_travels_by_its_pitch_and_its_pitch_may_be_off_by_the_tolerance_a_turn():
    chain = planar(screw.helical(Z, [-1, 0, 0], -0.5), limits=[[-1, 2], [-40, 8], [-1, 1]])
    assert bounds(chain) == pytest.approx(
        expected(3, (4 + 7 + 8) + 3 * 20, travel=20, turns=40 / (2 * np.pi), reach=chain.reach),
        rel=1e-12,
    )


def test_the_larger_travel_and_the_larger_reach_of_both_arms_count():
    limits = [[-1, 2], [-3, 1], [-1, 1]]
    small = planar(screw.prismatic(X), limits)
    large = planar(screw.prismatic(X), [[-1, 2], [-3, 7], [-1, 1]])
    long = Chain.from_space(small.screws, planar(small.screws[1], tip=6e9).home, limits=limits)
    assert bounds(small, large) == bounds(large, small) == bounds(large)
    assert bounds(small, long)[0] - bounds(small)[0] == pytest.approx(
        1e-12 * (long.reach - small.reach), rel=1e-6
    )


def test_equal_arms_agree_within_rounding_however_small_the_tolerance():
    chain = planar(screw.revolute(X, [1, 0, 0]), tip=1000.0)
    base, n = se3.exp([0.3, -0.5, 0.7, 1, 2, 3]), 3
    other, nothing = chain.rebased(base), np.zeros(n, bool)
    reading = Hypothesis(se3.inverse(base), np.eye(4), np.zeros(n), np.ones(n), nothing, nothing, chain.screws,
                      np.zeros(n), 1)  # fmt: skip
    pair = sides(chain, other, Tolerances(1e-300, 1e-300))
    assert poses_agree(pair, chain, other, reading)
    for xi in ([0, 0, 0, 1e-8, 0, 0], [1e-11, 0, 0, 0, 0, 0]):
        assert not poses_agree(pair, chain, other, replace(reading, tool=se3.exp(xi)))


@pytest.mark.parametrize("free", ["a", "b", "neither"])
def test_poses_are_looked_at_within_the_limits_of_each_arm_in_its_own_zero_and_direction(free):
    # A reading that holds only where a stands at 0, and b at its zeros: its second joint counts the
    # other way.
    zeros, directions, at_zero = (
        np.array([0.4, -0.7, 0.9]),
        np.array([1.0, 1, -1]),
        np.zeros((3, 2)),
    )
    theirs, wide = np.repeat(zeros[:, None], 2, axis=1), np.array([-0.2, 0.3])
    a = planar(screw.revolute(X, [1, 0, 0]), at_zero + wide * (free == "a"))
    S = a.screws * np.array([1, -1, -1])[:, None]
    b = Chain.from_space(S, a.home).rezeroed(-zeros)
    b = Chain.from_space(b.screws, b.home, limits=theirs + wide * (free == "b"))
    nothing = np.zeros(3, bool)
    reading = Hypothesis(
        np.eye(4), np.eye(4), zeros, directions, nothing, nothing, a.screws, np.zeros(3), 0
    )
    assert poses_agree(sides(a, b, Tolerances(TOL_M, TOL_RAD)), a, b, reading) == (
        free == "neither"
    )


@pytest.mark.parametrize("reaches, half_turns, one_arm", [
    (0.029, 0.0, True), (0.0, 0.029, True), (0.014, 0.014, True), (0.016, 0.016, False), (0.031, 0.0, False),
    (0.0, 0.031, False), (1.0, 0.0, False), (0.0, 0.999, False),
])  # fmt: skip
@pytest.mark.parametrize("which", ["a", "b"])
def test_arms_whose_tools_are_three_hundredths_of_reach_and_half_turn_apart_are_two(
    reaches, half_turns, one_arm, which
):
    chain = planar(screw.revolute(Z, [-1, 0, 0]))
    short = chain.replace(home=se3.exp([0, 0, 0, 3, 0, 0]))
    a, b = (chain, short) if which == "a" else (short, chain)
    # both tools where that of a is, but for what they are apart: of the larger reach
    apart = se3.exp([0, 0, 0, *(reaches * chain.reach * np.array([0, 0.6, 0.8]))])
    tool = se3.inverse(b.home) @ a.home @ apart @ se3.exp([np.pi * half_turns, 0, 0, 0, 0, 0])
    nothing = np.zeros(3, bool)
    reading = Hypothesis(
        np.eye(4), tool, np.zeros(3), np.ones(3), nothing, nothing, a.screws, np.zeros(3), 1
    )
    assert near(a, b, reading) is one_arm
