"""Mesh files as parts, kept in the cache between runs: trimesh takes seconds to be imported."""

from __future__ import annotations

import hashlib
import json
import os
from typing import Any

import numpy as np

from ...formats.text import xml
from .load import MeshPart, load

VERSION = 1
"""To be counted up when `load` reads a file otherwise than before."""


def parts_of(path: str) -> tuple[MeshPart, ...]:
    """Parts of a mesh file. Raises: FileError for what cannot be read; MissingExtra."""
    from ...engine.jit import cache, cache_size  # imports Numba, which waits for the first need

    data = xml.read_bytes(path)
    ending = os.path.splitext(path)[1].lower()
    if ending == ".obj":  # its colours are in another file
        return load(data, path)
    key = (VERSION, ending, hashlib.sha256(data).hexdigest())
    entry = cache.entry(f"{cache_size.ARM}mesh", key)
    kept = cache.read(entry) if entry is not None else None
    if kept is not None:
        return _unpacked(kept)
    parts = load(data, path)
    if entry is not None:
        cache.write(entry, _packed(parts))
    return parts


def _packed(parts: tuple[MeshPart, ...]) -> bytes:
    """Parts as a line of JSON, and the bytes of their arrays."""
    head = [(len(part.vertices), len(part.faces), part.color) for part in parts]
    arrays = [array.tobytes() for part in parts for array in (part.vertices, part.faces)]
    return b"".join([json.dumps(head).encode(), b"\n", *arrays])


def _unpacked(content: bytes) -> tuple[MeshPart, ...]:
    """Parts of an entry, which the cache has checked to be as it was written."""
    line, _, _ = content.partition(b"\n")
    place = len(line) + 1
    parts = []
    head: list[tuple[int, int, Any]] = json.loads(line)
    for vertices, faces, color in head:
        floats = np.frombuffer(content, np.float32, 3 * vertices, place)
        place += floats.nbytes
        numbers = np.frombuffer(content, np.uint32, 3 * faces, place)
        place += numbers.nbytes
        parts.append(MeshPart(floats.reshape(-1, 3), numbers.reshape(-1, 3), color))
    return tuple(parts)
