"""The lock of everything that compiles, which a fork waits for.

A forked process has one thread: a lock that another one held is never released in it, and what LLVM
was about to write stays half written. So `os.fork` waits until nobody compiles, and the locks of
Numba and LLVM are held over it as well: the child begins with all of them free, whoever else uses
Numba in this process.
What is left to the callers: an import that another thread has not finished, which Python itself
does not wait for.
"""

from __future__ import annotations

import logging  # noqa: F401  its lock is taken after these: of the handlers before a fork the last registered is first
import os
import sys
import threading
from typing import Any

COMPILING = threading.RLock()
"""Held while Numba is imported, and while machine code is made or loaded."""

FORK_TIMEOUT = 60.0
"""Seconds after which a fork waits no longer, should a thread that compiles wait for what the
forking one holds.
"""

_OTHERS = (
    ("numba.core.compiler_lock", "global_compiler_lock", "_lock"),
    ("llvmlite.binding.ffi", "lib", "_lock", "_lock"),
)
"""The locks of Numba and LLVM, by module and attributes, in the order in which Numba takes them."""
_held: list[Any] = []


def _before_fork() -> None:
    _hold(COMPILING)
    for module, *names in _OTHERS:
        lock: Any = sys.modules.get(module)
        for name in names:
            lock = getattr(lock, name, None)
        if lock is not None:
            _hold(lock)


def _hold(lock: Any) -> None:
    if lock.acquire(timeout=FORK_TIMEOUT):
        _held.append(lock)


def _after_fork() -> None:
    while _held:
        _held.pop().release()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(
        before=_before_fork,
        after_in_parent=_after_fork,
        after_in_child=_after_fork,
    )
