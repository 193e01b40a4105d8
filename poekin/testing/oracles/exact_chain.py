"""Kinematics of a serial chain in 80 digits, by the definition: poses and Jacobians.

A chain is `poekin.Chain`, or anything with its `screws` (n, 6), `home` (4, 4), `coupling` (n, m),
`offset` (n,) and `dof` m, in the base frame, rad and m; nothing else is asked of it.
Raises: nothing beside what `exact` does. Accuracy: 60 digits and more. Source: Park 1994, eqs. (1)
and (11): f(q) = e^{A_1 x_1} ⋯ e^{A_n x_n} M, x = C q + c.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from . import exact


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
    return columns(chain, A, exponentials(A, displacements(chain, q)), exact.exactly(chain.home))


def exponentials(
    screws: np.ndarray,
    x: np.ndarray,
) -> list[np.ndarray]:
    """Exponentials e^{A_i x_i} of the joints.

    Parameters
    ----------
    screws : (n, 6) ndarray
        Screws of the joints, (ω; v) in the base frame, in numbers of `exact`, rad and m.
    x : (n,) ndarray
        Displacements of the joints, in numbers of `exact`, rad or m.

    Returns
    -------
    turns : list of (4, 4) ndarray
        One pose a joint.
    """
    return [exact.exp(screw * amount) for screw, amount in zip(screws, x, strict=True)]


def columns(
    chain: Any,
    screws: Iterable[np.ndarray],
    turns: Iterable[np.ndarray],
    home: np.ndarray,
) -> np.ndarray:
    """Space, body and hybrid Jacobian for screws, their exponentials and a home pose.

    Parameters
    ----------
    chain : Chain
        The chain, of which the coupling is read.
    screws : iterable of (6,) ndarray
        Screws of the joints, (ω; v) in the base frame, rad and m.
    turns : iterable of (4, 4) ndarray
        Exponentials e^{A_i x_i} of the screws.
    home : (4, 4) ndarray
        Home pose in the base frame.

    Returns
    -------
    J : (3, 6, m) ndarray
        Numbers of `exact`, as `jacobians` returns them.
    """
    T = exact.exactly(np.eye(4))
    columns = []
    for screw, turn in zip(screws, turns, strict=True):
        columns.append(exact.adjoint(T) @ screw)
        T = T @ turn
    if not chain.dof:
        return exact.exactly(np.zeros((3, 6, 0)))
    return in_frames(np.array(columns, dtype=object).T @ exact.exactly(chain.coupling), T @ home)


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
