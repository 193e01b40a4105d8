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
    """Reader of bytes in order; after the last one it reads zeros.

    Raises: nothing for any bytes; bounds are trusted.

    Parameters
    ----------
    data : bytes
        The bytes.
    """

    __slots__ = ("_rest",)

    def __init__(self, data: bytes) -> None:
        self._rest = iter(data)

    def byte(self) -> int:
        """Next byte.

        Returns
        -------
        byte : int
            0 to 255.
        """
        return next(self._rest, 0)

    def pick(self, options: Sequence[T]) -> T:
        """One of several options, each as often as any; takes 1 byte.

        Parameters
        ----------
        options : sequence
            The options.

        Returns
        -------
        option : object
            One of them, the first for a zero.
        """
        return options[self.byte() * len(options) // 256]

    def fraction(
        self,
        low: float,
        high: float,
    ) -> float:
        """Number from low to high, evenly spread between neighbouring whole numbers; takes 3 bytes.

        Parameters
        ----------
        low, high : float
            Bounds, included.

        Returns
        -------
        number : float
            The number; for zeros the whole number next to 0.
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
        """Number from low to high with three decimals, or one, to which it shrinks; takes 4 bytes.

        Parameters
        ----------
        low, high : float
            Bounds, included.

        Returns
        -------
        number : float
            The number.
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
        """Number that is 0, one time in sixteen, or log-uniform; takes 4 bytes.

        Parameters
        ----------
        smallest, largest : float
            Bounds, above 0.

        Returns
        -------
        number : float
            0, or smallest to largest.
        """
        nought = self.byte() < 16
        exponent = self.fraction(math.log10(smallest), math.log10(largest))
        if nought:
            return 0.0
        return min(max(10.0**exponent, smallest), largest)
