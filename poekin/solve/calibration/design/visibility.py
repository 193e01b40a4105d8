"""Places where measuring is possible: a box that the tool is in, a cone that a camera or tracker sees.

Each is a function of configurations q (N, m) and poses T (N, 4, 4), and so is any that a user writes.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal, get_args

import numpy as np

from ....checks import choice, is_real
from ....errors import InputError, safe_repr
from ....groups import se3
from ....groups.arrays import Array, numbers
from ....groups.vectors import normalised, norms, rotation_part
from ..measurements.points import point_at, position

Stand = Literal["base", "tip"]


@dataclass(frozen=True, eq=False)
class WorkspaceBox:
    """Configurations with a point of the tool in a box along the axes of the base frame.

    Parameters
    ----------
    lower, upper : (3,) array_like
        Corners of the box in the base frame, m.
    point : (3,) array_like, default (0, 0, 0)
        The point of the tool in the tip frame, m.

    Raises
    ------
    ShapeError
        If a corner or the point is not three numbers.
    InputError
        If a number is not finite, or lower is above upper.

    Examples
    --------
    >>> import poekin as pk
    >>> arm = pk.load("ur5").chain()
    >>> box = pk.calibration.WorkspaceBox([-1, -1, 0.1], [1, 1, 0.6])
    >>> choice = pk.choose_poses(arm, 10, 100, allowed=box, n_random=5)
    >>> z = arm.fk(choice.q)[:, 2, 3]
    >>> bool((z >= 0.1).all() and (z <= 0.6).all())
    True
    """

    lower: Any
    upper: Any
    point: Any = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        for name in ("lower", "upper", "point"):
            given = numbers(getattr(self, name), name)
            object.__setattr__(self, name, position(given, name))
        for axis in np.flatnonzero(self.lower > self.upper):
            raise InputError(
                f"upper[{axis}]: expected at least lower[{axis}] = {self.lower[axis]:g}, got "
                f"{self.upper[axis]:g}"
            )

    def __call__(self, q: Array, T: Array) -> np.ndarray:
        """Whether the point is in the box, (N,) of bool, at poses T (N, 4, 4) of the tip."""
        p = point_at(T, self.point)
        inside = (p >= self.lower) & (p <= self.upper)
        return np.asarray(inside.all(axis=1))


@dataclass(frozen=True, eq=False)
class ViewCone:
    """Configurations at which a camera or tracker sees a target: in its cone, and facing it.

    Parameters
    ----------
    apex, axis : (3,) array_like
        Where the camera is, m, and the direction in which it looks.
    half_angle : float
        Angle between the axis and the side of its cone, rad; a tracker that turns has π.
    target : (3,) array_like, default (0, 0, 0)
        The point that has to be seen, m: of the tip, or of the base where the camera is on the tip.
    on : {"base", "tip"}, default "base"
        Frame in which apex and axis are, and in which the camera stands still.
    near, far : float, default 0 and inf
        Distances between which it sees, m.
    normal : (3,) array_like, optional
        Direction in which the target faces, in its frame: a board's, or a reflector's axis.
    acceptance : float, default π/3
        Angle between the normal and the line of sight up to which the target is seen, rad.

    Raises
    ------
    ShapeError
        If a point or direction is not three numbers.
    InputError
        If a number is not finite, a direction is zero, or an angle or a distance is out of its
        range.

    Examples
    --------
    A tracker at 2 m before the arm, and a reflector that it sees within 30° of the tool's z axis:

    >>> import poekin as pk
    >>> arm = pk.load("ur5").chain()
    >>> seen = pk.calibration.ViewCone(
    ...     [2, 0, 0.5], [-1, 0, 0], half_angle=3.14, normal=[0, 0, 1], acceptance=0.52
    ... )
    >>> pk.choose_poses(arm, 12, 100, measurements="points", allowed=seen, n_random=5).q.shape
    (12, 6)
    """

    apex: Any
    axis: Any
    half_angle: float
    target: Any = (0.0, 0.0, 0.0)
    on: Stand = "base"
    near: float = 0.0
    far: float = np.inf
    normal: Any = None
    acceptance: float = np.pi / 3

    def __post_init__(self) -> None:
        for name in ("apex", "target"):
            given = numbers(getattr(self, name), name)
            object.__setattr__(self, name, position(given, name))
        object.__setattr__(self, "axis", _direction(self.axis, "axis"))
        if self.normal is not None:
            object.__setattr__(self, "normal", _direction(self.normal, "normal"))
        choice(self.on, get_args(Stand), "on")
        for name in ("half_angle", "acceptance"):
            _between(getattr(self, name), name, 0.0, np.pi)
        _between(self.near, "near", 0.0, np.inf)
        _between(self.far, "far", self.near, np.inf)

    def __call__(self, q: Array, T: Array) -> np.ndarray:
        """Whether the target is seen, (N,) of bool, at poses T (N, 4, 4) of the tip."""
        if self.on == "tip":
            T = se3.inverse(T)
        sight = point_at(T, self.target) - self.apex
        distance = norms(sight)
        seen = sight @ self.axis >= np.cos(self.half_angle) * distance
        seen &= (distance >= self.near) & (distance <= self.far)
        if self.normal is not None:
            normals = rotation_part(T) @ self.normal
            faced = -np.sum(normals * sight, axis=1)
            seen &= faced >= np.cos(self.acceptance) * distance
        return np.asarray(seen)


def _direction(value: Any, name: str) -> Array:
    """A unit vector (3,)."""
    vector = numbers(value, name)
    position(vector, name)
    if not vector.any():
        raise InputError(f"{name}: expected a direction, got {safe_repr(value)}")
    return normalised(vector)


def _between(
    value: Any,
    name: str,
    least: float,
    most: float,
) -> None:
    if not is_real(value) or not least <= value <= most:
        raise InputError(
            f"{name}: expected a number from {least:g} to {most:g}, got {safe_repr(value)}"
        )
