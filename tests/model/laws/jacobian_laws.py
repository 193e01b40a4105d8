"""Laws of the Jacobian of a serial chain, in every frame; `chain_laws.CHAIN_LAWS` has them.

The subject is `poekin.Chain` or what has its attributes and methods, with as many of them replaced
as one likes. A violation has the law, the error, its bound, the arguments, and the chain's
numbers.
Source: Park 1994, Sections III and IV.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from poekin.model.kinematics.pose_jacobian import FRAME_NAMES
from poekin.testing.laws.laws import Pairs
from poekin.testing.laws.measures import of_twist, size
from poekin.testing.oracles import differences
from tests.model.laws.chain_bounds import adjoint, budget, chain_law, of_poses, of_twists


@chain_law()
def jacobian_is_the_derivative(
    chain: Any,
    q: np.ndarray,
    dq: np.ndarray,
) -> Pairs:
    """Law: J(q) dq is the velocity of f along dq, by finite differences, in the three frames."""
    # The sum of the stencil's weights, over its step of 0.1/rate, is what a difference makes of
    # rounding.
    rate = float(np.abs(chain.local.rotates * (chain.coupling @ dq)).sum())
    angular, linear = (30 * max(rate, 1.0) * b for b in budget(chain, q))
    pairs: Pairs = []
    for frame in FRAME_NAMES:
        V = differences.velocity(chain.fk, q, dq, frame, rate)
        pairs += of_twist(chain.jacobian(q, frame) @ dq - V, angular, linear)
    return pairs


@chain_law()
def space_jacobian_is_not_hybrid(
    chain: Any,
    q: np.ndarray,
    dq: np.ndarray,
) -> Pairs:
    """Law: the linear part of the space Jacobian is ḃ - ω × b, and not the hybrid Jacobian's ḃ."""
    V = chain.jacobian(q, "space") @ dq
    H = chain.jacobian(q, "hybrid") @ dq
    expected = np.concatenate([H[:3], H[3:] - np.cross(H[:3], chain.fk(q)[:3, 3])])
    return of_twists(chain, q, dq, V - expected)


@chain_law()
def body_jacobian_is_space_seen_from_the_tool(
    chain: Any,
    q: np.ndarray,
    dq: np.ndarray,
) -> Pairs:
    """Law: the body Jacobian is the space Jacobian seen from the tool, J_b = Ad(f⁻¹) J_s."""
    error = chain.jacobian(q, "space") - adjoint(chain.fk(q)) @ chain.jacobian(q, "body")
    return of_twists(chain, q, dq, error @ dq)


@chain_law("jacobian in a joint's frame is space seen from it")
def jacobian_in_a_joints_frame_is_space_seen_from_it(
    chain: Any,
    q: np.ndarray,
    dq: np.ndarray,
    joint: int,
) -> Pairs:
    """Law: the Jacobian in a joint's frame is the space Jacobian, seen from that frame.

    J_k = Ad(T_k⁻¹) J_s with T_k the pose of joint k's frame.
    """
    seen = adjoint(chain.joint_poses(q)[joint]) @ chain.jacobian(q, joint)
    return of_twists(chain, q, dq, (chain.jacobian(q, "space") - seen) @ dq, 4.0)


@chain_law()
def velocity_is_the_jacobian_times_rates(
    chain: Any,
    q: np.ndarray,
    dq: np.ndarray,
) -> Pairs:
    """Law: the recursion of velocities yields J(q) dq, in every frame."""
    pairs: Pairs = []
    for frame in (*FRAME_NAMES, *range(len(chain.screws))):
        error = chain.velocity(q, dq, frame) - chain.jacobian(q, frame) @ dq
        pairs += of_twists(chain, q, dq, error, 4.0 if isinstance(frame, int) else 1.0)
    return pairs


@chain_law()
def one_pass_gives_both(
    chain: Any,
    q: np.ndarray,
    dq: np.ndarray,
) -> Pairs:
    """Law: `fk_jacobian` returns what `fk` and `jacobian` return, in every frame."""
    pairs: Pairs = []
    for frame in (*FRAME_NAMES, *range(len(chain.screws))):
        T, J = chain.fk_jacobian(q, frame)
        pairs += of_poses(chain, q, T, chain.fk(q))
        pairs += of_twists(chain, q, dq, (J - chain.jacobian(q, frame)) @ dq)
    return pairs


@chain_law("a point moves as the tool's origin would")
def a_point_moves_as_the_tools_origin_would(
    chain: Any,
    q: np.ndarray,
    dq: np.ndarray,
    point: np.ndarray,
) -> Pairs:
    """Law: with `at` = p the linear part is the velocity of p, v + ω × p in body axes."""
    R = chain.fk(q)[:3, :3]
    pairs: Pairs = []
    for frame, lever in (("body", point), ("hybrid", R @ point)):
        V = chain.jacobian(q, frame) @ dq
        expected = np.concatenate([V[:3], V[3:] + np.cross(V[:3], lever)])
        T, J = chain.fk_jacobian(q, frame, at=point)
        for found in (chain.jacobian(q, frame, at=point), J):
            pairs += of_twists(chain, q, dq, found @ dq - expected, 4.0)
        pairs += of_poses(chain, q, T, chain.fk(q))
    return [(error, bound * (1 + size(point))) for error, bound in pairs]
