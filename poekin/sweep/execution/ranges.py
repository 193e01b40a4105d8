"""Ranges of a sweep's samples: its chunks, or several of them at a time."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

_SECONDS = 0.4  # of a task: Dask takes some milliseconds for each
_APART = 0.01  # s from one task's end to the next one's: who asked takes a part of them
_ROUNDS = 2  # of tasks, at least, so that all workers end at about the same time


class Range(NamedTuple):
    """Samples first ... last - 1, the first of them that of chunk `number`."""

    number: int
    first: int
    last: int


@dataclass(eq=False)
class Ranges:
    """Ranges of `count` samples: single chunks, until it is known how long one takes.

    most: number of ranges that are run at a time, two for each worker.
    """

    count: int
    chunk: int
    most: int
    chunks: int = 1

    def __iter__(self) -> Iterator[Range]:
        first = 0
        while first < self.count:
            last = min(first + self.chunks * self.chunk, self.count)
            yield Range(first // self.chunk, first, last)
            first = last

    def adapt(self, done: Range, seconds: float) -> None:
        """Makes ranges to come as long as suits the seconds that a worker took for one."""
        wanted = _SECONDS + _APART * self.most / 2
        samples = (done.last - done.first) * wanted / seconds
        longest = self.count / (_ROUNDS * self.most)
        self.chunks = max(int(min(samples, longest)) // self.chunk, 1)
