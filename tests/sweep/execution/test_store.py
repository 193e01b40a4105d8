"""A store keeps what is done: a run that was killed goes on, and gives the same bytes."""

from __future__ import annotations

import errno
import json
import os
import signal
import subprocess
import sys

import numpy as np
import pytest

from poekin.errors import FileError, InputError
from poekin.sweep import Cells, Random, Sweep, run
from tests.sweep.arms import bits, two_links

ARM = two_links()
CELLS = Cells.box([-1] * 3, [1] * 3, 0.1, side=1)
SWEEP = Sweep(ARM, Random.of(ARM, 5000, seed=1), CELLS, "manipulability")


@pytest.fixture(scope="module")
def whole():
    return bits(run(SWEEP, workers=1))


def test_a_stored_run_gives_the_same_bytes_and_is_read_back(tmp_path, whole):
    assert bits(run(SWEEP, chunk=1000, store=tmp_path / "maps")) == whole
    parts = sorted(file.name for file in (tmp_path / "maps").iterdir())
    assert parts == [*(f"part-{k:08d}.npz" for k in range(5)), "sweep.json"]
    told = []
    again = run(
        SWEEP,
        chunk=1000,
        store=tmp_path / "maps",
        resume=True,
        executor=Refusing(),
        progress=lambda *x: told.append(x[0]),
    )
    assert bits(again) == whole
    assert told == [1000, 2000, 3000, 4000, 5000]


class Refusing:
    """An executor that is asked for nothing."""

    def submit(self, *arguments):
        raise AssertionError(arguments)


@pytest.mark.parametrize("damage", [b"", b"PK\x03\x04 torn", None])
def test_a_part_that_is_damaged_or_gone_is_done_again(tmp_path, whole, damage):
    run(SWEEP, chunk=1000, store=tmp_path)
    file = tmp_path / "part-00000003.npz"
    if damage is None:
        file.unlink()
    else:
        file.write_bytes(damage)
    assert bits(run(SWEEP, chunk=1000, store=tmp_path, resume=True)) == whole
    assert file.stat().st_size > 100


def test_a_run_that_is_killed_again_and_again_goes_on_where_it_was(tmp_path, whole):
    code = (
        "import sys, poekin as pk\n"
        "from tests.sweep.execution.test_store import SWEEP, run\n"
        "import os, signal\n"
        "def tell(done, count):\n"
        "    if done == int(sys.argv[2]): os.kill(os.getpid(), signal.SIGKILL)\n"
        "run(SWEEP, chunk=1000, workers=1, store=sys.argv[1], resume=True, progress=tell)\n"
    )
    kept = []
    for done in (1000, 2000, 4000):
        ended = subprocess.run([sys.executable, "-c", code, str(tmp_path), str(done)], check=False)
        assert ended.returncode == -signal.SIGKILL
        kept.append(len(list(tmp_path.glob("part-*.npz"))))
    assert kept == [1, 2, 4]
    assert bits(run(SWEEP, chunk=1000, store=tmp_path, resume=True)) == whole


@pytest.mark.parametrize(
    ("other", "words"),
    [
        (Sweep(two_links(0.6), SWEEP.samples, CELLS, "manipulability"), "these differ: key "),
        (
            Sweep(ARM, Random.of(ARM, 5000, seed=2), CELLS, "manipulability"),
            "these differ: samples, key ",
        ),
        (Sweep(ARM, SWEEP.samples, CELLS), "these differ: measure, key "),
    ],
)
def test_a_store_of_another_sweep_is_refused_with_what_differs(tmp_path, other, words):
    run(SWEEP, chunk=1000, store=tmp_path)
    with pytest.raises(InputError, match=words):
        run(other, chunk=1000, store=tmp_path, resume=True)


def test_another_chunk_is_refused(tmp_path):
    run(SWEEP, chunk=1000, store=tmp_path)
    with pytest.raises(InputError, match="these differ: chunk "):
        run(SWEEP, chunk=500, store=tmp_path, resume=True)


def test_a_store_that_was_begun_is_not_gone_on_with_unasked(tmp_path):
    run(SWEEP, chunk=1000, store=tmp_path)
    with pytest.raises(InputError, match="resume=True goes on with it"):
        run(SWEEP, chunk=1000, store=tmp_path)


@pytest.mark.parametrize("head", ["", "[]", '{"chunk": 1000}'])
def test_a_torn_head_is_another_sweep_s(tmp_path, head):
    (tmp_path / "sweep.json").write_text(head)
    with pytest.raises(InputError, match="another sweep"):
        run(SWEEP, chunk=1000, store=tmp_path, resume=True)


def test_a_directory_of_other_things_is_left_alone(tmp_path):
    (tmp_path / "letter.txt").write_text("dear")
    with pytest.raises(InputError, match="no empty directory"):
        run(SWEEP, store=tmp_path)
    assert [file.name for file in tmp_path.iterdir()] == ["letter.txt"]


def test_a_store_where_no_directory_can_be_is_an_error_of_the_file(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(FileError, match="file"):
        run(SWEEP, store=tmp_path / "file")


def test_on_a_full_disk_parts_that_were_done_stay(tmp_path, monkeypatch):
    written = []

    def full(file, **arrays):
        written.append(arrays)
        if len(written) > 2:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        saved(file, **arrays)

    saved = np.savez_compressed
    monkeypatch.setattr(np, "savez_compressed", full)
    with pytest.raises(FileError, match=r"part-00000002\.npz: No space left"):
        run(SWEEP, chunk=1000, store=tmp_path, workers=1)
    assert sorted(file.name for file in tmp_path.glob("part*")) == [
        "part-00000000.npz",
        "part-00000001.npz",
    ]


@pytest.mark.parametrize(("side", "samples"), [(1, 2**22), (16, 4 * 12 * 16**2 * 8**3)])
def test_a_part_has_four_samples_for_each_cell_and_four_million_at_least(tmp_path, side, samples):
    cells = Cells.box([-1] * 3, [1] * 3, 0.25, side=side)
    run(Sweep(ARM, Random.of(ARM, 10), cells), workers=1, store=tmp_path)
    assert json.loads((tmp_path / "sweep.json").read_text())["chunk"] == samples


def test_the_head_says_what_the_sweep_is(tmp_path):
    run(SWEEP, chunk=1000, store=tmp_path)
    head = json.loads((tmp_path / "sweep.json").read_text())
    assert head["chunk"] == 1000
    assert head["samples"]["random"] == 5000
    assert head["q_names"] == list(ARM.q_names)
