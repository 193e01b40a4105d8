"""Targets that have no solution, known without poekin's solver: beyond the reach, and only outside
the limits.
"""

from __future__ import annotations

import numpy as np

from poekin import Chain, so3

from .inverse_kinematics_peers import ClosedForm, outside

ROUNDS = 20
CLEARLY = 1e-6  # rad: a solution nearer to a limit than this decides nothing


def beyond_reach(chain: Chain, rng: np.random.Generator, count: int) -> np.ndarray:
    """Poses (count, 4, 4) farther from the base's origin than the chain's reach, by 1e-6 to 1 of
    it.
    """
    T = np.tile(np.eye(4), (count, 1, 1))
    way = rng.normal(size=(count, 3))
    distance = chain.reach * (1 + 10 ** rng.uniform(-6, 0, (count, 1)))
    T[:, :3, 3] = distance * way / np.linalg.norm(way, axis=1, keepdims=True)
    T[:, :3, :3] = so3.exp(rng.normal(size=(count, 3)))
    return T


def tightened(chain: Chain, part: float) -> Chain:
    """The same arm with this part of its limits, about their middle."""
    lower, upper = chain.limits.T
    middle, half = (lower + upper) / 2, part * (upper - lower) / 2
    limits = np.stack([middle - half, middle + half], 1)
    return Chain.from_space(chain.screws, chain.home, joint_names=chain.joint_names, limits=limits)


def blocked_poses(chain: Chain, rng: np.random.Generator, count: int) -> tuple[np.ndarray, int]:
    """Poses (count, 4, 4) of an arm none of whose solutions by EAIK lies within its limits,
    whatever turns are added; and how many were passed over because EAIK did not find the
    configuration that they were made of.

    Raises: ValueError where EAIK has no closed form for the arm, and where the limits block too
    few.
    """
    form, found, passed = ClosedForm(chain), [], 0
    for _ in range(ROUNDS):
        if len(found) >= count:
            return np.stack(found[:count]), passed
        q = rng.uniform(-np.pi, np.pi, (count, chain.dof))
        T = chain.fk(q)
        for own, pose, target in zip(q, T, form.native(T), strict=True):
            each = form.exact(form.all_of(target), pose)
            off = np.abs((each - own + np.pi) % (2 * np.pi) - np.pi).max(axis=1, initial=0.0)
            if not (off < CLEARLY).any():
                passed += 1
            elif outside(chain.limits, each)[0].min() > CLEARLY:
                found.append(pose)
    raise ValueError(
        f"only {len(found)} of {ROUNDS * count} poses are blocked by the limits, {count} were asked for"
    )
