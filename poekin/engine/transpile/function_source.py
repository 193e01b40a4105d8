"""The Python text of a function: its syntax tree, its places, and in which blocks names are used."""

from __future__ import annotations

import ast
import inspect
import textwrap
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple, NoReturn

from ...errors import InputError

Blocks = tuple[int, ...]


class _Use(NamedTuple):
    """A name, the blocks around it, and whether it is assigned there."""

    name: str
    blocks: Blocks
    stored: bool


class FunctionSource:
    """A function with its syntax tree.

    `first` is the block where each local name is assigned first if all its uses are in there, None
    if others are; `stores` counts the places that assign a name.
    """

    def __init__(self, function: Callable) -> None:
        self.function = function
        self.file = inspect.getsourcefile(function) or "?"
        lines, self.line = inspect.getsourcelines(function)
        text = textwrap.dedent("".join(lines))
        self.tree = self._definition(text)
        self.parameters = [arg.arg for arg in self.tree.args.args]
        self.names: dict[str, Any] = {}
        self.names |= inspect.getclosurevars(function).builtins
        self.names |= function.__globals__
        self.stores = dict.fromkeys(self.parameters, 0)
        self.homes: dict[str, Blocks | None] = {}
        self._loops: dict[str, list[Blocks]] = {}
        self._loads: dict[str, list[Blocks]] = {}
        for use in self._uses(self.tree.body, ()):
            self._note(use)

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
        text = ast.get_docstring(self.tree) or ""
        paragraph, _, _ = text.partition("\n\n")
        return " ".join(line.strip() for line in paragraph.splitlines())

    def refuse(self, node: ast.AST, construct: str) -> NoReturn:
        """Raise InputError: file, line and construct."""
        line = self.line + getattr(node, "lineno", 1) - 1
        raise InputError(f"{self.file}:{line}: transpile: {construct} has no counterpart in C here")

    def stays_in_loops(self, name: str) -> bool:
        """Whether a name is only the variable of loops, and only used inside of them."""
        loops = self._loops.get(name, [])
        stores = self.stores.get(name, 0)
        if name in self.parameters or stores != len(loops):
            return False
        loads = self._loads.get(name, [])
        return all(any(_is_in(use, loop) for loop in loops) for use in loads)

    def _note(self, use: _Use) -> None:
        name = use.name
        blocks = use.blocks
        if use.stored:
            self.stores[name] = self.stores.get(name, 0) + 1
        else:
            self._loads.setdefault(name, []).append(blocks)
        if name not in self.homes:
            self.homes[name] = blocks if use.stored else None
            return
        home = self.homes[name]
        if home is not None and not _is_in(blocks, home):
            self.homes[name] = None

    def _uses(self, body: list[ast.stmt], blocks: Blocks) -> Iterator[_Use]:
        """Uses of names in the order in which they run."""
        for statement in body:
            inner = (*blocks, id(statement), 0)
            match statement:
                case ast.If() | ast.While():
                    yield from _names(statement.test, blocks)
                case ast.For(target, source):
                    yield from _names(source, blocks)
                    for use in _names(target, inner):
                        self._loops.setdefault(use.name, []).append(inner)
                        yield use
                case ast.AugAssign(target, _, value):
                    if isinstance(target, ast.Name):
                        yield _Use(target.id, blocks, False)
                    yield from _names(value, blocks)
                    yield from _names(target, blocks)
                case ast.Assign(targets, value):
                    yield from _names(value, blocks)
                    for target in targets:
                        yield from _names(target, blocks)
                case _:
                    yield from _names(statement, blocks)
            if isinstance(statement, (ast.If, ast.While, ast.For)):
                yield from self._uses(statement.body, inner)
                yield from self._uses(statement.orelse, (*blocks, id(statement), 1))


def _names(tree: ast.AST, blocks: Blocks) -> Iterator[_Use]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Name):
            yield _Use(node.id, blocks, isinstance(node.ctx, ast.Store))


def _is_in(blocks: Blocks, outer: Blocks) -> bool:
    """Whether the innermost of some blocks is in another block."""
    return blocks[: len(outer)] == outer


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
