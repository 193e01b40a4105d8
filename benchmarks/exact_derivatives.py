"""Derivatives of the motion of a serial chain in 80 digits, by the definition.

Central differences of step 1e-20, whose own error is 1e-39, of what `exact_chain` has. A chain is
what it is there. Accuracy: 30 digits and more.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np

from poekin.testing.oracles import exact, exact_chain
from poekin.testing.oracles.exact_numbers import skew_part

STEP = exact.mp.mpf(10) ** -20
Curve = Callable[[Any], np.ndarray]


class ScrewChanges(NamedTuple):
    """Derivatives of the motion of a chain by one screw.

    Attributes
    ----------
    twist : (6, 6) ndarray
        The twist df f⁻¹ in the base frame per unit of η, where A_i ← Ad(e^η) A_i, rad and m.
    components : (6, 6) ndarray
        The same per unit of each component of A_i.
    columns : (3, 6, m, 6) ndarray
        Derivatives of the space, body and hybrid Jacobian by η.
    """

    twist: np.ndarray
    components: np.ndarray
    columns: np.ndarray


class HomeChanges(NamedTuple):
    """Derivatives of the motion of a chain by its home pose: twist and columns as in `ScrewChanges`,
    by η, where M ← M e^η.
    """

    twist: np.ndarray
    columns: np.ndarray


def home_changes(
    chain: Any,
    q: np.ndarray,
) -> HomeChanges:
    """Derivatives of pose and Jacobians by the home pose.

    Parameters
    ----------
    chain : Chain
        The chain.
    q : (m,) array_like
        Coordinates, rad or m.

    Returns
    -------
    changes : HomeChanges
        Derivatives, rounded to float64.
    """
    A = exact.exactly(chain.screws)
    M = exact.exactly(chain.home)
    turns = exact_chain.exponentials(A, exact_chain.displacements(chain, q))
    f = exact.product(turns) @ M

    def of_unit(unit: np.ndarray) -> tuple[np.ndarray, ...]:
        e = exact.exactly(unit)
        columns = derivative(
            lambda t: exact_chain.columns(chain, A, turns, M @ exact.exp(e * t)),
        )
        twist = space_twist(lambda t: f @ exact.exp(e * t), f)
        return exact.rounded(twist), exact.rounded(columns)

    return HomeChanges(*_by_unit(of_unit))


def screw_changes(
    chain: Any,
    q: np.ndarray,
    joint: int,
) -> ScrewChanges:
    """Derivatives of pose and Jacobians by one screw.

    Parameters
    ----------
    chain : Chain
        The chain.
    q : (m,) array_like
        Coordinates, rad or m.
    joint : int
        Number of the joint whose screw changes, from 0.

    Returns
    -------
    changes : ScrewChanges
        Derivatives, rounded to float64.
    """
    A = exact.exactly(chain.screws)
    M = exact.exactly(chain.home)
    x = exact_chain.displacements(chain, q)
    turns = exact_chain.exponentials(A, x)
    before = exact.product(turns[:joint])
    after = exact.product(turns[joint + 1 :]) @ M
    f = before @ turns[joint] @ after

    def of_unit(unit: np.ndarray) -> tuple[np.ndarray, ...]:
        e = exact.exactly(unit)

        def carried(t: Any) -> np.ndarray:
            return exact.adjoint(exact.exp(e * t)) @ A[joint]

        def turn(screw: np.ndarray) -> np.ndarray:
            return exact.exp(screw * x[joint])

        def columns(t: Any) -> np.ndarray:
            screw = carried(t)
            screws = [*A[:joint], screw, *A[joint + 1 :]]
            return exact_chain.columns(
                chain, screws, [*turns[:joint], turn(screw), *turns[joint + 1 :]], M
            )

        return (
            exact.rounded(space_twist(lambda t: before @ turn(carried(t)) @ after, f)),
            exact.rounded(space_twist(lambda t: before @ turn(A[joint] + e * t) @ after, f)),
            exact.rounded(derivative(columns)),
        )

    return ScrewChanges(*_by_unit(of_unit))


def _by_unit(of_unit: Callable[[np.ndarray], tuple[np.ndarray, ...]]) -> Iterator[np.ndarray]:
    """Each result of the six unit twists, along a last axis of six."""
    units = zip(*map(of_unit, np.eye(6)), strict=True)
    return (np.stack(parts, axis=-1) for parts in units)


def derivative(f: Curve) -> np.ndarray:
    """Derivative df/dt at t = 0, by a central difference.

    Parameters
    ----------
    f : callable
        Function of one number of `exact`, that returns an array of them.

    Returns
    -------
    df : (...) ndarray
        Numbers of `exact`, in the shape of f(0).
    """
    return (f(STEP) - f(-STEP)) / (2 * STEP)


def space_twist(
    f: Curve,
    T: np.ndarray,
) -> np.ndarray:
    """Twist df/dt T⁻¹ of a moving pose at t = 0.

    Parameters
    ----------
    f : callable
        Function of one number of `exact`, that returns a pose (4, 4) in the base frame.
    T : (4, 4) ndarray
        The pose f(0), in numbers of `exact`, rad and m.

    Returns
    -------
    V : (6,) ndarray
        Twist (ω; v) in the base frame, in numbers of `exact`.
    """
    X = derivative(f) @ exact.inverse(T)
    return np.concatenate([skew_part(X), X[:3, 3]])
