"""Hypothesis strategies for configurations of a chain: within its limits, at its limits, and
singular ones.

Any configuration, whatever the limits say, is drawn by `chain_strategies.coordinates`.

Parameters of several: chain, a `poekin.Chain` or `poekin.Robot`, of which `dof` and `limits` are
asked. Returns: a strategy of float64 arrays, read-only, in rad or m. Raises: InputError, at the
call, for what is none of the two, and for numbers of joints that there are not.
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
    """The limits (m, 2) of a chain in rad or m; ± π where a coordinate has none, or one beyond 1e6.
    Returns: these.
    """
    arguments.moves(chain)
    limits = np.array(chain.limits, dtype=float)
    return np.where(np.abs(limits) < 1e6, limits, np.array([-math.pi, math.pi]))


def within_limits(chain: Any) -> Arrays:
    """Configurations (m,) evenly within the limits, each coordinate by itself; 0 where it lies
    within, 1 of 8.

    Shrinks to 0 where that lies within, else to the lower limit.
    """
    pairs = bounds(chain).tolist()
    return read(4 * len(pairs), lambda r: frozen([_inside(r, *pair) for pair in pairs]))


def at_limits(chain: Any) -> Arrays:
    """Configurations (m,) with each coordinate at its lower limit, at its upper one or inside, each
    1 of 3.

    Shrinks to the lower limits.
    """
    pairs = bounds(chain).tolist()

    def value(
        r: BytesReader,
        lower: float,
        upper: float,
    ) -> float:
        return r.pick([lower, upper, _inside(r, lower, upper)])

    return read(5 * len(pairs), lambda r: frozen([value(r, *pair) for pair in pairs]))


def _inside(
    r: BytesReader,
    lower: float,
    upper: float,
) -> float:
    at_nought = r.byte() < 32 and lower <= 0.0 <= upper
    # Of low and high rounded, the sum may be beyond.
    if at_nought:
        return 0.0
    return min(lower + (upper - lower) * r.fraction(0.0, 1.0), upper)


def singular_cases(
    min_joints: int = 2, max_joints: int = 7
) -> st.SearchStrategy[tuple[Chain, np.ndarray]]:
    """A chain and a configuration (m,) in which two of its joints move alike: their Jacobian
    columns are equal.

    Joint j's screw is A_j = Ad((e^{A_{i+1} q_{i+1}} ⋯ e^{A_{j-1} q_{j-1}})⁻¹) A_i, to rounding, of
    any two joints. Parameters: min_joints, at least 2, and max_joints. Shrinks to the smallest
    number of joints.
    """
    return _singular_cases(arguments.counts(min_joints, max_joints, floor=2))


@st.composite
def _singular_cases(draw: st.DrawFn, bounds: tuple[int, int]) -> tuple[Chain, np.ndarray]:
    n = draw(st.integers(*bounds))
    A = [np.array(draw(screws(("revolute", "prismatic")))) for _ in range(n)]
    home = draw(placements())
    q = np.asarray(draw(coordinates(Chain(A, home))))
    i = draw(st.integers(0, n - 2))
    j = draw(st.integers(i + 1, n - 1))
    between = np.eye(4)
    for k in range(i + 1, j):
        between = between @ se3.exp(A[k] * q[k])
    A[j] = se3.adjoint(se3.inverse(between)) @ A[i]
    return Chain(A, home), frozen(q)
