"""An exaggerated model: at k = 1 it is model b, at k = 0 model a, and between and beyond a screw."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

import poekin as pk
from poekin.view.nodes import Label, Polyline
from poekin.view.scenes.arm_parts.of_chain import chain_geometry
from poekin.view.scenes.two_arms.exaggerated import (
    FACTOR,
    compared_rows,
    exaggerated,
    visible_factor,
)
from poekin.view.scenes.two_arms.overlay import second_arm, second_nodes

ARM = pk.load("panda").chain(tip="panda_hand")
SIZES = st.floats(-1, 1)
# Products of some 20 exponentials of metres, and the alignment of `compare`, which is its own.
TIGHT = 1e-12


def moved(joint: int, twist: Any) -> pk.Chain:
    """The arm, one of its axes moved."""
    screws = ARM.screws.copy()
    screws[joint] = pk.se3.adjoint(pk.se3.exp(twist)) @ screws[joint]
    return ARM.replace(screws=screws)


def own(found: Any, q: Any) -> np.ndarray:
    """Coordinates of model b where those of a are q, its zero where a's are at 0."""
    directions = [-1 if joint.reversed else 1 for joint in found.joints]
    return directions * (found.a.coupling[compared_rows(found)] @ q)


def as_compared(found: Any, y: Any) -> np.ndarray:
    """Pose of b at coordinates `own`."""
    return found.b.fk(y + [joint.zero_offset for joint in found.joints])


def axis_at(made: Any, k: float, joint: int, q: Any) -> np.ndarray:
    """Place and direction of an axis as the page draws it."""
    chain = made.chain
    at_rest = pk.se3.exp(-made.moves[joint]) if made.factor > 1 else np.eye(4)
    axis = pk.se3.adjoint(at_rest) @ chain.screws[made.axes[joint]]
    zero = np.zeros(chain.dof)
    bodies = [
        np.eye(4),
        *(chain.joint_poses(np.append(q, k)) @ pk.se3.inverse(chain.joint_poses(zero))),
    ]
    return pk.se3.adjoint(bodies[made.axes[joint]]) @ axis


@given(st.integers(1, 5), st.lists(SIZES, min_size=6, max_size=6), st.integers(0, 2**31), SIZES)
@settings(max_examples=25, deadline=None)
@example(3, [1.0, 0.0, 0.0, 0.0, 1.0, 0.0], 0, 1.0)
def test_at_one_it_is_b_and_at_zero_a_at_all_joint_values(joint, sizes, seed, zero):
    twist = np.array(sizes) * [3e-3, 3e-3, 3e-3, 5e-3, 5e-3, 5e-3]
    base = pk.se3.exp([0.3, -0.2, 0.5, 0.1, 0.2, -0.4])
    b = moved(joint, twist).rezeroed(zero * np.eye(7)[joint])
    found = pk.compare(ARM, b.rebased(base))
    made = exaggerated(found)
    q = ARM.random(seed)
    y = own(found, q)
    at_one = y if made.factor == 1 else [*y, 1.0]
    np.testing.assert_allclose(made.chain.fk(at_one), as_compared(found, y), atol=TIGHT)
    if made.factor == 1:
        return
    assert found.base is not None
    assert found.tool is not None
    if all(not j.axis_differs or j.number == joint + 1 for j in found.joints):
        a_again = found.base @ made.chain.fk([*y, 0.0]) @ found.tool
        # what is within the tolerance of 1e-5 m is left as it is
        np.testing.assert_allclose(a_again, ARM.fk(q), atol=1e-4)


def test_an_axis_of_3_mm_is_drawn_k_times_3_mm_away():
    found = pk.compare(ARM, moved(3, [0, 0, 0, 0, 0, 0.003]))
    made = exaggerated(found)
    assert made.chain.q_names[-1] == FACTOR
    assert made.factor == 20.0  # 60 mm of a reach of 1.1 m; 50 would be 150 mm
    q = np.zeros(7)
    at_a = axis_at(made, 0.0, 3, q)
    np.testing.assert_allclose(at_a, ARM.screws[3], atol=1e-12)
    for k in (1.0, 7.0, made.factor):
        lifted = pk.se3.adjoint(pk.se3.exp([0, 0, 0, 0, 0, 0.003 * k])) @ ARM.screws[3]
        np.testing.assert_allclose(axis_at(made, k, 3, q), lifted, atol=1e-9)


