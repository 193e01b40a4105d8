"""The watcher of one child: it starts it, hands it jobs, and tells of what the child cannot tell:
its own end.
"""

from __future__ import annotations

import multiprocessing
import shutil
import signal
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

from .child import AT, TRACE, WRITTEN, Job, serve
from .trial import SLOW, Failure

STALLED = 30.0
"""Seconds without progress, of the clock on the wall, after which a child hangs, whatever it waits
for.
"""
GRACE = 0.5
"""What an input has left after it has used up its time, as a part of that time."""
_STARTED = 180.0

# A directory in memory where there is one: an input is a file, and a million of them are written.
FAST = "/dev/shm" if Path("/dev/shm").is_dir() else None


class Tally(NamedTuple):
    """How many inputs there were, how many were accepted, the most seconds that one took, and which
    it was.
    """

    inputs: int = 0
    accepted: int = 0
    slowest: float = 0.0
    slowest_at: int = -1

    def with_(self, other: Tally) -> Tally:
        """Both together."""
        worst = max(self, other, key=lambda tally: tally.slowest)
        return Tally(
            self.inputs + other.inputs,
            self.accepted + other.accepted,
            worst.slowest,
            worst.slowest_at,
        )


class Child:
    """One process that tries inputs, and is started again whenever it ends."""

    def __init__(self, stalled: float = STALLED, slow: float = SLOW):
        self.stalled, self.slow = stalled, slow
        self.folder = tempfile.mkdtemp(prefix="poekin-fuzz-", dir=FAST)
        self._process: Any = None

    def __enter__(self) -> Child:
        return self

    def __exit__(self, *_: object) -> None:
        self._stop()
        shutil.rmtree(self.folder, ignore_errors=True)

    def run(self, job: Job, tell: Callable[[Failure], None]) -> Tally:
        """Do a job and tell its failures; a child that ends is one of them, and a new one goes on
        behind that input.
        """
        tally, start = Tally(), job.start
        while start < job.stop:
            ended = self._run(job._replace(start=start), tell)
            at, accepted, slowest, slowest_at, _ = self._counters[:]
            tally = tally.with_(Tally(max(at - start + 1, 0), accepted, slowest / 1e6, slowest_at))
            if ended is None:
                break
            self._stop()
            tell(ended)
            start = ended.index + 1
        return tally

    def _run(self, job: Job, tell: Callable[[Failure], None]) -> Failure | None:
        """The failure that ended the child, or None where it came to the end of the job."""
        process = self._process or self._start()
        counters = self._counters
        counters[:] = [job.start - 1, 0, 0, -1, self._written()]
        at, since = job.start - 1, time.monotonic()
        self._connection.send(job)
        while True:
            if self._connection.poll(min(0.2, self.slow / 2)):
                try:
                    said = self._connection.recv()
                except (EOFError, ConnectionResetError):
                    process.join()
                    if counters[AT] < job.start:
                        raise RuntimeError(
                            f"{job.reader}: its seeds end the child: {self._said()}"
                        ) from None
                    return self._ended(f"crash ({_exit(process.exitcode)})")
                if isinstance(said, str):
                    raise RuntimeError(f"the harness itself failed in its child:\n{said}")
                if said is None:
                    return None
                tell(said)
                continue
            now = time.monotonic()
            if counters[AT] != at:
                at, since = counters[AT], now
            if at < job.start:  # still importing, compiling, reading seeds
                if now - since > _STARTED:
                    raise RuntimeError(
                        f"{job.reader}: its seeds are not read within {_STARTED:g} s"
                    )
            elif now - since > self.stalled or (
                self._written() > counters[WRITTEN] and now - since > self.slow * (1 + GRACE)
            ):
                process.kill()
                process.join()
                return self._ended("hang")

    def _written(self) -> int:
        trace = Path(self.folder, TRACE)
        return trace.stat().st_size if trace.exists() else 0

    def _said(self) -> str:
        return (
            Path(self.folder, TRACE)
            .read_bytes()[self._counters[WRITTEN] :]
            .decode(errors="replace")
        )

    def _ended(self, what: str) -> Failure:
        said = self._said()
        lines = [line.strip() for line in said.splitlines() if "/poekin/" in line]
        where = (
            lines[0].rpartition("/poekin/")[2].replace('"', "") if lines and what == "hang" else ""
        )
        short = said if len(said) < 3000 else f"{said[:1500]}\n...\n{said[-1500:]}"
        return Failure(what, where.partition(",")[0], short or "no traceback", self._counters[AT])

    def _start(self) -> Any:
        # Not forked: a child has to begin without the memory and the threads of this process.
        context = multiprocessing.get_context("spawn")
        Path(self.folder, TRACE).unlink(missing_ok=True)
        self._counters = context.RawArray("q", 5)
        self._connection, theirs = context.Pipe()
        self._process = context.Process(
            target=serve, args=(theirs, self._counters, self.folder, self.slow), daemon=True
        )
        self._process.start()
        theirs.close()
        return self._process

    def _stop(self) -> None:
        if self._process is not None:
            self._process.kill()
            self._process.join()
            self._connection.close()
            self._process = None


def _exit(code: int) -> str:
    return signal.Signals(-code).name if code < 0 else f"exit code {code}"
