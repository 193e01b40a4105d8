"""Calls of somebody else's function: whatever it does, the run goes on, and what it did is a text."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable
from types import TracebackType
from typing import Any, NamedTuple

import numpy as np

from ....errors import escape_unprintable

ENDED = "ended the process"
UNANSWERED = "no answer in"
LOST = "cannot be made again"
ArrayFunction = Callable[[np.ndarray], Any]
HERE = os.path.dirname(os.path.dirname(__file__))


class Attempt:
    """A block whose exceptions end it, and nothing else: `fault` says in one line what was raised,
    "" where nothing.

    What a subject may raise cannot be listed, and each exception of its own is a finding, not an
    error of the run; so is that it wants to end Python. KeyboardInterrupt and the like pass.
    `place` is the file and line of what raised.
    """

    def __init__(self) -> None:
        self.fault = self.place = ""

    def __enter__(self) -> Attempt:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> bool:
        if not isinstance(error, Exception | SystemExit):
            return False
        if isinstance(error, Fault):
            self.fault = str(error)
            return True
        said = escape_unprintable(" ".join(str(error).split()), 200)
        self.fault = type(error).__name__
        if said:
            self.fault += f": {said}"
        while trace is not None:
            file = trace.tb_frame.f_code.co_filename
            if not file.startswith(HERE) and "importlib" not in file:
                self.place = f"{os.path.basename(file)}, line {trace.tb_lineno}"
            trace = trace.tb_next
        return True


class Fault(Exception):
    """A fault that is said already: of a call in another process, or of that process."""


class Undeclared(Exception):
    """A law that a subject declares to be asked, and does not have what it is asked of."""


class ArgumentChanged(Exception):
    """A function wrote into an argument, which is its caller's."""


class CallResult(NamedTuple):
    """Result of a call, or None and the fault."""

    value: Any
    fault: str = ""


def made(call: Callable[[], Any]) -> CallResult:
    """Anything that a call of a subject's returns, or None and the fault, which is an exception.
    Warnings are none.
    """
    value: Any = None
    with Attempt() as attempt, warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        value = call()
    return CallResult(value, attempt.fault)


def untouched(function: Callable[..., Any]) -> Callable[..., Any]:
    """The function, which raises ArgumentChanged where it leaves other numbers in an array than it
    was given.
    """

    def call(*arguments: np.ndarray) -> Any:
        before = [np.array(x) for x in arguments]
        result = function(*arguments)
        for place, (x, was) in enumerate(zip(arguments, before, strict=True), 1):
            if not np.array_equal(x, was):
                which = "argument"
                if len(before) > 1:
                    which = f"argument {place} of {len(before)}"
                raise ArgumentChanged(f"it writes into its {which}")
        return result

    return call


def called(
    function: Callable[..., Any],
    shape: tuple[int, ...],
    *arguments: np.ndarray,
) -> CallResult:
    """The array of finite numbers, in the shape expected, that a function makes of copies of the
    arguments.

    A fault is an exception, another shape, what is no array of real numbers, NaN and infinite, and
    an argument that other numbers are left in.
    """
    value, fault = made(
        lambda: real(untouched(function)(*(np.array(x) for x in arguments))).astype(float)
    )
    if fault:
        return CallResult(None, fault)
    if value.shape != shape:
        return CallResult(None, f"shape {value.shape} where {shape} was expected")
    if np.isnan(value).any():
        return CallResult(None, "NaN")
    if not np.isfinite(value).all():
        return CallResult(None, "infinite")
    return CallResult(value)


def real(value: Any) -> np.ndarray:
    """A copy of an array of real numbers, as floats of their own precision; other objects are
    converted if they can be.

    Raises: TypeError for complex numbers that are not real, and for texts: NumPy would convert
    both.
    """
    array = np.asarray(value)
    if array.dtype.kind in "SU" or (np.iscomplexobj(array) and np.any(np.imag(array))):
        raise TypeError(f"real numbers expected, got {array.dtype.name}")
    if array.dtype in (np.float16, np.float32):
        return np.array(array)
    return np.array(np.real(array), dtype=float)
