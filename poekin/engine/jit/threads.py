"""A pool of threads over kernels that release the interpreter's lock.

Not OpenMP, which ends a forked worker: a process that was forked has none of its parent's threads,
and makes its own.
"""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

ROWS_AT_ONCE = 8192
"""Rows that a thread takes at a time."""

_pools: dict[int, ThreadPoolExecutor] = {}
_making = threading.Lock()


def share_out(
    run: Callable[..., Any],
    *arrays: Any,
    rows: int = ROWS_AT_ONCE,
) -> None:
    """run(*parts) for parts of all arrays, `rows` along their first axis, by a thread for each
    processor.
    """
    starts = range(0, len(arrays[0]), rows)
    if len(starts) < 2:
        run(*arrays)
        return
    parts = ([a[start : start + rows] for a in arrays] for start in starts)
    tasks = [_pool().submit(run, *part) for part in parts]
    try:
        for task in tasks:
            task.result()
    finally:  # an interrupt, or an error of one of them, ends the others too
        for task in tasks:
            task.cancel()


def _pool() -> ThreadPoolExecutor:
    with _making:
        if os.getpid() not in _pools:
            _pools[os.getpid()] = ThreadPoolExecutor(processors(), thread_name_prefix="poekin")
        return _pools[os.getpid()]


def processors() -> int:
    """Number of processors that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_making._at_fork_reinit)  # type: ignore[attr-defined]
