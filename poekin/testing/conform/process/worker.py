"""The process that a subject runs in: it makes the subject, describes it, and answers calls until
there are no more.

What the subject prints, from Python or C, goes to stderr. Nothing of it can end the run that asks
(`child`).
"""

from __future__ import annotations

import contextlib
import faulthandler
import io
import os
import pickle
import struct
import sys
from collections.abc import Callable
from typing import IO, Any, NamedTuple

from ....errors import PoekinError
from ..subjects.subject import Subject
from .calls import made, real, untouched
from .limits import Limits, restrict

HEAD = struct.Struct("<Q")


class Reply(NamedTuple):
    """Reply to a request: a value, or the fault; interrupted, where KeyboardInterrupt was raised."""

    value: Any = None
    fault: str = ""
    interrupted: bool = False


def send(stream: IO[bytes], message: Any) -> None:
    """Write one message, whole."""
    data = pickle.dumps(message)
    stream.write(HEAD.pack(len(data)) + data)
    stream.flush()


def receive(stream: IO[bytes]) -> Any:
    """Read one message. Raises: EOFError where the other side is gone."""
    head = stream.read(HEAD.size)
    if len(head) < HEAD.size:
        raise EOFError
    (size,) = HEAD.unpack(head)
    data = stream.read(size)
    if len(data) < size:
        raise EOFError
    return pickle.loads(data)


def main() -> None:
    """A fresh process, whose stdin and stdout are the streams; the first message is the subject's
    name, and limits.
    """
    requests = os.fdopen(os.dup(0), "rb")
    replies = os.fdopen(os.dup(1), "wb")
    with open(os.devnull, "rb") as nothing:
        os.dup2(nothing.fileno(), 0)
    thing, limits = receive(requests)
    run(thing, limits, requests, replies)


def run(
    thing: Any,
    limits: Limits,
    requests: IO[bytes],
    replies: IO[bytes],
) -> None:
    """Answer requests to a subject, and end the process."""
    code = 1
    try:
        _quiet()
        restrict(limits.memory)
        serve(thing, requests, replies)
        code = 0
    finally:
        # Nothing of the process that this one is a copy of may run here, such as what is registered
        # with atexit.
        os._exit(code)


def _quiet() -> None:
    """stdout becomes stderr, for C as well; a crash is said by who asks."""
    faulthandler.disable()
    with contextlib.suppress(OSError):  # stderr may be closed
        os.dup2(2, 1)
        sys.stdout = sys.stderr = io.TextIOWrapper(
            io.FileIO(2, "w", closefd=False),
            encoding="utf-8",
            errors="backslashreplace",
            write_through=True,
        )


def serve(
    thing: Any,
    requests: IO[bytes],
    replies: IO[bytes],
) -> None:
    """Say what the subject is, or why there is none; then answer."""
    try:
        subject = Subject(thing)
    except PoekinError as error:
        send(replies, error)
        return
    send(replies, subject)
    answers = Answers(subject)
    with contextlib.suppress(EOFError):
        while True:
            name, *arguments = receive(requests)
            send(replies, reply(getattr(answers, name), *arguments))


def reply(function: Callable[..., Any], *arguments: Any) -> Reply:
    """Reply that holds the value or the fault of a call."""
    try:
        return Reply(*made(lambda: function(*arguments)))
    except KeyboardInterrupt:
        return Reply(interrupted=True)


class Answers:
    """One method for each kind of request; what was read last is kept, and asked."""

    def __init__(self, subject: Subject) -> None:
        self._own = subject.own
        self._read: Any = None

    def function(
        self,
        name: str,
        *arguments: Any,
    ) -> Any:
        """The array that a function of the subject returns."""
        return real(untouched(getattr(self._own, name))(*arguments))

    def read(
        self,
        name: str,
        *texts: str,
    ) -> list[str]:
        """Read a URDF; returns what the object that is read has."""
        self._read = getattr(self._own, name)(*texts)
        return [
            member
            for member in ("fk", "jacobian", "poses")
            if getattr(self._read, member, None) is not None
        ]

    def names(self) -> list[str]:
        """The names of the coordinates of what was read."""
        return [str(name) for name in self._read.names]

    def member(
        self,
        name: str,
        q: Any,
    ) -> Any:
        """The array that a function of what was read returns."""
        return real(untouched(getattr(self._read, name))(q))

    def poses(self, q: Any) -> dict[str, Reply]:
        """The pose of each link, or what is wrong with it."""
        poses = dict(untouched(self._read.poses)(q))
        return {str(link): reply(real, T) for link, T in poses.items()}
