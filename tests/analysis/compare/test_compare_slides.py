"""compare where joints slide: an arm on a rail in other zero positions, and an axis that no far
slide makes up for.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.planted_changes import random_arm
from poekin.analysis.axis_lines import Tolerances
from poekin.analysis.compare.alignment.hypotheses import make_hypotheses
from poekin.analysis.compare.alignment.lines import sides
from poekin.analysis.compare.alignment.search import search
from poekin.analysis.compare.compare import compare
from poekin.analysis.compare.reached import poses_agree
from poekin.formats.load import load
from poekin.groups import se3
from poekin.model import screw
from poekin.model.chain import Chain
from poekin.model.sampling import sampling_range

TOL = Tolerances(1e-5, np.radians(1e-3))


def on_a_rail(chain, *ways):
    """The arm on one slide or more of 2 m, along these directions."""
    rails = [screw.prismatic(way) for way in ways]
    return Chain.from_space(
        [*rails, *chain.screws], chain.home, limits=[*([-1, 1] for _ in rails), *chain.limits]
    )


COBRA = load("cobra600").chain()
RAILS = {
    "cobra600": on_a_rail(COBRA, [0, 1, 0]),
    "panda": on_a_rail(load("panda").chain(tip="panda_hand"), [0, 1, 0]),
    "six axes anywhere": on_a_rail(random_arm(3), [1, 2, 0]),
    "on a gantry": on_a_rail(random_arm(4, ("revolute",) * 4), [1, 0, 0], [0, 1, 0]),
}


def in_other_conventions(chain, rng):
    """The arm with other zero positions, another base and tool, and some joints the other way
    round.
    """
    low, high = sampling_range(chain)
    moved = chain.rezeroed(rng.uniform(-0.25, 0.25, chain.dof) * (high - low)).rebased(
        se3.exp(rng.normal(size=6))
    )
    signs = rng.choice([-1.0, 1.0], chain.dof)
    return Chain.from_space(moved.screws * signs[:, None], moved.home @ se3.exp(rng.normal(size=6)))


@pytest.mark.parametrize("name", RAILS)
def test_an_arm_on_a_rail_is_the_same_arm_in_other_conventions(name):
    # Of 60 each 30 (cobra600) and 10 (panda) were said to differ.
    chain, rng = RAILS[name], np.random.default_rng(0)
    for _ in range(4):
        other = in_other_conventions(chain, rng)
        for one, two in ((chain, other), (other, chain)):
            result = compare(one, two, samples=5)
            assert result.same_arm, result.verdict
            assert result.after is not None
            assert result.after.worst_position < 1e-4


def shifted(chain, k, size):
    """The arm with axis k moved by a size along the line from the axis before it."""
    S = chain.screws.copy()
    places = np.cross(S[:, :3], S[:, 3:])
    way = places[k] - places[k - 2]
    S[k] = screw.revolute(S[k, :3], places[k] + size * way / np.linalg.norm(way))
    return Chain.from_space(S, chain.home, limits=chain.limits)


@pytest.mark.parametrize(
    "chain, k", [(COBRA, 3), (RAILS["cobra600"], 4)], ids=["cobra600", "on a rail"]
)
def test_no_slide_far_outside_its_limits_makes_up_for_an_axis_that_is_elsewhere(chain, k):
    # An axis 8.5 mm off was "the same arm", its slide's zero position 926 m away.
    rng = np.random.default_rng(1)
    for size in (0.08e-3, 0.2e-3, 2.7e-3, 8.5e-3):
        other = in_other_conventions(shifted(chain, k, size), rng)
        for one, two in ((chain, other), (other, chain)):
            result = compare(one, two, samples=5)
            assert not result.same_arm, result.verdict
            assert all(joint.unit == "rad" or abs(joint.zero_offset) < 5 for joint in result.joints)


def test_a_slide_that_is_tilted_within_tolerance_makes_up_for_no_axis_that_is_elsewhere():
    # Half a tolerance of tilt makes up for half a millimetre, 57 m away.
    other = shifted(COBRA, 3, 0.5e-3)
    S, way = other.screws.copy(), np.cross(other.screws[3, :3], other.screws[3, 3:])
    way = way / np.linalg.norm(way)
    S[2] = screw.prismatic(S[2, 3:] + 0.5 * TOL.rotation * way)
    other = Chain.from_space(S, other.home, limits=other.limits)
    moved = other.rebased(se3.exp([0.1, -0.4, 0.2, 1, 2, 3])).retooled(
        se3.exp([0.3, 0, 0.1, 0.5, 0, 0])
    )
    for one, two in ((COBRA, moved), (moved, COBRA)):
        result = compare(one, two, samples=5)
        assert (result.same_arm, [j.number for j in result.joints if j.axis_differs]) == (
            False,
            [4],
        ), result.verdict


def as_it_stands(chain, other, zeros=(0.0,)):
    """The sides of two arms, and the reading of their bases as they stand."""
    pair = sides(chain, other, TOL)
    start = pair.as_they_stand
    start.z[:] = zeros
    (reading,) = make_hypotheses(pair, start)
    return pair, reading


def off_by_the_tolerance(chain, rng):
    """The arm with each axis off by all of the tolerances, in direction and at its place."""
    rows, ours = [], sides(chain, chain, TOL).a
    for S, place in zip(chain.screws, ours.places + ours.centre, strict=True):
        way = S[:3] if S[:3].any() else S[3:]
        across = np.cross(way, rng.normal(size=3))
        across *= 0.999 / np.linalg.norm(across)
        tilted, pitch = way + np.tan(TOL.rotation) * across, screw.axis_of(S).pitch
        if np.isinf(pitch):
            rows.append(screw.prismatic(tilted))
        else:
            another = pitch + 0.999 * TOL.position / (2 * np.pi) if pitch else 0.0
            rows.append(
                screw.helical(tilted, place + TOL.position * np.cross(way, across), another)
            )
    return Chain.from_space(rows, chain.home, limits=chain.limits)


def test_a_reading_without_a_bad_axis_holds_where_the_poses_agree_within_the_limits_of_both():
    chain = RAILS["cobra600"]
    reading, _ = search(chain, chain.rebased(se3.exp([0.1, 0.2, 0.3, 1, 2, 3])), TOL)
    other = chain.rebased(se3.exp([0.1, 0.2, 0.3, 1, 2, 3]))
    pair = sides(chain, other, TOL)
    assert poses_agree(pair, chain, other, reading)
    for change in (
        {"tool": reading.tool @ se3.exp([0, 0, 0, 0.5e-3, 0, 0])},
        {"tool": reading.tool @ se3.exp([0.5e-3, 0, 0, 0, 0, 0])},
        {"zeros": reading.zeros + np.array([0, 0, 0, 0.5e-3, 0])},
    ):
        assert not poses_agree(pair, chain, other, replace(reading, **change))
    # Slides that differ by half a tolerance make the same arm, but not where the limits of one are
    # 100 m away.
    S = chain.screws.copy()
    S[3] = se3.adjoint(se3.exp([0.5 * TOL.rotation, 0, 0, 0, 0, 0])) @ S[3]
    tilted = Chain.from_space(S, chain.home, limits=chain.limits)
    far = tilted.rezeroed([0, 0, 0, 100.0, 0])
    elsewhere = Chain.from_space(far.screws, far.home, limits=chain.limits)
    for two, z, holds in ((tilted, 0.0, True), (far, -100.0, True), (elsewhere, -100.0, False)):
        pair, held = as_it_stands(chain, two, [0, 0, 0, z, 0])
        assert not held.moved.any()
        assert poses_agree(pair, chain, two, held) == holds


@pytest.mark.parametrize("kinds", ["r", "p", "h", "f", "rp", "hr", "pr", "rprrr", "rrrrrr"])
def test_axes_within_tolerance_keep_the_poses_within_the_bound(kinds):
    way = {
        "r": screw.revolute([0, 0, 1], [0, 0, 0]),
        "p": screw.prismatic([1, 0, 0]),
        "h": screw.helical([1, 0, 0], [0, 0, 0], 0.5),
        "f": screw.helical([1, 0, 0], [0, 0, 0], 0.001),
    }
    home = np.eye(4)
    home[0, 3] = 1.0
    limits = [
        [-np.inf, np.inf] if kind == "r" else [5.0, 10.0 if kind == "p" else 200.0]
        for kind in kinds
    ]
    rng = np.random.default_rng(0)
    for _ in range(20):
        chain = Chain.from_space([way[kind] for kind in kinds], home, limits=limits)
        if len(kinds) > 2:
            S = random_arm(
                int(rng.integers(100)),
                [{"r": "revolute", "p": "prismatic"}[kind] for kind in kinds],
            )
            chain = Chain.from_space(S.screws, S.home, limits=limits)
        other = off_by_the_tolerance(chain, rng)
        pair, reading = as_it_stands(chain, other)
        assert not reading.moved.any()
        assert reading.deviations.min() > 0.99
        assert poses_agree(pair, chain, other, reading)
