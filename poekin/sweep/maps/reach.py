"""reach: a map of where a tool can be, from a resolution and a number of samples."""

from __future__ import annotations

import os

import numpy as np

from ...checks import positive
from ...groups.vectors import translation_part
from ...model.chain import Chain
from ...model.kinematics.arm import Arm, chain_of
from ...results import Progress
from ..cells import Cells
from ..execution.run import Executor, run
from ..masks.self_collision import SelfCollision
from ..measures.measure import Measure
from ..measures.names import MeasureName
from ..samples import Random
from ..sweep import Keep, Sweep
from .sweep_map import SweepMap

_TRIED = 100_000
_MORE = 2  # cubes beyond what the tried samples reach


def reach(  # noqa: PLR0913 - options by keyword
    chain: Arm,
    *,
    resolution: float = 0.05,
    samples: int = 10_000_000,
    side: int = 0,
    measure: Measure | MeasureName = "reach",
    keep: Keep = "best",
    mask: SelfCollision | None = None,
    seed: int = 0,
    chunk: int | None = None,
    workers: int | None = None,
    executor: Executor | None = None,
    store: str | os.PathLike[str] | None = None,
    resume: bool = False,
    progress: Progress | None = None,
) -> SweepMap:
    """Map of the cells of space, and of the tool's directions, that an arm reaches.

    Configurations are drawn evenly within the limits; each counts in the cell of its pose.

    Parameters
    ----------
    chain : Chain or CompiledChain
        The arm.
    resolution : float, default 0.05
        Side of a cube, m.
    samples : int, default 10000000
        Number of configurations.
    side : int, default 0
        Tiles along each of the twelve faces of the sphere, for 12 side² directions of the tool's z
        axis (HEALPix); 0 where directions are not told apart.
    measure : Measure or str, default "reach"
        What is kept of each cell besides counts, as `Sweep` has it.
    keep : {"best", "worst", "mean"}, default "best"
        Whether the best or the worst measure of a cell is kept, with its configuration, or the mean.
    mask : SelfCollision, optional
        Configurations that it leaves out count nowhere.
    seed : int, default 0
        Seed of the configurations.
    chunk : int, optional
        Number of samples that are run, and kept, at a time, as in `run`.
    workers : int, optional
        Number of threads or of an executor's workers, as in `run`.
    executor : object, optional
        Runs the parts instead of threads, as in `run`.
    store : path, optional
        Directory that keeps each part as soon as it is done.
    resume : bool, default False
        Whether parts that the store holds are taken from there.
    progress : callable, optional
        Called as progress(samples done, samples of all).

    Returns
    -------
    found : SweepMap
        The map; the same to the last bit for any chunk, number of workers and executor, and on any
        processor.

    Raises
    ------
    InputError
        If an option cannot be used, or limits of joints cut corners off those of coordinates.
    FileError
        If the store cannot be read or written.

    See Also
    --------
    run : Sweeps over other samples and cells.

    Notes
    -----
    The map is a box around 100 000 of the configurations and two cubes more on each side;
    `SweepMap.outside` counts those beyond. A cell that is hardly reached may have no sample:
    n samples miss one that holds the share p of them with probability (1 - p)^n.
    Source: Zacharias, Borst and Hirzinger 2007 (capability maps); Górski et al. 2005 (tiles).

    Examples
    --------
    >>> import poekin as pk
    >>> arm = pk.load("ur5e").chain(tip="tool0")
    >>> found = pk.sweep.reach(arm, resolution=0.1, samples=200_000, side=2)
    >>> found.counts.shape[-1], found.outside
    (48, 0)
    """
    arm = chain_of(chain)
    size = positive(resolution, "resolution")
    drawn = Random.of(arm, samples, seed)
    cells = _around(arm, drawn, size, side)
    return run(
        Sweep(arm, drawn, cells, measure, keep, mask),
        chunk=chunk,
        workers=workers,
        executor=executor,
        store=store,
        resume=resume,
        progress=progress,
    )


def _around(chain: Chain, samples: Random, size: float, side: int) -> Cells:
    """Cells around the first of the samples."""
    count = min(_TRIED, samples.count)
    q = samples.configurations(np.arange(count))
    T = chain.compile().fk(q)
    # rounded, so that the last bit of a pose, which differs by processor, moves no corner
    p = translation_part(T).round(9)
    more = _MORE * size
    lower = p.min(axis=0) - more
    upper = p.max(axis=0) + more
    return Cells.box(lower, upper, size, side)
