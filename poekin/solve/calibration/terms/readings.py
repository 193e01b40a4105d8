"""Terms of the readings themselves: coupling of neighbours, and harmonics of each joint."""

from __future__ import annotations

import numpy as np

from ....groups.arrays import Array
from ....model.chain import Chain
from ....model.sampling import angle_mask
from ..model.parameters import Parameter
from .conditions import Conditions, Reference
from .term import Owners, Term, spread


def coupling(chain: Chain, owners: Owners, _reference: Reference) -> list[Term]:
    """Term q_i += c q_j of each coordinate and its neighbours j = i - 1 and i + 1."""
    pairs = []
    for i in owners.tolist():
        neighbours = (i - 1, i + 1)
        pairs += [(i, j) for j in neighbours if 0 <= j < chain.dof]
    if not pairs:
        return []
    to, other = np.array(pairs).T
    names = chain.q_names
    parameters = (Parameter(names[i], f"coupling to {names[j]}", "1") for i, j in pairs)

    def basis(q: Array, _conditions: Conditions) -> Array:
        return spread(q[:, other], to, chain.dof)

    return [Term("coupling", tuple(parameters), basis)]


def harmonics(chain: Chain, owners: Owners, _reference: Reference) -> list[Term]:
    """Terms q_i += c sin(k q_i) + d cos(k q_i), k = 1, of each angle."""
    return _harmonics(chain, owners, 1, "harmonics")


def second_harmonics(chain: Chain, owners: Owners, _reference: Reference) -> list[Term]:
    """`harmonics` of k = 2."""
    return _harmonics(chain, owners, 2, "second harmonics")


def _harmonics(chain: Chain, owners: Owners, order: int, name: str) -> list[Term]:
    angles = owners[angle_mask(chain)[owners]]
    if not len(angles):
        return []
    times = "" if order == 1 else f"{order} "
    parameters = [
        Parameter(chain.q_names[i], f"{function} {times}q", "rad")
        for function in ("sin", "cos")
        for i in angles
    ]
    twice = np.tile(angles, 2)

    def basis(q: Array, _conditions: Conditions) -> Array:
        x = order * q[:, angles]
        values = np.concatenate([np.sin(x), np.cos(x)], axis=1)
        return spread(values, twice, chain.dof)

    return [Term(name, tuple(parameters), basis)]
