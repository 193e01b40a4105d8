"""Terms of the motion before a reading: backlash, lag, drift."""

from __future__ import annotations

import numpy as np

from ....groups.arrays import Array
from ....model.chain import Chain
from ..model.parameters import Parameter, Unit
from .conditions import Conditions, Reference, drift_source
from .term import Basis, Owners, Term, spread

_RATES = {
    "rad": {"time": "rad/s", "temperature": "rad/K"},
    "m": {"time": "m/s", "temperature": "m/K"},
}


def backlash(chain: Chain, owners: Owners, _reference: Reference) -> list[Term]:
    """Term q_i += b / 2 sign of approach: b is what the joint reaches less or farther for a turn of
    its direction.
    """

    def basis(_q: Array, conditions: Conditions) -> Array:
        return spread(0.5 * conditions.approach[:, owners], owners, chain.dof)

    return _one_each(chain, owners, "backlash", basis)


def lag(chain: Chain, owners: Owners, _reference: Reference) -> list[Term]:
    """Term q_i += c (q_i - previous q_i): c < 0 where a joint is read before it has arrived."""

    def basis(q: Array, conditions: Conditions) -> Array:
        moves = q - conditions.previous
        return spread(moves[:, owners], owners, chain.dof)

    return _one_each(chain, owners, "lag", basis, "1")


def drift(chain: Chain, owners: Owners, reference: Reference) -> list[Term]:
    """Term q_i += c t, t the temperature, else the time beyond its mean, else the part of the run."""

    def basis(_q: Array, conditions: Conditions) -> Array:
        column = conditions.drift[:, None]
        t = np.repeat(column, len(owners), axis=1)
        return spread(t, owners, chain.dof)

    return _one_each(chain, owners, "drift", basis, rate=drift_source(reference))


def _one_each(
    chain: Chain,
    owners: Owners,
    name: str,
    basis: Basis,
    unit: Unit | None = None,
    rate: str | None = None,
) -> list[Term]:
    """The term with one coefficient a coordinate, in its own unit unless another is said."""
    parameters = []
    for i in owners.tolist():
        own: Unit = "rad" if chain.is_angle(i) else "m"
        if rate is not None:
            own = _RATES[own][rate]  # type: ignore[assignment]  # a unit of these
        parameters.append(Parameter(chain.q_names[i], name, unit or own))
    if not parameters:
        return []
    return [Term(name, tuple(parameters), basis)]
