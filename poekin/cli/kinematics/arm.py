"""Chain and configurations out of the arguments of a command, and its results, one or many."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Annotated

import numpy as np
from typer import Argument, Option

from ...errors import InputError, quote
from ...formats.text import csv_rows
from ...model.chain import Chain
from ...model.robot import Robot
from ...progress_line import ProgressLine
from .. import array_files
from ..formats.units import SI, SaidUnits, beyond_limits
from ..model import model_and_chain
from ..output import as_json, complain, heading, matrix, name, number, path_text, say
from . import poses

FILE_HELP = (
    "A URDF, MJCF, DH table or calibration file, a pipe (- is standard input), a built-in name "
    "(panda), or erd:NAME; poekin list names them."
)
File = Annotated[str, Argument(metavar="FILE", help=FILE_HELP)]
Tip = Annotated[
    str | None,
    Option("--tip", help="The link whose motion it is (may be left out for one leaf)."),
]
Base = Annotated[
    str | None,
    Option("--base", help="The link it is seen from (default: the root)."),
]
Numbers = Annotated[
    list[str] | None,
    Argument(
        metavar="Q...", help="The coordinates, in rad or m; of one word, with commas between."
    ),
]
Input = Annotated[
    str | None,
    Option(
        "--input",
        metavar="FILE",
        help="Many configurations: a .csv or .npy file, or - (CSV on stdin).",
    ),
]
Output = Annotated[
    Path | None,
    Option("-o", "--output", help="Where the results go: a .csv, .npy or .json file."),
]
Seed = Annotated[int, Option("--seed", help="Seed of the random configurations.", min=0)]
Json = Annotated[bool, Option("--json", help="Print JSON.")]

ROWS_AT_ONCE = 20_000


@dataclass(frozen=True)
class ChainArguments:
    """Robot and chain of a file, and configurations (N, m) in rad and m; single where the user gave one Q; the
    units that they are shown in.
    """

    robot: str
    chain: Chain
    q: np.ndarray
    single: bool
    units: SaidUnits = SI
    model: Robot | None = None


def take(
    file: str,
    tip: str | None,
    base: str | None,
    q: Sequence[str] | None,
    given: str | None,
    *,
    many: bool = True,
    units: SaidUnits | None = None,
) -> ChainArguments:
    """Chain and configurations that a command line names.

    Parameters: many, whether the command has --input; units, of the configurations, of a command
    that has --mm and --deg, and says which configurations are beyond the limits.

    Raises: what `model`, `Robot.chain` and reading do.
    """
    words = list(q or ())
    if len(words) == 1:  # commas of more words could be decimal ones
        words = poses.words_of(words[0])
    values = poses.numbers(words, "coordinate")
    robot, chain = model_and_chain(file, base, tip)
    if given is None:
        poses.check_count(values, chain, remedy="; or --input with a file" * many)
        arm = ChainArguments(robot.name, chain, values[None], True, model=robot)
        return _in_si(arm, units)
    if words:
        raise InputError(
            f"either coordinates or --input expected, got both ({quote(words[0])} and {quote(given)})"
        )
    with ProgressLine(f"reading {array_files.called(given)}") as progress:
        columns = (units or SI).columns(chain)
        rows = array_files.read_configurations(given, columns, progress)
    return _in_si(ChainArguments(robot.name, chain, rows, False, model=robot), units)


def _in_si(arm: ChainArguments, units: SaidUnits | None) -> ChainArguments:
    """Configurations in rad and m; those beyond the limits are told on stderr."""
    if units is None:
        return arm
    q = units.to_si(arm.q, arm.chain)
    sentence = beyond_limits(arm.chain, q, units)
    if sentence:
        complain(f"warning: {sentence}")
    return replace(arm, q=q, units=units)


def compute(
    arm: ChainArguments,
    function: Callable[[np.ndarray], np.ndarray],
    shape: tuple[int, ...],
) -> np.ndarray:
    """Results (N, *shape) of a function of configurations, computed in parts with progress."""
    q = arm.q
    count = len(q)
    results = np.empty((count, *shape))
    with ProgressLine("computing") as progress:
        for start in range(0, count, ROWS_AT_ONCE):
            progress(start, count)
            some = slice(start, start + ROWS_AT_ONCE)
            results[some] = function(q[some])
    return results


@dataclass(frozen=True)
class Results:
    """Matrices (N, r, c) of one kind, with what messages, columns and rows call them.

    Fields: values; symbol ("T", "J"); title; names of the rows and columns; extra JSON keys.
    """

    values: np.ndarray
    symbol: str
    title: str
    rows: Sequence[str]
    columns: Sequence[str] = ()
    extra: Mapping[str, object] = field(default_factory=dict)

    def array(self) -> np.ndarray:
        """Array of a .npy file."""
        return self.values

    def csv(self) -> str:
        """CSV with a line for each matrix."""
        columns = self.columns or [""]
        header = [f"{row} {column}".strip() for row in self.rows for column in columns]
        with ProgressLine("writing") as progress:
            # The width is said, not inferred: -1 means nothing where there is no configuration.
            flat = self.values.reshape(len(self.values), math.prod(self.values.shape[1:]))
            return csv_rows.text(header, flat, progress)

    def json(self, arm: ChainArguments, single: bool) -> str:
        """JSON with the configurations; of a single one without the axis of the batch."""
        head = heading(arm.robot, arm.chain, **self.extra)
        if single:
            (q,), (value,) = arm.q, self.values
            return as_json(head | {"q": q, self.symbol: value})
        return as_json(head | {"q": arm.q, self.symbol: self.values})

    def show(self, arm: ChainArguments) -> None:
        """Print the matrix of a single configuration."""
        (q,), (value,) = arm.q, self.values
        say(f"{self.title}, at")
        show_coordinates(arm.chain, q, arm.units)
        say()
        if self.columns:
            matrix(value, self.rows, self.columns)
        else:
            matrix(value)


def show_coordinates(chain: Chain, q: np.ndarray, units: SaidUnits = SI) -> None:
    """Print a line for each coordinate, with its unit where one was said."""
    said = units.said()
    values = units.from_si(q, chain)
    for coordinate, value, unit in zip(chain.q_names, values, units.of(chain), strict=True):
        end = f" {unit}" if unit in said else ""
        say(f"  {name(coordinate)} = {number(value, 9)}{end}")


def give(arm: ChainArguments, results: Results, output: Path | None, json: bool) -> None:
    """Write the results to a file, or print them."""
    if output is not None:
        array_files.write_result(
            output,
            results.csv,
            results.array(),
            lambda: results.json(arm, False),
        )
        count = len(results.values)
        if json:
            say(as_json({"written": str(output), "configurations": count}))
        else:
            say(f"{count} × {results.symbol} written to {path_text(output)}")
    elif json:
        print(results.json(arm, arm.single))
    elif arm.single:
        results.show(arm)
    else:
        print(results.csv(), end="")
