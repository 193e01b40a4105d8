"""Visuals of MJCF: every shape where MuJoCo puts it, without a file of a mesh opened."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.formats.visuals.of_robot import visuals_of

mujoco = pytest.importorskip("mujoco", reason="the package mujoco is not installed")

TETRAHEDRON = 'vertex="0 0 0 1 0 0 0 1 0 0 0 1" face="0 2 1 0 1 3 0 3 2 1 2 3"'
SHAPES = """
<geom type="sphere" size="0.1" pos="1 2 3"/>
<geom type="capsule" size="0.1" fromto="0 0 0 0 1 1"/>
<geom type="cylinder" size="0.1 0.2" euler="10 20 30"/>
<geom type="box" size="0.1 0.2 0.3" quat="1 2 3 4"/>
<geom type="ellipsoid" size="0.1 0.2 0.3" axisangle="0 1 0 40"/>
<geom type="mesh" mesh="plain" pos="0.1 0.2 0.3" euler="90 10 0"/>
<geom type="mesh" mesh="moved" pos="0.1 0.2 0.3" euler="90 10 0"/>
<geom type="mesh" mesh="turned" euler="0 0 50"/>
"""
ASSETS = f"""
<mesh name="plain" {TETRAHEDRON}/>
<mesh name="moved" {TETRAHEDRON} scale="2 3 -4"/>
<mesh name="turned" {TETRAHEDRON} scale="2 3 4" refpos="0.1 0.2 0.3" refquat="1 2 0 1"/>
"""


def model_of(body: str, assets: str = "", top: str = "") -> str:
    return (
        f'<mujoco model="m"><compiler angle="degree" {top}/><asset>{assets}</asset><worldbody>\n'
        f'<body name="b" pos="0 0 1"><joint axis="0 1 0"/>{body}</body></worldbody></mujoco>'
    )


def looks(body: str, assets: str = "", top: str = ""):
    return visuals_of(pk.from_text(model_of(body, assets, top), "m.xml"))


def test_shapes_and_vertices_stand_where_mujoco_puts_them():
    text = model_of(SHAPES, ASSETS)
    robot = pk.from_text(text, "m.xml")
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    data.qpos[0] = 0.3
    mujoco.mj_forward(model, data)
    T_link = robot.fk([0.3])["b"]
    found, left = visuals_of(robot)
    assert left == ()
    assert len(found) == model.ngeom == 8
    for number, shape in enumerate(found):
        T = T_link @ shape.T_link_visual
        R, p = data.geom_xmat[number].reshape(3, 3), data.geom_xpos[number]
        if shape.shape != "mesh":
            # quaternions and fromto, rounded a few times at lengths of up to 4
            assert np.abs(np.hstack([R, p[:, None]]) - T[:3]).max() <= 1e-14
            continue
        mesh = model.geom_dataid[number]
        first = model.mesh_vertadr[mesh]
        theirs = model.mesh_vert[first : first + model.mesh_vertnum[mesh]] @ R.T + p
        assert shape.triangles is not None
        assert shape.T_mesh is not None
        vertices, _ = shape.triangles
        vertices = vertices @ shape.T_mesh[:3, :3].T + shape.T_mesh[:3, 3]
        ours = vertices * shape.size @ T[:3, :3].T + T[:3, 3]
        # MuJoCo's vertices are float32, and may have another order
        nearest = np.linalg.norm(theirs[:, None] - ours, axis=2).min(axis=1)
        assert nearest.max() <= 1e-6
    sizes = [shape.size for shape in found[:5]]
    assert sizes[0] == (0.1,)
    assert sizes[1] == pytest.approx((0.1, 2**0.5))
    assert sizes[2:] == [(0.1, 0.4), (0.2, 0.4, 0.6), (0.1, 0.2, 0.3)]


def test_a_mesh_s_file_is_named_with_its_folder_and_neither_loading_nor_looking_opens_it(tmp_path):
    (tmp_path / "m.xml").write_text(
        model_of('<geom type="mesh" mesh="link" rgba="0 1 0 1"/>', '<mesh file="link.stl"/>', 'meshdir="there"')
    )  # fmt: skip
    robot = pk.load(tmp_path / "m.xml")
    (found,) = visuals_of(robot).found
    assert (found.file.replace("\\", "/"), found.link) == ("there/link.stl", "b")
    assert found.color == (0, 1, 0, 1)
    assert found.place == f"{tmp_path / 'm.xml'}:2"


@pytest.mark.parametrize(
    ("geom", "color"),
    [
        ("", None),
        ('rgba="1 0 0 0.5"', (1, 0, 0, 0.5)),
        ('material="blue"', (0, 0, 1, 1)),
        ('material="blue" rgba="1 0 0 1"', (1, 0, 0, 1)),
    ],
)
def test_a_geom_has_its_own_colour_then_its_material_s(geom, color):
    material = '<texture name="t" type="2d" file="gone.png"/>'
    material += '<material name="blue" texture="t" rgba="0 0 1 1"/>'
    assert looks(f'<geom size="1" {geom}/>', material).found[0].color == color


BALL = '<geom size="1"/>'
NO_MESH = "mesh 'p' has neither a file nor vertices with faces"
SEEN = '<geom size="2" contype="0" conaffinity="0"/>'


@pytest.mark.parametrize(
    ("geoms", "drawn"),
    [
        (BALL, [1]),
        ('<geom size="3" group="3"/>', [3]),
        ('<geom size="3" group="3"/>' + BALL, [1]),
        ('<geom size="3" group="1"/>' + SEEN, [2]),
        (BALL + SEEN, [1, 2]),
        ('<geom size="3" group="1" contype="1" conaffinity="0"/>' + SEEN, [2]),
        ('<geom size="3" group="1" contype="0" conaffinity="1"/>' + SEEN, [2]),
        ('<geom size="3" rgba="1 1 1 0"/>' + BALL, [1]),
    ],
)
def test_what_mujoco_s_viewer_hides_or_contacts_alone_need_is_not_drawn(geoms, drawn):
    assert [shape.size[0] for shape in looks(geoms).found] == drawn


@pytest.mark.parametrize(
    ("geom", "asset", "why"),
    [
        ('<geom type="plane" size="1 1 1"/>', "", "geoms of the type plane are not drawn"),
        ('<geom type="capsule" mesh="plain"/>', ASSETS, "a shape that is fitted to a mesh"),
        ('<geom type="mesh" mesh="p"/>', '<mesh name="p" vertex="0 0 0 1 0 0 0 1 0 0 0 1"/>',
         NO_MESH),
        ('<geom type="mesh" mesh="p"/>', '<mesh name="p" vertex="0 0 0 1" face="0 1 2"/>', NO_MESH),
        ('<geom type="mesh" mesh="p"/>', '<mesh name="p" vertex="0 0 0 1 0 0" face="0 1"/>', NO_MESH),
    ],
)  # fmt: skip
def test_what_cannot_be_drawn_is_left_out_with_its_line(geom, asset, why):
    found, (left,) = looks(geom.replace("<geom", "<geom "), asset)
    assert found == ()
    assert left.why == why
    assert left.link == "b"
    assert left.place == f"m.xml:{2 + asset.count(chr(10))}"


def test_a_mesh_of_five_vertices_is_drawn_with_all_of_them():
    vertices = [[1, 1, 0], [-1, 1, 0], [-1, -1, 0], [1, -1, 0], [0, 0, 2]]
    faces = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [0, 2, 1], [0, 3, 2]]
    words = [" ".join(str(x) for row in rows for x in row) for rows in (vertices, faces)]
    asset = f'<mesh name="p" vertex="{words[0]}" face="{words[1]}"/>'
    (shape,) = looks('<geom type="mesh" mesh="p"/>', asset).found
    assert shape.triangles is not None
    assert [part.tolist() for part in shape.triangles] == [vertices, faces]


def test_a_model_whose_include_is_gone_is_seen_without_shapes(tmp_path):
    (tmp_path / "part.xml").write_text(f"<mujoco><worldbody>{BALL}</worldbody></mujoco>")
    (tmp_path / "m.xml").write_text('<mujoco><include file="part.xml"/></mujoco>')
    robot = pk.load(tmp_path / "m.xml")
    assert len(visuals_of(robot).found) == 1
    (tmp_path / "part.xml").unlink()
    found, (left,) = visuals_of(robot)
    assert found == ()
    assert "MuJoCo refuses this model" in left.why
