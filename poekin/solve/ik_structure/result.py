"""Result of `ik_structure`: family, assumptions with their sizes, and what would change it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar, Literal

from ...errors import quote
from ...model.chain import Chain
from ...results import Result

IKKind = Literal[
    "spherical wrist",
    "spherical shoulder",
    "spherical joint",
    "three parallel axes",
    "two axes intersect",
    "two parallel axes",
    "general",
    "redundant",
    "singular everywhere",
    "fewer than six joints",
    "coupled joints",
]

IKMethod = Literal["closed form", "elimination", "search", "lock"]

_WAYS: dict[IKMethod, str] = {
    "closed form": "closed form",
    "elimination": "elimination: all real roots of a polynomial of degree 16",
    "search": "search from random starts",
}


@dataclass(frozen=True)
class Assumption(Result):
    """Relation of axes that a closed form needs, and by how much an arm misses it.

    Attributes
    ----------
    joints : tuple of int
        Numbers of the joints, from 1.
    relation : str
        "meet in a point" or "are parallel".
    angle : float
        Largest angle between two of axes that shall be parallel, rad; else 0.
    distance : float
        Largest distance of an axis from the point nearest to axes that shall meet, m; else 0.
    """

    joints: tuple[int, ...]
    relation: Literal["meet in a point", "are parallel"]
    angle: float
    distance: float

    @property
    def size(self) -> str:
        """The angle in degrees, or the distance in mm."""
        if self.relation == "are parallel":
            return degrees(self.angle)
        return mm(self.distance)

    def summary(self) -> str:
        """Line such as "axes 2, 3 and 4 are parallel within 0.397°".

        Returns
        -------
        text : str
            Axes, relation, and by how much they miss it.
        """
        return f"{axes_of(self.joints)} {self.relation} within {self.size}"


@dataclass(frozen=True)
class LockedStructure(Result):
    """Structure of an arm of seven joints with one of them locked.

    Attributes
    ----------
    joint : str
        Name of the locked joint.
    kind : str
        Kind of the arm of the six others, as `IKStructure.kind`.
    joints : tuple of int
        Numbers of the joints whose axes make the kind, from 1, in the whole arm.
    reversed : bool
        Whether the arm is solved from its tip.
    exact : bool
        Whether nothing but rounding is neglected.
    first_joints : str
        Case of the other three joints, as `IKStructure.first_joints`.
    """

    joint: str
    kind: IKKind
    joints: tuple[int, ...]
    reversed: bool
    exact: bool
    first_joints: str

    def summary(self) -> str:
        """Line such as "panda_joint7 locked: spherical shoulder (axes 1, 2 and 3), reversed".

        Returns
        -------
        text : str
            Joint, kind and axes.
        """
        parts = [f"{quote(self.joint)} locked: {self.kind}"]
        if self.joints:
            parts[0] += f" ({axes_of(self.joints)})"
        if self.reversed:
            parts.append("solved reversed")
        if not self.exact:
            parts.append("nearly")
        return ", ".join(parts)


@dataclass(frozen=True)
class IKStructure(Result):
    """Structure of an arm's inverse kinematics; the result of `ik_structure`.

    Attributes
    ----------
    kind : str
        Family: "spherical wrist", "spherical shoulder", "spherical joint" (in the middle),
        "three parallel axes", "two axes intersect", "two parallel axes", "general", "redundant"
        (seven coordinates and more), "fewer than six joints" (which fictitious ones make a
        spherical wrist or shoulder), "singular everywhere", or "coupled joints" (fewer coordinates
        than joints).
    method : str
        Way that `ik_all` takes: "closed form", "elimination" or "search" (from random starts), or
        "lock" (joints, of redundant arms).
    joints : tuple of int
        Numbers of the joints whose axes make the kind, from 1.
    reversed : bool
        Whether the arm is solved from its tip to its base.
    exact : bool
        Whether the axes have these relations to rounding.
    first_joints : str
        Case of the other three joints of an arm with three axes that meet: "axes 1 and 2
        intersect", "axes 2 and 3 are parallel", "general: a quartic", or "prismatic"; empty for
        other kinds.
    prismatic : tuple of str
        Names of the prismatic joints.
    fictitious : int
        Number of joints held at zero that make an arm of fewer than six joints one of six.
    assumptions : tuple of Assumption
        Relations that the closed form takes for exact, with their sizes.
    nearest : Chain or None
        Nearest arm that has them exactly, by `nearest_arm`; None where the arm itself has.
    position_bound, rotation_bound : float
        Bounds of its pose difference over all coordinates, m and rad; 0 where `nearest` is None.
    locked : tuple of LockedStructure
        Structure with each joint locked, of an arm of seven joints.
    hint : str
        Change of geometry that would make a closed form, or what to lock; empty where there is
        none to name.
    """

    left_out: ClassVar[tuple[str, ...]] = ("nearest",)

    kind: IKKind
    method: IKMethod = "search"
    joints: tuple[int, ...] = ()
    reversed: bool = False
    exact: bool = True
    first_joints: str = ""
    prismatic: tuple[str, ...] = ()
    fictitious: int = 0
    assumptions: tuple[Assumption, ...] = ()
    nearest: Chain | None = None
    position_bound: float = 0.0
    rotation_bound: float = 0.0
    locked: tuple[LockedStructure, ...] = ()
    hint: str = ""

    def summary(self) -> str:
        """Sentences for people, in mm and degrees.

        Returns
        -------
        text : str
            Kind and axes, method, assumptions with the distance of the nearest arm, and the hint,
            one a line.
        """
        head = self.kind
        if self.joints:
            head += f": {axes_of(self.joints)}"
        if self.reversed:
            head += ", solved reversed (from the tip to the base)"
        lines = [head]
        if self.first_joints:
            lines.append(f"other joints: {self.first_joints}")
        if self.method in _WAYS:
            lines.append(_WAYS[self.method])
        lines += [assumption.summary() for assumption in self.assumptions]
        if self.nearest is not None:
            away = f"{mm(self.position_bound)} and {degrees(self.rotation_bound)}"
            lines.append(f"the nearest such arm is at most {away} away")
        if self.fictitious:
            lines.append(
                f"overdetermined: solved as an arm of six joints, {self.fictitious} of them "
                "fictitious and held at zero"
            )
        if self.prismatic:
            lines.append(f"prismatic: {', '.join(map(quote, self.prismatic))}")
        lines += [locked.summary() for locked in self.locked]
        if self.hint:
            lines.append(self.hint)
        return "\n".join(lines)


def axes_of(joints: tuple[int, ...]) -> str:
    """Numbers of axes as words: "axes 2, 3 and 4"."""
    if len(joints) == 1:
        return f"axis {joints[0]}"
    return f"axes {', '.join(map(str, joints[:-1]))} and {joints[-1]}"


def mm(length: float) -> str:
    """A length in m, in mm with three digits."""
    return f"{1e3 * length:.3g} mm"


def degrees(angle: float) -> str:
    """An angle in rad, in degrees with three digits."""
    return f"{math.degrees(angle):.3g}°"