def test_bodies_are_those_behind_the_joints_whatever_k_is():
    found = pk.compare(ARM, moved(3, [0, 0, 0, 0, 0, 0.003]))
    made = exaggerated(found)
    assert made.bodies == (0, 1, 2, 3, 6, 7, 8, 9, 9)
    assert made.axes == (0, 1, 2, 4, 6, 7, 8)
    added = set(made.chain.joint_names) - set(ARM.joint_names)
    assert added == {"exaggeration 4", "exaggeration 4 back"}
    np.testing.assert_array_equal(made.chain.limits, [*found.b.limits, (0, 20)])
    rest = made.chain.joint_poses(np.zeros(8))
    at_20 = made.chain.joint_poses([0, 0, 0, 0, 0, 0, 0, 20.0])
    # a body behind a joint stands still as k grows, where all joints are at 0
    for body in made.bodies[1:]:
        displacement = at_20[body - 1] @ pk.se3.inverse(rest[body - 1])
        np.testing.assert_allclose(displacement, np.eye(4), atol=1e-12)


def test_a_slide_that_leans_and_a_link_that_is_longer_are_exaggerated_too():
    A = [
        pk.screw.revolute([0, 0, 1], [0, 0, 0]),
        pk.screw.prismatic([1, 0, 0]),
        pk.screw.revolute([0, 1, 0], [0.5, 0, 0]),
        pk.screw.revolute([1, 0, 0], [0.5, 0.2, 0]),
    ]
    arm = pk.Chain.from_space(A, pk.se3.exp([0, 0, 0, 0.8, 0.2, 0]))
    A[1] = pk.screw.prismatic([np.cos(0.01), np.sin(0.01), 0])
    found = pk.compare(arm, pk.Chain.from_space(A, arm.home))
    made = exaggerated(found)
    assert made.factor > 1
    ways = [axis_at(made, k, 1, np.zeros(4))[3:] for k in (0, 1, made.factor)]
    angles = [np.arctan2(way[1], way[0]) for way in ways]
    assert angles == pytest.approx([0, 0.01, 0.01 * made.factor], abs=1e-9)


def test_models_that_agree_have_no_factor():
    for b in (ARM, ARM.rebased(pk.se3.exp([0, 0, 1, 0, 0, 0]))):
        made = exaggerated(pk.compare(ARM, b))
        assert (made.factor, made.chain.dof) == (1.0, 7)
        assert made.bodies == (*range(8), 7)
        assert made.axes == tuple(range(7))
        assert made.moves.shape == (8, 6)
        assert not made.moves.any()


@pytest.mark.parametrize(
    ("zeros", "base"),
    [
        (np.zeros(7), np.eye(4)),
        (np.linspace(0.2, 0.8, 7), np.eye(4)),
        (np.zeros(7), pk.se3.exp([0.3, -0.2, 0.5, 0.1, 0.2, -0.4])),
    ],
    ids=["", "rezeroed", "rebased"],
)
def test_a_longer_link_takes_the_tool_along(zeros, base):
    longer = pk.se3.exp([0, 0, 0, 0, 0, 0.003])
    screws = ARM.screws.copy()
    screws[4:] = screws[4:] @ pk.se3.adjoint(longer).T
    found = pk.compare(ARM, ARM.replace(screws=screws, home=longer @ ARM.home))
    pairs = zip(found.joints, zeros.tolist(), strict=True)
    joints = tuple(replace(joint, zero_offset=joint.zero_offset - x) for joint, x in pairs)
    b = found.b.rezeroed(zeros).rebased(pk.se3.inverse(base))
    assert found.base is not None
    aligned = found.base @ base
    made = exaggerated(replace(found, b=b, joints=joints, base=aligned))
    assert made.factor > 1
    q = ARM.random(3)
    y = own(found, q)
    # the axes along the link are the same lines, and the tool is where the link's end is
    np.testing.assert_allclose(aligned @ made.chain.fk([*y, 0.0]), ARM.fk(q), atol=1e-9)
    far = (aligned @ made.chain.fk([*y, 10.0]) - ARM.fk(q))[:3, 3]
    assert np.linalg.norm(far) == pytest.approx(0.03, rel=1e-6)


