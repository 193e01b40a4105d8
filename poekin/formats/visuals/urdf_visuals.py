"""Visuals of a URDF.

Source: the URDF specification (<visual>, <material>) and urdfdom: of materials of one name the one
below <robot> counts, else the first that has a colour. <collision> is read likewise.
"""

from __future__ import annotations

from typing import get_args

from ...errors import ModelError, quote
from ...model.provenance import Source
from ..text import xml
from ..text.xml_reader import Fields
from ..urdf import origin_of, reads_quaternions
from .visual import Color, LeftOut, Shape, ShapeTag, Visual, Visuals

_NUMBERS = {
    "cylinder": ("radius", "length"),
    "capsule": ("radius", "length"),
    "sphere": ("radius",),
}


def read(text: str | bytes, name: str, tag: ShapeTag = "visual") -> Visuals:
    """Shapes of the text of a URDF that was read as a robot; `name` stands for the file, `tag` for the
    elements that they are read from.

    A shape that cannot be understood is left out, with the reason.
    """
    root = xml.parse(text, name, tell=False)
    top = Fields(root, Source(name))
    quaternions = reads_quaternions(root.get("version"))
    colors: dict[str, Color | None] = {}
    for material in top.all("material"):
        _color(material, colors)
    found = []
    left_out = []
    for link in top.all("link"):
        for element in link.children(tag):
            try:
                found.append(_visual(element, link.name("name"), quaternions, colors))
            except ModelError as fault:
                place = element.source.place(element.line)
                why = str(fault).removeprefix(f"{place}: ")
                left_out.append(LeftOut(link.name("name"), place, f"<{tag}>", why))
    return Visuals(tuple(found), tuple(left_out))


def _visual(
    element: Fields,
    link: str,
    quaternions: bool,
    colors: dict[str, Color | None],
) -> Visual:
    geometry = _first(element, "geometry")
    if geometry is None:
        raise element.fault("expected an element <geometry>, there is none")
    shape, fields = _shape(geometry)
    material = _first(element, "material")
    color = None
    if material is not None:
        color = _color(material, colors)
    file = ""
    if shape == "mesh":
        file = fields.name("filename")
    return Visual(
        link,
        origin_of(_first(element, "origin"), quaternions),
        shape,
        _size(fields, shape),
        color,
        element.source.place(fields.line),
        file,
    )


def _shape(geometry: Fields) -> tuple[Shape, Fields]:
    for shape in get_args(Shape):
        for fields in geometry.children(shape):
            return shape, fields
    tags = ", ".join(quote(str(child.tag)) for child in geometry.element) or "none"
    raise geometry.fault(f"expected one of {', '.join(get_args(Shape))}, got {tags}")


def _first(element: Fields, tag: str) -> Fields | None:
    return next(iter(element.children(tag)), None)


def _size(fields: Fields, shape: Shape) -> tuple[float, ...]:
    if shape == "mesh":
        scale = fields.vector("scale") or (1.0, 1.0, 1.0)
        if not all(scale):
            raise fields.fault(f"scale must not be zero, got {scale}")
        return scale
    names = _NUMBERS.get(shape)
    if names:
        values = tuple(fields.number(name) or 0.0 for name in names)
    else:
        names = ("size",)
        values = fields.vector("size") or ()
    if not values or min(values) < 0 or not any(values):
        raise fields.fault(f"expected positive lengths in {' and '.join(names)}, got {values}")
    return values


def _color(
    material: Fields,
    colors: dict[str, Color | None],
) -> Color | None:
    """Colour of a material, which then stands for its name."""
    name = material.element.get("name") or ""
    if colors.get(name) is not None:
        return colors[name]
    color = None
    element = _first(material, "color")
    if element is not None:
        rgba = element.numbers("rgba", 4) or [1.0] * 4
        r, g, b, alpha = (min(max(value, 0.0), 1.0) for value in rgba)
        color = (r, g, b, alpha)
    if name:
        colors[name] = color
    return color
