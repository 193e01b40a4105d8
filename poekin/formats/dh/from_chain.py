"""DH tables of chains, with the free choices made on the way."""

from __future__ import annotations

import math
from dataclasses import dataclass
from decimal import Decimal
from typing import Any

import numpy as np

from ...algebra import add, cross, dot, scale, subtract
from ...checks import REQUIRED, whole
from ...errors import InputError, quote
from ...groups import se3
from ...groups.arrays import ROUNDOFF, Array
from ...groups.vectors import norm, translation_part
from ...model.chain import Chain
from ...model.geometry.normals import (
    Normal,
    Vector,
    across,
    axis_near,
    common_normal,
    digits,
    exact,
    length,
    parallel_normal,
    unit,
)
from ...model.kinematics.arm import Arm, chain_of
from ...model.readings.coupled import own_coupling, own_limits
from ...model.readings.statements import make_statements
from ...results import Result, plain
from .table import Convention, Row, Table, check_convention
from .to_chain import to_chain

FAR = 10
"""Parameters beyond this many times the reach are worth a warning."""


@dataclass(frozen=True)
class FromChain(Result):
    """Denavit-Hartenberg table of a chain, and what its making decided.

    Attributes
    ----------
    table : Table
        The table, rad and m.
    gauge : tuple of str
        What was free and how it was chosen, a line a choice.
    error : float
        Largest pose error of the table against the chain over random configurations: rotations
        absolute, lengths as multiples of the reach.
    bound : float
        Bound of the error.
    warnings : tuple of str
        Where the parameters are ill-conditioned, with numbers.
    reach : float
        Reach of the chain, m.
    """

    left_out = ("table",)
    table: Table
    gauge: tuple[str, ...]
    error: float
    bound: float
    warnings: tuple[str, ...]
    reach: float

    def to_dict(self) -> dict[str, object]:
        """Table joint by joint with convention, base and tool, and the other fields.

        Returns
        -------
        document : dict
            Lists, strings and numbers, rad and m; a limit that is not finite is None.
        """
        table = self.table
        document = {"convention": table.convention, "joints": plain(table.rows)}
        document |= {"base_pose": table.base.tolist(), "tool_pose": table.tool.tolist()}
        document["coupling"] = list(table.coupling)
        return document | super().to_dict()

    def summary(self) -> str:
        """Free choices, warnings and the error of the table, a line each.

        Returns
        -------
        text : str
            Lines without a line break at the end.
        """
        lines = [f"Free choice: {words}" for words in self.gauge]
        lines += [f"Warning: {words}" for words in self.warnings]
        error = f"{self.error:.2g} over random configurations; at most {self.bound:.2g}"
        return "\n".join([*lines, f"Pose error ÷ reach ({self.reach:.3g} m): {error}"])


