"""Masses of a robot's links, and what each joint of a chain moves of them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np

from ...algebra import IDENTITY, compose, inverse, transform
from ...checks import is_real
from ...errors import ModelError, quote, safe_repr
from ...groups.arrays import Array
from ..joint import Joint
from .tree import Tree, path

# The twelve numbers of a pose (R, p), as algebra.py orders them, out of a flattened 4x4 matrix.
TWELVE = [0, 1, 2, 4, 5, 6, 8, 9, 10, 3, 7, 11]
HEAVIEST = 1e4
"""Mass (kg) from which on a link's is taken for a mistake."""
FARTHEST = 1e2
"""Distance (m) of a link's centre of mass from its origin beyond which it is taken for a mistake."""


class LinkMass(NamedTuple):
    """Mass of a link.

    Parameters
    ----------
    link : str
        Name of the link.
    mass : float
        Its mass, kg, positive and below 10 000.
    centre : tuple of float, default (0, 0, 0)
        Its centre of mass in the link's frame, m.

    Examples
    --------
    >>> import poekin as pk
    >>> turn = pk.Joint("turn", "revolute", "base", "arm", axis=(0, 1, 0))
    >>> masses = [pk.LinkMass("arm", 2.0, (0.5, 0.0, 0.0))]
    >>> pk.Robot("one", ["base", "arm"], [turn], masses=masses).chain().masses.tolist()
    [[2.0, 0.5, 0.0, 0.0]]
    """

    link: str
    mass: float
    centre: tuple[float, float, float] = (0.0, 0.0, 0.0)


def checked_masses(
    masses: Iterable[LinkMass], links: Sequence[str], place: str
) -> tuple[LinkMass, ...]:
    """Masses of links, each once. Raises: ModelError."""
    found = []
    left = set(links)
    for given in masses:
        if not isinstance(given, LinkMass) or given.link not in left:
            raise ModelError(
                f"{place}: masses: expected a LinkMass of each link at most once, got {safe_repr(given)}"
            )
        if not is_mass(given.mass, given.centre):
            raise ModelError(
                f"{place}: link {quote(given.link)}: expected a mass above 0 and below {HEAVIEST:g} kg,"
                f" and its centre within {FARTHEST:g} m, got {safe_repr(tuple(given[1:]))}"
            )
        left.remove(given.link)
        found.append(given)
    return tuple(found)


def is_mass(mass: Any, centre: Any) -> bool:
    """Whether they can be a link's mass, kg, and its centre, m."""
    if not all(map(is_real, (mass, *centre))) or len(centre) != 3:
        return False
    return 0.0 < mass < HEAVIEST and all(abs(x) <= FARTHEST for x in centre)


def moved_masses(
    tree: Tree,
    joints: Sequence[Joint],
    masses: dict[int, LinkMass],
    base: int,
    tip: int,
) -> Array | None:
    """Rows (n, 4) of what each moving joint from base to tip moves and the next one does not: its
    mass and its centre in the base link, all joints at 0. None where no link has a mass.
    """
    if not masses:
        return None
    bodies = [-1] * len(tree.parent_joint)
    moving = 0
    bodies[base] = 0
    top = base
    for number, forward in path(tree, base, tip):
        moving += joints[number].kind != "fixed"
        ends = tree.parent_link[number], tree.child_link[number]
        bodies[ends[forward]] = moving
        if not forward:
            top = ends[0]
    while tree.parent_joint[top] >= 0:  # all above moves as the highest link on the way
        above = tree.parent_link[tree.parent_joint[top]]
        bodies[above] = bodies[top]
        top = above
    poses: list[Any] = [IDENTITY] * len(bodies)
    for number in tree.order:
        parent = tree.parent_link[number]
        child = tree.child_link[number]
        origin = joints[number].origin.ravel()
        poses[child] = compose(poses[parent], origin[TWELVE].tolist())
        if bodies[child] < 0:
            bodies[child] = bodies[parent]
    to_base = inverse(poses[base])
    rows = np.zeros((moving + 1, 4))
    for link, own in masses.items():
        place = transform(to_base, transform(poses[link], own.centre))
        rows[bodies[link]] += own.mass * np.array([1.0, *place])
    whole = rows[:, 0] > 0.0
    rows[whole, 1:] /= rows[whole, :1]
    return rows[1:]
