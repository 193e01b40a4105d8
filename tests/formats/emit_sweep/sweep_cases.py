"""Sweeps of which no sample is within rounding of a border, and what emitted text has to count."""

from __future__ import annotations

from typing import Any

import numpy as np

from poekin.formats.emit.sweep.cuda import Measure
from poekin.sweep import Cells, Grid, Random, Sweep, run
from poekin.sweep.samples import Samples
from tests.sweep.arms import measured

from ..emitted import arm

# no border where a grid has whole rows of points, at y = 0 say
CELLS = Cells((-1.03, -1.02, -0.61), 0.2, (10, 10, 10), 1)
CUBES = Cells((-1.03, -1.02, -0.61), 0.2, (10, 10, 10))
_ROWS: list[tuple[str, str, Measure]] = [
    ("panda", "random", "manipulability"),
    ("panda", "grid", "reach"),
    ("mixed", "random", "reach"),
    ("coupled", "random", "manipulability"),
    ("one slide", "grid", "reach"),
]
CASES = {f"{row[0]}_{row[1]}": row for row in _ROWS}


def case(key: str) -> Sweep:
    """A sweep by name."""
    name, kind, measure = CASES[key]
    chain = arm(name)
    if kind == "random":
        return Sweep(chain, Random.of(chain, 5001, seed=2**40 + 3), CELLS, measure)
    counts = [(4, 3, 5, 2, 6, 2, 4)[k % 7] for k in range(chain.dof)]
    return Sweep(chain, Grid.of(chain, counts), CUBES, measure)


def samples_of(sweep: Sweep) -> Samples:
    """The sweep's samples, which are configurations."""
    assert isinstance(sweep.samples, Samples)
    return sweep.samples


def arguments(sweep: Sweep) -> tuple:
    """Samples, bounds, cells and place as the text takes them."""
    samples = samples_of(sweep)
    cells = tuple(sweep.cells.numbers().tolist())
    return tuple(samples.numbers().tolist()), samples.bounds, cells, sweep.cells.place()


def check(sweep: Sweep, counts, best: Any = None, attained: Any = None, rtol=1e-9) -> None:
    """Counts of a map: no sample of these is within rounding, 1e-14 m, of a border but by a chance of
    some 1e-9.
    """
    found = run(sweep)
    there = found.counts.reshape(-1) > 0
    np.testing.assert_array_equal(counts[:-1], found.counts.reshape(-1))
    assert counts[-1] == found.outside
    assert there.any()
    if sweep.is_measured:
        wanted, first = measured(found)
        np.testing.assert_allclose(best[:-1][there], wanted.reshape(-1)[there], rtol=0, atol=rtol)
        np.testing.assert_array_equal(attained[:-1][there], first.reshape(-1)[there])
        assert (attained[:-1][~there] == 2**63 - 1).all()
