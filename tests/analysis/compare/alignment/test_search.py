"""Of the readings of a difference the simplest is chosen, and the others that say as much are kept."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from benchmarks.planted_changes import random_arm
from poekin.analysis.axis_lines import Tolerances
from poekin.analysis.compare.alignment import search as module
from poekin.analysis.compare.alignment.alignment_seeds import rigid_poses
from poekin.analysis.compare.alignment.alignments import Alignments
from poekin.analysis.compare.alignment.hypotheses import Hypothesis
from poekin.analysis.compare.alignment.lines import sides
from poekin.analysis.compare.alignment.search import (
    _fitting,
    _inner,
    _links,
    _others,
    _simpler,
    _simplest,
    search,
)
from poekin.analysis.compare.compare import compare
from poekin.groups import se3
from poekin.model import screw
from poekin.model.chain import Chain

N = 4
TOL = Tolerances(1e-5, np.radians(1e-3))


def reading(moved=(), offset=(), reversed_=(), frames=0, link=0):
    """A reading that blames these joints, from 0."""
    at = np.arange(N)
    return Hypothesis(
        np.eye(4), np.eye(4), np.zeros(N), np.where(np.isin(at, reversed_), -1.0, 1.0), np.isin(at, moved),
        np.isin(at, offset), np.zeros((N, 6)), np.zeros(N), frames, link,
    )  # fmt: skip


def test_the_others_blame_one_joint_too_and_each_another_or_for_something_else():
    first, axis, zero, back = (
        reading(moved=[1]),
        reading(moved=[2]),
        reading(offset=[1]),
        reading(reversed_=[1]),
    )
    behind = [reading(moved=[1]), axis, zero, reading(offset=[1], frames=2), back, axis]
    behind += [
        reading(),
        reading(moved=[1, 2]),
        reading(moved=[0], offset=[0]),
        reading(offset=[3], reversed_=[2]),
    ]
    assert _others(first, behind) == [axis, zero, back]
    assert _others(zero, behind[:1]) == behind[:1]
    for several in (reading(), reading(moved=[1, 2]), reading(offset=[0, 1, 2])):
        assert _others(several, behind) == []
    # A joint that differs in two things is one joint, but says less shortly.
    assert _others(reading(moved=[1], offset=[1]), [axis]) == [axis]


def test_of_conventions_the_fewest_count_and_a_moved_base_is_one_of_them():
    moved_base = reading(reversed_=[1, 2, 3], frames=1)
    in_place = reading(reversed_=[0, 1, 2])
    assert _simpler(moved_base, [moved_base, in_place]) is in_place
    as_many = reading(reversed_=[0, 1, 2, 3])
    assert _simpler(moved_base, [moved_base, as_many]) is moved_base


def test_a_reading_that_blames_fewer_joints_and_moves_no_frame_comes_before_one_that_moves_them():
    first, simple = reading(offset=[0, 1], frames=1), reading(moved=[2])
    assert _simpler(first, [first, simple]) is simple
    for other in (
        reading(moved=[2], frames=1),
        reading(offset=[1, 2, 3]),
        reading(moved=[0, 1]),
        reading(moved=[0, 1, 2]),
    ):
        assert _simpler(first, [first, other]) is first
    for kept in (reading(offset=[0, 1]), reading(offset=[0, 1], frames=1, link=2)):
        assert _simpler(kept, [kept, simple]) is kept
    assert _simpler(first, [reading(offset=[1, 2, 3]), simple, reading(moved=[1])]) is simple


@pytest.mark.parametrize("n", range(5))
def test_the_zeros_of_the_first_and_the_last_joint_are_turns_of_base_and_tool(n):
    chain = random_arm(1, ("revolute",) * n)
    expected = [0 < k < n - 1 for k in range(n)]
    assert _inner(sides(chain, chain, TOL)).tolist() == expected


@pytest.mark.parametrize("n, k", [(5, 2), (5, 3), (4, 2)])
def test_a_link_of_another_shape_moves_what_is_behind_it_and_the_tool_with_it(n, k):
    chain = random_arm(7, ("revolute",) * n)
    base, bent = se3.exp([0.3, -0.5, 0.2, 1, 2, 3]), se3.exp([0.02, 0.01, 0.03, 0.1, 0.2, 0.1])
    S = np.concatenate([chain.screws[:k], chain.screws[k:] @ se3.adjoint(bent).T])
    for tool, frames in ((np.eye(4), 1), (se3.exp([0, 0, 0, 0, 0, 0.1]), 2)):
        # The tool is the one behind the link: it has moved with it.
        other = Chain.from_space(S, bent @ chain.home @ tool).rebased(base)
        pair = sides(chain, other, TOL)
        (found,) = _links(pair, rigid_poses(pair).at)
        assert (found.link, found.frames, found.moved.tolist()) == (
            k,
            frames,
            [i >= k for i in range(n)],
        )
        assert found.base == pytest.approx(se3.inverse(base), abs=1e-9)
        assert found.tool == pytest.approx(se3.inverse(tool), abs=1e-9)
    same = sides(chain, chain, TOL)
    assert _links(same, rigid_poses(same).at) == []


@pytest.mark.parametrize("axis", [0, 1, 2, 4])
@pytest.mark.parametrize(("tolerances", "links"), [(0.6, 1), (1.6, 0)])
def test_axes_on_both_sides_of_a_link_agree_within_the_tolerance(axis, tolerances, links):
    chain = random_arm(7, ("revolute",) * 5)
    bent = se3.exp([0.02, 0.01, 0.03, 0.1, 0.2, 0.1])
    S = np.concatenate([chain.screws[:2], chain.screws[2:] @ se3.adjoint(bent).T])
    other = Chain.from_space(S, bent @ chain.home)
    at = rigid_poses(sides(chain, other, TOL)).at
    way = np.cross(S[axis, :3], [0.6, 0.0, 0.8])
    step = tolerances * TOL.position * way / np.linalg.norm(way)
    S[axis] = se3.adjoint(se3.exp([0, 0, 0, *step])) @ S[axis]
    off = sides(chain, other.replace(screws=S), TOL)
    assert len(_links(off, at)) == links
    S[axis] *= -1.0  # an axis that points the other way is no link's
    assert _links(sides(chain, other.replace(screws=S), TOL), at) == []


@pytest.mark.parametrize(("tolerances", "agree"), [(1.0, True), (2.0, False)])
def test_a_reading_is_of_a_start_whose_used_axes_agree_within_tolerance(tolerances, agree):
    chain = random_arm(7, ("revolute",) * 5)
    S = chain.screws.copy()
    way = np.cross(S[2, :3], [0.6, 0.0, 0.8])
    step = tolerances * TOL.position * way / np.linalg.norm(way)
    S[2] = se3.adjoint(se3.exp([0, 0, 0, *step])) @ S[2]
    pair = sides(chain, Chain.from_space(S, chain.home), TOL)
    # Fitted, the moved axis misses by 0.7 of its shift, the others by less.
    assert bool(_fitting(pair, pair.as_they_stand, np.ones(5, bool))) == agree
    assert _fitting(pair, pair.as_they_stand, np.arange(5) != 2)


def test_a_link_with_one_axis_behind_it_is_an_axis_that_moved():
    chain = random_arm(7, ("revolute",) * 4)
    S = chain.screws.copy()
    S[3] = se3.adjoint(se3.exp([0.02, 0.01, 0.03, 0.1, 0.2, 0.1])) @ S[3]
    other = Chain.from_space(S, chain.home)
    pair = sides(chain, other, TOL)
    assert _links(pair, rigid_poses(pair).at) == []


def test_zero_offsets_that_no_axis_needs_are_put_back_and_whole_turns_taken_off():
    chain = random_arm(3, ("revolute",) * 5)
    other = chain.rezeroed([0, 0, 0.4, 0, 0])
    pair = sides(chain, other, TOL)
    # The last offset moves no axis; -0.4 and a turn less are one to a revolute joint.
    z = np.array([[0, 0, -0.4, 0, 0.3], [0, 0, -0.4 + 2 * np.pi, 0, 0.0], [0, 0, -0.4, 1e-9, 0.0]])
    for found in _simplest(pair, Alignments(pair.as_they_stand.tiled(3).P, z)):
        assert found.zeros == pytest.approx([0, 0, -0.4, 0, 0], abs=1e-9)
        assert (found.zeros == 0).tolist() == [True, True, False, True, True]
        assert not found.moved.any()


@pytest.mark.parametrize("n", [1, 2, 3])
@pytest.mark.parametrize("kind", ["axis", "zero", "direction"])
def test_arms_of_few_joints_are_read_too(n, kind):
    chain, k = random_arm(5, ("revolute",) * n), n // 2
    S = chain.screws.copy()
    if kind == "axis":
        S[k] = se3.adjoint(se3.exp([0.01, 0.02, 0.01, 0.05, 0, 0.03])) @ S[k]
    if kind == "direction":
        S[k] *= -1
    other = Chain.from_space(S, chain.home).rezeroed(0.1 * (kind == "zero") * (np.arange(n) == k))
    first, others = search(chain, other, TOL)
    assert first.implicated.sum() <= 1
    assert all(found.implicated.sum() == 1 for found in others)
    assert compare(chain, other, samples=5).differing or first.frames
    if n == 3:
        assert (first.moved | first.offset | (first.directions < 0)).tolist() == [
            False,
            True,
            False,
        ]


def measured(seed, sizes):
    """An arm, and the same one in another base, its axes moved by some such sizes (rad and m)."""
    rng = np.random.default_rng(seed)
    chain = random_arm(seed, ("revolute",) * len(sizes))
    moves = [se3.exp(size * rng.normal(size=6)) for size in sizes]
    S = np.array([se3.adjoint(T) @ A for T, A in zip(moves, chain.screws, strict=True)])
    return chain, Chain.from_space(S, chain.home).rebased(se3.exp(rng.normal(size=6)))


@pytest.mark.parametrize("seed", [105, 199, 1294])
def test_beside_one_wrong_axis_the_others_that_are_right_within_tolerance_place_the_base(seed):
    # The axis before it and the one behind it say where the base is; the wrong one itself does not.
    found, _ = search(*measured(seed, [4e-6, 2e-4, 4e-6]), TOL)
    assert np.flatnonzero(found.implicated).tolist() == [1]
    assert found.frames == 1


@pytest.mark.parametrize("seed", [196, 594])
def test_two_wrong_axes_are_told_by_a_fit_to_those_that_agree_within_tolerance(seed):
    found, _ = search(*measured(seed, [4e-6, 1e-4, 1e-4, 4e-6, 4e-6]), TOL)
    assert np.flatnonzero(found.implicated).tolist() == [1, 2]


def test_an_arm_of_slides_alone_is_read():
    chain = Chain.from_space(
        [screw.prismatic(row) for row in np.random.default_rng(1).normal(size=(3, 3))], np.eye(4)
    )
    first, _ = search(chain, chain.rebased(se3.exp([0.1, 0.2, 0.3, 1, 2, 3])), TOL)
    assert not first.implicated.any()


def test_another_link_is_tried_in_the_twelve_cheapest_readings_of_several_moved_axes(monkeypatch):
    tried = []
    costs = np.random.default_rng(0).permutation(15).tolist()
    several = [SimpleNamespace(moved=np.array([1, 1]), link=0, cost=cost) for cost in costs]
    others = [
        SimpleNamespace(moved=np.array([1, 0]), link=0, cost=-1),
        SimpleNamespace(moved=np.array([1, 1]), link=2, cost=-2),
    ]
    monkeypatch.setattr(module, "make_hypotheses", lambda pair, at: [])
    monkeypatch.setattr(module, "with_front_link", lambda pair, reading: None)
    monkeypatch.setattr(module, "with_link", lambda pair, readings: tried.extend(readings) or [])
    pair: Any = SimpleNamespace(tool_as_it_stands=None)
    readings: Any = several + others
    module._other_links(pair, readings)
    assert [reading.cost for reading in tried] == list(range(12))
