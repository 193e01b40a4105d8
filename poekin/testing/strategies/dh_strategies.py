"""Hypothesis strategies for Denavit-Hartenberg tables: both conventions, and what makes them
ill-conditioned.

Angles are quarter turns, quarter turns missed by 1e-12 to 1e-3 rad (nearly parallel, nearly meeting
axes), and anything up to 3 rad; lengths are 0, up to 2 m either way, and 1e-12 to 1e-3 m.

Returns: a strategy; arrays are float64 and read-only, poses those of a frame in the frame before
it. Raises: InputError, at the call, for conventions or numbers of joints that there are not.
Source: where DH numbers are ill-conditioned: parallel axes, and axes that meet (`formats.dh`).
"""

from __future__ import annotations

import functools
from collections.abc import Sequence
from typing import cast

import numpy as np

from ...formats.dh import Row, Table
from ...formats.dh.table import CONVENTIONS, Convention
from . import arguments
from .chain_strategies import QUARTERS
from .group_strategies import Arrays, poses, st

POWERS = (-12, -3)
"""Powers of 10 between which lie the rad that quarter turns are missed by, and the tiny lengths in
m.
"""


@functools.cache
def angles() -> st.SearchStrategy[float]:
    """Angles of a table: quarter turns, those by 1e-12 to 1e-3 rad off, or any from -3 to 3.

    Returns
    -------
    strategy : SearchStrategy
        Strategy of floats, rad; shrinks towards 0.
    """
    quarters = st.sampled_from(QUARTERS)
    missed = st.builds(
        lambda quarter, sign, power: quarter + sign * 10**power,
        quarters,
        st.sampled_from([1, -1]),
        st.floats(*POWERS),
    )
    return st.one_of(quarters, missed, st.floats(-3, 3))


@functools.cache
def lengths() -> st.SearchStrategy[float]:
    """Lengths of a table: 0, from -2 to 2 m, or 1e-12 to 1e-3 m.

    Returns
    -------
    strategy : SearchStrategy
        Strategy of floats, m; shrinks towards 0.
    """
    return st.one_of(
        st.just(0.0),
        st.floats(-2, 2),
        st.floats(*POWERS).map(lambda power: 10.0**power),
    )


@functools.cache
def rows() -> st.SearchStrategy[Row]:
    """Rows of a table: revolute or prismatic, turning either way, each number independent.

    Returns
    -------
    strategy : SearchStrategy
        Strategy of `poekin.dh.Row`.
    """
    kinds = st.sampled_from(["revolute", "prismatic"])
    return st.builds(Row, angles(), lengths(), lengths(), angles(), kinds, st.booleans())


@functools.cache
def mounts() -> Arrays:
    """Poses of bases and tools: any rotation, and an origin that is 0 or 1 mm to 2 m away.

    Returns
    -------
    strategy : SearchStrategy
        Strategy of arrays (4, 4), of a frame in the frame before it, m.
    """
    return poses(lengths=(1e-3, 2.0))


def tables(
    min_joints: int = 1,
    max_joints: int = 10,
    conventions: Sequence[Convention] = CONVENTIONS,
) -> st.SearchStrategy[Table]:
    """Denavit-Hartenberg tables with base and tool.

    Parameters
    ----------
    min_joints, max_joints : int, default 1 and 10
        Smallest and largest number of rows.
    conventions : sequence of str
        Conventions, of `CONVENTIONS`.

    Returns
    -------
    strategy : SearchStrategy
        Strategy of `poekin.dh.Table`; shrinks towards one row of zeros in standard convention.

    Raises
    ------
    InputError
        For conventions or numbers of joints that there are not.

    Examples
    --------
    >>> from hypothesis import given
    >>> import poekin as pk
    >>> from poekin.testing import strategies
    >>> @given(strategies.tables(min_joints=2))
    ... def test_each_row_is_a_joint(table):
    ...     assert len(pk.dh.to_chain(table).kinds) == len(table) >= 2
    >>> test_each_row_is_a_joint()
    """
    bounds = arguments.counts(min_joints, max_joints)
    return _tables(bounds, arguments.some("conventions", conventions, CONVENTIONS))


@st.composite
def _tables(
    draw: st.DrawFn,
    bounds: tuple[int, int],
    conventions: tuple[str, ...],
) -> Table:
    drawn = draw(st.lists(rows(), min_size=bounds[0], max_size=bounds[1]))
    base = np.asarray(draw(mounts()))
    tool = np.asarray(draw(mounts()))
    convention = cast(Convention, draw(st.sampled_from(conventions)))
    return Table(convention, drawn, base=base, tool=tool)
