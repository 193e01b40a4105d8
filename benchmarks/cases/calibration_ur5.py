"""A real arm: positions of a UR5's reflector by a laser tracker, data kept aside."""

from __future__ import annotations

import os
from pathlib import Path
from typing import NamedTuple

import numpy as np

from poekin import dh
from poekin.groups import so3
from poekin.model.chain import Chain
from poekin.solve import calibration as cal
from poekin.solve.calibration.model.parameters import Unit

from ..report import Figure, Table, Topic, short

VARIABLE = "POEKIN_UR5_DATA"
PLACE = Path(__file__).resolve().parents[3] / "shared" / "data" / "ur5_laser_tracker"
FIT, JUDGE = "grid_1000.csv", "test_20.csv"
POINT = np.array([-1e-6, 90e-6, 31e-3])  # of the reflector in tool0, m
PRIOR: dict[Unit, float] = {
    "rad": 1e-2,
    "m": 1e-2,
}  # the reflector is on the last axis, whose tilt it hardly shows
GEOMETRY, TERMS = 0.101, 0.090  # bars: mean error on the positions kept aside, mm
WITHIN = {0.68: (1.0, 12, 16), 0.95: (1.959964, 18, 20)}  # deviations, and bars of 20

WORDS = (
    "1000 positions of a UR5's reflector by a laser tracker to fit, 20 others to judge (P. Jacobi, "
    "serial_robots_datasets, MIT licence, values unchanged). The terms are chosen from the 1000 alone, by their own "
    "held-out folds. The thesis that the data comes from reaches 0.155 mm by DH parameters and a graph neural network. "
    f"The data is not part of the repository: {VARIABLE} names its folder, or it stands in shared/data beside the "
    "repository."
)


class Measured(NamedTuple):
    """Joint readings, rad, and positions of the reflector, m."""

    q: np.ndarray
    p: np.ndarray


class Judged(NamedTuple):
    """A calibration, its errors at the positions kept aside, mm, and the share of coordinates within
    the intervals that it foretells, times 20.
    """

    found: cal.Calibration
    errors: np.ndarray
    within: dict[float, float]


def topic(quick: bool, say) -> Topic:  # type: ignore[no-untyped-def]
    place = data_folder()
    if not (place / FIT).is_file():
        say(f"{FIT} is not there")
        return absent()
    chain = dh.to_chain(dh.published("ur5"))
    data = read(place / FIT)
    kept = read(place / JUDGE)
    geometric = judged(chain, data, kept, ("screws", "home"))
    chosen = judged(chain, data, kept, "auto")
    say(f"{short(geometric.errors.mean())} mm, with terms {short(chosen.errors.mean())} mm")
    return report(geometric, chosen)


def data_folder() -> Path:
    """Where the measurements ought to be."""
    return Path(os.environ.get(VARIABLE) or PLACE)


def read(path: Path) -> Measured:
    """Readings and measured positions: target - difference."""
    table = np.genfromtxt(path, delimiter=",", names=True)
    q, target, difference = (
        np.column_stack([table[name] for name in names])
        for names in (
            [f"joint_{k + 1}" for k in range(6)],
            ("x_t", "y_t", "z_t"),
            ("x_dif", "y_dif", "z_dif"),
        )
    )
    return Measured(np.deg2rad(q), 1e-3 * (target - difference))


def judged(chain: Chain, data: Measured, kept: Measured, parameters) -> Judged:  # type: ignore[no-untyped-def]
    """A calibration from the data, judged by what was kept aside."""
    found = cal.calibrate(
        chain, data.q, cal.Points(data.p, POINT), parameters=parameters, prior=PRIOR
    )
    T = found.chain.fk(found.true_joints(kept.q))
    off = T[:, :3] @ [*POINT, 1.0] - kept.p
    G = np.zeros((len(off), 3, 6))  # of the point, per rotation and shift of the tip
    G[:, :, :3] = -so3.hat(T[:, :3, :3] @ POINT)
    G[:, :, 3:] = np.eye(3)
    C = G @ found.pose_covariance(kept.q) @ np.swapaxes(G, 1, 2)
    (noise,) = found.noise_std
    if noise is None:
        raise RuntimeError("no covariance was given, and no noise estimated")
    sizes = np.abs(off) / np.sqrt(np.diagonal(C, axis1=1, axis2=2) + noise.length**2)
    within = {share: 20 * float(np.mean(sizes <= most)) for share, (most, *_) in WITHIN.items()}
    return Judged(found, 1e3 * np.linalg.norm(off, axis=1), within)


def report(geometric: Judged, chosen: Judged) -> Topic:
    """The topic of what was found."""
    added = ", ".join(map(str, chosen.found.error_model.kinds[2:])) or "nothing"
    figures = [
        Figure("mean error of 20 positions, geometry", float(geometric.errors.mean()), GEOMETRY, "mm",
               note=f"largest {short(geometric.errors.max())} mm"),
        Figure("mean error of 20 positions, terms chosen", float(chosen.errors.mean()), TERMS, "mm",
               note=f"{added}; largest {short(chosen.errors.max())} mm"),
    ]  # fmt: skip
    for share, (_, least, most) in WITHIN.items():
        of_20 = chosen.within[share]
        figures.append(
            Figure(f"coordinates within their {share:.0%} interval, of 20", of_20,
                   bar_shown=f"{least} to {most}",
                   holds=least <= round(of_20, 6) <= most,
                   note=f"geometry: {short(geometric.within[share])}")
        )  # fmt: skip
    rows = [
        (t.name, "yes" if t.chosen else "no", t.coefficients, short(1e3 * t.gain), short(1e3 * t.deviation))
        for t in chosen.found.terms
    ]  # fmt: skip
    heads = ("term", "chosen", "coefficients", "gain on held-out folds (mm)", "±")
    table = Table("What each term brings beside the chosen ones", heads, rows)
    return Topic("A real UR5, positions kept aside", WORDS, figures, tables=[table])


def absent() -> Topic:
    """The rows of a report without the data: they say so, and no bar is held or missed."""
    note = f"not measured: the data is outside the repository; {VARIABLE} names its folder, which is not there"
    names = {"geometry": GEOMETRY, "terms chosen": TERMS}
    figures = [
        Figure(f"mean error of 20 positions, {name}", None, bar_shown=f"≤ {short(bar)} mm", note=note)
        for name, bar in names.items()
    ]  # fmt: skip
    return Topic("A real UR5, positions kept aside", WORDS, figures)
