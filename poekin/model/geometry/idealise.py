"""The nearest exact geometry of a chain whose numbers were rounded, and what it costs.

Models write π/2 as 1.5708 and zeros as 1e-07. A chain is walked from line to line (`axis_walk`):
angles within the tolerance of a multiple of 15 degrees become that, with its exact sine and cosine,
and lengths within it become 0. Then the lines are built anew from these numbers alone, so that what
was rounded in one place is put right in that place, and parallel axes have the same direction to
the last bit.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar, Generic

import numpy as np

from ...algebra import dot, subtract
from ...checks import is_real
from ...errors import InputError, safe_repr
from ...groups.arrays import ROUNDOFF, Array
from ...groups.vectors import angular_part, directions
from ...results import Result
from ..chain_data import AnyChain, ChainData
from ..sampling import largest_slides
from .axis_walk import Walk
from .normals import Frame, digits, length, nearest_on_line

LARGEST = 0.05
"""The largest tolerance [rad, m] that is accepted: nothing has more than one multiple of 15 degrees
that near.
"""


@dataclass(frozen=True)
class Idealised(Result, Generic[AnyChain]):
    """Chain in exact geometry, and what that costs.

    Attributes
    ----------
    chain : Chain
        Chain with exact angles and lengths.
    position_bound : float
        Bound of the distance of its tip from the given chain's at the same coordinates, m.
    rotation_bound : float
        Bound of the angle between their orientations, rad.
    changes : tuple of str
        Each change in words. Changes of the size of rounding (1e-14 rad, 1e-14 of the reach) are
        made, but not listed.
    """

    left_out: ClassVar[tuple[str, ...]] = ("chain",)

    chain: AnyChain
    position_bound: float
    rotation_bound: float
    changes: tuple[str, ...]

    def summary(self) -> str:
        """Text for people.

        Returns
        -------
        text : str
            Bounds in mm and degrees, and the changes, one a line.
        """
        position = f"{1e3 * self.position_bound:.3g} mm"
        rotation = f"{math.degrees(self.rotation_bound):.3g}°"
        if not self.changes:
            return f"nothing was changed but rounding: within {position} and {rotation}"
        return "\n".join([f"within {position} and {rotation}", *self.changes])


def idealised(chain: AnyChain, tol: float) -> Idealised[AnyChain]:
    """The chain with its geometry made exact where it is so within a tolerance."""
    if not is_real(tol) or not 0 <= tol <= LARGEST:
        raise InputError(
            f"tol: a number from 0 to {LARGEST} expected (rad and m), got {safe_repr(tol)}"
        )
    unchanged = Idealised(chain, 0.0, 0.0, ())
    if tol == 0:
        return unchanged
    with digits():
        walk = Walk(chain, float(tol))
        screws = walk.screws()
        home = walk.home()
        if not walk.snapped or _settled(chain, screws, home):
            return unchanged
        position, rotation = _bounds(chain, walk.given, walk.exact)
    exact = chain.replace(screws=screws, home=home, pitches=chain.pitches, masses=chain.masses)
    return Idealised(exact, position, rotation, tuple(walk.changes))


def _bounds(
    chain: ChainData,
    given: list[Frame],
    exact: list[Frame],
) -> tuple[float, float]:
    """Bounds of the distance [m] and the angle [rad] of the tip from its given pose.

    f = G_0 e^{Z x_1} G_1 ... e^{Z x_n} G_n with z-aligned frames on the lines, and G_i' in place of
    G_i one by one: what lies before is a rigid motion, and what lies behind no further away than
    all its lengths one after the other. Frames may slide along their lines; here they are nearest
    to the one before, which makes the lengths least.
    """
    given = _nearest(chain, given)
    exact = _nearest(chain, exact)
    travel = [0.0, *largest_slides(chain).tolist()]
    behind = position = rotation = 0.0
    for i in reversed(range(len(given) - 1)):
        link = given[i + 1].seen_by(given[i])
        exact_link = exact[i + 1].seen_by(exact[i])
        *columns, moved = map(subtract, exact_link, link)
        chord = math.sqrt(sum(dot(column, column) for column in columns) / 2)
        shift = length(moved)
        position += float(shift) + chord * behind
        rotation += 2 * math.asin(chord / 2)  # of a few tolerances, far from half a turn
        behind += float(length(link.o)) + travel[i]
    rounding = 8 * ROUNDOFF * len(given)  # of the numbers that the new screws are written in
    return position + rounding * max(behind, chain.reach), rotation + rounding


def _nearest(chain: ChainData, frames: list[Frame]) -> list[Frame]:
    """The joints' frames with each origin slid along its line to be nearest to the one before."""
    slid = frames[:1]
    for frame, kind in zip(frames[1:-1], chain.kinds, strict=True):
        o = slid[-1].o
        if kind != "prismatic":
            o = nearest_on_line(frame.o, frame.z, o)
        slid.append(frame._replace(o=o))
    return [*slid, frames[-1]]


def _settled(chain: ChainData, screws: Array, home: Array) -> bool:
    """Whether a chain is as exact already as floats can say: only last digits differ, and no 0, no
    direction's 1 or parallel axis.
    """
    turns = angular_part(screws).any(axis=1)
    ways = np.repeat(np.stack([turns, ~turns], axis=1), 3, axis=1)
    rotation = np.zeros((4, 4), bool)
    rotation[:3, :3] = True
    for old, new, is_way in ((chain.screws, screws, ways), (chain.home, home, rotation)):
        size = np.abs(old).max(initial=chain.reach)
        far = np.abs(old - new) > 16 * ROUNDOFF * size
        # a place of 1 m is as any other
        is_exact = (new == 0.0) | is_way & (np.abs(new) == 1.0)
        if far.any() or (is_exact & (old != new)).any():
            return False
    # Axes that are parallel in the new screws must be so in the old ones.
    parallel: dict[bytes, bytes] = {}
    pairs = zip(map(_way, screws), map(_way, chain.screws), strict=True)
    return all(parallel.setdefault(exact, given) == given for exact, given in pairs)


def _way(S: Array) -> bytes:
    """The direction of a screw's axis to the last bit, whichever way it points."""
    z = directions(S)
    leading = z[np.flatnonzero(z)[0]]
    return (z * np.sign(leading) + 0.0).tobytes()
