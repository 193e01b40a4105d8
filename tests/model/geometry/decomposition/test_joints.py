"""Axes that meet and axes that are parallel."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import poekin as pk
from poekin.model.geometry.decomposition import joints as module
from poekin.model.geometry.decomposition.joints import LoopJoint, Tolerance
from tests.solve.ik_all import closed_form_arms as arms

SEEDS = st.integers(0, 2**32 - 1)
TIGHT = Tolerance(1e-13, 1e-13)


def through(place, *directions):
    return [LoopJoint(np.asarray(h, float), place + k * np.asarray(h), False) for k, h in
            enumerate(directions)]  # fmt: skip


@given(SEEDS, st.integers(2, 4))
def test_axes_through_a_point_meet_in_it(seed, count):
    rng = np.random.default_rng(seed)
    place = rng.uniform(-1, 1, 3)
    axes = through(place, *[arms.unit(rng) for _ in range(count)])
    least = min(module.sine(a, b) for a, b in pairwise(axes))
    point = module.meeting_point(axes, TIGHT)
    if least < module.SLANT:
        assert point is None
    elif least > 0.1:
        assert point is not None
        np.testing.assert_allclose(point, place, atol=1e-13)


@pytest.mark.parametrize("off", [1e-9, 1e-3])
def test_axes_that_pass_each_other_do_not_meet_within_less(off):
    axes = through(np.zeros(3), [0, 0, 1], [1, 0, 0])
    axes[1] = axes[1]._replace(point=np.array([0.0, off, 0.0]))
    assert module.meeting_point(axes, TIGHT) is None
    assert module.meeting_point(axes, Tolerance(1e-13, off)) is not None


def test_axes_meet_where_each_is_as_near_as_is_asked():
    axes = through(np.zeros(3), *[[0, 0, 1], [1, 0, 0]] * 2)
    for k in (1, 3):
        axes[k] = axes[k]._replace(point=np.array([0.0, 2.0, 0.0]))
    # each passes 1 m from the point between them, two of a kind together sqrt(2) m
    for within, meet in ((1.2, True), (0.9, False)):
        assert (module.meeting_point(axes, Tolerance(1e-13, within)) is not None) is meet


def test_axes_that_meet_exactly_do_so_within_nothing():
    axes = through(np.zeros(3), [0, 0, 1], [1, 0, 0])
    assert module.meeting_point(axes, Tolerance(0.0, 0.0)) is not None


def test_a_slide_neither_meets_nor_is_parallel():
    axes = through(np.zeros(3), [0, 0, 1], [1, 0, 0])
    slide = [axes[0], axes[1]._replace(slides=True)]
    assert module.meeting_point(slide, TIGHT) is None
    assert not module.parallel(slide, TIGHT)


@pytest.mark.parametrize(
    ("direction", "place", "expected"),
    [
        ([0, 0, 1], [1.0, 0, 0], True),
        ([0, 0, -1], [1.0, 0, 0], True),
        ([0, 0, 1], [0.0, 0, 5], False),
        ([0, 1e-9, 1], [1.0, 0, 0], False),
    ],
    ids=["parallel", "the other way", "coaxial", "tilted"],
)
def test_parallel_axes_are_told_from_coaxial_and_tilted_ones(direction, place, expected):
    first = LoopJoint(np.array([0.0, 0.0, 1.0]), np.zeros(3), False)
    other = LoopJoint(np.asarray(direction, float), np.asarray(place), False)
    assert module.parallel([first, other], TIGHT) is expected


Z, X, Y = np.array([0.0, 0, 1]), np.array([1.0, 0, 0]), np.array([0.0, 1, 0])
OFF = np.array([0.0, 1e-9, 1.0])


@pytest.mark.parametrize(
    ("turns", "slides", "expected"),
    [
        ([Z], [X], True),
        ([Z, -Z], [X], True),
        ([Z], [X, Y], True),
        ([Z, Z], [], False),
        ([], [X, Y], False),
        ([Z], [Z], False),
        ([Z], [X, OFF], False),
        ([X], [Y, OFF], True),
        ([Z, OFF], [X], True),
        ([Z, OFF], [Y], True),
        ([Z, X], [Y], False),
        ([Z, X, Z], [Y], False),
        ([Z, Z, X], [Y], False),
    ],
)
def test_joints_move_in_a_plane_where_slides_are_across_axes_that_are_parallel(
    turns, slides, expected
):
    loose = Tolerance(2e-9, 1e-13)
    joints = [LoopJoint(h, 5 * h[::-1], False) for h in turns]
    joints += [LoopJoint(h, np.zeros(3), True) for h in slides]
    for order in (joints, joints[::-1]):
        assert module.planar(order, loose) is expected
    tight = expected and not any(h is OFF for h in turns)
    assert module.planar(joints, TIGHT) is tight


def test_axes_tilted_by_as_much_as_is_allowed_are_parallel_in_a_plane_of_slides():
    tilt = float(np.linalg.norm(np.cross(Z, OFF)))
    joints = [LoopJoint(h, np.zeros(3), h is X) for h in (Z, OFF, X)]
    assert module.planar(joints, Tolerance(tilt, 0.0))
    assert not module.planar(joints, Tolerance(0.99 * tilt, 0.0))


def test_joints_are_lines_at_the_zero_of_the_coordinates():
    chain = pk.load("stanford").chain()
    joints = module.joints_of(chain)
    assert [joint.slides for joint in joints] == [False, False, True, False, False, False]
    assert [joint.column for joint in joints] == list(range(6))
    shifted = pk.Chain.from_space(chain.screws, chain.home, offset=[0.3, 0, 0, 0, 0, 0])
    turned = pk.so3.exp([0, 0, 0.3]) @ joints[1].direction
    np.testing.assert_allclose(module.joints_of(shifted)[1].direction, turned, atol=1e-15)


@given(SEEDS)
def test_a_vector_across_is_of_unit_length(seed):
    h = arms.unit(np.random.default_rng(seed), seed % 2 == 0)
    u = module.across(h)
    assert abs(u @ h) < 1e-15
    assert np.linalg.norm(u) == pytest.approx(1, abs=1e-15)
