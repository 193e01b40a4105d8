"""Masses of links as `<inertial>` of a URDF has them."""

from __future__ import annotations

from collections.abc import Sequence

from ...errors import quote
from ...model.provenance import Source, warn
from ...model.tree.link_masses import FARTHEST, HEAVIEST, LinkMass, is_mass
from ..text.numbers import real
from ..text.xml_reader import Fields


def link_masses(links: Sequence[Fields], source: Source, tell: bool) -> list[LinkMass]:
    """Masses of the links that have one; 0 is none, as frames have it. Where one is negative or absurd,
    no other is believed: with `tell` a warning says so.
    """
    found = []
    for link in links:
        for inertial in link.children("inertial")[:1]:
            mass = _numbers(inertial, "mass", "value", "0")
            if mass == [0.0]:
                continue
            centre = _numbers(inertial, "origin", "xyz", "0 0 0")
            if len(mass) != 1 or not is_mass(mass[0], centre):
                if tell:
                    warn(_refusal(link, inertial, source, mass, centre))
                return []
            x, y, z = centre
            found.append(LinkMass(link.name("name"), mass[0], (x, y, z)))
    return found


def _numbers(inertial: Fields, tag: str, attribute: str, default: str) -> list[float]:
    """Numbers of an attribute of the first child of that tag, as far as they are such."""
    texts = [child.element.get(attribute, default) for child in inertial.children(tag)]
    words = [*texts, default][0].split()
    return [x for x in map(real, words) if x is not None]


def _refusal(
    link: Fields, inertial: Fields, source: Source, mass: list[float], centre: list[float]
) -> str:
    return (
        f"{source.place(inertial.line)}: link {quote(link.name('name'))}: expected a mass from 0 to"
        f" {HEAVIEST:g} kg with its centre within {FARTHEST:g} m, got {mass} at {centre}: the masses of"
        " this robot are not used"
    )
