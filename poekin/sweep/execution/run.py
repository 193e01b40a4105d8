"""Running a sweep: by threads here, or by the processes and machines of an executor."""

from __future__ import annotations

import os
import pickle
import threading
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import Any, Protocol, TypedDict, Unpack

from ...checks import whole
from ...engine.jit.threads import processors
from ...errors import InputError, quote, suggest
from ...results import Progress
from ..maps.sweep_map import SweepMap, map_of
from ..pose_samples import NumberedPoses
from ..sweep import Sweep
from .ranges import Range, Ranges
from .store import Store
from .totals import Totals, timed_part

_CHUNK = 2**22  # samples a part at least: some tenths of a second
_OF_POSE = 64  # configurations that take as long as a pose, at least
_OF_CELL = 4  # samples a part for each cell of the map
_GIVEN = 8  # workers of an executor, where nobody says how many it has
_BYTES = {False: 8, True: 24}  # of a cell, without and with a measure
_SHARE = 0.8  # of the memory of the machine


class Executor(Protocol):
    """Executor of `concurrent.futures`, client of Dask, or what else has `submit`."""

    def submit(self, function: Any, /, *arguments: Any) -> Any:
        """A future of function(*arguments): its `result()` waits for it, `done()` does not, and
        `cancel()` gives it up.
        """


class RunOptions(TypedDict, total=False):
    """Options of `run`."""

    chunk: int | None
    workers: int | None
    executor: Executor | None
    store: str | os.PathLike[str] | None
    resume: bool
    progress: Progress | None


def run(
    sweep: Sweep,
    *,
    chunk: int | None = None,
    workers: int | None = None,
    executor: Executor | None = None,
    store: str | os.PathLike[str] | None = None,
    resume: bool = False,
    progress: Progress | None = None,
) -> SweepMap:
    """Runs a sweep; the result does not depend on any of the options, to the last bit.

    Parameters
    ----------
    sweep : Sweep
        The sweep.
    chunk : int, optional
        Number of samples that are run, and kept, at a time; by default four for each cell of the
        map, 4194304 at least, so that a part costs more than the map that it comes in; of poses one
        for sixteen cells, 65536 at least. An executor runs several in a task of some tenths of a
        second, unless there is a store.
    workers : int, optional
        Number of threads, by default one for each processor; of an executor its workers, which are
        given twice as many parts at a time, by default 16.
    executor : object, optional
        Runs the parts instead: an executor of `concurrent.futures`, a client of Dask, or another
        with `submit(function, *arguments)` and such futures.
    store : path, optional
        Directory that keeps each part as soon as it is done.
    resume : bool, default False
        Whether parts that the store holds are taken from there.
    progress : callable, optional
        Called as progress(samples done, samples of all).

    Returns
    -------
    found : SweepMap
        The map.

    Raises
    ------
    InputError
        If an option cannot be used, the store holds another sweep, or the map would not fit into
        the memory.
    FileError
        If the store cannot be read or written; parts that were done are kept.
    """
    totals = run_totals(
        sweep,
        chunk=chunk,
        workers=workers,
        executor=executor,
        store=store,
        resume=resume,
        progress=progress,
    )
    return map_of(sweep, totals)


def run_totals(sweep: Sweep, **options: Unpack[RunOptions]) -> Totals:
    """Totals of a sweep, its options those of `run`. Raises: InputError, FileError."""
    _check_names(options)
    chunk = options.get("chunk")
    workers = options.get("workers")
    executor = options.get("executor")
    store = options.get("store")
    if chunk is None:
        chunk = max(_CHUNK, _OF_CELL * sweep.cells.count)
        if isinstance(sweep.samples, NumberedPoses):
            chunk //= _OF_POSE
    whole(chunk, "chunk", 1)
    if workers is not None:
        whole(workers, "workers", 1)
    if executor is not None and not callable(getattr(executor, "submit", None)):
        raise InputError(f"executor: expected an object with submit, got {type(executor).__name__}")
    threads = workers or processors()
    _check_memory(sweep, threads + 1)
    kept = None if store is None else Store(store, sweep, chunk, options.get("resume", False))
    if executor is not None:
        threads = workers or _GIVEN
    ranges = Ranges(sweep.samples.count, chunk, 2 * threads)
    tell = _Teller(options.get("progress"), sweep.samples.count)
    if executor is not None:
        return _summed(sweep, ranges, executor, kept, tell)
    with ThreadPoolExecutor(threads, thread_name_prefix="poekin") as own:
        if kept is None:
            return _shared(sweep, iter(ranges), own, threads, tell)
        return _summed(sweep, ranges, own, kept, tell)


