"""Places that a map is not written to, and files that are not read."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from poekin.errors import FileError, InputError, quote
from poekin.sweep import Cells, Random, Sweep, load_map, run
from poekin.sweep.maps import labelled, map_files
from tests.messages import says
from tests.sweep.arms import two_links

ARM = two_links()
COUNTED = run(Sweep(ARM, Random.of(ARM, 50, seed=1), Cells.box([-1] * 3, [1] * 3, 0.5)))
LONG = "/".join(["a" * 60] * 9)


@pytest.mark.parametrize(
    ("path", "kind", "words"),
    [
        (
            f"{LONG}.txt",
            InputError,
            f"map: expected a .npz file or a .zarr directory, got {quote(f'{LONG}.txt', 300)}",
        ),
        (f"{LONG}/b.npz", FileError, f"map: there is no directory {quote(LONG, 300)}"),
    ],
)
def test_a_place_that_is_none_is_named_and_cut_at_300_characters(path, kind, words):
    with pytest.raises(kind) as caught:
        map_files.check_place(path, "map")
    assert says(caught.value, words)


@pytest.fixture
def long(tmp_path):
    place = tmp_path / LONG
    place.mkdir(parents=True)
    return place


def test_a_directory_is_no_file_and_none_that_is_something_else_becomes_a_map(long):
    (long / "b.npz").mkdir()
    with pytest.raises(FileError) as caught:
        map_files.check_place(long / "b.npz", "map")
    assert says(caught.value, f"map: {quote(str(long / 'b.npz'), 300)} is a directory")
    pytest.importorskip("zarr", reason="no zarr: no .zarr was looked for")
    (long / "b.zarr").mkdir()
    with pytest.raises(InputError) as caught_zarr:
        map_files.check_place(long / "b.zarr", "map")
    words = f"{quote(str(long / 'b.zarr'), 300)} is there already, and holds no map of a sweep"
    assert says(caught_zarr.value, words)
    map_files.check_place(long / "new.zarr", "map")
    map_files.check_place(long / "new.npz", "map")


class Harm:
    def __reduce__(self):
        return print, ("harm",)


@pytest.mark.parametrize("name", ["counts", "about", "outside"])
def test_nothing_in_a_file_is_unpickled(tmp_path, capsys, name):
    COUNTED.save(tmp_path / "map.npz")
    with np.load(tmp_path / "map.npz") as file:
        parts: dict[str, Any] = dict(file)
    parts[name] = np.array([Harm()], object)
    np.savez(tmp_path / "other.npz", **parts)
    with pytest.raises(FileError, match="no map of a sweep, as SweepMap"):
        load_map(tmp_path / "other.npz")
    assert capsys.readouterr().out == ""


@pytest.mark.parametrize("left", ["counts", "about", "outside"])
def test_a_file_without_one_of_its_parts_is_no_map(tmp_path, left):
    COUNTED.save(tmp_path / "map.npz")
    with np.load(tmp_path / "map.npz") as file:
        parts = {name: array for name, array in file.items() if name != left}
    np.savez(tmp_path / "map.npz", **parts)
    with pytest.raises(FileError) as caught:
        load_map(tmp_path / "map.npz")
    words = f"{tmp_path / 'map.npz'}: no map of a sweep, as SweepMap.save writes it"
    assert says(caught.value, words)
    with pytest.raises(FileError) as caught:
        load_map(tmp_path / "none.zarr")
    assert says(caught.value, f"{tmp_path / 'none.zarr'}: no such file")


@pytest.mark.parametrize("text", ["", "[]", "{}", '{"attributes": 3}', '{"attributes": {"x": 1}}'])
def test_a_directory_is_a_map_by_what_its_head_says(tmp_path, text):
    (tmp_path / "zarr.json").write_text(text)
    assert not labelled._holds_map(tmp_path)
    assert not labelled._holds_map(Path("nowhere"))
    head = {"attributes": {"poekin_sweep": "{}"}}
    (tmp_path / "zarr.json").write_text(json.dumps(head))
    assert labelled._holds_map(tmp_path)


def test_a_map_of_one_cube_has_its_middle_for_coordinates():
    pytest.importorskip("xarray", reason="no xarray: no map was labelled")
    one = run(Sweep(ARM, Random.of(ARM, 5), Cells((-2.0, -3.0, -1.5), 5.0, (1, 1, 1))))
    labels = one.to_xarray()
    assert [float(labels[axis][0]) for axis in "xyz"] == [0.5, -0.5, 1.0]
    assert labels.attrs["samples_outside"] == 0
    assert json.loads(labels.attrs["poekin_sweep"]) == one.about
    assert labels["counts"].shape == (1, 1, 1)
