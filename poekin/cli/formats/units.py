"""--mm and --deg: units of the coordinates that a command line or a file gives and takes."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Annotated, NamedTuple

import numpy as np
from typer import Option

from ...formats.poses.read import said_units
from ...formats.text.csv_header import CONVERSIONS, COORDINATE, Columns
from ...groups.arrays import Array
from ...model.chain import Chain
from ...model.kinematics.degrees import TURN
from ...model.readings.coupled import joint_values

Mm = Annotated[
    bool | None,
    Option("--mm/--m", help="Lengths in mm, of sliding joints and in --format."),
]
Deg = Annotated[
    bool | None,
    Option(
        "--deg/--rad", help="Angles in degrees, of joints and in --format, but a controller's own."
    ),
]
BEYOND = 1e-9  # rad or m: what rounding may add to a limit


class SaidUnits(NamedTuple):
    """Units that --mm and --deg say, None where they are not given: coordinates are in m and rad."""

    mm: bool | None = None
    deg: bool | None = None

    def said(self) -> tuple[str, ...]:
        """Units that were said."""
        return said_units(self.mm, self.deg)

    def of(self, chain: Chain) -> tuple[str, ...]:
        """Unit of each coordinate."""
        angle = "deg" if self.deg else "rad"
        length = "mm" if self.mm else "m"
        return tuple(angle if chain.is_angle(k) else length for k in range(chain.dof))

    def columns(self, chain: Chain) -> Columns:
        """Columns of a file of configurations."""
        return Columns(chain.q_names, COORDINATE, self.of(chain), self.said())

    def header(self, chain: Chain) -> list[str]:
        """Names of the coordinates in a file that is written, with their units where those were
        said.
        """
        pairs = zip(chain.q_names, self.of(chain), strict=True)
        said = self.said()
        return [f"{name} [{unit}]" if unit in said else name for name, unit in pairs]

    def to_si(self, values: Array, chain: Chain) -> Array:
        """Coordinates (..., m) in rad and m."""
        return _converted(values, self.of(chain), SI.of(chain))

    def from_si(self, values: Array, chain: Chain) -> Array:
        """Coordinates (..., m) in these units."""
        return _converted(values, SI.of(chain), self.of(chain))


def _converted(values: Array, units: Iterable[str], wanted: Iterable[str]) -> Array:
    """Coordinates (..., m) in the units that are wanted."""
    converted = np.array(values, float)
    for k, pair in enumerate(zip(units, wanted, strict=True)):
        if pair in CONVERSIONS:
            converted[..., k] = CONVERSIONS[pair](converted[..., k])
    return converted


SI = SaidUnits()
"""Neither --mm nor --deg."""


def beyond_limits(chain: Chain, q: Array, units: SaidUnits) -> str:
    """A sentence about configurations (N, m) beyond the limits, else about joints beyond their own;
    "" where there is none.
    """
    sentence = _beyond(chain, q, units)
    if sentence or not np.isfinite(chain.joint_limits).any():
        return sentence
    joints = chain.replace(
        coupling=None,
        offset=None,
        q_names=chain.joint_names,
        limits=chain.joint_limits,
        velocity_limits=None,
        joint_limits=None,
        joint_velocity_limits=None,
    )
    return _beyond(joints, joint_values(chain, q), units, "joint ", "own ")


def _beyond(
    chain: Chain,
    q: Array,
    units: SaidUnits,
    what: str = "",
    whose: str = "",
) -> str:
    """A sentence about coordinates (N, m) beyond the limits, each called `what` and its name."""
    low, high = chain.limits.T
    outside = (q < low - BEYOND) | (q > high + BEYOND)
    rows = np.flatnonzero(outside.any(axis=1))
    if not len(rows):
        return ""
    first = rows[0]
    k = int(np.flatnonzero(outside[first])[0])
    shown = units.from_si(np.stack([q[first], low, high]), chain)[:, k]
    value, least, most = (f"{x + 0.0:.6g}" for x in shown)
    unit = units.of(chain)[k]
    which = ""
    if len(q) > 1:
        which = (
            f"{len(rows)} of {len(q)} configurations are beyond limits; in the first, row {first}, "
        )
    cure = ""
    if abs(q[first, k]) <= TURN:  # a small number is more likely meant as it stands
        pass
    elif chain.is_angle(k) and units.deg is None:
        cure = "; are these degrees? --deg says so"
    elif not chain.is_angle(k) and units.mm is None:
        cure = "; are these mm? --mm says so"
    name = f"{what}{chain.q_names[k]}"
    return f"{which}{name} = {value} {unit} is outside its {whose}limits, {least} to {most}{cure}"
