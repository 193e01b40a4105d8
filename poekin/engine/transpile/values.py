"""Expressions of C, with type, strength of the operator and, where it is known, value; and functions
of C, one for each function of Python and types of its arguments.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Protocol

from .c_types import DOUBLE, INT, WORD, CScalar, CTuple, CType, Structures

UNKNOWN: Any = object()
FUNCTION = CScalar("function", "f")

OR = 1
AND = 2
EQUAL = 3
LESS = 4
SUM = 5
PRODUCT = 6
UNARY = 7
PRIMARY = 8


@dataclass(frozen=True)
class CValue:
    """An expression.

    `binds` is the strength of its operator, `constant` its value where the text does not depend on
    what is computed, and `fixed` says that this is told by the arm, so that functions are written
    for it. `root` is the parameter that a pointer leads into, and `parts` are the
    items of a tuple that is written out.
    """

    type: CType
    text: str
    binds: int = PRIMARY
    constant: Any = UNKNOWN
    fixed: bool = False
    root: str = ""
    parts: tuple[CValue, ...] = ()

    @property
    def known(self) -> bool:
        """Whether the value is known."""
        return self.constant is not UNKNOWN

    @property
    def simple(self) -> bool:
        """Whether the text may stand twice: a name, a member or a number."""
        return self.binds == PRIMARY and "(" not in self.text

    @property
    def told(self) -> tuple[CValue | None, ...]:
        """Items of a tuple that the arm tells, None for the others."""
        return tuple(item if item.known and item.fixed else None for item in self.parts)

    def within(self, binds: int) -> str:
        """The text as an operand of an operator."""
        if self.binds < binds:
            return f"({self.text})"
        return self.text


def number(value: float) -> str:
    """A double as C writes it."""
    value = float(value)
    if math.isnan(value):
        return "(double)NAN"
    if math.isinf(value):
        return "HUGE_VAL" if value > 0.0 else "-HUGE_VAL"
    return repr(value)


def initial(text: str, structure: str) -> str:
    """Text of a structure in braces, where the type is told already."""
    return text.removeprefix(f"({structure})") if text.endswith("}") else text


def scalar(value: Any, kind: CType, fixed: bool = False) -> CValue:
    """A known number or truth value."""
    text = number(value) if kind == DOUBLE else str(int(value))
    if kind == WORD:
        text += "ULL"
    negative = text.startswith(("-", "("))
    return CValue(kind, text, UNARY if negative else PRIMARY, value, fixed)


def as_double(value: CValue) -> CValue:
    """A scalar as a double."""
    if value.type == DOUBLE:
        return value
    if value.known:
        return scalar(float(value.constant), DOUBLE, value.fixed)
    return CValue(DOUBLE, f"(double){value.within(UNARY)}", UNARY)


def binary(sign: str, a: CValue, b: CValue, kind: CType, binds: int) -> CValue:
    """a sign b, of which Python's order of operations is kept."""
    # compilers warn of && within || and of comparisons of comparisons without brackets
    apart = {OR: EQUAL, EQUAL: SUM, LESS: SUM}.get(binds, binds)
    left = a.within(apart)
    right = b.within(max(apart, binds + 1))
    return CValue(kind, f"{left} {sign} {right}", binds)


def member(value: CValue, k: int) -> CValue:
    """Item k of a tuple."""
    kind = value.type
    if not isinstance(kind, CTuple):
        raise TypeError(f"expected a tuple, got {kind}")
    k = range(len(kind.items))[k]
    field = f"v[{k}]" if kind.uniform else f"m{k}"
    constant = value.constant[k] if value.known else UNKNOWN
    item = kind.items[k]
    if value.known and isinstance(item, CScalar):
        return scalar(constant, item, value.fixed)
    return CValue(item, f"{value.within(PRIMARY)}.{field}", PRIMARY, constant, value.fixed)


def word(sign: str, a: CValue, b: CValue) -> CValue:
    """a sign b of words: none of C's strengths of ^ and >> is relied on."""
    return CValue(WORD, f"{a.within(UNARY)} {sign} {b.within(UNARY)}", 0)


def is_number(kind: CType) -> bool:
    """Whether arithmetic takes it."""
    return kind in (DOUBLE, INT)


@dataclass(frozen=True)
class Argument:
    """Type of an argument, and its value where the function is written for it."""

    type: CType
    told: CValue | None = None

    @property
    def key(self) -> object:
        """Key of the function that is written for it."""
        if self.told is None:
            return self.type
        return self.type, self.told.text


@dataclass(eq=False)
class Instance:
    """One function of C. `runtime` are the parameters that it has in C, `written` the pointers that
    it writes to, `told` what is known of its value or of that value's items, and `called` the
    functions that it calls.
    """

    name: str
    parameters: list[str]
    runtime: list[str]
    returns: CType | None = None
    head: str = ""
    text: str = ""
    written: set[str] = field(default_factory=set)
    told: tuple[CValue | None, ...] | CValue | None = None
    called: list[Instance] = field(default_factory=list)

    def tell(self, results: list[CValue]) -> None:
        """Note what is known of the value, of a function that returns in one place."""
        if len(results) != 1:
            return
        result = results[0]
        if result.known and result.fixed:
            self.told = result
        elif any(result.told):
            self.told = result.told


class InstanceSource(Protocol):
    """The text that a function is part of, as the function sees it."""

    structures: Structures

    def instance(self, function: Callable, arguments: list[Argument]) -> Instance | None:
        """The function for these arguments, None while it is being written."""
        ...

    def helper(self, name: str) -> str:
        """C name of max or min."""
        ...

    def tuple_constant(self, function: Callable, name: str, value: CValue) -> CValue:
        """A module's tuple of numbers by its name in C."""
        ...
