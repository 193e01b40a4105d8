"""Random bytes read as numbers: evenly spread, and the smaller the bytes, the simpler the number.

    strategies.read(4, lambda r: r.magnitude(1e-6, 1.0))      a strategy of one's own

Raises: nothing for any bytes; bounds are trusted. Source: `strategies.read` says why bytes.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TypeVar

T = TypeVar("T")


class BytesReader:
    """Reads bytes in order; after the last one it reads zeros.

    Parameters: data, the bytes. Raises: nothing.
    """

    __slots__ = ("_rest",)

    def __init__(self, data: bytes):
        self._rest = iter(data)

    def byte(self) -> int:
        """0 to 255."""
        return next(self._rest, 0)

    def pick(self, options: Sequence[T]) -> T:
        """One of the options, each as often as any; the first one for a zero. Takes 1 byte. Raises:
        nothing.
        """
        return options[self.byte() * len(options) // 256]

    def fraction(
        self,
        low: float,
        high: float,
    ) -> float:
        """A number from low to high, evenly spread between neighbouring whole numbers, ends
        included. Takes 3 bytes.

        Zeros give the whole number next to 0. Parameters: low, high. Returns: the number. Raises:
        nothing.
        """
        wholes = range(math.floor(low), max(math.ceil(high), math.floor(low) + 1))
        k = self.pick(sorted(wholes, key=abs))
        first = max(float(k), low)
        last = min(k + 1.0, high)
        return first + (last - first) * ((256 * self.byte() + self.byte()) / 65535)

    def decimal(
        self,
        low: float,
        high: float,
    ) -> float:
        """A number from low to high with few digits: three decimals, or one, to which it shrinks.
        Takes 4 bytes.

        Parameters: low, high. Returns: the number, within the bounds. Raises: nothing.
        """
        decimals = 3
        if self.byte() < 128:
            decimals = 1
        return min(max(round(self.fraction(low, high), decimals), low), high)

    def magnitude(
        self,
        smallest: float,
        largest: float,
    ) -> float:
        """0 (one time in sixteen), or a number whose logarithm is spread evenly between two. Takes
        4 bytes.

        Parameters: smallest, largest, above 0. Returns: 0, or smallest to largest. Raises: nothing.
        """
        nought = self.byte() < 16
        exponent = self.fraction(math.log10(smallest), math.log10(largest))
        if nought:
            return 0.0
        return min(max(10.0**exponent, smallest), largest)
