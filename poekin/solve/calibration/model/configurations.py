"""Configurations of readings: which rows of q are the same, but for what joints scatter by; the
folds that they are drawn into, and the mean of what was measured at each.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal, NamedTuple, overload

import numpy as np
from numpy.typing import NDArray

from ....errors import InputError, ShapeError, safe_repr
from ....groups import se3
from ....groups.arrays import Array
from ....groups.vectors import rotation_part, translation_part
from ....model.checks import finite
from ..measurements.measurement import Measurement, Rows, rows_of

Repeats = Literal["keep", "average"]
NEAR = 1e-3
"""rad or m: readings that differ by less, one by one, are of one configuration."""


def configurations(q: Array) -> NDArray[np.intp]:
    """Number (N,) of the configuration of each of the readings (N, m), from 0 in order of first
    appearance.

    Coordinate by coordinate, twice, the rows of a group are sorted, and parted where a gap is wide.
    """
    count = len(q)
    label = np.zeros(count, np.intp)
    for column in np.tile(q, 2).T:
        order = np.lexsort((column, label))
        apart = np.diff(label[order]).astype(bool)
        apart |= np.diff(column[order]) > NEAR
        label[order[1:]] = np.cumsum(apart)
    _, first, label = np.unique(label, return_index=True, return_inverse=True)
    rank = np.empty(len(first), np.intp)
    rank[np.argsort(first)] = np.arange(len(first))
    return rank[label]


class Folds(NamedTuple):
    """Number of folds, and the seed by which configurations are drawn into them."""

    count: int
    seed: int

    def of(self, label: NDArray[np.intp]) -> NDArray[np.intp]:
        """Fold (N,) of each reading; label (N,), its configuration."""
        _, first = np.unique(label, return_index=True)
        order = np.random.default_rng(self.seed).permutation(len(label))
        # each configuration as its first reading is drawn
        order = label[order[np.isin(order, first)]]
        found = np.empty(len(first), np.intp)
        for k, drawn in enumerate(np.array_split(order, self.count)):
            found[drawn] = k
        return found[label]


@overload
def average_repeats(q: Any, measurements: Measurement) -> tuple[Array, Measurement]: ...
@overload
def average_repeats(
    q: Any, measurements: Measurement, conditions: Mapping[str, Any]
) -> tuple[Array, Measurement, dict[str, Array]]: ...
def average_repeats(
    q: Any, measurements: Measurement, conditions: Mapping[str, Any] | None = None
) -> tuple[Array, Measurement] | tuple[Array, Measurement, dict[str, Array]]:
    """Means of the measurements at readings that are the same to 1 mrad and 1 mm.

    `calibrate` takes repeated rows as they are: it holds them out together, and its intervals do
    not count them as independent. The means make a large file small, and hide the scatter.

    Parameters
    ----------
    q : (N, m) array_like
        Joint readings, rad or m.
    measurements : Poses, EyeInHand, EyeToHand, Points or Distances
        Measurements at rows of q.
    conditions : mapping of str to (N,) array_like, optional
        Columns at the rows of q, as `calibrate` takes them: payload, temperature, time. Rows under
        another payload, by more than 1 g, are no repeats.

    Returns
    -------
    q : (K, m) ndarray
        Mean readings of each configuration, in order of first appearance.
    measurements : Measurement
        The mean of what was measured at each, in its frame, and its covariance where one was given.
    conditions : dict of str to (K,) ndarray
        Mean conditions of each; only where conditions were given.

    Raises
    ------
    InputError
        If `measurements` is none, or a reading or condition is not finite.
    ShapeError
        If q has no row for a measurement, or a condition no number for a row.

    Notes
    -----
    Accuracy: rotations are the projected arithmetic mean. Source: Moakher 2002, "Means and
    averaging in the group of rotations" (SIAM J. Matrix Analysis 24).

    Examples
    --------
    >>> import poekin as pk
    >>> twice = pk.calibration.Points([[1, 0, 0], [1.002, 0, 0], [2, 0, 0]])
    >>> q, points = pk.calibration.average_repeats([[0.1], [0.1], [0.5]], twice)
    >>> q.shape, points.p[:, 0, 0].round(6).tolist()
    ((2, 1), [1.001, 2.0])
    """
    if not isinstance(measurements, Measurement):
        raise InputError(
            "measurements: expected Poses, Points, Distances, EyeInHand or EyeToHand, got "
            f"{safe_repr(measurements)}"
        )
    q = finite(q, "q")
    rows = rows_of(measurements, len(measurements))
    if q.ndim != 2 or rows.max(initial=-1) >= len(q):
        raise ShapeError(
            f"q: expected readings (N, m) with a row for each of {len(measurements)} {measurements.what}, "
            f"got shape {q.shape}"
        )
    columns = {}
    for name, values in (conditions or {}).items():
        column = finite(values, f"conditions[{name!r}]")
        if column.shape != (len(q),):
            raise ShapeError(
                f"conditions[{name!r}]: expected a number for each of {len(q)} rows of q, got shape {column.shape}"
            )
        columns[name] = column
    found = averages(q, rows, measurements, columns)
    if conditions is None:
        return found.q, found.measurements
    return found.q, found.measurements, found.conditions


class Averages(NamedTuple):
    """Means of readings q (K, m), of what was measured at each and of columns (K,) of conditions, and
    the first (K,) measurement of each.
    """

    q: Array
    measurements: Measurement
    conditions: dict[str, Array]
    first: Rows


def averages(
    q: Array,
    rows: Rows,
    s: Measurement,
    conditions: Mapping[str, Array],
) -> Averages:
    """Means over the rows of one configuration, and of one payload where there are several."""
    told_apart = [q]
    if "payload" in conditions:
        told_apart.append(conditions["payload"][:, None])
    label = configurations(np.concatenate(told_apart, axis=1)[rows])
    _, first, counts = np.unique(label, return_index=True, return_counts=True)

    def mean(values: Array) -> Array:
        sums = np.zeros((len(counts), *values.shape[1:]))
        np.add.at(sums, label, values)
        return sums / counts.reshape(-1, *[1] * (values.ndim - 1))

    measured = mean(s.measured)
    if measured.shape[1:] == (4, 4):
        measured = _projected(measured)
    C = None
    if s.covariance is not None:
        # of a mean of k independent ones: the sum of covariances / k^2
        C = mean(s.covariance) / counts[:, None, None]
    means = s.subset(first).with_rows(None).with_measured(measured, C)
    of_conditions = {name: mean(values[rows]) for name, values in conditions.items()}
    return Averages(mean(q[rows]), means, of_conditions, first)


def _projected(T: Array) -> Array:
    """Poses whose rotations are those nearest to the matrices in T (K, 4, 4)."""
    U, _, Vt = np.linalg.svd(rotation_part(T))
    return se3.pose(U @ Vt, translation_part(T))
