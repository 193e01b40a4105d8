"""Sweeps of poses are the same to the last bit however they are run, and are what ik_all says."""

from __future__ import annotations

import signal
import subprocess
import sys
from concurrent.futures import ProcessPoolExecutor

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError
from poekin.sweep import Cells, PoseGrid, PoseSamples, Sweep, SweepMap, run
from tests.sweep.arms import bits

ARM = pk.load("ur5e").chain(tip="tool0")
CELLS = Cells.box([-0.9, -0.9, -0.6], [0.9, 0.9, 0.9], 0.3, side=1)
# larger than the map, so that some are outside
POSES = PoseSamples.sobol([-1.0, -1.0, -0.6], [1.0, 1.0, 1.2], 9000, seed=3)
SWEEP = Sweep(ARM, POSES, CELLS, "manipulability")
# middles whose directions make axes parallel: there ik_all searches, from random starts
SINGULAR = Cells.box([-0.6, -0.6, 0.0], [0.6, 0.6, 0.3], 0.1)
GRID = Sweep(ARM, PoseGrid.of(SINGULAR, 7), SINGULAR, "limit_margin")


@pytest.fixture(scope="module")
def whole():
    return bits(run(SWEEP, workers=1))


@pytest.mark.parametrize("chunk", [91, 2049, 4096])
def test_any_chunk_and_number_of_threads_give_the_same_bytes(whole, chunk):
    assert bits(run(SWEEP, chunk=chunk, workers=1 + chunk % 3)) == whole


def test_middles_in_which_solutions_are_searched_give_the_same_bytes():
    expected = bits(run(GRID, workers=1))
    assert bits(run(GRID, chunk=333, workers=2)) == expected


def test_processes_and_runs_that_were_killed_give_the_same_bytes(tmp_path, whole):
    code = (
        "import os, signal, sys\n"
        "from tests.sweep.execution.test_pose_sweep import SWEEP, run\n"
        "def tell(done, count):\n"
        "    if done == 3000: os.kill(os.getpid(), signal.SIGKILL)\n"
        "run(SWEEP, chunk=1000, workers=1, store=sys.argv[1], progress=tell)\n"
    )
    ended = subprocess.run([sys.executable, "-c", code, str(tmp_path)], check=False)
    assert ended.returncode == -signal.SIGKILL
    assert len(list(tmp_path.glob("part-*.npz"))) == 3
    with ProcessPoolExecutor(2) as pool:
        found = run(SWEEP, chunk=1000, store=tmp_path, resume=True, executor=pool)
    assert bits(found) == whole


@pytest.mark.parametrize(
    ("other", "words"),
    [
        (
            Sweep(ARM, PoseSamples.sobol([-1] * 3, [1] * 3, 9000), CELLS, "manipulability"),
            "samples, key",
        ),
        (Sweep(ARM, PoseGrid.of(CELLS, 9), CELLS, "manipulability"), "samples, key"),
        (Sweep(ARM.replace(limits=[[-3, 3]] * 6), POSES, CELLS, "manipulability"), "key"),
    ],
)
def test_a_store_of_other_poses_or_limits_is_refused(tmp_path, other, words):
    few = Sweep(ARM, PoseSamples.sobol([-1] * 3, [1] * 3, 10), CELLS, "manipulability")
    run(few, chunk=1000, store=tmp_path)
    head = tmp_path / "sweep.json"
    head.write_text(head.read_text().replace(few.key(), SWEEP.key()))
    with pytest.raises(InputError, match="these differ: samples"):
        run(SWEEP, chunk=1000, store=tmp_path)
    assert SWEEP.describe().keys() == other.describe().keys()
    differing = [name for name, x in SWEEP.describe().items() if other.describe()[name] != x]
    assert ", ".join([*differing, *["key"] * (other.key() != SWEEP.key())]) == words


def values(found: SweepMap) -> np.ndarray:
    """The measures of a map that has some."""
    assert found.best is not None
    return found.best


def test_every_cell_counts_its_reached_poses_and_keeps_the_best_of_them():
    samples = PoseSamples.random([-1.0] * 3, [1.0] * 3, 2500, seed=4)
    T = samples.poses(np.arange(2500))
    counts = pk.ik_all(ARM, T).counts
    cell = CELLS.find(T)
    for keep in ("best", "worst", "mean"):
        found = run(Sweep(ARM, samples, CELLS, "solutions", keep), workers=1)
        reached = counts > 0
        inside = cell[reached & (cell >= 0)]
        expected = np.bincount(inside, minlength=CELLS.count).reshape(CELLS.array_shape)
        np.testing.assert_array_equal(found.counts, expected)
        assert found.outside == np.count_nonzero(reached & (cell < 0)) > 0
        assert found.masked == np.count_nonzero(~reached) > 0
        of_cell = {"best": np.max, "worst": np.min, "mean": np.mean}[keep]
        own = np.full(CELLS.count, np.nan)
        for number in np.unique(inside):
            own[number] = of_cell(counts[reached & (cell == number)])
        # a mean is of whole numbers of 2^-40, and rounded once
        np.testing.assert_allclose(values(found).reshape(-1), own, rtol=1e-15)


def test_the_middle_of_every_cell_is_asked_by_a_grid_of_its_cells():
    found = run(Sweep(ARM, PoseGrid.of(CELLS, 2), CELLS, "solutions"), workers=1)
    counts = pk.ik_all(ARM, CELLS.poses(2)).counts
    np.testing.assert_array_equal(found.counts, (counts > 0).sum(axis=-1))
    np.testing.assert_array_equal(np.nan_to_num(values(found)), counts.max(axis=-1))
    np.testing.assert_array_equal(found.reached_share, (counts > 0).mean(axis=-1))


def test_parts_of_poses_are_shorter_by_what_a_pose_takes():
    told = []
    many = Cells.box([-1] * 3, [1] * 3, 0.011)  # 182^3 cells, a part for every sixteen
    samples = PoseSamples.random([-9.0] * 3, [-8.0] * 3, 70_000)
    run(Sweep(ARM, samples, CELLS), workers=1, progress=lambda done, count: told.append(done))
    assert told == [2**16, 70_000]
    told.clear()
    few = PoseSamples.random([-9.0] * 3, [-8.0] * 3, 10)
    run(Sweep(ARM, few, many), workers=1, progress=lambda done, count: told.append(done))
    assert told == [10]
