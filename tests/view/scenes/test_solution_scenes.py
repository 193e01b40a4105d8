"""Scenes of solutions: each where it is, as a ghost and as a choice, and the target beside them."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError
from poekin.view.nodes import Label, Triangles
from poekin.view.scenes.arm_parts.of_chain import chain_geometry
from poekin.view.scenes.solutions import solutions_scene
from poekin.view.scenes.stage import make_stage
from poekin.view.scenes.targets import MOST, configuration_words, solution_scene
from tests.view.narrowed import all_of

ROBOT = pk.load("ur5")
ARM = ROBOT.chain()
T = ARM.fk([0.1, -1.0, 1.2, 0.4, 0.9, -0.3])
EVERY = pk.ik_all(ARM, T, method="search")


def test_each_solution_is_a_choice_and_a_ghost_and_the_page_opens_at_the_first():
    scene = solutions_scene(EVERY)
    assert len(scene.choices) == len(EVERY.solutions) == 8
    for k, choice in enumerate(scene.choices):
        np.testing.assert_array_equal(choice.q, EVERY.solutions[k])
        assert choice.text.startswith(f"{k + 1}: ")
    np.testing.assert_array_equal(scene.q, EVERY.solutions[0])
    ghosts = [n for n in scene.nodes if n.attachment.layer == "solutions"]
    assert {n.attachment.choice for n in ghosts} == set(range(8))
    assert all(n.attachment.opacity < 0.5 and n.attachment.rule is None for n in ghosts)
    assert {"solutions", "path"} <= scene.shown
    assert scene.words[0] == EVERY.summary()


def test_a_ghost_stands_where_its_solution_has_the_links():
    scene = solutions_scene(EVERY)
    arm = chain_geometry(ARM)
    bones = [
        n for n in scene.nodes if n.attachment.layer == "skeleton" and isinstance(n, Triangles)
    ]
    for k in (0, 5):
        own = [
            n for n in scene.nodes if n.attachment.layer == "solutions" and n.attachment.choice == k
        ]
        ghosts = all_of(Triangles, own)
        assert len(ghosts) == len(bones)
        poses = arm.poses(EVERY.solutions[k])
        for ghost, bone in zip(ghosts, bones, strict=True):
            R, p = poses[bone.attachment.link][:3, :3], poses[bone.attachment.link][:3, 3]
            np.testing.assert_allclose(ghost.vertices, bone.vertices @ R.T + p, atol=1e-14)


def test_the_words_of_a_choice_are_its_coordinates_and_the_places_it_stands_for():
    text = solutions_scene(EVERY).choices[0].text
    assert text.split(",")[0] == f"1: {np.degrees(EVERY.solutions[0][0]):.3g}°"
    assert f"(one of {EVERY.n_revolutions[0]} places, whole turns apart)" in text
    alone = ARM.replace(limits=[[-3, 3]] * 6)
    for choice in solutions_scene(pk.ik_all(alone, T, method="search")).choices:
        assert "places" not in choice.text


def test_the_rounding_of_a_zero_is_no_number_of_a_choice():
    assert configuration_words(ARM, np.array([1e-17, -1e-12, 1e-8, 0, 0, 0])).startswith(
        "0°, 0°, 5.73e-07°"
    )


def test_the_target_of_ik_is_drawn_with_the_arm_at_its_solution():
    found = pk.ik(ARM, T)
    scene = solution_scene(found)
    np.testing.assert_array_equal(scene.q, found.q)
    drawn = [n for n in scene.nodes if n.attachment.layer == "path" and isinstance(n, Triangles)]
    assert [n.attachment.role for n in drawn] == ["x", "y", "z"]
    for k, arrow in enumerate(drawn):  # from the target's origin along its axes
        start, end = arrow.vertices[-2:]
        np.testing.assert_allclose(start, T[:3, 3], atol=1e-12)
        np.testing.assert_allclose(end, T[:3, 3] + 0.1 * scene.size * T[:3, k], atol=1e-12)
    (label,) = [n for n in scene.nodes if isinstance(n, Label) and n.text == "target"]
    np.testing.assert_allclose(label.point, T[:3, 3], atol=0.05 * scene.size)
    assert scene.words[0] == found.summary()


def test_of_many_targets_the_first_are_choices_with_their_reasons():
    many = np.tile(T, (MOST + 3, 1, 1))
    many[1, 0, 3] += 10.0
    many[2] = np.nan
    scene = solution_scene(pk.ik(ARM, many))
    assert len(scene.choices) == MOST
    assert [c.text for c in scene.choices[:3]] == [
        "target 0: solved",
        "target 1: unreachable",
        "target 3: solved",
    ]
    assert scene.words[1] == f"The first {MOST} of {MOST + 2} targets are shown."


def test_in_its_robot_solutions_are_those_of_all_sliders():
    panda = pk.load("panda")
    arm = panda.chain(tip="panda_hand")
    q = np.array([0, -0.5, 0, -2.0, 0, 1.6, 0.8])
    found = pk.ik(arm, arm.fk(q))
    scene = solution_scene(found, panda)
    assert len(scene.q) == panda.dof == 8
    index = [panda.q_names.index(name) for name in arm.q_names]
    np.testing.assert_array_equal(scene.q[index], found.q)


def test_what_cannot_be_drawn_is_refused_in_words():
    batch = pk.ik_all(ARM, [T, T], method="search")
    with pytest.raises(
        InputError, match=r"^view: all solutions of one target expected, got those of 2$"
    ):
        solutions_scene(batch)
    bad = np.full((4, 4), np.nan)
    with pytest.raises(InputError, match=r"^view: a finite target expected, got \w+"):
        solutions_scene(pk.ik_all(ARM, bad, method="search"))
    with pytest.raises(
        InputError, match=r"^view: expected a finite target, got bad target: it is not made of"
    ):
        solution_scene(pk.ik(ARM, bad))
    with pytest.raises(InputError, match="expected the robot of the chain from 'base' to 'tool'"):
        solution_scene(pk.ik(ARM, T), pk.load("panda"))
    for own in ({"tip": "hand"}, {"base": "table"}):
        with pytest.raises(
            InputError, match=r"^robot: .*, got 'ur5' without these links, or without"
        ):
            make_stage(ARM.replace(**own), None, ROBOT)


def test_a_pose_without_solutions_is_shown_with_its_sentence():
    far = T.copy()
    far[0, 3] = 5.0
    found = pk.ik_all(ARM, far, method="search")
    scene = solutions_scene(found)
    assert scene.choices == ()
    assert scene.words[0].startswith("0 solutions")


def test_a_coordinate_below_a_billionth_is_a_zero_in_words():
    assert configuration_words(ARM, np.full(6, -4e-10)) == ", ".join(["0°"] * 6)
    assert "0°" not in configuration_words(ARM, np.full(6, 6e-10)).split(", ")


def test_each_choice_says_the_number_of_its_own_places():
    arm = pk.load("ur5e").chain(tip="tool0")
    found = pk.ik_all(arm, arm.fk([0, -1.2, 1.5, -0.3, 0.8, 0]))
    assert len({*found.n_revolutions.tolist()}) > 1
    for choice, places in zip(solutions_scene(found).choices, found.n_revolutions, strict=True):
        assert choice.text.endswith(f"(one of {places} places, whole turns apart)")
