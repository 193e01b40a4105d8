"""Spheres on the links of an arm, as they are given and as they move."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np

from ...checks import positive
from ...errors import InputError, ShapeError, UnknownName, quote, safe_repr, suggest
from ...groups.vectors import norms, rotation_part, translation_part
from ...model.chain import Chain
from ...model.robot import Robot

Point = tuple[float, ...]


class LinkSphere(NamedTuple):
    """A sphere on a link.

    Attributes
    ----------
    link : str
        Link.
    centre : (3,) tuple of float
        Centre in the link's frame, m.
    radius : float
        Radius, m.
    """

    link: str
    centre: Point
    radius: float


class MovedLink(NamedTuple):
    """A link with spheres: how many joints of the arm are before it, and centres, of a sphere that holds
    all others and of those, in the base frame where all joints are at 0 (m), and their radii.
    """

    name: str
    joints: int
    spheres: tuple[LinkSphere, ...]
    centres: tuple[Point, ...]
    radii: tuple[float, ...]


def moved_links(robot: Robot, chain: Chain, given: Iterable[Any]) -> list[MovedLink]:
    """Links with the spheres that are given, in the robot's order. Raises: InputError, ShapeError,
    UnknownName.
    """
    of_link: dict[str, list[LinkSphere]] = {}
    for number, one in enumerate(given):
        sphere = _checked(robot, one, f"spheres[{number}]")
        of_link.setdefault(sphere.link, []).append(sphere)
    order = sorted(of_link, key=robot.links.index)
    return [_moved(robot, chain, of_link[link]) for link in order]


def _checked(robot: Robot, one: Any, where: str) -> LinkSphere:
    try:
        link, centre, radius = one
    except (TypeError, ValueError):
        raise InputError(
            f"{where}: expected (link, centre, radius), got {safe_repr(one)}"
        ) from None
    if link not in robot.links:
        close = suggest(str(link), robot.links)
        raise UnknownName(f"{where}: there is no link {quote(link)}; {close}")
    point = np.asarray(centre, float)
    if point.shape != (3,) or not np.isfinite(point).all():
        raise ShapeError(f"{where}: expected three finite numbers, m, got {safe_repr(centre)}")
    return LinkSphere(link, tuple(point.tolist()), positive(radius, f"{where}: radius"))


def _moved(robot: Robot, chain: Chain, spheres: list[LinkSphere]) -> MovedLink:
    (link,) = {sphere.link for sphere in spheres}
    way = robot.chain(chain.base, link)
    # two ways in a tree that begin at one link part once
    both = zip(chain.joint_names, way.joint_names, strict=False)
    joints = sum(ours == theirs for ours, theirs in both)
    points = np.array([sphere.centre for sphere in spheres])
    centres = points @ rotation_part(way.home).T + translation_part(way.home)
    radii = np.array([sphere.radius for sphere in spheres])
    low = (centres - radii[:, None]).min(axis=0)
    high = (centres + radii[:, None]).max(axis=0)
    hull = (low + high) / 2
    # a rounding more, so that whatever touches a sphere touches the hull
    farthest = norms(centres - hull) + radii
    radius = float(farthest.max()) * (1 + 1e-9)
    every = [tuple(point) for point in np.vstack([hull, centres]).tolist()]
    return MovedLink(link, joints, tuple(spheres), tuple(every), (radius, *radii.tolist()))
