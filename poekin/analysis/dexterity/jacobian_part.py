"""Parts of a Jacobian: the tool's whole motion, its translation, or its rotation."""

from __future__ import annotations

from functools import lru_cache
from typing import Literal

import numpy as np

from ...errors import InputError
from ...groups.arrays import Array
from ...model.chain import Chain
from ...model.kinematics.arm import Arm, chain_of
from ...model.sampling import half_range, joint_ratios

Part = Literal["pose", "translation", "rotation"]

ROWS: dict[Part, slice] = {
    "pose": slice(None),
    "translation": slice(3, None),
    "rotation": slice(None, 3),
}

TOLERANCE = 1e-3
"""Quotient of a singular value and the largest, up to which a motion counts as lost."""
SAMPLES = 64
"""Random configurations at one of which the Jacobian has its largest rank."""


def moving_chain(arm: Arm) -> Chain:
    """The chain of an arm that has a coordinate. Raises: InputError for any other."""
    chain = chain_of(arm)
    if not chain.dof:
        raise InputError("the chain has no coordinate: nothing moves its tool")
    return chain


def scaled(
    X: Array,
    axis: int,
    part: Part,
    length: float,
) -> Array:
    """The rows of a part, along an axis of J (-2) or of its Hessian (-3); of the pose with v ÷
    length.
    """
    behind = -1 - axis
    if part == "pose":
        weights = np.repeat([1.0, 1.0 / length], 3)
        return X * weights.reshape(6, *[1] * behind)
    all_behind = [slice(None)] * behind
    return X[(..., ROWS[part], *all_behind)]


def svd(J: Array) -> tuple[Array, Array, Array]:
    """The factors U (..., k, r), s (..., r) and V^T (..., r, m) of J = U diag(s) V^T.

    Where an entry of J is NaN, s is.
    """
    finite = np.isfinite(J).all(axis=(-2, -1), keepdims=True)
    bad = np.asarray(~finite)
    numbers = np.where(bad, 0.0, J)
    U, s, V = np.linalg.svd(numbers, full_matrices=False)
    s = np.where(bad[..., 0], np.nan, s)
    return U, s, V


def random_configurations(chain: Chain) -> Array:
    """Configurations (SAMPLES, m), at one of which a Jacobian has its largest rank."""
    rng = np.random.default_rng(0)
    shares = rng.uniform(-1.0, 1.0, (SAMPLES, chain.dof))
    return half_range(chain) * shares


def largest_rank(
    J: Array,
    reach: float,
    part: Part,
    tolerance: float = TOLERANCE,
) -> int:
    """The largest rank of a part of hybrid Jacobians (N, 6, m) per rad or m of the joints.

    Lengths are in units of the arm's own size, so that it does not matter.
    """
    longest = float(np.abs(J[:, 3:]).max())
    length = max(longest, 1e-6 * reach)
    J = scaled(J, -2, "pose", length)
    _, s, _ = svd(J[:, ROWS[part]])
    # Below that is rounding: an arm that never moves its tool in this part.
    least = np.maximum(tolerance * s[:, :1], 1e-9)
    ranks = (s > least).sum(axis=1)
    return int(ranks.max())


@lru_cache(maxsize=64)
def generic_rank(chain: Chain, part: Part, tolerance: float = TOLERANCE) -> int:
    """The largest rank of a part of the Jacobian over all configurations, which it has at almost
    every one of them, in whatever units the coordinates are.
    """
    q = random_configurations(chain)
    J = chain.jacobian(q, "hybrid") / joint_ratios(chain)
    return largest_rank(J, chain.reach, part, tolerance)
