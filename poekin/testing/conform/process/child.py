"""The process that a subject runs in, as who asks sees it: calls with a limit, and a new process
where one ended.

A subject named "MODULE:CLASS" is imported by a fresh interpreter, and never by this one. A class or
object that is there already is run in a fork, where the system has one and nothing runs that a fork
would lose; else in this process.
"""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import threading
import time
import warnings
from collections.abc import Iterator, Mapping
from typing import IO, Any

import numpy as np
from numba.np.ufunc import threading_layer

from ....errors import InputError, PoekinError
from ..subjects.named import parted
from ..subjects.subject import Subject
from . import worker
from .calls import ENDED, LOST, UNANSWERED, Fault
from .limits import Limits

POOLS = ("jax", "tensorflow", "torch")
"""Libraries with threads that a fork does not have."""
ENDING = 5.0
"""Seconds that a process may take to end when asked to, or when it has closed its streams."""


def obstacle(thing: Any) -> str:
    """Why a subject has to run in this process; "" where it need not."""
    if isinstance(thing, str):
        return ""
    if not hasattr(os, "fork") or sys.platform == "darwin":
        return "this system forks no process that is sure to work"
    pools = [name for name in POOLS if name in sys.modules]
    if _numba_has_threads():
        pools.append("numba")
    if not pools:
        return ""
    return f"the threads of {' and '.join(pools)}, loaded here, do not survive a fork"


def _numba_has_threads() -> bool:
    """Whether Numba has started the threads of its parallel loops, of which some end a forked
    process.
    """
    try:
        return bool(threading_layer())
    except ValueError:
        return False


@contextlib.contextmanager
def isolated(thing: Any, limits: Limits) -> Iterator[Subject]:
    """The subject in a process of its own, which ends with the context.

    Raises: InputError, in that process, as `Subject`; and where it ends or does not answer.
    """
    if isinstance(thing, str):
        parted(thing)
    child = Child(thing, limits)
    try:
        yield child.subject
    finally:
        child.close()


class Child:
    """A process with a subject, which is made anew for the next call where it ended."""

    def __init__(
        self,
        thing: Any,
        limits: Limits,
    ) -> None:
        self._thing = thing
        self._limits = limits
        self._process: _Forked | _Fresh | None = None
        self._lost = ""
        self._answered = False
        self.seconds = limits.seconds
        self.subject = self._started()
        self.subject.own = Remote(self)

    def ask(self, *request: Any) -> Any:
        """The value of a reply. Raises: Fault for what it says, and where the process ends or is
        late.
        """
        if self._process is None and not self._lost:
            try:
                self._started()
            except PoekinError as error:
                self._lost = f"{LOST}: {error}"
        if self._lost:
            raise Fault(self._lost)
        try:
            reply = self._received(self.seconds, request)
        except Fault as fault:
            if self._answered or not str(fault).startswith(UNANSWERED):
                raise
            # The first call of all may have compiled for so long, and kept for the next process
            # what it did.
            self._answered = True
            return self.ask(*request)
        self._answered = True
        if reply.interrupted:
            raise KeyboardInterrupt
        if reply.fault:
            raise Fault(reply.fault)
        return reply.value

    def _started(self) -> Subject:
        first = None
        if isinstance(self._thing, str):
            self._process = _Fresh()
            first = self._thing, self._limits
        else:
            self._process = _Forked(self._thing, self._limits)
        try:
            found = self._received(self._limits.starting, first)
        except Fault as fault:
            raise InputError(
                f"{_title(self._thing)} cannot be imported and made: {fault}"
            ) from fault
        if isinstance(found, PoekinError):
            self.close()
            raise found
        return found

    def _received(
        self,
        seconds: float,
        message: Any,
    ) -> Any:
        """Send a message, if there is one, and receive the next."""
        process = self._process
        if process is None:
            raise Fault(ENDED)
        late = threading.Event()

        def expire() -> None:
            late.set()
            process.kill()

        timer = threading.Timer(seconds, expire)
        timer.daemon = True
        timer.start()
        try:
            if message is not None:
                worker.send(process.requests, message)
            return worker.receive(process.replies)
        except (EOFError, OSError) as error:
            code = self.close()
            said = f"{ENDED} ({_said(code)})"
            if late.is_set():
                said = f"{UNANSWERED} {seconds:g} s"
            raise Fault(said) from error
        finally:
            timer.cancel()
            if sys.exc_info()[0] is KeyboardInterrupt:
                self.close()

    def close(self) -> int:
        """End the process, if there is one. Returns: its exit code."""
        process = self._process
        self._process = None
        if process is None:
            return 0
        return process.close()


