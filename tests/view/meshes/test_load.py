"""Mesh files: the same triangles as a reading by hand, in metres, and no file that harms."""

from __future__ import annotations

import numpy as np
import pytest

from poekin.engine.jit import cache
from poekin.errors import FileError, MissingExtra
from poekin.view.meshes import kept, load, refuse
from tests.view.meshes.mesh_files import (
    FACES,
    TETRAHEDRON,
    accessors,
    corners,
    dae,
    glb,
    obj,
    stl,
    triangles_of_stl,
)

SHIFTED = TETRAHEDRON + np.array([1, 2, 3])
RED = (
    '<library_effects><effect id="e"><profile_COMMON><technique sid="t"><lambert><diffuse>'
    "<color>1 0 0 1</color></diffuse></lambert></technique></profile_COMMON></effect></library_effects>"
    '<library_materials><material id="red"><instance_effect url="#e"/></material></library_materials>'
)
BOUND = (
    '<instance_geometry url="#g"><bind_material><technique_common>'
    '<instance_material symbol="m" target="#red"/></technique_common></bind_material></instance_geometry>'
)  # fmt: skip


def test_a_binary_stl_has_the_triangles_that_its_bytes_say():
    vertices = np.random.default_rng(1).normal(size=(30, 3))
    faces = np.random.default_rng(2).permuted(np.tile(np.arange(30), (50, 1)), axis=1)[:, :3]
    content = stl(vertices, faces)
    (part,) = load.load(content, "m.STL")
    by_hand = triangles_of_stl(content)
    assert part.color is None
    assert len(part.vertices) <= 30
    assert (part.vertices.dtype, part.faces.dtype) == (np.float32, np.uint32)
    flat = corners(by_hand.reshape(-1, 3), np.arange(150).reshape(-1, 3))
    assert np.array_equal(corners(part.vertices, part.faces), flat)


@pytest.mark.parametrize(
    ("content", "name", "wanted", "color"),
    [
        (obj(), "m.obj", TETRAHEDRON, None),
        (glb(), "m.glb", SHIFTED, 0x00FF00),
        (dae(), "m.dae", TETRAHEDRON, None),
        (dae(asset='<unit name="mm" meter="0.001"/>'), "m.DAE", TETRAHEDRON * 1e-3, None),
        (dae(asset="<up_axis>Y_UP</up_axis>"), "m.dae", TETRAHEDRON, None),
        (dae('<translate>1 2 3</translate><instance_geometry url="#g"/>'), "m.dae", SHIFTED, None),
        (dae(BOUND, library=RED, bound='material="m"'), "m.dae", TETRAHEDRON, 0xFF0000),
    ],
    ids=["obj", "glb", "dae", "its unit", "its up axis", "its node", "its material"],
)
def test_each_format_has_the_tetrahedron_in_metres_and_its_colour(content, name, wanted, color):
    (part,) = load.load(content, name)
    assert np.array_equal(corners(part.vertices, part.faces), corners(wanted, FACES))
    assert part.color == color


@pytest.mark.parametrize("asset", ["", "<up_axis>Y_UP</up_axis>", '<unit name="meter" meter="1"/>'])
@pytest.mark.parametrize("moved", ["", "<rotate>1 0 0 90</rotate>", "<scale>1 2 3</scale>"])
def test_a_dae_has_the_vertices_that_pinocchio_s_reader_gives_it(asset, moved, tmp_path):
    coal = pytest.importorskip("coal", reason="the package pin is not installed")
    content = dae(f'<translate>1 2 3</translate>{moved}<instance_geometry url="#g"/>', asset=asset)
    (tmp_path / "m.dae").write_bytes(content)
    theirs = coal.MeshLoader().load(str(tmp_path / "m.dae"), np.ones(3)).vertices()
    (part,) = load.load(content, "m.dae")
    places = sorted(map(tuple, np.unique(theirs.round(6), axis=0).tolist()))
    assert np.allclose(sorted(map(tuple, part.vertices.tolist())), places, atol=2e-6)


def test_a_dae_whose_texture_is_not_there_is_drawn_still():
    lost = RED.replace("<color>1 0 0 1</color>", '<texture texture="gone" texcoord="UV"/>')
    (part,) = load.load(dae(BOUND, library=lost, bound='material="m"'), "m.dae")
    assert len(part.faces) == 4


