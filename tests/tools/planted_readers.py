"""Readers that do what none may do, for some inputs: the fuzzer has to find each of them."""

from __future__ import annotations

import os
import sys
import time
import warnings
from pathlib import Path

import numpy as np

from poekin.errors import InputError, PoekinWarning
from tools.fuzz.draw import Draw
from tools.fuzz.readers import Reader


def _digits(d: Draw) -> str:
    return "".join(str(d.below(10)) for _ in range(3))


def _sound(path: str) -> bytes:
    data = Path(path).read_bytes()
    if b"0" in data:
        raise InputError("expected no 0")
    warnings.warn("something was repaired", PoekinWarning, stacklevel=2)
    return data


def _planted(fault) -> Reader:
    """A reader that does this to what has a 7 and no 0 in it."""

    def read(path: str) -> None:
        if b"7" in _sound(path):
            fault()

    return Reader("planted", "input.txt", read, _digits, lambda: (b"1",))


def _raise(fault: BaseException):
    def fails() -> None:
        raise fault

    return fails


def _hang() -> None:
    while True:
        pass


def _eat() -> None:
    eaten = []
    while True:
        eaten.append(np.zeros(2**23))


def _wait() -> None:
    time.sleep(0.1)


def _starve() -> None:
    try:
        raise MemoryError
    except MemoryError as fault:
        raise InputError("expected something smaller") from fault


def _circular() -> None:
    fault = InputError("it is its own cause")
    raise fault from fault


def _warn() -> None:
    warnings.warn("overflow", RuntimeWarning, stacklevel=2)


sound = Reader("planted", "input.txt", _sound, _digits, lambda: (b"1",))
value_error = _planted(_raise(ValueError("7")))
system_exit = _planted(lambda: sys.exit(0))
recursion = _planted(lambda: _raise(RecursionError())())
raw_message = _planted(_raise(InputError("\x1b[31mred")))
endless_message = _planted(_raise(InputError("x" * 10**6)))
foreign_warning = _planted(_warn)
hang = _planted(_hang)
waiting = _planted(_wait)
starved = _planted(_starve)
circular = _planted(_circular)
starved_in_words = _planted(_raise(InputError("the library said: Out of memory")))
memory = _planted(_eat)
memory_at_once = _planted(lambda: bytearray(2**31))
left_file = _planted(lambda: Path("log.txt").write_text("7"))
crash = _planted(os.abort)


def _used(read: bytes) -> None:
    if b"7" in read:
        raise ZeroDivisionError


in_use = Reader("planted", "input.txt", _sound, _digits, lambda: (b"1",), _used)
