"""top: the configurations, or poses, with the best measures of all."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Unpack

import numpy as np

from ...checks import whole
from ...errors import InputError
from ...groups.arrays import Array
from ...model.kinematics.arm import Arm, chain_of
from ...results import Result
from ..bins import TopList
from ..execution.run import RunOptions, run_totals
from ..execution.totals import NO_SAMPLE
from ..masks.self_collision import SelfCollision
from ..measures.measure import Measure
from ..measures.names import LABELS, MeasureName
from ..pose_samples import NumberedPoses, is_of_poses, samples_of
from ..samples import Samples
from ..solutions import best_solutions
from ..sweep import Keep, Sweep

_LONGEST = 2**20


@dataclass(frozen=True, eq=False)
class TopSamples(Result):
    """Configurations with the best, or worst, measures, in order; the result of `top`.

    Attributes
    ----------
    about : dict
        The sweep as plain data.
    values : (K,) ndarray
        Their measures, in SI units (rad, m).
    numbers : (K,) ndarray of int
        Their numbers among the samples; of equal measures the smaller number comes first.
    q : (K, m) ndarray
        The configurations, rad or m; of poses the best solution of each.
    T : (K, 4, 4) ndarray or None
        The poses, m; None of a sweep of configurations.
    """

    about: dict[str, Any]
    values: Array
    numbers: np.ndarray
    q: Array
    T: Array | None = None

    def summary(self) -> str:
        """First and last measure.

        Returns
        -------
        text : str
            Line such as "10 best of 1000000 configurations: manipulability 0.12 to 0.11".
        """
        label = LABELS[self.about["measure"]]
        what = "poses" if is_of_poses(self.about["samples"]) else "configurations"
        first = float(self.values[0])
        last = float(self.values[-1])
        ends = label.between(first, last)
        return (
            f"{len(self.values)} {self.about['keep']} of {self.about['count']} {what}: "
            f"{label.words} {ends}"
        )


def top(
    chain: Arm,
    measure: Measure | MeasureName,
    count: int = 10,
    *,
    keep: Keep = "best",
    samples: int | Samples | NumberedPoses = 10_000_000,
    mask: SelfCollision | None = None,
    **options: Unpack[RunOptions],
) -> TopSamples:
    """Finds the configurations, or poses, with the best measures.

    Parameters
    ----------
    chain : Chain or CompiledChain
        The arm.
    measure : Measure or str
        The measure, as `Sweep` has it.
    count : int, default 10
        Number of configurations; fewer where fewer samples are left.
    keep : {"best", "worst"}, default "best"
        Whether the best or the worst are found.
    samples : int or Samples, default 10000000
        Number of random configurations, or `Random`, `Sobol` or `Grid` ones; or `PoseSamples`, or a
        `PoseGrid`, whose measures are those of their best solutions.
    mask : SelfCollision, optional
        Configurations that it leaves out count nowhere.
    **options
        Options of `run`; the result does not depend on them, to the last bit.

    Returns
    -------
    found : TopSamples
        The configurations, the best, or worst, first.

    Raises
    ------
    InputError
        If an option cannot be used, the measure is "reach", keep is "mean", or the mask leaves
        no configuration, or no pose is reached.
    FileError
        If the store cannot be read or written.

    See Also
    --------
    histogram : Numbers of configurations by their measure.

    Examples
    --------
    >>> import poekin as pk
    >>> arm = pk.load("ur5e").chain(tip="tool0")
    >>> found = pk.sweep.top(arm, "manipulability", 3, samples=100_000)
    >>> found.q.shape
    (3, 6)
    """
    arm = chain_of(chain)
    drawn = samples_of(arm, samples)
    whole(count, "count", 1, _LONGEST)
    if keep == "mean":
        raise InputError("keep: expected 'best' or 'worst', got 'mean'")
    best = TopList(min(count, drawn.count))
    sweep = Sweep(arm, drawn, best, measure, keep, mask)
    totals = run_totals(sweep, **options)
    about = sweep.describe() | {"count": drawn.count}
    is_found = totals.attained != NO_SAMPLE
    values = sweep.sign * totals.best[is_found]
    numbers = totals.attained[is_found]
    if not len(numbers):
        raise InputError("top: no sample has a measure, or all are left out or not reached")
    if isinstance(drawn, NumberedPoses):
        T = drawn.poses(numbers)
        q = best_solutions(arm, T, sweep.measured, mask).configurations()
        return TopSamples(about, values, numbers, q, T)
    q = drawn.configurations(numbers)
    return TopSamples(about, values, numbers, q)
