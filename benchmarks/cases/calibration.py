"""What can be known of an arm by measuring it: the rank of the identification of random chains."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from poekin import Chain, so3
from poekin.solve import calibration as cal
from poekin.solve.calibration.diagnostics.identification import RANK

from ..report import Figure, Table, Topic, short

KINDS = ("R", "RR", "RRR", "RRRRRR", "RRRRRRR", "RRP", "PPP", "RRPR", "RPRPRR")
CHAINS, MEASURED = 200, 30

WORDS = (
    "Random chains: axes uniform on the sphere, through points within 0.5 m of the origin, any home pose, "
    f"{MEASURED} configurations with angles in ±π and slides in ±0.5 m. Twice each: the rank of all derivatives that "
    "there are, six a screw and six of the home pose, of which many are the same; and what `identify` says of the "
    "minimal parameters of `calibrate`, which have to see as much with fewer. From full poses, and from the position "
    "of one point of the tool, 0.1 to 0.3 m away from the tip's origin. r revolute and p prismatic joints: 4r + 2p + 6 "
    f"and 4r + 2p + 3. A singular value counts above {RANK:g} of the largest, lengths ÷ reach; the gap shows how clear "
    "that is."
)


class Seen(NamedTuple):
    """Of one chain and one kind of measurement.

    rank by all derivatives; rank and expected rank by `identify`, its parameters; least singular
    value that counts and largest that does not, of all derivatives, ÷ the largest; the condition by
    `identify`.
    """

    rank: int
    identified: int
    identifiable: int
    parameters: int
    least: float
    lost: float
    condition: float


def topic(quick: bool, say) -> Topic:  # type: ignore[no-untyped-def]
    count = CHAINS // 10 if quick else CHAINS
    found: dict[tuple[str, str], list[Seen]] = {}
    for kinds in KINDS:
        rng = np.random.default_rng([ord(letter) for letter in kinds])
        for _ in range(count):
            chain, q, point = random_chain(kinds, rng)
            for what in ("poses", "point"):
                found.setdefault((kinds, what), []).append(
                    seen(chain, q, point if what == "point" else None)
                )
        say(f"{kinds}: {count} chains")
    return Topic(
        "What can be known: the rank of the identification",
        WORDS,
        figures=[
            figure("full poses", "4r + 2p + 6", "poses", found),
            figure("one point", "4r + 2p + 3", "point", found),
            Figure("gap: least singular value that counts ÷ largest that does not, of all derivatives, worst",
                   min(s.least / max(s.lost, 1e-300) for every in found.values() for s in every),
                   note=f"{short(min(s.least for e in found.values() for s in e))} of the largest at least, and "
                        f"{short(max(s.lost for e in found.values() for s in e))} at most"),
        ],
        tables=[
            Table("Chains by their joints", ("joints", "from", "4r + 2p + 6 or 3", "rank by all derivatives",
                                             "rank by identify", "parameters of calibrate", "condition, median",
                                             "condition, worst"),
                  [row(kinds, what, every) for (kinds, what), every in found.items()]),
        ],
    )  # fmt: skip


def identifiable(kinds: str, what: str) -> int:
    """What full poses or one point can tell of a chain of these joints."""
    return 4 * kinds.count("R") + 2 * kinds.count("P") + (6 if what == "poses" else 3)


def random_chain(kinds: str, rng: np.random.Generator) -> tuple[Chain, np.ndarray, np.ndarray]:
    """A chain of these joints, configurations (N, n), and a point of its tool (3,)."""
    screws = []
    for kind in kinds:
        axis = rng.normal(size=3)
        axis /= np.linalg.norm(axis)
        screws.append(
            [0, 0, 0, *axis] if kind == "P" else [*axis, *np.cross(rng.uniform(-0.5, 0.5, 3), axis)]
        )
    home = np.eye(4)
    home[:3, :3], home[:3, 3] = so3.exp(rng.normal(size=3)), rng.uniform(-0.5, 0.5, 3)
    span = np.array([0.5 if kind == "P" else np.pi for kind in kinds])
    point = rng.uniform(0.06, 0.17, 3) * rng.choice([-1.0, 1.0], 3)
    return Chain.from_space(screws, home), rng.uniform(-span, span, (MEASURED, len(kinds))), point


def seen(chain: Chain, q: np.ndarray, point: np.ndarray | None) -> Seen:
    """What poses, or this point of the tool, tell of the chain."""
    D = chain.screw_derivatives(q)
    changes = np.concatenate(
        [D.screws.reshape(len(q), 6, -1), D.home], axis=2
    )  # space twists of all motions
    T = chain.fk(q)
    if point is None:
        measurement: cal.Measurement = cal.Poses(T)
        J = changes
    else:
        y = T[:, :3, :3] @ point + T[:, :3, 3]
        measurement = cal.Points(y, points=point)
        J = changes[:, 3:] - so3.hat(y) @ changes[:, :3]
    weight = np.where(np.arange(J.shape[2]) % 6 < 3, 1.0, chain.reach)  # columns: rad, then reaches
    rows = np.where(np.arange(J.shape[1]) < J.shape[1] - 3, 1.0, 1.0 / chain.reach)
    sigma = np.linalg.svd((J * weight * rows[:, None]).reshape(-1, J.shape[2]), compute_uv=False)
    sigma /= sigma[0]
    rank = int(np.sum(sigma > RANK))
    said = cal.identify(chain, q, measurement)
    lost = float(sigma[rank]) if rank < len(sigma) else 0.0
    return Seen(
        rank,
        said.rank,
        said.identifiable,
        said.size,
        float(sigma[rank - 1]),
        lost,
        float(said.condition),
    )


def figure(words: str, formula: str, what: str, found: dict[tuple[str, str], list[Seen]]) -> Figure:
    """Chains of which a rank is not what it ought to be."""
    wrong = total = 0
    for (kinds, kind), every in found.items():
        if kind == what:
            right = identifiable(kinds, what)
            wrong += sum({s.rank, s.identified, s.identifiable} != {right} for s in every)
            total += len(every)
    return Figure(
        f"rank from {words} is {formula}, by all derivatives and by identify: chains where not", wrong, 0,
        shown=f"{wrong} of {total}", note=f"joints {', '.join(KINDS)}",
    )  # fmt: skip


def row(kinds: str, what: str, every: list[Seen]) -> tuple[str | int | float, ...]:
    def all_of(values: list[int]) -> str:
        least, most = min(values), max(values)
        return f"{least}" if least == most else f"{least} … {most}"

    conditions = [s.condition for s in every]
    return (
        kinds, what, identifiable(kinds, what), all_of([s.rank for s in every]),
        all_of([s.identified for s in every]), all_of([s.parameters for s in every]),
        float(np.median(conditions)), max(conditions),
    )  # fmt: skip
