"""Laws of a chain's derivatives, and `DERIVATIVE_LAWS`, the battery of them, made as
`chain_laws.CHAIN_LAWS` is.

Truth is the definition in 80 digits, differentiated by a central difference of step 1e-20: its own
error is 1e-39. Nothing is asked of the chain but its screws, home pose and coupling. Bounds are
those of `chain_laws.budget` times the rates and a small number.
Parameters: chain, `poekin.Chain` or what has its attributes and methods, with as many of them
replaced as one likes;
q, dq (m,), coordinates and rates, rad or m, and per s; batch (*shape, m); joint, its number;
the frames of Jacobians are "space", "body" and "hybrid".
Returns: error ÷ bound, 0 to 1; a pure number. Raises: LawViolation above 1, with the law, the
error, its bound, the arguments, and the chain's screws and home pose.
Source: Park 1994, Sections II to IV, by definition.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

import numpy as np

from ...model.kinematics.pose_jacobian import FRAME_NAMES
from ..oracles import exact
from .chain_laws import (
    Shaped,
    budget,
    check_batch,
    check_chain_bounds,
    exact_displacements,
    exact_joint_pose,
)
from .laws import Law
from .measures import Pairs, of_twist, size

STEP = exact.mp.mpf(10) ** -20


def jacobian_rate_is_the_derivative(
    chain: Any,
    q: np.ndarray,
    dq: np.ndarray,
) -> float:
    """dJ/dt along dq, in space, body and hybrid frame."""
    pairs = []
    truth = slope(lambda t: exact_jacobians(chain, line(t, q, dq)))
    for frame, rate in zip(FRAME_NAMES, truth, strict=True):
        pairs += _of_columns(chain, q, chain.jacobian_rate(q, dq, frame) - rate, _size(chain, dq))
    return check_chain_bounds("jacobian rate is the derivative", chain, *pairs, q=q, dq=dq)


def hessian_is_the_derivative(chain: Any, q: np.ndarray) -> float:
    """H[..., j] = dJ/dq_j for every coordinate."""
    pairs = []
    found = [chain.hessian(q, frame) for frame in FRAME_NAMES]
    for j, direction in enumerate(np.eye(chain.dof)):
        truth = slope(lambda t, d=direction: exact_jacobians(chain, line(t, q, d)))
        for H, rate in zip(found, truth, strict=True):
            pairs += _of_columns(chain, q, H[:, :, j] - rate, _size(chain, direction))
    return check_chain_bounds("hessian is the derivative", chain, *pairs, q=q)


def hessian_of_a_point_is_symmetric(chain: Any, q: np.ndarray) -> float:
    """The linear rows of the hybrid Hessian are second derivatives of p: to the last bit where
    nothing is coupled.
    """
    v = chain.hessian(q, "hybrid")[3:]
    error = size(v - np.swapaxes(v, 1, 2))
    bound = 0.0
    if chain.nontrivial_coupling is not None:
        bound = 8 * budget(chain, q)[1] * (1 + size(chain.coupling) ** 2)
    return check_chain_bounds("hessian of a point is symmetric", chain, (error, bound), q=q)


def acceleration_is_the_derivative_of_the_velocity(
    chain: Any, q: np.ndarray, dq: np.ndarray
) -> float:
    """d/dt of V along q + t dq + t²/2 ddq, with ddq = (dq, backwards) + q."""
    ddq = dq[::-1] + q

    def velocities(t: Any) -> np.ndarray:
        J = exact_jacobians(chain, line(t, q, dq))  # of second order, ddq is of no account to J
        if not chain.dof:
            return exact.exactly(np.zeros((3, 6)))
        return J @ line(t, dq, ddq)

    pairs = []
    grown = _size(chain, dq) ** 2 + _size(chain, ddq)
    for frame, truth in zip(FRAME_NAMES, slope(velocities), strict=True):
        error = chain.acceleration(q, dq, ddq, frame) - truth
        pairs += _of_columns(chain, q, error[:, None], grown)
    return check_chain_bounds(
        "acceleration is the derivative of the velocity", chain, *pairs, q=q, dq=dq
    )


def joint_velocities_are_those_of_the_joint_poses(
    chain: Any, q: np.ndarray, dq: np.ndarray
) -> float:
    """The twist of each z-aligned frame, by its pose's derivative, in space, body and hybrid frame."""
    found = {frame: chain.joint_velocities(q, dq, frame) for frame in FRAME_NAMES}
    pairs = []
    for k in range(len(chain.screws)):

        def pose(t: Any, k: int = k) -> np.ndarray:
            return exact_joint_pose(chain, exact_displacements(chain, line(t, q, dq)), k)

        T = pose(exact.mp.zero)
        dT = (pose(STEP) - pose(-STEP)) / (2 * STEP)
        truth = exact.rounded(_seen(_vee(dT @ exact.inverse(T))[:, None], T))
        for V, twist in zip(found.values(), truth, strict=True):
            pairs += _of_columns(chain, q, V[k][:, None] - twist, _size(chain, dq))
    return check_chain_bounds(
        "joint velocities are those of the joint poses", chain, *pairs, q=q, dq=dq
    )


