"""Compliance: joints that yield to the gravity torque of a mass at the wrist, and of the payload."""

from __future__ import annotations

import numpy as np

from ....groups.arrays import Array
from ....groups.vectors import norms, rotation_part, translation_part
from ....model.chain import Chain
from ....model.sampling import half_range
from ..model.parameters import Parameter, Unit
from .conditions import Conditions, Reference, in_order
from .term import Owners, Term, spread

STANDARD_GRAVITY = 9.80665
_LAST = 3  # axes that make a wrist
_MEET = 1e-9  # axes that are nearer to parallel leave the place along them open
_LEAST = 1e-6  # reaches: a joint whose lever is never longer carries no weight


def compliance(chain: Chain, owners: Owners, reference: Reference) -> list[Term]:
    """Terms q_i += c_i tau_i: tau_i is the lever (m) of a weight at the wrist, as the arm's own
    weight is not known; where payloads are given, also their torque (N m).

    Levers of the nominal arm, which do not depend on what is fitted. Only of joints that carry.
    """
    at_tip = np.zeros(3)
    at_wrist = wrist_in_tip(chain)
    arm = _term(chain, owners, reference, at_wrist, "compliance", "rad/m")
    terms = [arm]
    if "payload" in reference:
        terms.append(_term(chain, owners, reference, at_tip, "compliance to payload", "rad/(N m)"))
    return [term for term in terms if term is not None]


def _term(
    chain: Chain,
    owners: Owners,
    reference: Reference,
    point: Array,
    what: str,
    unit: Unit,
) -> Term | None:
    half = half_range(chain)
    q = np.random.default_rng(0).uniform(-half, half, (64, chain.dof))
    gravity = in_order(q, reference).gravity
    lengths = np.abs(levers(chain, q, gravity, point))
    longest = lengths.max(axis=0)
    loaded = owners[longest[owners] > _LEAST * chain.reach]
    if not len(loaded):
        return None

    def basis(q: Array, conditions: Conditions) -> Array:
        values = levers(chain, q, conditions.gravity, point)[:, loaded]
        if unit == "rad/(N m)":
            weights = STANDARD_GRAVITY * conditions.payload
            values = values * weights[:, None]
        return spread(values, loaded, chain.dof)

    parameters = (Parameter(chain.q_names[i], what, unit) for i in loaded)
    return Term("compliance", tuple(parameters), basis)


def levers(chain: Chain, q: Array, gravity: Array, point: Array) -> Array:
    """Levers (N, m) at which a unit force along gravity (N, 3) on a point of the tool turns each
    coordinate, m.
    """
    J = chain.jacobian(q, frame="hybrid", at=point)
    linear = J[:, 3:]
    return np.einsum("nk,nki->ni", gravity, linear)


def wrist_in_tip(chain: Chain) -> Array:
    """The wrist (3,) in the tip frame."""
    from_tip = wrist(chain) - translation_part(chain.home)
    return rotation_part(chain.home).T @ from_tip


def wrist(chain: Chain) -> Array:
    """The point (3,) at home, in the base frame, nearest to the last three axes that turn; where
    several are, the one nearest to the tip.
    """
    tip = translation_part(chain.home)
    turns = norms(chain.screws[:, :3])
    turning = turns > 0.5
    axes = chain.screws[turning][-_LAST:]
    omega = axes[:, :3]
    moments = np.cross(omega, axes[:, 3:])  # the point of each axis nearest to the base's origin
    along = omega[:, :, None] * omega[:, None, :]
    across = np.eye(3) - along
    off = moments - across @ tip
    rows = across.reshape(-1, 3)
    shift = np.linalg.lstsq(rows, off.ravel(), rcond=_MEET)[0]
    return tip + shift
