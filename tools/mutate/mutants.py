"""What can be changed in a module, one mutant a place: the operators are cosmic-ray's, and so is
its reading of source; those of `messages` change what is said.

cosmic-ray writes a mutant by walking the whole tree once more; here the changed node's text is put
into the source, which gives the same text (a test compares them) and takes milliseconds for all
mutants of a module.
"""

from __future__ import annotations

import ast
import hashlib
import itertools
import re
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import cosmic_ray.plugins
from cosmic_ray.ast import ast_nodes, get_ast
from cosmic_ray.ast.ast_query import ASTQuery

from . import messages

PACKAGE = "poekin"

# Whether two equal values are one object is the interpreter's affair, and no claim of a module.
_UNDEFINED = ("core/ReplaceComparisonOperator_Eq_Is", "core/ReplaceComparisonOperator_NotEq_IsNot")
# `reshape(-2)` is `reshape(-1)` to NumPy, which does not say so.
_LENGTH = re.compile(r"reshape\((~\s*1|-\s*2)\b")
_ARITHMETIC = {"arith_expr", "term", "power", "shift_expr", "expr", "and_expr", "xor_expr"}


@dataclass(frozen=True)
class Mutant:
    """One change: where it is, what made it, the first line that differs, and the span of the
    source it replaces.
    """

    path: str
    operator: str
    occurrence: int
    line: int
    definition: str
    old: str
    new: str
    key: str
    start: int
    end: int
    text: str

    @property
    def room(self) -> str:
        """The room of the package that its module stands in."""
        return room(self.path)

    def applied(self, source: str) -> str:
        """The source of the whole module with this change in it."""
        return source[: self.start] + self.text + source[self.end :]


def paths(root: Path) -> list[str]:
    """The modules of the package, relative to the root of the repository."""
    return sorted(file.relative_to(root).as_posix() for file in (root / PACKAGE).rglob("*.py"))


def room(path: str) -> str:
    """The folder below the package; the algebra is of the formulas, other single files are of
    "errors".
    """
    first, *rest = path.split("/")[1:]
    return first if rest else "formulas" if first == "algebra.py" else "errors"


def mutants_of(path: str, source: str) -> list[Mutant]:
    """Every mutant of a module, by place; two changes that give the same text count once."""
    tree, lines, silent = get_ast(source), source.split("\n"), hints(source)
    begins = [0, *itertools.accumulate(len(line) + 1 for line in lines)]
    nodes = list(ast_nodes(tree))
    ends, asked = [*begins[1:], len(source) + 1], _asked(nodes)
    found: dict[str, tuple[tuple[int, int], Mutant]] = {}
    for name, operator in operators():
        positions = (
            (node, start) for node in asked(name) for start, _ in operator.mutation_positions(node)
        )
        indices: dict[int, int] = {}  # how many changes of this node were made already
        for occurrence, (node, start) in enumerate(positions):
            index = indices.get(id(node), 0)
            indices[id(node)] = index + 1
            if any(first <= start < last for first, last in silent) or _no_operation(name, node):
                continue
            row, column = node.get_start_pos_of_prefix()
            begin, last = begins[row - 1] + column, min(node.end_pos[0] + 2, len(lines))
            end, text = begin + len(node.get_code()), changed(operator, node, index)
            # the lines of the change and two more: those before are as they were, and those after
            # are seldom asked for
            after = (
                source[begins[row - 1] : begin] + text + source[end : ends[last - 1] - 1]
            ).split("\n")
            found_at = _differs(lines[row - 1 : last], after, start[0] - row)
            if found_at is None:
                continue
            at = found_at + row - 1
            whole = f"{path}\0{source[:begin]}{text}{source[end:]}"
            key = hashlib.sha256(whole.encode()).hexdigest()[:16]
            definition = ASTQuery(node).get_definition_name() or ""
            old, new = lines[at].strip(), after[found_at].strip()
            if _LENGTH.search(new):
                continue
            mutant = Mutant(
                path, name, occurrence, at + 1, definition, old, new, key, begin, end, text
            )
            found.setdefault(key, (start, mutant))
    return [
        mutant
        for _, mutant in sorted(
            found.values(), key=lambda pair: (pair[0], pair[1].operator, pair[1].key)
        )
    ]


