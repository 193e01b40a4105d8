"""Nodes of meshes: on their links, in their place, and what is not drawn is said."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.view import shapes
from poekin.view.meshes import mesh_nodes as module
from poekin.view.meshes import reduce
from poekin.view.meshes.mesh_nodes import mesh_nodes
from poekin.view.nodes import Attachment
from tests.view.meshes.mesh_files import FACES, TETRAHEDRON, corners, stl


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("POEKIN_CACHE_DIR", "")
    (tmp_path / "m.stl").write_bytes(stl())
    return tmp_path


def robot_of(folder, visuals: str, top: str = ""):
    (folder / "r.urdf").write_text(
        f'<robot name="r">{top}<link name="base"/><link name="a">\n{visuals}\n</link>'
        '<joint name="j" type="fixed"><parent link="base"/><child link="a"/></joint></robot>'
    )
    return pk.load(folder / "r.urdf")


def visual(geometry: str, rest: str = "") -> str:
    return f"<visual>{rest}<geometry>{geometry}</geometry></visual>"


MESH = '<mesh filename="m.stl"/>'


def test_a_mesh_is_scaled_then_placed_on_its_link_and_a_mirrored_one_still_faces_outwards(folder):
    mesh = '<mesh filename="m.stl" scale="2 -3 4"/>'
    turned = '<origin xyz="1 2 3" rpy="0 0 1.5707963267948966"/>'
    (node,), missing = mesh_nodes(robot_of(folder, visual(mesh, turned)))
    assert missing == ()
    x, y, z = (TETRAHEDRON * [2, -3, 4]).T
    wanted = np.stack([1 - y, 2 + x, 3 + z], axis=1)
    assert np.array_equal(corners(node.vertices, node.faces), corners(wanted, FACES[:, ::-1]))
    assert node.attachment == Attachment("meshes", "first", 1, 0, "a")


def test_a_mesh_that_is_mirrored_twice_is_turned_and_its_faces_are_as_they_were(folder):
    mesh = '<mesh filename="m.stl" scale="-2 -3 4"/>'
    (node,), _ = mesh_nodes(robot_of(folder, visual(mesh)))
    wanted = corners(TETRAHEDRON * [-2, -3, 4], FACES)
    assert np.array_equal(corners(node.vertices, node.faces), wanted)


def test_visuals_of_one_colour_on_a_link_are_one_node_and_the_model_s_colour_is_first(folder):
    red = '<material name="red"><color rgba="1 0.5 0.25 0.5"/></material>'
    visuals = visual(MESH) + visual(MESH, red) + visual(MESH, '<material name="red"/>')
    nodes, _ = mesh_nodes(robot_of(folder, visuals))
    assert [(n.attachment.color, n.attachment.opacity, len(n.faces)) for n in nodes] == [
        (None, 1.0, 4),
        (0xFF8040, 0.5, 8),
    ]


@pytest.mark.parametrize(
    ("geometry", "low", "high", "volume"),
    [
        ('<box size="1 2 3"/>', (-0.5, -1, -1.5), (0.5, 1, 1.5), 6),
        ('<cylinder radius="0.5" length="2"/>', (-0.5, -0.5, -1), (0.5, 0.5, 1), np.pi / 2),
        ('<sphere radius="0.5"/>', (-0.5,) * 3, (0.5,) * 3, np.pi / 6),
        ('<capsule radius="0.5" length="2"/>', (-0.5, -0.5, -1.5), (0.5, 0.5, 1.5), np.pi * 2 / 3),
    ],
)
def test_a_shape_has_its_sizes_and_faces_outwards(geometry, low, high, volume, folder):
    (node,), _ = mesh_nodes(robot_of(folder, visual(geometry)))
    # polygons of 32 sides stand for circles: they lack 1 - cos(pi / 32) of the radius
    assert np.allclose(node.vertices.min(axis=0), low, atol=0.005)
    assert np.allclose(node.vertices.max(axis=0), high, atol=0.005)
    a, b, c = node.vertices[node.faces].transpose(1, 0, 2)
    assert np.einsum("ij,ij->", a, np.cross(b, c)) / 6 == pytest.approx(volume, rel=0.03)


def test_what_is_not_found_not_read_or_not_understood_is_listed_with_its_line(folder):
    (folder / "bad.stl").write_bytes(b"no")
    names = ("gone.stl", "bad.stl", "http://localhost/m.stl", "m\x1b.stl")
    visuals = "\n".join(visual(f'<mesh filename="{n.replace(chr(27), "")}"/>') for n in names)
    robot = robot_of(folder, f"{visuals}\n<visual/>\n{visual(MESH)}")
    nodes, missing = mesh_nodes(robot)
    assert len(nodes) == 1
    lines = {m.place.rpartition(":")[2]: (m.link, m.what, m.why) for m in missing}
    assert set(lines) == {"2", "3", "4", "6"}
    assert lines["2"] == ("a", "'gone.stl'", "there is no such file")
    assert lines["3"][2].startswith(("cannot be read", "there are no triangles"))
    assert "nothing over a network" in lines["4"][2]
    assert lines["6"][1] == "<visual>"


@pytest.mark.parametrize("scale", ["1e12 1 1", "1e308 1e308 1e308"])
def test_a_shape_that_is_too_far_out_is_not_drawn(scale, folder):
    mesh = f'<mesh filename="m.stl" scale="{scale}"/>'
    nodes, (left,) = mesh_nodes(robot_of(folder, visual(mesh) + visual('<sphere radius="1"/>')))
    assert len(nodes) == 1
    assert left.why == "expected it within 1e+09 m of its link"


def test_all_files_together_may_have_so_many_bytes(folder, monkeypatch):
    (folder / "n.stl").write_bytes(stl(TETRAHEDRON * 2))
    monkeypatch.setattr(module, "MOST_BYTES", 300)
    robot = robot_of(folder, visual(MESH) + visual('<mesh filename="n.stl"/>') + visual(MESH))
    (node,), (left,) = mesh_nodes(robot)
    assert len(node.faces) == 8
    assert left.what == "'n.stl'"
    assert "meshes before it" in left.why


def test_what_a_robot_s_meshes_have_already_is_said_in_mib(folder, monkeypatch):
    (folder / "n.stl").write_bytes(stl(TETRAHEDRON * 2))
    monkeypatch.setattr(module, "MOST_BYTES", 3 << 20)
    monkeypatch.setattr(module.os.path, "getsize", lambda _: 2 << 20)
    robot = robot_of(folder, visual(MESH) + visual('<mesh filename="n.stl"/>'))
    _, (left,) = mesh_nodes(robot)
    assert left.why == "the meshes before it have 3 MiB already"


def test_of_a_robot_a_thousand_shapes_are_drawn_and_the_next_one_is_named(folder):
    box = '<box size="1 2 3"/>'
    (node,), (left,) = mesh_nodes(robot_of(folder, visual(box) * 1000 + visual(MESH)))
    assert len(node.faces) == 1000 * 12
    assert (left.what, left.why) == ("'m.stl'", "the shapes before it are 1000 already")


def test_a_robot_of_too_many_triangles_has_fewer_and_says_how_far_off(folder, monkeypatch):
    monkeypatch.setattr(module, "BUDGET", 60)
    nodes, (left,) = mesh_nodes(robot_of(folder, visual('<sphere radius="1"/>') * 2))
    drawn = sum(len(node.faces) for node in nodes)
    assert 0 < drawn <= 60
    sphere = shapes.sphere()
    *_, diagonal = reduce.reduced(sphere.vertices, sphere.faces, 60 // 2)
    assert left.what == f"{2 * len(sphere.faces)} triangles are drawn as {drawn}"
    assert left.why == f"no vertex is more than {1e3 * diagonal:.2g} mm off"


def test_an_mjcf_s_meshes_are_drawn_with_the_scale_and_the_frame_of_the_asset(folder):
    pytest.importorskip("mujoco", reason="the package mujoco is not installed")
    text = (
        '<mujoco><asset><mesh name="m" file="m.stl" scale="2 3 4" refpos="1 0 0" refquat="1 1 0 0"/></asset>'
        '<worldbody><body name="b"><geom type="mesh" mesh="m" pos="0 0 5"/></body></worldbody></mujoco>'
    )
    (folder / "r.xml").write_text(text)
    (node,), missing = mesh_nodes(pk.load(folder / "r.xml"))
    x, y, z = TETRAHEDRON.T
    wanted = np.stack([x - 1, z, -y], axis=1) * [2, 3, 4] + [0, 0, 5]
    assert missing == ()
    assert np.allclose(corners(node.vertices, node.faces), corners(wanted, FACES), atol=1e-6)


def test_a_robot_without_looks_has_no_nodes():
    assert mesh_nodes(pk.load("stanford")) == ((), ())


def test_the_panda_is_drawn_whole_in_less_than_three_megabytes_of_arrays():
    robot = pk.load("panda")
    nodes, missing = mesh_nodes(robot)
    assert missing == ()
    links = {node.attachment.link for node in nodes}
    assert links == {*range(len(robot.links))} - {robot.links.index("panda_link8")}
    size = sum(12 * len(node.vertices) + 12 * len(node.faces) for node in nodes)
    assert size < 3e6
    z = np.concatenate([node.vertices[:, 2] for node in nodes if node.attachment.link == 0])
    # the base: 140 mm high, on the ground
    assert np.allclose([z.min(), z.max()], [0.0, 0.14], atol=0.005)


@pytest.mark.parametrize(("length", "shown"), [(200, "x" * 200), (201, "x" * 199 + "…")])
def test_a_name_of_two_hundred_characters_is_whole_and_a_longer_one_is_cut(folder, length, shown):
    _, (left,) = mesh_nodes(robot_of(folder, visual(f'<mesh filename="{"x" * length}"/>')))
    assert left.what == f"'{shown}'"


def test_a_page_has_four_hundred_thousand_triangles_at_most():
    assert module.BUDGET == 400_000
