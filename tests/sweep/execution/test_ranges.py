"""Ranges follow each other over all samples, and are as many chunks as take 0.4 s."""

from __future__ import annotations

from concurrent.futures import Future
from itertools import islice, pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

import poekin as pk
from poekin.sweep import Cells, Random, Sweep, run
from poekin.sweep.execution.ranges import Ranges
from tests.sweep.arms import bits

ARM = pk.load("panda").chain(tip="panda_hand")
CELLS = Cells.box([-1.0, -1.0, -0.6], [1.0, 1.0, 1.3], 0.25, side=1)
SWEEP = Sweep(ARM, Random.of(ARM, 2_001, seed=5), CELLS, "manipulability")
CHUNK = 10


@given(st.integers(1, 10**4), st.integers(1, 100), st.integers(1, 9), st.floats(1e-6, 10))
def test_ranges_are_whole_chunks_that_follow_each_other_up_to_the_last_sample(
    count, chunk, most, seconds
):
    ranges = Ranges(count, chunk, most)
    found = []
    for one in ranges:
        found.append(one)
        ranges.adapt(one, seconds)
    assert (found[0].first, found[-1].last) == (0, count)
    assert all(one.last == other.first for one, other in pairwise(found))
    assert all(one.first == chunk * one.number and one.first < one.last for one in found)


@pytest.mark.parametrize(
    ("seconds", "most", "chunks"),
    [
        (0.02, 2, 20),  # one worker: 0.41 s
        (0.04, 80, 6),  # forty: 0.8 s, but each has four tasks of a thousand chunks
        (0.4, 80, 2),
        (0.042, 2, 9),
        (0.3, 2, 1),
        (9.0, 2, 1),  # never less than one
        (1e-6, 2, 250),  # a half of what each of two may run
        (1e-6, 10, 50),
    ],
)
def test_a_range_to_come_takes_some_tenths_of_a_second(seconds, most, chunks):
    ranges = Ranges(1000 * CHUNK, CHUNK, most)
    single, other = islice(ranges, 2)
    assert [one.last - one.first for one in (single, other)] == [CHUNK, CHUNK]
    ranges.adapt(single, seconds)
    assert ranges.chunks == chunks
    # of the same speed: as many
    _, second = islice(ranges, 2)
    ranges.adapt(second, seconds * chunks)
    assert ranges.chunks == chunks


class Instant:
    """An executor whose tasks are done at once, and take no time as far as anybody is told."""

    def __init__(self) -> None:
        self.samples: list[int] = []

    def submit(self, function, /, *arguments):
        pickled, first, last = arguments
        part, seconds = function(pickled, first, last)
        assert 0 < seconds < 60
        self.samples.append(last - first)
        future: Future[object] = Future()
        future.set_result((part, 1e-9))
        return future


def test_an_executor_runs_many_short_chunks_in_few_tasks_and_gives_the_same_bytes():
    executor = Instant()
    told = []
    found = run(
        SWEEP, chunk=2, workers=2, executor=executor, progress=lambda done, _: told.append(done)
    )
    assert bits(found) == bits(run(SWEEP))
    # four are begun before the first is taken
    assert executor.samples == [2] * 4 + [250] * 7 + [243]
    assert told[-1] == 2_001
    assert len(told) == len(executor.samples)


def test_each_chunk_is_a_task_of_its_own_where_it_is_kept(tmp_path):
    executor = Instant()
    found = run(SWEEP, chunk=100, workers=1, executor=executor, store=tmp_path)
    assert bits(found) == bits(run(SWEEP))
    assert executor.samples == [100] * 20 + [1]
    assert len(list(tmp_path.glob("part-*.npz"))) == 21
