"""Maps with labelled axes, as xarray and Zarr know them; needs the extra "sweep"."""

from __future__ import annotations

import json
import os
import secrets
import shutil
from pathlib import Path
from typing import Any

from ...errors import FileError, InputError, MissingExtra, quote
from ..cells import Cells
from ..tile_centres import tile_centres
from .kept_map import ARRAYS, KeptMap

_ABOUT = "poekin_sweep"
_OUTSIDE = "samples_outside"


def dataset(kept: KeptMap, cells: Cells) -> Any:
    """The arrays with the centres of cubes and tiles as coordinates. Raises: MissingExtra."""
    xarray = _xarray()
    centres = cells.centres()
    coordinates: dict[str, Any] = {
        "x": ("x", centres[:, 0, 0, 0], {"units": "m"}),
        "y": ("y", centres[0, :, 0, 1], {"units": "m"}),
        "z": ("z", centres[0, 0, :, 2], {"units": "m"}),
    }
    axes = ["x", "y", "z"]
    if cells.side:
        coordinates["direction"] = (("tile", "xyz"), tile_centres(cells.side))
        axes.append("tile")
    variables = {name: (axes, array) for name, array in kept.arrays.items()}
    attributes = {_ABOUT: json.dumps(kept.about), _OUTSIDE: kept.outside}
    return xarray.Dataset(variables, coordinates, attributes)


def check_place(path: Path) -> None:
    """Refuses a place that could not become a map. Raises: InputError, MissingExtra."""
    _xarray()
    _zarr()
    if path.exists() and not _holds_map(path):
        raise InputError(
            f"{quote(os.fspath(path), 300)} is there already, and holds no map of a sweep"
        )


def write_zarr(path: str | os.PathLike[str], kept: KeptMap, cells: Cells) -> None:
    """Writes a directory, which appears whole or not at all; an old map is replaced, and stays until
    then. Raises: FileError, InputError, MissingExtra.
    """
    target = Path(path)
    check_place(target)
    labelled = dataset(kept, cells)
    mark = secrets.token_hex(8)
    written = target.with_name(f".{target.name[:50]}.{mark}.part")
    old = target.with_name(f".{target.name[:50]}.{mark}.old")
    try:
        labelled.to_zarr(written, mode="w-", consolidated=False)
        if target.exists():
            target.rename(old)
        written.rename(target)
    except OSError as error:
        if old.exists():
            old.rename(target)
        raise FileError(f"{path}: {error.strerror or error}") from error
    finally:
        shutil.rmtree(written, ignore_errors=True)
    shutil.rmtree(old, ignore_errors=True)


def read_zarr(path: str | os.PathLike[str]) -> KeptMap:
    """Reads such a directory. Raises: KeyError, ValueError, OSError, MissingExtra."""
    xarray = _xarray()
    _zarr()
    with xarray.open_zarr(os.fspath(path), consolidated=False, chunks=None) as opened:
        arrays = {name: opened[name].to_numpy() for name in ARRAYS if name in opened}
        about = json.loads(opened.attrs[_ABOUT])
        return KeptMap(about, arrays, int(opened.attrs[_OUTSIDE]))


def _holds_map(path: Path) -> bool:
    """Whether a directory is one that `write_zarr` has written."""
    try:
        head = json.loads((path / "zarr.json").read_text(encoding="utf-8"))
        return _ABOUT in head["attributes"]
    except (OSError, ValueError, KeyError, TypeError):
        return False


def _xarray() -> Any:
    try:
        import xarray
    except ImportError as missing:
        raise MissingExtra("xarray", "sweep", "a map with labelled axes") from missing
    return xarray


def _zarr() -> None:
    try:
        import zarr  # noqa: F401 - xarray finds it by itself
    except ImportError as missing:
        raise MissingExtra("zarr", "sweep", "a map in a .zarr directory") from missing
