"""Hypothesis strategies for Denavit-Hartenberg tables: both conventions, and what makes them ill-conditioned.

Angles are quarter turns, quarter turns missed by 1e-12 to 1e-3 rad (nearly parallel, nearly meeting axes), and anything
up to 3 rad; lengths are 0, up to 2 m either way, and 1e-12 to 1e-3 m.
"""

from __future__ import annotations

import functools
import math

import numpy as np

from ..formats.dh import Row, Table
from .strategies import Arrays, poses, st

CONVENTIONS = ("standard", "modified")
QUARTERS = (0.0, math.pi / 2, -math.pi / 2, math.pi)


@functools.cache
def angles() -> st.SearchStrategy[float]:
    """Angles of a table in rad: quarter turns, those by 1e-12 to 1e-3 off, or any from -3 to 3; shrinks towards 0."""
    quarters = st.sampled_from(QUARTERS)
    missed = st.builds(
        lambda quarter, sign, power: quarter + sign * 10**power, quarters, st.sampled_from([1, -1]), st.floats(-12, -3)
    )
    return st.one_of(quarters, missed, st.floats(-3, 3))


@functools.cache
def lengths() -> st.SearchStrategy[float]:
    """Lengths of a table in m: 0, from -2 to 2, or 1e-12 to 1e-3; shrinks towards 0."""
    return st.one_of(st.just(0.0), st.floats(-2, 2), st.floats(-12, -3).map(lambda power: 10.0**power))


@functools.cache
def rows() -> st.SearchStrategy[Row]:
    """Rows of a table: revolute or prismatic, turning either way; each number independent of the others."""
    kinds = st.sampled_from(["revolute", "prismatic"])
    return st.builds(Row, angles(), lengths(), lengths(), angles(), kinds, st.booleans())


@functools.cache
def mounts() -> Arrays:
    """Poses (4, 4) of bases and tools: any rotation, and an origin that is 0 or 1 mm to 2 m away."""
    return poses(lengths=(1e-3, 2.0))


@st.composite
def tables(
    draw: st.DrawFn, min_joints: int = 1, max_joints: int = 10, conventions: tuple[str, ...] = CONVENTIONS
) -> Table:
    """Tables of either convention with base and tool; shrinks towards one row of zeros in standard convention."""
    drawn = draw(st.lists(rows(), min_size=min_joints, max_size=max_joints))
    base, tool = np.asarray(draw(mounts())), np.asarray(draw(mounts()))
    return Table(draw(st.sampled_from(conventions)), drawn, base=base, tool=tool)
