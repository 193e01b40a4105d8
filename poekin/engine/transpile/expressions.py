"""Expressions of a function: Python's syntax tree to C, with the types and what is known."""

from __future__ import annotations

import ast
import operator
from itertools import pairwise

from ..straight_line.trace import folded
from .c_types import BOOL, DOUBLE, INT, WORD, CRow, CScalar, CTable, CTuple, unify
from .values import (
    AND,
    EQUAL,
    LESS,
    OR,
    PRODUCT,
    SUM,
    UNARY,
    CValue,
    as_double,
    binary,
    is_number,
    scalar,
    word,
)
from .writer import Writer

_ARITHMETIC = {
    ast.Add: ("+", SUM, operator.add),
    ast.Sub: ("-", SUM, operator.sub),
    ast.Mult: ("*", PRODUCT, operator.mul),
    ast.Div: ("/", PRODUCT, operator.truediv),
    ast.Mod: ("%", PRODUCT, operator.mod),
    ast.FloorDiv: ("/", PRODUCT, operator.floordiv),
}
_OF_WORDS = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.BitXor: "^", ast.RShift: ">>"}
_COMPARISONS = {
    ast.Lt: ("<", LESS, operator.lt),
    ast.LtE: ("<=", LESS, operator.le),
    ast.Gt: (">", LESS, operator.gt),
    ast.GtE: (">=", LESS, operator.ge),
    ast.Eq: ("==", EQUAL, operator.eq),
    ast.NotEq: ("!=", EQUAL, operator.ne),
}


