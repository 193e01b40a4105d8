"""Functions of rows, transpiled and compiled by the system's compiler."""

from __future__ import annotations

import ctypes
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from poekin.engine.transpile.c_types import CRow, CType
from poekin.engine.transpile.translation_unit import TranslationUnit
from poekin.engine.transpile.values import Argument

STRICT = (
    "-std=c99",
    "-O2",
    "-ffp-contract=off",
    "-Wall",
    "-Wextra",
    "-Wpedantic",
    "-Wconversion",
    "-Wshadow",
    "-Wdouble-promotion",
    "-Werror",
)
READ = 6
WRITTEN = 16


def text_of(*functions: Callable, types: tuple[CType, ...] = (CRow(READ), CRow(WRITTEN))) -> str:
    """C of functions (a, out), each with a function run_NAME that others can call."""
    unit = TranslationUnit("t")
    entries = [unit.instance(function, [Argument(t) for t in types]) for function in functions]
    lines = ["#include <math.h>", "", unit.text([entry for entry in entries if entry])]
    for function, entry in zip(functions, entries, strict=True):
        assert entry is not None
        head = f"void run_{function.__name__}(double *a, double *out)"
        lines += [f"{head};", head, "{", "    (void)a;", f"    {entry.name}(a, out);", "}"]
    return "\n".join(lines) + "\n"


def library(folder: Path, text: str) -> ctypes.CDLL:
    """The compiled text; each of gcc and clang that there is compiles it without a warning."""
    found = [path for path in map(shutil.which, ("gcc", "clang")) if path]
    if not found:
        pytest.skip("no C compiler: what is transpiled was not compiled")
    (folder / "unit.c").write_text(text, encoding="ascii")
    for compiler in found:
        words = [compiler, *STRICT, "-fPIC", "-shared", "unit.c", "-o", "unit.so", "-lm"]
        done = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False)
        assert (done.returncode, done.stderr) == (0, "")
    return ctypes.CDLL(str(folder / "unit.so"))


def run(unit: ctypes.CDLL, function: Callable, a: list[float]) -> np.ndarray:
    """What the C of a function writes."""
    given = np.array(a)
    out = np.zeros(WRITTEN)
    pointers = (given.ctypes.data_as(ctypes.c_void_p), out.ctypes.data_as(ctypes.c_void_p))
    getattr(unit, f"run_{function.__name__}")(*pointers)
    return out
