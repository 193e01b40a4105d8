"""ProgressLine: how far long work is, on one line."""

from __future__ import annotations

import sys
import time

from .errors import InputError, escape_unprintable, safe_repr

PAUSE = 10.0
"""Seconds of silence between two lines where a line cannot be written again."""
CLEAR_LINE = "\r\x1b[K"
"""Code that clears the line of a terminal on which the cursor stands."""
_FIRST = 0.5  # seconds: shorter work shows nothing
_AGAIN = 0.1
_LONGEST = 100


class ProgressLine:
    """Line that says how far long work is: for the option `progress` of functions that have one.

    It is written to stderr: in a terminal and in a notebook again and again in one place, elsewhere
    now and then on a new line. Short work shows nothing. The rate, and the time that is left by it,
    are of the whole work since the first call.

    Parameters
    ----------
    what : str
        Name of the work.

    Raises
    ------
    InputError
        If it is no text.

    Examples
    --------
    >>> import poekin as pk
    >>> arm = pk.load("ur5e").chain()
    >>> with pk.ProgressLine("sweep") as progress:
    ...     found = pk.sweep.reach(arm, resolution=0.2, samples=10_000, progress=progress)
    """

    def __init__(self, what: str) -> None:
        if not isinstance(what, str):
            raise InputError(f"what: expected the name of the work, got {safe_repr(what)}")
        self.what = what
        # a cell of a notebook takes the carriage return, as a terminal does
        self.terminal = sys.stderr.isatty() or "ipykernel" in type(sys.stderr).__module__
        self.shown = False
        self.last = time.monotonic()
        self._begun: tuple[float, int] | None = None

    def __call__(self, done: int, total: int, text: str = "") -> None:
        """Say how far the work is, if it is time to say something.

        Parameters
        ----------
        done, total : int
            How much is done, and of how much; 0 where nobody knows.
        text : str, default ""
            What is being done.
        """
        now = time.monotonic()
        if self._begun is None:
            self._begun = (now, done)
        if now - self.last < self._pause():
            return
        self.last = now
        self.shown = True
        line = f"{self.what}: {done}"
        if total:
            line += f" of {total}{self._left(now, done, total)}"
        if text:
            line += f", {text}"
        line = escape_unprintable(line)
        if self.terminal:
            print(f"{CLEAR_LINE}{line[:_LONGEST]}", end="", file=sys.stderr, flush=True)
        else:
            print(line, file=sys.stderr)

    def _left(self, now: float, done: int, total: int) -> str:
        """Rate and time left, where something was done since the first call."""
        begin, before = self._begun or (now, done)
        if now <= begin or done <= before:
            return ""
        rate = (done - before) / (now - begin)
        return f", {rate:.2g} a second, {(total - done) / rate:.0f} s left"

    def _pause(self) -> float:
        if not self.terminal:
            return PAUSE
        return _AGAIN if self.shown else _FIRST

    def __enter__(self) -> ProgressLine:
        return self

    def __exit__(self, *_: object) -> None:
        if self.terminal and self.shown:
            print(CLEAR_LINE, end="", file=sys.stderr, flush=True)
