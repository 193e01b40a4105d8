"""Hypothesis strategies for configurations of a chain: within its limits, at its limits, and singular ones.

Any configuration, whatever the limits say, is drawn by `chain_strategies.coordinates`.
"""

from __future__ import annotations

import functools
import math
from typing import Any

import numpy as np

from poekin.groups import se3
from poekin.model.chain import Chain

from .chain_strategies import coordinates, placements, screws
from .reader import Reader
from .strategies import Arrays, frozen, read, st


def bounds(chain: Any) -> np.ndarray:
    """Its limits (m, 2) in rad or m; ± π where a coordinate has none, or one beyond 1e6."""
    limits = np.array(chain.limits, dtype=float)
    return np.where(np.abs(limits) < 1e6, limits, np.array([-math.pi, math.pi]))


def within_limits(chain: Any) -> Arrays:
    """Configurations (m,) evenly within the limits, each coordinate by itself; 0 where it lies within, now and then."""
    return read(4 * chain.dof, lambda r: frozen([_inside(r, *pair) for pair in bounds(chain).tolist()]))


def at_limits(chain: Any) -> Arrays:
    """Configurations (m,) with each coordinate at its lower or upper limit, or one in three inside."""

    def value(r: Reader, lower: float, upper: float) -> float:
        return r.pick([lower, upper, _inside(r, lower, upper)])

    return read(5 * chain.dof, lambda r: frozen([value(r, *pair) for pair in bounds(chain).tolist()]))


def _inside(r: Reader, lower: float, upper: float) -> float:
    at_nought = r.byte() < 32 and lower <= 0.0 <= upper
    # Of low and high rounded, the sum may be beyond.
    return 0.0 if at_nought else min(max(lower + (upper - lower) * r.fraction(0.0, 1.0), lower), upper)


@st.composite
def singular_cases(draw: st.DrawFn, min_joints: int = 2, max_joints: int = 7) -> tuple[Chain, np.ndarray]:
    """A chain and a configuration in which two of its joints move alike: their Jacobian columns are equal.

    Joint j's screw is A_j = Ad((e^{A_{i+1} q_{i+1}} ⋯ e^{A_{j-1} q_{j-1}})⁻¹) A_i, to rounding.
    """
    n = draw(st.integers(min_joints, max_joints))
    A = [np.array(draw(screws(("revolute", "prismatic")))) for _ in range(n)]
    home = draw(placements())
    q = np.asarray(draw(coordinates(Chain(A, home))))
    i = draw(st.integers(0, n - 2))
    j = draw(st.integers(i + 1, n - 1))
    between = functools.reduce(np.matmul, (se3.exp(A[k] * q[k]) for k in range(i + 1, j)), np.eye(4))
    A[j] = se3.adjoint(se3.inverse(between)) @ A[i]
    return Chain(A, home), frozen(q)
