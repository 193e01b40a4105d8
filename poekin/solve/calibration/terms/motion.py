"""Terms of the motion before a reading: backlash, lag, drift."""

from __future__ import annotations

from ....model.chain import Chain
from ..model.parameters import Parameter, Unit
from .conditions import Reference, drift_source
from .scalars import Columns
from .term import Owners, Term, make_term

_RATES = {
    "rad": {"time": "rad/s", "temperature": "rad/K"},
    "m": {"time": "m/s", "temperature": "m/K"},
}


def backlash(chain: Chain, owners: Owners, _reference: Reference) -> list[Term]:
    """Term q_i += b / 2 sign of approach: b is what the joint reaches less or farther for a turn of
    its direction.
    """
    return _one_each(chain, owners, "backlash", lambda x: [0.5 * x.approach[i] for i in owners])


def lag(chain: Chain, owners: Owners, _reference: Reference) -> list[Term]:
    """Term q_i += c (q_i - previous q_i): c < 0 where a joint is read before it has arrived."""
    return _one_each(
        chain, owners, "lag", lambda x: [x.q[i] - x.previous[i] for i in owners], unit="1"
    )


def drift(chain: Chain, owners: Owners, reference: Reference) -> list[Term]:
    """Term q_i += c t, t the temperature, else the time beyond its mean, else the part of the run."""
    return _one_each(
        chain, owners, "drift", lambda x: [x.drift] * len(owners), rate=drift_source(reference)
    )


def _one_each(
    chain: Chain,
    owners: Owners,
    name: str,
    columns: Columns,
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
    return make_term(name, parameters, owners, columns)
