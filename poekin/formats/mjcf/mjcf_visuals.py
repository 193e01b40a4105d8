"""Visuals of an MJCF: its geoms as MuJoCo compiles them, without opening a file of a mesh.

MuJoCo's own viewer shows the groups 0 to 2, and so are geoms drawn here; all, where these have
none. Of a body that has geoms that touch nothing (contype and conaffinity 0), those that do are
drawn in the same groups only: others stand for its contacts. A geom has its own colour, unless that
is MuJoCo's grey, else its material's, without texture.

A mesh's vertices p are at T_link_visual diag(scale) P^-1 p, P its refpos and refquat; MuJoCo moves
them to the axes of inertia and the geom with them, which is the same place.

Source: the MJCF reference of MuJoCo (geom, mesh).
"""

from __future__ import annotations

import os
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np

from ...errors import PoekinError, quote
from ...groups import se3
from ...groups.arrays import Array
from ...model.provenance import Source
from ..text import xml
from ..visuals.visual import Color, LeftOut, Shape, Visual, Visuals
from . import mjcf
from .mjcf_robot import ModelReader

SHOWN_GROUPS = range(3)
GREY = (0.5, 0.5, 0.5, 1.0)
"""Colour of geoms whose file says nothing, in MuJoCo."""
SHAPES: dict[int, Shape] = {
    2: "sphere",
    3: "capsule",
    4: "ellipsoid",
    5: "cylinder",
    6: "box",
    7: "mesh",
}
"""By the number that MuJoCo gives to a geom's type (mjtGeom)."""


class _Mesh(NamedTuple):
    """Mesh of a spec: scale, pose of its vertices before that, file or triangles."""

    scale: tuple[float, ...]
    before: Array
    file: str
    triangles: tuple[Array, np.ndarray] | None


class _Geom(NamedTuple):
    """Geom before it is compiled; why it is not drawn, "" where it is."""

    geom: Any
    type: int
    line: int | None
    color: Color | None
    mesh: _Mesh | None
    why: str


def read(text: str | bytes, name: str) -> Visuals:
    """Visuals of the text of an MJCF that was read as a robot; `name` stands for the file.

    What MuJoCo refuses now, as where a file to include is gone, is the reason for no visuals.
    """
    path = ""
    try:
        if os.path.isfile(name):
            plain = text.encode() if isinstance(text, str) else text
            if xml.read_bytes(name) == plain:
                path = os.path.abspath(name)
        _, model, (_, geoms) = mjcf.compiled(text, name, path, _prepared)
    except PoekinError as fault:
        place = Source(name).place()
        return Visuals((), (LeftOut("world", place, "<mujoco>", str(fault)),))
    source = Source(name)
    reader = ModelReader(model)
    found = []
    left_out = []
    for geom in _drawn(geoms, model):
        number = int(geom.geom.id)
        body = int(model.geom_bodyid[number])
        place = source.place(geom.line)
        if body in reader.gone:
            continue
        link = reader.links[body]
        if geom.why:
            left_out.append(LeftOut(link, place, "<geom>", geom.why))
        else:
            found.append(_visual(geom, model, link, place))
    return Visuals(tuple(found), tuple(left_out))


def _prepared(spec: Any, mujoco: ModuleType) -> tuple[Any, list[_Geom]]:
    """Geoms of a spec, and the spec that keeps them alive; what needs a file becomes a sphere."""
    folder = str(spec.meshdir)
    meshes = {_name(mesh): _mesh(mesh, folder) for mesh in spec.meshes}
    colors = {material.name: _rgba(material) for material in spec.materials}
    geoms = [_geom(geom, meshes, colors) for geom in spec.geoms]
    for geom in geoms:
        if geom.mesh is not None or geom.why:
            mjcf.make_sphere(geom.geom, mujoco)
            geom.geom.fromto = [np.nan] * 6
    mjcf.without_dynamics(spec, mujoco)
    return spec, geoms


