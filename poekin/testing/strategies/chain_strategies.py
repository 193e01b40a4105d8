"""Hypothesis strategies for serial chains: screws of all joint kinds, chains with and without
coupling, coordinates.

Twists and screws are (ω; v) in the base frame, lengths in m, angles in rad; arrays are float64 and
read-only. Whole trees are drawn by `robot_strategies`, configurations within limits by
`configuration_strategies`.

Raises: InputError, at the call, for kinds, numbers of joints or shapes that there are not.
Accuracy: a screw's axis has unit length, and v of a revolute
one is at right angles to it, to rounding.
Source: Park 1994, Section II: f(q) = e^{A_1 x_1} ⋯ e^{A_n x_n} M, x = C q + c.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from typing import Any, get_args

import numpy as np

from poekin.model.chain import Chain
from poekin.model.chain_data import ScrewKind

from . import arguments
from .decoding.bytes_reader import BytesReader
from .group_strategies import Arrays, axes, frozen, poses, read, st, vectors

KINDS: tuple[ScrewKind, ...] = get_args(ScrewKind)
"""What a chain's joints may be; a continuous joint is a revolute one without limits."""
REACHES = (1e-3, 3.0)
"""The smallest distance in m of an arm's points, beside 0, and the largest."""
QUARTERS = (0.0, math.pi / 2, -math.pi / 2, math.pi)
"""Values of coordinates that one in four has."""
RATIOS = (1.0, -1.0, 0.5, -2.0, 0.0)
"""By which coupled joints follow a coordinate."""
LIMITS = ("none", "both", "both", "both", "equal", "lower", "upper")
"""Which limits coordinates of a chain have, each as often as any."""


@functools.cache
def points() -> Arrays:
    """Points of an arm: the origin, or at a log-uniform distance of 1 mm to 3 m.

    Returns
    -------
    strategy : SearchStrategy
        Strategy of arrays (3,), m, in the base frame; shrinks to 0.
    """
    return vectors(REACHES)


def screws(kinds: Sequence[ScrewKind] = KINDS) -> Arrays:
    """Screws of joints: axis, point and pitch independent of each other.

    Pitches are 1 mm to 1 m per rad, of either sign.

    Parameters
    ----------
    kinds : sequence of str
        Kinds of joints, of `KINDS`.

    Returns
    -------
    strategy : SearchStrategy
        Strategy of arrays (6,), (ω; v) in the base frame; shrinks to a revolute joint about x through
        the origin.

    Raises
    ------
    InputError
        For kinds that there are not.
    """
    return _screws(arguments.some("kinds", kinds, KINDS))


@functools.cache
def _screws(kinds: tuple[str, ...]) -> Arrays:
    def screw(
        kind: str,
        axis: np.ndarray,
        point: np.ndarray,
        pitch: float,
    ) -> np.ndarray:
        if kind == "prismatic":
            return frozen([0, 0, 0, *axis])
        slide = np.zeros(3)
        if kind == "helical":
            slide = pitch * axis
        return frozen([*axis, *(np.cross(point, axis) + slide)])

    pitches = read(5, lambda r: r.pick([1.0, -1.0]) * max(r.magnitude(1e-3, 1.0), 1e-3))
    return st.builds(screw, read(1, lambda r: r.pick(kinds)), axes(), points(), pitches)


@functools.cache
def placements() -> Arrays:
    """Poses of frames of an arm: any rotation, and an origin as in `points`.

    Returns
    -------
    strategy : SearchStrategy
        Strategy of arrays (4, 4), in the base frame, m; shrinks to I.
    """
    return poses(REACHES)


