"""The scene of a comparison: what `compare` says is what is red, and where it says b stands."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.view.nodes import Label, Triangles
from poekin.view.scenes import comparison
from poekin.view.scenes.arm import arm_scene, arm_size
from poekin.view.scenes.arm_parts.of_chain import chain_geometry
from poekin.view.scenes.arm_parts.skeleton import glyph_radii, skeleton_nodes
from poekin.view.scenes.comparison import LEGEND, comparison_scene
from poekin.view.scenes.two_arms.exaggerated import exaggerated
from poekin.view.scenes.two_arms.overlay import COVER, FADED, SHELL, second_nodes
from tests.view.narrowed import all_of

ARM = pk.load("panda").chain(tip="panda_hand")


def lifted(joint=3, length=0.003):
    screws = ARM.screws.copy()
    screws[joint] = pk.se3.adjoint(pk.se3.exp([0, 0, 0, 0, 0, length])) @ screws[joint]
    return ARM.replace(screws=screws)


def of_b(found, y):
    """Pose of model b at coordinates whose zero is where a's joints are at 0."""
    return found.b.fk(y + [joint.zero_offset for joint in found.joints])


def red(scene):
    return {node.attachment.name for node in scene.nodes if node.attachment.role == "differs"}


@pytest.mark.parametrize("joint", [1, 3, 5])
def test_the_joint_that_compare_names_is_the_one_that_is_red(joint):
    found = pk.compare(ARM, lifted(joint))
    (differing,) = found.differing
    scene = comparison_scene(found)
    (sentence,) = red(scene)
    assert sentence.startswith(f"joint {joint + 1} ('{differing.name_b}') has an axis that is 3 mm")
    (label,) = [n for n in scene.nodes if isinstance(n, Label) and n.attachment.arm == 1]
    assert label.text == differing.name_b
    # on the axis of model b at q = 0, ahead of the joint
    made = exaggerated(found)
    body = chain_geometry(made.chain).poses(np.append(np.zeros(7), 1.0))[label.attachment.link]
    seen = body[:3, :3] @ label.point + body[:3, 3]
    axis = pk.screw.axis_of(found.b.screws[joint])
    assert axis.point is not None
    assert np.linalg.norm(np.cross(axis.direction, seen - axis.point)) < 1e-12
    centre = found.b.joint_poses(np.zeros(7))[joint, :3, 3]
    assert (seen - centre) @ axis.direction > 0
    assert {n.attachment.layer for n in scene.nodes if n.attachment.role == "differs"} == {
        "differences"
    }
    assert "differences" in scene.shown


def test_the_words_begin_with_the_outcome_and_the_table_has_each_joint():
    found = pk.compare(ARM, lifted())
    scene = comparison_scene(found, title="a and b")
    assert scene.title == "a and b"
    lines = found.summary().splitlines()
    assert scene.words == (lines[-1], LEGEND, *lines[:-1])
    (table,) = scene.tables
    assert [row[3] for row in table.rows] == ["same"] * 3 + ["DIFFERS"] + ["same"] * 3
    assert table.rows[3][6] == "3"
    assert {len(row) for row in table.rows} == {len(table.heads)}


def test_of_many_sentences_the_page_holds_eight_and_says_how_many_more_there_are(monkeypatch):
    moved = pk.se3.exp(0.02 * np.random.default_rng(0).normal(size=(7, 6)))
    screws = np.einsum("kij,kj->ki", pk.se3.adjoint(moved), ARM.screws)
    found = pk.compare(ARM, ARM.replace(screws=screws))
    lines = found.summary().splitlines()
    words = comparison_scene(found).words
    every = (lines[-1], LEGEND, *lines[:-1])
    assert len(every) > 9
    assert words[:8] == every[:8]
    assert words[8:] == (
        f"{len(every) - 8} more: summary() of the comparison, and `poekin compare`.",
    )
    monkeypatch.setattr(comparison, "MOST_WORDS", len(every))
    assert comparison_scene(found).words == every
    monkeypatch.setattr(comparison, "MOST_WORDS", len(every) - 1)
    assert comparison_scene(found).words[-1].startswith("1 more: ")


