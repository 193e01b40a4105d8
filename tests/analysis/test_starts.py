"""Alignments start where two of b's axes lie on a's, and a turn brings a third one there."""

from __future__ import annotations

import numpy as np
import pytest

from poekin.analysis.compare import compare
from poekin.analysis.lines import carried, lines, misses, sides
from poekin.analysis.starts import one_turn, pair_poses, rigid_poses, turns
from poekin.groups import se3
from poekin.model import screw
from poekin.model.chain import Chain
from poekin.testing.planted_changes import random_arm

PARALLEL = Chain([screw.revolute([0, 0, 1], [x, 0.1 * x * x, 0]) for x in (0.0, 0.4, 0.7)], np.eye(4))
RNG = np.random.default_rng(0)
BASE = se3.exp(RNG.normal(size=6))


def test_an_axis_misses_by_its_angle_and_by_its_distance_at_the_place_of_the_other():
    chain = random_arm(3)
    S = chain.screws.copy()
    foot = np.cross(S[1, :3], S[1, 3:])
    ours = lines(chain)
    place = ours.places[1] + ours.hub
    across = np.cross(S[1, :3], S[2, :3]) / np.linalg.norm(np.cross(S[1, :3], S[2, :3]))
    # Turned by 1e-3 about a point of it that is 0.5 m from its place, which so moves by 0.5 mm.
    S[1] = se3.adjoint(se3.exp(1e-3 * screw.revolute(across, place + 0.5 * S[1, :3]))) @ S[1]
    pair = sides(chain, Chain(S, chain.home), 1e-5, 1e-3)
    P = np.eye(4)
    P[:3, 3] = pair.b.hub - pair.a.hub
    nothing = np.zeros((1, 6))
    assert misses(pair, carried(pair, P[None], nothing)[1])[0] == pytest.approx([0, 50, 0, 0, 0, 0], rel=1e-3, abs=1e-9)
    assert np.linalg.norm(place - foot) > 1e-2  # else the place would be that of the base


@pytest.mark.parametrize("signs", [(1, 1, 1), (-1, 1, 1), (1, -1, -1), (-1, -1, -1)], ids=str)
@pytest.mark.parametrize("chain", [random_arm(5, ("revolute",) * 3), PARALLEL], ids=["skew", "parallel"])
def test_one_pose_of_each_pair_of_axes_brings_all_of_a_moved_arm_home(chain, signs):
    moved = chain.rebased(BASE)
    pair = sides(chain, Chain(moved.screws * np.array(signs)[:, None], moved.home), 1e-6, 1e-6)
    for joints in [(0, 1), (0, 2), (1, 2)]:
        found, D = pair_poses(pair, [joints])
        miss = misses(pair, carried(pair, D, np.zeros((len(D), 3)))[1])
        assert (found == joints).all()
        assert miss[:, joints].max() < 1e-3  # that is 1e-9, far above rounding
        assert miss.max(axis=1).min() < 1e-3


@pytest.mark.parametrize("k", [1, 2, 3, 4])
def test_one_turn_finds_a_zero_offset_from_the_poses_before_the_joint_and_from_those_behind_it(k):
    chain = random_arm(4)
    offset = np.where(np.arange(6) == k, 0.7, 0.0)
    pair = sides(chain, chain.rezeroed(offset).rebased(BASE), 1e-6, 1e-6)
    joints, D = rigid_poses(pair)
    for i in (joints[:, 0] >= k, (joints[:, 0] >= 0) & (joints[:, 1] <= k)):
        if i.any():
            P, z = one_turn(pair, (joints[i], D[i]), k)
            assert misses(pair, carried(pair, P[:1], z[:1])[1]).max() < 1e-3
            assert z[0] == pytest.approx(-offset, abs=1e-9)


def test_a_turn_brings_an_axis_onto_its_target_whether_it_slants_or_is_parallel_to_the_joint_or_the_joint_slides():
    S, axis = screw.revolute([0.1, 0.2, 1], [0.3, 0, 0]), screw.revolute([1, 0.3, 0], [0, 0.2, 0.5])
    beside = screw.revolute([0.1, 0.2, 1], [0, 0.4, 0])
    for joint, line, ways in ((S, axis, 2), (S, beside, 1), (screw.prismatic([0, 1, 1]), axis, 1)):
        target = se3.adjoint(se3.exp(0.6 * joint)) @ line
        z = turns(joint, line, target)
        assert z[0] == pytest.approx(0.6, abs=1e-9)
        assert np.isnan(z[1]) == (ways == 1)
    assert turns(S, S, S)[0] == 0
    assert turns(S, screw.prismatic(S[:3]), screw.prismatic(S[:3]))[0] == 0


@pytest.mark.parametrize("ways", [(1, -1), (1, -1, 1), (1, -1, -1)], ids=str)
@pytest.mark.parametrize(
    "xi", [(np.pi, 0, 0, 0.3, 0.1, 0.2), (0, np.pi, 0, 0, 0, 0), (0.3, 1.0, -0.4, 2, 0, 1)], ids=str
)
def test_parallel_axes_that_point_opposite_ways_are_turned_with_the_base(ways, xi):
    places = [0.0, 0.5, 1.2]
    rows = [screw.revolute([0, 0, way], [x, 0, 0]) for way, x in zip(ways, places, strict=False)]
    chain = Chain(rows, np.eye(4))
    result = compare(chain, chain.rebased(se3.exp(xi)), samples=1)
    assert (result.equal, result.differing, result.tool) == (True, (), pytest.approx(np.eye(4), abs=1e-9))
    assert result.base == pytest.approx(se3.inverse(se3.exp(xi)), abs=1e-9)
