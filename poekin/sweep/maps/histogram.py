"""histogram: how often a measure has which value over all configurations."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any, Unpack, get_args

import numpy as np

from ...checks import is_real, whole
from ...errors import InputError, safe_repr
from ...groups.arrays import Array
from ...model.chain import Chain
from ...model.kinematics.arm import Arm, chain_of
from ...results import Result
from ..bins import Bins
from ..execution.run import RunOptions, run_totals
from ..masks.self_collision import SelfCollision
from ..measures.measure import Measure
from ..measures.names import LABELS, MeasureName
from ..pose_samples import NumberedPoses, is_of_poses, samples_of
from ..samples import Samples
from ..sweep import Keep, Sweep
from .top import top

_TRIED = 100_000
_ROOM = 1e-3  # of the range that was tried, above it: a bin does not hold its upper end
_MOST_BINS = 2**24
_BOTH: tuple[Keep, ...] = get_args(Keep)[:2]


@dataclass(frozen=True, eq=False)
class MeasureHistogram(Result):
    """Numbers of configurations by their measure; the result of `histogram`.

    Attributes
    ----------
    about : dict
        The sweep as plain data.
    edges : (bins + 1,) ndarray
        Borders of the bins, in SI units (rad, m); a bin holds its lower one.
    counts : (bins,) ndarray of int
        Number of configurations in each bin.
    outside : int
        Number of configurations in none.
    """

    about: dict[str, Any]
    edges: Array
    counts: np.ndarray
    outside: int

    def summary(self) -> str:
        """Numbers of configurations, and three values of the measure.

        Returns
        -------
        text : str
            Lines such as "manipulability: 5 % below 0.01, half below 0.05, 95 % below 0.1".
        """
        label = LABELS[self.about["measure"]]
        what = "reached poses" if is_of_poses(self.about["samples"]) else "configurations"
        lines = [f"{self.counts.sum()} {what}, {self.outside} more outside of the bins"]
        if self.counts.any():
            below = np.cumsum(self.counts) / self.counts.sum()
            low, half, high = (
                label.value(self.edges[1:][np.searchsorted(below, share)])
                for share in (0.05, 0.5, 0.95)
            )
            lines.append(f"{label.words}: 5 % below {low}, half below {half}, 95 % below {high}")
        return "\n".join(lines)


def histogram(
    chain: Arm,
    measure: Measure | MeasureName,
    *,
    bins: int = 100,
    ends: tuple[float, float] | None = None,
    samples: int | Samples | NumberedPoses = 10_000_000,
    mask: SelfCollision | None = None,
    **options: Unpack[RunOptions],
) -> MeasureHistogram:
    """Counts configurations by their measure.

    Parameters
    ----------
    chain : Chain or CompiledChain
        The arm.
    measure : Measure or str
        The measure, as `Sweep` has it.
    bins : int, default 100
        Number of bins of equal width.
    ends : (float, float), optional
        Ends of the bins, in SI units; by default those of 100 000 configurations.
    samples : int or Samples, default 10000000
        Number of random configurations, or `Random`, `Sobol` or `Grid` ones; or `PoseSamples`, or a
        `PoseGrid`, whose measures are those of their best solutions.
    mask : SelfCollision, optional
        Configurations that it leaves out count nowhere.
    **options
        Options of `run`; the result does not depend on them, to the last bit.

    Returns
    -------
    found : MeasureHistogram
        The counts.

    Raises
    ------
    InputError
        If an option cannot be used, or the measure is "reach".
    FileError
        If the store cannot be read or written.

    See Also
    --------
    top : The best configurations themselves.

    Examples
    --------
    >>> import poekin as pk
    >>> arm = pk.load("ur5e").chain(tip="tool0")
    >>> found = pk.sweep.histogram(arm, "manipulability", bins=20, samples=100_000)
    >>> int(found.counts.sum()) + found.outside
    100000
    """
    arm = chain_of(chain)
    drawn = samples_of(arm, samples)
    whole(bins, "bins", 1, _MOST_BINS)
    if ends is None:
        ends = _tried(arm, drawn, measure)
    else:
        ends = _checked(ends)
    sweep = Sweep(arm, drawn, Bins(*ends, bins), measure, mask=mask)
    totals = run_totals(sweep, **options)
    edges = np.linspace(*ends, bins + 1)
    return MeasureHistogram(sweep.describe(), edges, totals.counts, totals.outside)


def _tried(
    chain: Chain, samples: Samples | NumberedPoses, measure: Measure | MeasureName
) -> tuple[float, float]:
    """Least and largest measure of the first samples, with some room."""
    few = replace(samples, count=min(_TRIED, samples.count))
    values = []
    for keep in _BOTH:
        found = top(chain, measure, 1, keep=keep, samples=few)
        values.extend(found.values)
    lower = float(min(values))
    upper = float(max(values))
    room = _ROOM * (upper - lower) or 1.0
    return lower, upper + room


def _checked(ends: tuple[float, float]) -> tuple[float, float]:
    if isinstance(ends, Iterable):
        lower, upper, *more = (*ends, None, None)
        is_pair = is_real(lower) and is_real(upper) and more == [None, None]
        if is_pair and -math.inf < lower < upper < math.inf:
            return float(lower), float(upper)
    raise InputError(f"ends: expected two numbers, the smaller one first, got {safe_repr(ends)}")
