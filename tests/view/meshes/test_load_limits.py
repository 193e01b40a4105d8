"""What is read of a mesh file at its limits: coordinates, colours, libraries of materials, faces."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from poekin.errors import FileError
from poekin.view.meshes import load
from tests.view.meshes.mesh_files import FACES, TETRAHEDRON, obj


@pytest.mark.parametrize("sign", [1, -1])
def test_a_vertex_may_be_a_billion_metres_away_and_no_farther(sign):
    (part,) = load.load(obj(sign * 1e9 * TETRAHEDRON), "m.obj")
    assert np.abs(part.vertices).max() == 1e9
    with pytest.raises(FileError, match=r"expected finite vertices within 1e\+09 m"):
        load.load(obj(sign * (1e9 + 1) * TETRAHEDRON), "m.obj")


def test_a_file_of_lines_or_points_alone_has_no_triangles():
    for text in (b"v 0 0 0\nv 1 0 0\nl 1 2\n", obj(faces=np.array([[0, 0, 1]]))):
        with pytest.raises(FileError, match=r"no triangles|cannot be read"):
            load.load(text, "m.obj")


def test_a_colour_has_red_first_and_is_rounded():
    assert load.rgb([1, 2, 3]) == 0x010203
    assert load.rgb([254.6, 0.4, 128.0, 7]) == 0xFF0080


def test_a_piece_has_the_colour_of_its_material_or_the_one_most_of_it_has():
    plain = SimpleNamespace(kind=None)
    bare = SimpleNamespace(kind="texture", material=None)
    painted = SimpleNamespace(
        kind="texture", material=SimpleNamespace(main_color=np.array([1, 2, 3, 255]))
    )
    rows = np.array([[9, 9, 9, 255], [4, 5, 6, 255], [4, 5, 6, 255]])
    other = np.array([[7, 7, 7, 255]])
    faces = SimpleNamespace(kind="face", face_colors=rows, vertex_colors=other)
    vertices = SimpleNamespace(kind="vertex", face_colors=other, vertex_colors=rows)
    visuals = (plain, bare, painted, faces, vertices)
    colors = [load._color(visual) for visual in visuals]
    assert colors == [None, None, 0x010203, 0x040506, 0x040506]


def test_faces_with_two_equal_corners_are_left_out_whichever_two():
    faces = np.array([[0, 1, 2], [0, 0, 1], [0, 1, 1], [1, 0, 1], [2, 1, 0]])
    kept = load.proper(faces)
    assert kept.dtype == np.uint32
    assert kept.tolist() == [[0, 1, 2], [2, 1, 0]]


def test_vertices_of_one_place_become_one_and_minus_zero_is_zero():
    second = np.where(TETRAHEDRON == 0, -0.0, TETRAHEDRON)
    vertices, faces = load.merged([(TETRAHEDRON, FACES), (second, FACES)])
    assert len(vertices) == 4
    assert not np.signbit(vertices).any()
    np.testing.assert_array_equal(vertices[faces], TETRAHEDRON[[*FACES, *FACES]])


def libraries(folder, *names: str) -> list[str]:
    """Libraries of materials that an OBJ with these in its head has."""
    text = "\n".join(f"mtllib {name}" for name in names).encode()
    return list(load._materials(text, str(folder / "m.obj")))


def test_libraries_behind_one_that_is_not_there_or_is_none_are_read_still(tmp_path):
    for name in ("b.mtl", "C.MTL", "d.txt"):
        (tmp_path / name).write_text("newmtl x\n")
    assert libraries(tmp_path, "gone.mtl", "d.txt", "b.mtl", "C.MTL") == ["b.mtl", "C.MTL"]


def test_sixteen_libraries_are_read_and_no_more(tmp_path):
    names = [f"{k:02}.mtl" for k in range(17)]
    for name in names:
        (tmp_path / name).write_text("newmtl x\n")
    assert libraries(tmp_path, *names) == names[:16]


def test_spaces_around_the_name_of_a_library_are_none_of_it(tmp_path):
    (tmp_path / "a b.mtl").write_text("newmtl x\n")
    text = b"v 0 0 0\r\n \tmtllib \t a b.mtl \t\r\nmtllibx c.mtl\n# mtllib d.mtl\n"
    assert list(load._materials(text, str(tmp_path / "m.obj"))) == ["a b.mtl"]
