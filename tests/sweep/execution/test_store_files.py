"""Files of a store: what they look like, and what is not taken out of them."""

from __future__ import annotations

import json
import pickle
import shutil
from typing import Any

import numpy as np
import pytest

from poekin.errors import FileError, InputError
from poekin.sweep import Cells, Random, Sweep, run
from poekin.sweep.execution.store import Store
from poekin.sweep.execution.totals import SweepPart
from tests.messages import says
from tests.sweep.arms import two_links

ARM = two_links()
SWEEP = Sweep(ARM, Random.of(ARM, 30, seed=1), Cells.box([-1] * 3, [1] * 3, 0.5))
PART = SweepPart(np.array([2, 5]), np.array([1, 3]), np.empty(0), np.empty(0), 4)


def test_a_store_is_made_with_the_directories_above_it_and_its_head_has_a_line_an_entry(tmp_path):
    place = tmp_path / "a" / "b"
    Store(place, SWEEP, 10, False)
    text = (place / "sweep.json").read_text()
    head = json.loads(text)
    assert list(head) == [*SWEEP.describe(), "chunk", "key"]
    assert text == json.dumps(head, indent=1)
    assert [file.name for file in place.iterdir()] == ["sweep.json"]


def test_a_part_is_what_was_written(tmp_path):
    store = Store(tmp_path, SWEEP, 10, False)
    store.write(123, PART)
    assert (tmp_path / "part-00000123.npz").is_file()
    read = store.read(123)
    assert read is not None
    assert isinstance(read.outside, int)
    for kept, given in zip(read, PART, strict=True):
        np.testing.assert_array_equal(kept, given)
    assert store.read(12) is None


class Harm:
    """What does harm as soon as it is unpickled."""

    def __init__(self, file):
        self.file = file

    def __reduce__(self):
        return open, (self.file, "w")


def test_a_part_is_never_unpickled(tmp_path):
    store = Store(tmp_path / "store", SWEEP, 10, False)
    harm = tmp_path / "harm"
    every: dict[str, Any] = PART._asdict() | {"counts": np.array([Harm(str(harm))], object)}
    np.savez(tmp_path / "store" / "part-00000000.npz", **every)
    assert store.read(0) is None
    assert not harm.exists()
    pickle.loads(pickle.dumps(Harm(str(harm)))).close()
    assert harm.exists()


def test_a_store_that_is_taken_away_is_an_error_of_the_file(tmp_path):
    place = tmp_path / "store"
    store = Store(place, SWEEP, 10, False)
    shutil.rmtree(place)
    with pytest.raises(
        FileError, match=r"^store: .*part-00000007\.npz: No such file or directory$"
    ):
        store.write(7, PART)


def test_what_a_store_holds_is_said_with_its_place(tmp_path):
    place = tmp_path / "other"
    place.mkdir()
    (place / "letter").write_text("")
    with pytest.raises(InputError) as caught:
        Store(place, SWEEP, 10, False)
    assert says(caught.value, f"store: {place} is no empty directory, and holds no sweep")
    (place / "letter").unlink()
    Store(place, SWEEP, 10, False)
    with pytest.raises(InputError) as caught:
        Store(place, SWEEP, 10, False)
    assert says(
        caught.value, f"store: {place} holds this sweep, begun before; resume=True goes on with it"
    )
    with pytest.raises(InputError) as caught:
        Store(place, SWEEP, 11, True)
    assert says(
        caught.value,
        f"store: {place} holds another sweep; these differ: chunk (key: the arm, or the version of poekin)",
    )
    with pytest.raises(FileError) as caught_error:
        run(SWEEP, store=place / "sweep.json")
    assert says(caught_error.value, f"store: {place / 'sweep.json'}: File exists")