def test_the_table_leaves_out_what_is_the_same_of_all_joints_and_keeps_what_is_not():
    (table,) = comparison_scene(pk.compare(ARM, lifted())).tables
    assert table.heads[-1] == "at the arm (mm)"
    (table,) = comparison_scene(pk.compare(ARM, ARM.rezeroed([0, 0, 0, 0, -0.2, 0, 0]))).tables
    zero = table.heads.index("zero")
    told = [row[1] for row in table.rows if row[zero] != "0 deg"]
    assert told == [ARM.joint_names[4]]
    assert "direction" not in table.heads


def test_the_second_arm_stands_where_compare_aligned_it():
    b = lifted().rezeroed([0.1, 0, 0, 0, -0.2, 0, 0]).rebased(pk.se3.exp([0, 0, 1, 0, 2, 0]))
    found = pk.compare(ARM, b)
    scene = comparison_scene(found)
    first, second = scene.arms
    assert found.tool is not None
    assert scene.exaggerated > 1
    q = ARM.random(4)
    own = second.factors @ q + second.shift
    assert own[-1] == scene.exaggerated  # k when the page opens
    aligned = second.base @ of_b(found, own[:-1]) @ found.tool
    true = ARM.fk(q)
    # the axis that is 3 mm off moves the tool by up to 6 mm
    assert np.abs(aligned - true)[:3, 3].max() < 0.007
    assert np.abs(aligned - true)[:3, :3].max() < 1e-9
    assert first.coordinates[0].name == ARM.q_names[0]


def test_reversed_joints_and_other_zeros_stand_on_the_first_arm():
    screws = ARM.screws.copy()
    screws[2] *= -1
    found = pk.compare(ARM, ARM.replace(screws=screws).rezeroed([0, 0.3, 0, 0, 0, 0, 0]))
    scene = comparison_scene(found)
    second = scene.arms[1]
    assert found.tool is not None
    assert (scene.exaggerated, second.factors[2, 2]) == (1.0, -1.0)
    q = ARM.random(5)
    assert not second.shift.any()
    found_at = second.base @ of_b(found, second.factors @ q) @ found.tool
    np.testing.assert_allclose(found_at, ARM.fk(q), atol=1e-9)
    assert len(red(scene)) == len(found.differing) == 2


def test_joints_that_cannot_be_matched_are_drawn_as_they_stand():
    other = pk.load("ur5").chain()
    found = pk.compare(ARM, other)
    assert not found.joints
    scene = comparison_scene(found)
    assert not red(scene)
    assert not scene.arms[1].factors.any()
    assert scene.exaggerated == 1
    # the scene is as large as the larger one, whichever it is
    size = comparison_scene(pk.compare(other, ARM)).size
    assert size == arm_size(chain_geometry(ARM), np.zeros(7)) > arm_scene(other).size
    assert scene.size == arm_scene(ARM).size > arm_size(chain_geometry(other), np.zeros(6))
    np.testing.assert_array_equal(scene.arms[1].base, np.eye(4))
    assert scene.words[0].startswith("The models differ: 7 joints against 6")


def test_a_dropped_joint_leaves_the_others_on_their_sliders():
    names = [name for k, name in enumerate(ARM.joint_names) if k != 2]
    screws = np.delete(ARM.screws, 2, axis=0)
    short = pk.Chain(screws, ARM.home, frame="space", joint_names=names)
    found = pk.compare(ARM, short)
    assert found.unmatched_joints == ("a", "panda_joint3")
    factors = comparison_scene(found).arms[1].factors
    assert factors.shape == (6, 7)
    np.testing.assert_array_equal(np.abs(factors), np.delete(np.eye(7), 2, axis=0))


