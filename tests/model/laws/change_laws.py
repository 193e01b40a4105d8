"""Laws of a changed chain: other base, other tool, other zero position, other link frames; and
`CHANGE_LAWS`.

f' = P f Q makes A' = Ad(P) A, B' = Ad(Q)⁻¹ B and M' = P M Q; f'(q) = f(q + q0) moves the zero
position; and where the link frames sit changes neither A nor M: that is the paper's uniqueness.
Parameters: chain, `poekin.Chain` or what has its attributes and methods, with as many of them
replaced as one likes;
q (m,), coordinates, rad or m; q0 (m,), added to them; P, Q (4, 4), poses of the old base in the new
one, and of the new tool in the old one, m; frames (n, 2, 4, 4), poses of joints and links in the
base frame.
Returns: error ÷ bound, 0 to 1; a pure number. Raises: LawViolation above 1, with the law, the
error, its bound, the arguments, and the chain's screws and home pose.
Source: Park 1994, Section II.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from poekin.model.joint import Joint
from poekin.model.kinematics.pose_jacobian import FRAME_NAMES
from poekin.model.robot import Robot
from poekin.testing.laws.laws import Law, Pairs
from poekin.testing.laws.measures import of_twist, size
from tests.model.laws.chain_bounds import (
    adjoint,
    budget,
    chain_law,
    check_chain_bounds,
    inverse,
    of_poses,
)


@chain_law()
def a_rebased_chain_is_seen_from_another_base(
    chain: Any,
    q: np.ndarray,
    P: np.ndarray,
) -> Pairs:
    """f' = P f, A' = Ad(P) A, M' = P M, B' = B; J_s' = Ad(P) J_s, J_b' = J_b."""
    other = chain.rebased(P)
    grown = 8 * (1 + size(P[:3, 3]))
    pairs = of_poses(chain, q, other.fk(q), P @ chain.fk(q)) + of_poses(
        chain, q, other.home, P @ chain.home
    )
    errors = (
        other.screws - chain.screws @ adjoint(P).T,
        other.body.screws - chain.body.screws,
        (other.jacobian(q, "space") - adjoint(P) @ chain.jacobian(q, "space")).T,
        (other.jacobian(q, "body") - chain.jacobian(q, "body")).T,
    )
    pairs += _of_screws(chain, q, errors)
    return [(e, grown * b) for e, b in pairs]


@chain_law()
def a_retooled_chain_carries_another_tool(
    chain: Any,
    q: np.ndarray,
    Q: np.ndarray,
) -> Pairs:
    """f' = f Q, A' = A, M' = M Q, B' = Ad(Q)⁻¹ B; J_s' = J_s, J_b = Ad(Q) J_b'."""
    other = chain.retooled(Q)
    grown = 8 * (1 + size(Q[:3, 3]))
    pairs = of_poses(chain, q, other.fk(q), chain.fk(q) @ Q) + of_poses(
        chain, q, other.home, chain.home @ Q
    )
    errors = (
        other.screws - chain.screws,
        other.body.screws @ adjoint(Q).T - chain.body.screws,
        (other.jacobian(q, "space") - chain.jacobian(q, "space")).T,
        (adjoint(Q) @ other.jacobian(q, "body") - chain.jacobian(q, "body")).T,
    )
    pairs += _of_screws(chain, q, errors)
    return [(e, grown * b) for e, b in pairs]


@chain_law()
def a_rezeroed_chain_starts_elsewhere(
    chain: Any,
    q: np.ndarray,
    q0: np.ndarray,
) -> Pairs:
    """f'(q) = f(q + q0), J'(q) = J(q + q0) in every frame, and limits move by -q0."""
    other = chain.rezeroed(q0)
    there = q + q0
    pairs = of_poses(chain, there, other.fk(q), chain.fk(there))
    pairs += of_poses(chain, q0, other.fk(np.zeros_like(q)), chain.fk(q0))
    errors = [(other.jacobian(q, frame) - chain.jacobian(there, frame)).T for frame in FRAME_NAMES]
    pairs += _of_screws(chain, there, errors)
    shifted = np.array_equal(other.limits, chain.limits - q0[:, None])
    grown = 4 * (1 + size(q) + size(q0))
    return [*((e, grown * b) for e, b in pairs), (float(not shifted), 0.0)]


def reattached(chain: Any, frames: np.ndarray) -> Any:
    """Chain of a robot with the arm's screws and the given joint and link frames.

    frames (n, 2, 4, 4), poses in the base at home: of each joint's frame, which is shifted onto the
    axis where the joint turns, and of the link behind it. Between the two lies a fixed joint.
    Returns: `poekin.Chain`. Raises: nothing.
    """
    joints = []
    links = ["base"]
    at = np.eye(4)
    for k, (S, kind, (P, G)) in enumerate(zip(chain.screws, chain.kinds, frames, strict=True)):
        turns = kind != "prismatic"
        axis = S[:3] if turns else S[3:]
        P = P.copy()
        if turns:
            P[:3, 3] = np.cross(axis, S[3:]) + axis * (axis @ P[:3, 3])
        pitch = float(axis @ S[3:]) * (kind == "helical")
        own = P[:3, :3].T @ axis
        joints.append(
            Joint(f"joint{k}", kind, links[-1], f"moved{k}", inverse(at) @ P, own, pitch=pitch)
        )
        joints.append(Joint(f"fixed{k}", "fixed", f"moved{k}", f"link{k}", inverse(P) @ G))
        links += [f"moved{k}", f"link{k}"]
        at = G
    joints.append(Joint("tool", "fixed", links[-1], "tip", inverse(at) @ chain.home))
    return Robot("arm", [*links, "tip"], joints).chain("base", "tip")


def link_frames_do_not_matter(
    chain: Any, frames: np.ndarray, built: Callable[[Any, np.ndarray], Any] = reattached
) -> float:
    """Re-attaching every joint's and link's frame at random leaves A and M as they were: the
    paper's uniqueness.

    `built(chain, frames)` makes the chain anew from a robot with those frames; by default
    `reattached`.
    """
    other = built(chain, frames)
    unit, linear = budget(chain, np.zeros(chain.dof))
    grown = 8 * linear * (1 + size(frames[:, :, :3, 3]))
    if other.screws.shape != chain.screws.shape:
        return check_chain_bounds("link frames do not matter", chain, (np.inf, 0.0), frames=frames)
    return check_chain_bounds(
        "link frames do not matter",
        chain,
        (size(other.screws[:, :3] - chain.screws[:, :3]), 8 * unit),
        (size(other.screws[:, 3:] - chain.screws[:, 3:]), grown),
        (size(other.home[:3, :3] - chain.home[:3, :3]), 8 * unit),
        (size(other.home[:3, 3] - chain.home[:3, 3]), grown),
        frames=frames,
    )


CHANGE_LAWS = (
    Law(a_rebased_chain_is_seen_from_another_base, ("q", "pose")),
    Law(a_retooled_chain_carries_another_tool, ("q", "pose")),
    Law(a_rezeroed_chain_starts_elsewhere, ("q", "dq")),
    Law(link_frames_do_not_matter, ("frames",)),
)
"""The battery: each law with the kinds of its arguments after the chain
(`chain_cases.chain_cases`).
"""


def _of_screws(
    chain: Any,
    q: np.ndarray,
    errors: Sequence[np.ndarray],
) -> Pairs:
    """The errors of rows (ω; v), each half with its budget, for every joint or coordinate."""
    angular, linear = budget(chain, q)
    ratios = 1 + size(chain.coupling)
    pairs: Pairs = []
    for error in errors:
        pairs += of_twist(error.T, ratios * angular, ratios * linear)
    return pairs
