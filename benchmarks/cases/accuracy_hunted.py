"""The worst error of exp and log on SE(3) that hill climbing finds: poekin, and each installed peer
beside it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from poekin import se3

from .. import peers
from ..accuracy.worst_errors import REPORT_BAR
from ..hunt import QUANTITIES, Effort, Function, Worst, hunt
from ..report import Figure, Table, Topic, short

WORDS = (
    "Random twists, |ω| up to 10 rad for exp and 0.05 rad to π for log, then hill climbing: the worst cases so far "
    "are changed by relative steps of 1e-16 to 0.1, and what is worse is kept. Each library is hunted for itself, all "
    "with the same effort; poekin is then hunted in more cases. The unit is the error that float64 cannot avoid, as in "
    "the topic of accuracy against angle; errors are measured in extended precision, which is enough at these angles. "
    "`python -m benchmarks.hunt CASES` hunts poekin in as many cases as one likes."
)
OWN = {"exp": se3.exp, "log": se3.log}


class Hunted(NamedTuple):
    """A library, by name and version, with the worst of each quantity by its name; problem: why
    there is none.
    """

    name: str
    worst: Mapping[str, Worst]
    problem: str = ""


def topic(quick: bool, say) -> Topic:  # type: ignore[no-untyped-def]
    same, more = (
        (Effort(500, 3), Effort(2_000, 3)) if quick else (Effort(2_000, 10), Effort(100_000, 25))
    )
    found = [hunted("poekin, longer", OWN, more), hunted("poekin", OWN, same)]
    say(_line(found[0]))
    for peer in peers.chosen():
        if peer.peer.group is not None:
            found.append(_peer(peer, same))
            say(_line(found[-1]))
    return report(found)


def hunted(name: str, functions: Mapping[str, Function], effort: Effort) -> Hunted:
    """Hunt a library; the random cases are the same for everybody who is hunted with the same
    effort.
    """
    return Hunted(
        name,
        {
            q.name: hunt(q, functions[q.function], effort, np.random.default_rng(0))
            for q in QUANTITIES
        },
    )


def report(found: Sequence[Hunted]) -> Topic:
    """The topic of poekin hunted for long, poekin hunted as the others are, and the others."""
    longer, own, *others = found
    figures = [
        Figure(
            f"hunted, {name}: poekin's worst error ÷ attainable",
            max(worst.hunted, own.worst[name].hunted), REPORT_BAR, note=f"{worst.cases} cases",
        )
        for name, worst in longer.worst.items()
    ]  # fmt: skip
    figures += [_beside_peers(name, worst.hunted, others) for name, worst in own.worst.items()]
    return Topic("Accuracy of exp and log, hunted", WORDS, figures=figures, tables=[_table(found)])


def _peer(found: peers.Found, effort: Effort) -> Hunted:
    name = f"{found.peer.name} {found.peer.version}".strip()
    if found.problem or found.peer.group is None:
        return Hunted(name, {}, found.problem)
    group, problem = peers.attempt(found.peer.group)
    if group is None:
        return Hunted(name, {}, problem)
    return hunted(name, {"exp": group.exp_of, "log": group.log_of}, effort)


def _beside_peers(quantity: str, own: float, others: Sequence[Hunted]) -> Figure:
    """poekin's worst as a share of the best peer's, both hunted with the same effort."""
    what = f"hunted, {quantity}: poekin's worst error ÷ the best peer's"
    ranked = sorted((other.worst[quantity].hunted, other.name) for other in others if other.worst)
    if not ranked:
        return Figure(what, None, note="no peer is installed that has exp and log")
    least, best = ranked[0]
    return Figure(what, own / least, 1, note=f"{_number(own)} and {_number(least)} of {best}")


def _table(found: Sequence[Hunted]) -> Table:
    rows: list[Sequence[str | int | float]] = []
    for library in found:
        if not library.worst:
            rows.append((library.name, "", "", "", "", library.problem))
        for quantity, worst in library.worst.items():
            angle = f"{np.linalg.norm(worst.twist[:3]):.4g}"
            rows.append(
                (
                    library.name,
                    quantity,
                    _number(worst.random),
                    _number(worst.hunted),
                    angle,
                    worst.cases,
                )
            )
    columns = ("library", "quantity", "random cases", "hunted", "at θ (rad)", "cases")
    return Table("Worst error ÷ attainable of each", columns, rows)


def _line(library: Hunted) -> str:
    worst = ", ".join(
        f"{quantity} {_number(found.hunted)}" for quantity, found in library.worst.items()
    )
    return f"{library.name}: {library.problem or worst}"


def _number(value: float) -> str:
    return short(value) if math.isfinite(value) else "no finite result somewhere"
