"""A scalar that counts: run a formula on it and read what the formula costs.

A multiplication, addition, subtraction or division counts where at least one operand is a
`Counted`: what combines two constants is done once, beforehand. Negation and comparison are free,
and so are the integers 0, 1 and -1: they are a formula's structure (a revolute joint's r = 1, s =
0), while the float 1.0 is a number like any other.
"""

from __future__ import annotations

import math
import operator
from dataclasses import dataclass
from types import SimpleNamespace
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


def _value(x) -> float:
    if isinstance(x, Counted):
        return x.value
    return x


def _is_zero(x) -> bool:
    return type(x) is int and x == 0


def _comparison(compare):
    """A method of `Counted` that compares the values, which is free."""
    return lambda self, other: compare(self.value, _value(other))


class Counted:
    """A float that adds what is done with it to a `Count`."""

    __slots__ = ("count", "value")

    def __init__(self, value: float, count: Count):
        self.value = float(value)
        self.count = count

    def made(self, value: float, operation: str) -> Counted:
        """The result of one operation, which is counted."""
        setattr(self.count, operation, getattr(self.count, operation) + 1)
        return Counted(value, self.count)

    def __mul__(self, other):
        if type(other) is int and other in (0, 1, -1):
            return (other, self, -self)[other]
        return self.made(self.value * _value(other), "multiplications")

    def __add__(self, other):
        if _is_zero(other):
            return self
        return self.made(self.value + _value(other), "additions")

    def __sub__(self, other):
        if _is_zero(other):
            return self
        return self.made(self.value - _value(other), "additions")

    def __rsub__(self, other):
        if _is_zero(other):
            return -self
        return self.made(_value(other) - self.value, "additions")

    def __truediv__(self, other):
        return self.made(self.value / _value(other), "divisions")

    def __rtruediv__(self, other):
        return self.made(_value(other) / self.value, "divisions")

    def __mod__(self, other):
        return self.made(self.value % _value(other), "divisions")

    __rmul__ = __mul__
    __radd__ = __add__

    def __neg__(self):
        return Counted(-self.value, self.count)

    def __abs__(self):
        return Counted(abs(self.value), self.count)

    __eq__ = _comparison(operator.eq)
    __lt__ = _comparison(operator.lt)
    __le__ = _comparison(operator.le)
    __gt__ = _comparison(operator.gt)
    __ge__ = _comparison(operator.ge)
    __hash__ = None  # type: ignore[assignment]

    def __float__(self) -> float:
        return self.value

    def __repr__(self) -> str:
        return f"Counted({self.value!r})"


def _counting(function, operation: str):
    """A function of `formulas.elementary` on counting scalars."""

    def run(x: Counted, *others) -> Counted:
        return x.made(function(x.value, *map(_value, others)), operation)

    return run


FUNCTIONS = SimpleNamespace(
    sqrt=_counting(math.sqrt, "square_roots"),
    sin=_counting(math.sin, "sines"),
    cos=_counting(math.cos, "cosines"),
    asin=_counting(math.asin, "arctangents"),  # asin x = atan2(x, sqrt(1 - x^2))
    atan2=_counting(math.atan2, "arctangents"),
)
elementary.provide(Counted, FUNCTIONS)


def counted(values: Any, count: Count) -> Any:
    """Nested tuples and lists of numbers as counting scalars of one count."""
    if isinstance(values, (tuple, list)):
        return type(values)(counted(v, count) for v in values)
    return Counted(values, count)
