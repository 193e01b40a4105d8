"""The Python text of a function: its syntax tree, its places, and in which blocks names are used."""

from __future__ import annotations

import ast
import inspect
import textwrap
from collections.abc import Callable, Iterator
from typing import Any, NoReturn

from ...errors import InputError

Blocks = tuple[int, ...]


class FunctionSource:
    """A function with its syntax tree.

    `first` is the block where each local name is assigned first if all its uses are in there, None
    if others are; `stores` counts the places that assign a name.
    """

    def __init__(self, function: Callable) -> None:
        self.function = function
        self.file = inspect.getsourcefile(function) or "?"
        lines, self.line = inspect.getsourcelines(function)
        self.tree = self._definition(textwrap.dedent("".join(lines)))
        self.parameters = [arg.arg for arg in self.tree.args.args]
        self.names: dict[str, Any] = dict(inspect.getclosurevars(function).builtins)
        self.names |= function.__globals__
        self.stores: dict[str, int] = dict.fromkeys(self.parameters, 0)
        self.homes: dict[str, Blocks | None] = {}
        self._loops: dict[str, list[Blocks]] = {}
        self._loads: dict[str, list[Blocks]] = {}
        for name, blocks, stored in self._uses(self.tree.body, ()):
            self._note(name, blocks, stored)

    def _definition(self, text: str) -> ast.FunctionDef:
        found = ast.parse(text).body[0]
        if not isinstance(found, ast.FunctionDef):
            self.refuse(found, "anything but a function defined by def")
        args = found.args
        if args.vararg or args.kwarg or args.kwonlyargs or args.posonlyargs:
            self.refuse(found, "a parameter of another sort than by position")
        if found.decorator_list:
            self.refuse(found, "a decorator")
        return found

    @property
    def summary(self) -> str:
        """The docstring's first line."""
        lines = (ast.get_docstring(self.tree) or "").split("\n\n")[0].splitlines()
        return " ".join(line.strip() for line in lines)

    def refuse(self, node: ast.AST, construct: str) -> NoReturn:
        """Raise InputError: file, line and construct."""
        line = self.line + getattr(node, "lineno", 1) - 1
        raise InputError(f"{self.file}:{line}: transpile: {construct} has no counterpart in C here")

    def stays_in_loops(self, name: str) -> bool:
        """Whether a name is only the variable of loops, and only used inside of them."""
        loops = self._loops.get(name, [])
        if name in self.parameters or self.stores.get(name, 0) != len(loops):
            return False
        loads = self._loads.get(name, [])
        return all(any(use[: len(loop)] == loop for loop in loops) for use in loads)

    def _note(self, name: str, blocks: Blocks, stored: bool) -> None:
        if stored:
            self.stores[name] = self.stores.get(name, 0) + 1
        else:
            self._loads.setdefault(name, []).append(blocks)
        if name not in self.homes:
            self.homes[name] = blocks if stored else None
            return
        home = self.homes[name]
        if home is not None and blocks[: len(home)] != home:
            self.homes[name] = None

    def _uses(self, body: list[ast.stmt], blocks: Blocks) -> Iterator[tuple[str, Blocks, bool]]:
        """Name, blocks and whether it is assigned, of each use in the order in which they run."""
        for statement in body:
            inner = [(*blocks, id(statement), k) for k in range(2)]
            if isinstance(statement, (ast.If, ast.While)):
                yield from _names(statement.test, blocks)
            elif isinstance(statement, ast.For):
                yield from _names(statement.iter, blocks)
                for name in ast.walk(statement.target):
                    if isinstance(name, ast.Name):
                        self._loops.setdefault(name.id, []).append(inner[0])
                yield from _names(statement.target, inner[0])
            elif isinstance(statement, (ast.Assign, ast.AugAssign)):
                if isinstance(statement, ast.AugAssign) and isinstance(statement.target, ast.Name):
                    yield statement.target.id, blocks, False
                yield from _names(statement.value, blocks)
                targets: list[ast.expr] = []
                if isinstance(statement, ast.Assign):
                    targets += statement.targets
                else:
                    targets.append(statement.target)
                for target in targets:
                    yield from _names(target, blocks)
            else:
                yield from _names(statement, blocks)
            if isinstance(statement, (ast.If, ast.While, ast.For)):
                yield from self._uses(statement.body, inner[0])
                yield from self._uses(statement.orelse, inner[1])


def _names(tree: ast.AST, blocks: Blocks) -> Iterator[tuple[str, Blocks, bool]]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Name):
            yield node.id, blocks, isinstance(node.ctx, ast.Store)


def always_returns(body: list[ast.stmt]) -> bool:
    """Whether no way through statements ends behind them."""
    for statement in body:
        if isinstance(statement, ast.Return):
            return True
        if isinstance(statement, ast.If) and statement.orelse:
            parts = (statement.body, statement.orelse)
            if all(always_returns(part) for part in parts):
                return True
    return False