def _check_names(options: RunOptions) -> None:
    """Refuses options that there are not, and one that nothing can be taken from."""
    known = RunOptions.__annotations__
    for name in options:
        if name not in known:
            raise InputError(f"sweep: no option {quote(name)}; {suggest(name, known)}")
    if options.get("resume") and options.get("store") is None:
        raise InputError("resume: expected a store, which keeps what is done, got none")


class _Teller:
    """Says how many samples are done, from any thread."""

    def __init__(self, progress: Progress | None, count: int) -> None:
        self.progress = progress
        self.count = count
        self.done = 0
        self._telling = threading.Lock()

    def add(self, done: Range) -> None:
        with self._telling:
            self.done += done.last - done.first
            if self.progress is not None:
                self.progress(self.done, self.count)


def _shared(
    sweep: Sweep,
    ranges: Iterator[Range],
    pool: ThreadPoolExecutor,
    threads: int,
    tell: _Teller,
) -> Totals:
    """The sum of all parts, each thread's in one map of its own."""
    taking = threading.Lock()
    ended = threading.Event()

    def taken() -> Iterator[Range]:
        while not ended.is_set():
            with taking:
                one = next(ranges, None)
            if one is None:
                return
            yield one

    def work() -> Totals:
        totals = Totals(sweep)
        try:
            for one in taken():
                totals.run(one.first, one.last)
                tell.add(one)
        finally:  # nothing is left, or this one failed: the others need not go on
            ended.set()
        return totals

    futures = [pool.submit(work) for _ in range(threads)]
    try:
        first, *others = [future.result() for future in futures]
    finally:  # an interrupt ends the others too
        ended.set()
    for other in others:
        first.add(other.whole())
    return first


def _summed(
    sweep: Sweep,
    ranges: Ranges,
    executor: Any,
    store: Store | None,
    tell: _Teller,
) -> Totals:
    """The sum of all parts, with no more of them waited for at a time than `ranges.most`."""
    totals = Totals(sweep)
    pickled = pickle.dumps(sweep)
    waiting: list[tuple[Range, Any]] = []

    def take() -> None:
        # one that is done is kept at once, whatever was begun before it
        done = (k for k, (_, future) in enumerate(waiting) if future.done())
        one, future = waiting.pop(next(done, 0))
        part, seconds = future.result()
        if store is None:
            ranges.adapt(one, seconds)
        else:
            store.write(one.number, part)
        totals.add(part)
        tell.add(one)

    try:
        for one in ranges:
            part = None if store is None else store.read(one.number)
            if part is not None:
                totals.add(part)
                tell.add(one)
                continue
            waiting.append((one, executor.submit(timed_part, pickled, one.first, one.last)))
            if len(waiting) >= ranges.most:
                take()
        while waiting:
            take()
    finally:  # an interrupt, or an error of one part, ends the others too
        for _, future in waiting:
            future.cancel()
    return totals


def _check_memory(sweep: Sweep, maps: int) -> None:
    """Refuses a map that does not fit into the memory. Raises: InputError."""
    needed = sweep.cells.count * _BYTES[sweep.is_measured] * maps
    there = _memory()
    if there is not None and needed > _SHARE * there:
        raise InputError(
            f"sweep: {sweep.cells.count:.3g} cells take {needed / 2**30:.3g} GiB in {maps} maps, of "
            f"{there / 2**30:.3g} GiB here; a coarser resolution, fewer directions or fewer workers take less"
        )


def _memory() -> int | None:
    """Bytes of this machine's memory, where they can be known."""
    try:
        return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, ValueError, OSError):
        return None
