"""Laws of a serial chain as plain functions, and `CHAIN_LAWS`, the battery of them.

For functions of one's own that know nothing of chains, see `conform.laws.of_arms`.

Parameters: chain, `poekin.Chain` or what has its attributes and methods, with as many of them
replaced as one likes;
q, dq (m,), coordinates and rates, rad or m, and per s; batch (*shape, m); point (3,), of the tool's
frame, m; joint, its number; the frames of Jacobians are "space", "body", "hybrid" or a joint's.
Returns: error ÷ bound, 0 to 1; a pure number. Raises: LawViolation above 1, with the law, the
error, its bound, the arguments, and the chain's screws and home pose.
Truth is the product of exponentials in 60 digits, finite
differences on the group, and the laws that tie one function to another. Rotations and translations,
ω and v, are held apart; bounds are those of `budget` times a small number.
Source: Park 1994, Sections II to IV; f' = P f Q and the laws that follow from it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ...model.kinematics.pose_jacobian import FRAME_NAMES
from ..accuracy.error_bounds import UNIT
from ..oracles import differences, exact
from .laws import Law, check_bounds
from .measures import Pairs, of_twist, size


def displacements(chain: Any, q: np.ndarray) -> np.ndarray:
    """x = C q + c (n,), rad or m. Returns: x. Raises: nothing."""
    return chain.coupling @ q + chain.offset


def budget(chain: Any, q: np.ndarray) -> tuple[float, float]:
    """Bounds on the rounding of a pose: of its rotation, and of its translation, which grows with
    the arm.

    u (8 (n + 1) + 4 Σ |x_i|), and that times the reach and what the joints slide beyond it. Where
    the home pose's rotation R misses being one by δ = |R Rᵀ - I|, the forms are different motions:
    M e^{B x}, whose B = Ad(M)⁻¹ A takes Rᵀ for the inverse, turns otherwise by up to δ (1 + Σ
    |x_i|/2), and moves by up to δ (2 + Σ |x_i|/2) times the same. Returns: both, in rad and in m.
    Raises: nothing.
    """
    x = displacements(chain, q)
    R = chain.home[:3, :3]
    turned = float(np.abs(x).sum())
    missed = size(R @ R.T - np.eye(3))
    angular = UNIT * (8 * (len(x) + 1) + 4 * turned) + missed * (1 + turned / 2)
    return angular, (angular + missed) * (chain.reach + float(np.abs(chain.local.slides * x).sum()))


def fk_is_the_product_of_exponentials(chain: Any, q: np.ndarray) -> float:
    """f(q) = e^{A_1 x_1} ⋯ e^{A_n x_n} M, in 60 digits."""
    return check_chain_bounds(
        "fk is the product of exponentials",
        chain,
        *of_poses(chain, q, chain.fk(q), _exact_pose(chain, q)),
        q=q,
    )


def home_is_where_zero_leads(chain: Any) -> float:
    """f(0) = M where c = 0, and for any c the pose of the joints at c. Raises: LawViolation."""
    q = np.zeros(chain.dof)
    expected = chain.home
    if np.any(chain.offset):
        expected = _exact_pose(chain, q)
    return check_chain_bounds(
        "home is where zero leads", chain, *of_poses(chain, q, chain.fk(q), expected)
    )


def forms_agree(chain: Any, q: np.ndarray) -> float:
    """The space, body and local forms are one motion: f = Π e^{A x} M = M Π e^{B x} = M_1 e^{S x_1}
    ⋯ M_{n+1}.
    """
    x = exact_displacements(chain, q)
    f = chain.fk(q)
    space = exact.forward(chain.space.screws, chain.space.home, x)
    body = exact.exactly(chain.body.home) @ exact.forward(chain.body.screws, np.eye(4), x)
    factors = [chain.local.frames[0]]
    joints = zip(chain.local.rotates, chain.local.slides, x, strict=True)
    for (r, s, amount), M in zip(joints, chain.local.frames[1:], strict=True):
        S = exact.exactly([0, 0, r, 0, 0, s])
        factors += [exact.exp(S * amount), M]
    pairs: Pairs = []
    for form in (space, body, exact.product(factors)):
        pairs += of_poses(chain, q, f, form)
    return check_chain_bounds("forms agree", chain, *pairs, q=q)


def jacobian_is_the_derivative(
    chain: Any,
    q: np.ndarray,
    dq: np.ndarray,
) -> float:
    """J(q) dq is the velocity of f along dq by finite differences, in space, body and hybrid frame.

    For hybrid that says: its linear part is ḃ.
    """
    # The sum of the stencil's weights, over its step of 0.1/rate, is what a difference makes of
    # rounding.
    rate = float(np.abs(chain.local.rotates * (chain.coupling @ dq)).sum())
    angular, linear = (30 * max(rate, 1.0) * b for b in budget(chain, q))
    pairs: Pairs = []
    for frame in FRAME_NAMES:
        V = differences.velocity(chain.fk, q, dq, frame, rate)
        pairs += of_twist(chain.jacobian(q, frame) @ dq - V, angular, linear)
    return check_chain_bounds("jacobian is the derivative", chain, *pairs, q=q, dq=dq)


def space_jacobian_is_not_hybrid(
    chain: Any,
    q: np.ndarray,
    dq: np.ndarray,
) -> float:
    """The space Jacobian's linear part is ḃ - ω × b, not ḃ: it misses the hybrid one's by ω × b."""
    V = chain.jacobian(q, "space") @ dq
    H = chain.jacobian(q, "hybrid") @ dq
    expected = np.concatenate([H[:3], H[3:] - np.cross(H[:3], chain.fk(q)[:3, 3])])
    return check_chain_bounds(
        "space jacobian is not hybrid", chain, *of_twists(chain, q, dq, V - expected), q=q, dq=dq
    )


def body_jacobian_is_space_seen_from_the_tool(
    chain: Any,
    q: np.ndarray,
    dq: np.ndarray,
) -> float:
    """J_b = Ad(f⁻¹) J_s, that is J_s = Ad(f) J_b."""
    error = chain.jacobian(q, "space") - adjoint(chain.fk(q)) @ chain.jacobian(q, "body")
    return check_chain_bounds(
        "body jacobian is space seen from the tool",
        chain,
        *of_twists(chain, q, dq, error @ dq),
        q=q,
        dq=dq,
    )


def joint_poses_are_partial_products(
    chain: Any,
    q: np.ndarray,
    joint: int,
) -> float:
    """The z-aligned frame of joint k stands at e^{A_1 x_1} ⋯ e^{A_k x_k} (M_1 ⋯ M_k)."""
    expected = exact_joint_pose(chain, exact_displacements(chain, q), joint)
    pairs = of_poses(chain, q, chain.joint_poses(q)[joint], expected)
    return check_chain_bounds("joint poses are partial products", chain, *pairs, q=q, joint=joint)


def jacobian_in_a_joints_frame_is_space_seen_from_it(
    chain: Any, q: np.ndarray, dq: np.ndarray, joint: int
) -> float:
    """J_k = Ad(T_k⁻¹) J_s with T_k the pose of joint k's frame."""
    error = chain.jacobian(q, "space") - adjoint(chain.joint_poses(q)[joint]) @ chain.jacobian(
        q, joint
    )
    pairs = of_twists(chain, q, dq, error @ dq, 4.0)
    return check_chain_bounds(
        "jacobian in a joint's frame is space seen from it", chain, *pairs, q=q, dq=dq, joint=joint
    )


