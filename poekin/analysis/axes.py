"""axes: how the axes of an arm lie to each other, and what that makes of the arm."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar, get_args

import numpy as np

from ..checks import choice, positive
from ..groups.arrays import Array
from ..model.chain import Chain
from ..model.kinematics.arm import Arm, chain_of
from ..results import Result
from .amounts import amount
from .axis_lines import POSITION, ROTATION, cross, direction, uncoupled_at_zero
from .shapes import Shape, ShapeKind, line_angle, shapes

__all__ = ["AxesReport", "AxisPair", "axes"]


@dataclass(frozen=True)
class AxisPair(Result):
    """Two axes of an arm, one or two joints apart, at q = 0.

    Attributes
    ----------
    first, second : int
        Numbers of the joints, from 1.
    name_first, name_second : str
        Names of the joints.
    angle : float
        Angle between the lines whatever their directions, 0 to π/2 rad.
    distance : float or None
        Length of the common normal, m; None with a prismatic joint, whose axis has no place.
    parallel, perpendicular, intersecting : bool
        Relation within the tolerances; parallel and intersecting axes are coaxial.
    fixed : bool
        Whether it holds at every q, that is, whether the axes are of neighbouring joints.
    """

    derived: ClassVar = ("relation",)

    first: int
    second: int
    name_first: str
    name_second: str
    angle: float
    distance: float | None
    parallel: bool
    perpendicular: bool
    intersecting: bool
    fixed: bool

    @property
    def relation(self) -> str:
        """Text such as "perpendicular, 82.5 mm from intersecting"."""
        if self.parallel:
            lie = "parallel"
        elif self.perpendicular:
            lie = "perpendicular"
        elif self.angle < math.pi / 4:
            lie = f"{amount(self.angle, 'rad')} from parallel"
        else:
            lie = f"{amount(math.pi / 2 - self.angle, 'rad')} from perpendicular"
        if self.distance is None:
            return lie
        if self.parallel and self.intersecting:
            return "coaxial"
        if self.intersecting:
            return f"{lie}, intersecting"
        end = "from intersecting"
        if self.parallel:
            end = "apart"
        return f"{lie}, {amount(self.distance, 'm')} {end}"

    def summary(self) -> str:
        """Names of both joints and their relation, in mm and degrees.

        Returns
        -------
        text : str
            Line such as "joint1 - joint2: parallel, 425 mm apart".
        """
        return f"{self.name_first} - {self.name_second}: {self.relation}"


@dataclass(frozen=True)
class AxesReport(Result):
    """Geometry of an arm's axes; the result of `axes`.

    Attributes
    ----------
    pairs : tuple of AxisPair
        Relations of neighbouring axes and of every third.
    shapes : tuple of Shape
        Shapes that axes make together, such as a spherical wrist.
    tol_position, tol_rotation : float
        Tolerances, m and rad.
    """

    pairs: tuple[AxisPair, ...]
    shapes: tuple[Shape, ...]
    tol_position: float
    tol_rotation: float

    def has(self, kind: ShapeKind) -> bool:
        """Whether a shape of a kind was found.

        Parameters
        ----------
        kind : str
            "spherical wrist", "spherical shoulder", "spherical joint", "three parallel axes",
            "Pieper" or "S-R-S".

        Returns
        -------
        found : bool
            Whether there is at least one.

        Raises
        ------
        InputError
            If there is no such kind.
        """
        choice(kind, get_args(ShapeKind), "kind")
        return any(shape.kind == kind for shape in self.shapes)

    def summary(self) -> str:
        """One line a pair and one a shape, in mm and degrees.

        Returns
        -------
        text : str
            Lines such as "joint1 - joint2: parallel, 425 mm apart".
        """
        return "\n".join(row.summary() for row in (*self.pairs, *self.shapes))


def axes(
    chain: Arm,
    *,
    tol_position: float = POSITION,
    tol_rotation: float = ROTATION,
) -> AxesReport:
    """Relations of neighbouring and every third axes at q = 0, and the shapes that they make.

    Neighbouring axes keep their angle and distance whatever q is; every third pair is as it stands
    at q = 0. A shape is reported only where it holds at every q.

    Parameters
    ----------
    chain : Chain or CompiledChain
        Arm to look at.
    tol_position : float, default 1e-5
        Distance up to which axes intersect, m.
    tol_rotation : float, default 1.75e-5
        Angle up to which they are parallel or perpendicular, rad (0.001 degrees).

    Returns
    -------
    report : AxesReport
        Pairs of axes and shapes.

    Raises
    ------
    InputError
        If `chain` is no Chain, or a tolerance no positive number.

    See Also
    --------
    compare : Comparison of two models of one arm.

    Notes
    -----
    Accuracy: an angle or distance built into two screws comes back to 1e-9 of itself, from 2e-4 rad
    and 0.1 mm up (tests/analysis/test_axes.py). Source: Pieper 1968 for the arms that have a
    closed form.

    Examples
    --------
    >>> import poekin as pk
    >>> report = pk.axes(pk.load("panda").chain(tip="panda_hand"))
    >>> report.has("spherical shoulder"), report.has("spherical wrist")
    (True, False)
    >>> print(report.pairs[6])
    panda_joint4 - panda_joint5: perpendicular, 82.5 mm from intersecting
    """
    chain = chain_of(chain)
    tol = (positive(tol_position, "tol_position"), positive(tol_rotation, "tol_rotation"))
    rest = uncoupled_at_zero(chain)
    numbers = range(1, len(rest.kinds) + 1)
    near = [(i, i + step) for i in numbers for step in (1, 2) if i + step in numbers]
    ways = direction(rest.screws, rest.kinds)
    places = cross(rest.screws[:, :3], rest.screws[:, 3:])
    pairs = tuple(_pair(rest, ways, places, i - 1, j - 1, *tol) for i, j in near)
    coaxial = [pair.parallel and pair.intersecting for pair in pairs if pair.fixed]
    return AxesReport(pairs, shapes(rest, coaxial, *tol), *tol)


def _pair(
    rest: Chain,
    ways: Array,
    places: Array,
    i: int,
    j: int,
    tol_position: float,
    tol_rotation: float,
) -> AxisPair:
    """Relation of the axes i < j of a chain at rest."""
    angle = line_angle(ways[i], ways[j])
    distance = None
    if "prismatic" not in (rest.kinds[i], rest.kinds[j]):
        distance = _distance(ways[i], ways[j], places[j] - places[i], angle <= tol_rotation)
    return AxisPair(
        first=i + 1,
        second=j + 1,
        name_first=rest.joint_names[i],
        name_second=rest.joint_names[j],
        angle=angle,
        distance=distance,
        parallel=angle <= tol_rotation,
        perpendicular=math.pi / 2 - angle <= tol_rotation,
        intersecting=distance is not None and distance <= tol_position,
        fixed=j == i + 1,
    )


def _distance(w: Array, u: Array, gap: Array, parallel: bool) -> float:
    """Length (m) of the common normal of lines along w and u, `gap` between them."""
    if parallel:
        return float(np.linalg.norm(gap - w * (w @ gap)))
    across = cross(w, u)
    return abs(float(gap @ across)) / float(np.linalg.norm(across))
