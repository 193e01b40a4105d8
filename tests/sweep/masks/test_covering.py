"""Spheres around collision geometry hold it."""

from __future__ import annotations

import numpy as np
import pytest

from poekin.formats.visuals import urdf_visuals
from poekin.sweep.masks import covering as covering_module
from poekin.sweep.masks.covering import covering
from poekin.view.meshes.mesh_nodes import ShapeReader
from tests.sweep.masks.arm_of_all_shapes import SHAPES, robot_in, urdf

RNG = np.random.default_rng(0)


def on_surface(shape):
    """Points on the surface of each shape, in its own frame."""
    u = RNG.uniform(-1, 1, (500, 3))
    if shape == "box":
        faces = u / np.abs(u).max(axis=1, keepdims=True)
        return faces * [0.15, 0.1, 0.05]
    if shape == "sphere":
        return 0.06 * u / np.linalg.norm(u, axis=1, keepdims=True)
    if shape == "mesh":
        corners = np.array([[0, 0, 0], [0.1, 0, 0], [0, 0.08, 0], [0.02, 0.02, 0.25]])
        weights = RNG.dirichlet([1] * 3, 500)
        faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
        points = np.einsum("ki,kij->kj", weights, corners[faces[np.arange(500) % 4]])
        return points * [1, -1, 1]
    radius, half = {"cylinder": (0.05, 0.15), "capsule": (0.05, 0.2)}[shape]
    angle = np.pi * u[:, 0]
    side = np.stack([radius * np.cos(angle), radius * np.sin(angle), half * u[:, 1]], axis=1)
    ends = side * [1, 1, 0] * np.abs(u[:, 2:]) + [0, 0, half] * np.sign(u[:, 1:2])
    if shape == "cylinder":
        return np.concatenate([side, ends])
    caps = 0.05 * u / np.linalg.norm(u, axis=1, keepdims=True)
    caps[:, 2] += 0.15 * np.sign(caps[:, 2])
    return np.concatenate([side * [1, 1, 0.75], caps])


@pytest.mark.parametrize("tolerance", [0.03, 0.1])
def test_every_point_of_a_shape_is_in_a_sphere(tmp_path, tolerance):
    capsule = '<capsule radius="0.05" length="0.3"/>'
    robot = robot_in(tmp_path, urdf(SHAPES | {"extra": capsule}).replace("</robot>", LINKED))
    found, excess = covering(robot, tolerance)
    assert 0 < excess <= 1.1 * tolerance
    cosine, sine = np.cos([0.1, 0.3]), np.sin([0.1, 0.3])
    about_y = np.array([[cosine[0], 0, sine[0]], [0, 1, 0], [-sine[0], 0, cosine[0]]])
    about_z = np.array([[cosine[1], -sine[1], 0], [sine[1], cosine[1], 0], [0, 0, 1]])
    for link, text in (SHAPES | {"extra": capsule}).items():
        points = on_surface(text.split()[0][1:]) @ (about_z @ about_y).T + [0, 0, 0.15]
        of_link = [sphere for sphere in found if sphere.link == link]
        centres = np.array([sphere.centre for sphere in of_link])
        radii = [sphere.radius for sphere in of_link]
        beyond = np.linalg.norm(points[:, None] - centres, axis=2) - radii
        assert beyond.min(axis=1).max() <= 1e-15
        assert (len(of_link) == 1) == (link == "hand")


LINKED = (
    """<joint name="j9" type="fixed"><parent link="base"/><child link="extra"/></joint></robot>"""
)


def test_smaller_tolerances_take_more_spheres_that_stand_out_less(tmp_path):
    robot = robot_in(tmp_path)
    counts, excesses = zip(
        *(
            (len(found), excess)
            for found, excess in (covering(robot, t) for t in (0.08, 0.05, 0.03))
        ),
        strict=True,
    )
    assert list(counts) == sorted(counts)
    assert counts[0] < counts[2]
    assert list(excesses) == sorted(excesses, reverse=True)


def test_the_excess_is_that_of_the_sphere_that_stands_out_most(tmp_path):
    worst = 0.0
    for link, shape in SHAPES.items():
        alone = robot_in(
            tmp_path, urdf(dict.fromkeys(SHAPES, "<sphere radius='0.01'/>") | {link: shape})
        )
        worst = max(worst, covering(alone, 0.1).excess)
    for order in (SHAPES, dict(reversed(SHAPES.items()))):
        assert covering(robot_in(tmp_path, urdf(order)), 0.1).excess == worst


def test_the_polygon_of_a_cylinder_is_around_its_circle(tmp_path):
    robot = robot_in(tmp_path)
    found = urdf_visuals.read(urdf(), "r", "collision").found
    (cylinder,) = (shape for shape in found if shape.shape == "cylinder")
    around = covering_module._around(cylinder)
    (part,) = ShapeReader(robot).parts(around)
    corners = np.hypot(*part.vertices[:, :2].T).max()
    # the middle of a side is the nearest to the axis
    assert corners * np.cos(np.pi / 32) >= 0.05 - 1e-8
