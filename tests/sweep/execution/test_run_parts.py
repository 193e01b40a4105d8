"""The machine's memory, the order in which parts are waited for, and what an error leaves."""

from __future__ import annotations

import os

import pytest

import poekin as pk
from poekin.sweep import Cells, PoseSamples, Random, Sweep, run
from poekin.sweep.execution.run import _memory
from tests.findings import defaults_are_those_of_the_docstring
from tests.sweep.arms import two_links

ARM = two_links()
UR5E = pk.load("ur5e").chain(tip="tool0")
POSES = PoseSamples.random([0] * 3, [1] * 3, 9)
SWEEP = Sweep(ARM, Random.of(ARM, 100, seed=1), Cells.box([-1] * 3, [1] * 3, 0.5))


def test_the_memory_is_that_of_all_pages(monkeypatch):
    monkeypatch.setattr(os, "sysconf", {"SC_PAGE_SIZE": 4096, "SC_PHYS_PAGES": 1001}.__getitem__)
    assert _memory() == 4096 * 1001


@pytest.mark.parametrize("fault", [AttributeError, ValueError, OSError])
def test_where_the_memory_is_not_known_none_is_too_small(monkeypatch, fault):
    def sysconf(name):
        raise fault(name)

    monkeypatch.setattr(os, "sysconf", sysconf)
    assert _memory() is None
    assert run(SWEEP).counts.sum() == 100


class Slow:
    """An executor whose futures are done when they are waited for, and not before."""

    def __init__(self, failing=-1):
        self.failing = failing
        self.waited: list[int] = []
        self.left: list[int] = []

    def submit(self, function, *arguments):
        return Future(self, lambda: function(*arguments), arguments[1])


class Future:
    def __init__(self, executor, make, first):
        self.executor = executor
        self.make = make
        self.first = first

    def done(self):
        return False

    def result(self):
        self.executor.waited.append(self.first)
        if self.first == self.executor.failing:
            raise KeyboardInterrupt
        part, _ = self.make()
        return part, 1.0  # s

    def cancel(self):
        self.executor.left.append(self.first)


def test_the_oldest_part_is_waited_for_where_none_is_done():
    executor = Slow()
    assert run(SWEEP, chunk=20, workers=1, executor=executor).counts.sum() == 100
    assert executor.waited == [0, 20, 40, 60, 80]
    assert executor.left == []


def test_an_error_of_a_part_gives_up_those_that_were_begun():
    executor = Slow(failing=20)
    with pytest.raises(KeyboardInterrupt):
        run(SWEEP, chunk=20, workers=2, executor=executor)
    assert executor.waited == [0, 20]
    assert executor.left == [40, 60, 80]


def test_a_store_is_gone_on_with_only_where_that_is_asked_for():
    assert defaults_are_those_of_the_docstring(run)


@pytest.mark.parametrize(
    ("cells", "samples", "chunk"),
    [
        (Cells((0, 0, 0), 1.0, (8, 8, 8)), Random.of(ARM, 9), 2**22),
        (Cells((0, 0, 0), 1.0, (128, 128, 256)), Random.of(ARM, 9), 2**24),
        (Cells((0, 0, 0), 1.0, (8, 8, 8)), POSES, 2**16),
        (Cells((0, 0, 0), 1.0, (128, 128, 256)), POSES, 2**18),
    ],
)
def test_a_part_has_four_samples_a_cell_or_a_pose_for_sixteen_and_some_at_least(
    monkeypatch, cells, samples, chunk
):
    def ranges(*of):
        raise FloatingPointError(of)

    monkeypatch.setattr("poekin.sweep.execution.run.Ranges", ranges)
    chain = ARM if samples is not POSES else UR5E
    for workers, most in ((3, 6), (1, 2)):
        with pytest.raises(FloatingPointError) as caught:
            run(Sweep(chain, samples, cells), workers=workers)
        assert caught.value.args == ((samples.count, chunk, most),)


def test_parts_that_are_kept_are_taken_and_those_that_are_not_are_run(tmp_path):
    whole = run(SWEEP, chunk=20, store=tmp_path, workers=1)
    (tmp_path / "part-00000002.npz").unlink()
    executor = Slow()
    again = run(SWEEP, chunk=20, store=tmp_path, resume=True, executor=executor)
    assert executor.waited == [40]
    assert again.counts.tobytes() == whole.counts.tobytes()
    assert len(list(tmp_path.glob("part-*.npz"))) == 5