def velocity_is_the_jacobian_times_rates(
    chain: Any,
    q: np.ndarray,
    dq: np.ndarray,
) -> float:
    """The V recursion yields J(q) dq, in every frame."""
    pairs = []
    for frame in (*FRAME_NAMES, *range(len(chain.screws))):
        error = chain.velocity(q, dq, frame) - chain.jacobian(q, frame) @ dq
        pairs += of_twists(chain, q, dq, error, 4.0 if isinstance(frame, int) else 1.0)
    return check_chain_bounds("velocity is the jacobian times rates", chain, *pairs, q=q, dq=dq)


def one_pass_gives_both(
    chain: Any,
    q: np.ndarray,
    dq: np.ndarray,
) -> float:
    """fk_jacobian is fk and jacobian, in every frame."""
    pairs = []
    for frame in (*FRAME_NAMES, *range(len(chain.screws))):
        T, J = chain.fk_jacobian(q, frame)
        pairs += of_poses(chain, q, T, chain.fk(q))
        pairs += of_twists(chain, q, dq, (J - chain.jacobian(q, frame)) @ dq)
    return check_chain_bounds("one pass gives both", chain, *pairs, q=q, dq=dq)


def a_point_moves_as_the_tools_origin_would(
    chain: Any, q: np.ndarray, dq: np.ndarray, point: np.ndarray
) -> float:
    """With `at` = p the linear part is the velocity of p: v + ω × p in body axes, v + ω × R p in
    base axes.
    """
    R = chain.fk(q)[:3, :3]
    pairs = []
    for frame, arm in (("body", point), ("hybrid", R @ point)):
        V = chain.jacobian(q, frame) @ dq
        expected = np.concatenate([V[:3], V[3:] + np.cross(V[:3], arm)])
        T, J = chain.fk_jacobian(q, frame, at=point)
        error = np.stack([chain.jacobian(q, frame, at=point) @ dq - expected, J @ dq - expected])
        pairs += [
            (e, b * (1 + size(point)))
            for row in error
            for e, b in of_twists(chain, q, dq, row, 4.0)
        ]
        pairs += [(e, b * (1 + size(point))) for e, b in of_poses(chain, q, T, chain.fk(q))]
    return check_chain_bounds(
        "a point moves as the tool's origin would", chain, *pairs, q=q, dq=dq, point=point
    )