def from_chain(
    chain: Arm,
    *,
    convention: Convention = REQUIRED,
    samples: int = 100,
    seed: int = 0,
) -> FromChain:
    """Denavit-Hartenberg table of a chain of revolute and prismatic joints, in either convention.

    The table's variables are the joints' own, x = C q + c of a coupled chain; coupled readings of
    the joints' names are kept as the table's coupling. Base and tool carry what the rows cannot.

    Parameters
    ----------
    chain : Chain or CompiledChain
        Chain without helical joints.
    convention : {"standard", "modified"}
        Paul's (distal) or Craig's (proximal) convention, as in `Table`; required.
    samples : int, default 100
        Number of random configurations at which the error is measured.
    seed : int, default 0
        Seed of these configurations.

    Returns
    -------
    result : FromChain
        Table, choices, error and its bound, and warnings.

    Raises
    ------
    InputError
        If a joint is helical, which DH parameters cannot express; if the convention is missing or
        unknown; if `chain` is no Chain.

    Notes
    -----
    Parallel axes: the common normal is taken at the previous frame's origin (d = 0). Meeting axes:
    x is along z_i x z_{i+1}. A prismatic axis, which has no place, goes through the previous
    origin. The first frame stands where axis 1 is nearest to the base's origin, the last where axis
    n is nearest to the tool's. Axes so nearly parallel that the table's rounding would cost more
    than their angle are taken as parallel, with a warning in the result.

    Accuracy: `bound`: 20 u (n + 1) (reach + max(|d|, |a|)) over the reach, u = 2^-53, plus
    2 delta max(1, l / reach) for each angle delta that was dropped, l the sum of the table's
    lengths, as the table may have the axis far from the tool (tests/formats/test_dh.py). Source:
    Park 1994, Section II; the geometry is that of the axes.

    Examples
    --------
    >>> import poekin as pk
    >>> arm = pk.load("ur5e").chain()
    >>> result = pk.dh.from_chain(arm, convention="modified")
    >>> result.table.a.round(4).tolist()
    [0.0, 0.0, 0.425, 0.3922, 0.0, 0.0]
    >>> result.error < result.bound
    True
    """
    chain = chain_of(chain)
    check_convention(convention)
    whole(samples, "samples", 0)
    whole(seed, "seed", 0)
    for name, kind in zip(chain.joint_names, chain.kinds, strict=True):
        if kind == "helical":
            raise InputError(
                f"joint {quote(name)} is helical: Denavit-Hartenberg parameters cannot express its pitch"
            )
    with digits():
        walk = _Walk(chain)
        table = walk.table(convention)
    lengths = [0.0, *np.abs(table.d).tolist(), *np.abs(table.a).tolist()]
    longest = max(lengths) / chain.reach
    bound = 20 * ROUNDOFF * (len(table) + 1) * (1 + longest)
    if walk.dropped:
        # A joint that turns about an axis off by delta turns what is behind it by at most 2 delta
        # more or less, and moves the tool by that times its distance: the lengths behind, and the
        # metre that each slide is measured over.
        away = sum(lengths) + norm(translation_part(table.tool)) + chain.kinds.count("prismatic")
        bound += 2 * sum(walk.dropped) * max(1.0, away / chain.reach)
    error = _error(chain, table, samples, seed)
    readings = own_coupling(chain)
    if readings is not None and chain.offset.any():
        walk.warnings.append(
            "the coupling of readings is left out: with offsets c, x = K r + c, a table cannot say it"
        )
    return FromChain(
        _with_coupling(table, chain),
        tuple(walk.gauge),
        error,
        bound,
        tuple(walk.warnings),
        float(chain.reach),
    )


