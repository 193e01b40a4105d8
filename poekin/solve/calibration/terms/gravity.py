"""Compliance: joints that yield to the gravity torque of the arm's masses, or of a mass at the wrist, and
of the payload.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ....analysis.axis_lines import nearest_point
from ....errors import join_names
from ....formulas.statics import gravity
from ....groups.arrays import Array
from ....groups.vectors import rotation_part, translation_part
from ....model.chain import Chain
from ....model.sampling import half_range
from ..model.parameters import Parameter, Unit
from .conditions import Conditions, Reference, at_rest, in_order
from .scalars import Scalars, linear, of_rows
from .term import Owners, Term, make_term

STANDARD_GRAVITY = 9.80665
_LAST = 3  # axes that make a wrist
_MEET = 1e-9  # axes that are nearer to parallel leave the place along them open
_LEAST = 1e-6  # reaches: a joint whose lever is never longer carries no weight
_OF_SLIDES: dict[str, Unit] = {"rad/m": "m", "rad/(N m)": "m/N"}
_WEIGHTS = {"rad/m": 1.0, "rad/(N m)": STANDARD_GRAVITY}


class Load(NamedTuple):
    """Masses that joints yield to: a parameter's words and unit, rows (n, 4) of mass (kg, or 1 of a
    lever) and centre at home in the base frame, and whether the payload multiplies them.
    """

    what: str
    unit: Unit
    masses: Array
    of_payload: bool = False


def compliance(chain: Chain, owners: Owners, reference: Reference) -> list[Term]:
    """Terms q_i += c_i tau_i: tau_i is the gravity torque (N m) of the arm's masses, and where the model
    does not have those of all bodies, the lever (m) of a weight at the wrist; where payloads are
    given, also their torque.

    Torques of the nominal arm, which do not depend on what is fitted. Only of joints that carry.
    """
    loads = [Load("compliance", "rad/m", point_mass(chain, wrist(chain)))]
    if chain.masses is not None and not unknown_masses(chain):
        loads = [Load("compliance", "rad/(N m)", chain.masses)]
    if "payload" in reference:
        tip = point_mass(chain, translation_part(chain.home))
        loads.append(Load("compliance to payload", "rad/(N m)", tip, of_payload=True))
    return [term for load in loads for term in _terms(chain, owners, reference, load)]


def _terms(chain: Chain, owners: Owners, reference: Reference, load: Load) -> list[Term]:
    half = half_range(chain)
    q = np.random.default_rng(0).uniform(-half, half, (64, chain.dof))
    found = _torques_of_rows(chain, q, in_order(q, reference), load.masses)
    longest = np.abs(found).max(axis=0)
    carried = load.masses[:, 0].sum()
    loaded = owners[longest[owners] > _LEAST * chain.reach * carried]

    def columns(x: Scalars) -> list[Any]:
        weight: Any = _WEIGHTS[load.unit]
        if load.of_payload:
            weight = weight * x.payload
        every = torques(chain, x, load.masses)
        return [weight * every[i] for i in loaded]

    parameters = []
    for i in loaded.tolist():
        unit = load.unit if chain.is_angle(i) else _OF_SLIDES[load.unit]
        parameters.append(Parameter(chain.q_names[i], load.what, unit))
    return make_term("compliance", parameters, loaded, columns)


def torques(chain: Chain, x: Scalars, masses: Array) -> list[Any]:
    """Torques (m) of rows (n, 4) of masses, N m where gravity is 1 m/s^2: positive where they sink as a
    coordinate grows.
    """
    C = chain.coupling.tolist()
    joints = []
    turns = []
    for row, offset in zip(C, chain.offset.tolist(), strict=True):
        joints.append(linear(row, x.q, offset))
        turns.append(x.sine_cosine(row, offset))
    sines = [sine for sine, _ in turns]
    cosines = [cosine for _, cosine in turns]
    count = len(joints)
    forces: list[list[Any]] = [[None, None, None] for _ in range(count)]
    rows = masses.tolist()
    screws = chain.screws.tolist()
    gravity.torques(screws, rows, joints, sines, cosines, x.gravity, count, forces)
    of_joints = [force[0] for force in forces]
    return [linear(column, of_joints, 0.0) for column in zip(*C, strict=True)]


def _torques_of_rows(chain: Chain, q: Array, conditions: Conditions, masses: Array) -> Array:
    """Torques (N, m) at the rows of q (N, m)."""
    found = np.zeros(q.shape)
    for i, torque in enumerate(torques(chain, of_rows(q, conditions), masses)):
        found[:, i] = torque
    return found


def point_mass(chain: Chain, place: Array) -> Array:
    """Rows (n, 4) of the mass 1 on the tool, at a place at home in the base frame."""
    rows = np.zeros((len(chain.screws), 4))
    rows[-1:] = [1.0, *place]
    return rows


def unknown_masses(chain: Chain) -> list[str]:
    """Joints of which nothing that they move has a mass, in a model with masses."""
    if chain.masses is None:
        return []
    pairs = zip(chain.joint_names, chain.masses[:, 0], strict=True)
    return [name for name, mass in pairs if not mass]


def remarks(chain: Chain) -> tuple[str, ...]:
    """Words on a compliance by levers though the model has masses."""
    names = unknown_masses(chain)
    if not names:
        return ()
    return (
        "compliance is by levers of a weight at the wrist, not by the model's masses: what these joints"
        f" move has none: {join_names(names)}",
    )


def levers(chain: Chain, q: Array, gravity: Array, point: Array) -> Array:
    """Levers (N, m) at which a unit force along gravity (N, 3) on a point of the tool turns each
    coordinate, m.
    """
    conditions = at_rest(q, {})._replace(gravity=gravity)
    place = rotation_part(chain.home) @ point + translation_part(chain.home)
    return _torques_of_rows(chain, q, conditions, point_mass(chain, place))


def wrist_in_tip(chain: Chain) -> Array:
    """The wrist (3,) in the tip frame."""
    from_tip = wrist(chain) - translation_part(chain.home)
    return rotation_part(chain.home).T @ from_tip


def wrist(chain: Chain) -> Array:
    """The point (3,) at home, in the base frame, nearest to the last three axes that turn; where
    several are, the one nearest to the tip.
    """
    tip = translation_part(chain.home)
    turning = chain.screws[:, :3].any(axis=1)
    axes = chain.screws[turning][-_LAST:]
    return nearest_point(axes, tip, _MEET)
