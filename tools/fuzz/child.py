"""The process in which inputs are tried: it may hang, be killed or run out of memory, and the
watcher tells.
"""

from __future__ import annotations

import faulthandler
import gc
import os
import resource
import signal
import traceback
from collections.abc import Iterator
from multiprocessing.connection import Connection
from pathlib import Path
from typing import IO, Any, NamedTuple

from . import inputs
from .readers import Reader, of_name
from .trial import MEMORY, Failure, Trial, attempt

TRACE = "trace.txt"
"""Where the traceback of a hang or crash is written, in the child's own directory."""
AT, ACCEPTED, SLOWEST, SLOWEST_AT, WRITTEN = range(5)
"""What the shared counters hold: the input under way, how many were accepted, the most
microseconds, and of which; and the bytes of traceback that there were before that input.
"""


class Job(NamedTuple):
    """Inputs start ... stop - 1 of a reader; or, where there is data, that alone, to be used as
    well.
    """

    reader: str
    seed: int
    start: int
    stop: int
    data: bytes | None = None


def serve(connection: Connection, counters: Any, folder: str, slow: float) -> None:
    """Do the jobs that come in, until there are no more: a Failure is sent back for each, and None
    at a job's end.

    slow: seconds that an input may take, in place of SLOW.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # what comes from the keyboard is for the watcher
    os.chdir(folder)
    quiet = os.open(os.devnull, os.O_RDWR)
    for stream in (0, 1, 2):  # what libraries print about broken files is not read by anybody
        os.dup2(quiet, stream)
    # Open as long as the process lives: it is written to when nothing else can be done any more.
    trace = open(TRACE, "wb", buffering=0)  # noqa: SIM115
    faulthandler.enable(trace)
    faulthandler.register(signal.SIGPROF, trace, all_threads=False)
    try:
        while (job := connection.recv()) is not None:
            reader = _ready(job.reader)
            for failure in _failures(reader, job, counters, trace, slow):
                connection.send(failure)
            connection.send(None)
    except EOFError:  # the watcher is gone
        return
    except BaseException as fault:
        connection.send("".join(traceback.format_exception(fault)))
        raise


_known: dict[str, Reader] = {}


def _ready(name: str) -> Reader:
    """The reader, after it has read its seeds once: what it imports and compiles is no input's time
    or memory.
    """
    if name not in _known:
        _limit(None)
        reader = of_name(name)
        for data in reader.seeds():
            attempt(reader, data)
        _known[name] = reader
        gc.collect()
        gc.freeze()
    _limit(MEMORY)
    return _known[name]


def _limit(memory: int | None) -> None:
    """Let the process grow until it holds that much: what is mapped and not used does not count."""
    pages = [
        int(n) * resource.getpagesize() for n in Path("/proc/self/statm").read_text().split()[:2]
    ]
    hard = resource.getrlimit(resource.RLIMIT_AS)[1]
    soft = resource.RLIM_INFINITY if memory is None else pages[0] + memory - pages[1]
    resource.setrlimit(resource.RLIMIT_AS, (soft, hard))


def _failures(
    reader: Reader, job: Job, counters: Any, trace: IO[bytes], slow: float
) -> Iterator[Failure]:
    for index in range(job.start, job.stop):
        data = inputs.make(reader, job.seed, index) if job.data is None else job.data
        counters[WRITTEN] = os.fstat(trace.fileno()).st_size
        counters[AT] = index
        trial = _timed(reader, data, job.data is not None or index % 4 == 0, slow)
        counters[ACCEPTED] += trial.accepted
        if trial.seconds * 1e6 > counters[SLOWEST]:
            counters[SLOWEST], counters[SLOWEST_AT] = int(trial.seconds * 1e6), index
        if trial.failure is not None:
            yield trial.failure._replace(index=index)


def _timed(reader: Reader, data: bytes, use: bool, slow: float) -> Trial:
    """A trial under the clock: when time is up the traceback is written, and the watcher waits no
    longer.

    What was too long once has to be so again: the first time something may have been imported or
    compiled.
    """
    for _ in range(2):
        signal.setitimer(signal.ITIMER_PROF, slow)
        trial = attempt(reader, data, use)
        signal.setitimer(signal.ITIMER_PROF, 0)
        if max(trial.seconds, trial.waited) <= slow:
            return trial
    took = f"{trial.seconds:.1f} s of the processor and {trial.waited:.1f} s of waiting"
    hang = Failure("hang", reader.name, f"{took}; {TRACE} has where, if it was the processor")
    return trial._replace(failure=trial.failure or hang)