class _Walk:
    """Walk from axis to axis that finds the rows' numbers and the frames of base and tool."""

    def __init__(self, chain: Chain) -> None:
        self.chain = chain
        self.gauge: list[str] = []
        self.warnings: list[str] = []
        self.dropped: list[float] = []
        self.turns: list[tuple[float, float]] = []  # theta, d of joint i
        self.normals: list[tuple[float, float]] = []  # a, alpha between joints i and i + 1
        self.reach = Decimal(chain.reach)
        n = len(chain.screws)
        if not n:
            return
        z, o = self._axis(0, _ORIGIN)
        aside = _X if abs(z[0]) < Decimal("0.9") else _Y
        x = unit(across(aside, z))
        self.base = (x, z, o)
        self.gauge.append(
            f"zero of {self._name(0)} and place along its axis: nearest to the base frame"
        )
        for i in range(n - 1):
            near = self._near(o, z)
            if chain.kinds[i + 1] == "prismatic":
                self.gauge.append(
                    f"axis of {self._name(i + 1)} has no place: put through the origin before it"
                )
            z2, p2 = self._axis(i + 1, near)
            normal, z2 = self._normal(i, near, z, p2, z2, x)
            self.turns.append(_turn(x, normal.x, z, subtract(normal.foot, o)))
            alpha = math.atan2(float(normal.sine), float(normal.cosine))
            self.normals.append((float(normal.a), alpha))
            x = normal.x
            z = z2
            o = add(normal.foot, scale(normal.a, normal.x))
        along = dot(subtract(exact(translation_part(chain.home)), o), z)
        self.turns.append((0.0, float(along)))
        self.gauge.append(
            f"last frame: on the axis of {self._name(n - 1)}, nearest to the tool, theta = 0"
        )
        self.last = (x, z, add(o, scale(Decimal(float(along)), z)))

    def _near(self, o: Vector, z: Vector) -> Vector:
        """Origin, or the axis' point nearest to the base where the origin is far from the arm."""
        if length(o) <= self.reach * FAR:
            return o
        return subtract(o, scale(dot(o, z), z))

    def _axis(self, i: int, origin: Vector) -> tuple[Vector, Vector]:
        """Direction and a point of axis i, nearest to `origin`; a prismatic one passes through it."""
        slides = self.chain.kinds[i] == "prismatic"
        return axis_near(self.chain.screws[i], slides, origin)

    def _normal(
        self,
        i: int,
        o: Vector,
        z: Vector,
        p2: Vector,
        z2: Vector,
        x: Vector,
    ) -> tuple[Normal, Vector]:
        """Common normal of axes i and i + 1, and the direction of axis i + 1 in the table."""
        angle = length(cross(z, z2))
        nothing = self.reach * Decimal("1e-16")
        names = f"{self._name(i)} and {self._name(i + 1)}"
        if angle == 0:
            self.gauge.append(
                f"axes of {names} are parallel: their normal is taken at the origin before it"
            )
            return parallel_normal(o, z, p2, z2, x, nothing), z2
        normal = common_normal(o, z, p2, z2)
        foot = normal.foot
        away = max(length(subtract(foot, o)), length(subtract(p2, foot)))
        if 2 * angle * self.reach <= Decimal(ROUNDOFF) * away:
            self.dropped.append(float(angle))
            self.warnings.append(
                f"axes of {names} are taken as parallel: the angle of {float(angle):.3g} rad between them would put "
                f"d at {float(away):.3g} m; a product of exponentials keeps it"
            )
            flat = scale(Decimal(-1), z)
            if dot(z, z2) > 0:
                flat = z
            return parallel_normal(o, z, p2, z2, x, nothing), flat
        if away > self.reach * FAR:
            self.warnings.append(
                f"axes of {names} are nearly parallel, {float(angle):.3g} rad: d is {float(away):.3g} m on an arm of "
                f"{self.chain.reach:.3g} m, and its rounding {ROUNDOFF * float(away):.1g} m; a product of exponentials "
                "has no such number"
            )
        if normal.a <= nothing:
            self.gauge.append(f"axes of {names} meet: x is along z x z'")
        return normal, z2

    def _name(self, i: int) -> str:
        return quote(self.chain.joint_names[i])

    def table(self, convention: Convention) -> Table:
        """The rows of the convention, base and tool."""
        chain = self.chain
        if not self.turns:
            return Table(convention, [], tool=chain.home, name=chain.tip)
        links = [(0.0, 0.0), *self.normals]
        if convention == "standard":
            links.append(links.pop(0))
        limits = [(low, high) for low, high in own_limits(chain).tolist()]
        kinds: Any = chain.kinds
        rows = [
            Row(
                theta,
                d,
                a,
                alpha,
                kinds[i],
                False,
                chain.joint_names[i],
                limits[i],
            )
            for i, ((theta, d), (a, alpha)) in enumerate(zip(self.turns, links, strict=True))
        ]
        return Table(
            convention,
            rows,
            base=_pose(*self.base),
            tool=self._tool(),
            name=chain.tip,
        )

    def _tool(self) -> Array:
        """F^-1 M with the last frame F."""
        x, z, o = self.last
        *columns, p = map(exact, self.chain.home[:3].T)
        T = np.eye(4)
        axes = (x, cross(z, x), z)
        columns.append(subtract(p, o))
        for row, axis in enumerate(axes):
            for column, values in enumerate(columns):
                T[row, column] = float(dot(axis, values))
        return T


_ORIGIN = exact(np.zeros(3))
_X = exact(np.eye(3)[0])
_Y = exact(np.eye(3)[1])


def _turn(
    x: Vector,
    x2: Vector,
    z: Vector,
    along: Vector,
) -> tuple[float, float]:
    """Angle from x to x2 about z, and how far along z."""
    sine = dot(cross(x, x2), z)
    cosine = dot(x, x2)
    angle = math.atan2(float(sine), float(cosine))
    return angle, float(dot(along, z))


def _pose(x: Vector, z: Vector, o: Vector) -> Array:
    vectors = (x, cross(z, x), z, o)
    columns = [[float(value) for value in vector] for vector in vectors]
    return se3.pose(np.transpose(columns[:3]), columns[3])


def _with_coupling(table: Table, chain: Chain) -> Table:
    """The table with the coupling of the chain's readings, where these have the joints' names."""
    readings = own_coupling(chain)
    if readings is None or chain.offset.any():
        return table
    return Table(
        table.convention,
        table.rows,
        base=table.base,
        tool=table.tool,
        name=table.name,
        coupling=make_statements(readings, table.names),
    )


def _error(
    chain: Chain,
    table: Table,
    samples: int,
    seed: int,
) -> float:
    """Largest pose error over a turn of each revolute joint and 1 m of each prismatic one."""
    joints = Chain.from_space(chain.screws, chain.home, joint_names=chain.joint_names)
    x = joints.random(seed, samples)
    difference = to_chain(table).fk(x) - joints.fk(x)
    difference[:, :3, 3] /= chain.reach
    return float(np.abs(difference).max(initial=0.0))