def batches_are_made_of_single_configurations(chain: Any, batch: np.ndarray) -> float:
    """Every function of a batch gives, element by element, what it gives for one configuration."""
    functions: list[Shaped] = [
        (chain.fk, (4, 4)),
        (chain.joint_poses, (len(chain.screws), 4, 4)),
        (lambda q: chain.velocity(q, q, "body"), (6,)),
    ]
    for frame in FRAME_NAMES:
        functions.append((lambda q, f=frame: chain.jacobian(q, f), (6, chain.dof)))
    return check_batch(
        "batches are made of single configurations",
        chain,
        batch,
        functions,
        bound=lambda q, one: budget(chain, q)[1] * (1 + size(q)),
    )


Shaped = tuple[Callable[[np.ndarray], np.ndarray], tuple[int, ...]]
"""A function of configurations, and the shape of its value for a single one."""


def check_batch(
    law: str,
    chain: Any,
    batch: np.ndarray,
    functions: Sequence[Shaped],
    bound: Callable[[np.ndarray, np.ndarray], float],
) -> float:
    """Check that functions of a batch are, element by element, those of single configurations.

    Parameters: law, its name; chain; batch (*shape, m); functions, with the shapes of their values;
    bound(q, value), of the error at one configuration. Returns: error ÷ bound. Raises: LawViolation.
    """
    shape = batch.shape[:-1]
    pairs: Pairs = []
    for function, tail in functions:
        together = function(batch)
        expected = (*shape, *tail)
        if together.shape != expected:
            return check_chain_bounds(
                "batches have their shape",
                chain,
                (np.inf, 0.0),
                shape=together.shape,
                expected=expected,
            )
        for index in np.ndindex(shape):
            q = batch[index]
            one = function(q)
            pairs.append((size(together[index] - one), bound(q, one)))
    return check_chain_bounds(law, chain, *pairs, batch=batch)


def adjoint(T: np.ndarray) -> np.ndarray:
    """Ad(T) = [R 0; [t] R R] (6, 6) of a pose T (4, 4), of floats, by NumPy alone. Returns: this.
    Raises: nothing.
    """
    R = T[:3, :3]
    x, y, z = T[:3, 3]
    corner = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]]) @ R
    return np.block([[R, np.zeros((3, 3))], [corner, R]])


