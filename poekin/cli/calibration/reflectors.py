"""Reflectors whose places on the tool are not known, and a file of the distances between them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ...errors import InputError
from ...formats.poses.read import said_units
from ...formats.text import csv_rows
from ...formats.text.csv_header import Columns
from ...groups.arrays import Array
from ...solve.calibration.measurements.header import Convention
from ...solve.calibration.measurements.points import Points
from ...solve.calibration.measurements.separations import Separations
from ..array_files import called, to_open
from ..output import path_text

UNKNOWN = "unknown"
SHARED = "tool"
"""Name of the points that all files have in common."""
COLUMNS = ("from", "to", "distance", "sigma")


def are_unknown(points: Sequence[str]) -> bool:
    """Whether --point says that nobody knows the points. Raises: InputError."""
    unknown = [text for text in points if text.strip().lower() == UNKNOWN]
    if unknown and points[1:]:
        raise InputError(f"--point {UNKNOWN}: expected once and alone, for all points of the files")
    return bool(unknown)


def with_separations(
    sets: Sequence[Any],
    paths: Sequence[str],
    separations: str | None,
    convention: Convention,
) -> list[Separations]:
    """The known distances between unknown points of these sets, if there is a file of them.

    Raises: InputError where sets do not have the same points; as `_read`.
    """
    measured = [(s, path) for s, path in zip(sets, paths, strict=True) if isinstance(s, Points)]
    first, where = measured[0]
    count = first.p.shape[1]
    for s, path in measured:
        if s.p.shape[1] != count:
            raise InputError(
                f"{path_text(path)}: {s.p.shape[1]} points a line, and {count} in {path_text(where)}: "
                f"--point {UNKNOWN} is of the same points in all files"
            )
    if separations is None:
        return []
    table = _read(separations, count, convention)
    return [Separations(table.d, SHARED, table.variances)]


class _Distances(NamedTuple):
    """Distances d (k, k), m, NaN where unknown, and variances of those that are known."""

    d: Array
    variances: Array


def _read(given: str, count: int, convention: Convention) -> _Distances:
    """Distances between so many points, in the lines of a file. Raises: InputError with file and line."""
    lengths = (convention.length, convention.length)
    columns = Columns(COLUMNS, "column", ("", "", *lengths), said_units(convention.mm, None))
    with csv_rows.opened(to_open(given, "separations"), called(given)) as (stream, where, size):
        rows, lines = csv_rows.read(stream, columns, where, None, size)
    if not len(rows):
        raise InputError(f"{where}: expected distances between points, got none")
    d = np.full((count, count), np.nan)
    variances = np.empty((count, count))
    for row, line in zip(rows.tolist(), lines, strict=True):
        here = f"{where}:{line}"
        i, j = (_point(number, count, here) for number in row[:2])
        distance, sigma = (x / 1000.0 if convention.mm else x for x in row[2:])
        if i == j:
            raise InputError(f"{here}: expected two different points, got {i + 1} twice")
        if not np.isnan(d[i, j]):
            raise InputError(f"{here}: the distance of {i + 1} and {j + 1} is there twice")
        for name, x in (("distance", distance), ("sigma", sigma)):
            if not 0.0 < x < np.inf:
                raise InputError(f"{here}: expected a {name} above 0, got {x:g} m")
        d[i, j] = d[j, i] = distance
        variances[i, j] = variances[j, i] = sigma**2
    known = np.triu(~np.isnan(d))
    return _Distances(d, variances[known])


def _point(number: float, count: int, here: str) -> int:
    """Index of a point by its number, counted from 1 as the columns x1, x2 are."""
    if number not in range(1, count + 1):
        raise InputError(f"{here}: expected the number of a point, 1 to {count}, got {number:g}")
    return int(number) - 1
