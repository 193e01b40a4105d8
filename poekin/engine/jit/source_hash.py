"""The key of the source that machine code comes from, taken when the package is imported.

Later would be too late: an edit made while a session is open changes the files, and not what the
session has loaded.
"""

from __future__ import annotations

import hashlib
import itertools
from pathlib import Path


def source_key(package: Path) -> str | None:
    """SHA-256 over all source of algebra, formulas and engine; None where the source cannot be
    read.
    """
    rooms = (sorted((package / room).rglob("*.py")) for room in ("formulas", "engine"))
    digest = hashlib.sha256()
    try:
        for path in [package / "algebra.py", *itertools.chain(*rooms)]:
            text = path.read_bytes()
            digest.update(f"{path.relative_to(package).as_posix()} {len(text)} ".encode() + text)
    except OSError:
        return None
    return digest.hexdigest()


LOADED = source_key(Path(__file__).parents[2])