def test_an_obj_has_the_colours_of_the_library_beside_it_and_of_no_other_place(tmp_path):
    library = "newmtl blue\nKd 0 0 1\nmap_Kd texture.png\n"
    (tmp_path / "in").mkdir()
    for place in ("in/m.mtl", "out.mtl"):
        (tmp_path / place).write_text(library)
    for name, color in (("m.mtl", 0x0000FF), ("../out.mtl", None), ("gone.mtl", None)):
        head = f"mtllib {name}\nusemtl blue"
        (part,) = load.load(obj(head=head), str(tmp_path / "in" / "m.obj"))
        if color is None:
            assert part.color != 0x0000FF
        else:
            assert part.color == color


def test_parts_are_kept_by_their_content_and_come_back_bit_for_bit(tmp_path, monkeypatch):
    monkeypatch.setenv("POEKIN_CACHE_DIR", str(tmp_path / "cache"))
    twice = f'{BOUND}<instance_geometry url="#g"/>'
    (tmp_path / "m.dae").write_bytes(dae(twice, library=RED, bound='material="m"'))
    first = kept.parts_of(str(tmp_path / "m.dae"))
    monkeypatch.setattr(kept, "load", None)
    again = kept.parts_of(str(tmp_path / "m.dae"))
    assert [part.color for part in again] == [part.color for part in first] == [0xFF0000, None]
    for part, other in zip(first, again, strict=True):
        for one, two in zip(part[:2], other[:2], strict=True):
            assert one.dtype == two.dtype
            assert np.array_equal(one, two)
    (entry,) = (tmp_path / "cache").glob("arm-mesh*")
    entry.write_bytes(entry.read_bytes()[:-1] + b"x")  # damaged: it is read anew
    cache._logged.add("entry")
    with pytest.raises(TypeError, match="not callable"):
        kept.parts_of(str(tmp_path / "m.dae"))


BOMB = '<!DOCTYPE a [<!ENTITY b "c"><!ENTITY d "&b;&b;&b;">]>'
DOUBLED = "".join(
    f'<node id="n{k}"><instance_node url="#n{k + 1}"/><instance_node url="#n{k + 1}"/></node>'
    for k in range(40)
)
LEAF = '<node id="n40"><instance_geometry url="#g"/></node>'
HOSTILE = {
    "entities": (dae(before=BOMB), "m.dae", "DOCTYPE"),
    "malformed": (dae()[:-9], "m.dae", "malformed XML"),
    "doubled forty times": (
        dae(
            '<instance_node url="#n0"/>', library=f"<library_nodes>{DOUBLED}{LEAF}</library_nodes>"
        ),
        "m.dae",
        "named too many times",
    ),
    "a circle": (dae('<instance_node url="#n"/>'), "m.dae", "name each other"),
    "many of one": (dae('<instance_geometry url="#g"/>' * 10_001), "m.dae", "too many times"),
    "a zip": (b"PK\3\4" + b"\0" * 100, "m.dae", "malformed XML"),
    "no glb": (b"glTF", "m.glb", "it is no GLB of version 2"),
    "an array larger than its file": (
        glb(accessors=[{"componentType": 5126, "count": 10**12, "type": "VEC3"}] * 2),
        "m.glb",
        "larger than the file",
    ),
    "a node in two places": (
        glb(nodes=[{"children": [1, 1]}, {"mesh": 0}]),
        "m.glb",
        "named twice",
    ),
    "a circle of nodes": (glb(nodes=[{"children": [0]}]), "m.glb", "named twice"),
    "a buffer elsewhere": (
        glb(buffers=[{"uri": "file:///etc/hostname", "byteLength": 96}]),
        "m.glb",
        "cannot be read|no triangles",
    ),
    "not a number": (
        stl(TETRAHEDRON * np.nan),
        "m.stl",
        "finite vertices|no triangles|does not exist",
    ),
    "too far": (stl(TETRAHEDRON * 1e30), "m.stl", "finite vertices within 1e"),
    "a vertex that does not exist": (obj(faces=FACES + 7), "m.obj", "cannot be read|exist"),
    "numbers of no vertex": (
        glb(accessors=accessors(of_faces=0)),
        "m.glb",
        "does not exist",
    ),
    "a vertex too few": (glb(accessors=accessors(vertices=3)), "m.glb", "does not exist"),
    "no triangles": (b"v 0 0 0\n", "m.obj", "no triangles|cannot be read"),
    "cut off": (stl()[:-20], "m.stl", "cannot be read|no triangles"),
    "an unknown ending": (stl(), "m.mesh", "ends in .stl, .obj"),
}


