"""Terms by name."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Literal

from ....model.chain import Chain
from .conditions import Reference
from .gravity import compliance
from .motion import backlash, drift, lag
from .readings import coupling, harmonics, second_harmonics
from .term import Owners, Term

TermName = Literal[
    "compliance", "coupling", "harmonics", "second harmonics", "backlash", "lag", "drift"
]
BUILDERS: dict[str, Callable[[Chain, Owners, Reference], list[Term]]] = {
    "compliance": compliance,
    "coupling": coupling,
    "harmonics": harmonics,
    "second harmonics": second_harmonics,
    "backlash": backlash,
    "lag": lag,
    "drift": drift,
}


def make_terms(
    kinds: Sequence[str | Term],
    chain: Chain,
    owners: Owners,
    reference: Reference,
) -> tuple[Term, ...]:
    """The terms among kinds of parameters, for the coordinates `owners`."""
    found: list[Term] = []
    for kind in kinds:
        if isinstance(kind, Term):
            found.append(kind)
        elif kind in BUILDERS:
            found += BUILDERS[kind](chain, owners, reference)
    return tuple(found)
