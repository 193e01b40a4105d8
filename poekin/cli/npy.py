"""Configurations out of the content of a .npy file, whose header is checked against what is there."""

from __future__ import annotations

import ast
import math
import re
import warnings
from typing import Literal

import numpy as np

from ..errors import FileError, InputError

MAGIC = b"\x93NUMPY"
# NumPy's own limit on what it evaluates.
LONGEST_HEADER = 10_000
# Brackets and signs of a header: one of numbers has four.
NESTED = 100
# No array has more rows: a shape whose other axis is 0 could otherwise claim any number of them.
MOST_ROWS = 2**40
_ORDER: dict[bool, Literal["C", "F"]] = {False: "C", True: "F"}
# Of each version, the first byte of the header and its encoding.
_HEADERS = {b"\1\0": (10, "latin-1"), b"\2\0": (12, "latin-1"), b"\3\0": (12, "utf-8")}


def configurations(content: bytes, m: int, where: str, tail: tuple[int, ...] = ()) -> np.ndarray:
    """The array (N, m), or (m,) for a single configuration, in the bytes of a .npy file, as float64
    (N, m).

    Parameters: content; m; where, the file as messages call it; tail, last axes of m numbers, as
    (4, 4) for m = 16, that an array may have instead of (m,).
    Raises: FileError, which names the file, for what is no .npy file of real numbers, whose header
    is damaged, or that holds fewer bytes than its header says; InputError for another shape.
    Nothing is allocated before all that holds. Source: the format's versions 1.0 to 3.0 as the
    documentation of numpy.lib.format describes them.
    """
    try:
        dtype, column_major, shape, start = _header(content)
    except ValueError as fault:
        raise FileError(f"{where} is no .npy file of numbers: {fault}") from fault
    last: tuple[int, ...] = (m,)
    if tail and tail in (shape, shape[1:]):
        last = tail
    if last not in (shape, shape[1:]):
        raise InputError(f"{where}: an array of shape (N, {m}) expected, got {shape}")
    count = math.prod(shape)
    needed = count * dtype.itemsize
    there = len(content) - start
    if needed > there:
        raise FileError(f"{where} is damaged: its header says {needed} bytes, the file has {there}")
    flat = np.zeros(0, dtype)
    if count:  # NumPy refuses an empty buffer
        flat = np.frombuffer(content, dtype, count, start)
    # A signalling NaN becomes a quiet one, and what is too large infinite.
    with np.errstate(all="ignore"):
        values = flat.reshape(shape, order=_ORDER[column_major]).astype(float)
    return values.reshape(math.prod(shape[: -len(last)]), m)


def _header(content: bytes) -> tuple[np.dtype, bool, tuple[int, ...], int]:
    """Type of the elements, whether the first axis runs fastest, shape, and first byte of data."""
    if not content.startswith(MAGIC):
        raise ValueError("its first bytes are not those of a .npy file")
    version = content[6:8]
    if version not in _HEADERS:
        raise ValueError("its version is unknown")
    start, encoding = _HEADERS[version]
    length = int.from_bytes(content[8:start], "little")
    text = content[start : start + length]
    if len(content) < start or len(text) < length:
        raise ValueError("it ends within its header")
    if length > LONGEST_HEADER:
        raise ValueError(f"its header is longer than {LONGEST_HEADER} bytes")
    header = _literal(text, encoding)
    if not isinstance(header, dict) or set(header) != {"descr", "fortran_order", "shape"}:
        raise ValueError("its header does not say descr, fortran_order and shape")
    descr = header["descr"]
    column_major = header["fortran_order"]
    shape = header["shape"]
    if not isinstance(descr, str) or not re.fullmatch("[<>|=]?(f2|f4|f8|f16|[iu][1248])", descr):
        raise ValueError(f"an array of real numbers expected, its elements are {str(descr)[:40]!r}")
    if not isinstance(column_major, bool):
        raise ValueError("its header's fortran_order is neither True nor False")
    if not isinstance(shape, tuple) or not all(
        type(size) is int and 0 <= size <= MOST_ROWS for size in shape
    ):
        raise ValueError("its header's shape is not valid")
    return np.dtype(descr), column_major, shape, start + length


def _literal(text: bytes, encoding: str) -> object:
    """Value of a Python literal."""
    # Python's parser raises MemoryError where brackets are nested deeply.
    if sum(map(text.count, (b"(", b"[", b"{", b"-"))) > NESTED:
        raise ValueError("its header cannot be read")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", SyntaxWarning)
            return ast.literal_eval(text.decode(encoding).strip())
    except (ValueError, TypeError, SyntaxError, RecursionError, MemoryError) as fault:
        raise ValueError("its header cannot be read") from fault
