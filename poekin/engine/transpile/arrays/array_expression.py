"""Expressions of scalar Python as those of arrays of a module `xp`: numpy or jax.numpy."""

from __future__ import annotations

import ast
import inspect
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import reduce
from typing import Any

import numpy as np

from ..function_source import FunctionSource

SELECT = "select"
_OF_ARRAYS: dict[Any, str] = {
    math.floor: "xp.floor",
    math.sqrt: "xp.sqrt",
    abs: "xp.abs",
    min: "xp.minimum",
    max: "xp.maximum",
}
_CASTS: dict[Any, str] = {int: "int64", np.int64: "int64", np.uint64: "uint64"}
_JOINED = {ast.And: ast.BitAnd, ast.Or: ast.BitOr}


@dataclass(frozen=True, eq=False)
class ArrayExpression(ast.NodeTransformer):
    """Expressions of one function; `names` are its local names in the text, `called` says the name of a
    function that it calls.
    """

    source: FunctionSource
    names: Mapping[str, str]
    called: Callable[[Callable], str]

    def text(self, node: ast.expr) -> str:
        """An expression's text."""
        copied = ast.parse(ast.unparse(node), mode="eval").body
        return ast.unparse(self.visit(copied))

    def visit_Name(self, node: ast.Name) -> ast.expr:
        """A local name, or the number that a module's name has."""
        if node.id in self.names:
            return ast.Name(self.names[node.id])
        return self._constant(node)

    def visit_Attribute(self, node: ast.Attribute) -> ast.expr:
        """A number of another module."""
        return self._constant(node)

    def visit_Call(self, node: ast.Call) -> ast.expr:
        """A function of arrays of xp, a cast, or a function that is written too."""
        function = self._value(node.func)
        arguments = [self.visit(argument) for argument in node.args]
        if function in _CASTS:
            kind = ast.Name(f"xp.{_CASTS[function]}")
            return ast.Call(ast.Name("xp.asarray"), [*arguments, kind], [])
        if function in _OF_ARRAYS:
            return ast.Call(ast.Name(_OF_ARRAYS[function]), arguments, [])
        if not inspect.isfunction(function) or node.keywords:
            self.source.refuse(node, f"a call of {ast.unparse(node.func)}")
        return ast.Call(ast.Name(self.called(function)), arguments, [])

    def visit_Compare(self, node: ast.Compare) -> ast.expr:
        """a < b < c as (a < b) & (b < c)."""
        operands = [self.visit(x) for x in (node.left, *node.comparators)]
        parts: list[ast.expr] = [
            ast.Compare(a, [op], [b])
            for a, op, b in zip(operands[:-1], node.ops, operands[1:], strict=True)
        ]
        return reduce(lambda a, b: ast.BinOp(a, ast.BitAnd(), b), parts)

    def visit_BoolOp(self, node: ast.BoolOp) -> ast.expr:
        """`and`, `or` of each element."""
        operands = [self.visit(x) for x in node.values]
        return reduce(lambda a, b: ast.BinOp(a, _JOINED[type(node.op)](), b), operands)

    def visit_UnaryOp(self, node: ast.UnaryOp) -> ast.expr:
        """`not` of each element."""
        operand = self.visit(node.operand)
        if isinstance(node.op, ast.Not):
            return ast.Call(ast.Name("xp.logical_not"), [operand], [])
        return ast.UnaryOp(node.op, operand)

    def _value(self, node: ast.expr) -> Any:
        """The object that a name of a module stands for."""
        if isinstance(node, ast.Attribute):
            return getattr(self._value(node.value), node.attr)
        if isinstance(node, ast.Name) and node.id in self.source.names:
            return self.source.names[node.id]
        self.source.refuse(node, f"the name {ast.unparse(node)}")

    def _constant(self, node: ast.Name | ast.Attribute) -> ast.expr:
        value = self._value(node)
        if type(value) is np.uint64:
            return ast.Call(ast.Name("xp.uint64"), [ast.Constant(int(value))], [])
        if not isinstance(value, (int, float)):
            self.source.refuse(
                node, f"the value {ast.unparse(node)} of type {type(value).__name__}"
            )
        return ast.Constant(value)
