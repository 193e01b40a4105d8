"""A directory that keeps the parts of a sweep as they are done, so that it can go on where it was."""

from __future__ import annotations

import json
import os
import zipfile
from pathlib import Path

import numpy as np

from ...errors import FileError, InputError
from ..sweep import Sweep
from .totals import SweepPart

_HEAD = "sweep.json"
_DAMAGED = (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile)


class Store:
    """Parts of one sweep in files of their own, each written whole or not at all.

    path: the directory; chunk, samples a part.
    """

    def __init__(
        self, path: str | os.PathLike[str], sweep: Sweep, chunk: int, resume: bool
    ) -> None:
        self.path = Path(path)
        head = sweep.describe() | {"chunk": chunk, "key": sweep.key()}
        text = json.dumps(head, indent=1)
        try:
            self.path.mkdir(parents=True, exist_ok=True)
            begun = (self.path / _HEAD).exists()
            if begun:
                self._check((self.path / _HEAD).read_text(encoding="utf-8"), head, resume)
            elif any(self.path.iterdir()):
                raise InputError(f"store: {self.path} is no empty directory, and holds no sweep")
            else:
                _write(self.path / _HEAD, text.encode())
        except OSError as error:
            raise FileError(f"store: {self.path}: {error.strerror}") from error

    def _check(self, text: str, head: dict[str, object], resume: bool) -> None:
        try:
            kept = json.loads(text)
        except ValueError:
            kept = {}
        differs = [
            name for name in head if not isinstance(kept, dict) or kept.get(name) != head[name]
        ]
        if differs:
            raise InputError(
                f"store: {self.path} holds another sweep; these differ: {', '.join(differs)} "
                "(key: the arm, or the version of poekin)"
            )
        if not resume:
            raise InputError(
                f"store: {self.path} holds this sweep, begun before; resume=True goes on with it"
            )

    def read(self, number: int) -> SweepPart | None:
        """A part, or None where it is not done or its file is damaged."""
        try:
            with (
                self._file(number).open("rb") as opened,
                np.load(opened, allow_pickle=False) as file,
            ):
                kept = [file[name] for name in SweepPart._fields]
            cells, counts, best, attained, outside = kept
            return SweepPart(cells, counts, best, attained, int(outside))
        except _DAMAGED:
            return None

    def write(self, number: int, part: SweepPart) -> None:
        """Keeps a part. Raises: FileError, where the disk is full, say; parts before are kept."""
        file = self._file(number)
        place = file.with_suffix(f".{os.getpid()}")
        try:
            with place.open("wb") as written:
                np.savez_compressed(written, **part._asdict())
                written.flush()
                os.fsync(written.fileno())
            place.replace(file)
        except OSError as error:
            place.unlink(missing_ok=True)
            raise FileError(f"store: {file}: {error.strerror}") from error

    def _file(self, number: int) -> Path:
        return self.path / f"part-{number:08d}.npz"


def _write(file: Path, content: bytes) -> None:
    place = file.with_suffix(f".{os.getpid()}")
    place.write_bytes(content)
    place.replace(file)
