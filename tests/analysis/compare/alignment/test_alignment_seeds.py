"""Alignments start where two of b's axes lie on a's, and a turn brings a third one there."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.planted_changes import random_arm
from poekin.analysis.axis_lines import Tolerances
from poekin.analysis.compare.alignment import alignment_seeds
from poekin.analysis.compare.alignment.alignment_seeds import (
    one_turn,
    pair_poses,
    rigid_poses,
    turns,
)
from poekin.analysis.compare.alignment.alignments import Alignments
from poekin.analysis.compare.alignment.lines import lines, sides
from poekin.analysis.compare.compare import compare
from poekin.groups import se3
from poekin.model import screw
from poekin.model.chain import Chain

PARALLEL = Chain.from_space(
    [screw.revolute([0, 0, 1], [x, 0.1 * x * x, 0]) for x in (0.0, 0.4, 0.7)], np.eye(4)
)
RNG = np.random.default_rng(0)
BASE = se3.exp(RNG.normal(size=6))
BEST = alignment_seeds.best


def test_an_axis_misses_by_its_angle_and_by_its_distance_at_the_place_of_the_other():
    chain = random_arm(3)
    S = chain.screws.copy()
    foot = np.cross(S[1, :3], S[1, 3:])
    ours = lines(chain)
    place = ours.places[1] + ours.centre
    across = np.cross(S[1, :3], S[2, :3]) / np.linalg.norm(np.cross(S[1, :3], S[2, :3]))
    # Turned by 1e-3 about a point of it that is 0.5 m from its place, which so moves by 0.5 mm.
    S[1] = se3.adjoint(se3.exp(1e-3 * screw.revolute(across, place + 0.5 * S[1, :3]))) @ S[1]
    pair = sides(chain, Chain.from_space(S, chain.home), Tolerances(1e-5, 1e-3))
    assert pair.deviations(pair.as_they_stand)[0] == pytest.approx(
        [0, 50, 0, 0, 0, 0], rel=1e-3, abs=1e-9
    )
    assert np.linalg.norm(place - foot) > 1e-2  # else the place would be that of the base


@pytest.mark.parametrize("signs", [(1, 1, 1), (-1, 1, 1), (1, -1, -1), (-1, -1, -1)], ids=str)
@pytest.mark.parametrize(
    "chain", [random_arm(5, ("revolute",) * 3), PARALLEL], ids=["skew", "parallel"]
)
def test_one_pose_of_each_pair_of_axes_brings_all_of_a_moved_arm_home(chain, signs):
    moved = chain.rebased(BASE)
    pair = sides(
        chain,
        Chain.from_space(moved.screws * np.array(signs)[:, None], moved.home),
        Tolerances(1e-6, 1e-6),
    )
    for joints in [(0, 1), (0, 2), (1, 2)]:
        found = pair_poses(pair, [joints])
        miss = pair.deviations(found.at)
        assert (found.joints == joints).all()
        assert miss[:, joints].max() < 1e-3  # that is 1e-9, far above rounding
        assert miss.max(axis=1).min() < 1e-3


@pytest.mark.parametrize("k", [1, 2, 3, 4])
def test_one_turn_finds_a_zero_offset_from_the_poses_before_the_joint_and_from_those_behind_it(k):
    chain = random_arm(4)
    offset = np.where(np.arange(6) == k, 0.7, 0.0)
    pair = sides(chain, chain.rezeroed(offset).rebased(BASE), Tolerances(1e-6, 1e-6))
    poses = rigid_poses(pair)
    joints = poses.joints
    for i in (joints[:, 0] >= k, (joints[:, 0] >= 0) & (joints[:, 1] <= k)):
        if i.any():
            found = one_turn(pair, poses[i], k)
            assert pair.deviations(found[:1]).max() < 1e-3
            assert found.z[0] == pytest.approx(-offset, abs=1e-9)


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


def test_an_angle_about_a_direction_comes_with_the_lesser_length_across_it():
    w, u, v = np.array([0.0, 0, 1]), np.array([1.0, 0, 5]), np.array([0.0, 2, 7])
    assert np.ravel(alignment_seeds._angle(w, u, v)) == pytest.approx([np.pi / 2, 1])
    assert np.ravel(alignment_seeds._angle(w, v, u)) == pytest.approx([-np.pi / 2, 1])


@pytest.mark.parametrize("ways", [(1, -1), (1, -1, 1), (1, -1, -1)], ids=str)
@pytest.mark.parametrize(
    "xi", [(np.pi, 0, 0, 0.3, 0.1, 0.2), (0, np.pi, 0, 0, 0, 0), (0.3, 1.0, -0.4, 2, 0, 1)], ids=str
)
def test_parallel_axes_that_point_opposite_ways_are_turned_with_the_base(ways, xi):
    places = [0.0, 0.5, 1.2]
    rows = [screw.revolute([0, 0, way], [x, 0, 0]) for way, x in zip(ways, places, strict=False)]
    chain = Chain.from_space(rows, np.eye(4))
    result = compare(chain, chain.rebased(se3.exp(xi)), samples=1)
    assert (result.same_arm, result.differing, result.tool) == (
        True,
        (),
        pytest.approx(np.eye(4), abs=1e-9),
    )
    assert result.base == pytest.approx(se3.inverse(se3.exp(xi)), abs=1e-9)


def two_lines(cosine, gap=0.5):
    """An axis along z, and one at `gap` along x whose direction has this cosine to it."""
    way = [0, np.sqrt(1 - cosine * cosine), cosine]
    return Chain.from_space(
        [screw.revolute([0, 0, 1], [0, 0, 0]), screw.revolute(way, [gap, 0, 0])], np.eye(4)
    )


@pytest.mark.parametrize(
    "cosine, poses", [(0.5, 2), (0.535, 2), (0.465, 2), (0.545, 0), (0.455, 0), (-0.5, 2)]
)
def test_axes_at_another_angle_are_not_carried_onto_each_other(cosine, poses):
    pair = sides(two_lines(0.5), two_lines(cosine), Tolerances(1e-6, 1e-6))
    found = pair_poses(pair, [(0, 1)])
    assert (found.joints.shape, found.at.P.shape) == ((poses, 2), (poses, 4, 4))
    assert found.at.z.shape == (poses, 2)


SKEW = lines(
    Chain.from_space(
        [screw.revolute([0, 0, 2], [1, 2, 0]), screw.revolute([0, 1, 1], [1.5, 7, 4])], np.eye(4)
    )
)


def test_the_frame_of_two_axes_stands_on_the_first_where_their_common_normal_begins():
    # The second axis comes by x = 1.5, y = 2 at z = -1.
    one, other = alignment_seeds._frame(SKEW, 0, 1), alignment_seeds._frame(SKEW, 1, 0)
    assert one is not None
    assert other is not None
    frame, cosine, parallel = one
    assert frame[:3, 3] + SKEW.centre == pytest.approx([1, 2, -1])
    assert frame[:3, 2] == pytest.approx([0, 0, 1])
    assert frame[:3, 0] == pytest.approx([-1, 0, 0])  # z cross the other's direction
    assert np.linalg.det(frame[:3, :3]) == pytest.approx(1)
    assert (cosine, parallel) == (pytest.approx(np.sqrt(0.5)), False)
    back = other[0]
    assert back[:3, 3] + SKEW.centre == pytest.approx([1.5, 2, -1])
    assert back[:3, 2] == pytest.approx(np.sqrt([0, 0.5, 0.5]))


@pytest.mark.parametrize("tilt, gap, found", [
    (0.0, 0.5, True), (0.019, 0.5, True), (0.0, 1.1e-5, True), (0.0, 0.9e-5, False), (0.019, 0.0, False),
    (0.021, 0.5, False), (0.021, 0.0, False),
])  # fmt: skip
def test_the_frame_of_parallel_axes_looks_from_the_one_to_the_other(tilt, gap, found):
    side = lines(two_lines(np.cos(tilt), gap))
    found_frame = alignment_seeds._frame(side, 0, 1)
    assert (found_frame is not None and found_frame[2]) == found
    assert (found_frame is not None) == (found or tilt > alignment_seeds.PARALLEL)
    if found_frame is not None and found:
        assert found_frame[0][:3, :3] == pytest.approx(np.eye(3), abs=0.02)
        assert (found_frame[0][:3, 3] == side.places[0]).all()


def test_the_frame_of_a_slide_stands_on_the_axis_beside_it_and_two_slides_have_one_only_where_they_cross():
    slide, turn = screw.prismatic([1, 0, 0]), screw.revolute([0, 0, 1], [0, 3, 0])
    for rows, i, j in (([slide, turn], 0, 1), ([turn, slide], 0, 1)):
        side = lines(Chain.from_space(rows, np.eye(4)))
        found = alignment_seeds._frame(side, i, j)
        assert found is not None
        assert found[0][:3, 3] + side.centre == pytest.approx([0, 3, 0])
        assert found[0][:3, 2] == pytest.approx(side.ways[0])
    assert (
        alignment_seeds._frame(
            lines(Chain.from_space([slide, screw.prismatic([1, 1e-3, 0])], np.eye(4))), 0, 1
        )
        is None
    )
    assert (
        alignment_seeds._frame(
            lines(Chain.from_space([slide, screw.revolute([1, 0, 0], [0, 3, 0])], np.eye(4))), 0, 1
        )
        is None
    )
    crossing = alignment_seeds._frame(
        lines(Chain.from_space([slide, screw.prismatic([0, 1, 0])], np.eye(4))), 0, 1
    )
    assert crossing is not None
    assert (crossing[0][:3, 3] == 0).all()


def test_an_axis_behind_slides_is_anchored_where_the_next_links_that_turn_have_it():
    slide, here, level = screw.prismatic([0, 1, 0]), [1, 2, 0], [3, 2, 5]
    first, beside = screw.revolute([0, 0, 1], here), screw.revolute([0, 0, -1], level)
    across = screw.revolute([0, 1, 0], [4, 0, -7])
    for rows, k, expected in (
        ([slide, first, across], 1, [1, 2, -7]),
        ([slide, first, beside, across], 1, [1, 2, -7]),
        ([slide, first, across, slide, across], 1, [1, 2, -7]),
        ([slide, first, slide, across], 1, None),
        ([slide, first, beside], 1, None),
        ([slide, first, beside, first], 1, None),
        ([slide, first, beside, slide, across], 1, None),
    ):
        side = lines(Chain.from_space(rows, np.eye(4)))
        anchor = alignment_seeds._anchor(side, k)
        assert (anchor is None) == (expected is None)
        if anchor is not None:
            assert anchor + side.centre == pytest.approx(expected)


def test_both_turns_that_make_an_axis_parallel_to_its_target_are_within_half_a_turn():
    S, axis = screw.revolute([0, 0, 1], [0.3, 0, 0]), screw.revolute([1, 0.3, 0.4], [0, 0.2, 0.5])
    for angle in (0.6, -0.6, 3.0):
        one, other = turns(S, axis, se3.adjoint(se3.exp(angle * S)) @ axis)
        assert one == pytest.approx(angle)
        assert other == pytest.approx(angle - np.copysign(np.pi, angle))


def test_a_slide_along_an_axis_moves_it_nowhere():
    for slant, expected in ((0.01, 0.0), (0.03, 0.4)):
        slide, axis = screw.prismatic([slant, 0, 1]), screw.revolute([0, 0, 1], [1, 2, 3])
        z = turns(slide, axis, se3.adjoint(se3.exp(0.4 * slide)) @ axis)
        assert z[0] == pytest.approx(expected)
    assert turns(slide, screw.prismatic([0, 0, 1]), axis)[0] == 0


def test_the_best_alignments_are_those_under_which_most_axes_agree_and_fewest_things_change():
    chain = random_arm(3, ("revolute",) * 4)
    pair = sides(chain, chain, Tolerances(1e-5, 1e-5))
    away = [np.eye(4), *(se3.exp(np.array([0, 0, 0, size, 0, 0])) for size in (1e-7, 5e-3, 5.0))]
    z = np.zeros((5, 4))
    z[0, 3] = 0.5  # moves no axis
    P = np.stack([away[i] for i in (0, 3, 2, 1, 0)])
    at = Alignments(P, z)
    found = alignment_seeds.best(pair, at, 5)
    order = [
        np.flatnonzero((P == D).all((1, 2)) & (z == x).all(1)).tolist()
        for D, x in zip(found.P, found.z, strict=True)
    ]
    assert order == [[4], [0], [3], [2], [1]]
    assert alignment_seeds.best(pair, at).z.shape == (4, 4)


def test_one_axis_far_off_counts_less_than_several_that_miss():
    chain = random_arm(3, ("revolute",) * 4)
    S = chain.screws.copy()
    S[3] = screw.prismatic([0, 0, 1])  # another kind, so that it never agrees
    pair = sides(Chain.from_space(S, chain.home), chain, Tolerances(1e-5, 1e-5))
    centres = pair.as_they_stand.P[0]
    P = np.stack([se3.exp(np.array([0, 0, 0, 5e-4, 0, 0])) @ centres, centres])
    assert alignment_seeds.best(pair, Alignments.rigid(P, 4), 1).P[0] == pytest.approx(centres)


def test_two_axes_are_aligned_as_one_pair():
    chain = two_lines(0.3)
    pair = sides(chain, chain.rebased(BASE), Tolerances(1e-6, 1e-6))
    found = alignment_seeds.one_by_one(pair)
    assert pytest.approx(pair_poses(pair, [(0, 1)]).at.P) == found.P
    assert (found.z == np.zeros((2, 2))).all()
    alone = Chain.from_space(chain.screws[:1], chain.home)
    assert (
        pytest.approx(np.eye(4)[None])
        == alignment_seeds.one_by_one(sides(alone, alone, Tolerances(1e-6, 1e-6))).P
    )


@pytest.mark.parametrize("k", [1, 2, 3, 4])
@pytest.mark.parametrize("behind", [False, True])
def test_beyond_many_alignments_each_pose_is_tried_with_the_turns_of_one_axis(
    k, behind, monkeypatch
):
    chain = random_arm(4)
    offset = np.where(np.arange(6) == k, 0.7, 0.0)
    pair = sides(chain, chain.rezeroed(offset).rebased(BASE), Tolerances(1e-6, 1e-6))
    poses = rigid_poses(pair)
    joints = poses.joints
    some = joints[:, 0] >= k if behind else (joints[:, 0] >= 0) & (joints[:, 1] <= k)
    if some.any():
        kept = []
        monkeypatch.setattr(alignment_seeds, "MOST", -1)
        monkeypatch.setattr(
            alignment_seeds, "best", lambda pair, at: kept.append(len(at)) or BEST(pair, at)
        )
        found = one_turn(pair, poses[some], k)
        assert kept == [2 * some.sum()]
        assert pair.deviations(found[:1]).max() < 1e-3


def test_a_helical_axis_has_its_line_as_a_revolute_one_has():
    rng = np.random.default_rng(3)
    ways, places = rng.normal(size=(2, 3, 3))
    plain = lines(
        Chain.from_space(
            [screw.revolute(*line) for line in zip(ways, places, strict=True)], np.eye(4)
        )
    )
    bolts = lines(
        Chain.from_space(
            [screw.helical(*line, 0.1) for line in zip(ways, places, strict=True)], np.eye(4)
        )
    )
    for i, j in ((0, 1), (1, 2), (2, 0)):
        one, other = alignment_seeds._frame(plain, i, j), alignment_seeds._frame(bolts, i, j)
        assert one is not None
        assert other is not None
        assert other[0] == pytest.approx(one[0], abs=1e-12)


@pytest.mark.parametrize(
    "first", [screw.revolute, lambda z, p: screw.helical(z, p, 0.1)], ids=["turns", "bolt"]
)
def test_poses_are_moved_along_slides_to_where_the_first_axis_that_turns_has_its_place(first):
    rows = [
        screw.prismatic([1, 0, 0]),
        first([0, 0, 1], [1, 2, 0]),
        screw.revolute([0, 1, 0], [4, 0, -7]),
    ]
    chain = Chain.from_space(rows, np.eye(4))
    moved = chain.rezeroed([3.0, 0, 0]).rebased(BASE)  # the slide has moved what is behind it
    pair = sides(chain, moved, Tolerances(1e-6, 1e-6))
    P = se3.inverse(BASE)
    P[:3, 3] += P[:3, :3] @ pair.b.centre - pair.a.centre + [0.3, 0.2, 0.1]
    (D,) = alignment_seeds._on_the_first_turning_axis(pair, P[None])
    miss = pair.deviations(Alignments.rigid(D[None], 3))[0]
    assert miss[1:].max() < 1e-3
    turning = sides(
        Chain.from_space(chain.screws[1:], chain.home),
        Chain.from_space(moved.screws[1:], moved.home),
        Tolerances(1e-6, 1e-6),
    )
    assert alignment_seeds._on_the_first_turning_axis(turning, P[None]) == pytest.approx(P[None])


@pytest.mark.parametrize(
    "offset", [(0, 0, 0, 0, 0, 0), (0, 0.7, 0, -0.4, 0.5, 0), (0, 0, 1.9, 0, 0, 0)], ids=str
)
@pytest.mark.parametrize("wrists", [False, True])
def test_the_few_alignments_that_are_kept_are_those_that_miss_least_and_change_least(
    offset, wrists, monkeypatch
):
    # Where a half turn brings an axis onto itself the other way round, the one without is kept.
    z, y, x = [0, 0, 1], [0, 1, 0], [1, 0, 0]
    rows = [
        (z, [0, 0, 0]),
        (y, [0, 0, 0.3]),
        (y, [0.5, 0, 0.4]),
        (x, [1, 0, 0.2]),
        (y, [1, 0, 0.2]),
        (x, [1, 0, 0.2]),
    ]
    chain = (
        Chain.from_space([screw.revolute(*row) for row in rows], np.eye(4))
        if wrists
        else random_arm(4)
    )
    pair = sides(chain, chain.rezeroed(offset).rebased(BASE), Tolerances(1e-6, 1e-6))
    monkeypatch.setattr(alignment_seeds, "BEAM", 2)
    found = alignment_seeds.one_by_one(pair)
    assert len(found) == 2
    assert pair.deviations(found)[0].max() < 1e-3
    assert np.sort((abs(found.z) > 1e-6).sum(1))[0] <= np.count_nonzero(offset)


def test_pairs_without_a_frame_or_at_another_angle_are_passed_over():
    z, x = [0, 0, 1], [1, 0, 0]
    one = Chain.from_space(
        [screw.revolute(*row) for row in ((z, [0, 0, 0]), (z, [0, 0, 1]), (x, [0, 1, 0]))],
        np.eye(4),
    )
    pair = sides(one, one, Tolerances(1e-6, 1e-6))
    found = pair_poses(pair, [(0, 1), (0, 2), (1, 2)])
    assert sorted({tuple(map(int, row)) for row in found.joints}) == [(0, 2), (1, 2)]
    other = sides(
        one,
        Chain.from_space([one.screws[0], *one.screws[[2, 2]]], np.eye(4)),
        Tolerances(1e-6, 1e-6),
    )
    found = pair_poses(other, [(0, 1), (1, 2), (0, 2)])
    assert {tuple(map(int, row)) for row in found.joints} == {(0, 2)}


def test_the_first_pose_is_the_base_as_it_is_and_the_others_are_of_pairs_of_joints_of_the_same_kind():
    chain = random_arm(4, ("revolute",) * 4)
    rows = [*chain.screws[:3], screw.prismatic([1, 2, 3])]
    pair = sides(chain, Chain.from_space(rows, chain.home), Tolerances(1e-6, 1e-6))
    poses = rigid_poses(pair)
    joints = poses.joints
    as_it_is = np.eye(4)
    as_it_is[:3, 3] = pair.b.centre - pair.a.centre
    assert joints[0].tolist() == [-1, -1]
    assert poses.at.P[0] == pytest.approx(as_it_is)
    assert {tuple(map(int, row)) for row in joints[1:]} == {(0, 1), (0, 2), (1, 2)}
    assert len(joints) == len(poses.at)
    assert not poses.at.z.any()


@pytest.mark.parametrize("k", [1, 2, 3, 4])
def test_the_axes_on_the_other_side_of_a_joint_tell_its_offset(k, monkeypatch):
    chain = random_arm(4, ("revolute",) * 6)
    pair = sides(
        chain,
        chain.rezeroed(np.where(np.arange(6) == k, 0.7, 0.0)).rebased(BASE),
        Tolerances(1e-6, 1e-6),
    )
    poses = rigid_poses(pair)
    joints = poses.joints
    kept = []
    monkeypatch.setattr(
        alignment_seeds, "best", lambda pair, at: kept.append(len(at)) or BEST(pair, at)
    )
    front, back = joints[:, 1] <= k, joints[:, 0] >= k
    for some in (front, back, front | back):
        if some.any():
            one_turn(pair, poses[some], k)
    # Each brings there either of two turns.
    counts = [2 * some.sum() * others for some, others in ((front, 5 - k), (back, k)) if some.any()]
    assert kept == [*counts, sum(counts)]


def test_of_two_alignments_alike_the_one_that_reverses_no_axis_is_best():
    rows = [screw.revolute(z, [0, 0, 0]) for z in ([0, 0, 1], [1, 0, 0])]
    chain = Chain.from_space(rows, np.eye(4))
    pair = sides(chain, chain, Tolerances(1e-5, 1e-5))
    half_turn = np.diag([-1.0, -1.0, 1.0, 1.0])  # the second axis points the other way
    at = Alignments.rigid(np.stack([half_turn, np.eye(4)]), 2)
    np.testing.assert_array_equal(alignment_seeds.best(pair, at, 1).P[0], np.eye(4))
