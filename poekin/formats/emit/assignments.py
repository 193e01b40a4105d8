"""Statements as C and JavaScript write them: one declaration or assignment a line."""

from __future__ import annotations

from collections.abc import Iterable

from .messages import EmittedFunction
from .statements import Statements, WriteNumber, by_outputs

INDENT = "    "


def angle_assignments(program: Statements, declare: str) -> list[str]:
    """The angles x of the coordinates q; declare is what stands before a new name."""
    return [
        *_declared(((name, f"{array}[{k}]") for name, array, k in program.angle_reads), declare),
        *_declared(((f"x{j}", text) for j, text in enumerate(program.angles)), declare),
        *(f"{INDENT}x[{j}] = x{j};" for j in range(len(program.angles))),
    ]


def result_assignments(
    program: Statements,
    task: EmittedFunction,
    literal: WriteNumber,
    declare: str,
) -> list[str]:
    """The results T and J of sines s, cosines c and coordinates q; all is read before it is written."""
    T, J = by_outputs(program.outputs, task.poses)
    return [
        *_declared(((name, f"{array}[{k}]") for name, array, k in program.reads), declare),
        *_declared(program.lines, declare),
        *(
            f"{INDENT}{name}[{k}] = {x if isinstance(x, str) else literal(x)};"
            for name, values in (("T", T), ("J", J))
            for k, x in enumerate(values)
        ),
    ]


def comment(lines: list[str]) -> str:
    """A comment of many lines."""
    return "\n".join(["/*", *(f" * {line}".rstrip() for line in lines), " */"])


def _declared(pairs: Iterable[tuple[str, str]], declare: str) -> list[str]:
    return [f"{INDENT}{declare} {name} = {text};" for name, text in pairs]
