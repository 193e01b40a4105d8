"""One arm's machine code with its table of angles: from the cache, or traced and compiled now, and kept there."""

from __future__ import annotations

import struct
from collections.abc import Callable

import llvmlite
import numpy as np
from llvmlite import binding

from . import cache
from .machine_code import Loaded, object_code
from .program import Program

_HEAD = struct.Struct("<qq")


class Arm:
    """What the kernels of `engine.arm_kernels` run: `address` is good as long as this object lives."""

    __slots__ = ("_angles", "_loaded", "_numbers", "address")

    def __init__(self, code: bytes, angles: np.ndarray):
        self._loaded, self._angles = Loaded(code), angles
        numbers = (self._loaded.one, self._loaded.four, angles.ctypes.data, *angles.shape)
        self._numbers = np.array(numbers, np.int64)
        self.address = int(self._numbers.ctypes.data)


def arm(key: object, make: Callable[[], Program], coordinates: int, pose: bool) -> Arm:
    """The machine code of the program that `make` makes. key: all that it depends on besides poekin's source."""
    processor = binding.get_host_cpu_name(), binding.get_host_cpu_features().flatten(), llvmlite.__version__
    path = cache.entry("arm", (key, coordinates, pose, processor))
    kept = None if path is None else cache.read(path)
    if kept is None:
        program = make()
        angles, code = _table(program, coordinates), object_code(program, pose)
        if path is not None:
            cache.write(path, _HEAD.pack(*angles.shape) + angles.tobytes() + code)
        return Arm(code, angles)
    rows, columns = _HEAD.unpack_from(kept)
    end = _HEAD.size + 8 * rows * columns
    return Arm(kept[end:], np.frombuffer(kept[_HEAD.size : end]).reshape(rows, columns).copy())


def _table(program: Program, coordinates: int) -> np.ndarray:
    """Each angle as `engine.arm_kernels` reads it."""
    table = np.zeros((len(program.angles), 2 + coordinates))
    for row, angle in zip(table, program.angles, strict=True):
        row[0], row[1] = -1 if angle.base is None else angle.base, angle.offset
        for k, factor in angle.terms:
            row[2 + k] = factor
    return table
