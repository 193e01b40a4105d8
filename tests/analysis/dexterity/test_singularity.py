"""Singularities whose place and lost motion are known: a stretched arm, aligned wrist axes, an arm
over its base.
"""

from __future__ import annotations

import json
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import poekin as pk
from poekin.analysis.dexterity.messages import motion_words
from poekin.analysis.dexterity.singularity import _distance, singularity
from poekin.errors import InputError, ShapeError
from tests.model.laws.chain_cases import chain_cases

FEW = settings(max_examples=max(settings().max_examples // 3, 20))
ELBOW = [0.3, -0.7, 0.0, 0.4, 0.8, 0.2]
AWAY = [0.3, -0.7, 0.9, 0.4, 0.8, 0.2]


def elbow_arm():
    """Six revolute joints, z y y x y x, with upper arm and forearm of 0.5 m along x and a wrist
    whose axes meet.
    """
    z, y, x = [0, 0, 1], [0, 1, 0], [1, 0, 0]
    axes = [
        (z, [0, 0, 0]),
        (y, [0, 0, 0]),
        (y, [0.5, 0, 0]),
        (x, [1, 0, 0]),
        (y, [1, 0, 0]),
        (x, [1, 0, 0]),
    ]
    return pk.Chain.from_space(
        [[*w, *np.cross(p, w)] for w, p in axes], pk.se3.exp([0, 0, 0, 1, 0, 0])
    )


def test_a_stretched_arm_cannot_move_along_itself():
    arm, s = elbow_arm(), singularity(elbow_arm(), ELBOW)
    along = arm.fk(ELBOW)[:3, 3] / np.linalg.norm(arm.fk(ELBOW)[:3, 3])
    assert s.singular
    assert s.rank == 5
    assert s.distance <= 1e-15
    np.testing.assert_allclose(np.abs(s.singular_direction[3:] @ along), s.length, rtol=1e-14)
    np.testing.assert_allclose(s.singular_direction[:3], np.zeros(3), rtol=0, atol=1e-14)
    assert "the tool cannot move by moving along (" in s.summary()
    # and the rates that do nothing do nothing
    assert np.abs(arm.jacobian(ELBOW, "hybrid") @ s.joint_direction).max() < 1e-14


@pytest.mark.parametrize("q", [[0.0, 0.0], [0.0, 1.2], [2.0, -1.2], [-1.0, np.pi]], ids=str)
def test_no_component_of_a_direction_is_a_negative_zero(q):
    joints = [pk.screw.revolute([0, 0, 1], [x, 0, 0]) for x in (0.0, 0.5)]
    s = singularity(pk.Chain.from_space(joints, pk.se3.exp([0, 0, 0, 1, 0, 0])), q)
    for vector in (s.singular_direction, s.singular_subspace, s.joint_direction):
        assert not np.signbit(vector[vector == 0]).any()
    assert (s.singular_direction[:3] == 0).all()  # the translation alone is judged


def test_aligned_wrist_axes_lose_a_turn_about_what_is_square_to_them():
    arm, q = elbow_arm(), np.array([0.3, -0.7, 0.9, 0.4, 0.0, 0.2])
    s, T = singularity(arm, q), arm.joint_poses(q)
    assert s.singular
    assert s.rank == 5
    # the tool's origin is where the axes meet; to keep it still is part of what the other joints
    # cannot do as well
    for joint in (3, 4, 5):
        assert abs(s.singular_direction[:3] @ T[joint, :3, 2]) < 1e-14
    np.testing.assert_allclose(
        np.abs(s.joint_direction[[3, 5]]), math.sqrt(0.5), rtol=0, atol=1e-14
    )
    assert "turning about" in s.summary()
    assert "The rates 'joint" in s.summary()


@pytest.mark.parametrize("off", [1e-2, 1e-4, -1e-6])
def test_the_distance_is_how_far_the_elbow_is_bent(off):
    q = np.array(ELBOW)
    q[2] += off
    s = singularity(elbow_arm(), q)
    # to first order: the relative error is of the order of the distance
    assert s.distance == pytest.approx(abs(off), rel=10 * abs(off) + 1e-6)
    np.testing.assert_allclose(
        s.gradient_direction, [0, 0, -np.sign(off), 0, 0, 0], rtol=0, atol=10 * abs(off)
    )
    assert s.singular == (abs(off) < 5e-3)


def test_two_singularities_at_once_lose_two_motions():
    s = singularity(elbow_arm(), [0.3, -0.7, 0.0, 0.0, 0.0, 0.2])
    assert s.rank == 4
    assert s.singular_subspace.shape == (2, 6)
    assert s.summary().count("; and ") == 1


def test_a_part_may_be_regular_where_the_whole_is_not():
    q = [0.3, -0.7, 0.9, 0.4, 0.0, 0.2]
    assert singularity(elbow_arm(), q).singular
    assert not singularity(elbow_arm(), q, part="translation").singular
    assert singularity(elbow_arm(), ELBOW, part="translation").singular_direction[:3].tolist() == [
        0,
        0,
        0,
    ]
    assert singularity(elbow_arm(), q, part="rotation").singular_direction[3:].tolist() == [0, 0, 0]


def test_a_regular_arm_says_how_far_it_is_off():
    s = singularity(elbow_arm(), AWAY)
    assert not s.singular
    assert s.rank == 6
    assert s.singular_subspace.shape == (0, 6)
    assert s.summary().startswith("regular (smallest ÷ largest singular value ")
    assert "What would be lost there: " in s.summary()
    q = np.array(ELBOW)
    q[2] = 0.01
    assert (
        "the nearest singularity is about 0.01 rad away, most of it in 'joint3'"
        in singularity(elbow_arm(), q).summary()
    )


@FEW
@given(data=st.data())
def test_the_least_rates_and_the_lost_motion_are_singular_vectors(data):
    chain, q = data.draw(chain_cases(("q",), min_joints=1, max_joints=8, coupled=False))
    s = singularity(chain, q, part="pose")
    J = chain.jacobian(q, "hybrid") / np.repeat([1.0, s.length], 3)[:, None]
    u, size = (
        s.singular_direction / np.repeat([1.0, s.length], 3),
        1e-13 * (1 + np.linalg.norm(J, 2)),
    )
    assert abs(np.linalg.norm(J @ s.joint_direction) - s.smallest) <= size
    assert abs(np.linalg.norm(u) - 1) < 1e-13
    assert abs(np.linalg.norm(s.joint_direction) - 1) < 1e-13
    if chain.dof <= 6:
        assert np.abs(J.T @ u - (u @ J @ s.joint_direction) * s.joint_direction).max() <= size
    # no direction of the rates moves the tool less
    others = np.random.default_rng(0).normal(size=(chain.dof, 20))
    if chain.dof == s.generic_rank:
        assert (
            np.linalg.norm(J @ others, axis=0) >= np.linalg.norm(others, axis=0) * s.smallest - size
        ).all()


def test_a_tolerance_that_the_arm_never_keeps_calls_it_singular_and_leaves_it_its_motions():
    found = singularity(elbow_arm(), AWAY, tolerance=0.9)
    assert (found.singular, found.rank, found.generic_rank) == (True, 1, 6)
    assert found.singular_subspace.shape == (5, 6)


def test_a_lost_motion_in_a_wrong_frame_is_seen(monkeypatch):
    arm, right = elbow_arm(), pk.Chain.jacobian
    J = arm.jacobian(ELBOW, "hybrid")
    assert np.abs(singularity(arm, ELBOW).singular_direction @ J).max() < 1e-14
    monkeypatch.setattr(pk.Chain, "jacobian", lambda self, q, frame: right(self, q, "body"))
    assert np.abs(singularity(arm, ELBOW).singular_direction @ J).max() > 0.01


@pytest.mark.parametrize(
    ("twist", "words"),
    [
        ([0, 0, 1, 0, 0, 0], "turning about the base's z axis"),
        ([0, 0, 0, -0.3, 0, 0], "moving along the base's x axis"),
        ([0, 0, 0, 0.6, 0, 0.8], "moving along (0.60, 0.00, 0.80)"),
        ([1, 0, 0, 0, 0.5, 0], "turning about the base's x axis while its origin is moving along the base's y axis by "
         "0.5 m per rad"),
        ([0, 0.5, 0, 1, 0, 0], "moving along the base's x axis while turning about the base's y axis by 0.5 rad per m"),
    ],
)  # fmt: skip
def test_a_motion_in_words(twist, words):
    assert motion_words(np.array(twist, float)) == words


@pytest.mark.parametrize(("twist", "words"), [
    ([0, 0, 2.0, 0.039, 0, 0], "turning about the base's z axis"),
    ([0, 0, 1.0, 0.021, 0, 0], "turning about the base's z axis while its origin is moving along the base's x axis by "
     "0.021 m per rad"),
    ([0, 0.039, 0, 2.0, 0, 0], "moving along the base's x axis"),
    ([0, 0.021, 0, 1.0, 0, 0], "moving along the base's x axis while turning about the base's y axis by 0.021 rad per "
     "m"),
    ([0, np.sin(0.017), np.cos(0.017), 0, 0, 0], "turning about the base's z axis"),
    ([0, np.sin(0.018), -np.cos(0.018), 0, 0, 0], "turning about (0.00, 0.02, -1.00)"),
    ([-0.6, 0, 0.8, 0, 0, 0], "turning about (-0.60, 0.00, 0.80)"),
    ([0, 0, 2.0, 2.0, 0, 0], "turning about the base's z axis while its origin is moving along the base's x axis by "
     "1 m per rad"),
])  # fmt: skip
def test_a_motion_is_about_or_along_an_axis_of_the_base_within_a_degree(twist, words):
    assert motion_words(np.array(twist, float)) == words


def planar(lengths=(1.0, 1.0), slides=False):
    """Two links in a plane, of which the second may slide instead."""
    second = (
        pk.screw.prismatic([1, 0, 0])
        if slides
        else pk.screw.revolute([0, 0, 1], [lengths[0], 0, 0])
    )
    first = pk.screw.revolute([0, 0, 1], [0, 0, 0])
    home = pk.se3.exp([0, 0, 0, sum(lengths), 0, 0])
    return pk.Chain.from_space([first, second], home, joint_names=["one", "two"])


def test_what_is_lost_is_in_metres_of_the_length_and_the_rates_have_their_signs():
    # Stretched, two links of 1 m cannot move along themselves, and -1 at one with 2 at two leaves
    # the tip.
    rows = [*planar().screws, pk.screw.prismatic([0, 0, 1])]
    arm = pk.Chain.from_space(rows, planar().home, joint_names=["one", "two", "up"])
    found = singularity(arm, [0, 0, 0], part="translation", length=3.0)
    np.testing.assert_allclose(found.singular_direction, [0, 0, 0, 3, 0, 0], atol=1e-15)
    np.testing.assert_allclose(found.joint_direction, np.array([-1, 2, 0]) / np.sqrt(5), atol=1e-15)
    np.testing.assert_allclose(found.singular_values, [np.sqrt(5), 1, 0], atol=1e-15)
    assert (found.rank, found.distance) == (2, 0)
    assert found.summary().endswith(
        "the tool cannot move by moving along the base's x axis. The rates 'two' +0.89, 'one' -0.45 leave it where it "
        "is."
    )
    bent = singularity(arm, [0.0, 1e-3, 0], part="translation", length=3.0)
    assert bent.distance == pytest.approx(1e-3, rel=1e-3)
    np.testing.assert_allclose(bent.gradient_direction, [0, -1, 0], atol=1e-3)
    assert bent.summary().endswith(
        "The rates 'two' +0.89, 'one' -0.45 leave it where it is, nearly."
    )
    regular = singularity(arm, [0.0, 0.5, 0], part="translation")
    quotient, rates = (
        regular.smallest / regular.singular_values[0],
        {"one": regular.joint_direction[0], "two": regular.joint_direction[1]},
    )
    assert regular.condition == pytest.approx(1 / quotient)
    assert regular.summary() == (
        f"regular (smallest ÷ largest singular value {quotient:.3g}, tolerance 0.001): the nearest singularity is "
        f"about {regular.distance:.2g} (rad and m) away, most of it in 'two'. What would be lost there: "
        f"{motion_words(regular.singular_direction)}; "
        f"the rates for it: 'two' {rates['two']:+.2f}, 'one' {rates['one']:+.2f}."
    )


@pytest.mark.parametrize("slides, unit", [(False, "rad"), (True, "(rad and m)")])
def test_the_distance_is_told_in_the_unit_of_the_coordinates(slides, unit):
    arm = planar(slides=slides)
    found = singularity(arm, [0.3, 1.2], part="pose")
    assert (
        f" {unit} away" in found.summary()
        or f"no singularity is within 1 {unit}" in found.summary()
    )
    slide = pk.Chain.from_space([pk.screw.prismatic([1, 0, 0])], np.eye(4))
    assert (
        "): to first order no singularity is within 1 m. What"
        in singularity(slide, [0.0]).summary()
    )


def test_it_is_a_dict_and_json():
    s = singularity(elbow_arm(), ELBOW)
    assert json.loads(s.to_json()) == s.to_dict()
    assert s.to_dict()["rank"] == 5
    assert str(s) == s.summary()


def test_what_cannot_be_judged_is_refused():
    arm = elbow_arm()
    with pytest.raises(
        InputError, match=r"^q: expected one finite configuration \(6,\), got \[nan, "
    ):
        singularity(arm, [np.nan, 0, 0, 0, 0, 0])
    with pytest.raises(InputError, match=r"^q: expected one finite configuration"):
        singularity(arm, np.zeros((2, 6)))
    with pytest.raises(ShapeError, match=r"^q: expected 6 coordinates"):
        singularity(arm, [0, 0])
    with pytest.raises(InputError, match=r"^tolerance: expected a number between 0 and 1, got 2"):
        singularity(arm, ELBOW, tolerance=2)
    with pytest.raises(InputError, match=r"^part: "):
        singularity(arm, ELBOW, part="all")  # pyright: ignore[reportArgumentType]


def test_an_arm_that_never_moves_its_tool_has_no_motion_to_lose():
    arm = pk.Chain.from_space([pk.screw.revolute([0, 0, 1], [0, 0, 0])], np.eye(4))
    found = singularity(arm, [0.4], part="translation")
    assert (found.singular, found.rank, found.generic_rank, found.smallest) == (False, 0, 0, 0)
    assert found.condition == math.inf
    assert found.gradient_direction.tolist() == [0]
    assert found.summary() == (
        "regular: the arm has no motion of this part (translation) at any configuration."
    )
    assert found.to_dict()["condition"] is None


@pytest.mark.parametrize("options, words", [
    ({"tolerance": 0}, "tolerance: expected a number between 0 and 1, got 0"),
    ({"tolerance": 1.0}, "tolerance: expected a number between 0 and 1, got 1.0"),
    ({"tolerance": True}, "tolerance: expected a number between 0 and 1, got True"),
    ({"tolerance": "1"}, "tolerance: expected a number between 0 and 1, got '1'"),
    ({"length": 0}, "length: expected a positive number, got 0"),
    ({"length": math.inf}, "length: expected a positive number, got inf"),
    ({"length": True}, "length: expected a positive number, got True"),
    ({"length": "1"}, "length: expected a positive number, got '1'"),
])  # fmt: skip
def test_tolerance_and_length_are_within_what_they_mean(options, words):
    with pytest.raises(InputError) as caught:
        singularity(elbow_arm(), ELBOW, **options)
    assert str(caught.value) == words
    for value in (1e-300, float(np.float32(0.5)), 0.999):
        assert singularity(elbow_arm(), AWAY, tolerance=value).tolerance == value


@pytest.mark.parametrize(
    ("smallest", "steep", "distance"),
    [
        (0.0, 4.0, 0.0),
        (1e-15, 4.0, 0.0),
        (1e-15, 0.0, 0.0),
        (3e-15, 4.0, 7.5e-16),
        (0.5, 0.0, math.inf),
    ],
)
def test_the_distance_is_0_where_the_singular_value_is_rounding_and_else_by_how_steep_it_is(
    smallest, steep, distance
):
    assert _distance(smallest, 1.0, steep) == pytest.approx(distance, rel=1e-12, abs=0)
