"""base_placement: where the base of an arm is best put for a list of poses."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from ...errors import ShapeError
from ...groups.arrays import Array, poses
from ...groups.vectors import rotation_part, translation_part
from ...results import Result
from .sweep_map import SweepMap


@dataclass(frozen=True, eq=False)
class BasePlacement(Result):
    """Candidates for the base, the best first; the result of `base_placement`.

    Attributes
    ----------
    T_wb : (K, 4, 4) ndarray
        Candidates, poses of the base in the frame of the poses, m.
    order : (K,) ndarray of int
        Their numbers among those that were given.
    reached : (K,) ndarray of int
        Number of poses whose cell is reached.
    rarest : (K,) ndarray of int
        Smallest number of samples in the cells of the poses that are reached.
    poses : int
        Number of poses.
    """

    left_out: ClassVar = ("T_wb",)

    T_wb: Array
    order: np.ndarray
    reached: np.ndarray
    rarest: np.ndarray
    poses: int

    def summary(self) -> str:
        """The best candidate, and how many serve all poses.

        Returns
        -------
        text : str
            Line such as "candidate 7 (0 ... 99) reaches 12 of 12 poses; 31 reach all".
        """
        every = np.count_nonzero(self.reached == self.poses)
        return (
            f"candidate {self.order[0]} (0 ... {len(self.order) - 1}) reaches {self.reached[0]} of {self.poses} poses; "
            f"{every} reach all"
        )


def base_placement(found: SweepMap, T_wt: ArrayLike, T_wb: ArrayLike) -> BasePlacement:
    """Ranks places of an arm's base by how many poses of the tool they reach.

    Parameters
    ----------
    found : SweepMap
        Map of the arm, in its base frame; with directions they are asked for too.
    T_wt : (N, 4, 4) array_like
        Poses of the tool in a frame w of the cell, m.
    T_wb : (K, 4, 4) array_like
        Candidates for the base in the same frame, m.

    Returns
    -------
    ranking : BasePlacement
        The candidates: those that reach more poses first, of these the ones whose rarest pose has
        more samples, then in the given order.

    Raises
    ------
    PoseError
        If an element is no pose.
    ShapeError
        If an array has another shape, or is empty.

    Notes
    -----
    A cell is reached where a sample of the sweep lies in it: a map with few samples calls poses
    unreached that are not (`SweepMap.new_cell_chance`).

    Examples
    --------
    >>> import numpy as np
    >>> import poekin as pk
    >>> arm = pk.load("ur5e").chain(tip="tool0")
    >>> found = pk.sweep.reach(arm, resolution=0.1, samples=200_000)
    >>> targets = pk.se3.exp([[0, 0, 0, x, 0.4, 0.3] for x in (-0.2, 0.0, 0.2)])
    >>> bases = pk.se3.exp([[0, 0, 0, x, 0, 0] for x in (3.0, 0.0)])
    >>> ranking = pk.sweep.base_placement(found, targets, bases)
    >>> int(ranking.order[0]), int(ranking.reached[0])
    (1, 3)
    """
    targets = _rows(T_wt, "T_wt")
    bases = _rows(T_wb, "T_wb")
    R = rotation_part(bases)
    p = translation_part(bases)
    inverse = bases.copy()
    rotation_part(inverse)[:] = np.swapaxes(R, 1, 2)
    translation_part(inverse)[:] = -np.einsum("kji,kj->ki", R, p)
    counts = np.array([found.query(T_bw @ targets) for T_bw in inverse])
    is_reached = counts > 0
    reached = is_reached.sum(axis=1)
    rarest = counts.min(axis=1, where=is_reached, initial=np.iinfo(np.int64).max)
    rarest[reached == 0] = 0
    order = np.lexsort((-rarest, -reached))
    return BasePlacement(bases[order], order, reached[order], rarest[order], len(targets))


def _rows(T: ArrayLike, what: str) -> Array:
    """Poses (N, 4, 4), at least one. Raises: ShapeError, PoseError."""
    rows = poses(T, what)
    if rows.ndim != 3 or not len(rows):
        raise ShapeError(f"{what}: expected poses (N, 4, 4), N from 1 on, got {rows.shape}")
    return rows