class Remote:
    """The functions of a subject in a child."""

    def __init__(self, child: Child) -> None:
        self._child = child

    def __getattr__(self, name: str) -> Any:
        if name in ("read_urdf", "read_robot"):
            return lambda *texts: RemoteRead(self._child, self._child.ask("read", name, *texts))
        return lambda *arguments: self._child.ask("function", name, *arguments)

    @contextlib.contextmanager
    def within(self, seconds: float) -> Iterator[None]:
        """Calls may take so long only, as long as the context lasts."""
        before = self._child.seconds
        self._child.seconds = min(seconds, self._child.seconds)
        try:
            yield
        finally:
            self._child.seconds = before


class RemoteRead:
    """Object that the subject read last, in a child: the names of its coordinates, and those
    functions that it has.
    """

    def __init__(
        self,
        child: Child,
        members: list[str],
    ) -> None:
        self._child = child
        self._members = members

    @property
    def names(self) -> list[str]:
        """Names of its coordinates."""
        return self._child.ask("names")

    def __getattr__(self, name: str) -> Any:
        if name == "jacobian" and name not in self._members:
            return None
        return lambda q: self._child.ask("member", name, q)

    def poses(self, q: np.ndarray) -> RemotePoses:
        """The pose of each link."""
        return RemotePoses(self._child.ask("poses", q))


class RemotePoses(Mapping[str, Any]):
    """Poses of links, each an array or what is wrong with it, which raises Fault."""

    def __init__(self, replies: dict[str, worker.Reply]) -> None:
        self._replies = replies

    def __len__(self) -> int:
        return len(self._replies)

    def __iter__(self) -> Iterator[str]:
        return iter(self._replies)

    def __getitem__(self, link: str) -> Any:
        reply = self._replies[link]
        if reply.fault:
            raise Fault(reply.fault)
        return reply.value


class _Forked:
    """A copy of this process."""

    def __init__(
        self,
        thing: Any,
        limits: Limits,
    ) -> None:
        sys.stdout.flush()
        sys.stderr.flush()
        there, requests = os.pipe()
        replies, here = os.pipe()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of threads, such as NumPy's, which are made anew
            self._pid = os.fork()
        if self._pid == 0:
            os.setsid()
            os.close(requests)
            os.close(replies)
            worker.run(thing, limits, os.fdopen(there, "rb"), os.fdopen(here, "wb"))
        os.close(there)
        os.close(here)
        self.requests = os.fdopen(requests, "wb")
        self.replies = os.fdopen(replies, "rb")

    def kill(self) -> None:
        _kill(self._pid)

    def close(self) -> int:
        _close(self.requests, self.replies)
        end = time.monotonic() + ENDING
        pid, status = os.waitpid(self._pid, os.WNOHANG)
        while pid == 0 and time.monotonic() < end:
            time.sleep(0.001)
            pid, status = os.waitpid(self._pid, os.WNOHANG)
        if pid == 0:
            self.kill()
            _, status = os.waitpid(self._pid, 0)
        return os.waitstatus_to_exitcode(status)


class _Fresh:
    """Another interpreter, with this one's path."""

    def __init__(self) -> None:
        path = [entry for entry in sys.path if isinstance(entry, str)]
        start = f"import sys; sys.path[:] = {path!r}; from {worker.__name__} import main; main()"
        self._process = subprocess.Popen(
            [sys.executable, "-c", start],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            start_new_session=True,  # which Windows passes over
        )
        self.requests: Any = self._process.stdin
        self.replies: Any = self._process.stdout

    def kill(self) -> None:
        if os.name == "posix":
            _kill(self._process.pid)
        else:
            self._process.kill()

    def close(self) -> int:
        _close(self.requests, self.replies)
        try:
            return self._process.wait(ENDING)
        except subprocess.TimeoutExpired:
            self.kill()
            return self._process.wait()


def _kill(pid: int) -> None:
    """A process with those that it started; itself alone where it had no time to be the first of a
    group.
    """
    for end in (os.killpg, os.kill):
        with contextlib.suppress(ProcessLookupError, PermissionError):
            end(pid, signal.SIGKILL)


def _close(*streams: IO[bytes]) -> None:
    for stream in streams:
        with contextlib.suppress(OSError):  # what could not be sent any more
            stream.close()


def _said(code: int) -> str:
    if code >= 0:
        return f"exit code {code}"
    try:
        return signal.Signals(-code).name
    except ValueError:
        return f"signal {-code}"


def _title(thing: Any) -> str:
    if isinstance(thing, str):
        return thing
    return getattr(thing, "__name__", type(thing).__name__)
