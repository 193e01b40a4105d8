"""Bounds on the rounding of a chain's poses and twists, and errors measured against them.

Rotations and translations, ω and v, are held apart. A chain is `poekin.Chain`, or anything with its
attributes and methods; poses are in the base frame, in rad and m.
Raises: nothing, unless stated. Source: u = 2⁻⁵³, half the distance from 1 to the next float, for
each of the n + 1 factors of Park 1994, eq. (1), and for each of their angles.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from poekin.testing.accuracy.error_bounds import UNIT
from poekin.testing.laws.laws import LawViolation, Pairs, check_bounds, checked
from poekin.testing.laws.measures import of_twist, size

Shaped = tuple[Callable[[np.ndarray], np.ndarray], tuple[int, ...]]
"""A function of configurations, and the shape of its value for a single one."""


def budget(chain: Any, q: np.ndarray) -> tuple[Any, Any]:
    """Bounds on the rounding of poses at q (..., m): of their rotations, and of their translations.

    The angular bound is u (8 (n + 1) + 4 Σ |x_i|); the linear bound is that times the reach and what
    the joints slide beyond it. Where the home pose's rotation R misses being one by δ = |R Rᵀ - I|,
    the forms are different motions: M e^{B x}, whose B = Ad(M)⁻¹ A takes Rᵀ for the inverse, turns
    otherwise by up to δ (1 + Σ |x_i|/2), and moves by up to δ (2 + Σ |x_i|/2) times the same.
    """
    x = q @ chain.coupling.T + chain.offset
    R = chain.home[:3, :3]
    turned = np.abs(x).sum(axis=-1)
    missed = size(R @ R.T - np.eye(3))
    angular = UNIT * (8 * (len(chain.screws) + 1) + 4 * turned) + missed * (1 + turned / 2)
    far = chain.reach + np.abs(chain.local.slides * x).sum(axis=-1)
    return angular, (angular + missed) * far


def of_poses(
    chain: Any,
    q: np.ndarray,
    T: np.ndarray,
    expected: np.ndarray,
) -> Pairs:
    """Errors of R, of t and of the last row of a pose, with their bounds."""
    angular, linear = budget(chain, q)
    error = T - np.asarray(expected, dtype=float)
    return [(size(error[:3, :3]), angular), (size(error[:3, 3]), linear), (size(error[3]), 0.0)]


def of_twists(
    chain: Any,
    q: np.ndarray,
    dq: np.ndarray,
    error: np.ndarray,
    factor: float = 1.0,
) -> Pairs:
    """Errors of ω and v of a twist, with the budget times the joints' rates as bounds."""
    angular, linear = budget(chain, q)
    rates = chain.coupling @ dq
    turning = size(chain.local.rotates * rates)
    sliding = size(chain.local.slides * rates)
    grown = factor * (1 + len(rates))
    return of_twist(error, grown * angular * turning, grown * linear * (turning + sliding))


def chain_numbers(chain: Any) -> dict[str, object]:
    """Screws and home pose of a chain, and its coupling where there is one."""
    numbers = {"screws": chain.screws, "home": chain.home}
    if not np.array_equal(chain.coupling, np.eye(chain.dof)):
        numbers |= {"coupling": chain.coupling, "offset": chain.offset}
    return numbers


def chain_law(title: str = "") -> Callable[[Callable[..., Pairs]], Callable[..., float]]:
    """Decorator that makes a law of a chain of a function that measures pairs (error, bound); a
    violation has the chain's numbers, too.
    """

    def decorate(measure: Callable[..., Pairs]) -> Callable[..., float]:
        plain = checked(title)(measure)

        @functools.wraps(measure)
        def law(chain: Any, *arguments: Any, **named: Any) -> float:
            try:
                return plain(chain, *arguments, **named)
            except LawViolation as found:
                seen = found.seen | chain_numbers(chain)
                raise LawViolation(found.law, found.error, found.bound, seen) from None

        return law

    return decorate


def check_chain_bounds(
    law: str,
    chain: Any,
    *measured: tuple[float, float],
    **seen: object,
) -> float:
    """Worst error ÷ bound, as `check_bounds`; a violation has the chain's numbers, too."""
    return check_bounds(law, *measured, **seen, **chain_numbers(chain))


def check_batch(
    law: str,
    chain: Any,
    batch: np.ndarray,
    functions: Sequence[Shaped],
    bound: Callable[[np.ndarray, np.ndarray], float],
) -> float:
    """Check that functions of a batch are, element by element, those of single configurations."""
    shape = batch.shape[:-1]
    pairs: Pairs = []
    for function, tail in functions:
        together = function(batch)
        expected = (*shape, *tail)
        if together.shape != expected:
            seen = {"shape": together.shape, "expected": expected}
            return check_chain_bounds("batches have their shape", chain, (np.inf, 0.0), **seen)
        for index in np.ndindex(shape):
            q = batch[index]
            value = function(q)
            pairs.append((size(together[index] - value), bound(q, value)))
    return check_chain_bounds(law, chain, *pairs, batch=batch)


def adjoint(T: np.ndarray) -> np.ndarray:
    """Adjoint matrix Ad(T) = [R 0; [t] R R] of a pose, by NumPy alone."""
    R = T[:3, :3]
    x, y, z = T[:3, 3]
    corner = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]]) @ R
    return np.block([[R, np.zeros((3, 3))], [corner, R]])


def inverse(T: np.ndarray) -> np.ndarray:
    """Inverse of a pose, by NumPy alone."""
    R = T[:3, :3].T
    return np.block([[R, -(R @ T[:3, 3:])], [np.zeros((1, 3)), np.ones((1, 1))]])
