"""State of a function that is written as C: its lines, its names, tuples, rows and their items."""

from __future__ import annotations

import ast
from dataclasses import replace
from types import ModuleType
from typing import Any, NamedTuple, NoReturn

import numpy as np

from .c_types import (
    BOOL,
    DOUBLE,
    INT,
    CRow,
    CScalar,
    CTable,
    CTuple,
    CType,
    Pointer,
    Structures,
    type_of_constant,
)
from .function_source import FunctionSource
from .values import (
    PRIMARY,
    SUM,
    UNARY,
    UNKNOWN,
    CValue,
    Instance,
    as_double,
    initial,
    member,
    scalar,
)

# names that math.h or C itself has
_WORDS = """
auto break case char const continue default do double else enum extern float for goto if inline
int long register restrict return short signed sizeof static struct switch typedef union unsigned
void volatile while acos asin atan atan2 cbrt ceil copysign cos cosh erf erfc exp exp2 expm1 fabs
fdim floor fma fmax fmin fmod frexp gamma hypot ilogb index j0 j1 jn ldexp lgamma log log10 log1p
log2 logb lrint lround main modf nan nearbyint nextafter pow remainder remquo rint round scalb
scalbn signbit signgam sin sinh sqrt tan tanh tgamma trunc y0 y1 yn isfinite isinf isnan isnormal
NAN HUGE_VAL INFINITY
"""
RESERVED = frozenset(_WORDS.split())


class Mark(NamedTuple):
    """State of a text: its number of lines, names that are read, functions that are called."""

    lines: int
    read: set[str]
    called: dict[Instance, None]
    temporaries: int


