"""One input to one reader: what came of it."""

from __future__ import annotations

import os
import re
import resource
import time
import traceback
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

from poekin.errors import PoekinError, PoekinWarning

from .readers import Reader

SLOW = 1.0
"""Seconds that an input may take: of the processor, and again of waiting, as for a lock, a pipe or
a clock.
"""
MEMORY = 2**30
"""Bytes that a process may hold, poekin and all that it uses among them."""
LONGEST = 20_000
"""Characters of a message that somebody may still read."""

# In the words of libxml2, of MuJoCo and of C++; a stack or an arena whose size the model itself
# asks for is none.
_NO_MEMORY = re.compile(
    r"(?<!mj_stackAlloc: )out of memory|(cannot|could not|failed to) allocate(?! mjData arena)|bad_alloc",
    re.IGNORECASE,
)


class Failure(NamedTuple):
    """What a reader must not do: what it was, where in poekin, and the traceback; index, of the
    input.
    """

    what: str
    where: str
    trace: str
    index: int = -1


class Trial(NamedTuple):
    """accepted: whether something was read; seconds of the processor; failure, or None; waited:
    seconds of neither having nor wanting a processor.
    """

    accepted: bool
    seconds: float
    failure: Failure | None
    waited: float = 0.0


def attempt(reader: Reader, data: bytes, use: bool = True) -> Trial:
    """Read an input, out of a file in the working directory, and use what was read.

    A warning of poekin's own is none of its failures; any other is, as it would be in a test run of
    its users.
    """
    for name, content in (*reader.beside, (reader.file, data)):
        Path(name).write_bytes(content)
    there = os.listdir()
    accepted, failure = False, None
    peak, start, idle = _peak(), time.process_time(), _idle()
    with _warnings_said() as said:
        try:
            read = reader.read(reader.file)
            accepted = True
            if use:
                reader.use(read)
        except PoekinError as fault:
            said.append(str(fault))
            failure = _refused_badly(fault)
        except BaseException as fault:  # noqa: BLE001  whatever it is, it is what is looked for
            failure = Failure(
                type(fault).__name__, _place(fault), "".join(traceback.format_exception(fault))
            )
    seconds, waited = time.process_time() - start, _idle() - idle
    if failure is None:
        failure = next(filter(None, map(_unreadable, said)), None)
    if left := set(os.listdir()).difference(there):
        for name in left:
            os.remove(name)
        failure = failure or Failure("left a file", reader.name, ", ".join(left))
    if failure is None and peak < _peak() >= 0.9 * MEMORY:
        failure = Failure("memory", reader.name, f"the process has held {_peak() / 2**20:.0f} MiB")
    return Trial(accepted, seconds, failure, waited)


@contextmanager
def _warnings_said() -> Iterator[list[str]]:
    """The texts of poekin's warnings; all others are raised."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("error")
        warnings.simplefilter("always", PoekinWarning)
        said: list[str] = []
        yield said
        said += [str(warning.message) for warning in caught]


def _unreadable(message: str) -> Failure | None:
    """A message that a terminal would obey, that cannot be printed, or that nobody reads to its
    end.
    """
    if len(message) > LONGEST:
        return Failure(
            "endless message", _start(message), f"{len(message)} characters: {message[:300]!r} ..."
        )
    if not message.replace("\n", "").isprintable():
        return Failure("raw message", _start(message), repr(message[:2000]))
    return None


def _refused_badly(fault: BaseException) -> Failure | None:
    """A refusal that is no more than the limit of this process, as elsewhere the reader would have
    gone on eating; or one that is its own cause, so that whoever looks for the first cause goes
    round for ever.
    """
    chain: list[BaseException] = [fault]
    while (cause := chain[-1].__cause__ or chain[-1].__context__) is not None:
        if cause in chain:
            return Failure("its own cause", _place(fault), traceback.format_exc())
        chain.append(cause)
    if any(isinstance(one, MemoryError) or _NO_MEMORY.search(str(one)) for one in chain):
        return Failure("memory refused", _place(fault), traceback.format_exc())
    return None


def _start(message: str) -> str:
    return " ".join(message.split(": ")[1:3])[:40]


def _place(fault: BaseException) -> str:
    """The innermost function of poekin that was at work; else the innermost of all."""
    frames = [(f.filename, f.name) for f in traceback.extract_tb(fault.__traceback__)]
    inside = [(file, name) for file, name in frames if "/poekin/" in file] or frames[-1:]
    return f"{inside[-1][0].rpartition('/poekin/')[2]} {inside[-1][1]}" if inside else ""


def _idle() -> float:
    """Seconds of the clock less those on a processor or in the queue for one: a busy machine makes
    nobody wait.
    """
    on, queued = map(int, Path("/proc/thread-self/schedstat").read_text().split()[:2])
    return time.monotonic() - (on + queued) / 1e9


def _peak() -> int:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
