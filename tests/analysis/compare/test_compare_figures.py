"""The figures and sentences of a comparison are those that the models' own numbers give."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.planted_changes import arm, random_arm
from poekin.analysis.axis_lines import Tolerances
from poekin.analysis.compare.alignment import search as searching
from poekin.analysis.compare.alignment.alignments import Alignments
from poekin.analysis.compare.alignment.hypotheses import Hypothesis
from poekin.analysis.compare.alignment.lines import sides
from poekin.analysis.compare.compare import compare
from poekin.formats import dh
from poekin.groups import se3
from poekin.model import screw
from poekin.model.chain import Chain

TOL = Tolerances(1e-5, np.radians(1e-3))


def reversed_at(chain, k):
    """The arm with joint k the other way round, its limits too."""
    S, limits = chain.screws.copy(), chain.limits.copy()
    S[k], limits[k] = -S[k], -limits[k, ::-1]
    return Chain.from_space(S, chain.home, joint_names=chain.joint_names, limits=limits)


def test_limits_of_a_joint_both_reversed_and_rezeroed_are_those_in_the_other_models_zero_and_direction():
    chain = arm("ur5e")
    limits = chain.limits.copy()
    limits[2] = np.radians([-100, 130])
    chain = Chain.from_space(chain.screws, chain.home, joint_names=chain.joint_names, limits=limits)
    other = reversed_at(chain.rezeroed([0, 0, 0.4, 0, 0, 0]), 2)
    result = compare(chain, other, samples=1)
    assert (result.joints[2].reversed, abs(result.joints[2].zero_offset)) == (
        True,
        pytest.approx(0.4),
    )
    assert result.joints[2].limits == pytest.approx((0, 0), abs=1e-9)
    limits = other.limits.copy()
    limits[2] += np.radians(
        [10, -20]
    )  # in the other direction: the upper end 10 less, the lower one 20 more
    result = compare(
        chain,
        Chain.from_space(other.screws, other.home, joint_names=chain.joint_names, limits=limits),
        samples=1,
    )
    assert result.joints[2].limits == pytest.approx(np.radians([20, -10]).tolist())


def tilted(chain, k, angle, about, along):
    """The arm with axis k turned by an angle about the line through a point along a direction."""
    S = chain.screws.copy()
    S[k] = se3.adjoint(se3.exp(angle * screw.revolute(along, about))) @ S[k]
    return Chain.from_space(S, chain.home, joint_names=chain.joint_names)


@pytest.mark.parametrize("angle", [0.02, 0.7])
def test_angle_normal_and_shift_are_those_of_the_two_lines(angle):
    chain, k = random_arm(2), 3
    other = tilted(chain, k, angle, [0.4, -0.3, 0.2], [0.3, 1, -0.2])
    joint = compare(chain, other, samples=1, strict=True).joints[k]
    (w, p, _), (u, r, _) = (screw.axis_of(model.screws[k]) for model in (chain, other))
    assert p is not None
    assert r is not None
    pair = sides(chain, chain, TOL).a
    place = pair.places[k] + pair.centre
    assert np.linalg.norm(np.cross(w, place - p)) < 1e-12
    across = np.cross(w, u)
    assert joint.angle == pytest.approx(np.arccos(w @ u), rel=1e-9)
    assert joint.normal == pytest.approx(abs((r - p) @ across) / np.linalg.norm(across), rel=1e-9)
    assert joint.shift == pytest.approx(np.linalg.norm(np.cross(u, r - place)), rel=1e-9)


def test_pose_errors_are_the_worst_and_the_mean_over_the_configurations():
    chain = arm("ur5e")
    other = tilted(chain, 2, 0.01, [0.1, 0.2, 0.3], [1, 0, 0])
    found = compare(chain, other, samples=40, seed=5, strict=True).before
    q = chain.random(5, 40)
    ours, theirs = chain.fk(q), other.fk(q)
    distance = np.linalg.norm(ours[:, :3, 3] - theirs[:, :3, 3], axis=1)
    turned = ours[:, :3, :3].swapaxes(1, 2) @ theirs[:, :3, :3]
    # |R - I| = 2 sqrt(2) sin(angle / 2) in the Frobenius norm.
    chord = np.linalg.norm(turned - np.eye(3), axis=(1, 2)) / (2 * np.sqrt(2))
    angle = 2 * np.arcsin(chord)
    assert found is not None
    assert (found.worst_position, found.mean_position) == pytest.approx(
        (distance.max(), distance.mean()), rel=1e-9
    )
    assert (found.worst_rotation, found.mean_rotation) == pytest.approx(
        (angle.max(), angle.mean()), rel=1e-9
    )
    assert angle.max() > 1.001 * angle.mean()


def test_an_axis_that_only_turns_says_how_far_it_is_at_the_arm_and_one_that_passes_by_says_both():
    chain, k = random_arm(2), 3
    pair = sides(chain, chain, TOL).a
    w, place = chain.screws[k, :3], pair.places[k] + pair.centre
    across = np.cross(w, [1, 0, 0]) / np.linalg.norm(np.cross(w, [1, 0, 0]))
    # Turned by 0.1 rad about a point of it that is 0.5 m from the arm: it crosses the old one
    # there.
    crossing = tilted(chain, k, 0.1, place + 0.5 * w, across)
    words = compare(chain, crossing, samples=1, strict=True).verdict
    far = f"{500 * np.sin(0.1):.4g} mm at the arm"
    assert (
        f"joint 4 ('joint4') has an axis that is turned by 5.73° from the other model's ({far})"
        in words
    )
    S = crossing.screws.copy()
    S[k, 3:] += np.cross(0.02 * across, S[k, :3])
    words = compare(chain, Chain.from_space(S, chain.home), samples=1, strict=True).verdict
    far = f"{1e3 * np.hypot(0.5 * np.sin(0.1), 0.02):.4g} mm at the arm"
    assert f"has an axis that is 5.73° and 20 mm from the other model's ({far})" in words
    S = chain.screws.copy()
    S[k, 3:] += np.cross(0.02 * across, w)
    words = compare(chain, Chain.from_space(S, chain.home), samples=1, strict=True).verdict
    assert "has an axis that is 20 mm from the other model's" in words
    assert "at the arm" not in words


def test_a_zero_offset_is_read_as_the_lesser_turn():
    chain = random_arm(3)
    other = chain.rezeroed([0, 0, np.radians(10), 0, 0, 0])
    pair = sides(chain, other, TOL)
    z = np.zeros((2, 6))
    z[:, 2] = np.radians([350, -370])
    for reading in searching._simplest(pair, Alignments(pair.as_they_stand.tiled(2).P, z)):
        assert np.degrees(reading.zeros) == pytest.approx([0, 0, -10, 0, 0, 0], abs=1e-9)
        assert not reading.moved.any()


def test_neighbouring_zero_offsets_are_two_zero_offsets_and_no_other_link():
    # All axes behind joint 2 have moved together, as an axis turned about itself stays where it is.
    for name in ("ur5e", "random 6a"):
        chain = arm(name)
        result = compare(chain, chain.rezeroed([0, 0.3, 0.4, 0, 0, 0]), samples=1)
        assert (result.same_arm, [j.number for j in result.joints if j.zero_differs]) == (
            True,
            [2, 3],
        ), result.verdict
        assert "link" not in result.verdict


def test_a_link_that_is_another_one_hides_no_joint_that_is_reversed_behind_it():
    table = dh.published("ur5")
    rows = list(table.rows)
    rows[1] = replace(rows[1], a=rows[1].a + 0.005)
    chain, other = dh.to_chain(table), dh.to_chain(dh.Table(table.convention, rows))
    assert "the link between" in compare(chain, other, samples=1).verdict
    result = compare(chain, reversed_at(other, 4), samples=1)
    assert result.joints[4].reversed
    assert "joint 5 ('wrist_2_joint') has the sign of q flipped" in result.verdict


def reading(moved=(), offset=(), reversed=(), frames=0, link=0, far=100.0):
    """A reading of six joints that blames these."""
    marks = np.zeros((3, 6), bool)
    for row, joints in zip(marks, (moved, offset, reversed), strict=True):
        row[list(joints)] = True
    deviations = np.where(marks[0], far, 0.1)
    return Hypothesis(
        np.eye(4), np.eye(4), np.where(marks[1], 0.1, 0.0), np.where(marks[2], -1.0, 1.0), marks[0], marks[1],
        np.zeros((6, 6)), deviations, frames, link,
    )  # fmt: skip


@pytest.mark.parametrize("better, worse", [
    (reading(), reading(offset=[2])),
    (reading(offset=[2]), reading(offset=[2], frames=1)),
    (reading(offset=[2]), reading(moved=[2])),
    (reading(moved=[2]), reading(offset=[2], frames=1)),
    (reading(moved=[2], frames=1), reading(offset=[2, 3])),
    (reading(moved=[2], frames=1), reading(reversed=[2, 3])),
    (reading(offset=[2, 3], frames=2), reading(moved=[2], frames=2)),
    (reading(moved=[2], frames=2), reading(link=2, moved=[3, 4, 5], frames=1)),
    (reading(offset=[2, 3], frames=1), reading(link=2, moved=[2, 3, 4, 5], frames=1)),
    (reading(link=2, moved=[2, 3, 4, 5], frames=1), reading(moved=[3], offset=[2, 4])),
    (reading(offset=[1, 2, 3, 4], reversed=[1, 3], frames=2), reading(moved=[2], frames=2)),
    (reading(moved=[2, 3], far=50.0), reading(moved=[2, 3], far=500.0)),
    # one axis, however far it moved
    (reading(moved=[2], offset=[4], far=1000.0), reading(moved=[2, 3], far=2.0)),
])  # fmt: skip
def test_one_reading_is_better_than_another(better, worse):
    assert better.cost < worse.cost


def test_each_joint_has_the_name_and_the_kind_of_either_model():
    a, b = random_arm(2), random_arm(2)
    S = b.screws.copy()
    S[4] = screw.prismatic(S[4, :3])
    a, b = (
        Chain.from_space(rows, a.home, joint_names=[f"{name}{k}" for k in range(6)])
        for rows, name in ((a.screws, "a"), (S, "b"))
    )
    joints = compare(a, b, samples=1).joints
    assert [(j.number, j.name_a, j.name_b) for j in joints] == [
        (k + 1, f"a{k}", f"b{k}") for k in range(6)
    ]
    assert [(j.kind_a, j.kind_b, j.unit) for j in joints[3:5]] == [("revolute", "revolute", "rad"),
                                                                   ("revolute", "prismatic", "m")]  # fmt: skip
    assert (joints[4].normal, joints[4].shift) == (None, None)
    assert compare(b, a, samples=1).joints[4].unit == "rad"


def test_a_zero_offset_that_no_agreeing_axis_needs_is_put_back_though_another_axis_disagrees():
    chain = random_arm(3)
    S = chain.screws.copy()
    across = np.cross(S[2, :3], S[0, :3])
    S[2, 3:] += np.cross(1e-3 * across / np.linalg.norm(across), S[2, :3])
    other = Chain.from_space(S, chain.home)
    pair = sides(chain, other, TOL)
    start = pair.as_they_stand
    start.z[0, 5] = 0.4
    (found,) = searching._simplest(pair, start)
    assert found.zeros.tolist() == [0.0] * 6
    assert found.moved.sum() >= 1


def test_zero_offsets_of_inner_joints_alone_are_no_turn_of_base_or_tool():
    pair = sides(random_arm(1), random_arm(1), TOL)
    assert searching._inner(pair).tolist() == [False, True, True, True, True, False]
