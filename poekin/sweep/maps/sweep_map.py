"""A map: how many samples fell into each cell, and the best measure there."""

from __future__ import annotations

import math
import os
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from ...checks import is_real
from ...errors import FileError, InputError, UnknownName, safe_repr
from ...groups.arrays import Array
from ...model.chain import Chain
from ...results import Result
from ..cells import Cells, cells_from
from ..execution.totals import NO_SAMPLE, Totals
from ..measures.names import LABELS
from ..pose_samples import NumberedPoses, read_samples
from ..samples import Samples
from ..solutions import best_solutions
from ..sweep import Sweep
from . import labelled, map_files
from .kept_map import ARRAYS, KeptMap

_AT_ONCE = 2**16  # poses that are in memory at once


@dataclass(frozen=True, eq=False)
class SweepMap(Result):
    """Map that a sweep has found; the result of `run` and `reach`.

    Attributes
    ----------
    about : dict
        The sweep as plain data.
    cells : Cells
        Where the cells are.
    samples : Random, Sobol, Grid, PoseSamples or PoseGrid
        The configurations, or the poses.
    counts : (nx, ny, nz) or (nx, ny, nz, tiles) ndarray of int
        Number of samples in each cell; of poses those that are reached.
    outside : int
        Number of samples in none of them.
    best : (nx, ny, nz) or (nx, ny, nz, tiles) ndarray or None
        Measure that is kept of each cell, the best, the worst or the mean as about["keep"] says, in
        SI units (rad, m), NaN in an empty one; None of a sweep that only counts.
    attained : (nx, ny, nz) or (nx, ny, nz, tiles) ndarray of int or None
        Number of the first sample with that measure, -1 in an empty cell; None of means too.
    sweep : Sweep or None
        The sweep itself; None of a map that was read from a file.
    """

    left_out: ClassVar = ("cells", "samples", "counts", "best", "attained", "sweep")
    derived: ClassVar = ("reached_volume", "capability_range", "new_cell_chance")

    about: dict[str, Any]
    cells: Cells
    samples: Samples | NumberedPoses
    counts: np.ndarray
    outside: int
    best: Array | None = None
    attained: np.ndarray | None = None
    sweep: Sweep | None = None

    @property
    def chain(self) -> Chain | None:
        """The arm; None of a map that was read from a file."""
        return None if self.sweep is None else self.sweep.chain

    @property
    def reached(self) -> np.ndarray:
        """Whether a sample fell into each cube (nx, ny, nz); no unit."""
        if self.cells.side:
            return np.any(self.counts, axis=-1)
        return np.greater(self.counts, 0)

    @property
    def capability(self) -> Array:
        """Share of the directions that the tool takes in each cube (nx, ny, nz), 0 to 1, no unit.

        Raises: InputError, of a sweep without directions.
        """
        if not self.cells.side:
            raise InputError("capability: the sweep has no directions (side=0)")
        return np.count_nonzero(self.counts, axis=-1) / self.cells.tiles

    @property
    def reached_share(self) -> Array:
        """Share of the poses tried in each cell (nx, ny, nz) or (nx, ny, nz, tiles) that are reached.

        No unit; NaN where none was tried.

        Raises: InputError, of a sweep of configurations.
        """
        samples = self.samples
        if not isinstance(samples, NumberedPoses):
            raise InputError("reached_share: expected a map of poses, this is of configurations")
        tried = np.zeros(self.cells.count, np.int64)
        for first in range(0, samples.count, _AT_ONCE):
            numbers = np.arange(first, min(first + _AT_ONCE, samples.count))
            found = self.cells.find(samples.poses(numbers))
            tried += np.bincount(found[found >= 0], minlength=len(tried))
        tried = tried.reshape(self.counts.shape)
        return np.where(tried > 0, self.counts / np.maximum(tried, 1), np.nan)

    @property
    def reached_volume(self) -> float:
        """Volume of the cubes that were reached, m³."""
        return float(np.count_nonzero(self.reached)) * self.cells.resolution**3

    @property
    def capability_range(self) -> tuple[float, float] | None:
        """Mean and greatest capability of the cubes that were reached; None without directions."""
        if not self.cells.side or not self.reached.any():
            return None
        shares = self.capability[self.reached]
        return float(shares.mean()), float(shares.max())

    @property
    def new_cell_chance(self) -> float:
        """Chance that a further random sample would fall into an empty cell, no unit.

        It is the share of the samples that are alone in their cell (Good 1953).
        """
        return np.count_nonzero(self.counts == 1) / self.samples.count

    @property
    def masked(self) -> int:
        """Number of samples that the sweep's mask left out; of poses those that are not reached."""
        return self.samples.count - int(self.counts.sum()) - self.outside

    def summary(self) -> str:
        """Numbers of samples, and how much was reached.

        Returns
        -------
        text : str
            Lines such as "3.2 m³ of 14.1 m³ reached in cubes of 50 mm".
        """
        cells = self.cells
        whole = float(np.prod(cells.shape)) * cells.resolution**3
        lines = [
            self._counted(),
            f"{self.reached_volume:.4g} m³ of {whole:.4g} m³ reached, in cubes of {1e3 * cells.resolution:.4g} mm",
        ]
        if self.capability_range is not None:
            mean, most = self.capability_range
            lines.append(
                f"of {cells.tiles} directions of the tool {100 * mean:.3g} % in the mean of these cubes, "
                f"{100 * most:.3g} % in the best"
            )
        if self.best is not None and self.reached.any():
            label = LABELS[self.about["measure"]]
            least = np.nanmin(self.best)
            most = np.nanmax(self.best)
            ends = label.between(float(least), float(most))
            lines.append(f"{self.about['keep']} {label.words} of a cell: {ends}")
        if not isinstance(self.samples, NumberedPoses):
            chance = 100 * self.new_cell_chance
            lines.append(
                f"a further configuration would fall into an empty cell with a chance of {chance:.2g} %"
            )
        return "\n".join(lines)

    def _counted(self) -> str:
        count = self.samples.count
        if isinstance(self.samples, NumberedPoses):
            reached = count - self.masked
            share = 100 * reached / count
            return f"{count} poses, {reached} of them reached ({share:.3g} %), {self.outside} of these outside the map"
        words = f"{count} configurations, {self.outside} of them outside the map"
        if "mask" in self.about:
            words += f", {self.masked} left out as the arm touches itself"
        return words

    def query(self, T: ArrayLike) -> np.ndarray:
        """Number of samples in the cells of poses.

        Parameters
        ----------
        T : (..., 4, 4) array_like
            Poses of the tip in the base frame, m.

        Returns
        -------
        counts : (...) ndarray of int
            Numbers of samples; 0 outside of the map.

        Raises
        ------
        PoseError
            If an element of T is no pose.
        ShapeError
            If T has another shape.

        Notes
        -----
        Accuracy: as `Cells.find`. Source: as `reach`.
        """
        found = self.cells.find(T)
        return np.where(found < 0, 0, self.counts.reshape(-1)[found])

    def slice(self, axis: str, at: float) -> np.ndarray:
        """The cells of one layer of cubes.

        Parameters
        ----------
        axis : {"x", "y", "z"}
            Axis of the base frame that the layer is across.
        at : float
            Place on it, m.

        Returns
        -------
        counts : (n1, n2) or (n1, n2, tiles) ndarray of int
            Counts without that axis.

        Raises
        ------
        UnknownName
            If there is no such axis.
        InputError
            If the map does not reach there.
        """
        if axis not in ("x", "y", "z"):
            raise UnknownName(f"axis: expected 'x', 'y' or 'z', got {axis!r}")
        along = "xyz".index(axis)
        start = self.cells.corner[along]
        most = self.cells.shape[along]
        end = start + most * self.cells.resolution
        if not (is_real(at) and start <= at < end):
            place = f"{axis} within {start:g} ... {end:g} m"
            raise InputError(f"at: expected {place}, got {safe_repr(at)}")
        number = min(math.floor((at - start) * self.cells.place()[3]), most - 1)
        return np.take(self.counts, number, axis=along)

    def configurations(self, cells: Any = ...) -> Array:
        """The configurations with the best, or the worst, measure; of poses their best solutions.

        Parameters
        ----------
        cells : index, optional
            Index of the arrays (counts.shape); all by default.

        Returns
        -------
        q : (..., m) ndarray
            Configurations, rad or m; NaN for an empty cell.

        Raises
        ------
        InputError
            If the sweep has no measure, or means, or is one of poses read from a file.
        """
        numbers = self._attained(cells, "configurations")
        known = numbers != NO_SAMPLE
        q = np.full((*numbers.shape, len(self.about["q_names"])), np.nan)
        if not isinstance(self.samples, NumberedPoses):
            q[known] = self.samples.configurations(numbers[known])
            return q
        sweep = self.sweep
        if sweep is None:
            raise InputError(
                "configurations: a map of poses out of a file does not know its arm; ik_all of `poses` does"
            )
        T = self.samples.poses(numbers[known])
        found = best_solutions(sweep.chain, T, sweep.measured, sweep.mask)
        q[known] = found.configurations()
        return q

    def poses(self, cells: Any = ...) -> Array:
        """The poses with the best, or the worst, measure.

        Parameters
        ----------
        cells : index, optional
            Index of the arrays (counts.shape); all by default.

        Returns
        -------
        T : (..., 4, 4) ndarray
            Poses of the tip in the base frame, m; NaN for an empty cell.

        Raises
        ------
        InputError
            If the sweep has no measure, or means, or is one of configurations.
        """
        numbers = self._attained(cells, "poses")
        if not isinstance(self.samples, NumberedPoses):
            raise InputError("poses: expected a map of poses, this is of configurations")
        known = numbers != NO_SAMPLE
        T = np.full((*numbers.shape, 4, 4), np.nan)
        T[known] = self.samples.poses(numbers[known])
        return T

    def _attained(self, cells: Any, what: str) -> np.ndarray:
        if self.attained is None:
            raise InputError(f"{what}: the sweep only counts (measure='reach'), or keeps means")
        return np.asarray(self.attained[cells])

    def to_xarray(self) -> Any:
        """The map as a dataset of xarray.

        Returns
        -------
        labelled : xarray.Dataset
            `counts`, and of a measured sweep `best` and `attained`, along x, y and z (centres of
            the cubes in the base frame, m) and the tiles, whose centres are `direction`.

        Raises
        ------
        MissingExtra
            If xarray is not installed (extra "sweep").
        """
        return labelled.dataset(self._kept(), self.cells)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the map so that it appears whole or not at all; an old one is replaced.

        Parameters
        ----------
        path : path
            A .npz file, of NumPy; or a .zarr directory, which `xarray.open_zarr` reads too.

        Raises
        ------
        FileError
            If it cannot be written.
        InputError
            If the path ends otherwise, or is a directory that holds something else.
        MissingExtra
            If a .zarr is asked for and xarray or Zarr is not installed (extra "sweep").
        """
        map_files.write(path, self._kept(), self.cells)

    def _kept(self) -> KeptMap:
        every = {"counts": self.counts, "best": self.best, "attained": self.attained}
        arrays = {name: values for name, values in every.items() if values is not None}
        return KeptMap(self.about, arrays, self.outside)


def map_of(sweep: Sweep, totals: Totals) -> SweepMap:
    """The map of what a sweep has added up."""
    cells = sweep.cells
    if not isinstance(cells, Cells):
        raise InputError(f"map: expected a sweep of Cells, got {type(cells).__name__}")
    shape = cells.array_shape
    best = None
    attained = None
    if totals.rule == "sum":
        best = np.where(totals.counts > 0, totals.means(), np.nan).reshape(shape)
    elif totals.rule == "extreme":
        attained = totals.attained.reshape(shape)
        best = np.where(attained == NO_SAMPLE, np.nan, sweep.sign * totals.best.reshape(shape))
    counts = totals.counts.reshape(shape)
    found = (sweep.samples, counts, totals.outside, best, attained)
    return SweepMap(sweep.describe(), cells, *found, sweep)


def load_map(path: str | os.PathLike[str]) -> SweepMap:
    """Reads a map that `SweepMap.save` has written.

    Parameters
    ----------
    path : path
        The .npz file, or the .zarr directory.

    Returns
    -------
    found : SweepMap
        The map.

    Raises
    ------
    FileError
        If there is no such file, or it holds no map.
    InputError
        If the path ends otherwise.
    MissingExtra
        If a .zarr is to be read and xarray or Zarr is not installed (extra "sweep").
    """
    about, arrays, outside = map_files.read(path)
    try:
        cells = cells_from(about)
        samples = read_samples(about["samples"])
        counts, best, attained = (arrays.get(name) for name in ARRAYS)
        if counts is None:
            raise KeyError("counts")
        return SweepMap(about, cells, samples, counts, outside, best, attained)
    except (ValueError, KeyError, TypeError) as error:
        raise FileError(f"{path}: no map of a sweep, as SweepMap.save writes it") from error
