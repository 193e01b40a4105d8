"""Relations of two neighbouring axes, which hold at every q, and arms with a joint locked."""

from __future__ import annotations

import numpy as np

from ...analysis.axis_lines import sine
from ...groups import se3
from ...groups.arrays import Array
from ...groups.vectors import angular_part, linear_part, norm
from ...model.chain import Chain
from ..ik_all.structure import EXACT


def parallel(chain: Chain, i: int) -> bool:
    """Whether the axes of joints i and i + 1, from 0, are parallel to rounding; both turn."""
    if "prismatic" in chain.kinds[i : i + 2]:
        return False
    w = chain.screws[i, :3]
    u = chain.screws[i + 1, :3]
    return sine(w, u) <= EXACT


def intersecting(chain: Chain, i: int) -> bool:
    """Whether the axes of joints i and i + 1, from 0, intersect to rounding, and are not parallel."""
    if chain.kinds[i : i + 2] != ("revolute",) * 2 or parallel(chain, i):
        return False
    return _common_normal(chain.screws[i], chain.screws[i + 1]) <= EXACT * chain.reach


def locked(chain: Chain, k: int, value: float) -> Chain:
    """The chain without joint k, which stays at a value, rad or m; its own joint variables."""
    S = chain.screws[k]
    T = se3.exp(S * value)
    kept = [i for i in range(len(chain.kinds)) if i != k]
    screws = chain.screws.copy()
    screws[k + 1 :] = screws[k + 1 :] @ se3.adjoint(T).T
    return Chain.from_space(
        screws[kept],
        T @ chain.home,
        joint_names=[chain.joint_names[i] for i in kept],
        pitches=chain.pitches[kept],
    )


def _common_normal(A: Array, B: Array) -> float:
    """Length of the common normal of two axes, m."""
    normal = np.cross(angular_part(A), angular_part(B))
    moment = angular_part(A) @ linear_part(B) + angular_part(B) @ linear_part(A)
    return abs(float(moment)) / norm(normal)
