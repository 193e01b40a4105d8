"""Samples of a sweep that are poses: drawn in a box, all rotations alike, or on a grid."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..checks import KERNEL_INT, whole
from ..errors import InputError, quote, show_numbers
from ..groups.arrays import Array
from ..groups.vectors import rotation_part, translation_part
from ..model.chain import Chain
from .cells import Cells, box_corners, cells_from
from .samples import (
    MOST_SAMPLES,
    Random,
    Samples,
    Sobol,
    sample_numbers,
    samples_from,
)

_TRIED = 100_000
_ROOM = 0.05  # of a box's side, on each side


@dataclass(frozen=True, eq=False)
class NumberedPoses:
    """Poses by their numbers 0 ... count - 1, each a function of its number alone.

    Attributes
    ----------
    count : int
        Number of samples.
    """

    count: int

    @abstractmethod
    def describe(self) -> dict[str, object]:
        """Plain data from which the same samples are made again."""

    @abstractmethod
    def poses(self, numbers: ArrayLike) -> Array:
        """Poses of the tip in the base frame, m.

        Parameters
        ----------
        numbers : (N,) array_like of int
            Numbers of samples, each below `count`.

        Returns
        -------
        T : (N, 4, 4) ndarray
            Their poses.

        Raises
        ------
        InputError
            If a number is no sample's.
        """


@dataclass(frozen=True, eq=False)
class PoseSamples(NumberedPoses):
    """Poses drawn evenly in a box, with evenly distributed rotations.

    Attributes
    ----------
    count : int
        Number of samples.
    drawn : Random or Sobol
        Six numbers each: the place, m, and three from 0 to 1 for the rotation.

    Examples
    --------
    >>> import poekin as pk
    >>> samples = pk.sweep.PoseSamples.sobol([-1, -1, 0], [1, 1, 1], 2**16)
    >>> samples.poses([0, 1]).shape
    (2, 4, 4)
    """

    drawn: Random | Sobol

    @classmethod
    def random(
        cls,
        lower: ArrayLike,
        upper: ArrayLike,
        count: int,
        seed: int = 0,
    ) -> PoseSamples:
        """Independent poses in a box.

        Parameters
        ----------
        lower, upper : (3,) array_like
            Corners of the box in the base frame, m.
        count : int
            Number of samples.
        seed : int, default 0
            Seed of the random numbers; the same seed gives the same samples on every machine.

        Returns
        -------
        samples : PoseSamples
            The samples.

        Raises
        ------
        InputError
            If the box is empty, or a number cannot be used.
        """
        bounds = _six_bounds(lower, upper)
        whole(count, "count", 1, MOST_SAMPLES)
        whole(seed, "seed", 0, KERNEL_INT)
        return cls(count, Random(*bounds, count, seed))

    @classmethod
    def sobol(
        cls,
        lower: ArrayLike,
        upper: ArrayLike,
        count: int,
        seed: int | None = 0,
    ) -> PoseSamples:
        """Poses of Sobol's sequence in six dimensions: more even than random ones.

        Parameters
        ----------
        lower, upper : (3,) array_like
            Corners of the box in the base frame, m.
        count : int
            Number of samples; a power of 2 is most even.
        seed : int or None, default 0
            Seed of the scrambling, None for none.

        Returns
        -------
        samples : PoseSamples
            The samples.

        Raises
        ------
        InputError
            If the box is empty, or a number cannot be used.

        Notes
        -----
        Three even numbers from 0 to 1 are brought to unit quaternions. Source: Shoemake 1992.
        """
        bounds = _six_bounds(lower, upper)
        whole(count, "count", 1, MOST_SAMPLES)
        if seed is not None:
            whole(seed, "seed", 0, KERNEL_INT)
        return cls(count, Sobol(*bounds, count, seed))

    @classmethod
    def of(cls, chain: Chain, count: int, seed: int = 0) -> PoseSamples:
        """Independent poses in the box that an arm reaches, and some room around it.

        Parameters
        ----------
        chain : Chain
            The arm.
        count : int
            Number of samples.
        seed : int, default 0
            Seed of the random numbers.

        Returns
        -------
        samples : PoseSamples
            The samples.

        Raises
        ------
        InputError
            If a number cannot be used, the arm has no configurations to draw (`Random.of`), or its
            tool stays in a plane.

        Notes
        -----
        The box is that of 100 000 random configurations, with 5 % of its sides more at each end.
        """
        lower, upper = reached_box(chain, Random.of(chain, _TRIED))
        sides = upper - lower
        if not sides.all():
            raise InputError(
                f"chain: expected an arm whose tool moves along x, y and z, got {quote(chain.tip)}"
                f" within {show_numbers(sides)} m: PoseSamples.random takes a box"
            )
        room = _ROOM * sides
        return cls.random(lower - room, upper + room, count, seed)

    def describe(self) -> dict[str, object]:
        """Plain data of the samples."""
        return {"poses": self.drawn.describe()}

    def poses(self, numbers: ArrayLike) -> Array:
        """Poses of samples, see `NumberedPoses`; the same bits on every machine."""
        from ..engine.kernels.sweep import pose_kernel  # which imports Numba

        rows = self.drawn.configurations(numbers)
        T = np.empty((len(rows), 4, 4))
        pose_kernel.posed.call(rows, T)
        return T


@dataclass(frozen=True, eq=False)
class PoseGrid(NumberedPoses):
    """Poses in the middles of cells: of every cube, every tile of directions, every turn.

    Attributes
    ----------
    count : int
        Number of samples.
    cells : Cells
        Cells whose middles they are; the last cell changes first.
    turns : int
        Number of turns about the tool's z axis in each, evenly over a whole one.
    """

    cells: Cells
    turns: int

    @classmethod
    def of(cls, cells: Cells, turns: int = 1) -> PoseGrid:
        """The middles of cells.

        Parameters
        ----------
        cells : Cells
            The cells; with side=0 the tool's z axis is along the base's.
        turns : int, default 1
            See the class.

        Returns
        -------
        samples : PoseGrid
            The samples.

        Raises
        ------
        InputError
            If a number cannot be used.

        Examples
        --------
        >>> import poekin as pk
        >>> cells = pk.sweep.Cells.box([-1, -1, 0], [1, 1, 1], 0.1, side=1)
        >>> pk.sweep.PoseGrid.of(cells, turns=4).count
        192000
        """
        whole(turns, "turns", 1, KERNEL_INT)
        count = whole(cells.count * turns, "cells times turns", 1, MOST_SAMPLES)
        return cls(count, cells, turns)

    def describe(self) -> dict[str, object]:
        """Plain data of the samples."""
        return {"poses": {"cells": self.cells.describe(), "turns": self.turns}}

    def poses(self, numbers: ArrayLike) -> Array:
        """Poses of samples, see `NumberedPoses`."""
        rows = sample_numbers(numbers, self.count)
        R = self.cells.rotations(self.turns).reshape(-1, 3, 3)
        cubes, rotations = np.divmod(rows, len(R))
        index = np.stack(np.unravel_index(cubes, self.cells.shape), axis=1)
        T = np.zeros((len(rows), 4, 4))
        rotation_part(T)[:] = R[rotations]
        translation_part(T)[:] = self.cells.corner + self.cells.resolution * (index + 0.5)
        T[:, 3, 3] = 1.0
        return T


def samples_of(chain: Chain, asked: int | Samples | NumberedPoses) -> Samples | NumberedPoses:
    """Samples as they are, or a number of random configurations. Raises: InputError."""
    if isinstance(asked, (Samples, NumberedPoses)):
        return asked
    return Random.of(chain, asked)


def read_samples(document: dict[str, Any]) -> Samples | NumberedPoses:
    """The samples that `describe` has described."""
    if not is_of_poses(document):
        return samples_from(document)
    poses = document["poses"]
    if "cells" in poses:
        return PoseGrid.of(cells_from(poses["cells"]), poses["turns"])
    drawn = samples_from(poses)
    if not isinstance(drawn, (Random, Sobol)):
        raise ValueError("samples")
    return PoseSamples(drawn.count, drawn)


def is_of_poses(document: dict[str, Any]) -> bool:
    """Whether described samples are poses."""
    return "poses" in document


def reached_box(chain: Chain, samples: Samples) -> tuple[Array, Array]:
    """Corners (3,) of the box of the tool's places in the first of the samples, m."""
    count = min(_TRIED, samples.count)
    q = samples.configurations(np.arange(count))
    T = chain.compile().fk(q)
    # rounded, so that the last bit of a pose, which differs by processor, moves no corner
    p = translation_part(T).round(9)
    return p.min(axis=0), p.max(axis=0)


def _six_bounds(lower: ArrayLike, upper: ArrayLike) -> tuple[Array, Array]:
    """Bounds (6,) of a place and of three numbers from 0 to 1. Raises: InputError, ShapeError."""
    begin, end = box_corners(lower, upper)
    return np.append(begin, np.zeros(3)), np.append(end, np.ones(3))
