"""The bound on the size of the cache: what has not been used for the longest time is removed first."""

from __future__ import annotations

import contextlib
import os
import time
from pathlib import Path

MONTH = 30 * 24 * 3600.0
ARM = "arm-"
"""The first characters of the names of entries for single arms."""

_unswept: dict[Path, float] = {}


def bound(place: Path, written: int, most: float) -> None:
    """Remove the oldest entries of a directory where there may be more than `most` bytes.

    An entry is as old as its last use. Arms take at most half of the room, and are removed after a
    month too: the code of thousands of them does not remove the kernels that every process needs,
    and those that an image came with stay however old it is.
    Parameters: written, bytes of the entry that was just written. The directory is looked through
    when this process writes its first entry there, and after each sixteenth of the bound.
    """
    unswept = _unswept.get(place, most) + written
    if unswept > most / 16:
        unswept = 0
        _sweep(place, most * 15 / 16)
    _unswept[place] = unswept


def _sweep(place: Path, most: float) -> None:
    """Remove all entries but the latest that have room."""
    found = []
    with os.scandir(place) as files:
        for file in files:
            # an entry, or what is left of a process that ended while it wrote one
            if ".kernel" in file.name:
                with contextlib.suppress(FileNotFoundError):  # another process was quicker
                    status = file.stat(follow_symlinks=False)
                    found.append((status.st_mtime, status.st_size, file))
    arms = whole = 0
    long_ago = time.time() - MONTH
    for used, size, file in sorted(found, key=lambda one: one[0], reverse=True):
        whole_package = file.name.endswith(".kernel") and not file.name.startswith(ARM)
        keep = whole_package or used > long_ago
        if keep and file.name.startswith(ARM):
            arms += size
            keep = arms <= most / 2
        if keep:
            whole += size
            keep = whole <= most
        if not keep:
            # it is gone already, or in use where such a file cannot be removed
            with contextlib.suppress(OSError):
                os.unlink(file.path)
