"""reach: a map of where a tool can be, from a resolution and a number of samples."""

from __future__ import annotations

import os
from typing import Literal, get_args

from ...checks import choice, positive
from ...errors import InputError, safe_repr
from ...model.kinematics.arm import Arm, chain_of
from ...results import Progress
from ..cells import Cells
from ..execution.run import Executor, run
from ..masks.self_collision import SelfCollision
from ..measures.measure import Measure
from ..measures.names import MeasureName
from ..pose_samples import PoseGrid, PoseSamples, reached_box
from ..samples import Random
from ..sweep import Keep, Sweep
from .sweep_map import SweepMap

Drawn = Literal["configurations", "poses", "middles"]

_TRIED = 100_000
_MORE = 2  # cubes beyond what the tried samples reach


def reach(  # noqa: PLR0913 - options by keyword
    chain: Arm,
    *,
    resolution: float = 0.05,
    samples: int = 10_000_000,
    by: Drawn = "configurations",
    turns: int = 1,
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

    Configurations are drawn evenly within the limits; each counts in the cell of its pose. Or poses
    are tried, and count in their cells where inverse kinematics has a solution.

    Parameters
    ----------
    chain : Chain or CompiledChain
        The arm.
    resolution : float, default 0.05
        Side of a cube, m.
    samples : int, default 10000000
        Number of configurations, or of poses that are drawn.
    by : {"configurations", "poses", "middles"}, default "configurations"
        Samples: configurations; poses that are drawn evenly in the map; or those in the middles of
        its cells. Poses take a hundred times as long, and an arm of up to six coordinates that is
        solved in closed form or by elimination; they find what few configurations reach.
    turns : int, default 1
        Of middles, number of turns of the tool about its z axis in each, as of `PoseGrid`.
    side : int, default 0
        Tiles along each of the twelve faces of the sphere, for 12 side² directions of the tool's z
        axis (HEALPix); 0 where directions are not told apart.
    measure : Measure or str, default "reach"
        What is kept of each cell besides counts, as `Sweep` has it; of a pose the measure is that
        of its best solution, or "solutions", their number.
    keep : {"best", "worst", "mean"}, default "best"
        Whether the best or the worst measure of a cell is kept, with its configuration, or the mean.
    mask : SelfCollision, optional
        Configurations, or solutions, that it leaves out count nowhere.
    seed : int, default 0
        Seed of the samples.
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
        The map; the same to the last bit for any chunk, number of workers and executor, and of
        configurations on any processor.

    Raises
    ------
    InputError
        If an option cannot be used, or limits of joints cut corners off those of coordinates.
    FileError
        If the store cannot be read or written.

    See Also
    --------
    run : Sweeps over other samples and cells.
    PoseSamples, PoseGrid : Poses in a box, and in the middles of cells.

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
    choice(by, get_args(Drawn), "by")
    if turns != 1 and by != "middles":
        raise InputError(f"turns: expected 1 unless by is 'middles', got {safe_repr(turns)}")
    drawn = Random.of(arm, samples, seed)
    lower, upper = reached_box(arm, drawn if by == "configurations" else Random.of(arm, _TRIED))
    more = _MORE * size
    cells = Cells.box(lower - more, upper + more, size, side)
    tried = drawn
    if by == "poses":
        tried = PoseSamples.random(cells.corner, cells.upper, samples, seed)
    elif by == "middles":
        tried = PoseGrid.of(cells, turns)
    return run(
        Sweep(arm, tried, cells, measure, keep, mask),
        chunk=chunk,
        workers=workers,
        executor=executor,
        store=store,
        resume=resume,
        progress=progress,
    )
