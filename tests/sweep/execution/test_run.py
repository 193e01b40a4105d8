"""A sweep is the same to the last bit however it is run, and is what single configurations say."""

from __future__ import annotations

import contextlib
import os
import pickle
import re
import subprocess
import sys
import threading
from concurrent.futures import Future, ProcessPoolExecutor
from itertools import pairwise, permutations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import InputError
from poekin.sweep import Cells, Grid, Random, Sweep, run
from poekin.sweep.execution.totals import SweepPart, Totals, part_of
from tests.sweep.arms import bits, measured, slide, two_links

ARM = pk.load("panda").chain(tip="panda_hand")
CELLS = Cells.box([-1.0, -1.0, -0.6], [1.0, 1.0, 1.3], 0.25, side=1)
SWEEP = Sweep(ARM, Random.of(ARM, 10_001, seed=5), CELLS, "manipulability")


@pytest.fixture(scope="module")
def whole():
    return bits(run(SWEEP, chunk=10**6, workers=1))


@pytest.mark.parametrize("chunk", [1, 63, 64, 1001, 10_000])
@pytest.mark.parametrize("workers", [1, 3])
def test_any_chunk_and_number_of_threads_give_the_same_bytes(whole, chunk, workers):
    if chunk == 1:
        few = Sweep(ARM, Random.of(ARM, 201, seed=5), CELLS, "manipulability")
        assert bits(run(few, chunk=1, workers=workers)) == bits(run(few, workers=1))
    else:
        assert bits(run(SWEEP, chunk=chunk, workers=workers)) == whole


def test_processes_of_an_executor_give_the_same_bytes(whole):
    with ProcessPoolExecutor(2) as pool:
        assert bits(run(SWEEP, chunk=2500, executor=pool)) == whole


class Backwards:
    """An executor that runs nothing before it is asked for a result, and keeps what it was given."""

    def __init__(self):
        self.asked = []

    def submit(self, function, *arguments):
        self.asked.append(arguments[1:])
        future = Future()
        future.set_result(function(*arguments))
        return future


def test_an_executor_is_given_all_parts_once(whole):
    executor = Backwards()
    assert bits(run(SWEEP, chunk=3000, executor=executor)) == whole
    assert executor.asked == [(0, 3000), (3000, 6000), (6000, 9000), (9000, 10_001)]


class Late:
    """An executor whose first part is not done before all others were asked for."""

    def __init__(self, last):
        self.last = last
        self.first = Future()

    def submit(self, function, *arguments):
        future = self.first if arguments[1] == 0 else Future()
        if future is not self.first:
            future.set_result(function(*arguments))
        if arguments[2] == self.last:
            self.first.set_result(function(arguments[0], 0, 3000))
        return future


def test_a_part_that_is_done_is_kept_whatever_was_begun_before_it(tmp_path, whole):
    kept = []

    def tell(done, count):
        kept.append(sorted(int(file.stem[5:]) for file in tmp_path.glob("part-*.npz")))

    late = Late(10_001)
    found = run(SWEEP, chunk=3000, executor=late, workers=1, store=tmp_path, progress=tell)
    assert bits(found) == whole
    assert kept[:2] == [[1], [1, 2]]


class Counting:
    """An executor that counts the parts that were asked for and not taken."""

    def __init__(self):
        self.open = self.most = 0

    def submit(self, function, *arguments):
        self.open += 1
        self.most = max(self.most, self.open)
        part = function(*arguments)
        return Taken(self, part)


class Taken:
    """A future that is never done before it is waited for."""

    def __init__(self, executor, part):
        self.executor = executor
        self.part = part

    def done(self):
        return False

    def result(self):
        self.executor.open -= 1
        return self.part

    def cancel(self):
        raise AssertionError


@pytest.mark.parametrize(("workers", "most"), [(1, 2), (3, 6), (None, 16)])
def test_an_executor_is_given_two_parts_for_each_worker(whole, workers, most):
    executor = Counting()
    assert bits(run(SWEEP, chunk=400, executor=executor, workers=workers)) == whole
    assert executor.most == most
    assert executor.open == 0


def test_of_own_threads_each_has_two_parts_where_these_are_kept(tmp_path, monkeypatch, whole):
    pool = Counting()
    own = lambda threads, **_: contextlib.nullcontext(pool)  # noqa: E731
    monkeypatch.setattr("poekin.sweep.execution.run.ThreadPoolExecutor", own)
    assert bits(run(SWEEP, chunk=400, workers=3, store=tmp_path)) == whole
    assert pool.most == 6


