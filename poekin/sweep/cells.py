"""Cells of a map: cubes of space, and in each of them tiles of the directions of the tool's z axis."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ..checks import positive, whole
from ..errors import InputError, ShapeError
from ..groups.arrays import Array, poses
from .tile_centres import tile_centres

_SIDES = 1025  # a square of tiles has fewer along a side
_MOST_CELLS = 2**40


@dataclass(frozen=True)
class Cells:
    """Cubes from a corner on, along x, y and z of the base frame, each with tiles of equal area.

    Attributes
    ----------
    corner : tuple of float
        Corner of the first cube with the smallest x, y and z, m.
    resolution : float
        Side of a cube, m.
    shape : tuple of int
        Numbers of cubes along x, y and z.
    side : int
        Tiles along each of the twelve faces of the sphere: 12 side² directions of the tool's z
        axis; 0 where directions are not told apart.
    """

    corner: tuple[float, float, float]
    resolution: float
    shape: tuple[int, int, int]
    side: int = 0

    @classmethod
    def box(
        cls,
        lower: ArrayLike,
        upper: ArrayLike,
        resolution: float,
        side: int = 0,
    ) -> Cells:
        """Cubes that cover a box.

        Parameters
        ----------
        lower, upper : (3,) array_like
            Corners of the box in the base frame, m.
        resolution : float
            Side of a cube, m.
        side : int, default 0
            See the class.

        Returns
        -------
        cells : Cells
            Cubes whose corners are multiples of the resolution.

        Raises
        ------
        InputError
            If a number cannot be used, or there would be more than 2^40 cells.
        """
        size = positive(resolution, "resolution")
        whole(side, "side", 0, _SIDES)
        ends = np.array([_corner(lower, "lower"), _corner(upper, "upper")])
        if not (ends[0] < ends[1]).all():
            raise InputError(f"box: expected lower below upper, got {ends[0]} and {ends[1]}")
        first = np.floor(ends[0] / size)
        shape = np.maximum(np.ceil(ends[1] / size) - first, 1.0)
        number = math.prod(shape) * max(12 * side**2, 1)
        if number > _MOST_CELLS:
            raise InputError(
                f"resolution: expected at most 2^40 cells, got {number:.3g}, "
                f"{shape[0]:.0f} x {shape[1]:.0f} x {shape[2]:.0f} cubes of {max(12 * side**2, 1)}"
            )
        x, y, z = (first * size).tolist()
        nx, ny, nz = (int(count) for count in shape)
        return cls((x, y, z), size, (nx, ny, nz), side)

    @property
    def tiles(self) -> int:
        """Tiles of directions of each cube, 1 where they are not told apart."""
        return 12 * self.side**2 if self.side else 1

    @property
    def count(self) -> int:
        """Number of cells."""
        return math.prod(self.shape) * self.tiles

    @property
    def array_shape(self) -> tuple[int, ...]:
        """Shape of an array with an entry for each cell."""
        return (*self.shape, self.tiles) if self.side else self.shape

    def numbers(self) -> np.ndarray:
        """Whole numbers of the kernel.

        Returns
        -------
        numbers : (4,) ndarray of int
            Tiles along a face's side, and the shape.
        """
        return np.array([self.side, *self.shape], np.int64)

    def place(self) -> Array:
        """Place of the cubes, for the kernel.

        Returns
        -------
        place : (4,) ndarray
            Corner, m, and cubes per m.
        """
        return np.array([*self.corner, 1.0 / self.resolution])

    def describe(self) -> dict[str, object]:
        """Plain data from which the same cells are made again.

        Returns
        -------
        document : dict
            Corner, resolution, shape and side.
        """
        return {
            "corner": list(self.corner),
            "resolution": self.resolution,
            "shape": list(self.shape),
            "side": self.side,
        }

    def centres(self) -> Array:
        """Centres of the cubes.

        Returns
        -------
        p : (nx, ny, nz, 3) ndarray
            Points in the base frame, m.
        """
        axes = [
            start + self.resolution * (np.arange(number, dtype=float) + 0.5)
            for start, number in zip(self.corner, self.shape, strict=True)
        ]
        return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)

    def poses(self, turns: int = 1) -> Array:
        """Poses in the middle of every cell.

        Parameters
        ----------
        turns : int, default 1
            Number of turns about the tool's z axis, evenly over a whole one.

        Returns
        -------
        T : (nx, ny, nz, tiles, turns, 4, 4) ndarray
            Poses of the tip in the base frame, m, their z axes at the centres of the tiles; with
            one tile along the base's z axis where directions are not told apart.

        Raises
        ------
        InputError
            If turns is no whole number from 1 on.
        """
        whole(turns, "turns", 1)
        z = tile_centres(self.side) if self.side else np.array([[0.0, 0.0, 1.0]])
        angle = 2.0 * np.pi * np.arange(turns) / turns
        tilt = _tilts(z)
        spin = np.tile(np.eye(3), (turns, 1, 1))
        spin[:, 0, 0] = spin[:, 1, 1] = np.cos(angle)
        spin[:, 1, 0] = np.sin(angle)
        spin[:, 0, 1] = -spin[:, 1, 0]
        T = np.zeros((*self.shape, len(z), turns, 4, 4))
        T[..., :3, :3] = tilt[:, None] @ spin
        T[..., :3, 3] = self.centres()[..., None, None, :]
        T[..., 3, 3] = 1.0
        return T

    def find(self, T: ArrayLike) -> np.ndarray:
        """Cells of poses.

        Parameters
        ----------
        T : (..., 4, 4) array_like
            Poses of the tip in the base frame, m.

        Returns
        -------
        cells : (...) ndarray of int
            Numbers of cells, in the order of `array_shape`; -1 outside.

        Raises
        ------
        PoseError
            If an element of T is no pose.
        ShapeError
            If T has another shape.

        Notes
        -----
        Accuracy: a pose within rounding of a cell's border may be in either. Source: Górski et al.
        2005, Section 4 (tiles).
        """
        from ..engine.kernels.sweep import sweep_kernel  # which imports Numba

        T = poses(T, "T")
        found = np.empty(T.shape[:-2], np.int64)
        rows = T.reshape(-1, 4, 4)
        sweep_kernel.located.call(rows, self.numbers(), self.place(), found.reshape(-1))
        return found


def _tilts(z: Array) -> Array:
    """Rotations (N, 3, 3) that bring the z axis to unit vectors (N, 3) the shortest way; from the
    opposite side about x.
    """
    x, y, up = z.T
    near = np.maximum(1.0 + up, np.finfo(float).tiny)
    R = np.empty((len(z), 3, 3))
    R[:, 0] = np.stack([1.0 - x * x / near, -x * y / near, x], axis=1)
    R[:, 1] = np.stack([-x * y / near, 1.0 - y * y / near, y], axis=1)
    R[:, 2] = np.stack([-x, -y, up], axis=1)
    R[1.0 + up <= 0.0] = np.diag([1.0, -1.0, -1.0])
    return R


def _corner(point: ArrayLike, what: str) -> Sequence[float]:
    values = np.asarray(point, float)
    if values.shape != (3,) or not np.isfinite(values).all():
        raise ShapeError(f"{what}: expected three finite numbers, m, got {point!r}")
    return values.tolist()
