"""A campaign: so many inputs to each reader, by children side by side; what failed is made as small
as it gets.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from queue import Empty, SimpleQueue
from threading import Event, Lock

from . import inputs
from .child import Job
from .readers import of_name
from .shrink import smallest
from .trial import SLOW, Failure
from .watch import STALLED, Child, Tally

CHUNK = 500
"""Inputs of a job."""
MOST = 20
"""Ends of the child after which a reader is not asked any more."""
# Attempts to make an input smaller: each of them that ends the child takes seconds.
_ATTEMPTS = {"hang": 25, "crash": 60}


@dataclass
class Found:
    """Failures of the same kind in the same place: the first of them, how many, and an input as
    small as it gets.

    again: whether the input fails when it is alone.
    """

    first: Failure
    count: int = 1
    data: bytes = b""
    again: bool = False


@dataclass
class Row:
    """One reader's part of a campaign; `ends` counts the children that it ended."""

    reader: str
    tally: Tally = field(default_factory=Tally)
    found: dict[tuple[str, str], Found] = field(default_factory=dict)
    seconds: float = 0.0
    ends: int = 0

    @property
    def failures(self) -> int:
        """How many inputs failed."""
        return sum(found.count for found in self.found.values())

    def add(self, tally: Tally, failures: Iterable[Failure], seconds: float = 0.0) -> None:
        """Add what came of a job; the failure of the smallest number stands for all of its kind,
        whoever came first.
        """
        self.tally, self.seconds = self.tally.with_(tally), self.seconds + seconds
        for failure in failures:
            self.ends += failure.what == "hang" or failure.what.startswith("crash")
            known = self.found.setdefault((failure.what, failure.where), Found(failure, 0))
            known.count += 1
            known.first = min(known.first, failure, key=lambda f: f.index)


def run(
    counts: dict[str, int],
    seed: int,
    workers: int = 2,
    *,
    stalled: float = STALLED,
    slow: float = SLOW,
    shrink: bool = True,
    progress: Callable[[Row, int], None] | None = None,
) -> list[Row]:
    """Inputs 0 ... count - 1 of each reader; the same seed gives the same inputs, whatever the
    workers.

    slow: seconds that an input may take. progress(row, count) is called after each job. Interrupted
    from the keyboard, it returns what there is.
    """
    rows = {name: Row(name) for name in counts}
    jobs: SimpleQueue[Job] = SimpleQueue()
    for name, count in counts.items():
        for start in range(0, count, CHUNK):
            jobs.put(Job(name, seed, start, min(start + CHUNK, count)))

    interrupted, one_at_a_time = Event(), Lock()

    def work() -> None:
        with Child(stalled, slow) as child:
            while not interrupted.is_set():
                try:
                    job = jobs.get_nowait()
                except Empty:
                    return
                row = rows[job.reader]
                if row.ends >= MOST:
                    continue
                failures: list[Failure] = []
                start = time.monotonic()
                tally = child.run(job, failures.append)
                with one_at_a_time:
                    row.add(tally, failures, time.monotonic() - start)
                if progress is not None:
                    progress(row, counts[job.reader])

    with ThreadPoolExecutor(workers) as pool:
        try:
            for done in [pool.submit(work) for _ in range(workers)]:
                done.result()
        except BaseException as fault:
            interrupted.set()  # the workers end with the jobs they are at
            if not isinstance(fault, KeyboardInterrupt):
                raise
    if shrink:
        with Child(stalled, slow) as child:
            for row in rows.values():
                for found in row.found.values():
                    _shrink(child, row.reader, seed, found)
    return list(rows.values())


def _shrink(child: Child, reader: str, seed: int, found: Found) -> None:
    """Try the input alone; where it fails again, leave out what is not needed for that."""
    found.data = inputs.make(of_name(reader), seed, found.first.index)

    def fails(data: bytes) -> bool:
        failures: list[Failure] = []
        child.run(Job(reader, seed, 0, 1, data), failures.append)
        return any(f.what == found.first.what and f.where == found.first.where for f in failures)

    found.again = fails(found.data)
    if found.again:
        found.data = smallest(
            found.data, fails, _ATTEMPTS.get(found.first.what.partition(" ")[0], 1000)
        )


def counts_of(names: Sequence[str], count: int) -> dict[str, int]:
    """How many inputs each reader has, where the URDF reader has `count`."""
    return {name: max(1, round(count * of_name(name).share)) for name in names}
