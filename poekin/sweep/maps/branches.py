"""branches: how many solutions of the inverse kinematics the middle of each cell has."""

from __future__ import annotations

import numpy as np

from ...checks import whole
from ...model.chain import Chain
from ...model.kinematics.arm import Arm, chain_of
from ...results import Progress
from ...solve.ik_all.ik_all import ik_all
from ..cells import Cells

_AT_ONCE = 50_000


def branches(
    chain: Arm,
    cells: Cells,
    *,
    turns: int = 1,
    limits: bool = True,
    progress: Progress | None = None,
) -> np.ndarray:
    """Number of solutions of the inverse kinematics in the middle of every cell.

    Parameters
    ----------
    chain : Chain or CompiledChain
        Arm of up to six coordinates.
    cells : Cells
        Cells whose middles are the targets.
    turns : int, default 1
        Number of turns of the tool about its z axis that are tried in each, evenly over a whole
        one.
    limits : bool, default True
        Whether only solutions within the chain's limits count.
    progress : callable, optional
        Called as progress(targets done, targets of all).

    Returns
    -------
    counts : (nx, ny, nz, tiles, turns) ndarray of int
        Numbers of solutions.

    Raises
    ------
    InputError
        If the arm has more than six coordinates, or an option cannot be used.

    See Also
    --------
    reach : A map by forward kinematics, of any arm.

    Notes
    -----
    Solutions are those of `ik_all`. A middle that is out of reach has none though a corner of its
    cell may be reached.

    Examples
    --------
    >>> import poekin as pk
    >>> arm = pk.load("ur5e").chain(tip="tool0")
    >>> cells = pk.sweep.Cells.box([-0.6, -0.6, 0.0], [0.6, 0.6, 0.6], 0.3, side=1)
    >>> pk.sweep.branches(arm, cells, limits=False).shape
    (4, 4, 2, 12, 1)
    """
    arm: Chain = chain_of(chain)
    whole(turns, "turns", 1)
    layers = np.empty((*cells.shape, cells.tiles, turns), np.int64)
    found = layers.reshape(-1)
    T = cells.poses(turns).reshape(-1, 4, 4)
    for first in range(0, len(T), _AT_ONCE):
        part = slice(first, first + _AT_ONCE)
        solutions = ik_all(arm, T[part], limits=limits, parallel=True)
        found[part] = solutions.counts
        if progress is not None:
            done = min(part.stop, len(T))
            progress(done, len(T))
    return layers
