"""A scalar that counts: run a formula on it and read what the formula costs.

A multiplication, addition, subtraction or division counts where at least one operand is a
`Counted`: what combines two constants is done once, beforehand. Negation and comparison are free,
and so are the integers 0, 1 and -1: they are a formula's structure (a revolute joint's r = 1, s =
0), while the float 1.0 is a number like any other.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar

from ..formulas import elementary
from ..results import Result


@dataclass
class Count(Result):
    """Numbers of operations: those of Park's table and the others that a formula may use.

    Attributes
    ----------
    multiplications, additions, divisions, square_roots : int
        Numbers of these operations; subtractions are additions.
    sines, cosines, arctangents : int
        Numbers of calls of these functions.
    """

    derived: ClassVar = ("sine_cosine_pairs",)

    multiplications: int = 0
    additions: int = 0
    divisions: int = 0
    square_roots: int = 0
    sines: int = 0
    cosines: int = 0
    arctangents: int = 0

    @property
    def sine_cosine_pairs(self) -> int:
        """Number of angles whose sine and cosine are needed: one routine gives both."""
        return max(self.sines, self.cosines)

    def summary(self) -> str:
        """Operations that there are, by number and name.

        Returns
        -------
        text : str
            Line such as "174 multiplications, 123 additions".
        """
        charged = {name.replace("_", " "): n for name, n in vars(self).items() if n}
        return ", ".join(f"{n} {name}" for name, n in charged.items()) or "no operations"


class Counted:
    """A float that adds what is done with it to a `Count`."""

    __slots__ = ("count", "value")

    def __init__(self, value: float, count: Count):
        self.value = float(value)
        self.count = count

    def _new(self, value: float, operation: str) -> Counted:
        setattr(self.count, operation, getattr(self.count, operation) + 1)
        return Counted(value, self.count)

    def __mul__(self, other):
        if type(other) is int and other in (0, 1, -1):
            if other == 0:
                return other
            if other == 1:
                return self
            return -self
        return self._new(self.value * _value(other), "multiplications")

    def __add__(self, other):
        if _is_zero(other):
            return self
        return self._new(self.value + _value(other), "additions")

    def __sub__(self, other):
        if _is_zero(other):
            return self
        return self._new(self.value - _value(other), "additions")

    def __rsub__(self, other):
        if _is_zero(other):
            return -self
        return self._new(_value(other) - self.value, "additions")

    def __truediv__(self, other):
        return self._new(self.value / _value(other), "divisions")

    def __rtruediv__(self, other):
        return self._new(_value(other) / self.value, "divisions")

    def __mod__(self, other):
        return self._new(self.value % _value(other), "divisions")

    __rmul__ = __mul__
    __radd__ = __add__

    def __neg__(self):
        return Counted(-self.value, self.count)

    def __abs__(self):
        return Counted(abs(self.value), self.count)

    def __eq__(self, other):
        return self.value == _value(other)

    def __lt__(self, other):
        return self.value < _value(other)

    def __le__(self, other):
        return self.value <= _value(other)

    def __gt__(self, other):
        return self.value > _value(other)

    def __ge__(self, other):
        return self.value >= _value(other)

    __hash__ = None  # type: ignore[assignment]

    def __float__(self) -> float:
        return self.value

    def __repr__(self) -> str:
        return f"Counted({self.value!r})"


def _value(x) -> float:
    if isinstance(x, Counted):
        return x.value
    return x


def _is_zero(x) -> bool:
    return type(x) is int and x == 0


class _Functions:
    """Stand-ins for `formulas.elementary` on counting scalars."""

    @staticmethod
    def sqrt(x: Counted) -> Counted:
        return x._new(math.sqrt(x.value), "square_roots")

    @staticmethod
    def sin(x: Counted) -> Counted:
        return x._new(math.sin(x.value), "sines")

    @staticmethod
    def cos(x: Counted) -> Counted:
        return x._new(math.cos(x.value), "cosines")

    @staticmethod
    def asin(x: Counted) -> Counted:
        return x._new(math.asin(x.value), "arctangents")  # asin x = atan2(x, sqrt(1 - x^2))

    @staticmethod
    def atan2(y: Counted, x) -> Counted:
        return y._new(math.atan2(y.value, _value(x)), "arctangents")


elementary.provide(Counted, _Functions)


def counted(values: Any, count: Count) -> Any:
    """Nested tuples and lists of numbers as counting scalars of one count."""
    if isinstance(values, (tuple, list)):
        return type(values)(counted(v, count) for v in values)
    return Counted(values, count)
