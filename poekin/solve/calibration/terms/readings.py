"""Terms of the readings themselves: coupling of neighbours, and harmonics of each joint."""

from __future__ import annotations

from typing import Any

import numpy as np

from ....model.chain import Chain
from ....model.sampling import angle_mask
from ..model.parameters import Parameter
from .conditions import Reference
from .scalars import Scalars
from .term import Owners, Term, make_term


def coupling(chain: Chain, owners: Owners, _reference: Reference) -> list[Term]:
    """Term q_i += c q_j of each coordinate and its neighbours j = i - 1 and i + 1."""
    pairs = []
    for i in owners.tolist():
        neighbours = (i - 1, i + 1)
        pairs += [(i, j) for j in neighbours if 0 <= j < chain.dof]
    to, other = np.reshape(pairs, (-1, 2)).T
    names = chain.q_names
    parameters = (Parameter(names[i], f"coupling to {names[j]}", "1") for i, j in pairs)
    return make_term("coupling", parameters, to, lambda x: [x.q[j] for j in other])


def harmonics(chain: Chain, owners: Owners, _reference: Reference) -> list[Term]:
    """Terms q_i += c sin(k q_i) + d cos(k q_i), k = 1, of each angle."""
    return _harmonics(chain, owners, 1, "harmonics")


def second_harmonics(chain: Chain, owners: Owners, _reference: Reference) -> list[Term]:
    """`harmonics` of k = 2."""
    return _harmonics(chain, owners, 2, "second harmonics")


def _harmonics(chain: Chain, owners: Owners, order: int, name: str) -> list[Term]:
    angles = owners[angle_mask(chain)[owners]]
    times = "" if order == 1 else f"{order} "
    parameters = [
        Parameter(chain.q_names[i], f"{function} {times}q", "rad")
        for function in ("sin", "cos")
        for i in angles
    ]
    multiples = (order * np.eye(chain.dof)[angles]).tolist()

    def columns(x: Scalars) -> list[Any]:
        pairs = [x.sine_cosine(factors, 0.0) for factors in multiples]
        return [sine for sine, _ in pairs] + [cosine for _, cosine in pairs]

    return make_term(name, parameters, np.tile(angles, 2), columns)
