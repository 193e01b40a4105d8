"""Kinematics of a serial chain in 80 digits, by the definition: poses, Jacobians, their derivatives.

A chain is `poekin.Chain`, or anything with its `screws` (n, 6), `home` (4, 4), `coupling` (n, m),
`offset` (n,) and `dof` m, in the base frame, rad and m; nothing else is asked of it. Derivatives are
central differences of step 1e-20, whose own error is 1e-39.
Raises: nothing beside what `exact` does. Accuracy: 30 digits and more. Source: Park 1994, eqs. (1)
and (11): f(q) = e^{A_1 x_1} ⋯ e^{A_n x_n} M, x = C q + c.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

import numpy as np

from . import exact
from .exact_numbers import skew_part

STEP = exact.mp.mpf(10) ** -20
Curve = Callable[[Any], np.ndarray]


class ScrewChanges(NamedTuple):
    """Derivatives of the motion of a chain by one screw and by its home pose.

    Attributes
    ----------
    twist : (6, 6) ndarray
        The twist df f⁻¹ in the base frame per unit of η, where A_i ← Ad(e^η) A_i, rad and m.
    components : (6, 6) ndarray
        The same per unit of each component of A_i.
    home : (6, 6) ndarray
        The same per unit of η, where M ← M e^η.
    columns : (3, 6, m, 6) ndarray
        Derivatives of the space, body and hybrid Jacobian by the η of the screw.
    home_columns : (3, 6, m, 6) ndarray
        Derivatives of the three Jacobians by the η of the home pose.
    """

    twist: np.ndarray
    components: np.ndarray
    home: np.ndarray
    columns: np.ndarray
    home_columns: np.ndarray


def displacements(
    chain: Any,
    q: np.ndarray,
) -> np.ndarray:
    """Displacements of the joints, x = C q + c.

    Parameters
    ----------
    chain : Chain
        The chain.
    q : (m,) array_like
        Coordinates, rad or m.

    Returns
    -------
    x : (n,) ndarray
        Numbers of `exact`, rad or m.
    """
    offset = exact.exactly(chain.offset)
    if not chain.dof:
        return offset
    return exact.exactly(chain.coupling) @ exact.exactly(q) + offset


def pose(
    chain: Any,
    q: np.ndarray,
) -> np.ndarray:
    """Pose of the tool, f(q).

    Parameters
    ----------
    chain : Chain
        The chain.
    q : (m,) array_like
        Coordinates, rad or m.

    Returns
    -------
    T : (4, 4) ndarray
        Numbers of `exact`, in the base frame.
    """
    return exact.forward(chain.screws, chain.home, displacements(chain, q))


def joint_pose(
    chain: Any,
    q: np.ndarray,
    joint: int,
) -> np.ndarray:
    """Pose of the z-aligned frame of a joint, e^{A_1 x_1} ⋯ e^{A_k x_k} M_1 ⋯ M_k.

    Parameters
    ----------
    chain : Chain
        The chain, with its local form.
    q : (m,) array_like
        Coordinates, rad or m.
    joint : int
        Number k of the joint, from 0.

    Returns
    -------
    T : (4, 4) ndarray
        Numbers of `exact`, in the base frame.
    """
    first = slice(joint + 1)
    x = displacements(chain, q)
    return exact.forward(chain.screws[first], exact.product(chain.local.frames[first]), x[first])


def jacobians(
    chain: Any,
    q: np.ndarray,
) -> np.ndarray:
    """Space, body and hybrid Jacobian: screws carried by the exponentials before them.

    Parameters
    ----------
    chain : Chain
        The chain.
    q : (m,) array_like
        Coordinates, rad or m.

    Returns
    -------
    J : (3, 6, m) ndarray
        Numbers of `exact`, rows (ω; v), in the three frames in this order, rad and m per unit of q.
    """
    A = exact.exactly(chain.screws)
    turns = _exponentials(A, displacements(chain, q))
    return _columns(chain, A, turns, exact.exactly(chain.home))


def screw_changes(
    chain: Any,
    q: np.ndarray,
    joint: int,
) -> ScrewChanges:
    """Derivatives of pose and Jacobians by one screw and by the home pose.

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
    x = displacements(chain, q)
    turns = _exponentials(A, x)
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
            return _columns(chain, screws, [*turns[:joint], turn(screw), *turns[joint + 1 :]], M)

        return (
            exact.rounded(space_twist(lambda t: before @ turn(carried(t)) @ after, f)),
            exact.rounded(space_twist(lambda t: before @ turn(A[joint] + e * t) @ after, f)),
            exact.rounded(space_twist(lambda t: f @ exact.exp(e * t), f)),
            exact.rounded(derivative(columns)),
            exact.rounded(derivative(lambda t: _columns(chain, A, turns, M @ exact.exp(e * t)))),
        )

    units = zip(*map(of_unit, np.eye(6)), strict=True)
    return ScrewChanges(*(np.stack(parts, axis=-1) for parts in units))


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


def in_frames(
    S: np.ndarray,
    T: np.ndarray,
) -> np.ndarray:
    """Space twists of a frame at T, as seen in the space, body and hybrid frame.

    Parameters
    ----------
    S : (6, k) ndarray
        Twists (ω; v) in the base frame, as columns of numbers of `exact`, rad and m.
    T : (4, 4) ndarray
        Pose of the moving frame in the base frame.

    Returns
    -------
    V : (3, 6, k) ndarray
        The twists in the three frames in this order.
    """
    t = T[:3, 3]
    carried = np.array([exact.cross(w, t) for w in S[:3].T], dtype=object).T
    body = exact.adjoint(exact.inverse(T)) @ S
    hybrid = np.concatenate([S[:3], S[3:] + carried])
    return np.stack([S, body, hybrid])


def _exponentials(
    A: np.ndarray,
    x: np.ndarray,
) -> list[np.ndarray]:
    return [exact.exp(screw * amount) for screw, amount in zip(A, x, strict=True)]


def _columns(
    chain: Any,
    screws: Iterable[np.ndarray],
    turns: Iterable[np.ndarray],
    home: np.ndarray,
) -> np.ndarray:
    T = exact.exactly(np.eye(4))
    columns = []
    for screw, turn in zip(screws, turns, strict=True):
        columns.append(exact.adjoint(T) @ screw)
        T = T @ turn
    if not chain.dof:
        return exact.exactly(np.zeros((3, 6, 0)))
    return in_frames(np.array(columns, dtype=object).T @ exact.exactly(chain.coupling), T @ home)
