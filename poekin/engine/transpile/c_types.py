"""Types of the Python that is transpiled, and how C spells them.

A tuple is a structure by value, an array `v` where its items are of one type. A row or table of
doubles is a pointer to the first of them, row after row, of which the sizes are known.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class CScalar:
    """A number or a truth value; `code` is its letter in names of structures."""

    c: str
    code: str


DOUBLE = CScalar("double", "d")
INT = CScalar("int", "i")
BOOL = CScalar("int", "b")
WORD = CScalar("unsigned long long", "w")
"""np.uint64: 64 bits, of which sums and products keep the last ones."""


@dataclass(frozen=True)
class CTuple:
    """A tuple of fixed length."""

    items: tuple[CType, ...]

    @property
    def uniform(self) -> bool:
        """Whether all items are of one type."""
        return len(set(self.items)) == 1

    @property
    def code(self) -> str:
        """Name of the structure without its prefix."""
        if not self.uniform:
            return f"t{len(self.items)}_" + "_".join(item.code for item in self.items)
        first = self.items[0]
        between = "x" if isinstance(first, CTuple) else ""
        return f"{first.code}{between}{len(self.items)}"


@dataclass(frozen=True)
class CRow:
    """Consecutive doubles."""

    length: int
    code = "row"


@dataclass(frozen=True)
class CTable:
    """Rows of doubles, one after the other."""

    rows: int
    columns: int
    code = "table"


Pointer = CRow | CTable
CType = CScalar | CTuple | Pointer


def unify(a: CType, b: CType) -> CType | None:
    """Type that holds values of both, or None."""
    if a == b:
        return a
    if WORD in (a, b):
        return None
    if isinstance(a, CScalar) and isinstance(b, CScalar):
        return DOUBLE if DOUBLE in (a, b) else INT
    if isinstance(a, CTuple) and isinstance(b, CTuple) and len(a.items) == len(b.items):
        return _tuple_of([unify(x, y) for x, y in zip(a.items, b.items, strict=True)])
    return None


def type_of_constant(value: object) -> CType | None:
    """Type of a number, a truth value, or a tuple of them; None of anything else."""
    if isinstance(value, bool):
        return BOOL
    if isinstance(value, int):
        return INT
    if isinstance(value, float):
        return DOUBLE
    if type(value) is np.uint64:
        return WORD
    if isinstance(value, tuple) and value:
        return _tuple_of([type_of_constant(item) for item in value])
    return None


def _tuple_of(items: list[CType | None]) -> CTuple | None:
    """The tuple of items of these types; None where one has no type."""
    found = tuple(item for item in items if item is not None)
    return CTuple(found) if len(found) == len(items) else None


class Structures:
    """Names and definitions of the structures of one text, in the order in which they need each
    other.
    """

    def __init__(self, prefix: str) -> None:
        self.prefix = prefix
        self.definitions: dict[str, str] = {}

    def spell(self, kind: CType) -> str:
        """The type as C has it; a pointer without its star."""
        if isinstance(kind, CScalar):
            return kind.c
        if not isinstance(kind, CTuple):
            return "double"
        name = f"{self.prefix}_{kind.code}"
        if name not in self.definitions:
            if kind.uniform:
                members = f"{self.spell(kind.items[0])} v[{len(kind.items)}];"
            else:
                spelled = [self.spell(item) for item in kind.items]
                members = " ".join(f"{item} m{k};" for k, item in enumerate(spelled))
            self.definitions[name] = f"typedef struct {{ {members} }} {name};"
        return name

    def used_in(self, text: str) -> list[str]:
        """Definitions of the structures that a text names, and of those that these name."""
        found: list[str] = []
        for name, definition in reversed(self.definitions.items()):
            if f"{name} " in text or f"{name})" in text or any(f" {name} " in f for f in found):
                found.insert(0, definition)
        return found
