"""A map's files: NumPy's, and a Zarr directory that xarray reads."""

from __future__ import annotations

import errno
import os
import sys
from pathlib import Path

import numpy as np
import pytest

from poekin.errors import FileError, InputError, MissingExtra
from poekin.sweep import Cells, Grid, Random, Sweep, load_map, run
from poekin.sweep.samples import Samples
from poekin.sweep.tile_centres import tile_centres
from tests.sweep.arms import bits, two_links

ARM = two_links()
CELLS = Cells.box([-1, -1, -0.2], [1.1, 1, 0.3], 0.1, side=1)
MEASURED = run(Sweep(ARM, Random.of(ARM, 5000, seed=1), CELLS, "manipulability"))
COUNTED = run(Sweep(ARM, Grid.of(ARM, 50), Cells.box([-1] * 3, [1] * 3, 0.1)))
MAPS = pytest.mark.parametrize("found", [MEASURED, COUNTED], ids=["measured", "counted"])
ENDINGS = pytest.mark.parametrize("name", ["map.npz", "map.zarr"])


@MAPS
@ENDINGS
def test_a_file_gives_the_map_back(tmp_path, found, name):
    if name == "map.zarr":
        pytest.importorskip("zarr", reason="no zarr: no .zarr was written")
    COUNTED.save(tmp_path / name)  # which is replaced
    found.save(tmp_path / name)
    read = load_map(tmp_path / name)
    assert read.to_dict() == found.to_dict()
    assert read.counts.tobytes() == found.counts.tobytes()
    assert read.cells == found.cells
    numbers = np.arange(10)
    assert isinstance(read.samples, Samples)
    np.testing.assert_array_equal(
        read.samples.configurations(numbers), found.samples.configurations(numbers)
    )
    if found.best is not None:
        assert bits(read) == bits(found)
        np.testing.assert_array_equal(read.configurations(), found.configurations())
    assert [file.name for file in tmp_path.iterdir()] == [name]


def test_labels_say_where_the_cells_are():
    pytest.importorskip("xarray", reason="no xarray: no map was labelled")
    found = MEASURED.to_xarray()
    assert dict(found.sizes) == {"x": 21, "y": 20, "z": 5, "tile": 12, "xyz": 3}
    centres = CELLS.centres()
    at = (20, 3, 1)
    for k, axis in enumerate("xyz"):
        assert found[axis].to_numpy()[at[k]] == centres[at][k]
        assert found[axis].attrs["units"] == "m"
    np.testing.assert_array_equal(found.direction.to_numpy(), tile_centres(1))
    filled = np.argwhere(MEASURED.counts)[7]
    x, y, z, tile = filled.tolist()
    one = found.sel(x=centres[x, 0, 0, 0], y=centres[0, y, 0, 1], z=centres[0, 0, z, 2]).isel(
        tile=tile
    )
    assert MEASURED.best is not None
    assert MEASURED.attained is not None
    assert int(one.counts) == MEASURED.counts[tuple(filled)]
    assert float(one.best) == MEASURED.best[tuple(filled)]
    assert int(one.attained) == MEASURED.attained[tuple(filled)]
    assert set(COUNTED.to_xarray().data_vars) == {"counts"}


def test_a_file_that_holds_no_map_is_refused(tmp_path):
    with pytest.raises(FileError, match="no such file"):
        load_map(tmp_path / "none.npz")
    (tmp_path / "text.npz").write_text("no map")
    with pytest.raises(FileError, match="no map of a sweep"):
        load_map(tmp_path / "text.npz")
    np.savez(tmp_path / "other.npz", counts=np.zeros(3))
    with pytest.raises(FileError) as caught:
        load_map(tmp_path / "other.npz")
    words = "no map of a sweep, as SweepMap.save writes it"
    assert str(caught.value) == f"{tmp_path / 'other.npz'}: {words}"
    with pytest.raises(
        InputError, match=r"expected a \.npz file or a \.zarr directory, got '.*map"
    ):
        load_map(tmp_path / "map")


def test_a_directory_of_something_else_is_neither_read_nor_replaced(tmp_path):
    zarr = pytest.importorskip("zarr", reason="no zarr: no .zarr was read")
    (tmp_path / "empty.zarr").mkdir()
    (tmp_path / "text.zarr").mkdir()
    (tmp_path / "text.zarr" / "zarr.json").write_text("{}")
    zarr.open_group(tmp_path / "other.zarr", mode="w")
    for name in ("empty.zarr", "text.zarr", "other.zarr"):
        before = sorted((tmp_path / name).rglob("*"))
        with pytest.raises(FileError, match="no map of a sweep"):
            load_map(tmp_path / name)
        with pytest.raises(InputError, match="is there already, and holds no map"):
            COUNTED.save(tmp_path / name)
        assert sorted((tmp_path / name).rglob("*")) == before


@ENDINGS
def test_a_map_that_cannot_be_written_leaves_nothing(tmp_path, name):
    if name == "map.zarr":
        pytest.importorskip("zarr", reason="no zarr: no .zarr was written")
    (tmp_path / "none").write_text("a file, and no directory")
    with pytest.raises(FileError, match=r"map\."):
        MEASURED.save(tmp_path / "none" / name)
    assert [file.name for file in tmp_path.iterdir()] == ["none"]


def test_an_old_map_stays_where_the_new_one_cannot_take_its_place(tmp_path, monkeypatch):
    pytest.importorskip("zarr", reason="no zarr: no .zarr was written")
    place = tmp_path / "map.zarr"
    COUNTED.save(place)
    rename = Path.rename

    def refused(self, target):
        if self.name.endswith(".part"):
            raise OSError(errno.EACCES, os.strerror(errno.EACCES))
        return rename(self, target)

    monkeypatch.setattr(Path, "rename", refused)
    with pytest.raises(FileError, match=r"map\.zarr: Permission denied"):
        MEASURED.save(place)
    assert load_map(place).counts.tobytes() == COUNTED.counts.tobytes()
    assert [file.name for file in tmp_path.iterdir()] == ["map.zarr"]


@pytest.mark.parametrize("package", ["xarray", "zarr"])
def test_without_the_extra_its_name_is_said(tmp_path, monkeypatch, package):
    pytest.importorskip("xarray", reason="no xarray: it cannot be taken away")
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(MissingExtra, match=rf"{package}.*poekin\[sweep\]"):
        COUNTED.save(tmp_path / "map.zarr")
    (tmp_path / "map.zarr").mkdir()
    with pytest.raises(MissingExtra, match=rf"{package}.*poekin\[sweep\]"):
        load_map(tmp_path / "map.zarr")