@given(st.lists(st.integers(1, 2999), min_size=1, max_size=4, unique=True), st.randoms())
@settings(max_examples=20)
def test_parts_add_up_to_the_same_in_any_order(cuts, order):
    small = Sweep(ARM, Random.of(ARM, 3000, seed=1), CELLS, "manipulability")
    ends = [0, *sorted(cuts), 3000]
    parts = [part_of(pickle.dumps(small), a, b) for a, b in pairwise(ends)]
    order.shuffle(parts)
    totals = Totals(small)
    for part in parts:
        totals.add(part)
    expected = run(small, workers=1)
    assert totals.counts.tobytes() == expected.counts.tobytes()
    assert totals.attained.tobytes() == measured(expected)[1].tobytes()


@pytest.mark.parametrize("kind", ["random", "grid"])
@pytest.mark.parametrize(
    "arm", [two_links(), slide(), pk.load("ur5e").chain(tip="tool0")], ids=["2R", "PR", "6R"]
)
def test_every_count_is_that_of_single_configurations(arm, kind):
    samples = Random.of(arm, 5000, seed=2) if kind == "random" else Grid.of(arm, [4] * arm.dof)
    q = samples.configurations(np.arange(samples.count))
    T = arm.fk(q)
    reach = np.abs(T[:, :3, 3]).max() + 0.01
    cells = Cells.box([-reach] * 3, [0.8 * reach] * 3, 0.11, side=2)
    found = run(Sweep(arm, samples, cells))
    place = (T[:, :3, 3] - cells.corner) / 0.11
    # a point on a face of a cube, to rounding, may be on either side
    clear = (np.abs(place - np.round(place)) > 1e-9).all(axis=1)
    index = cells.find(T)
    inside = ((place >= 0) & (place < cells.shape)).all(axis=1)
    assert (inside == (index >= 0))[clear].all()
    counts = np.bincount(index[index >= 0], minlength=cells.count).reshape(cells.array_shape)
    differing = np.abs(counts - found.counts).sum() + abs(
        found.outside - np.count_nonzero(index < 0)
    )
    assert differing <= 3 * np.count_nonzero(~clear) + tied_directions(T, index)
    assert found.counts.sum() + found.outside == samples.count


def tied_directions(T, index):
    """Twice the number of tool axes so near to a border of tiles that rounding decides: along a
    quarter turn or the equator's, which grids and planar arms have.
    """
    z = T[index >= 0, :3, 2]
    near = np.abs(z[:, :2]).min(axis=1) < 1e-9
    return 2 * np.count_nonzero(near | (np.abs(np.abs(z[:, 2]) - 2 / 3) < 1e-9))


@pytest.mark.parametrize(
    "arm",
    [ARM, pk.load("ur5e").chain(tip="tool0"), two_links(), slide()],
    ids=["7R", "6R", "2R", "PR"],
)
def test_the_best_of_a_cell_is_that_of_its_configurations(arm):
    samples = Random.of(arm, 2000, seed=8)
    q = samples.configurations(np.arange(samples.count))
    cells = Cells.box([-2.0] * 3, [2.0] * 3, 0.5)
    found = run(Sweep(arm, samples, cells, "manipulability"))
    bests, attained = measured(found)
    own = pk.manipulability(arm, q).pose.yoshikawa
    index = cells.find(arm.fk(q))
    for cell in np.unique(index):
        best = own[index == cell].max()
        # the square is within rounding of the product of the rows' squared lengths, below 2^6
        assert bests.reshape(-1)[cell] == pytest.approx(best, abs=1e-6)
        number = attained.reshape(-1)[cell]
        assert index[number] == cell
        assert own[number] == pytest.approx(best, abs=1e-6)
    assert np.isnan(bests[found.counts == 0]).all()
    assert (attained[found.counts == 0] == -1).all()


