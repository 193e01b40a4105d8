"""Compliance: joints that yield to the gravity torque of a mass at the wrist, and of the payload."""

from __future__ import annotations

import numpy as np

from ....groups.arrays import Array
from ....groups.vectors import translation_part
from ....model.chain import Chain
from ....model.sampling import half_range
from ..model.parameters import Parameter, Unit
from .conditions import Conditions, Reference, in_order
from .term import Owners, Term, spread

STANDARD_GRAVITY = 9.80665
_LAST = 3  # axes that make a wrist
_LEAST = 1e-6  # reaches: a joint whose lever is never longer carries no weight


def compliance(chain: Chain, owners: Owners, reference: Reference) -> list[Term]:
    """Terms q_i += c_i tau_i: tau_i is the lever (m) of a weight at the wrist, as the arm's own
    weight is not known; where payloads are given, also their torque (N m).

    Levers of the nominal arm, which do not depend on what is fitted. Only of joints that carry.
    """
    home = chain.home
    at_tip = np.zeros(3)
    at_wrist = home[:3, :3].T @ (wrist(chain) - translation_part(home))
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
    longest = np.abs(levers(chain, q, in_order(q, reference).gravity, point)).max(axis=0)
    loaded = owners[longest[owners] > _LEAST * chain.reach]
    if not len(loaded):
        return None

    def basis(q: Array, conditions: Conditions) -> Array:
        values = levers(chain, q, conditions.gravity, point)[:, loaded]
        if unit == "rad/(N m)":
            values = values * (STANDARD_GRAVITY * conditions.payload[:, None])
        return spread(values, loaded, chain.dof)

    parameters = (Parameter(chain.q_names[i], what, unit) for i in loaded)
    return Term("compliance", tuple(parameters), basis)


def levers(chain: Chain, q: Array, gravity: Array, point: Array) -> Array:
    """Levers (N, m) at which a unit force along gravity (N, 3) on a point of the tool turns each
    coordinate, m.
    """
    J = chain.jacobian(q, frame="hybrid", at=point)
    return np.einsum("nk,nki->ni", gravity, J[:, 3:])


def wrist(chain: Chain) -> Array:
    """The point (3,) at home, in the base frame, nearest to the last three axes that turn; where
    several are, the one nearest to the tip.
    """
    tip = translation_part(chain.home)
    turning = np.linalg.norm(chain.screws[:, :3], axis=1) > 0.5
    axes = chain.screws[turning][-_LAST:]
    omega = axes[:, :3]
    moments = np.cross(omega, axes[:, 3:])  # the point of each axis nearest to the base's origin
    across = np.eye(3) - omega[:, :, None] * omega[:, None, :]
    off = moments - np.einsum("kij,j->ki", across, tip)
    shift = np.linalg.lstsq(across.reshape(-1, 3), off.ravel(), rcond=1e-9)[0]
    return tip + shift
