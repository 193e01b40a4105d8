"""What a DAE or a GLB may hold at most: the largest that is read, and the next that is refused."""

from __future__ import annotations

import re

import pytest

from poekin.errors import FileError
from poekin.view.meshes import refuse
from tests.view.meshes.mesh_files import dae, glb

NAMED = "its parts are named too many times"
CIRCLE = "its nodes name each other, or too many times"
LARGE = "its arrays are larger than the file, or are named too many times"


def refused(data: bytes, ending: str) -> str:
    """Why a file is refused; "" where it is read."""
    try:
        refuse.checked(data, ending)
    except FileError as fault:
        return str(fault)
    return ""


def test_the_limits_are_far_from_any_real_mesh():
    assert (refuse.MOST_NODES, refuse.DEEPEST, refuse.MOST) == (10_000, 64, 134_217_728)


def test_so_many_parts_may_be_named_and_one_more_is_refused(monkeypatch):
    monkeypatch.setattr(refuse, "MOST_NODES", 3)
    named = '<instance_geometry url="#g"/>'
    assert refused(dae(named * 3), ".dae") == ""
    assert refused(dae(named * 4), ".dae") == NAMED


@pytest.mark.parametrize("depth", [2, 3])
def test_nodes_may_be_so_deep_and_one_more_is_refused(depth, monkeypatch):
    """Each pass over the nodes, the root first, finds the size of one more; the last changes none."""
    monkeypatch.setattr(refuse, "DEEPEST", 4)
    chain = "".join(
        f'<node id="n{k}"><instance_node url="#n{k + 1}"/></node>' for k in range(depth - 1)
    )
    leaf = f'<node id="n{depth - 1}"><instance_geometry url="#g"/></node>'
    text = (
        f"<COLLADA><library_nodes>{chain}{leaf}</library_nodes><library_geometries>"
        '<geometry id="g"><mesh><triangles><p>0</p></triangles></mesh></geometry>'
        "</library_geometries></COLLADA>"
    )
    assert refused(text.encode(), ".dae") == ""
    monkeypatch.setattr(refuse, "DEEPEST", depth)
    assert refused(text.encode(), ".dae") == CIRCLE


def test_a_node_counts_once_more_than_what_it_names(monkeypatch):
    """Two places that name five characters, one of them through another node: 5, 6, and 1 + 5 + 6."""
    text = (
        b'<COLLADA><visual_scene id="s"><node id="n"><instance_node url="#m"/>'
        b'<instance_geometry url="#g"/></node></visual_scene><library_nodes><node id="m">'
        b'<instance_geometry url="#g"/></node></library_nodes><library_geometries><geometry id="g">'
        b"<mesh><triangles><p>0 1</p><p>12</p></triangles></mesh></geometry></library_geometries>"
        b"</COLLADA>"
    )
    monkeypatch.setattr(refuse, "MOST", 12)
    assert refused(text, ".dae") == ""
    monkeypatch.setattr(refuse, "MOST", 11)
    assert refused(text, ".dae") == NAMED


def accessors(count: int) -> list[dict[str, object]]:
    """Arrays of a GLB, the vertices so many."""
    vertices = {"bufferView": 0, "componentType": 5126, "count": count, "type": "VEC3"}
    return [vertices, {"bufferView": 1, "componentType": 5125, "count": 12, "type": "SCALAR"}]


def test_an_array_may_have_as_many_entries_as_its_file_has_bytes():
    length = len(glb(accessors=accessors(100)))
    assert 100 <= length < 999  # so that the count has as many digits
    assert refused(glb(accessors=accessors(length)), ".glb") == ""
    assert refused(glb(accessors=accessors(length + 1)), ".glb") == LARGE


@pytest.mark.parametrize("nodes", [1, 3])
def test_vertices_of_a_glb_are_counted_where_they_are_listed_and_where_they_are_drawn(
    nodes, monkeypatch
):
    """A mesh of four vertices counts as five, in the list once, and once for each node."""
    data = glb(scenes=[{"nodes": [*range(nodes)]}], nodes=[{"mesh": 0}] * nodes + [{}])
    monkeypatch.setattr(refuse, "MOST", 5 * nodes)
    assert refused(data, ".glb") == ""
    monkeypatch.setattr(refuse, "MOST", 5 * nodes - 1)
    assert refused(data, ".glb") == LARGE


def test_a_mesh_that_no_node_draws_counts_in_the_list(monkeypatch):
    part = {"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}
    monkeypatch.setattr(refuse, "MOST", 9)
    assert refused(glb(meshes=[part, part], nodes=[{}]), ".glb") == LARGE


def test_an_empty_tree_has_nothing_to_refuse():
    empty = {"scenes": [], "nodes": [], "meshes": [], "accessors": []}
    assert refused(glb(**empty), ".glb") == ""
    tree = re.sub(rb"\{.*\}", lambda m: b"{}".ljust(len(m[0])), glb())
    assert refused(tree, ".glb") == ""


@pytest.mark.parametrize(
    "data",
    [b"", b"glTF" * 5, glb(scenes=1), glb(nodes=[1]), glb(accessors=[{}]), glb(meshes=[{}])],
)
def test_what_is_no_tree_of_a_glb_is_refused_as_none(data):
    assert refused(data, ".glb") == "it is no GLB of version 2"


def test_what_has_a_texture_and_images_are_taken_out_of_a_dae():
    """A texture with what it colours; an image that stands in another part goes with that part."""
    text = (
        b'<COLLADA><library_images><image id="i"/></library_images><library_effects><effect>'
        b'<newparam sid="s"><surface/></newparam><diffuse><texture texture="s"/></diffuse>'
        b"<ambient><color>1 0 0 1</color></ambient></effect></library_effects></COLLADA>"
    )
    left = refuse.checked(text, ".dae")
    assert left == (
        b"<COLLADA><library_effects><effect><ambient><color>1 0 0 1</color></ambient></effect>"
        b"</library_effects></COLLADA>"
    )
