"""What fk and jacobian have in common: the chain and its configurations in, one result or many out."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import numpy as np
import typer

from ...errors import InputError, quote, suggest
from ...formats.text.atomic_write import write_whole
from ...formats.text.numbers import real
from ...model.chain import Chain
from .. import array_files
from ..model import OPTIONS, model
from ..output import Progress, as_json, matrix, name, number, path_text, say

FILE_HELP = "A URDF, MJCF, DH table or calibration file, a built-in name (panda), or erd:NAME."
File = Annotated[str, typer.Argument(metavar="FILE", help=FILE_HELP)]
Tip = Annotated[
    str | None,
    typer.Option("--tip", help="The link whose motion it is (may be left out for one leaf)."),
]
Base = Annotated[
    str | None, typer.Option("--base", help="The link it is seen from (default: the root).")
]
Numbers = Annotated[
    list[str] | None, typer.Argument(metavar="Q...", help="The coordinates, in rad or m.")
]
Input = Annotated[
    str | None,
    typer.Option(
        "--input",
        metavar="FILE",
        help="Many configurations: a .csv or .npy file, or - (CSV on stdin).",
    ),
]
Output = Annotated[
    Path | None, typer.Option("--output", help="Where the results go: a .csv, .npy or .json file.")
]
Json = Annotated[bool, typer.Option("--json", help="Print JSON.")]

ROWS_AT_ONCE = 20_000


@dataclass(frozen=True)
class Arm:
    """One chain out of a file, and the configurations (N, m) that the user gave; single where it
    was one Q.
    """

    robot: str
    chain: Chain
    q: np.ndarray
    single: bool


def take(
    file: str,
    tip: str | None,
    base: str | None,
    q: Sequence[str] | None,
    given: str | None,
    *,
    many: bool = True,
) -> Arm:
    """The chain and configurations that a command line names; many: whether the command has
    --input.

    Raises: what `model`, `Robot.chain` and reading do.
    """
    words = list(q or ())
    for word in words:
        if word.startswith("--"):  # it came through as a number might
            options = ("--tip", "--base", "--frame", "--input", "--output", "--json", *OPTIONS)
            raise InputError(f"there is no option {quote(word)}; {suggest(word, options)}")
    values = [_value(word, i) for i, word in enumerate(words)]
    robot = model(file)
    chain = robot.chain(base=base, tip=tip)
    if given is None:
        if len(values) != chain.dof:
            names = ", ".join(name(n) for n in chain.q_names)
            other = "; or --input with a file" if many else ""
            raise InputError(
                f"{chain.dof} coordinates expected ({names}), got {len(values)}{other}"
            )
        return Arm(robot.name, chain, np.array(values, float).reshape(1, chain.dof), True)
    if values:
        raise InputError(
            f"either coordinates or --input expected, got both ({quote(words[0])} and {quote(given)})"
        )
    with Progress(f"reading {array_files.called(given)}") as progress:
        return Arm(
            robot.name,
            chain,
            array_files.read_configurations(given, chain.q_names, progress),
            False,
        )


def _value(word: str, index: int) -> float:
    value = real(word)
    if value is None:
        raise InputError(f"coordinate {index + 1}: a number expected (rad or m), got {quote(word)}")
    return value


def compute(
    arm: Arm, function: Callable[[np.ndarray], np.ndarray], shape: tuple[int, ...]
) -> np.ndarray:
    """The results (N, *shape) of a function of configurations, some at a time so that it can tell
    how far it is.
    """
    results = np.empty((len(arm.q), *shape))
    with Progress("computing") as progress:
        for start in range(0, len(arm.q), ROWS_AT_ONCE):
            progress(start, len(arm.q))
            results[start : start + ROWS_AT_ONCE] = function(arm.q[start : start + ROWS_AT_ONCE])
    return results


def give(
    arm: Arm, results: np.ndarray, what: str, *, title: str, rows: Sequence[str], columns: Sequence[str],
    output: Path | None, json: bool, extra: dict[str, object] | None = None,
) -> None:  # fmt: skip
    """Print the results (N, r, c), or write them: what is their symbol ("T", "J"); rows and columns
    have names.
    """
    chain = arm.chain
    head = {
        "robot": arm.robot,
        "base": chain.base,
        "tip": chain.tip,
        **(extra or {}),
        "q_names": list(chain.q_names),
    }

    def document() -> str:
        one = arm.single and output is None
        return as_json(
            head | {"q": arm.q[0] if one else arm.q, what: results[0] if one else results}
        )

    def sheet() -> str:
        header = [f"{r} {c}".strip() if columns else r for r in rows for c in columns or [""]]
        with Progress("writing") as progress:
            # The width is said, not inferred: -1 means nothing where there is no configuration.
            flat = results.reshape(len(results), math.prod(results.shape[1:]))
            return array_files.csv_text(header, flat, progress)

    if output is not None:
        content = {".csv": lambda: sheet().encode(), ".npy": lambda: array_files.npy_bytes(results)}
        write_whole(
            output, content.get(output.suffix.lower(), lambda: (document() + "\n").encode())()
        )
        summary = {"written": str(output), "configurations": len(results)}
        say(as_json(summary) if json else f"{len(results)} × {what} written to {path_text(output)}")
    elif json:
        print(document())
    elif arm.single:
        say(f"{title}, at")
        for coordinate, value in zip(chain.q_names, arm.q[0], strict=True):
            say(f"  {name(coordinate)} = {number(value, 9)}")
        say()
        matrix(results[0], *((rows, columns) if columns else ()))
    else:
        print(sheet(), end="")