def screw_derivatives_are_differences_on_the_group(
    chain: Any,
    q: np.ndarray,
    joint: int,
) -> float:
    """df f⁻¹ and dJ under A_i ← Ad(e^η) A_i and M ← M e^η, and df f⁻¹ under A_i ← A_i + dA."""
    truth = exact_changes(chain, q, joint)
    motion = chain.screw_derivatives(q)
    entries = chain.screw_derivatives(q, by="entries")
    angular, linear = budget(chain, q)
    reach = 1 + linear / angular
    x = float(chain.coupling[joint] @ q + chain.offset[joint])
    errors = [
        (motion.screws[:, joint] - truth.motion, 1.0),
        (entries.screws[:, joint] - truth.entries, 1 + abs(x)),
        (motion.home - truth.home, 1.0),
        (entries.home - truth.home, 1.0),
    ]
    grown = 1 + size(chain.coupling)
    for k, frame in enumerate(FRAME_NAMES):
        change = chain.jacobian_screw_derivatives(q, frame)
        errors.append((change.screws[:, :, joint] - truth.columns[k], reach * grown))
        errors.append((change.home - truth.home_columns[k], reach * grown))
    pairs: Pairs = []
    for error, weight in errors:
        # per unit of a twist, which at arm's length is as much as the reach
        bound = 16 * weight * reach
        pairs += of_twist(error, bound * angular, bound * linear)
    return check_chain_bounds(
        "screw derivatives are differences on the group", chain, *pairs, q=q, joint=joint
    )


class Changes(NamedTuple):
    """Truth for one joint: motion, entries and home (6, 6), rows of df f⁻¹, a column per unit of
    each of six numbers; columns and home_columns (3, 6, m, 6), of the Jacobian in each of
    FRAME_NAMES.
    """

    motion: np.ndarray
    entries: np.ndarray
    home: np.ndarray
    columns: np.ndarray
    home_columns: np.ndarray


def exact_changes(
    chain: Any,
    q: np.ndarray,
    joint: int,
) -> Changes:
    """Effects of unit changes of one screw and of the home pose, by central differences on the group
    in 80 digits.

    Returns: `Changes`, as floats. Raises: nothing.
    """
    x = exact_displacements(chain, q)
    A = exact.exactly(chain.screws)
    M = exact.exactly(chain.home)
    turns = _exponentials(A, x)
    before = exact.product(turns[:joint])
    after = exact.product(turns[joint + 1 :]) @ M
    pose = before @ turns[joint] @ after
    back = exact.inverse(pose)

    def twist(pose: Callable[[Any], np.ndarray]) -> np.ndarray:
        return exact.rounded(_vee((pose(STEP) - pose(-STEP)) / (2 * STEP) @ back))

    def one(unit: np.ndarray) -> tuple[np.ndarray, ...]:
        e = exact.exactly(unit)

        def carried(t: Any) -> np.ndarray:
            return exact.adjoint(exact.exp(e * t)) @ A[joint]

        def turn(screw: np.ndarray) -> np.ndarray:
            return exact.exp(screw * x[joint])

        def columns(screw: np.ndarray) -> np.ndarray:
            screws = [*A[:joint], screw, *A[joint + 1 :]]
            return _exact_columns(
                chain, screws, [*turns[:joint], turn(screw), *turns[joint + 1 :]], M
            )

        return (
            twist(lambda t: before @ turn(carried(t)) @ after),
            twist(lambda t: before @ turn(A[joint] + e * t) @ after),
            twist(lambda t: pose @ exact.exp(e * t)),
            slope(lambda t: columns(carried(t))),
            slope(lambda t: _exact_columns(chain, A, turns, M @ exact.exp(e * t))),
        )

    return Changes(*(np.stack(parts, axis=-1) for parts in zip(*map(one, np.eye(6)), strict=True)))


