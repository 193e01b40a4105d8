"""Every chain of the real robots: to DH tables of both conventions and back, and to URDF text that
Pinocchio reads.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np

from poekin import Chain, load, to_urdf
from poekin.analysis.validate import routes
from poekin.errors import PoekinError, PoekinWarning
from poekin.formats.erd import example_robots

from ..dh_judge import WELL, Trip, there_and_back
from ..draw import dots
from ..report import Figure, Table, Topic
from ..urdf_errors import pinocchio_errors
from .model_truth_tables import trip_figures


@dataclass(frozen=True)
class Way:
    """One chain of a robot: its tables, the error of its URDF, what refused it, and where it starts
    or ends early.
    """

    robot: str
    tip: str
    joints: int
    trips: tuple[Trip, ...]
    urdf: float | None
    refusal: str
    note: str


def topic(quick: bool, say) -> Topic:  # type: ignore[no-untyped-def]
    robots = list(example_robots()[0].items())[:: 6 if quick else 1]
    ways: list[Way] = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PoekinWarning)
        for number, (name, path) in enumerate(robots, 1):
            robot = load(path)
            ways += [way(name, robot.chain(base, tip), note) for base, tip, note in routes(robot)]
            if number % 10 == 0:
                say(f"{number} of {len(robots)} robots")
    trips = [trip for way in ways for trip in way.trips]
    texts = [way.urdf for way in ways if way.urdf is not None]
    refused = [way for way in ways if way.refusal]
    early = [way for way in ways if way.note]
    return Topic(
        "Every chain of example-robot-data to DH and to URDF",
        f"{len(ways)} chains of {len(robots)} robots, from the root to each leaf"
        + (", in parts where a floating or planar joint interrupts one (the table says where). " if early else ". ")
        + "Each becomes a standard and a modified DH table and screws again, and is compared with itself at 5 random "
        "configurations. Each also becomes URDF text: Pinocchio reads it, and its pose and Jacobians (space, body, "
        "hybrid) are compared with those of the chain that was written. Rotations are compared as they are, lengths "
        "÷ R.",
        figures=[
            Figure(
                "chains of example-robot-data that have a DH table in both conventions and a URDF", len(refused), 0,
                shown=f"{len(ways) - len(refused)} of {len(ways)}", bar_shown=f"{len(ways)} of {len(ways)}",
                holds=bool(ways) and not refused,
                note="; ".join([
                    f"{sum(way.joints == 0 for way in ways)} without a moving joint",
                    *(f"{way.robot}, {way.tip} is refused: {way.refusal}" for way in refused),
                ]),
            ),
            *trip_figures("chains of example-robot-data → DH → POE", trips),
            Figure(
                "chains of example-robot-data → URDF → Pinocchio: pose and J, worst", max(texts, default=None), WELL,
                "R", note=f"{len(texts)} chains",
            ),
        ],
        pictures=[
            dots(
                "DH → POE: pose error of each chain ÷ R, both conventions, well-conditioned tables, in ascending "
                "order; exact at the lower edge",
                [trip.error for trip in trips if trip.well], WELL, x_label="table", y_label="error ÷ R",
            ),
            dots(
                "URDF → Pinocchio: worst error of each chain ÷ R, pose and three Jacobians, in ascending order",
                texts, WELL, x_label="chain", y_label="error ÷ R",
            ),
        ],
        tables=[
            Table(
                "Robots",
                ("robot", "chains", "longest (joints)", "standard DH ÷ R", "modified DH ÷ R", "largest table ÷ bar",
                 "URDF ÷ R"),
                [_row(name, [way for way in ways if way.robot == name]) for name, _ in robots],
                folded=True,
            ),
            *([Table("Chains taken in parts", ("robot", "chain ends at", "why"),
                     [(way.robot, way.tip, way.note) for way in early], folded=True)] if early else []),
        ],
    )  # fmt: skip


def way(robot: str, chain: Chain, note: str) -> Way:
    """One chain there and back; a refusal is kept in its own words."""
    q = np.random.default_rng(0).uniform(-3, 3, (5, chain.dof))
    trips: tuple[Trip, ...] = ()
    urdf, refusal = None, ""
    try:
        trips = tuple(
            there_and_back(chain, convention, q) for convention in ("standard", "modified")
        )
        urdf = float(pinocchio_errors(chain, to_urdf(chain), seed=0).max())
    except PoekinError as error:
        refusal = str(error)
    return Way(robot, chain.tip, len(chain.joint_names), trips, urdf, refusal, note)


def _row(name: str, ways: list[Way]) -> tuple[str | int | float, ...]:
    whole = [way for way in ways if not way.refusal]
    tables = [max((way.trips[i].error for way in whole), default=float("nan")) for i in (0, 1)]
    share = max(
        (t.error / (WELL if t.well else t.bound) for way in whole for t in way.trips),
        default=float("nan"),
    )
    text = max((way.urdf for way in whole if way.urdf is not None), default=float("nan"))
    return (name, len(ways), max(way.joints for way in ways), *tables, share, text)
