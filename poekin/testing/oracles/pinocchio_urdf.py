"""URDF as Pinocchio takes it: plain elements, and what `<mimic>` says about coordinates.

XML is decoded, and refused where it is not safe, by `poekin.formats.text.xml`, which is lxml.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from lxml import etree  # pyright: ignore[reportAttributeAccessIssue]  (it is compiled and has no stubs)

from ...errors import ModelError, quote
from ...formats.text import xml


def text_of(root: xml.Element) -> str:
    """Text of an element."""
    return etree.tostring(root, encoding="unicode")


def plain(root: xml.Element) -> xml.Element:
    """Elements of the root's namespace under their names without it, and no others; nothing with a
    prefix that is not declared.
    """
    space, bracket, _ = root.tag.rpartition("}")

    def parts(element: xml.Element) -> tuple[str, dict[str, str]]:
        return element.tag.rpartition("}")[2], {
            k: v for k, v in element.attrib.items() if not k.startswith("{") and ":" not in k
        }

    plain = etree.Element(*parts(root))
    copies = {root: plain}
    for element in root.iterdescendants(f"{space}{bracket}*" if bracket else "{}*"):
        above = copies.get(element.getparent())
        if (
            above is not None and ":" not in parts(element)[0]
        ):  # else it is inside of an element of another namespace
            copies[element] = etree.SubElement(above, *parts(element))
    return plain


def coupling_of(
    root: xml.Element,
    joints: Sequence[str],
) -> tuple[tuple[str, ...], np.ndarray, np.ndarray]:
    """Independent coordinates, C (n, m) and c (n,): x = C q + c for the moving joints, out of the
    `<mimic>` tags.
    """
    elements = {e.get("name"): e for e in root.findall("joint")}
    mimics: dict[str, tuple[str, float, float]] = {}
    for name in joints:
        mimic = elements[name].find("mimic")
        if mimic is not None and mimic.get("joint") in elements:
            scale = float(mimic.get("multiplier", 1))
            shift = float(mimic.get("offset", 0))
            mimics[name] = str(mimic.get("joint")), scale, shift
    coordinates = tuple(name for name in joints if name not in mimics)
    C = np.zeros((len(joints), len(coordinates)))
    c = np.zeros(len(joints))
    for row, name in enumerate(joints):
        master = name
        scale = 1.0
        shift = 0.0
        for _ in range(len(mimics)):
            if master not in mimics:
                break
            master, factor, step = mimics[master]
            scale, shift = scale * factor, shift + scale * step
        if master in mimics:
            raise ModelError(f"the joints that mimic {quote(master)} go round in a circle")
        c[row] = shift
        if master in coordinates:
            C[row, coordinates.index(master)] = scale
    return coordinates, C, c