def _geom(
    geom: Any,
    meshes: dict[str, _Mesh],
    colors: dict[str, Color],
) -> _Geom:
    kind = int(geom.type)
    color: Color | None = _rgba(geom)
    if color == GREY:
        color = colors.get(geom.material)
    why = ""
    mesh = None
    if kind not in SHAPES:
        called = geom.type.name.removeprefix("mjGEOM_")
        why = f"geoms of the type {called.lower()} are not drawn"
    elif geom.meshname and SHAPES[kind] != "mesh":
        why = "a shape that is fitted to a mesh"
    elif SHAPES[kind] == "mesh":
        mesh = meshes.get(geom.meshname)
        if mesh is None:
            why = f"there is no mesh {quote(geom.meshname)}"
        elif not mesh.file and mesh.triangles is None:
            why = f"mesh {quote(geom.meshname)} has neither a file nor vertices with faces"
    return _Geom(geom, kind, _line(geom.info), color, mesh, why)


def _name(mesh: Any) -> str:
    """Name of a mesh: one without is called after its file, which older versions do as they compile."""
    if mesh.name:
        return mesh.name
    file = os.path.basename(mesh.file)
    return os.path.splitext(file)[0]


def _mesh(mesh: Any, folder: str) -> _Mesh:
    vertices = np.array(list(mesh.uservert), dtype=float)
    faces = np.array(list(mesh.userface), dtype=np.int64)
    triangles = None
    whole = len(vertices) % 3 == len(faces) % 3 == 0
    if len(vertices) and len(faces) and whole:
        triangles = vertices.reshape(-1, 3), faces.reshape(-1, 3)
    file = str(mesh.file)
    if file:
        file = os.path.join(folder, file)
    turn = np.array(mesh.refquat, dtype=float)
    turn /= np.linalg.norm(turn) or 1.0
    place = np.array([mesh.refpos], dtype=float)
    reference = mjcf.poses(place, turn[None])[0]
    scale = tuple(map(float, mesh.scale))
    return _Mesh(scale, se3.inverse(reference), file, triangles)


def _drawn(geoms: list[_Geom], model: Any) -> list[_Geom]:
    """Geoms that are drawn: not those for contacts alone, nor those that cannot be seen."""
    seen = [geom for geom in geoms if _is_opaque(geom)]
    shown = [geom for geom in seen if geom.geom.group in SHOWN_GROUPS] or seen
    bodies = [int(model.geom_bodyid[geom.geom.id]) for geom in shown]
    groups = [int(geom.geom.group) for geom in shown]
    looks: dict[int, set[int]] = {}
    for geom, body, group in zip(shown, bodies, groups, strict=True):
        if not (geom.geom.contype or geom.geom.conaffinity):
            looks.setdefault(body, set()).add(group)
    drawn = []
    for geom, body, group in zip(shown, bodies, groups, strict=True):
        if group in looks.get(body, {group}):
            drawn.append(geom)
    return drawn


def _is_opaque(geom: _Geom) -> bool:
    return geom.color is None or geom.color[3] > 0


def _visual(
    geom: _Geom,
    model: Any,
    link: str,
    place: str,
) -> Visual:
    number = int(geom.geom.id)
    turns = model.geom_quat[[number]]
    T = mjcf.poses(model.geom_pos[[number]], turns)[0]
    shape = SHAPES[geom.type]
    if geom.mesh is not None:
        scale, before, file, triangles = geom.mesh
        return Visual(link, T, shape, scale, geom.color, place, file, triangles, before)
    size = _size(shape, model.geom_size[number])
    return Visual(link, T, shape, size, geom.color, place)


def _size(shape: Shape, size: Array) -> tuple[float, ...]:
    """Sizes as `Visual` has them: MuJoCo's are radii and halves of lengths."""
    x, y, z = map(float, size)
    sizes: dict[str, tuple[float, ...]] = {
        "sphere": (x,),
        "ellipsoid": (x, y, z),
        "box": (2 * x, 2 * y, 2 * z),
    }
    return sizes.get(shape, (x, 2 * y))


def _rgba(element: Any) -> Color:
    rounded = (round(float(value), 6) for value in element.rgba)
    r, g, b, alpha = (min(max(value, 0.0), 1.0) for value in rounded)
    return r, g, b, alpha


def _line(info: str) -> int | None:
    """Line of an element, out of what MuJoCo says of it: "line 12"."""
    word = info.rpartition(" ")[2]
    if info.startswith("line ") and word.isdigit():
        return int(word)
    return None
