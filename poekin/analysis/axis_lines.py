"""Axes of an arm as lines: their directions, places and distances, and the arm at rest."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..groups.arrays import Array
from ..groups.vectors import angular_part, applied, linear_part, norm
from ..model.chain import Chain
from ..model.chain_data import ChainData
from ..model.readings.coupled import own_limits

Marks = NDArray[np.bool_]

POSITION = 1e-5
"""Default of `tol_position`, m: 0.01 mm."""
ROTATION = math.radians(1e-3)
"""Default of `tol_rotation`, rad: 0.001 deg."""

_NEXT = [1, 2, 0]
_LAST = [2, 0, 1]


class Tolerances(NamedTuple):
    """Largest position (m) and rotation (rad) that make no difference."""

    position: float
    rotation: float


def cross(x: Array, y: Array) -> Array:
    """x × y over the last axis (..., 3): `numpy.cross` takes four times as long for so few numbers."""
    ahead = x[..., _NEXT] * y[..., _LAST]
    return ahead - x[..., _LAST] * y[..., _NEXT]


def prismatic(chain: ChainData) -> Marks:
    """Whether each joint is prismatic (n)."""
    slides = [kind == "prismatic" for kind in chain.kinds]
    return np.array(slides, bool)


def direction(axes: Array, slides: Marks) -> Array:
    """Unit directions (n, 3) of axes, some of which are those of prismatic joints."""
    return np.where(slides[:, None], linear_part(axes), angular_part(axes))


def place(axes: Array) -> Array:
    """Points (..., 3) of axes (..., 6) that are nearest to the origin."""
    return cross(angular_part(axes), linear_part(axes))


def sine(w: Array, u: Array) -> float:
    """Sine of the angle between unit directions."""
    return norm(cross(w, u))


def line_angle(w: Array, u: Array) -> float:
    """Angle between two lines whatever their directions, 0 to π/2 rad."""
    cosine = abs(float(w @ u))
    return math.atan2(sine(w, u), cosine)


def distance_to_line(gap: Array, w: Array) -> float:
    """Distance (m) of a point from a line along w, `gap` from a point of the line."""
    across = gap - w * (w @ gap)
    return norm(across)


def normal_length(w: Array, u: Array, gap: Array) -> float:
    """Length (m) of the common normal of lines along w and u that are not parallel, `gap` between
    them.
    """
    volume = abs(float(gap @ cross(w, u)))
    return volume / sine(w, u)


def nearest_point(screws: Array, start: Array, rcond: float) -> Array:
    """The point (3,) nearest to axes; where they leave it free, within `rcond`, nearest to a start."""
    w = screws[:, :3]
    along = w[:, :, None] * w[:, None]
    across = np.eye(3) - along
    right = applied(across, place(screws) - start)
    system = across.reshape(-1, 3)
    moved, *_ = np.linalg.lstsq(system, right.ravel(), rcond=rcond)
    return start + moved


def wrapped(x: Array, turns: Marks) -> Array:
    """Values of joints, those of joints that turn within half a turn."""
    within = np.arctan2(np.sin(x), np.cos(x))
    return np.where(turns, within, x)


def uncoupled_at_zero(chain: Chain) -> Chain:
    """The chain with every joint its own coordinate x, x = 0 where q = 0, and the joints' own limits;
    velocity limits are left out.
    """
    if chain.nontrivial_coupling is None and not chain.offset.any():
        return chain
    own = chain.replace(
        coupling=None,
        q_names=None,
        limits=own_limits(chain),
        offset=None,
        velocity_limits=None,
        joint_limits=None,
        joint_velocity_limits=None,
    )
    return own.rezeroed(chain.offset)
