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
from typing import TYPE_CHECKING

import numpy as np

from ...algebra import add, dot, scale, subtract
from ...errors import InputError, safe_repr
from ...groups.arrays import Array
from .axis_walk import Frame, Walk
from .normals import digits, length

if TYPE_CHECKING:
    from ..chain import Chain

LARGEST = 0.05
"""The largest tolerance [rad, m] that is accepted: nothing has more than one multiple of 15 degrees
that near.
"""

UNIT = 2.0**-53


@dataclass(frozen=True)
class Idealised:
    """A chain in exact geometry, and what that costs.

    Attributes: chain; position_bound [m] and rotation_bound [rad], how far its tip's pose may be
    from the given chain's, at the same coordinates; changes, each in words. Changes of the size of
    rounding (1e-14 rad, 1e-14 of the reach) are made, but not listed.
    """

    chain: Chain
    position_bound: float
    rotation_bound: float
    changes: tuple[str, ...]


def idealised(self: Chain, tol: float) -> Idealised:
    """The same arm with its geometry made exact where it is so within a tolerance; nothing else
    ever implies this.

    Angles between consecutive axes, and between consecutive common normals, become multiples of 15
    degrees, and the lengths between them 0. Base and tool are the first and last axis of this (z
    axis and x direction): so a tool's rotation is Rz Rx Rz, of which each angle is looked at for
    itself.

    Parameters: tol, one number that is radians for angles and metres for lengths, 0 (nothing
    changes) to 0.05.
    Returns: Idealised. Kinds, pitches, names, limits and coupling stay.
    Raises: InputError for another tol.
    Accuracy: the exact geometry to the last digit of the screws. The bounds hold at every value of
    revolute joints; a joint that slides counts as far as it can within its limits, by as much as
    `random` draws where it has none. They are at most 20 times the worst error of the package's
    arms (tests/model/test_idealised.py).
    Source: none, the lines' geometry; the error of a product of poses is at most the sum of its
    factors'.
    """
    real = isinstance(tol, (int, float, np.integer, np.floating)) and not isinstance(tol, bool)
    if not real or not 0 <= tol <= LARGEST:
        raise InputError(
            f"tol: a number from 0 to {LARGEST} expected (rad and m), got {safe_repr(tol)}"
        )
    if tol == 0:
        return Idealised(self, 0.0, 0.0, ())
    with digits():
        walk = Walk(self, float(tol))
        screws, home = walk.screws(), walk.home()
        if not walk.snapped or _settled(self, screws, home):
            return Idealised(self, 0.0, 0.0, ())
        position, rotation = _bounds(self, walk.given, walk.exact)
    return Idealised(self._with(screws=screws, home=home), position, rotation, tuple(walk.changes))


def _bounds(chain: Chain, given: list[Frame], exact: list[Frame]) -> tuple[float, float]:
    """How far the tip may be from where it was [m], and turned [rad].

    f = G_0 e^{Z x_1} G_1 ... e^{Z x_n} G_n with z-aligned frames on the lines, and G_i' in place of
    G_i one by one: what lies before is a rigid motion, and what lies behind no further away than
    all its lengths one after the other. Frames may slide along their lines; here they are nearest
    to the one before, which makes the lengths least.
    """
    given, exact = _nearest(chain, given), _nearest(chain, exact)
    low, high = chain._range()
    C, form = chain.coupling, chain.local
    most = np.abs(form.slides) * (
        np.abs(C @ (low / 2 + high / 2) + chain.offset) + np.abs(C) @ (high / 2 - low / 2)
    )
    behind = position = rotation = 0.0
    for i in reversed(range(len(given) - 1)):
        (a, b), (p, q) = given[i : i + 2], exact[i : i + 2]
        t, moved = a.of(subtract(b.o, a.o)), p.of(subtract(q.o, p.o))
        turn = [
            subtract(a.of(x), p.of(y))
            for x, y in zip((b.x, b.y, b.z), (q.x, q.y, q.z), strict=True)
        ]
        chord = math.sqrt(sum(dot(column, column) for column in turn) / 2)
        position += float(length(subtract(moved, t))) + chord * behind
        rotation += 2 * math.asin(chord / 2)  # of a few tolerances, far from half a turn
        behind += float(length(t)) + (float(most[i - 1]) if i else 0.0)
    rounding = 8 * UNIT * len(given)  # of the numbers that the new screws are written in
    return position + rounding * max(behind, chain.reach), rotation + rounding


def _nearest(chain: Chain, frames: list[Frame]) -> list[Frame]:
    """The joints' frames with each origin slid along its line to be nearest to the one before."""
    slid = frames[:1]
    for frame, kind in zip(frames[1:-1], chain.kinds, strict=True):
        back = subtract(slid[-1].o, frame.o)
        o = slid[-1].o if kind == "prismatic" else add(frame.o, scale(dot(back, frame.z), frame.z))
        slid.append(frame._replace(o=o))
    return [*slid, frames[-1]]


def _settled(chain: Chain, screws: Array, home: Array) -> bool:
    """Whether a chain is as exact already as floats can say: only last digits differ, and no 0, 1
    or parallel axis.
    """
    for old, new in ((chain.screws, screws), (chain.home, home)):
        if (
            np.abs(old - new) > 16 * UNIT * max(1.0, chain.reach, float(np.abs(old).max(initial=0)))
        ).any():
            return False
        if (np.isin(new, (-1.0, 0.0, 1.0)) & (old != new)).any():
            return False
    # Axes that are parallel in the new screws must be so in the old ones.
    parallel: dict[bytes, bytes] = {}
    return all(
        parallel.setdefault(_way(a), _way(b)) == _way(b)
        for a, b in zip(screws, chain.screws, strict=True)
    )


def _way(S: Array) -> bytes:
    """The direction of a screw's axis to the last bit, whichever way it points."""
    z = S[:3] if S[:3].any() else S[3:]
    return (z * np.sign(z[np.flatnonzero(z)[0]]) + 0.0).tobytes()
