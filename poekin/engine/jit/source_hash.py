"""The key of the source that machine code comes from, taken when the package is imported.

Later would be too late: an edit made while a session is open changes the files, and not what the
session has loaded.
"""

from __future__ import annotations

import hashlib
import itertools
from collections.abc import Sequence
from pathlib import Path

KERNELS = ("algebra.py", "formulas", "engine")
PROGRAMS = ("model/kinematics", "sweep/masks", "sweep/measures")
"""Rooms that write programs of one arm, which are compiled beside the kernels."""


def source_key(package: Path, rooms: Sequence[str] = KERNELS) -> str | None:
    """SHA-256 over all source of files and rooms; None where the source cannot be read."""
    digest = hashlib.sha256()
    try:
        for path in itertools.chain(*(_sources(package / room) for room in rooms)):
            text = path.read_bytes()
            digest.update(f"{path.relative_to(package).as_posix()} {len(text)} ".encode() + text)
    except OSError:
        return None
    return digest.hexdigest()


def _sources(place: Path) -> list[Path]:
    return [place] if place.suffix else sorted(place.rglob("*.py"))


_PACKAGE = Path(__file__).parents[2]
LOADED = source_key(_PACKAGE)
LOADED_PROGRAMS = source_key(_PACKAGE, PROGRAMS)
