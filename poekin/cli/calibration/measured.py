"""The measurements that `poekin calibrate` is given: files, and what the options say of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from ...errors import InputError
from ...groups.arrays import Array
from ...model.chain import Chain
from ...solve.calibration.measurements import data
from ...solve.calibration.measurements.measurement import Measurement
from ..kinematics import poses
from ..output import Progress, path_text


class Said(NamedTuple):
    """What the options say of measurements: see the help of each."""

    kind: Sequence[str]
    point: Sequence[str]
    centre: str | None
    frame: str | None
    sigma_angle: float | None
    sigma_length: float | None
    ignore: Sequence[str]


class Measured(NamedTuple):
    """Joint readings q (N, m), the sets of measurements made at them, and the file and line of each
    row of q.
    """

    q: Array
    sets: list[Measurement]
    sources: list[str]


_TAKES = {"points": ("point", "frame"), "distances": ("point", "centre")}
"""The options that say something of measurements of a kind."""


def read(paths: Sequence[str], chain: Chain, said: Said) -> Measured:
    """The measurements in files, one set a file.

    Raises: what `data.read` does; InputError for options that do not fit.
    """
    kinds = list(said.kind) * (len(paths) if len(said.kind) == 1 else 1) or [None] * len(paths)
    if len(kinds) != len(paths):
        raise InputError(
            f"--kind: expected one for all files or one for each of {len(paths)}, got {len(kinds)}"
        )
    tables = []
    for path, kind in zip(paths, kinds, strict=True):
        with Progress(f"reading {path_text(path)}") as progress:
            tables.append(
                data.read_table(path, chain, kind=kind, ignore=said.ignore, progress=progress)
            )
    made = [kind or table.layout.kinds[0] for kind, table in zip(kinds, tables, strict=True)]
    _check_fit(said, made)
    readings, sets, sources = [np.empty((0, chain.dof))], [], []
    for kind, table in zip(made, tables, strict=True):
        measured = data.measurement_of(
            table, kind, _known(said, kind, len(table.layout.columns) // 3)
        )
        readings.append(table.q)
        sets.append(replace(measured, rows=np.arange(len(table.q)) + len(sources)))  # type: ignore[type-var]
        sources += table.places
    return Measured(np.concatenate(readings), sets, sources)


def _check_fit(said: Said, kinds: Sequence[str]) -> None:
    """Refuse options of which no file knows anything."""
    for name in ("point", "frame", "centre"):
        takers = [kind for kind, takes in _TAKES.items() if name in takes]
        if getattr(said, name) and not set(kinds) & set(takers):
            raise InputError(
                f"--{name}: expected with {' or '.join(takers)} only, got {', '.join(dict.fromkeys(kinds))}"
            )
    for sigma, option in (
        (said.sigma_angle, "--sigma-angle"),
        (said.sigma_length, "--sigma-length"),
    ):
        if sigma is not None and not 0 < sigma < np.inf:
            raise InputError(f"{option}: expected a standard deviation above 0, got {sigma:g}")
    if said.sigma_angle is not None and not any(_angular(kind) for kind in kinds):
        raise InputError(
            "--sigma-angle: expected with measured poses only, and there are lengths alone"
        )
    if (said.sigma_angle is None) != (said.sigma_length is None) and any(map(_angular, kinds)):
        raise InputError(
            "--sigma-angle and --sigma-length: of measured poses, both expected or neither"
        )


def _angular(kind: str) -> bool:
    return bool(data.KINDS.get(kind, Measurement).angular)


def _known(said: Said, kind: str, points: int) -> dict[str, Any]:
    """What else `data.read` is to be told of measurements of this kind."""
    known: dict[str, Any] = {}
    takes = _TAKES.get(kind, ())
    if said.sigma_length is not None:
        angular = _angular(kind)
        lengths = 3 if angular else 3 * points if kind == "points" else 1
        deviations = [said.sigma_angle] * 3 * angular + [said.sigma_length] * lengths
        known["covariance"] = np.diag(np.square(np.array(deviations, float)))
        if kind == "distances":
            known["covariance"] = said.sigma_length**2
    if said.point and "point" in takes:
        places = np.array([vector(text, "--point") for text in said.point])
        # of several, distances are to the first
        known |= {"points": places} if kind == "points" else {"point": places[0]}
    if said.frame is not None and "frame" in takes:
        known["frame"] = said.frame
    if said.centre is not None and "centre" in takes:
        known["centre"] = vector(said.centre, "--centre")
    return known


def vector(text: str, option: str) -> Array:
    """Three numbers, commas or blanks between them. Raises: InputError."""
    values = poses.numbers(text.replace(",", " ").split(), f"{option}: number")
    if len(values) != 3:
        raise InputError(f"{option}: three numbers expected (x,y,z in m), got {len(values)}")
    return values
