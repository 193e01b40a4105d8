"""DH tables into screws and back: random ones against 60 digits, and a calibrated arm in single
precision.
"""

from __future__ import annotations

import math
from collections import Counter

import numpy as np

from poekin import dh, se3
from poekin.formats.dh.table import KINDS

from ..calibrated_arm import UR10E, single_precision_errors
from ..dh_judge import FAR, WELL, Trip, ceiling, error, largest, product, there_and_back
from ..report import Figure, Table, Topic, short

QUARTERS = (0.0, math.pi / 2, -math.pi / 2, math.pi)
CONFIGURATIONS = 1000


def topic(quick: bool, say) -> Topic:  # type: ignore[no-untyped-def]
    count = 60 if quick else 300
    rng = np.random.default_rng(0)
    tables = [
        random_table(rng, dh_convention)
        for dh_convention in ("standard", "modified")
        for _ in range(count // 2)
    ]
    near, far, trips = [], [], []
    for number, table in enumerate(tables, 1):
        chain, x = dh.to_chain(table), rng.uniform(-np.pi, np.pi, len(table))
        off = error(chain.fk(x), product(table, x), chain.reach)
        if largest(table, chain.reach) <= FAR:
            near.append(off)
        else:
            far.append(off / ceiling(table, chain.reach))
        q = rng.uniform(-np.pi, np.pi, (10, len(table)))
        trips += [there_and_back(chain, convention, q) for convention in ("standard", "modified")]
        if number % max(count // 4, 1) == 0:
            say(f"{number} of {count} tables")
    single = single_precision_errors(
        UR10E, np.random.default_rng(0).uniform(-np.pi, np.pi, (CONFIGURATIONS, len(UR10E)))
    )
    far_entry = short(float(np.abs(UR10E.d).max()))
    return Topic(
        "DH tables into screws and back",
        f"{count} random tables of 1 to 10 joints, half of them standard and half modified, with base and tool poses; "
        "the table below says what is in them. Each is compared at a random configuration with the product of its own "
        "links in 60 digits (mpmath; it shares no code with poekin). Its screws then become a table of either "
        f"convention and screws again. R is the chain's reach, n the number of joints, u = 2⁻⁵³. A table is "
        f"well-conditioned where the largest of its |d| and |a| is at most {FAR} R. Two axes too nearly parallel for a "
        "table in float64 are taken as parallel, which from_chain has to say: such a table is judged by its bound. "
        "Rotations are compared as they are, lengths ÷ R.\n\n"
        "The calibrated arm is a real UR10e, its table as its maker publishes it: the calibration found two axes not "
        f"quite parallel, so that an entry of the table is {far_entry} m. Both forms are evaluated in float32 and "
        "compared with float64.",
        figures=[
            Figure(
                "random DH tables → POE against 60 digits, well-conditioned", max(near, default=None), WELL, "R",
                note=f"{len(near)} tables",
            ),
            Figure(
                f"the same, tables with |d| or |a| above {FAR} R: error ÷ 100 u n (R + max(|d|, |a|))",
                max(far, default=None), 1, note=f"{len(far)} tables",
            ),
            *trip_figures("POE → DH → POE of these, both conventions", trips),
            Figure(
                "calibrated UR10e: largest entry of any screw", float(np.abs(dh.to_chain(UR10E).screws).max()), 1.2,
                note=f"the table's largest is {far_entry} m",
            ),
            Figure(
                "calibrated UR10e in float32, POE: worst position error", float(single["POE"].max()), 1e-6, "m",
                note=f"{CONFIGURATIONS} random configurations",
            ),
            Figure(
                "calibrated UR10e in float32, DH: worst position error", float(single["DH"].max()), unit="m",
                bar_shown="> 1e-05 m", holds=bool(single["DH"].max() > 1e-5), note="the same configurations",
            ),
        ],
        tables=[
            Table(
                f"Calibrated UR10e in float32: position error over {CONFIGURATIONS} random configurations (m)",
                ("form", "median", "nine in ten below", "worst"),
                [(form, *map(float, np.quantile(off, (0.5, 0.9, 1.0)))) for form, off in sorted(single.items())],
            ),
            Table("What is in the random tables", ("what", "how many"), _contents(tables), folded=True),
        ],
    )  # fmt: skip


def trip_figures(what: str, trips: list[Trip]) -> list[Figure]:
    """Three figures of chains that became tables and chains again: those near, and the rest against
    their bounds.
    """
    near, rest = [t for t in trips if t.well], [t for t in trips if not t.well]
    dropped = [angle for t in trips for angle in t.dropped]
    said = (
        f"; {len(dropped)} angles dropped and said, the largest {short(max(dropped))} rad"
        if dropped
        else ""
    )
    return [
        Figure(
            f"{what}: pose, well-conditioned", max((t.error for t in near), default=None), WELL, "R",
            note=f"{len(near)} tables",
        ),
        Figure(
            f"{what}: the others, error ÷ bound that the result reports",
            max((t.error / t.bound for t in rest), default=None), 1, note=f"{len(rest)} tables{said}",
            error=f"{short(max(t.error for t in rest))} R" if rest else "",
        ),
        Figure(
            f"{what}: that bound ÷ (100 u n (R + max(|d|, |a|)) + 2 δ L for angles δ dropped, L the lengths)",
            max((t.bound / t.ceiling for t in rest), default=None), 1, note=f"{len(rest)} tables",
        ),
    ]  # fmt: skip


def random_table(rng: np.random.Generator, convention: dh.Convention) -> dh.Table:
    """A table with all that tables go wrong on; one in four is far, as calibration makes them.

    Far: between two axes 1e-5 to 1e-2 rad off parallel, one d is 10 to 3000 m up and the next as
    much down.
    """
    count = int(rng.integers(1, 11))
    rows = np.array([[_angle(rng), _length(rng), _length(rng), _angle(rng)] for _ in range(count)])
    if count > 1 and rng.random() < 0.25:
        i, up = int(rng.integers(count - 1)), 10 ** rng.uniform(1, 3.5)
        rows[i : i + 2, 1] += up, -up
        rows[i + (convention == "modified"), 3] = rng.choice([-1, 1]) * 10 ** rng.uniform(-5, -2)
    listed = [
        dh.Row(*numbers, kind=KINDS[rng.integers(2)], flip=bool(rng.random() < 0.5))
        for numbers in rows.tolist()
    ]
    base, tool = se3.exp(rng.normal(size=(2, 6)))
    return dh.Table(convention, listed, base=base, tool=tool)


def _angle(rng: np.random.Generator) -> float:
    """In thirds: a right angle or none, one that is 1e-12 to 1e-3 off, and any."""
    quarter, sort = float(rng.choice(QUARTERS)), rng.integers(3)
    if sort == 2:
        return float(rng.uniform(-3, 3))
    return quarter + float(rng.choice([-1, 1]) * 10 ** rng.uniform(-12, -3)) * bool(sort)


def _length(rng: np.random.Generator) -> float:
    """In thirds: 0, 1e-12 to 1e-3 m, and up to 2 m."""
    sort = rng.integers(3)
    sizes = (
        0.0,
        float(rng.choice([-1, 1]) * 10 ** rng.uniform(-12, -3)),
        float(rng.uniform(-2, 2)),
    )
    return sizes[sort]


def _contents(tables: list[dh.Table]) -> list[tuple[str, int]]:
    rows = [row for table in tables for row in table.rows]
    off = [min(abs(row.alpha - quarter) for quarter in QUARTERS) for row in rows]
    lengths = [abs(length) for row in rows for length in (row.a, row.d)]
    kinds = Counter(row.kind for row in rows)
    return [
        ("tables", len(tables)),
        ("joints", len(rows)),
        *((f"{kind} joints", number) for kind, number in sorted(kinds.items())),
        ("flipped joints", sum(row.flip for row in rows)),
        ("alpha of 0, ±90° or 180° to the last digit", sum(x == 0 for x in off)),
        ("alpha that is off these by 1e-12 to 1.1e-3 rad", sum(0 < x <= 1.1e-3 for x in off)),
        ("a or d of 0", lengths.count(0.0)),
        ("a or d of 1e-12 to 1e-3 m", sum(0 < x <= 1e-3 for x in lengths)),
        ("d above 9 m", sum(abs(row.d) > 9 for row in rows)),
    ]
