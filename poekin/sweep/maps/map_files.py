"""Files of maps: the sweep as JSON and its arrays, in a file of NumPy's or a directory of Zarr's."""

from __future__ import annotations

import io
import json
import os
import zipfile
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import FileError, InputError, quote
from ...formats.text.atomic_write import write_whole
from ..cells import Cells
from . import labelled
from .kept_map import ARRAYS, KeptMap

ENDINGS = (".npz", ".zarr")
_NO_MAP = "no map of a sweep, as SweepMap.save writes it"


def write(path: str | os.PathLike[str], kept: KeptMap, cells: Cells) -> None:
    """Writes a .npz file or a .zarr directory. Raises: FileError, InputError, MissingExtra."""
    if ending(path) == ".zarr":
        labelled.write_zarr(path, kept, cells)
        return
    written = io.BytesIO()
    parts: dict[str, Any] = {"about": json.dumps(kept.about), "outside": kept.outside}
    parts |= kept.arrays
    np.savez_compressed(written, **parts)
    write_whole(path, written.getvalue())


def read(path: str | os.PathLike[str]) -> KeptMap:
    """Reads a .npz file or a .zarr directory. Raises: FileError, InputError, MissingExtra."""
    is_zarr = ending(path) == ".zarr"
    if not Path(path).exists():
        raise FileError(f"{path}: no such file")
    try:
        if is_zarr:
            return labelled.read_zarr(path)
        with Path(path).open("rb") as opened, np.load(opened, allow_pickle=False) as file:
            arrays = {name: file[name] for name in ARRAYS if name in file}
            return KeptMap(json.loads(str(file["about"])), arrays, int(file["outside"]))
    except OSError as error:
        raise FileError(f"{path}: {error.strerror or _NO_MAP}") from error
    except (ValueError, KeyError, TypeError, EOFError, zipfile.BadZipFile) as error:
        raise FileError(f"{path}: {_NO_MAP}") from error


def check_place(path: str | os.PathLike[str], what: str) -> None:
    """Refuses a place that a map could not be written to, before any work is done. Raises: FileError,
    InputError, MissingExtra.
    """
    is_zarr = ending(path, what) == ".zarr"
    place = Path(path)
    if not place.parent.is_dir():
        raise FileError(f"{what}: there is no directory {quote(os.fspath(place.parent), 300)}")
    if is_zarr:
        labelled.check_place(place)
    elif place.is_dir():
        raise FileError(f"{what}: {quote(os.fspath(path), 300)} is a directory")


def ending(path: str | os.PathLike[str], what: str = "path") -> str:
    """The ending of a map's path. Raises: InputError, if it is none of these."""
    found = Path(path).suffix
    if found not in ENDINGS:
        raise InputError(
            f"{what}: expected a .npz file or a .zarr directory, got {quote(os.fspath(path), 300)}"
        )
    return found
