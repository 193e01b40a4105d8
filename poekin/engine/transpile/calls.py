"""Calls: functions of Python, of `elementary` and `math`, and functions that are written too."""

from __future__ import annotations

import ast
import inspect
import math
from collections.abc import Callable
from typing import Any

import numpy as np

from ...formulas import elementary
from .c_types import BOOL, DOUBLE, INT, WORD, CScalar, CTable, CTuple, CType
from .expressions import ExpressionWriter
from .function_source import FunctionSource
from .values import (
    FUNCTION,
    LESS,
    UNARY,
    Argument,
    CValue,
    InstanceSource,
    as_double,
    binary,
    is_number,
    scalar,
)
from .writer import rows_of

_MATHEMATICAL: dict[Any, str] = {
    elementary.sqrt: "sqrt",
    elementary.sin: "sin",
    elementary.cos: "cos",
    elementary.asin: "asin",
    elementary.atan2: "atan2",
    math.sqrt: "sqrt",
    math.sin: "sin",
    math.cos: "cos",
    math.asin: "asin",
    math.atan2: "atan2",
    math.copysign: "copysign",
    math.floor: "floor",  # a double here: of a large number too
    abs: "fabs",
}


class CallWriter(ExpressionWriter):
    """Calls of one function."""

    def __init__(self, source: FunctionSource, units: InstanceSource) -> None:
        super().__init__(source, units.structures)
        self.units = units
        self.written: set[str] = set()

    def _call(self, node: ast.Call) -> CValue:
        kind, text = self.call(node)
        if isinstance(text, CValue):
            return text
        if kind is None:
            self.refuse(node, "the value of a call that returns none")
        return CValue(kind, text)

    def call(self, node: ast.Call) -> tuple[CType | None, str | CValue]:
        """Type and text of a call, or its value."""
        function = self._function(node.func)
        values = self.listed(node.args)
        if function in _MATHEMATICAL or function in _OF_PYTHON:
            if node.keywords:
                self.refuse(node, "a call with a keyword here")
            if function in _MATHEMATICAL:
                return DOUBLE, self._mathematical(node, function, values)
            return None, _OF_PYTHON[function](self, node, values)
        if not inspect.isfunction(function):
            self.refuse(node, f"a call of {ast.unparse(node.func)}")
        values = self._bound(node, function, values)
        told = [value.fixed for value in values if value.type != FUNCTION]
        if any(told) and all(value.known for value in values):
            found = function(*(value.constant for value in values))
            return None, self.constant(node, found, "", True)
        return self._instance(node, function, values)

    def _function(self, node: ast.expr) -> Any:
        if isinstance(node, ast.Name) and node.id in self.known:
            return self.known[node.id].constant
        return self.python_value(node)

    def _mathematical(self, node: ast.Call, function: Any, values: list[CValue]) -> CValue:
        if not all(isinstance(value.type, CScalar) for value in values):
            self.refuse(node, f"{ast.unparse(node.func)} of anything but numbers")
        name = _MATHEMATICAL[function]
        if name == "fabs" and values[0].type != DOUBLE:
            self.refuse(node, "abs of an integer")
        texts = ", ".join(as_double(value).text for value in values)
        return CValue(DOUBLE, f"{name}({texts})")

    def _bound(self, node: ast.Call, function: Callable, values: list[CValue]) -> list[CValue]:
        """Arguments in the order of the parameters; defaults are constants."""
        named = {}
        for word in node.keywords:
            if word.arg is None:
                self.refuse(node, "an argument with two stars")
            named[word.arg] = self.expression(word.value)
        try:
            bound = inspect.signature(function).bind(*values, **named)
        except TypeError as error:
            self.refuse(node, f"a call of {function.__name__} with {error}; it")
        bound.apply_defaults()
        found = []
        for value in bound.arguments.values():
            given = isinstance(value, CValue)
            found.append(value if given else self.constant(node, value, ""))
        return found

    def _instance(
        self, node: ast.Call, function: Callable, values: list[CValue]
    ) -> tuple[CType | None, str | CValue]:
        """The call of a function that is written for these types."""
        arguments = list(map(_argument, values))
        instance = self.units.instance(function, arguments)
        if instance is None:
            self.refuse(node, f"a call of {function.__name__} by itself")
        if isinstance(instance.told, CValue) and not instance.written:
            return None, instance.told
        self.called[instance] = None
        texts = []
        for name, value in zip(instance.parameters, values, strict=True):
            if name in instance.written:
                if not value.root:
                    self.refuse(node, f"writing to the constant {value.text}")
                self.written.add(value.root)
            if name in instance.runtime:
                texts.append(value.text)
        text = f"{instance.name}({', '.join(texts)})"
        if instance.returns is None or not isinstance(instance.told, tuple):
            return instance.returns, text
        result = self.held(CValue(instance.returns, text))
        return None, self.in_parts(result, instance.told)

    def global_constant(self, name: str, value: Any) -> CValue:
        """A tuple of numbers of a module by its name in C."""
        tree = self.source.tree
        made = self.make_tuple([self.constant(tree, item, "") for item in value])
        return self.units.tuple_constant(self.source.function, name, made)

    def helper(self, name: str) -> str:
        """C name of a function of two numbers that C has not."""
        return self.units.helper(name)

    def maximum(self, node: ast.Call, values: list[CValue], name: str) -> CValue:
        """max or min as Python has them: a NaN that stands first stays, another is passed over."""
        numbers = all(is_number(value.type) for value in values)
        if len(values) < 2 or not numbers:
            self.refuse(node, f"{name} of anything but two numbers or more")
        result = values[0]
        for value in values[1:]:
            if result.type == INT and value.type == INT:
                a = self.held(result)
                b = self.held(value)
                sign = ">" if name == "max" else "<"
                test = binary(sign, b, a, BOOL, LESS)
                result = CValue(INT, f"({test.text} ? {b.text} : {a.text})", UNARY)
            else:
                helper = self.helper(name)
                a = as_double(result)
                b = as_double(value)
                result = CValue(DOUBLE, f"{helper}({a.text}, {b.text})")
        return result


