"""Sequences of which nothing is made before it is asked for: parts of one array, and texts."""

from __future__ import annotations

import operator
from collections.abc import Callable, Sequence
from typing import Any, Generic, SupportsIndex, TypeVar, overload

import numpy as np

from ..groups.arrays import Array

Item = TypeVar("Item")


class LazySequence(Sequence, Generic[Item]):
    """Sequence whose items are made one by one, when they are asked for."""

    def __init__(self, length: int, make: Callable[[int], Item]) -> None:
        self._length = length
        self._make = make

    def __len__(self) -> int:
        return self._length

    @overload
    def __getitem__(self, index: SupportsIndex) -> Item: ...
    @overload
    def __getitem__(self, index: slice) -> list[Item]: ...
    def __getitem__(self, index: Any) -> Any:
        if isinstance(index, slice):
            chosen = range(*index.indices(self._length))
            return [self._make(k) for k in chosen]
        k = operator.index(index)
        if not -self._length <= k < self._length:
            raise IndexError(f"index {k} is out of bounds for {self._length} targets")
        return self._make(k % self._length)

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {self._length}>"


class Ragged(LazySequence[Array]):
    """Arrays of different lengths, one after the other in one array: item k is a view of its part.

    Attributes
    ----------
    rows : (S, ...) ndarray
        All arrays together.
    ends : (N + 1,) ndarray of int
        Item k is rows[ends[k] : ends[k + 1]].
    """

    def __init__(self, rows: np.ndarray, counts: np.ndarray) -> None:
        super().__init__(len(counts), self._part)
        self.rows = rows
        self.ends = np.zeros(len(counts) + 1, np.intp)
        np.cumsum(counts, out=self.ends[1:])

    @property
    def counts(self) -> np.ndarray:
        """Lengths (N,) of the items."""
        return np.diff(self.ends)

    @property
    def owner(self) -> np.ndarray:
        """Number of the item (S,) to which each row belongs."""
        return np.repeat(np.arange(len(self)), self.counts)

    def padded(self, fill: float) -> np.ndarray:
        """All items in one array (N, most, ...), filled up to as many rows of each."""
        counts = self.counts
        most = int(counts.max(initial=0))
        rows = self.rows
        shape = (len(self), most, *rows.shape[1:])
        whole = np.full(shape, fill, rows.dtype)
        there = np.arange(most) < counts[:, None]
        whole[there] = rows
        return whole

    def part(self, first: int, end: int) -> Ragged:
        """The items from number `first` to `end`, without it."""
        ends = self.ends[first : end + 1]
        rows = slice(ends[0], ends[-1])
        return Ragged(self.rows[rows], np.diff(ends))

    def chosen(self, numbers: np.ndarray) -> Ragged:
        """The items of these numbers, in order."""
        wanted = np.zeros(len(self), bool)
        wanted[numbers] = True
        rows = self.rows[wanted[self.owner]]
        return Ragged(rows, self.counts[numbers])

    def _part(self, k: int) -> Array:
        start, end = self.ends[k : k + 2]
        return self.rows[start:end]

    def __repr__(self) -> str:
        return f"<Ragged of {len(self)}: lengths {np.array2string(self.counts, threshold=8)}>"
