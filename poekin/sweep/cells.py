"""Cells of a map: cubes of space, and in each of them tiles of the directions of the tool's z axis."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..checks import positive, whole
from ..errors import InputError, ShapeError
from ..groups.arrays import Array, numbers, poses
from ..groups.vectors import rotation_part, translation_part
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
        begin, end = box_corners(lower, upper)
        first = np.floor(begin / size)
        last = np.ceil(end / size)
        shape = np.maximum(last - first, 1.0)
        tiles = _tiles(side)
        number = math.prod(shape) * tiles
        nx, ny, nz = shape.tolist()
        if number > _MOST_CELLS:
            raise InputError(
                f"resolution: expected at most 2^40 cells, got {number:.3g}, "
                f"{nx:.0f} x {ny:.0f} x {nz:.0f} cubes of {tiles}"
            )
        x, y, z = (first * size).tolist()
        cubes = (int(nx), int(ny), int(nz))
        return cls((x, y, z), size, cubes, side)

    @property
    def upper(self) -> tuple[float, float, float]:
        """Corner of the last cube with the largest x, y and z, m."""
        x, y, z = np.add(self.corner, np.multiply(self.resolution, self.shape)).tolist()
        return x, y, z

    @property
    def tiles(self) -> int:
        """Tiles of directions of each cube, 1 where they are not told apart."""
        return _tiles(self.side)

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
            start + self.resolution * (np.arange(count, dtype=float) + 0.5)
            for start, count in zip(self.corner, self.shape, strict=True)
        ]
        grids = np.meshgrid(*axes, indexing="ij")
        return np.stack(grids, axis=-1)

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
        R = self.rotations(turns)
        p = self.centres()
        T = np.zeros((*self.shape, *R.shape[:2], 4, 4))
        rotation_part(T)[:] = R
        translation_part(T)[:] = p[..., None, None, :]
        T[..., 3, 3] = 1.0
        return T

    def rotations(self, turns: int = 1) -> Array:
        """Rotations in the middle of every tile.

        Parameters
        ----------
        turns : int, default 1
            As of `poses`.

        Returns
        -------
        R : (tiles, turns, 3, 3) ndarray
            Rotations of the tip in the base frame.

        Raises
        ------
        InputError
            If turns is no whole number from 1 on.
        """
        whole(turns, "turns", 1)
        z = np.array([[0.0, 0.0, 1.0]])
        if self.side:
            z = tile_centres(self.side)
        angle = 2.0 * np.pi * np.arange(turns) / turns
        return _tilts(z)[:, None] @ _turned(angle)

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
        into = found.reshape(-1)
        sweep_kernel.located.call(rows, self.numbers(), self.place(), into)
        return found


def cells_from(document: dict[str, Any]) -> Cells:
    """The cells that `describe` has described."""
    corner = tuple(document["corner"])
    shape = tuple(document["shape"])
    return Cells(corner, document["resolution"], shape, document["side"])


def box_corners(lower: ArrayLike, upper: ArrayLike) -> tuple[Array, Array]:
    """Corners (3,) of a box, m. Raises: InputError of an empty one, ShapeError."""
    begin = _corner(lower, "lower")
    end = _corner(upper, "upper")
    if not (begin < end).all():
        raise InputError(f"box: expected lower below upper, got {begin} and {end}")
    return begin, end


def _tiles(side: int) -> int:
    return max(12 * side**2, 1)


def _turned(angle: Array) -> Array:
    """Rotations (N, 3, 3) about z."""
    cosine = np.cos(angle)
    sine = np.sin(angle)
    R = np.tile(np.eye(3), (len(angle), 1, 1))
    R[:, 0, 0] = cosine
    R[:, 0, 1] = -sine
    R[:, 1, 0] = sine
    R[:, 1, 1] = cosine
    return R


def _tilts(z: Array) -> Array:
    """Rotations (N, 3, 3) that bring the z axis to unit vectors (N, 3) the shortest way; from the
    opposite side about x.
    """
    x, y, up = z.T
    near = 1.0 + up
    is_opposite = near <= 0.0
    near = np.maximum(near, np.finfo(float).tiny)
    xy = -x * y / near
    R = np.empty((len(z), 3, 3))
    R[:, 0, 0] = 1.0 - x * x / near
    R[:, 0, 1] = xy
    R[:, 1, 0] = xy
    R[:, 1, 1] = 1.0 - y * y / near
    R[:, 2] = -z
    R[:, :, 2] = z
    R[is_opposite] = np.diag([1.0, -1.0, -1.0])
    return R


def _corner(point: ArrayLike, what: str) -> Array:
    values = numbers(point, what)
    if values.shape != (3,) or not np.isfinite(values).all():
        raise ShapeError(f"{what}: expected three finite numbers, m, got {point!r}")
    return values