class ExpressionWriter(Writer):
    """Operators, names and conditions."""

    def test(self, node: ast.expr) -> CValue:
        """An expression as a condition."""
        return self.truth(node, self.expression(node))

    def truth(self, node: ast.AST, value: CValue) -> CValue:
        """Whether a number is not 0."""
        if value.type == BOOL:
            return value
        if not is_number(value.type):
            self.refuse(node, "a condition that is no number")
        if value.known:
            return scalar(bool(value.constant), BOOL, value.fixed)
        zero = scalar(0, value.type)
        return binary("!=", value, zero, BOOL, EQUAL)

    def _constant(self, node: ast.Constant) -> CValue:
        if not isinstance(node.value, (bool, int, float)):
            self.refuse(node, f"the constant {node.value!r}")
        return self.constant(node, node.value, "")

    def _name(self, node: ast.Name) -> CValue:
        name = node.id
        if name in self.known:
            return self.known[name]
        if name in self.types:
            self.read.add(name)
            root = self.roots.get(name, "")
            value = CValue(self.types[name], self.c_name(name), root=root)
            if name in self.told:
                return self.in_parts(value, self.told[name])
            return value
        if name in self.source.stores:
            self.refuse(node, f"the use of {name} before it has a value")
        return self.constant(node, self.python_value(node), name)

    def _attribute(self, node: ast.Attribute) -> CValue:
        if node.attr == "shape":
            match self.expression(node.value).type:
                case CRow(length):
                    return self._integers(length)
                case CTable(rows, columns):
                    return self._integers(rows, columns)
        return self.constant(node, self.python_value(node), node.attr)

    def _integers(self, *values: int) -> CValue:
        return self.make_tuple([scalar(value, INT) for value in values])

    def _tuple(self, node: ast.Tuple) -> CValue:
        items = self.listed(node.elts)
        if not items:
            self.refuse(node, "an empty tuple")
        return self.make_tuple(items)

    def listed(self, nodes: list[ast.expr]) -> list[CValue]:
        """Values of a list of expressions, those with a star unpacked."""
        found = []
        for node in nodes:
            if isinstance(node, ast.Starred):
                found += self.items(self.expression(node.value))
            else:
                found.append(self.expression(node))
        return found

    def _unaryop(self, node: ast.UnaryOp) -> CValue:
        if isinstance(node.op, ast.Not):
            value = self.test(node.operand)
            if value.known:
                return scalar(not value.constant, BOOL, value.fixed)
            return CValue(BOOL, f"!{value.within(UNARY + 1)}", UNARY)
        value = self.expression(node.operand)
        inverted = isinstance(node.op, ast.Invert)
        if inverted or not is_number(value.type):
            self.refuse(node, f"the operator {type(node.op).__name__} here")
        if isinstance(node.op, ast.UAdd):
            return value
        if value.known:
            return scalar(-value.constant, value.type, value.fixed)
        return CValue(value.type, f"-{value.within(UNARY + 1)}", UNARY)

    def _binop(self, node: ast.BinOp) -> CValue:
        mark = self.mark()
        a = self.expression(node.left)
        b = self.expression(node.right)
        value = self.arithmetic(node, node.op, a, b)
        if value.known:
            self.back_to(mark)
        return value

    def arithmetic(self, node: ast.AST, op: ast.operator, a: CValue, b: CValue) -> CValue:
        """a op b of numbers, or the sum of two tuples."""
        if isinstance(op, ast.Add) and _both(CTuple, a, b):
            return self.make_tuple(self.items(a) + self.items(b))
        if a.type == b.type == WORD and type(op) in _OF_WORDS:
            return word(_OF_WORDS[type(op)], a, b)
        entry = _ARITHMETIC.get(type(op))
        if entry is None or not _both(CScalar, a, b) or WORD in (a.type, b.type):
            self.refuse(node, f"the operator {type(op).__name__} here")
        sign, binds, function = entry
        fixed = a.fixed or b.fixed
        defined = b.constant != 0 or binds == SUM
        if a.known and b.known and defined:
            value = function(a.constant, b.constant)
            return self.constant(node, value, "", fixed)
        doubles = DOUBLE in (a.type, b.type)
        if doubles and fixed:
            found = self._folded(op, a, b)
            if found is not None:
                return found
        whole = not doubles and not isinstance(op, ast.Div)
        if isinstance(op, (ast.Mod, ast.FloorDiv)):
            if not whole:
                self.refuse(node, "% or // but of integers")
            if isinstance(op, ast.FloorDiv) or not b.known or b.constant <= 0:
                helper = self.helper(type(op).__name__)
                return CValue(INT, f"{helper}({a.text}, {b.text})")
            # Python's rest is never negative
            rest = binary("%", a, b, INT, PRODUCT)
            above = binary("+", rest, b, INT, SUM)
            return binary("%", above, b, INT, PRODUCT)
        if whole:
            return binary(sign, a, b, INT, binds)
        return binary(sign, as_double(a), as_double(b), DOUBLE, binds)

    def _folded(self, op: ast.operator, a: CValue, b: CValue) -> CValue | None:
        """a op b of finite numbers where one is 0, 1 or -1 but for rounding, as the arm tells."""
        x = folded(a.constant) if a.fixed else None
        y = folded(b.constant) if b.fixed else None
        product = isinstance(op, ast.Mult)
        total = isinstance(op, (ast.Add, ast.Sub))
        if product and 0.0 in (x, y):
            return scalar(0.0, DOUBLE, True)
        if product and x in (1.0, -1.0):
            return _signed(b, x == -1.0)
        if not total and y in (1.0, -1.0):
            return _signed(a, y == -1.0)
        if total and y == 0.0:
            return as_double(a)
        if total and x == 0.0:
            return _signed(b, isinstance(op, ast.Sub))
        return None

    def _compare(self, node: ast.Compare) -> CValue:
        operands = [self.expression(node.left)]
        for op, operand in zip(node.ops, node.comparators, strict=True):
            if isinstance(op, (ast.In, ast.NotIn)):
                return self._among(node, operands[0], operand)
            operands.append(self.expression(operand))
        operands[1:-1] = map(self.held, operands[1:-1])
        result = scalar(True, BOOL)
        for op, (a, b) in zip(node.ops, pairwise(operands), strict=True):
            found = self._compared(node, op, a, b)
            result = self._joined("&&", AND, result, found)
        return result

    def _compared(self, node: ast.AST, op: ast.cmpop, a: CValue, b: CValue) -> CValue:
        if isinstance(op, ast.Eq) and _both(CTuple, a, b):
            return self._same_tuple(node, a, b)
        entry = _COMPARISONS.get(type(op))
        if entry is None or not _both(CScalar, a, b):
            self.refuse(node, f"the comparison {type(op).__name__} here")
        sign, binds, function = entry
        if a.known and b.known:
            holds = function(a.constant, b.constant)
            return scalar(holds, BOOL, a.fixed or b.fixed)
        if DOUBLE in (a.type, b.type):
            a = as_double(a)
            b = as_double(b)
        return binary(sign, a, b, BOOL, binds)

    def _same_tuple(self, node: ast.AST, a: CValue, b: CValue) -> CValue:
        """Whether the items of two tuples are equal, and as many."""
        first = self.items(a)
        second = self.items(b)
        result = scalar(len(first) == len(second), BOOL)
        for one, other in zip(first, second, strict=False):
            found = self._compared(node, ast.Eq(), one, other)
            result = self._joined("&&", AND, result, found)
        return result

    def _among(self, node: ast.Compare, value: CValue, where: ast.expr) -> CValue:
        """value in (a, b, ...)."""
        negated = isinstance(node.ops[0], ast.NotIn)
        if len(node.ops) > 1 or negated or not isinstance(where, ast.Tuple):
            self.refuse(node, "`in` but of a tuple that is written there")
        value = self.held(value)
        result = scalar(False, BOOL)
        for item in self.listed(where.elts):
            found = self._compared(node, ast.Eq(), value, item)
            result = self._joined("||", OR, result, found)
        return result

    def _joined(self, sign: str, binds: int, a: CValue, b: CValue) -> CValue:
        """a && b or a || b of truth values."""
        ends = sign == "||"
        for one, other in ((a, b), (b, a)):
            if one.known:
                return one if bool(one.constant) == ends else other
        return binary(sign, a, b, BOOL, binds)

    def _boolop(self, node: ast.BoolOp) -> CValue:
        sign = "||"
        binds = OR
        if isinstance(node.op, ast.And):
            sign = "&&"
            binds = AND
        result = scalar(sign == "&&", BOOL)
        for operand in node.values:
            found = self.test(operand)
            result = self._joined(sign, binds, result, found)
            if result.known and bool(result.constant) == (sign == "||"):
                break
        return result

    def _ifexp(self, node: ast.IfExp) -> CValue:
        test = self.test(node.test)
        if test.known:
            chosen = node.body if test.constant else node.orelse
            return self.expression(chosen)
        a = self.expression(node.body)
        b = self.expression(node.orelse)
        kind = unify(a.type, b.type)
        if kind is None:
            self.refuse(node, "a value of two types")
        a = self.converted(node, a, kind)
        b = self.converted(node, b, kind)
        return CValue(kind, f"{test.within(OR)} ? {a.within(OR)} : {b.within(OR)}", 0)


def _both(kind: type, a: CValue, b: CValue) -> bool:
    """Whether two values are of one kind."""
    return isinstance(a.type, kind) and isinstance(b.type, kind)


def _signed(value: CValue, negative: bool) -> CValue:
    """A number or its negative, as a double."""
    value = as_double(value)
    if not negative:
        return value
    if value.known:
        return scalar(-value.constant, DOUBLE, value.fixed)
    return CValue(DOUBLE, f"-{value.within(UNARY + 1)}", UNARY)