def inverse(T: np.ndarray) -> np.ndarray:
    """The inverse (4, 4) of a pose T (4, 4), of floats, by NumPy alone. Returns: this. Raises:
    nothing.
    """
    R = T[:3, :3].T
    return np.block([[R, -(R @ T[:3, 3:])], [np.zeros((1, 3)), np.ones((1, 1))]])


def check_chain_bounds(
    law: str, chain: Any, *measured: tuple[float, float], **seen: object
) -> float:
    """As `check_bounds`, with the chain's numbers among what a violation says: without them nobody could
    repeat it.

    Parameters: law, its name; chain; measured, pairs (error, bound); seen, arguments by name.
    Returns: error ÷ bound.
    """
    seen = {**seen, "screws": chain.screws, "home": chain.home}
    if not np.array_equal(chain.coupling, np.eye(chain.dof)):
        seen |= {"coupling": chain.coupling, "offset": chain.offset}
    return check_bounds(law, *measured, **seen)


CHAIN_LAWS = (
    Law(fk_is_the_product_of_exponentials, ("q",)),
    Law(home_is_where_zero_leads, ()),
    Law(forms_agree, ("q",)),
    Law(jacobian_is_the_derivative, ("q", "dq")),
    Law(space_jacobian_is_not_hybrid, ("q", "dq")),
    Law(body_jacobian_is_space_seen_from_the_tool, ("q", "dq")),
    Law(joint_poses_are_partial_products, ("q", "joint")),
    Law(jacobian_in_a_joints_frame_is_space_seen_from_it, ("q", "dq", "joint")),
    Law(velocity_is_the_jacobian_times_rates, ("q", "dq")),
    Law(one_pass_gives_both, ("q", "dq")),
    Law(a_point_moves_as_the_tools_origin_would, ("q", "dq", "point")),
    Law(batches_are_made_of_single_configurations, ("batch",)),
)
"""The battery: each law with the kinds of its arguments after the chain
(`chain_strategies.chain_cases`).
"""


def exact_displacements(chain: Any, q: np.ndarray) -> np.ndarray:
    """x = C q + c (n,) in 80 digits. Returns: numbers of `exact`. Raises: nothing."""
    offset = exact.exactly(chain.offset)
    if not chain.dof:
        return offset
    return exact.exactly(chain.coupling) @ exact.exactly(q) + offset


def exact_joint_pose(
    chain: Any,
    x: np.ndarray,
    joint: int,
) -> np.ndarray:
    """Pose (4, 4) of a joint's z-aligned frame at displacements x (n,), in 80 digits.

    Returns: numbers of `exact`. Raises: nothing.
    """
    first = slice(joint + 1)
    return exact.forward(chain.screws[first], exact.product(chain.local.frames[first]), x[first])


def _exact_pose(chain: Any, q: np.ndarray) -> np.ndarray:
    x = exact_displacements(chain, q)
    return exact.rounded(exact.forward(chain.screws, chain.home, x))


def of_poses(
    chain: Any,
    q: np.ndarray,
    T: np.ndarray,
    expected: np.ndarray,
) -> Pairs:
    """The errors of R and t, and of the last row, with their bounds: of T (4, 4) against expected
    (4, 4).

    Returns: pairs (error, bound), rad and m. Raises: nothing.
    """
    angular, linear = budget(chain, q)
    error = T - np.asarray(expected, dtype=float)
    return [(size(error[:3, :3]), angular), (size(error[:3, 3]), linear), (size(error[3]), 0.0)]


def of_twists(
    chain: Any, q: np.ndarray, dq: np.ndarray, error: np.ndarray, factor: float = 1.0
) -> Pairs:
    """The errors of ω and v, of error (6,), with `factor` times the budget times the joints' rates
    as bounds.

    Returns: pairs (error, bound), rad/s and m/s. Raises: nothing.
    """
    angular, linear = budget(chain, q)
    rates = chain.coupling @ dq
    turning = size(chain.local.rotates * rates)
    sliding = size(chain.local.slides * rates)
    grown = factor * (1 + len(rates))
    return of_twist(error, grown * angular * turning, grown * linear * (turning + sliding))
