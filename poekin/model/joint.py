"""Joint: what connects two links of a robot, as data that is checked once."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import Any, Literal, get_args

import numpy as np

from ..by_value import ByValue
from ..errors import InputError, ModelError, quote, safe_repr
from . import screw
from .checks import LONGEST, one_pose, read_only

JointKind = Literal["revolute", "continuous", "prismatic", "helical", "fixed", "floating", "planar"]
KINDS: tuple[JointKind, ...] = get_args(JointKind)
MOVING: tuple[JointKind, ...] = ("revolute", "continuous", "prismatic", "helical")
FREE: tuple[JointKind, ...] = ("floating", "planar")

# A vector this close to unit length stays as it is, so that a joint made from a joint's own axis
# equals it: what `screw.prismatic` returns is this close.
UNIT = 2.0**-52


@dataclass(frozen=True, slots=True)
class Mimic:
    """A joint that follows another one: x = multiplier x_joint + offset.

    Parameters
    ----------
    joint : str
        Name of the joint to follow.
    multiplier : float, default 1.0
        Own unit per the other's.
    offset : float, default 0.0
        Value where the other's is 0, rad or m.

    Raises
    ------
    ModelError
        If a number is not finite, or the name is none.

    Examples
    --------
    >>> import poekin as pk
    >>> finger = pk.Joint("right", "prismatic", "hand", "finger", mimic=pk.Mimic("left"))
    >>> print(finger)
    Joint('right', prismatic, 'hand' -> 'finger', mimic='left')
    """

    joint: str
    multiplier: float = 1.0
    offset: float = 0.0

    def __post_init__(self) -> None:
        _name(self.joint, "mimic: joint")
        _set(self, "multiplier", _number(self.multiplier, "mimic: multiplier"))
        _set(self, "offset", _number(self.offset, "mimic: offset"))


@dataclass(frozen=True, slots=True)
class SafetyController:
    """Limits of a joint's controller in URDF; poekin keeps them and does not use them.

    Velocity is kept within -k_position (x - soft_lower_limit) and -k_position (x -
    soft_upper_limit), effort within -k_velocity (v - v_limit).

    Parameters
    ----------
    k_velocity : float, default 0.0
        Effort per velocity, N m s/rad or N s/m.
    k_position : float, default 0.0
        Velocity per position, 1/s.
    soft_lower_limit, soft_upper_limit : float, default 0.0
        Bounds of x at which the controller begins to slow the joint down, rad or m.

    Raises
    ------
    ModelError
        If a number is not finite.

    Notes
    -----
    Source: the URDF specification, element <safety_controller>, whose defaults these are.

    Examples
    --------
    >>> import poekin as pk
    >>> pk.SafetyController(k_velocity=40.0, k_position=100.0, soft_lower_limit=-2.9).k_position
    100.0
    """

    k_velocity: float = 0.0
    k_position: float = 0.0
    soft_lower_limit: float = 0.0
    soft_upper_limit: float = 0.0

    def __post_init__(self) -> None:
        for field in fields(self):
            what = f"safety_controller: {field.name}"
            _set(self, field.name, _number(getattr(self, field.name), what))


@dataclass(frozen=True, slots=True, eq=False)
class Joint(ByValue):
    """Joint of two links: T_pc(x) = origin e^{S x}, S the screw in the joint's own frame.

    T_pc is the pose of the child link in the parent link's frame.

    Parameters
    ----------
    name : str
        Name of the joint.
    kind : {"revolute", "continuous", "prismatic", "helical", "fixed", "floating", "planar"}
        Kind of the motion; "floating" and "planar" are kept in the tree, but no chain can cross
        them.
    parent, child : str
        Names of the two links.
    origin : (4, 4) array_like, optional
        Pose of the joint's frame in the parent's, m; the identity where it is left out.
    axis : (3,) array_like, default (1, 0, 0)
        Direction of the axis in the joint's frame; any length, kept as a unit vector.
    limits : (2,) array_like, optional
        Lower and upper bound of x, rad or m; infinite where there is none, and for a continuous
        joint.
    mimic : Mimic, optional
        Joint that it follows. A fixed joint stays where it is, whatever it is said to mimic.
    pitch : float, default 0.0
        Pitch of a helical joint, m per rad.
    velocity, effort : float, optional
        Greatest |dx/dt|, rad/s or m/s, and greatest torque or force, N m or N; infinite where it is
        not known.
    damping, friction : float, default 0.0
        Viscous damping, N m s/rad or N s/m, and Coulomb friction, N m or N; kept for other programs.
    safety_controller : SafetyController, optional
        Limits of the joint's controller; kept for other programs.

    Raises
    ------
    ModelError
        If a field cannot be used, with the joint and the field; lengths above 1e100 m are refused.
    ShapeError
        If the origin has another shape.
    PoseError
        If the origin is no pose.
    InputError
        If the origin holds anything but real numbers.

    Notes
    -----
    Frozen, and equal to a joint of the same numbers. Accuracy: the axis is a unit vector to 4e-16,
    the origin's rotation orthonormal to 4e-15 (the nearest rotation to what is given); all else is
    kept as given.

    Examples
    --------
    >>> import math
    >>> import poekin as pk
    >>> elbow = pk.Joint("elbow", "revolute", "upper", "lower", axis=(0, 0, 2), limits=(0, math.pi))
    >>> elbow.screw
    (0.0, 0.0, 1.0, 0.0, 0.0, 0.0)
    """

    name: str
    kind: JointKind
    parent: str
    child: str
    origin: Any = None
    axis: Any = (1.0, 0.0, 0.0)
    limits: Any = (-math.inf, math.inf)
    mimic: Mimic | None = None
    pitch: float = 0.0
    velocity: float = math.inf
    effort: float = math.inf
    damping: float = 0.0
    friction: float = 0.0
    safety_controller: SafetyController | None = None

    def __post_init__(self) -> None:
        _name(self.name, "a joint")
        try:
            self._check()
        except (InputError, ModelError) as fault:
            raise type(fault)(f"joint {quote(self.name)}: {fault}") from fault.__cause__

    def _check(self) -> None:
        if not isinstance(self.kind, str) or self.kind not in KINDS:
            raise ModelError(f"kind must be one of {', '.join(KINDS)}, got {safe_repr(self.kind)}")
        _name(self.parent, "parent")
        _name(self.child, "child")
        _set(self, "origin", _pose(self.origin))
        _set(self, "axis", _direction(self.axis))
        limits = (-math.inf, math.inf)
        if self.kind != "continuous":
            limits = _interval(self.limits)
        _set(self, "limits", limits)
        _set(self, "pitch", _number(self.pitch, "pitch"))
        if abs(self.pitch) > LONGEST:
            raise ModelError(f"pitch: expected at most {LONGEST:g} m per rad, got {self.pitch:g}")
        if self.pitch and self.kind != "helical":
            raise ModelError(f"only a helical joint has a pitch, and this one is {self.kind}")
        if self.mimic is not None and not isinstance(self.mimic, Mimic):
            raise ModelError(f"mimic must be a Mimic or None, got {safe_repr(self.mimic)}")
        if self.mimic is not None and self.kind in FREE:
            raise ModelError(
                f"a {self.kind} joint has no single value and cannot mimic another joint"
            )

        for field in ("velocity", "effort"):
            _set(self, field, _bound(getattr(self, field), field))
        for field in ("damping", "friction"):
            _set(self, field, _loss(getattr(self, field), field))
        controller = self.safety_controller
        if controller is not None and not isinstance(controller, SafetyController):
            raise ModelError(
                f"safety_controller must be a SafetyController or None, got {safe_repr(controller)}"
            )

    @property
    def screw(self) -> tuple[float, ...]:
        """Screw S = (ω; v) in the joint's own frame; zeros where it has no coordinate."""
        x, y, z = self.axis
        if self.kind in ("revolute", "continuous", "helical"):
            return (x, y, z, self.pitch * x, self.pitch * y, self.pitch * z)
        if self.kind == "prismatic":
            return (0.0, 0.0, 0.0, x, y, z)
        return (0.0,) * 6

    def __repr__(self) -> str:
        follows = f", mimic={quote(self.mimic.joint)}" if self.mimic else ""
        return f"Joint({quote(self.name)}, {self.kind}, {quote(self.parent)} -> {quote(self.child)}{follows})"