def test_of_equal_measures_the_first_sample_is_named():
    # the manipulability of two parallel axes depends on the second alone
    arm = two_links()
    samples = Grid.of(arm, [8, 1])
    cells = Cells((-1.0, -1.0, -1.0), 2.0, (1, 1, 1))
    found = run(Sweep(arm, samples, cells, "manipulability"), chunk=3)
    best, attained = measured(found)
    cell = found.counts == 8
    measures = pk.manipulability(arm, samples.configurations(np.arange(8))).pose.yoshikawa
    np.testing.assert_allclose(measures, best[cell][0], rtol=1e-9)
    # all eight are alike, and compared to their last bits
    again = run(Sweep(arm, samples, cells, "manipulability"), chunk=1, workers=3)
    assert measured(again)[1].tobytes() == attained.tobytes()


def test_progress_is_told_up_to_the_end():
    told = []
    run(SWEEP, chunk=4000, workers=1, progress=lambda done, count: told.append((done, count)))
    assert told == [(4000, 10_001), (8000, 10_001), (10_001, 10_001)]
    told.clear()
    run(SWEEP, progress=lambda done, count: told.append((done, count)))
    assert told == [(10_001, 10_001)]  # a part is of millions


def test_an_error_of_one_thread_ends_all():
    def failing(done, count):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run(SWEEP, chunk=100, workers=2, progress=failing)
    assert not [t for t in threading.enumerate() if t.name.startswith("poekin-sweep")]


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"chunk": 0}, "chunk"),
        ({"workers": 0}, "workers"),
        ({"executor": 3}, "executor: expected an object with submit, got int"),
    ],
)
def test_options_that_cannot_be_used_are_refused(options, words):
    with pytest.raises(InputError, match=words):
        run(SWEEP, **options)


@pytest.mark.parametrize("measure", ["manipulability", "reach"])
def test_maps_larger_than_four_fifths_of_the_memory_are_refused_before_they_begin(
    measure, monkeypatch
):
    sweep = Sweep(ARM, SWEEP.samples, CELLS, measure)
    of_one = Totals(sweep)
    size = 4 * sum(a.nbytes for a in (of_one.counts, of_one.best, of_one.attained))
    # of three threads and of their sum
    monkeypatch.setattr("poekin.sweep.execution.run._memory", lambda: size * 5 // 4)
    assert run(sweep, workers=3).samples is sweep.samples
    there = size * 5 // 4 - 2
    monkeypatch.setattr("poekin.sweep.execution.run._memory", lambda: there)
    words = (
        f"sweep: {CELLS.count:.3g} cells take {size / 2**30:.3g} GiB in 4 maps, "
        f"of {there / 2**30:.3g} GiB here; "
    )
    with pytest.raises(InputError, match=f"^{re.escape(words)}"):
        run(sweep, workers=3)


def test_of_equal_measures_that_parts_bring_in_any_order_the_first_sample_stays():
    sweep = Sweep(ARM, SWEEP.samples, Cells((0, 0, 0), 1.0, (1, 1, 1)), "manipulability")
    for order in permutations((7, 3, 5)):
        totals = Totals(sweep)
        for number in order:
            one = np.array([0])
            totals.add(SweepPart(one, one + 1, np.array([2.0]), np.array([number]), 0))
        assert totals.attained.tolist() == [3]


def test_a_sweep_of_another_arm_s_samples_is_refused():
    with pytest.raises(InputError, match="has 2 coordinates, its samples 7"):
        Sweep(two_links(), SWEEP.samples, CELLS)
    with pytest.raises(InputError, match="measure"):
        Sweep(ARM, SWEEP.samples, CELLS, "speed")  # type: ignore[arg-type]


def test_an_arm_that_cannot_do_what_its_coordinates_are_for_has_no_manipulability():
    axes = [pk.screw.revolute([0, 0, 1], [x, 0, 0]) for x in (0.0, 0.3, 0.6, 0.9)]
    planar = pk.Chain(np.array(axes), np.eye(4), frame="space", limits=[[-1, 1]] * 4)
    with pytest.raises(InputError, match="0 everywhere"):
        run(Sweep(planar, Random.of(planar, 10), CELLS, "manipulability"))


def test_without_compiled_code_it_says_so():
    code = (
        "import poekin as pk\n"
        "arm = pk.load('ur5e').chain()\n"
        "pk.sweep.run(pk.sweep.Sweep(arm, pk.sweep.Random.of(arm, 10), pk.sweep.Cells.box([0]*3, [1]*3, 1.0)))"
    )
    ended = subprocess.run(
        [sys.executable, "-c", code],
        env=os.environ | {"NUMBA_DISABLE_JIT": "1"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert "NUMBA_DISABLE_JIT is set" in ended.stderr
