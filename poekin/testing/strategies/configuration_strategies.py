"""Hypothesis strategies for configurations of a chain: within its limits, at its limits, and
singular ones.

Any configuration, whatever the limits say, is drawn by `chain_strategies.coordinates`.

Arrays are float64 and read-only, in rad or m. Raises: InputError, at the call, for what is no chain
or robot, and for numbers of joints that there are not.
Source: of singular cases, that a column of the Jacobian is the joint's screw where the arm has
carried it (Park 1994, eq. (11)), in the base frame.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from poekin.groups import se3
from poekin.model.chain import Chain

from . import arguments
from .chain_strategies import coordinates, placements, screws
from .decoding.bytes_reader import BytesReader
from .group_strategies import Arrays, frozen, read, st


def bounds(chain: Any) -> np.ndarray:
    """Limits of a chain, ±π where a coordinate has none, or one beyond 1e6.

    Parameters
    ----------
    chain : Chain or Robot
        Model, of which `dof` and `limits` are asked.

    Returns
    -------
    limits : (m, 2) ndarray
        Lower and upper limits, rad or m.

    Raises
    ------
    InputError
        For what is no model.
    """
    arguments.moves(chain)
    limits = np.array(chain.limits, dtype=float)
    half_turns = np.array([-math.pi, math.pi])
    return np.where(np.abs(limits) < 1e6, limits, half_turns)


def within_limits(chain: Any) -> Arrays:
    """Configurations evenly within the limits, each coordinate by itself.

    0 is drawn 1 of 8 times if it lies within.

    Parameters
    ----------
    chain : Chain or Robot
        Model, of which `dof` and `limits` are asked.

    Returns
    -------
    strategy : SearchStrategy
        Strategy of arrays (m,), rad or m; shrinks to 0 if that lies within, else to the lower limit.

    Raises
    ------
    InputError
        For what is no model.

    Examples
    --------
    >>> from hypothesis import given
    >>> import poekin as pk
    >>> from poekin.testing import strategies
    >>> arm = pk.load("panda").chain(tip="panda_hand")
    >>> @given(strategies.within_limits(arm))
    ... def test_no_limit_is_passed(q):
    ...     assert (arm.limits[:, 0] <= q).all() and (q <= arm.limits[:, 1]).all()
    >>> test_no_limit_is_passed()
    """
    pairs = bounds(chain).tolist()

    def configuration(r: BytesReader) -> np.ndarray:
        return frozen([_inside(r, *pair) for pair in pairs])

    return read(4 * len(pairs), configuration)


def at_limits(chain: Any) -> Arrays:
    """Configurations with each coordinate at a limit, or inside, each 1 of 3.

    Parameters
    ----------
    chain : Chain or Robot
        Model, of which `dof` and `limits` are asked.

    Returns
    -------
    strategy : SearchStrategy
        Strategy of arrays (m,), rad or m; shrinks to the lower limits.

    Raises
    ------
    InputError
        For what is no model.
    """
    pairs = bounds(chain).tolist()

    def value(
        r: BytesReader,
        lower: float,
        upper: float,
    ) -> float:
        inside = _inside(r, lower, upper)
        return r.pick([lower, upper, inside])

    def configuration(r: BytesReader) -> np.ndarray:
        return frozen([value(r, *pair) for pair in pairs])

    return read(5 * len(pairs), configuration)


def _inside(
    r: BytesReader,
    lower: float,
    upper: float,
) -> float:
    at_nought = r.byte() < 32 and lower <= 0.0 <= upper
    if at_nought:
        return 0.0
    width = upper - lower
    share = r.fraction(0.0, 1.0)
    # Of low and high rounded, the sum may be beyond.
    return min(lower + width * share, upper)


def singular_cases(
    min_joints: int = 2,
    max_joints: int = 7,
) -> st.SearchStrategy[tuple[Chain, np.ndarray]]:
    """Chains with a configuration in which two of its joints move alike.

    Joint j's screw is A_j = Ad((e^{A_{i+1} q_{i+1}} ⋯ e^{A_{j-1} q_{j-1}})⁻¹) A_i, to rounding, of any
    two joints: two columns of the Jacobian are equal.

    Parameters
    ----------
    min_joints, max_joints : int, default 2 and 7
        Smallest and largest number of joints, 2 and more.

    Returns
    -------
    strategy : SearchStrategy
        Strategy of pairs of `Chain` and an array (m,), rad or m; shrinks to the smallest number of
        joints.

    Raises
    ------
    InputError
        For numbers of joints that there are not.
    """
    return _singular_cases(arguments.counts(min_joints, max_joints, floor=2))


@st.composite
def _singular_cases(
    draw: st.DrawFn,
    bounds: tuple[int, int],
) -> tuple[Chain, np.ndarray]:
    n = draw(st.integers(*bounds))
    joints = screws(("revolute", "prismatic"))
    A = [np.array(draw(joints)) for _ in range(n)]
    home = draw(placements())
    arm = Chain.from_space(A, home)
    q = np.asarray(draw(coordinates(arm)))
    i = draw(st.integers(0, n - 2))
    j = draw(st.integers(i + 1, n - 1))
    between = np.eye(4)
    for k in range(i + 1, j):
        between = between @ se3.exp(A[k] * q[k])
    back = se3.inverse(between)
    A[j] = se3.adjoint(back) @ A[i]
    return Chain.from_space(A, home), frozen(q)