def _set(self: object, field: str, value: object) -> None:
    object.__setattr__(self, field, value)


def _name(value: object, what: str) -> None:
    if not isinstance(value, str) or not value:
        raise ModelError(
            f"{what}: a name must be a string that is not empty, got {safe_repr(value)}"
        )


def _finite(values: Any, count: int, what: str) -> tuple[float, ...]:
    fault = None
    try:
        numbers = tuple(map(float, values))
        if len(numbers) == count and all(map(math.isfinite, numbers)):
            return numbers
    except (TypeError, ValueError, OverflowError) as error:
        fault = error
    raise ModelError(
        f"{what}: expected {count} finite number(s), got {safe_repr(values)}"
    ) from fault


def _number(value: Any, what: str) -> float:
    (number,) = _finite((value,), 1, what)
    return number


def _bound(value: Any, what: str) -> float:
    """Bound of a rate or a force: positive, infinite where there is none."""
    fault = None
    try:
        bound = float(value)
        if bound > 0:
            return bound
    except (TypeError, ValueError, OverflowError) as error:
        fault = error
    raise ModelError(
        f"{what}: expected a positive number, infinite where it is not known, got {safe_repr(value)}"
    ) from fault


def _loss(value: Any, what: str) -> float:
    """Coefficient of damping or friction: finite, not negative."""
    loss = _number(value, what)
    if loss < 0:
        raise ModelError(f"{what}: expected no negative number, got {safe_repr(value)}")
    return loss + 0.0


def _direction(axis: Any) -> tuple[float, ...]:
    vector = _finite(axis, 3, "axis")
    if not any(vector):
        raise ModelError(f"axis must not be zero, got {safe_repr(vector)}")
    if abs(math.hypot(*vector) - 1.0) > UNIT:
        vector = screw.prismatic(vector)[3:].tolist()
    x, y, z = vector
    return x + 0.0, y + 0.0, z + 0.0


def _interval(limits: Any) -> tuple[float, float]:
    try:
        lower, upper = map(float, limits)
    except (TypeError, ValueError, OverflowError) as fault:
        raise ModelError(
            f"limits must be two numbers, lower and upper, got {safe_repr(limits)}"
        ) from fault
    if not lower <= upper or lower == math.inf or upper == -math.inf:
        raise ModelError(f"limits must be lower <= upper, got lower = {lower!r}, upper = {upper!r}")
    return lower, upper


def _pose(origin: Any) -> np.ndarray:
    return read_only(np.eye(4) if origin is None else one_pose(origin, "origin"))