def chains(
    min_joints: int = 0,
    max_joints: int = 12,
    joint_kinds: Sequence[ScrewKind] = KINDS,
    coupled: bool | None = None,
    offsets: bool = True,
    limits: bool = False,
) -> st.SearchStrategy[Chain]:
    """Serial chains of any kinds of joints, with any home pose.

    Parameters
    ----------
    min_joints, max_joints : int, default 0 and 12
        Smallest and largest number of joints, each number as often as any.
    joint_kinds : sequence of str
        Kinds of joints, of `KINDS`.
    coupled : bool, optional
        Whether joints may follow a coordinate by a ratio (also 0: they stand still); by default coupled
        and uncoupled chains are drawn.
    offsets : bool, default True
        Whether coupled joints also have an offset.
    limits : bool, default False
        Whether coordinates have limits: two, equal ones, a lower or an upper one alone, or none, rad or m.

    Returns
    -------
    strategy : SearchStrategy
        Strategy of `Chain`; shrinks to the joints that matter, revolute about x through the origin, and
        M = I.

    Raises
    ------
    InputError
        For kinds or numbers of joints that there are not.

    Examples
    --------
    >>> from hypothesis import given
    >>> from poekin.testing import strategies
    >>> @given(strategies.chains(min_joints=2, joint_kinds=["revolute"]))
    ... def test_all_joints_turn(chain):
    ...     assert set(chain.kinds) == {"revolute"}
    >>> test_all_joints_turn()
    """
    bounds = arguments.counts(min_joints, max_joints)
    return _chains(
        bounds,
        arguments.some("joint_kinds", joint_kinds, KINDS),
        coupled,
        offsets,
        limits,
    )


def _limits(r: BytesReader) -> tuple[float, float]:
    kind = r.pick(LIMITS)
    lower = r.decimal(-3.0, 3.0)
    width = r.decimal(0.1, 3.0)
    upper = lower + width
    if kind == "equal":
        upper = lower
    if kind in ("none", "upper"):
        lower = -math.inf
    if kind in ("none", "lower"):
        upper = math.inf
    return lower, upper


@st.composite
def _chains(
    draw: st.DrawFn,
    bounds: tuple[int, int],
    kinds: tuple[str, ...],
    coupled: bool | None,
    offsets: bool,
    limits: bool,
) -> Chain:
    n = draw(read(1, lambda r: r.pick(range(bounds[0], bounds[1] + 1))))
    A = [draw(_screws(kinds)) for _ in range(n)]
    home = draw(placements())
    if n and coupled is None:
        coupled = draw(st.booleans())
    if n == 0 or not coupled:
        return Chain.from_space(np.reshape(A, (n, 6)), home, limits=_drawn_limits(draw, n, limits))
    m = draw(st.integers(1, n))
    C = np.zeros((n, m))
    c = np.zeros(n)
    # The first m joints are masters in an order of their own; the others follow one of them.
    for i in range(n):
        if i < m:
            C[i, i] = 1.0
        else:
            ratio = draw(st.sampled_from(RATIOS))
            C[i, draw(st.integers(0, m - 1))] = ratio
        if offsets:
            c[i] = draw(read(3, lambda r: r.fraction(-1.0, 1.0)))
    order = list(draw(st.permutations(range(n))))
    pairs = _drawn_limits(draw, m, limits)
    return Chain.from_space(
        A,
        home,
        coupling=C[order],
        offset=c[order],
        limits=pairs,
    )


def _drawn_limits(
    draw: st.DrawFn,
    count: int,
    limits: bool,
) -> list[tuple[float, float]] | None:
    """Limits of so many coordinates, or None where there are to be none."""
    if not limits:
        return None
    return draw(read(9 * count, lambda r: [_limits(r) for _ in range(count)])) or None


def coordinates(chain: Any, shape: Sequence[int] = ()) -> Arrays:
    """Configurations: 0 and quarter turns (1 of 4), and anything up to ±π.

    Parameters
    ----------
    chain : Chain or Robot
        Model, of which only `dof` is asked: limits are none here.
    shape : sequence of int, default ()
        Shape of the leading axes.

    Returns
    -------
    strategy : SearchStrategy
        Strategy of arrays (*shape, m), rad or m; shrinks to 0.

    Raises
    ------
    InputError
        For what is no model, or no shape.
    """
    m = arguments.moves(chain)
    shape = arguments.shape(shape)
    count = math.prod(shape) * m

    def value(r: BytesReader) -> float:
        if r.byte() < 64:
            return r.pick(QUARTERS)
        return r.fraction(-math.pi, math.pi)

    return read(
        4 * count,
        lambda r: frozen(np.reshape([value(r) for _ in range(count)], (*shape, m))),
    )
