"""A model of twice the size is drawn twice as large: each length of a drawing is a share of the arm's.

Twice is exact in floats, so what is computed by the same steps is exactly twice.
"""

from __future__ import annotations

from dataclasses import astuple, replace

import numpy as np
import pytest

import poekin as pk
from poekin.solve.path.joint_path import joint_path
from poekin.view.nodes import Cloud, Label, Node, Polyline, Triangles
from poekin.view.scene import Scene
from poekin.view.scenes.arm import arm_scene
from poekin.view.scenes.calibration import calibration_scene
from poekin.view.scenes.comparison import comparison_scene
from poekin.view.scenes.path import path_scene
from poekin.view.scenes.singular import singularity_scene
from poekin.view.scenes.solutions import solutions_scene

UR5 = pk.load("ur5").chain()
Q = np.array([0.1, -1.0, 1.2, 0.4, 0.9, -0.3])


def robot(k: float) -> pk.Robot:
    """A tree with each kind of joint, k times as large, and a link that is no longer than nothing."""
    there = pk.se3.exp([0.3, -0.2, 0.5, 0.1 * k, 0.2 * k, 0.3 * k])
    slit = (0.0, 0.02 * k)
    return pk.Robot(
        "tree",
        ["base", "spin", "slid", "screwed", "finger"],
        [
            pk.Joint("turn", "revolute", "base", "spin", there, (1, 2, 0), limits=(-1, 2)),
            pk.Joint("slide", "prismatic", "spin", "slid", there, limits=(0.1 * k, 0.4 * k)),
            pk.Joint("thread", "helical", "slid", "screwed", there, (0, 0, 1), pitch=-0.02 * k),
            pk.Joint("grip", "prismatic", "screwed", "finger", there, (1, 0, 0), limits=slit),
        ],
    )


def arm(k: float) -> pk.Chain:
    """A UR5 k times as large."""
    home = UR5.home.copy()
    home[:3, 3] *= k
    return UR5.replace(screws=UR5.screws * [1, 1, 1, k, k, k], home=home)


def moved_axis(k: float) -> pk.Chain:
    """That arm with its third axis aside by 2 mm, k times as much."""
    chain = arm(k)
    screws = chain.screws.copy()
    screws[2] = pk.se3.adjoint(pk.se3.exp([0, 0, 0, 0.002 * k, 0.002 * k, 0.002 * k])) @ screws[2]
    return chain.replace(screws=screws)


def path(k: float) -> Scene:
    """Limits over several poses and at one, and a change of branch."""
    q = Q + np.linspace(0, 0.5, 40)[:, None]
    chain = arm(k)
    limits = np.array(chain.limits)
    limits[0] = [-9, q[5, 0]]
    limits[1] = [q[39, 1], 9]
    q[5:10, 0] = q[5, 0]
    q[39, 1] = limits[1, 0]
    made = joint_path(chain.replace(limits=limits), q)
    return path_scene(replace(made, branch_switches=(20,)))


def calibration(k: float) -> Scene:
    """The same deviations, k times as large; the fit is the same to its tolerance."""
    chain = arm(k)
    q = chain.random(3, size=30)
    true = moved_axis(k).fk(q)
    true[::3, :3, 3] += 1e-5 * k * np.sin(np.arange(30))[: len(true[::3]), None]
    return calibration_scene(pk.calibrate(chain, q, true, folds=0))


SCENES = {
    "robot": lambda k: arm_scene(robot(k)),
    "chain": lambda k: arm_scene(arm(k), q=Q, cloud=5),
    "path": path,
    "singularity": lambda k: singularity_scene(pk.singularity(arm(k), np.zeros(6))),
    "solutions": lambda k: solutions_scene(pk.ik_all(arm(k), arm(k).fk(Q))),
    "comparison": lambda k: comparison_scene(pk.compare(arm(k), moved_axis(k))),
    "calibration": calibration,
}


def lengths(node: Node) -> np.ndarray:
    """All numbers of a node that are lengths."""
    if isinstance(node, Triangles):
        return node.vertices.ravel()
    if isinstance(node, Polyline):
        return np.append(node.points.ravel(), node.width)
    if isinstance(node, Cloud):
        return np.append(node.points.ravel(), node.size)
    assert isinstance(node, Label)
    return node.point


@pytest.mark.parametrize("kind", SCENES)
def test_a_model_of_twice_the_size_is_drawn_twice_as_large(kind):
    """Of a fit and of inverse kinematics to 1e-6 of the size, as they end where they are near."""
    one, two = SCENES[kind](1.0), SCENES[kind](2.0)
    assert two.size == 2 * one.size
    # of a sentence that names a length, its first words
    places = [
        [astuple(replace(n.attachment, name=n.attachment.name[:9])) for n in s.nodes]
        for s in (one, two)
    ]
    assert places[0] == places[1]
    for small, large in zip(one.nodes, two.nodes, strict=True):
        k = (
            2.0 if small.attachment.rule in (None, "target") else 1.0
        )  # the page makes it as long as J says
        np.testing.assert_allclose(lengths(large), k * lengths(small), rtol=0, atol=1e-9 * one.size)