def _argument(value: CValue) -> Argument:
    """A value as an argument: what the arm tells of flags, tables and tuples is written into the
    function, and so are known integers.
    """
    kind = value.type
    compound = isinstance(kind, (CTable, CTuple))
    told = value.fixed and (compound or _is_flag(kind))
    if told or (value.known and kind == INT):
        return Argument(kind, value)
    return Argument(kind)


def _is_flag(kind: CType) -> bool:
    """Whether a type has integers and truth values only."""
    if isinstance(kind, CTuple):
        return all(_is_flag(item) for item in kind.items)
    return kind in (INT, BOOL, FUNCTION)


def _length(writer: CallWriter, node: ast.Call, values: list[CValue]) -> CValue:
    kind = values[0].type
    if isinstance(kind, CTuple):
        return scalar(len(kind.items), INT)
    if isinstance(kind, CScalar):
        writer.refuse(node, "len of a number")
    return scalar(rows_of(kind), INT)


def _integer(writer: CallWriter, node: ast.Call, values: list[CValue]) -> CValue:
    value = values[0]
    if value.known:
        return scalar(int(value.constant), INT, value.fixed)
    if value.type == WORD:
        return CValue(INT, f"(long long){value.within(UNARY)}", UNARY)
    if value.type != DOUBLE:
        return writer.converted(node, value, INT)
    return CValue(INT, f"(int){value.within(UNARY)}", UNARY)


def _word(writer: CallWriter, node: ast.Call, values: list[CValue]) -> CValue:
    value = values[0]
    if value.type not in (INT, WORD):
        writer.refuse(node, "np.uint64 of anything but an integer")
    if value.known:
        return scalar(value.constant, WORD, value.fixed)
    return CValue(WORD, f"(unsigned long long){value.within(UNARY)}", UNARY)


_OfPython = Callable[[CallWriter, ast.Call, list[CValue]], CValue]
_OF_PYTHON: dict[Any, _OfPython] = {
    max: lambda writer, node, values: writer.maximum(node, values, "max"),
    min: lambda writer, node, values: writer.maximum(node, values, "min"),
    len: _length,
    int: _integer,
    np.int64: _integer,
    np.uint64: _word,
    float: lambda writer, node, values: writer.converted(node, values[0], DOUBLE),
    # as the engine compiles them for doubles
    elementary.below: lambda _, __, values: binary(
        "<", *map(as_double, values), kind=BOOL, binds=LESS
    ),
    elementary.takes_series: lambda *_: scalar(True, BOOL),
}