def _asked(nodes: list[Any]) -> Callable[[str], list[Any]]:
    """The nodes that an operator can change, by its name: of 213 operators 196 replace a sign by
    another one.
    """
    signs = [node for node in nodes if node.type == "operator" and node.value not in "()[]{},.:;="]
    comparisons = [node for node in nodes if node.type == "comparison"]
    unary = [node for node in nodes if node.type in ("factor", "not_test")]
    kinds = {"BinaryOperator": signs, "ComparisonOperator": comparisons, "UnaryOperator": unary}
    return lambda name: next((found for kind, found in kinds.items() if kind in name), nodes)


def _differs(lines: list[str], after: list[str], place: int) -> int | None:
    """The line of the place where something was changed, or else the first one that differs.

    The first one too where a break before the place was lost, as then its lines are not the same.
    """
    pairs = list(zip(lines, after, strict=False))
    differing = [k for k, (old, new) in enumerate(pairs) if old != new]
    if place in differing and len(lines) == len(after):
        return place
    filled = [k for k in differing if lines[k].strip()]
    return next(iter(filled or differing), None)


@cache
def operators() -> tuple[tuple[str, Any], ...]:
    """cosmic-ray's operators by name, and those of `messages`; all but four.

    VariableReplacer and VariableInserter want to be told of which variables, and put a random
    number in their place or an operation drawn at random beside them, so that no two runs would
    plant the same. `==` does not become `is`, nor `!=` `is not`: for small integers and most
    strings they do the same.
    """
    names = sorted(set(cosmic_ray.plugins.operator_names()) - set(_UNDEFINED))
    classes = [(name, cosmic_ray.plugins.get_operator(name)) for name in names]
    return (
        *((name, operator()) for name, operator in classes if not operator.arguments()),
        *messages.OPERATORS,
    )


def changed(operator: Any, node: Any, index: int) -> str:
    """The text of a node after an operator's change number `index`; the node is left as it was."""
    parts = [node, *getattr(node, "children", ())]
    saved = [(part, part.value) for part in parts if hasattr(part, "value")]
    children = list(node.children) if hasattr(node, "children") else None
    result = operator.mutate(node, index)
    text = "" if result is None else result.get_code()
    for part, value in saved:
        part.value = value
    if children is not None:
        node.children = children
    return text


def hints(source: str) -> list[tuple[tuple[int, int], tuple[int, int]]]:
    """Where the annotations of a module stand, and its overloads: with `from __future__ import
    annotations` nothing there ever runs.
    """
    tree = ast.parse(source)
    if not any(
        isinstance(node, ast.ImportFrom) and node.module == "__future__" for node in tree.body
    ):
        return []
    found = [
        (
            (node.lineno, column(source, node)),
            (node.end_lineno or 0, column(source, node, end=True)),
        )
        for node in _hint_nodes(tree)
    ]
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef) and _is_overload(node):
            found.append(((node.decorator_list[0].lineno, 0), (node.end_lineno or 0, sys.maxsize)))
    return found


def _is_overload(node: ast.FunctionDef) -> bool:
    return any(isinstance(d, ast.Name) and d.id == "overload" for d in node.decorator_list)


def _hint_nodes(tree: ast.AST) -> Iterator[ast.expr]:
    for node in ast.walk(tree):
        hint = (
            node.returns if isinstance(node, ast.FunctionDef) else getattr(node, "annotation", None)
        )
        if hint is not None:
            yield hint


def column(source: str, node: ast.expr, end: bool = False) -> int:
    """The column of a node's begin or end in characters; Python's own counts bytes."""
    line, offset = (node.end_lineno, node.end_col_offset) if end else (node.lineno, node.col_offset)
    text = source.split("\n")[(line or 1) - 1]
    return len(text.encode()[:offset].decode())


def _no_operation(name: str, node: Any) -> bool:
    """Whether a `*`, `**` or `/` is no operation of two numbers: that of a signature or of a
    display. And whether an exception has a dotted name, which cosmic-ray's ExceptionReplacer cannot
    write.
    """
    if name == "core/ExceptionReplacer":
        return "." in node.children[1].get_code()
    return "BinaryOperator" in name and node.parent.type not in _ARITHMETIC