def test_an_arm_of_sums_with_an_offset_is_exaggerated_as_one_without():
    coupling = np.eye(7) - np.eye(7, k=-1)
    names = [f"c{k}" for k in range(7)]
    made = []
    for offset in (np.zeros(7), np.linspace(-0.3, 0.3, 7)):
        arm = ARM.replace(coupling=coupling, offset=offset, q_names=names)
        b = moved(3, [0, 0, 0, 0, 0, 0.003])
        found = pk.compare(arm, b.replace(coupling=coupling, offset=offset, q_names=names))
        made.append(exaggerated(found))
        q = arm.random(9)
        np.testing.assert_allclose(made[-1].chain.fk([*own(found, q), 0.0]), arm.fk(q), atol=1e-9)
    assert made[0].factor == made[1].factor == 20.0


def test_the_frame_of_a_tool_that_is_aligned_is_drawn_where_model_b_has_it():
    b = moved(3, [0, 0, 0, 0, 0, 0.003]).retooled(pk.se3.exp([0, 0, 0, 0, 0, 0.004]))
    found = pk.compare(ARM, b)
    made = exaggerated(found)
    nodes = second_nodes(made, {}, {ARM.tip}, 1.0)
    (label,) = [node for node in nodes if isinstance(node, Label)]
    plain = second_nodes(exaggerated(pk.compare(b, b)), {}, {ARM.tip}, 1.0)
    (at_rest,) = [node for node in plain if isinstance(node, Label)]
    q = ARM.random(6)
    drawn = chain_geometry(made.chain).poses(np.append(q, 1.0))[label.attachment.link]
    true = chain_geometry(found.b).poses(q)[-1]
    place = true @ [*at_rest.point, 1.0]
    np.testing.assert_allclose(drawn @ [*label.point, 1.0], place, atol=1e-12)


def test_an_axis_that_is_tilted_is_drawn_along_that_of_model_b():
    found = pk.compare(ARM, moved(3, [0.01, 0, 0.01, 0, 0, 0]))
    made = exaggerated(found)
    assert made.factor > 1
    name = found.b.joint_names[3]
    nodes = second_nodes(made, {name: "tilted"}, (), 1.0)
    (line,) = [node for node in nodes if isinstance(node, Polyline)]
    q = ARM.random(6)
    drawn = chain_geometry(made.chain).poses(np.append(q, 1.0))[line.attachment.link]
    true = chain_geometry(found.b).poses(q)[3]
    way = drawn[:3, :3] @ np.diff(line.points, axis=0)[0]
    axis = true[:3, :3] @ found.b.screws[3, :3]
    np.testing.assert_allclose(way / np.linalg.norm(way), axis, atol=1e-9)


@pytest.mark.parametrize(("length", "follows"), [(0.03, True), (0.08, False)])
def test_a_tool_that_would_be_drawn_farther_away_than_the_arm_reaches_stays(length, follows):
    b = moved(3, [0, 0, 0, 0, 0, 0.003]).retooled(pk.se3.exp([0, 0, 0, 0, 0, length]))
    made = exaggerated(pk.compare(ARM, b))
    assert made.factor == 20.0
    assert made.moves[-1].any() == follows


def test_factors_are_round_and_draw_a_length_as_a_tenth_of_the_size_at_most():
    sizes = np.geomspace(1, 2000, 400)
    factors = [visible_factor(1.0, size) for size in sizes]
    assert set(factors) == {1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0}
    assert all(k <= max(1, 0.1 * size) for k, size in zip(factors, sizes, strict=True))


def test_the_factor_is_the_second_arms_last_coordinate_and_follows_no_slider():
    made = exaggerated(pk.compare(ARM, moved(3, [0, 0, 0, 0, 0, 0.05])))
    assert made.factor == 2.0
    factors = np.ones((7, 3))
    arm = second_arm(made, np.eye(4), factors)
    np.testing.assert_array_equal(arm.factors, [*factors, np.zeros(3)])
    np.testing.assert_array_equal(arm.shift, [*np.zeros(7), 2.0])
