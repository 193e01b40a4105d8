"""Functions of scalars as functions of arrays, for NumPy and JAX.

Of a branch both ways are computed for all elements, and one of them is taken for each. What is refused has
no counterpart: loops, rows that are written, a name that is given another value in one way that returns, an
`if` of no array in a way of one of arrays, whose names would have no value where it does not hold.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Collection, Mapping

from ..function_source import FunctionSource
from .array_expression import SELECT, ArrayExpression

_CHOICE = f'''def {SELECT}(test, a, b):
    """a where test holds, b elsewhere; of tuples item by item."""
    if isinstance(a, tuple):
        return tuple(xp.where(test, x, y) for x, y in zip(a, b))
    return xp.where(test, a, b)
'''


class ArrayFunctions:
    """Functions of one text, each with those that it calls; `replaced` are written elsewhere, by name."""

    def __init__(self, replaced: Mapping[Callable, str]) -> None:
        self._names = dict(replaced)
        self._texts: dict[Callable, str] = {}

    def add(self, function: Callable, fixed: Collection[str] = ()) -> str:
        """Name of a function in the text. fixed: parameters that are no arrays, which an `if` may ask."""
        if function not in self._names:
            module = function.__module__.split(".")[-1].strip("_")
            self._names[function] = f"{module}_{function.__name__.strip('_')}"
            self._texts[function] = _Writer(function, self.add, set(fixed)).text(
                self._names[function]
            )
        return self._names[function]

    @property
    def text(self) -> str:
        """All functions, in any order, and the one that chooses."""
        return "\n\n".join([_CHOICE, *self._texts.values()])


class _Writer:
    """The text of one function."""

    def __init__(self, function: Callable, called: Callable, fixed: set[str]) -> None:
        self.source = FunctionSource(function)
        self.called = called
        self.fixed = fixed
        self.lines: list[str] = []
        self.taken = {*self.source.stores, "xp", SELECT}

    def text(self, name: str) -> str:
        parameters = self.source.parameters
        lines = [f"def {name}({', '.join(parameters)}):"]
        if self.source.summary:
            lines.append(f'    """{self.source.summary}"""')
        self._body(self.source.tree.body, {name: name for name in parameters}, 1)
        return "\n".join([*lines, *self.lines, ""])

    def _put(self, depth: int, text: str) -> None:
        self.lines.append("    " * depth + text)

    def _body(
        self, statements: list[ast.stmt], names: dict[str, str], depth: int, renamed: bool = False
    ) -> None:
        """Statements; `names` gets what they assign, under another name where `renamed`."""
        for k, node in enumerate(statements):
            match node:
                case ast.Expr(ast.Constant()):
                    continue
                case ast.Assign([target], value):
                    text = self._expression(value, names)
                    self._assign(target, text, names, depth, renamed)
                    if self._is_fixed(value):
                        self.fixed.add(ast.unparse(target))
                case ast.AugAssign(ast.Name(name) as target, op, value):
                    whole = ast.BinOp(ast.Name(name), op, value)
                    self._assign(target, self._expression(whole, names), names, depth, renamed)
                case ast.Return(ast.expr() as value):
                    self._put(depth, f"return {self._expression(value, names)}")
                    return
                case ast.If(test) if self._is_fixed(test):
                    if renamed:
                        self.source.refuse(node, "an `if` of no array inside one of arrays")
                    self._put(depth, f"if {ast.unparse(test)}:")
                    self._body(node.body, names, depth + 1, renamed)
                    if node.orelse:
                        self.source.refuse(node, "`else` where an `if` asks of no array")
                case ast.If() if _returns(node):
                    self._two_ways(node, statements[k + 1 :], names, depth)
                    return
                case ast.If():
                    self._merged(node, names, depth, renamed)
                case _:
                    self.source.refuse(node, f"a statement {type(node).__name__}")

    def _expression(self, node: ast.expr, names: Mapping[str, str]) -> str:
        return ArrayExpression(self.source, names, self.called).text(node)

    def _is_fixed(self, node: ast.expr) -> bool:
        """Whether all names of an expression are no arrays."""
        names = {name.id for name in ast.walk(node) if isinstance(name, ast.Name)}
        return bool(names) and names <= self.fixed

    def _assign(
        self, target: ast.expr, text: str, names: dict[str, str], depth: int, renamed: bool
    ) -> None:
        places = target.elts if isinstance(target, ast.Tuple) else [target]
        found = []
        for place in places:
            if not isinstance(place, ast.Name):
                self.source.refuse(target, f"writing to {ast.unparse(place)}")
            names[place.id] = self._fresh(place.id) if renamed else place.id
            found.append(names[place.id])
        self._put(depth, f"{', '.join(found)} = {text}")

    def _fresh(self, stem: str) -> str:
        count = 1
        while f"{stem}_{count}" in self.taken:
            count += 1
        self.taken.add(f"{stem}_{count}")
        return f"{stem}_{count}"

    def _merged(self, node: ast.If, names: dict[str, str], depth: int, renamed: bool) -> None:
        """Both ways under names of their own, then each name from one of them."""
        test = self._fresh("test")
        self._put(depth, f"{test} = {self._expression(node.test, names)}")
        ways = []
        for part in (node.body, node.orelse):
            ways.append(dict(names))
            self._body(part, ways[-1], depth, renamed=True)
        first, second = ways
        for name in {**first, **second}:
            if name not in first or name not in second:
                self.source.refuse(node, f"{name}, which one way alone gives a value,")
            if first[name] != second[name]:
                text = f"{SELECT}({test}, {first[name]}, {second[name]})"
                self._assign(ast.Name(name), text, names, depth, renamed)

    def _two_ways(
        self, node: ast.If, rest: list[ast.stmt], names: dict[str, str], depth: int
    ) -> None:
        """Ways that return, as functions without arguments, and the choice between their values."""
        ways = []
        test = self._expression(node.test, names)
        for part in (node.body, node.orelse):
            statements = [*part, *rest]
            again = {
                name.id
                for statement in statements
                for name in ast.walk(statement)
                if isinstance(name, ast.Name) and isinstance(name.ctx, ast.Store)
            }
            if not again.isdisjoint(names):
                self.source.refuse(node, "a way that returns and gives a name another value")
            ways.append(self._fresh("way"))
            self._put(depth, f"def {ways[-1]}():")
            self._body(statements, dict(names), depth + 1)
        self._put(depth, f"return {SELECT}({test}, {ways[0]}(), {ways[1]}())")


def _returns(node: ast.If) -> bool:
    """Whether a way returns."""
    return any(isinstance(inner, ast.Return) for inner in ast.walk(node))
