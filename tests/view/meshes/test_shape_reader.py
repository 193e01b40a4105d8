"""Shapes of a robot one by one: which are read, how far they reach, and what is left of a budget."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.errors import FileError
from poekin.formats.visuals.visual import Visual
from poekin.view.meshes import mesh_nodes as module
from poekin.view.meshes.load import MeshPart
from poekin.view.meshes.mesh_nodes import ShapeReader
from tests.view.meshes.mesh_files import FACES, TETRAHEDRON, stl


def visual(shape: Any, size: tuple[float, ...], **more: Any) -> Visual:
    held = {"link": "a", "T_link_visual": np.eye(4), "color": None, "place": ""} | more
    return Visual(shape=shape, size=size, **held)


@pytest.fixture
def reader(tmp_path, monkeypatch) -> ShapeReader:
    monkeypatch.setenv("POEKIN_CACHE_DIR", "")
    for name in ("m.stl", "n.stl"):
        (tmp_path / name).write_bytes(stl())
    (tmp_path / "r.urdf").write_text('<robot name="r"><link name="a"/></robot>')
    return ShapeReader(pk.load(tmp_path / "r.urdf"))


def test_triangles_that_stand_in_the_model_are_drawn(reader):
    (part,) = reader.parts(visual("mesh", (1, 1, 1), triangles=(TETRAHEDRON, FACES)))
    np.testing.assert_array_equal(part.vertices[part.faces], TETRAHEDRON[FACES])


@pytest.mark.parametrize("faces", [[[0, 1, 4]], [[0, 1, -1]], np.empty((0, 3), int)])
def test_a_face_without_its_vertex_is_refused(reader, faces):
    with pytest.raises(FileError, match=r"^a face has a vertex that does not exist$"):
        reader.parts(visual("mesh", (1, 1, 1), triangles=(TETRAHEDRON, np.array(faces))))


def test_shapes_of_one_kind_and_size_are_made_once(reader):
    first = reader.parts(visual("sphere", (0.5,)))
    assert reader.parts(visual("sphere", (0.5,))) is first
    assert reader.parts(visual("sphere", (0.6,))) is not first
    assert reader.parts(visual("cylinder", (0.5, 0.5))) is not first


def test_an_ellipsoid_has_its_three_semi_axes_and_a_sphere_its_radius_thrice(reader):
    for size, reached in (((1.0, 2.0, 3.0), [1, 2, 3]), ((2.0,), [2, 2, 2])):
        (part,) = reader.parts(visual("ellipsoid" if len(size) > 1 else "sphere", size))
        np.testing.assert_allclose(part.vertices.max(axis=0), reached, rtol=1e-12)


def test_files_may_have_512_mib_together_to_the_last_byte(reader):
    assert reader.left == 536_870_912
    reader.left = 2 * 284  # a header of 84 bytes and 50 for each of four triangles
    for name in ("m.stl", "m.stl", "n.stl"):
        assert len(reader.parts(visual("mesh", (1, 1, 1), file=name))) == 1
    assert reader.left == 0


def test_a_part_of_several_shapes_is_reduced_once(reader):
    (part,) = reader.parts(visual("sphere", (1.0,)))
    fewer = reader.reduced(part, 50)
    assert len(fewer.faces) <= 50
    assert reader.reduced(part, 50) is fewer


def at(x: float, y: float, z: float) -> np.ndarray:
    T = np.eye(4)
    T[:3, 3] = x, y, z
    return T


@pytest.mark.parametrize(
    ("of", "bound"),
    [
        (visual("box", (1, 1, 1)), 3.0),
        (visual("box", (9, 9, 9), T_link_visual=at(0, -5, 1)), 3.0 + 5.0),
        (visual("mesh", (1, -4, 2)), 4 * 3.0),
        (visual("mesh", (1, -4, 2), T_mesh=at(0, 1, -2)), 4 * (3.0 + 2.0)),
        (visual("mesh", (1, 1, 4), T_mesh=at(2, 0, 0), T_link_visual=at(0.5, 0, 0)), 20.5),
    ],
)
def test_a_shape_is_bounded_by_its_vertices_its_mesh_s_place_its_scale_and_its_own_place(of, bound):
    vertices = np.array([[1.0, 2, -3], [0, 0, 0]])
    parts = tuple(MeshPart(v, FACES, None) for v in (vertices[1:], vertices, vertices[:0]))
    assert module._farthest(of, parts) == bound


def robot(folder, visuals: str) -> pk.Robot:
    (folder / "v.urdf").write_text(f'<robot name="v"><link name="a">{visuals}</link></robot>')
    return pk.load(folder / "v.urdf")


def box(more: str = "", size: float = 1.0) -> str:
    return f'<visual>{more}<geometry><box size="{size} 1 1"/></geometry></visual>'


def test_what_cannot_be_seen_is_not_drawn(tmp_path):
    clear = '<material name="c"><color rgba="1 0 0 0"/></material>'
    assert module.mesh_nodes(robot(tmp_path, box(clear))) == ((), ())


def test_a_shape_may_be_a_billion_metres_out_and_no_farther(tmp_path):
    """The corners of a box of a metre are half a metre nearer or farther than its place."""
    out = '<origin xyz="0 0 {}"/>'
    visuals = box(out.format(1e9 - 0.5)) + box(out.format(1e9))
    (node,), (left,) = module.mesh_nodes(robot(tmp_path, visuals))
    assert len(node.faces) == 12
    assert (left.what, left.why) == ("'box'", "expected it within 1e+09 m of its link")


def test_how_far_a_vertex_is_off_is_said_of_the_largest_scale(tmp_path, monkeypatch):
    """A mesh that is drawn two and forty times as large as its file has it; its faces are reduced."""
    monkeypatch.setenv("POEKIN_CACHE_DIR", "")
    monkeypatch.setattr(module, "BUDGET", 4)
    (tmp_path / "m.stl").write_bytes(stl())
    drawn = []

    def fewer(vertices: Any, faces: Any, limit: int) -> Any:
        drawn.append(limit)
        return vertices, faces[:limit], 0.25

    monkeypatch.setattr(module, "reduced", fewer)
    meshes = [
        f'<visual><geometry><mesh filename="m.stl" scale="{x} 1 1"/></geometry></visual>'
        for x in (2, -40)
    ]
    _, (left,) = module.mesh_nodes(robot(tmp_path, "".join(meshes)))
    assert drawn == [2]
    assert left.link == ""
    assert left.what == "8 triangles are drawn as 4"
    assert left.why == "no vertex is more than 1e+04 mm off"
