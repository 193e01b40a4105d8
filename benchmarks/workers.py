"""Work that is no measurement of time, shared out among processes: one a core, and all of them ended
before anything else is measured.
"""

from __future__ import annotations

import multiprocessing
import os
import signal
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from typing import Any
from unittest import mock

Share = Callable[..., Iterable[Any]]
"""`map`, or that of processes: share(function, *arguments) -> results, in the arguments' order."""
MOST = 8
THREADS = ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS", "VECLIB_MAXIMUM_THREADS")
"""Variables that say how many threads a library of linear algebra starts."""


@contextmanager
def workers() -> Iterator[Share]:
    """`map` by processes, which begins with everything at once.

    Their linear algebra has one thread: more would wait for each other on cores that are taken.
    """
    context = multiprocessing.get_context("spawn")
    alone = mock.patch.dict(os.environ, dict.fromkeys(THREADS, "1"))
    with alone, ProcessPoolExecutor(most_workers(), context, initializer=_end_at_once) as pool:
        try:
            yield pool.map
        except BaseException:  # Ctrl-C, too: what has not begun is not waited for
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def most_workers() -> int:
    """How many tasks run at once."""
    return min(processors(), MOST)


def processors() -> int:
    """How many this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def _end_at_once() -> None:
    """Ctrl-C reaches every process of a terminal: the first one answers it, these end in silence."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
