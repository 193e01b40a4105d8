"""axes: how the axes of an arm lie to each other, and what that makes of the arm."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations
from typing import ClassVar, get_args

from ..checks import choice, positive
from ..model.chain import Chain
from ..model.kinematics.arm import Arm, chain_of
from ..results import Result
from .amounts import amount
from .axis_lines import (
    POSITION,
    ROTATION,
    Tolerances,
    direction,
    distance_to_line,
    line_angle,
    normal_length,
    place,
    prismatic,
    uncoupled_at_zero,
)
from .shapes import Shape, ShapeKind, shapes


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
        rows = (*self.pairs, *self.shapes)
        return "\n".join(row.summary() for row in rows)


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
    tol_rotation : float, default π/180000
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
    tol = Tolerances(
        positive(tol_position, "tol_position"),
        positive(tol_rotation, "tol_rotation"),
    )
    rest = uncoupled_at_zero(chain)
    pairs = tuple(axis_pairs(rest, tol))
    coaxial = [pair.parallel and pair.intersecting for pair in pairs if pair.fixed]
    return AxesReport(pairs, shapes(rest, coaxial, tol), *tol)


def axis_pairs(rest: Chain, tol: Tolerances) -> Iterator[AxisPair]:
    """Relations of neighbouring and every third axes of a chain at rest."""
    slides = prismatic(rest)
    ways = direction(rest.screws, slides)
    places = place(rest.screws)
    names = rest.joint_names
    for i, j in combinations(range(len(names)), 2):
        if j > i + 2:
            continue
        w = ways[i]
        u = ways[j]
        angle = line_angle(w, u)
        parallel = angle <= tol.rotation
        gap = places[j] - places[i]
        distance = None
        if not slides[[i, j]].any():
            distance = distance_to_line(gap, w) if parallel else normal_length(w, u, gap)
        yield AxisPair(
            first=i + 1,
            second=j + 1,
            name_first=names[i],
            name_second=names[j],
            angle=angle,
            distance=distance,
            parallel=parallel,
            perpendicular=math.pi / 2 - angle <= tol.rotation,
            intersecting=distance is not None and distance <= tol.position,
            fixed=j == i + 1,
        )
