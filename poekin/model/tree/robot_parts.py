"""Parts of a robot: its names, its tree, and how its joints follow the coordinates."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np

from ...errors import ModelError, UnknownName, quote, safe_repr, suggest
from ..checks import read_only
from ..joint import Joint
from ..provenance import Source
from ..readings.coupled import reading_limits
from ..readings.statements import Statements, parse_statements
from .coupling import Coupling, coupling_of, shared_limits
from .link_masses import LinkMass, checked_masses
from .tree import Tree, tree_of
from .tree_arrays import TreeLayout, layout_of


class RobotParts(NamedTuple):
    """Checked parts of a robot, and what follows from them.

    `place` is what messages name: the source, or the robot itself. `numbers` are those of the
    links; `bounds` (J, 2) are the joints' own, `limits` (m, 2) those of the coordinates, and `torn`
    lists the coordinates whose followers' bounds leave nothing in common. `readings` (m, m) is K of
    q = K r where the robot's coordinates are coupled readings r, else None.
    """

    name: str
    links: tuple[str, ...]
    joints: tuple[Joint, ...]
    place: Source
    numbers: dict[str, int]
    tree: Tree
    coupling: Coupling
    bounds: np.ndarray
    limits: np.ndarray
    torn: np.ndarray
    layout: TreeLayout
    readings: np.ndarray | None = None
    masses: tuple[LinkMass, ...] = ()


def make_parts(
    name: str,
    links: Iterable[str],
    joints: Iterable[Joint],
    source: Source | None,
    statements: Statements = (),
    masses: Iterable[LinkMass] = (),
) -> RobotParts:
    """Parts of a robot. Raises: ModelError where links and joints make no tree."""
    all_links = _items(links, "links", name)
    all_joints = _items(joints, "joints", name)
    place = source or Source(f"robot {quote(name)}")
    for joint in all_joints:
        if not isinstance(joint, Joint):
            raise ModelError(
                f"{place.place()}: joints must be Joint objects, got {safe_repr(joint)}"
            )
    tree = tree_of(all_links, all_joints, place)
    coupling = coupling_of(all_joints, place)
    bounds = np.array([joint.limits for joint in all_joints]).reshape(len(all_joints), 2)
    limits, torn = shared_limits(coupling, bounds, np.arange(len(all_joints)))
    readings = None
    if statements:
        readings = read_only(parse_statements(statements, coupling.q_names))
        limits = reading_limits(readings, limits)
    return RobotParts(
        str(name),
        all_links,
        all_joints,
        place,
        {link: number for number, link in enumerate(all_links)},
        tree,
        coupling,
        read_only(bounds),
        read_only(limits),
        torn,
        layout_of(tree, all_joints, coupling),
        readings,
        checked_masses(masses, all_links, place.place()),
    )


def link_number(parts: RobotParts, name: str, role: str) -> int:
    """Number of a link. Raises: UnknownName with the closest names."""
    if not isinstance(name, str) or name not in parts.numbers:
        close = suggest(str(name), parts.links)
        raise UnknownName(f"{parts.place.place()}: no {role} link {quote(name)}; {close}")
    return parts.numbers[name]


def _items(values: Any, what: str, name: str) -> tuple[Any, ...]:
    """Links or joints as a tuple; a text is not taken for its letters, nor a set for an order."""
    if isinstance(values, (str, bytes, set, frozenset)) or not isinstance(values, Iterable):
        raise ModelError(f"robot {quote(name)}: {what} must be a list, got {safe_repr(values)}")
    return tuple(values)