def derivatives_of_batches_are_those_of_single_configurations(
    chain: Any, batch: np.ndarray
) -> float:
    """Every derivative of a batch has, element by element, the bits that it has for one
    configuration.
    """
    n = len(chain.screws)
    m = chain.dof
    functions: list[Shaped] = []
    for frame in FRAME_NAMES:
        functions += [
            (lambda q, f=frame: chain.jacobian_rate(q, q, f), (6, m)),
            (lambda q, f=frame: chain.hessian(q, f), (6, m, m)),
            (lambda q, f=frame: chain.acceleration(q, q, q, f), (6,)),
            (lambda q, f=frame: chain.joint_velocities(q, q, f), (n, 6)),
            (lambda q, f=frame: chain.jacobian_screw_derivatives(q, f).screws, (6, m, n, 6)),
            (lambda q, f=frame: chain.jacobian_screw_derivatives(q, f).home, (6, m, 6)),
        ]
    for by in ("motion", "entries"):
        functions.append((lambda q, by=by: chain.screw_derivatives(q, by).screws, (6, n, 6)))
        functions.append((lambda q, by=by: chain.screw_derivatives(q, by).home, (6, 6)))
    # Products of matrices may be summed in another order in a batch.
    return check_batch(
        "derivatives of batches are those of single configurations",
        chain,
        batch,
        functions,
        bound=lambda q, one: 1e-14 * (1 + size(one)),
    )


def exact_jacobians(chain: Any, q: np.ndarray) -> np.ndarray:
    """J(q) (3, 6, m), a frame of FRAME_NAMES each, in 80 digits: screws carried by the exponentials
    before them.

    Returns: numbers of `exact`. Raises: nothing.
    """
    A = exact.exactly(chain.screws)
    turns = _exponentials(A, exact_displacements(chain, q))
    return _exact_columns(chain, A, turns, exact.exactly(chain.home))


def line(
    t: Any,
    q: np.ndarray,
    dq: np.ndarray,
) -> np.ndarray:
    """q + t dq (m,) in 80 digits. Returns: numbers of `exact`. Raises: nothing."""
    return exact.exactly(q) + exact.exactly(dq) * t


def slope(f: Callable[[Any], np.ndarray]) -> np.ndarray:
    """df/dt at 0 of a function f of one number in 80 digits. Returns: floats (...), f's shape.
    Raises: nothing.
    """
    return exact.rounded((f(STEP) - f(-STEP)) / (2 * STEP))


def _exponentials(A: np.ndarray, x: np.ndarray) -> list[np.ndarray]:
    return [exact.exp(screw * amount) for screw, amount in zip(A, x, strict=True)]


def _exact_columns(
    chain: Any, screws: Iterable[np.ndarray], turns: Iterable[np.ndarray], home: np.ndarray
) -> np.ndarray:
    T = exact.exactly(np.eye(4))
    columns = []
    for screw, turn in zip(screws, turns, strict=True):
        columns.append(exact.adjoint(T) @ screw)
        T = T @ turn
    if not chain.dof:
        return exact.exactly(np.zeros((3, 6, 0)))
    return _seen(np.array(columns, dtype=object).T @ exact.exactly(chain.coupling), T @ home)


def _seen(S: np.ndarray, T: np.ndarray) -> np.ndarray:
    """Space twists (6, k) of what stands at T in the three frames (3, 6, k), in the order of
    FRAME_NAMES.
    """
    moved = S[3:] + np.array([exact.cross(w, T[:3, 3]) for w in S[:3].T], dtype=object).T
    return np.stack([S, exact.adjoint(exact.inverse(T)) @ S, np.concatenate([S[:3], moved])])


def _vee(X: np.ndarray) -> np.ndarray:
    w = np.array([X[2, 1] - X[1, 2], X[0, 2] - X[2, 0], X[1, 0] - X[0, 1]], dtype=object) / 2
    return np.concatenate([w, X[:3, 3]])


def _size(chain: Any, dq: np.ndarray) -> float:
    """Sum of the joints' speeds, in rad/s and m/s."""
    return float(np.abs(chain.coupling @ dq).sum())


def _of_columns(
    chain: Any,
    q: np.ndarray,
    error: np.ndarray,
    rates: float,
) -> Pairs:
    """The errors of the angular and the linear rows of columns, against the budget times the rates."""
    angular, linear = budget(chain, q)
    grown = 8 * rates * (1 + size(chain.coupling))
    return of_twist(error, grown * angular, grown * linear)


DERIVATIVE_LAWS = (
    Law(jacobian_rate_is_the_derivative, ("q", "dq")),
    Law(hessian_is_the_derivative, ("q",)),
    Law(hessian_of_a_point_is_symmetric, ("q",)),
    Law(acceleration_is_the_derivative_of_the_velocity, ("q", "dq")),
    Law(joint_velocities_are_those_of_the_joint_poses, ("q", "dq")),
    Law(screw_derivatives_are_differences_on_the_group, ("q", "joint")),
    Law(derivatives_of_batches_are_those_of_single_configurations, ("batch",)),
)
"""The battery: each law with the kinds of its arguments after the chain
(`chain_strategies.chain_cases`).
"""
