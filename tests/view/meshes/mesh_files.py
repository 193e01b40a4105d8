"""Mesh files that tests write, and read by hand."""

from __future__ import annotations

import json
import struct

import numpy as np

TETRAHEDRON = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
FACES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])


def stl(vertices=TETRAHEDRON, faces=FACES) -> bytes:
    """Binary STL."""
    facets = [
        struct.pack("<12fH", 0, 0, 0, *vertices[list(face)].ravel().tolist(), 0) for face in faces
    ]
    return b" " * 80 + struct.pack("<I", len(faces)) + b"".join(facets)


def triangles_of_stl(content: bytes) -> np.ndarray:
    """Triangles (n, 3, 3) of a binary STL."""
    (count,) = struct.unpack_from("<I", content, 80)
    rows = [struct.unpack_from("<12fH", content, 84 + 50 * k)[3:12] for k in range(count)]
    return np.array(rows).reshape(-1, 3, 3)


def obj(vertices=TETRAHEDRON, faces=FACES, head: str = "") -> bytes:
    """OBJ."""
    rows = [f"v {x} {y} {z}" for x, y, z in vertices.tolist()]
    rows += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces.tolist()]
    return "\n".join([head, *rows, ""]).encode()


def dae(
    nodes: str = '<instance_geometry url="#g"/>',
    *,
    asset: str = "",
    library: str = "",
    before: str = "",
    bound: str = "",
) -> bytes:
    """DAE of the tetrahedron as geometry g, with these nodes in the scene."""
    numbers = " ".join(map(str, TETRAHEDRON.ravel()))
    p = " ".join(map(str, FACES.ravel()))
    return f"""{before}<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset>{asset}</asset>{library}<library_geometries><geometry id="g"><mesh>
<source id="s"><float_array id="a" count="12">{numbers}</float_array><technique_common>
<accessor source="#a" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#s"/></vertices>
<triangles count="4" {bound}><input semantic="VERTEX" source="#v" offset="0"/><p>{p}</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="scene"><node id="n">{nodes}</node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#scene"/></scene></COLLADA>""".encode()


def accessors(vertices: int = 4, of_faces: int = 1) -> list[dict]:
    """How many vertices a GLB has, and in which part of its data the faces are."""
    return [
        {"bufferView": 0, "componentType": 5126, "count": vertices, "type": "VEC3"},
        {"bufferView": of_faces, "componentType": 5125, "count": 12, "type": "SCALAR"},
    ]


def glb(**changes) -> bytes:
    """GLB of the tetrahedron; changes, parts of its tree that are replaced."""
    data = TETRAHEDRON.astype("<f4").tobytes() + FACES.astype("<u4").tobytes()
    tree = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "translation": [1, 2, 3]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0, 1, 0, 1]}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
        "accessors": accessors(),
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 48},
            {"buffer": 0, "byteOffset": 48, "byteLength": 48},
        ],
        "buffers": [{"byteLength": 96}],
    } | changes
    text = json.dumps(tree).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    chunks += struct.pack("<I4s", len(data), b"BIN\0") + data
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def corners(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Triangles (n, 9), each from its smallest corner, in order: equal for the same surface."""
    rows = []
    for face in np.asarray(vertices, float)[faces].round(6).tolist():
        rows.append(min(face[k:] + face[:k] for k in range(3)))
    return np.array(sorted(rows)).reshape(-1, 9)
