"""Geometry of an arm to be drawn, the same for a robot and for a chain: joints, bones and frames,
each on a numbered link.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from ....errors import join_names
from ....groups.arrays import Array
from ....groups.vectors import translation_part
from ....model.chain_data import ScrewKind
from ....model.coordinates import one_configuration
from ...scene import Slider
from ...shapes import transformed

FrameKind = Literal["end", "tip", "link"]


@dataclass(frozen=True, slots=True, eq=False)
class JointGeometry:
    """A joint that moves.

    Attributes
    ----------
    name : str
        Name of the joint.
    kind : {"revolute", "prismatic", "helical"}
        Kind of its motion.
    parent, child : int
        Numbers of the links that it joins.
    point, direction : (3,) ndarray
        Point of its axis, m, and unit vector along it, in the parent link's coordinates.
    child_point, child_direction : (3,) ndarray
        The same in the child link's coordinates.
    pitch : float
        Pitch, m per rad.
    limits : tuple of float
        Lower and upper bound of the joint's own value, rad or m.
    screw : (6,) ndarray
        Screw (ω; v) in the base frame at q = 0.
    """

    name: str
    kind: ScrewKind
    parent: int
    child: int
    point: Array
    direction: Array
    child_point: Array
    child_direction: Array
    pitch: float
    limits: tuple[float, float]
    screw: Array


@dataclass(frozen=True, slots=True, eq=False)
class Bone:
    """Segment of a link between two points (3,) in its coordinates, m."""

    link: int
    start: Array
    end: Array


@dataclass(frozen=True, slots=True, eq=False)
class LinkFrame:
    """Frame on a link.

    Attributes
    ----------
    link : int
        Number of the link.
    pose : (4, 4) ndarray
        Pose in the link's coordinates, m.
    name : str
        Words for it.
    kind : {"end", "tip", "link"}
        "end" of the base and of the tip that is shown first, "tip" of other tips.
    """

    link: int
    pose: Array
    name: str
    kind: FrameKind


@dataclass(frozen=True, slots=True, eq=False)
class ArmGeometry:
    """All that is drawn of an arm.

    Attributes
    ----------
    name : str
        Name of the model.
    links : tuple of str
        Names of the links.
    sliders : tuple of Slider
        Coordinates with units and limits.
    joints : tuple of JointGeometry
        Joints that move, from the base on.
    bones : tuple of Bone
        Segments of the links.
    frames : tuple of LinkFrame
        Frames of the base, of the links that joints move, and of the tips.
    poses : callable
        Poses (L, 4, 4) of the links, m, from a configuration (m,).
    """

    name: str
    links: tuple[str, ...]
    sliders: tuple[Slider, ...]
    joints: tuple[JointGeometry, ...]
    bones: tuple[Bone, ...]
    frames: tuple[LinkFrame, ...]
    poses: Callable[[Array], Array]

    def points(self, q: Array) -> Array:
        """Points (n, 3) of the arm in its base frame: the ends of its bones and its frames, m."""
        T = self.poses(q)
        held = [(bone.link, point) for bone in self.bones for point in (bone.start, bone.end)]
        held += [(frame.link, translation_part(frame.pose)) for frame in self.frames]
        return np.array([transformed(point, T[link]) for link, point in held])


def opening_q(sliders: tuple[Slider, ...], q: Any = None) -> Array:
    """Configuration (m,) of the sliders: q; without it zero where that is within the limits, else
    their middle, or the one bound that there is.

    Raises: what `one_configuration` does.
    """
    if q is None:
        return np.array([_opening(slider.lower, slider.upper) for slider in sliders])
    return one_configuration(q, tuple(slider.name for slider in sliders))


def _opening(lower: float, upper: float) -> float:
    if lower <= 0 <= upper:
        return 0.0
    if math.isfinite(lower) and math.isfinite(upper):
        return 0.5 * (lower + upper)
    return lower if math.isfinite(lower) else upper


def beyond(sliders: tuple[Slider, ...], reached: tuple[Slider, ...]) -> str:
    """Names of sliders that reach further than before; "" where none does."""
    return join_names([new.name for old, new in zip(sliders, reached, strict=True) if new != old])


def widened(sliders: tuple[Slider, ...], q: Array) -> tuple[Slider, ...]:
    """Sliders that reach all configurations (N, m)."""
    low = q.min(axis=0, initial=math.inf)
    high = q.max(axis=0, initial=-math.inf)
    return tuple(
        replace(slider, lower=min(slider.lower, least), upper=max(slider.upper, most))
        for slider, least, most in zip(sliders, low.tolist(), high.tolist(), strict=True)
    )