class Writer:
    """Expressions of one function for arguments of given types."""

    # of one run over the function, which makes them anew
    known: dict[str, CValue]
    told: dict[str, tuple[CValue | None, ...]]
    read: set[str]
    called: dict[Instance, None]
    results: list[CValue]
    lines: list[str]
    temporaries: int

    def __init__(self, source: FunctionSource, structures: Structures) -> None:
        self.source = source
        self.structures = structures
        self.types: dict[str, CType] = {}
        self.roots: dict[str, str] = {}
        self.indent = 1

    def global_constant(self, name: str, value: Any) -> CValue:
        """A constant of a module that is no number; see `translation_unit`."""
        raise NotImplementedError

    def helper(self, name: str) -> str:
        """C name of a function of two numbers that C has not; see `translation_unit`."""
        raise NotImplementedError

    def refuse(self, node: ast.AST, construct: str) -> NoReturn:
        """Raise InputError with file and line."""
        self.source.refuse(node, construct)

    def put(self, text: str) -> None:
        """A line of C."""
        self.lines.append("    " * self.indent + text)

    def mark(self) -> Mark:
        """State of the text, to which `back_to` brings it back."""
        read = set(self.read)
        called = dict(self.called)
        return Mark(len(self.lines), read, called, self.temporaries)

    def back_to(self, mark: Mark) -> None:
        """Forget what was written since a mark."""
        del self.lines[mark.lines :]
        self.read = mark.read
        self.called = mark.called
        self.temporaries = mark.temporaries

    def c_name(self, name: str) -> str:
        """A local name in C."""
        if not name.isascii() or name.startswith("_"):
            self.refuse(self.source.tree, f"the name {name!r}")
        return f"{name}_" if name in RESERVED else name

    def held(self, value: CValue) -> CValue:
        """The value with a name, so that its text may stand twice."""
        if value.simple or isinstance(value.type, Pointer):
            return value
        self.temporaries += 1
        name = f"t{self.temporaries}"
        while name in self.source.stores:
            name += "_"
        spelled = self.structures.spell(value.type)
        self.put(f"const {spelled} {name} = {initial(value.text, spelled)};")
        return CValue(value.type, name, PRIMARY, value.constant, value.fixed)

    def expression(self, node: ast.expr) -> CValue:
        """C of an expression."""
        method = getattr(self, f"_{type(node).__name__.lower()}", None)
        if method is None:
            self.refuse(node, f"an expression {type(node).__name__}")
        return method(node)

    def converted(self, node: ast.AST, value: CValue, kind: CType) -> CValue:
        """The value as a value of a type that holds it."""
        if value.type == kind:
            return value
        if kind == DOUBLE and isinstance(value.type, CScalar):
            return as_double(value)
        if kind == INT and value.type == BOOL:
            return replace(value, type=INT, root="", parts=())
        if isinstance(kind, CTuple) and isinstance(value.type, CTuple):
            pairs = zip(self.items(value), kind.items, strict=True)
            items = [self.converted(node, item, k) for item, k in pairs]
            return self.make_tuple(items)
        self.refuse(node, "a value of two types")

    def items(self, value: CValue) -> list[CValue]:
        """Items of a tuple, or numbers of a row."""
        kind = value.type
        if value.parts:
            return list(value.parts)
        if isinstance(kind, CTuple):
            value = self.held(value)
            numbers = range(len(kind.items))
            return [self.member(value, k) for k in numbers]
        if isinstance(kind, CRow):
            row = value.within(PRIMARY)
            return [CValue(DOUBLE, f"{row}[{k}]") for k in range(kind.length)]
        raise TypeError(f"expected a tuple, got {kind}")

    def member(self, value: CValue, k: int) -> CValue:
        """Item k of a tuple; what the arm tells of it is written out."""
        if value.parts and value.parts[k].known:
            return value.parts[k]
        found = member(value, k)
        if found.known and found.fixed:
            return self.constant(self.source.tree, found.constant, "", True)
        return found

    def in_parts(self, value: CValue, told: tuple[CValue | None, ...]) -> CValue:
        """A tuple by its name, of which some items are known."""
        parts = list(told)
        for k, item in enumerate(told):
            if item is None:
                parts[k] = member(value, k)
        return replace(value, parts=tuple(parts))

    def make_tuple(self, items: list[CValue]) -> CValue:
        """A tuple of values."""
        kind = CTuple(tuple(item.type for item in items))
        texts = [initial(item.text, self.structures.spell(item.type)) for item in items]
        inner = ", ".join(texts)
        braces = f"{{{{{inner}}}}}" if kind.uniform else f"{{{inner}}}"
        constant = UNKNOWN
        fixed = False
        if all(item.known for item in items):
            constant = tuple(item.constant for item in items)
            fixed = any(item.fixed for item in items)
        text = f"({self.structures.spell(kind)}){braces}"
        parts = tuple(items)
        return CValue(kind, text, UNARY, constant, fixed, parts=parts)

    def constant(self, node: ast.AST, value: Any, name: str, fixed: bool = False) -> CValue:
        """A value that Python knows."""
        plain = value
        if isinstance(value, np.generic) and value.dtype != np.uint64:
            plain = value.item()
        kind = type_of_constant(plain)
        if kind is None:
            self.refuse(node, f"the value {name} of type {type(value).__name__}")
        if isinstance(kind, CScalar):
            return scalar(plain, kind, fixed)
        if name and not fixed:
            return self.global_constant(name, plain)
        items = [self.constant(node, item, "", fixed) for item in plain]
        return self.make_tuple(items)

    def python_value(self, node: ast.expr) -> Any:
        """Value of a module's name, or of a name of a module that it imports."""
        if isinstance(node, ast.Attribute):
            owner = self.python_value(node.value)
            if isinstance(owner, ModuleType) and hasattr(owner, node.attr):
                return getattr(owner, node.attr)
            self.refuse(node, f"the attribute {node.attr}")
        names = self.source.names
        if isinstance(node, ast.Name) and node.id in names:
            return names[node.id]
        self.refuse(node, f"the name {ast.unparse(node)}")

    def _subscript(self, node: ast.Subscript) -> CValue:
        value = self.expression(node.value)
        if isinstance(node.slice, ast.Slice):
            return self._slice(node, value, node.slice)
        if isinstance(node.slice, ast.Tuple):
            for index in node.slice.elts:
                value = self.item(node, value, self.expression(index))
            return value
        return self.item(node, value, self.expression(node.slice))

    def item(self, node: ast.AST, value: CValue, index: CValue) -> CValue:
        """value[index]."""
        kind = value.type
        if index.type == DOUBLE or isinstance(kind, CScalar):
            self.refuse(node, f"an index of {value.text} here")
        if index.known:
            length = rows_of(kind)
            if not -length <= index.constant < length:
                self.refuse(node, f"the index {index.constant} of {length}")
            index = scalar(index.constant % length, INT, index.fixed)
        constant = UNKNOWN
        if value.known and index.known:
            constant = value.constant[index.constant]
        if isinstance(kind, CTuple):
            if index.known:
                return self.member(value, index.constant)
            if not kind.uniform:
                self.refuse(node, "an index that is not known of a tuple of several types")
            return CValue(kind.items[0], f"{self.held(value).text}.v[{index.text}]")
        if isinstance(kind, CTable):
            text = shifted(value, index, kind.columns)
            binds = PRIMARY if text == value.text else SUM
            row = CRow(kind.columns)
            return CValue(row, text, binds, constant, value.fixed, value.root)
        return self._number_of_row(value, index, constant)

    def _number_of_row(self, value: CValue, index: CValue, constant: Any) -> CValue:
        """A number of a row, at one index of the pointer that the row is counted from."""
        if constant is not UNKNOWN:
            return scalar(float(constant), DOUBLE, value.fixed)
        base, _, offset = value.text.partition(" + ")
        text = f"{offset} + {index.text}"
        if not offset:
            text = index.text
        elif index.known and index.constant == 0:
            text = offset
        elif index.known and offset.isdigit():
            text = str(int(offset) + index.constant)
        return CValue(DOUBLE, f"{base}[{text}]", root=value.root)

    def _slice(self, node: ast.Subscript, value: CValue, part: ast.slice | ast.Slice) -> CValue:
        bounds: list[Any] = [None, None]
        for k, bound in enumerate((part.lower, part.upper)):  # type: ignore[union-attr]
            if bound is not None:
                found = self.expression(bound)
                if not found.known or found.type == DOUBLE:
                    self.refuse(node, "a slice whose bounds are not known")
                bounds[k] = found.constant
        if part.step is not None:  # type: ignore[union-attr]
            self.refuse(node, "a slice with a step")
        kind = value.type
        chosen = slice(*bounds)
        if isinstance(kind, CTuple):
            items = self.items(value)[chosen]
            if items:
                return self.make_tuple(items)
        if isinstance(kind, Pointer):
            rows = range(rows_of(kind))[chosen]
            start = scalar(rows.start, INT)
            wide = 1
            shape: CType = CRow(len(rows))
            if isinstance(kind, CTable):
                wide = kind.columns
                shape = CTable(len(rows), wide)
            text = shifted(value, start, wide)
            binds = PRIMARY if text == value.text else SUM
            return CValue(shape, text, binds, root=value.root)
        self.refuse(node, "a slice here")


def rows_of(kind: CTuple | CRow | CTable) -> int:
    """Length of the first axis."""
    if isinstance(kind, CTuple):
        return len(kind.items)
    if isinstance(kind, CRow):
        return kind.length
    return kind.rows


def shifted(value: CValue, index: CValue, wide: int) -> str:
    """Pointer to row `index` of rows of `wide` numbers."""
    if index.known:
        base, _, offset = value.text.partition(" + ")
        ahead = index.constant * wide
        if index.constant == 0:
            return value.text
        if not offset:
            return f"{base} + {ahead}"
        if offset.isdigit():
            return f"{base} + {int(offset) + ahead}"
        return f"{value.text} + {ahead}"
    if wide == 1:
        return f"{value.text} + {index.within(SUM)}"
    return f"{value.text} + {wide} * {index.within(UNARY)}"
