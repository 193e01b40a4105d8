"""The scene of a singularity: the lost motion is an arrow at the tip, as `singularity` has it."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.view.nodes import Triangles
from poekin.view.scenes.singular import LENGTH, singularity_scene

UR5 = pk.load("ur5").chain()


def arrows(scene):
    """Name, and vector from the foot to the head, of each arrow of the layer."""
    found = {}
    for node in scene.nodes:
        if node.attachment.layer == "singular" and isinstance(node, Triangles):
            # the surface begins and ends at the points of its profile on the axis, the last two
            start, end = node.vertices[-2:]
            found[node.attachment.name.partition(":")[0]] = (start, end - start)
    return found


def test_the_lost_rotation_of_a_stretched_arm_is_an_arrow_along_it():
    found = pk.singularity(UR5, np.zeros(6))
    scene = singularity_scene(found)
    np.testing.assert_array_equal(scene.q, np.zeros(6))
    assert scene.words == (found.summary(),)
    assert "singular" in scene.shown
    ((name, (start, way)),) = arrows(scene).items()
    assert name == "lost rotation"
    np.testing.assert_allclose(start, UR5.fk(np.zeros(6))[:3, 3], atol=1e-12)
    (twist,) = found.singular_subspace
    np.testing.assert_allclose(way, LENGTH * scene.size * twist[:3], atol=1e-9)


def test_a_lost_translation_is_an_arrow_too_and_a_regular_arm_shows_what_would_be_lost():
    joints = [pk.screw.revolute([0, 0, 1], [x, 0, 0]) for x in (0.0, 0.5)]
    links = pk.Chain.from_space(joints, pk.se3.exp([0, 0, 0, 1, 0, 0]))
    for q in ([0.0, 0.0], [0.0, 0.4]):
        found = pk.singularity(links, q)
        scene = singularity_scene(found)
        _, way = arrows(scene)["lost translation"]
        direction = found.singular_direction[3:]
        assert np.linalg.norm(np.cross(way, direction)) == pytest.approx(0, abs=1e-12)
        assert way @ direction > 0
        # of a unit twist: the squares of its two parts are 1 together
        lengths = [np.linalg.norm(part) for _, part in arrows(scene).values()]
        assert np.linalg.norm(lengths) == pytest.approx(LENGTH * scene.size, rel=1e-9)


def test_the_arrow_that_follows_the_sliders_is_not_drawn_beside_it():
    scene = singularity_scene(pk.singularity(UR5, np.zeros(6)))
    assert all(node.attachment.rule != "singular" for node in scene.nodes)
