"""Laws of a serial chain as plain functions, and `CHAIN_LAWS`, the battery of them.

The subject is `poekin.Chain` or what has its attributes and methods, with as many of them replaced
as one likes. For functions of one's own that know nothing of chains, see `conform.laws.of_arms`.

Truth is the product of exponentials in 60 digits, finite differences on the group, and the laws
that tie one function to another; those of the Jacobian are in `jacobian_laws`. ω and v are held
apart, by `chain_bounds.budget` times a small number. A violation has the law, the error, its bound,
the arguments, and the chain's numbers.
Source: Park 1994, Sections II to IV.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from poekin.model.kinematics.pose_jacobian import FRAME_NAMES
from poekin.testing.laws.laws import Law, Pairs
from poekin.testing.laws.measures import size
from poekin.testing.oracles import exact, exact_chain
from tests.model.laws import jacobian_laws
from tests.model.laws.chain_bounds import Shaped, budget, chain_law, check_batch, of_poses


@chain_law()
def fk_is_the_product_of_exponentials(
    chain: Any,
    q: np.ndarray,
) -> Pairs:
    """Law: forward kinematics is the product of exponentials, in 60 digits.

    f(q) = e^{A_1 x_1} ⋯ e^{A_n x_n} M.
    """
    return of_poses(chain, q, chain.fk(q), exact.rounded(exact_chain.pose(chain, q)))


@chain_law()
def home_is_where_zero_leads(chain: Any) -> Pairs:
    """Law: the pose at zero coordinates is the home pose.

    f(0) = M where c = 0, and for any c the pose of the joints at c.
    """
    q = np.zeros(chain.dof)
    expected = chain.home
    if np.any(chain.offset):
        expected = exact.rounded(exact_chain.pose(chain, q))
    return of_poses(chain, q, chain.fk(q), expected)


@chain_law()
def forms_agree(
    chain: Any,
    q: np.ndarray,
) -> Pairs:
    """Law: the space, body and local forms are one motion.

    f = Π e^{A x} M = M Π e^{B x} = M_1 e^{S x_1} ⋯ M_{n+1}.
    """
    x = exact_chain.displacements(chain, q)
    f = chain.fk(q)
    space = exact.forward(chain.space.screws, chain.space.home, x)
    body = exact.exactly(chain.body.home) @ exact.forward(chain.body.screws, np.eye(4), x)
    factors = [chain.local.frames[0]]
    joints = zip(chain.local.rotates, chain.local.slides, x, strict=True)
    for (r, s, amount), M in zip(joints, chain.local.frames[1:], strict=True):
        S = exact.exactly([0, 0, r, 0, 0, s])
        factors += [exact.exp(S * amount), M]
    forms = (space, body, exact.product(factors))
    return [pair for form in forms for pair in of_poses(chain, q, f, form)]


@chain_law()
def joint_poses_are_partial_products(
    chain: Any,
    q: np.ndarray,
    joint: int,
) -> Pairs:
    """Law: the z-aligned frame of joint k stands at e^{A_1 x_1} ⋯ e^{A_k x_k} (M_1 ⋯ M_k)."""
    expected = joint_pose(chain, q, joint)
    return of_poses(chain, q, chain.joint_poses(q)[joint], expected)


def batches_are_made_of_single_configurations(
    chain: Any,
    batch: np.ndarray,
) -> float:
    """Law: a function of a batch gives, element by element, its value for one configuration."""
    functions: list[Shaped] = [
        (chain.fk, (4, 4)),
        (chain.joint_poses, (len(chain.screws), 4, 4)),
        (lambda q: chain.velocity(q, q, "body"), (6,)),
    ]
    for frame in FRAME_NAMES:
        functions.append((lambda q, f=frame: chain.jacobian(q, f), (6, chain.dof)))

    law = "batches are made of single configurations"
    return check_batch(
        law,
        chain,
        batch,
        functions,
        lambda q, _: budget(chain, q)[1] * (1 + size(q)),
    )


def joint_pose(
    chain: Any,
    q: np.ndarray,
    joint: int,
) -> np.ndarray:
    """Pose of the z-aligned frame of a joint, e^{A_1 x_1} ⋯ e^{A_k x_k} M_1 ⋯ M_k."""
    first = slice(joint + 1)
    x = exact_chain.displacements(chain, q)
    return exact.forward(chain.screws[first], exact.product(chain.local.frames[first]), x[first])


CHAIN_LAWS = (
    Law(fk_is_the_product_of_exponentials, ("q",)),
    Law(home_is_where_zero_leads, ()),
    Law(forms_agree, ("q",)),
    Law(jacobian_laws.jacobian_is_the_derivative, ("q", "dq")),
    Law(jacobian_laws.space_jacobian_is_not_hybrid, ("q", "dq")),
    Law(jacobian_laws.body_jacobian_is_space_seen_from_the_tool, ("q", "dq")),
    Law(joint_poses_are_partial_products, ("q", "joint")),
    Law(jacobian_laws.jacobian_in_a_joints_frame_is_space_seen_from_it, ("q", "dq", "joint")),
    Law(jacobian_laws.velocity_is_the_jacobian_times_rates, ("q", "dq")),
    Law(jacobian_laws.one_pass_gives_both, ("q", "dq")),
    Law(jacobian_laws.a_point_moves_as_the_tools_origin_would, ("q", "dq", "point")),
    Law(batches_are_made_of_single_configurations, ("batch",)),
)
"""The battery: each law with the kinds of its arguments (`strategies.chain_cases`)."""