def test_frames_of_the_second_arm_are_drawn_where_they_are_elsewhere():
    up = pk.se3.exp([0, 0, 0, 0, 0, 0.1])
    for b, ends in ((ARM.rebased(up), {ARM.base}), (ARM.retooled(up), {ARM.tip}), (ARM, set())):
        scene = comparison_scene(pk.compare(ARM, b))
        frames = [
            n for n in scene.nodes if n.attachment.layer == "frames" and n.attachment.arm == 1
        ]
        assert {n.attachment.name for n in frames} == ends
    both = comparison_scene(pk.compare(ARM, ARM.rebased(up).retooled(up)))
    names = {
        n.attachment.name
        for n in both.nodes
        if n.attachment.layer == "frames" and n.attachment.arm == 1
    }
    assert names == {ARM.base, ARM.tip}


@pytest.mark.parametrize("zeros", [np.zeros(7), [0, 0.2, 0, 0.5, 0, 0.3, 0]], ids=["", "rezeroed"])
def test_links_of_the_second_arm_are_where_model_b_has_them_and_at_a_factor_of_0_model_a(zeros):
    found = pk.compare(ARM, lifted().rezeroed(zeros))
    made = exaggerated(found)
    assert made.factor > 1
    z = [joint.zero_offset for joint in found.joints]
    # the bones are drawn between the axes' places where a's joints are at 0
    b = chain_geometry(found.b.rezeroed(z))
    q = ARM.random(8)
    plain = b.poses(q)
    drawn = chain_geometry(made.chain).poses(np.append(q, 1.0))
    # at a factor of 0 they move as those of model a
    at_zero = chain_geometry(made.chain).poses(np.append(q, 0.0))
    first = chain_geometry(ARM).poses(q)
    radii = glyph_radii(b, np.zeros(7), 1.0)
    true = [n for n in skeleton_nodes(b, SHELL * radii, 1.0) if n.attachment.role == "first"]
    nodes = [n for n in second_nodes(made, {}, (), 1.0) if n.attachment.layer == "skeleton"]
    assert len(true) == 6
    pairs = zip(all_of(Triangles, true), all_of(Triangles, nodes), strict=False)
    for one, other in pairs:
        np.testing.assert_array_equal(one.vertices, other.vertices)
        link = other.attachment.link
        np.testing.assert_allclose(drawn[link], plain[one.attachment.link], atol=1e-12)
        np.testing.assert_allclose(at_zero[link], first[one.attachment.link], atol=1e-12)


def test_a_joint_that_is_called_like_the_tip_has_no_frame_in_its_place():
    chain = ARM.replace(joint_names=(*ARM.joint_names[:-1], ARM.tip))
    made = exaggerated(pk.compare(chain, chain, samples=1))
    nodes = second_nodes(made, {}, {chain.tip}, 1.0)
    own = [node for node in nodes if node.attachment.layer == "frames"]
    arrows = [node for node in own if isinstance(node, Triangles)]
    assert len(arrows) == 3


def test_two_models_that_coincide_are_told_apart_and_a_joint_that_differs_covers_the_other():
    """What coincides is a shell around the first model, which is seen through it; a joint that
    differs is opaque, and larger than the first model's.
    """
    arm = chain_geometry(ARM)
    radii = glyph_radii(arm, np.zeros(7), 1.0)
    first = all_of(Triangles, skeleton_nodes(arm, radii, 1.0))
    made = exaggerated(pk.compare(ARM, ARM))
    nodes = second_nodes(made, {ARM.joint_names[2]: "differs"}, (), 1.0)
    second = [n for n in nodes if isinstance(n, Triangles) and n.attachment.role == "second"]
    assert {n.attachment.opacity for n in second} == {FADED}
    red = next(n for n in nodes if isinstance(n, Triangles) and n.attachment.role == "differs")
    assert red.attachment.opacity == 1
    glyph = next(
        n for n in first if (n.attachment.name, n.attachment.role) == (ARM.joint_names[2], "joint")
    )
    middle = arm.joints[2].point
    np.testing.assert_allclose(
        red.vertices - middle, COVER * (glyph.vertices - middle), rtol=0, atol=1e-15
    )
    assert 1 < COVER < SHELL
    same = [n for n in first if n is not glyph]
    for inner, outer in zip(same, second, strict=True):
        assert (np.ptp(outer.vertices, axis=0) > np.ptp(inner.vertices, axis=0)).all()
