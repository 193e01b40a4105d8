"""Judges of DH tables: the product of their links in 60 digits, and a chain's way to a table and
back.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

from poekin import Chain, dh
from poekin.testing.oracles import exact

UNIT = 2.0**-53
WELL = 1e-13
"""Bar on the pose error ÷ R of a well-conditioned table."""
FAR = 10
"""A table is well-conditioned where its largest |d| and |a| are at most so many R."""


def product(table: dh.Table, x: np.ndarray) -> np.ndarray:
    """The pose (4, 4) that a table means, x (n,) in rad and m: in 60 digits, rounded once.

    A turn about an axis and a shift along it are one twist, so a link is two of the oracle's
    exponentials:
    Rz(theta) Tz(d) = e^(0, 0, theta; 0, 0, d) and Tx(a) Rx(alpha) = e^(alpha, 0, 0; a, 0, 0).
    """
    T = exact.exactly(table.base)
    for row, value in zip(table.rows, exact.exactly(x), strict=True):
        moved, turns = (-value if row.flip else value), row.kind == "revolute"
        joint = exact.exp([0, 0, row.theta + moved * turns, 0, 0, row.d + moved * (not turns)])
        link = exact.exp([row.alpha, 0, 0, row.a, 0, 0])
        T = T @ joint @ link if table.convention == "standard" else T @ link @ joint
    return exact.rounded(T @ exact.exactly(table.tool))


def error(got: np.ndarray, expected: np.ndarray, reach: float) -> float:
    """The largest entry that differs of poses (..., 4, 4), lengths ÷ R."""
    return float((np.abs(got - expected)[..., :3, :] * np.array([1, 1, 1, 1 / reach])).max())


def largest(table: dh.Table, reach: float) -> float:
    """The largest |d| or |a| of a table ÷ R."""
    return float(max(np.abs(table.d).max(initial=0.0), np.abs(table.a).max(initial=0.0)) / reach)


def ceiling(table: dh.Table, reach: float) -> float:
    """What the rounding of far origins may cost: 100 u n (R + max(|d|, |a|)) ÷ R."""
    return 100 * UNIT * max(len(table), 1) * (1 + largest(table, reach))


def lever(table: dh.Table, chain: Chain) -> float:
    """How far an angle that was dropped reaches ÷ R: over all lengths of the table and of its tool,
    at least R.
    """
    lengths = np.abs(table.d).sum() + np.abs(table.a).sum() + np.linalg.norm(table.tool[:3, 3])
    return max(1.0, float(lengths + chain.kinds.count("prismatic")) / chain.reach)


@dataclass(frozen=True)
class Trip:
    """Screws → table → screws.

    error: of the pose ÷ R; bound: what `dh.from_chain` says that it may be; ceiling: what that may
    be at most;
    well: whether the table is well-conditioned and no angle between axes was dropped; dropped: such
    angles, rad.
    """

    error: float
    bound: float
    ceiling: float
    well: bool
    dropped: tuple[float, ...]


def there_and_back(chain: Chain, convention: dh.Convention, q: np.ndarray) -> Trip:
    """A chain's table in a convention, back to screws, and both compared at q (N, m)."""
    result = dh.from_chain(chain, convention=convention, samples=1)
    x = q @ chain.coupling.T + chain.offset
    off = error(dh.to_chain(result.table).fk(x), chain.fk(q), chain.reach)
    # What a table dropped has to be said in its warnings, in three digits: read there, as a user
    # would.
    said = [re.search(r"the angle of (\S+) rad between", words) for words in result.warnings]
    dropped = tuple(float(found[1]) for found in said if found)
    most = ceiling(result.table, chain.reach) + 2 * 1.005 * sum(dropped) * lever(
        result.table, chain
    )
    well = largest(result.table, chain.reach) <= FAR and not dropped
    return Trip(off, result.bound, most, well, dropped)
