"""The scalar functions that a sweep runs, as functions of CUDA: samples, cells, sines and cosines.

They are transpiled to C, and respelled: integers have 64 bits, functions and constants are the device's,
and numbers of single precision are told as such.
"""

from __future__ import annotations

import re
from typing import NamedTuple

from ....engine.kernels.sweep import root, samples, tiles
from ....engine.straight_line import arctangent, sincos
from ....engine.transpile.c_types import DOUBLE, INT, WORD, CRow, CTable, CTuple
from ....engine.transpile.translation_unit import External, TranslationUnit
from ....engine.transpile.values import Argument
from ..c import Real

_NUMBER = re.compile(r"(?<![\w.])(\d+\.\d+(?:e[+-]?\d+)?|\d+e[+-]?\d+)")


class DeviceCode(NamedTuple):
    """Text of the functions, the names of those that kernels call, and statements from an angle x to s[j]
    and c[j].
    """

    text: str
    names: dict[str, str]
    sines: tuple[str, ...]


def device_code(word: str, real: Real, dof: int) -> DeviceCode:
    """Functions whose names begin with `word`, for an arm with `dof` coordinates.

    In double precision sines and angles of points are poekin's own, to the last bit; in single
    precision, for which those are not made, CUDA's.
    """
    outside = {}
    if real == "float":
        outside[arctangent.atan2] = External("atan2f", returns=DOUBLE)
    unit = TranslationUnit(word, outside)
    point = Argument(CTuple((DOUBLE,) * 3))
    entries = {
        samples.write_grid: [
            Argument(INT),
            Argument(CTuple((INT,) * dof)),
            Argument(CTable(2, dof)),
            Argument(CRow(dof)),
        ],
        samples.write_random: [
            Argument(WORD),
            Argument(INT),
            Argument(CTable(2, dof)),
            Argument(CTable(dof, 1)),
        ],
        tiles.cell_of: [Argument(CTuple((INT,) * 4)), Argument(CRow(4)), point, point],
        root.root: [Argument(DOUBLE)],
    }
    sines: tuple[str, ...] = ("sincosf(x, &s[j], &c[j]);",)
    if real == "double":
        entries[sincos.sincos] = [Argument(DOUBLE)]
        call = f"const {word}_d2 both = {word}_sincos_sincos(x);"
        sines = (call, "s[j] = both.v[0];", "c[j] = both.v[1];")
    names = {}
    found = []
    for function, given in entries.items():
        instance = unit.instance(function, given)
        if instance is None:
            raise RuntimeError("a function that is being written was asked for")
        names[function.__name__] = instance.name
        found.append(instance)
    text = respelled(unit.text(found), word, real)
    return DeviceCode(text, names, sines)


def respelled(text: str, word: str, real: Real) -> str:
    """Transpiled C as CUDA: C++11, integers of 64 bits, numbers of `real`."""
    text = re.sub(r"\bint\b", "long long", text)
    text = re.sub(rf"\(({word}_\w+)\)\{{", r"\1{", text)
    text = re.sub(r"^static (const|inline)", r"static __device__ \1", text, flags=re.MULTILINE)
    if real == "float":
        text = _NUMBER.sub(r"\1f", re.sub(r"\bdouble\b", "float", text))
    return text