@pytest.mark.parametrize("what", HOSTILE)
def test_a_hostile_or_broken_file_is_refused(what):
    content, name, why = HOSTILE[what]
    with pytest.raises(FileError, match=why):
        load.load(content, name)


@pytest.mark.parametrize("name", ["m.stl", "m.obj", "m.ply", "m.glb", "m.dae"])
def test_noise_is_refused_or_drawn_and_nothing_else(name):
    random = np.random.default_rng(3)
    for size in (1, 20, 84, 200):
        for content in (
            random.bytes(size),
            {"m.dae": dae(), "m.glb": glb()}.get(name, stl())[:-size],
        ):
            try:
                assert load.load(content, name)
            except FileError:
                continue


def test_each_place_that_names_an_array_of_a_glb_counts_once_more(monkeypatch):
    """Two primitives of four vertices, and one more for each, as an array may be empty."""
    part = {"attributes": {"POSITION": 0}, "indices": 1}
    twice = glb(meshes=[{"primitives": [part, part]}])
    monkeypatch.setattr(refuse, "MOST", 10)
    assert refuse.checked(twice, ".glb") == twice
    monkeypatch.setattr(refuse, "MOST", 9)
    with pytest.raises(FileError, match="named too many times"):
        refuse.checked(twice, ".glb")


def test_a_file_that_is_too_large_is_refused_unread(tmp_path):
    path = tmp_path / "m.stl"
    with path.open("wb") as file:
        file.truncate(65 * 2**20)
    with pytest.raises(FileError, match="at most 64 MiB"):
        kept.parts_of(str(path))


def test_without_pycollada_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "collada", None)
    message = r"^drawing meshes needs the package {}: pip install 'poekin\[view\]'$"
    with pytest.raises(MissingExtra, match=message.format("pycollada")):
        load.load(dae(), "m.dae")
    monkeypatch.setitem(__import__("sys").modules, "trimesh", None)
    with pytest.raises(MissingExtra, match=message.format("trimesh")):
        load.load(stl(), "m.stl")


def test_what_no_geometry_names_is_nothing_to_refuse():
    assert refuse.checked(b"anything", ".stl") == b"anything"


@pytest.mark.parametrize(("length", "shown"), [(200, "x" * 200), (201, "x" * 199 + "…")])
def test_two_hundred_characters_of_a_library_s_words_are_shown(monkeypatch, length, shown):
    trimesh = pytest.importorskip("trimesh")

    def fails(*_: object, **__: object) -> None:
        raise ValueError("x" * length)

    monkeypatch.setattr(trimesh, "load_scene", fails)
    with pytest.raises(FileError) as caught:
        load.load(stl(), "m.stl")
    assert str(caught.value) == f"cannot be read: {shown}"


def test_each_place_that_names_a_geometry_of_a_dae_counts_the_characters_of_its_numbers(
    monkeypatch,
):
    """Two names of one geometry with five characters, and one more for the node that has them."""
    geometry = '<geometry id="{}"><mesh><triangles><p>{}</p></triangles></mesh></geometry>'
    name = '<instance_geometry url="#a"/>'
    twice = (
        f"<COLLADA><library_geometries>{geometry.format('a', '0 1 2')}{geometry.format('b', '0')}"
        f'</library_geometries><visual_scene id="s"><node id="n">{name * 2}</node></visual_scene></COLLADA>'
    ).encode()
    monkeypatch.setattr(refuse, "MOST", 11)
    refuse.checked(twice, ".dae")
    monkeypatch.setattr(refuse, "MOST", 10)
    with pytest.raises(FileError, match=r"^its parts are named too many times$"):
        refuse.checked(twice, ".dae")
