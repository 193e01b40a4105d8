"""Laws of a chain's derivatives, and `DERIVATIVE_LAWS`, the battery of them, made as
`chain_laws.CHAIN_LAWS` is.

Truth is the definition in 80 digits, differentiated by a central difference of step 1e-20: its own
error is 1e-39. Nothing is asked of the chain but its screws, home pose and coupling. Bounds are
those of `chain_bounds.budget` times the rates and a small number.
Parameters: chain, `poekin.Chain` or what has its attributes and methods, with as many of them
replaced as one likes;
q, dq (m,), coordinates and rates, rad or m, and per s; batch (*shape, m); joint, its number;
the frames of Jacobians are "space", "body" and "hybrid".
Returns: error ÷ bound, 0 to 1; a pure number. Raises: LawViolation above 1, with the law, the
error, its bound, the arguments, and the chain's screws and home pose.
Source: Park 1994, Sections II to IV, by definition.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from benchmarks import exact_derivatives
from poekin.model.kinematics.pose_jacobian import FRAME_NAMES
from poekin.testing.laws.laws import Law, Pairs
from poekin.testing.laws.measures import of_twist, size
from poekin.testing.oracles import exact, exact_chain
from tests.model.laws.chain_bounds import Shaped, budget, chain_law, check_batch
from tests.model.laws.chain_laws import joint_pose


@chain_law()
def jacobian_rate_is_the_derivative(
    chain: Any,
    q: np.ndarray,
    dq: np.ndarray,
) -> Pairs:
    """dJ/dt along dq, in space, body and hybrid frame."""
    pairs: Pairs = []
    truth = slope(lambda t: exact_chain.jacobians(chain, along(t, q, dq)))
    for frame, rate in zip(FRAME_NAMES, truth, strict=True):
        pairs += _of_columns(chain, q, chain.jacobian_rate(q, dq, frame) - rate, _size(chain, dq))
    return pairs


@chain_law()
def hessian_is_the_derivative(chain: Any, q: np.ndarray) -> Pairs:
    """H[..., j] = dJ/dq_j for every coordinate."""
    pairs: Pairs = []
    found = [chain.hessian(q, frame) for frame in FRAME_NAMES]
    for j, direction in enumerate(np.eye(chain.dof)):
        truth = slope(lambda t, d=direction: exact_chain.jacobians(chain, along(t, q, d)))
        for H, rate in zip(found, truth, strict=True):
            pairs += _of_columns(chain, q, H[:, :, j] - rate, _size(chain, direction))
    return pairs


@chain_law()
def hessian_of_a_point_is_symmetric(chain: Any, q: np.ndarray) -> Pairs:
    """The linear rows of the hybrid Hessian are second derivatives of p: to the last bit where
    nothing is coupled.
    """
    v = chain.hessian(q, "hybrid")[3:]
    error = size(v - np.swapaxes(v, 1, 2))
    bound = 0.0
    if chain.nontrivial_coupling is not None:
        bound = 8 * budget(chain, q)[1] * (1 + size(chain.coupling) ** 2)
    return [(error, bound)]


@chain_law()
def acceleration_is_the_derivative_of_the_velocity(
    chain: Any, q: np.ndarray, dq: np.ndarray
) -> Pairs:
    """d/dt of V along q + t dq + t²/2 ddq, with ddq = (dq, backwards) + q."""
    ddq = dq[::-1] + q

    def velocities(t: Any) -> np.ndarray:
        J = exact_chain.jacobians(
            chain, along(t, q, dq)
        )  # of second order, ddq is of no account to J
        if not chain.dof:
            return exact.exactly(np.zeros((3, 6)))
        return J @ along(t, dq, ddq)

    pairs: Pairs = []
    grown = _size(chain, dq) ** 2 + _size(chain, ddq)
    for frame, truth in zip(FRAME_NAMES, slope(velocities), strict=True):
        error = chain.acceleration(q, dq, ddq, frame) - truth
        pairs += _of_columns(chain, q, error[:, None], grown)
    return pairs


@chain_law()
def joint_velocities_are_those_of_the_joint_poses(
    chain: Any, q: np.ndarray, dq: np.ndarray
) -> Pairs:
    """The twist of each z-aligned frame, by its pose's derivative, in space, body and hybrid frame."""
    found = {frame: chain.joint_velocities(q, dq, frame) for frame in FRAME_NAMES}
    pairs: Pairs = []
    for k in range(len(chain.screws)):

        def pose(t: Any, k: int = k) -> np.ndarray:
            return joint_pose(chain, along(t, q, dq), k)

        T = pose(exact.mp.zero)
        V_s = exact_derivatives.space_twist(pose, T)
        truth = exact.rounded(exact_chain.in_frames(V_s[:, None], T))
        for V, twist in zip(found.values(), truth, strict=True):
            pairs += _of_columns(chain, q, V[k][:, None] - twist, _size(chain, dq))
    return pairs


@chain_law()
def screw_derivatives_are_differences_on_the_group(
    chain: Any,
    q: np.ndarray,
    joint: int,
) -> Pairs:
    """df f⁻¹ and dJ under A_i ← Ad(e^η) A_i and M ← M e^η, and df f⁻¹ under A_i ← A_i + dA."""
    truth = exact_derivatives.screw_changes(chain, q, joint)
    home = exact_derivatives.home_changes(chain, q)
    motion = chain.screw_derivatives(q)
    entries = chain.screw_derivatives(q, wrt="components")
    angular, linear = budget(chain, q)
    reach = 1 + linear / angular
    x = float(chain.coupling[joint] @ q + chain.offset[joint])
    errors = [
        (motion.screws[:, joint] - truth.twist, 1.0),
        (entries.screws[:, joint] - truth.components, 1 + abs(x)),
        (motion.home - home.twist, 1.0),
        (entries.home - home.twist, 1.0),
    ]
    grown = 1 + size(chain.coupling)
    for k, frame in enumerate(FRAME_NAMES):
        change = chain.jacobian_screw_derivatives(q, frame)
        errors.append((change.screws[:, :, joint] - truth.columns[k], reach * grown))
        errors.append((change.home - home.columns[k], reach * grown))
    pairs: Pairs = []
    for error, weight in errors:
        # per unit of a twist, which at arm's length is as much as the reach
        bound = 16 * weight * reach
        pairs += of_twist(error, bound * angular, bound * linear)
    return pairs


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
    for wrt in ("twist", "components"):
        functions.append((lambda q, wrt=wrt: chain.screw_derivatives(q, wrt).screws, (6, n, 6)))
        functions.append((lambda q, wrt=wrt: chain.screw_derivatives(q, wrt).home, (6, 6)))
    # Products of matrices may be summed in another order in a batch.
    return check_batch(
        "derivatives of batches are those of single configurations",
        chain,
        batch,
        functions,
        bound=lambda q, one: 1e-14 * (1 + size(one)),
    )


def along(t: Any, q: np.ndarray, dq: np.ndarray) -> np.ndarray:
    """q + t dq (m,) in 80 digits."""
    return exact.exactly(q) + exact.exactly(dq) * t


def slope(f: exact_derivatives.Curve) -> np.ndarray:
    """df/dt at 0 of a function of one number in 80 digits, as floats."""
    return exact.rounded(exact_derivatives.derivative(f))


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
(`chain_cases.chain_cases`).
"""
