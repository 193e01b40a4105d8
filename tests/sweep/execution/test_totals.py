"""Means of cells: sums of whole numbers, the same in any order and of any size."""

from __future__ import annotations

import math
import pickle
from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import poekin as pk
from poekin.sweep import Cells, JointTravel, PoseUncertainty, Random, Sweep, run
from poekin.sweep.execution.totals import SweepPart, Totals, part_of
from tests.sweep.arms import two_links

ARM = pk.load("panda").chain(tip="panda_hand")
CELLS = Cells.box([-1.0, -1.0, -0.6], [1.0, 1.0, 1.3], 0.25, side=1)
ONE = Cells((-9.0, -9.0, -9.0), 18.0, (1, 1, 1))
ERROR = PoseUncertainty.by_tolerances(ARM, tilt=1e-4, shift=1e-5, offset=1e-4)
SUMMED = Sweep(ARM, Random.of(ARM, 3000, seed=1), CELLS, ERROR, "mean")


@given(st.lists(st.integers(1, 2999), max_size=4, unique=True), st.randoms())
@settings(max_examples=20)
def test_means_are_the_same_in_any_order_of_the_parts(cuts, order):
    parts = [part_of(pickle.dumps(SUMMED), a, b) for a, b in pairwise([0, *sorted(cuts), 3000])]
    order.shuffle(parts)
    totals = Totals(SUMMED)
    for part in parts:
        totals.add(part)
    whole = Totals(SUMMED)
    whole.run(0, 3000)
    assert totals.best.tobytes() == whole.best.tobytes()
    assert totals.attained.tobytes() == whole.attained.tobytes()


@pytest.mark.parametrize("keep", ["best", "worst", "mean"])
def test_a_map_of_errors_has_the_same_bytes_for_any_chunk_and_number_of_threads(keep):
    sweep = Sweep(ARM, SUMMED.samples, CELLS, ERROR, keep)
    whole = np.asarray(run(sweep, workers=1).best).tobytes()
    for chunk in (63, 64, 1001):
        assert np.asarray(run(sweep, chunk=chunk, workers=3).best).tobytes() == whole


def test_a_mean_is_kept_in_a_store_and_in_a_file(tmp_path):
    found = run(SUMMED, chunk=700, store=tmp_path / "store")
    again = run(SUMMED, chunk=700, store=tmp_path / "store", resume=True)
    assert np.asarray(again.best).tobytes() == np.asarray(found.best).tobytes()
    found.save(tmp_path / "map.npz")
    read = pk.sweep.load_map(tmp_path / "map.npz")
    assert np.asarray(read.best).tobytes() == np.asarray(found.best).tobytes()
    assert read.attained is None
    assert read.summary() == found.summary()
    with pytest.raises(pk.errors.InputError, match="or keeps means"):
        read.configurations()


def of_one(count, high, low):
    cells = np.zeros(1, np.int64)
    return SweepPart(cells, np.array([count]), np.array([high]), np.array([low]), 0)


@given(
    st.lists(
        st.tuples(st.integers(1, 2**40), st.integers(-(2**40), 2**40), st.integers(0, 2**32 - 1)),
        min_size=1,
        max_size=20,
    )
)
def test_sums_are_exact_however_large(parts):
    totals = Totals(Sweep(ARM, SUMMED.samples, ONE, ERROR, "mean"))
    for part in parts:
        totals.add(of_one(*part))
    total = sum(high * 2**32 + low for _, high, low in parts)
    assert int(totals.best[0]) * 2**32 + int(totals.attained[0]) == total
    assert 0 <= totals.attained[0] < 2**32
    mean = Fraction(total, 2**40) / sum(count for count, _, _ in parts)
    # two products, a sum and a quotient are rounded
    size = abs(int(totals.best[0])) * 2.0**-8 + 2.0**-8
    count = sum(count for count, _, _ in parts)
    assert abs(totals.means()[0] - float(mean)) <= 4 * 2.0**-53 * size / count


@pytest.mark.parametrize("far", [1e5, 1e300])
def test_a_measure_that_is_beyond_all_sums_counts_as_the_largest(far):
    arm = two_links()
    samples = Random.of(arm, 100)
    sweep = Sweep(arm, samples, ONE, JointTravel((far, 0.0)), "mean")
    (mean,) = np.ravel(np.asarray(run(sweep).best))
    assert mean == pytest.approx(min(far, 2.0**22), abs=math.pi)
