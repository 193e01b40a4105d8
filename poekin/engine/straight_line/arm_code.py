"""One arm's machine code: from the cache, or traced and compiled now, and kept there."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..jit import cache
from ..jit.source_hash import LOADED_PROGRAMS
from .machine_code import Layout, LoadedCode, object_code, processor
from .program import Program


class ArmCode:
    """Machine code that the kernels of `engine.kernels.arm_kernels` run; `address` is valid as long
    as this object lives.
    """

    __slots__ = ("_loaded", "_numbers", "address")

    def __init__(self, code: bytes, angles: int, coordinates: int, layout: Layout = "rows"):
        self._loaded = LoadedCode(code, layout)
        self._numbers = np.array([angles, coordinates, *self._loaded.addresses], np.int64)
        self.address = int(self._numbers.ctypes.data)


def arm_code(
    key: object,
    make: Callable[[], Program],
    coordinates: int,
    pose: bool,
    layout: Layout = "rows",
) -> ArmCode:
    """The machine code of the program that `make` makes. key: all that it depends on besides
    poekin's source.
    """
    beside = (LOADED_PROGRAMS, pose, layout, processor())
    path = cache.entry("arm", (key, beside))
    kept = None if path is None else cache.read(path)
    if kept is None:
        program = make()
        kept = len(program.angles).to_bytes(8, "little") + object_code(program, pose, layout)
        if path is not None:
            cache.write(path, kept)
    return ArmCode(kept[8:], int.from_bytes(kept[:8], "little"), coordinates, layout)
