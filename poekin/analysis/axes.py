"""axes: how the axes of an arm lie to each other, and what that makes of the arm."""

from __future__ import annotations

import json
import math
from dataclasses import asdict, dataclass

import numpy as np

from ..errors import InputError, safe_repr
from ..groups.arrays import Array
from ..model.chain import Chain
from .compare.alignment.lines import cross, direction, uncoupled_at_zero
from .shapes import Shape, shapes
from .tolerances import check_tolerances

__all__ = ["AxesReport", "AxisPair", "axes"]


@dataclass(frozen=True)
class AxisPair:
    """Two axes, one or two joints apart, at q = 0.

    Attributes: first, second (joint numbers from 1), name_first, name_second; angle, 0 to 90 deg,
    between the lines whatever their directions; distance, the common normal's length in mm (None
    with a prismatic joint, which has no place); parallel, perpendicular, intersecting within
    tolerance (parallel at distance 0 is one line: coaxial).
    fixed: whether no joint between them changes it, that is, the axes are of neighbouring joints.
    """

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
    def words(self) -> str:
        """The relation in words, with what it misses: "perpendicular, 82.5 mm from intersecting"."""
        if self.parallel:
            lie = "parallel"
        elif self.perpendicular:
            lie = "perpendicular"
        else:
            lie = f"{90 - self.angle:.4g}° from perpendicular"
            if self.angle < 45:
                lie = f"{self.angle:.4g}° from parallel"
        if self.distance is None:
            return lie
        if self.parallel and self.intersecting:
            return "coaxial"
        if self.intersecting:
            return f"{lie}, intersecting"
        end = "from intersecting"
        if self.parallel:
            end = "apart"
        return f"{lie}, {self.distance:.4g} mm {end}"


@dataclass(frozen=True)
class AxesReport:
    """Geometry of an arm's axes: pairs of neighbours and of every third, and the shapes that they
    make.

    Attributes: pairs, shapes (see `Shape`), tol_mm, tol_deg.
    """

    pairs: tuple[AxisPair, ...]
    shapes: tuple[Shape, ...]
    tol_mm: float
    tol_deg: float

    def has(self, kind: str) -> bool:
        """Whether a shape of that kind was found.

        Parameters: kind, "spherical wrist", "spherical shoulder", "three parallel axes", "Pieper"
        or "S-R-S". Raises: nothing; of another kind there is none.
        """
        return any(shape.kind == kind for shape in self.shapes)

    def as_dict(self) -> dict[str, object]:
        """Everything as plain dicts, lists, strings and numbers."""
        return {
            "pairs": [asdict(pair) | {"words": pair.words} for pair in self.pairs],
            "shapes": [asdict(shape) | {"joints": list(shape.joints)} for shape in self.shapes],
            "tol_mm": self.tol_mm,
            "tol_deg": self.tol_deg,
        }

    def to_json(self) -> str:
        """`as_dict` as JSON text."""
        return json.dumps(self.as_dict(), indent=2, allow_nan=False)

    def __str__(self) -> str:
        lines = [f"{p.name_first} - {p.name_second}: {p.words}" for p in self.pairs]
        return "\n".join([*lines, *(shape.words for shape in self.shapes)])


def axes(chain: Chain, *, tol_mm: float = 0.01, tol_deg: float = 0.001) -> AxesReport:
    """Every pair of consecutive and every third axes of a chain at q = 0, and the shapes that they
    make.

    Consecutive axes keep their angle and distance whatever q is; every third pair is as it stands
    at q = 0. A shape is said to be there only where it holds at every q, by axes that no joint
    moves against each other.

    Parameters: chain; tol_mm, tol_deg, how far off parallel, perpendicular or intersecting still is
    it.
    Returns: AxesReport. Raises: InputError. Accuracy: an angle or distance built into two screws
    comes
    back to 1e-9 of itself, from 0.01 deg and 0.1 mm up (tests/analysis/test_axes.py).
    Source: Pieper 1968 for what solves in closed form.
    """
    if not isinstance(chain, Chain):
        raise InputError(
            f"expected a Chain, as Robot.chain(tip=...) makes it, got {safe_repr(chain)}"
        )
    check_tolerances(tol_mm, tol_deg)
    rest = uncoupled_at_zero(chain)
    ways = direction(rest.screws, rest.kinds)
    places = [
        None if k == "prismatic" else cross(S[:3], S[3:])
        for S, k in zip(rest.screws, rest.kinds, strict=True)
    ]
    n = len(rest.kinds)
    pairs = []
    for i, j in [(i, i + step) for i in range(n) for step in (1, 2) if i + step < n]:
        angle, distance = _between(ways[i], places[i], ways[j], places[j], tol_deg)
        pair = AxisPair(
            first=i + 1,
            second=j + 1,
            name_first=rest.joint_names[i],
            name_second=rest.joint_names[j],
            angle=angle,
            distance=distance,
            parallel=angle <= tol_deg,
            perpendicular=90 - angle <= tol_deg,
            intersecting=distance is not None and distance <= tol_mm,
            fixed=j == i + 1,
        )
        pairs.append(pair)
    return AxesReport(
        tuple(pairs), shapes(rest, float(tol_mm), float(tol_deg)), float(tol_mm), float(tol_deg)
    )


def _between(
    w: Array, p: Array | None, u: Array, r: Array | None, tol_deg: float
) -> tuple[float, float | None]:
    """Angle (0 to 90 deg) and common normal (mm) of two lines; of parallel ones their distance."""
    across = cross(w, u)
    sine = float(np.linalg.norm(across))
    angle = math.degrees(math.atan2(sine, abs(float(w @ u))))
    if p is None or r is None:
        return angle, None
    gap = r - p
    if angle <= tol_deg:
        return angle, 1e3 * float(np.linalg.norm(gap - w * (w @ gap)))
    return angle, 1e3 * abs(float(gap @ across)) / sine
