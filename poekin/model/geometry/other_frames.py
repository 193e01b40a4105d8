"""One arm seen from another base frame, with another tool frame, or from other zero positions."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ...errors import InputError
from ...groups import se3
from ...groups.arrays import Array
from ..chain_data import AnyChain
from ..checks import one_pose
from ..coordinates import coordinates


def rebased(chain: AnyChain, P: ArrayLike, base: str | None) -> AnyChain:
    """f' = P f: A' = Ad(P) A, M' = P M."""
    P = one_pose(P, "P")
    screws = chain.screws @ se3.adjoint(P).T
    return chain.replace(
        screws=screws,
        home=P @ chain.home,
        base=base or chain.base,
        pitches=chain.pitches,
        masses=_moved_masses(chain.masses, P),
    )


def retooled(chain: AnyChain, Q: ArrayLike, tip: str | None) -> AnyChain:
    """f' = f Q: M' = M Q."""
    return chain.replace(home=chain.home @ one_pose(Q, "Q"), tip=tip or chain.tip)


def rezeroed(chain: AnyChain, q0: Any) -> AnyChain:
    """f'(q) = f(q + q0): each screw moved by the joints before it, each from 0 to its new zero."""
    q0 = coordinates(q0, chain.q_names, "q0")
    if q0.ndim != 1 or not np.isfinite(q0).all():
        raise InputError(f"q0: expected one finite configuration ({chain.dof},), got {q0.tolist()}")
    C = chain.nontrivial_coupling
    shifts = q0 if C is None else C @ q0
    A = np.empty_like(chain.screws)
    P = np.eye(4)
    moved = []
    for i, S in enumerate(chain.screws):
        A[i] = se3.adjoint(P) @ S
        P = P @ se3.exp(S * shifts[i])
        moved.append(P)
    return chain.replace(
        screws=A,
        home=P @ chain.home,
        limits=chain.limits - q0[:, None],
        joint_limits=chain.joint_limits - shifts[:, None],
        pitches=chain.pitches,
        masses=_moved_masses(chain.masses, moved),
    )


def without_offset(chain: AnyChain) -> AnyChain:
    """A chain without coupling, its offset taken into the zero."""
    if not chain.offset.any():
        return chain
    return rezeroed(chain.replace(offset=np.zeros(chain.dof)), chain.offset)


def _moved_masses(masses: Array | None, P: ArrayLike) -> Array | None:
    """Rows (n, 4) of mass and centre of mass, each moved by P (4, 4) or its own of P (n, 4, 4)."""
    if masses is None:
        return None
    moves = np.broadcast_to(P, (len(masses), 4, 4))
    turned = np.einsum("nij,nj->ni", moves[:, :3, :3], masses[:, 1:])
    centres = turned + moves[:, :3, 3]
    return np.column_stack([masses[:, 0], centres])
