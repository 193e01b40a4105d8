"""DH tables as files: TOML, or CSV for spreadsheets, both with convention, base and tool; rad, m.

TOML: convention, name, base and tool (4x4, identity if left out), coupling (a list of statements
such as "J3 = J2 + J3"), and a [[joint]] for each row with theta, d, a, alpha and, where they differ
from the default, kind, flip, name and limits.
CSV: a header of these columns and `convention`; a row whose kind is "base" or "tool" holds a pose's
first three rows, twelve numbers, in the column `pose`; the column `coupling` holds statements.
"""

from __future__ import annotations

import csv
import io
import os
import re
from collections import Counter
from collections.abc import Callable
from typing import Any

import numpy as np

from ...errors import (
    InputError,
    ModelError,
    PoekinError,
    escape_unprintable,
    quote,
    safe_repr,
)
from ...groups.arrays import Array
from ...model.readings.statements import statements_by_joint
from ..common.limits import UNBOUNDED
from ..text import toml_text, xml
from ..text.atomic_write import FilePath, write_whole
from ..text.csv_dialect import separator_of
from ..text.numbers import real
from ..text.toml_text import Keys
from .table import COLUMNS, KINDS, Row, Table, check_table

TOP: tuple[str, ...] = (
    "convention",
    "name",
    "source",
    "base",
    "tool",
    "coupling",
    "joint",
)
_CELLS: tuple[str, ...] = ("name", "kind", *COLUMNS, "flip")
FIELDS: tuple[str, ...] = (*_CELLS, "limits")
CSV_COLUMNS: tuple[str, ...] = (
    "convention",
    *_CELLS,
    "lower",
    "upper",
    "pose",
    "coupling",
)
_TRUTHS = {"true": True, "false": False}


def read(path: FilePath) -> Table:
    """Denavit-Hartenberg table in a .toml or .csv file.

    Parameters
    ----------
    path : str or os.PathLike
        Path of the file; its ending says which kind it is.

    Returns
    -------
    table : Table
        The table, rad and m.

    Raises
    ------
    FileError
        If the file cannot be read.
    ModelError
        If a column is missing or misspelt, the conventions are mixed, or a number is none; with the
        file, and the line of a CSV.
    InputError
        If the path ends in neither .toml nor .csv, or is no path.

    Notes
    -----
    Accuracy: numbers as they are written.

    Examples
    --------
    >>> import poekin as pk
    >>> pk.dh.write(pk.dh.published("ur5e"), "arm.csv")
    >>> pk.dh.read("arm.csv").d.tolist()
    [0.1625, 0.0, 0.0, 0.1333, 0.0997, 0.0996]
    """
    text, _ = xml.read_text(path)
    return read_text(text, os.fsdecode(path))


def read_text(text: str, name: str, ending: str = "") -> Table:
    """Table in the text of a file, TOML or CSV as `ending` says, or its name. Raises as `read`."""
    stem, own_ending = os.path.splitext(os.path.basename(name))
    reader = _reader(name, ending or own_ending, _READERS)
    return reader(text, escape_unprintable(name, 400), stem)


def write(table: Table, path: FilePath) -> None:
    """Write a table as a .toml (extra `formats`) or .csv file; numbers keep all their digits.

    The file appears whole or not at all; one that was there stays until the new one is complete.

    Parameters
    ----------
    table : Table
        Table to write.
    path : str or os.PathLike
        Path of the file; its ending says which kind it is.

    Raises
    ------
    InputError
        If `table` is no Table, or the path ends in neither .toml nor .csv.
    FileError
        If the file cannot be written.
    MissingExtra
        If tomli-w is not installed, for .toml.

    Examples
    --------
    >>> import poekin as pk
    >>> table = pk.dh.published("ur5e")
    >>> pk.dh.write(table, "ur5e.csv")
    >>> pk.dh.read("ur5e.csv") == table
    True
    """
    check_table(table, "write")
    if not isinstance(path, (str, bytes, os.PathLike)):
        raise InputError(f"expected the path of a file, got {safe_repr(path)}")
    name = os.fsdecode(path)
    _, ending = os.path.splitext(name)
    text = _reader(name, ending, _WRITERS)(table)
    write_whole(path, text.encode())


def make_text(table: Table, ending: str) -> str:
    """A table as the text of a .toml or .csv file."""
    return _reader(ending, ending, _WRITERS)(table)


def _reader(
    name: str,
    ending: str,
    known: dict[str, Callable],
) -> Callable:
    if ending.lower() not in known:
        raise InputError(
            f"{escape_unprintable(name, 400)}: expected a file ending in .toml or .csv"
        )
    return known[ending.lower()]


def _from_toml(text: str, place: str, stem: str) -> Table:
    data = toml_text.parse(text, place)
    keys = Keys(data, place, TOP)
    joints = keys.tables("joint", FIELDS)
    given = keys.data
    coupling: tuple[str, ...] = ()
    if isinstance(given.get("coupling"), str):
        coupling = (keys.text("coupling"),)
    elif "coupling" in given:
        coupling = keys.texts("coupling")
    return _table(
        place,
        given.get("convention"),
        [_row(joint) for joint in joints],
        given.get("base"),
        given.get("tool"),
        given.get("name", stem),
        coupling,
    )


def _row(keys: Keys) -> Row:
    """Row of a table in TOML, or of a line of CSV as such a table."""
    optional: dict[str, Any] = {}
    if "kind" in keys.data:
        optional["kind"] = keys.text("kind", KINDS)
    if "flip" in keys.data:
        optional["flip"] = keys.truth("flip")
    if "name" in keys.data:
        optional["name"] = keys.text("name")
    if "limits" in keys.data:
        limits = keys.array("limits", (2,), finite=False)
        lower, upper = limits.tolist()
        if not lower <= upper:
            raise keys.fault("limits", f"expected lower <= upper, got {lower} and {upper}")
        optional["limits"] = (lower, upper)
    numbers = {column: keys.number(column) for column in COLUMNS}
    return Row(**numbers, **optional)


def _from_csv(text: str, place: str, stem: str) -> Table:
    separator = ";" if separator_of(text.partition("\n")[0]) == ";" else ","
    reader = csv.DictReader(io.StringIO(text), strict=True, delimiter=separator)
    try:
        header = list(reader.fieldnames or ())
        found = _CsvTable(place, header)
        for record in reader:
            if separator == ";":
                record = _with_points(record)
            found.take(record, f"{place}:{reader.line_num}")
    except csv.Error as fault:
        raise ModelError(f"{place}:{max(reader.line_num, 1)}: {fault}") from fault
    poses = found.poses
    return _table(
        place,
        found.convention,
        found.rows,
        poses.get("base"),
        poses.get("tool"),
        stem,
        tuple(found.coupling),
    )


def _with_points(record: dict[Any, Any]) -> dict[Any, Any]:
    """A line with decimal commas as points, but for the joint's name."""
    return {
        column: re.sub(r"(?<=\d),(?=\d)", ".", cell)
        if column in (*COLUMNS, "lower", "upper", "pose") and isinstance(cell, str)
        else cell
        for column, cell in record.items()
    }


class _CsvTable:
    """Rows, poses and convention of a table, taken out of a CSV line by line."""

    def __init__(self, place: str, header: list[str]) -> None:
        self.header = header
        self.rows: list[Row] = []
        self.poses: dict[str, Array] = {}
        self.coupling: list[str] = []
        self.convention: str | None = None
        keys = Keys(Counter(header), f"{place}:1", CSV_COLUMNS)
        for column, times in keys.data.items():
            if times > 1:
                raise keys.fault(column, f"it appears {times} times, expected once")
        for column in ("convention", *COLUMNS):
            keys.value(column)

    def take(self, record: dict[Any, Any], line: str) -> None:
        """Take a row or a pose, of an empty line nothing; line is what messages call it."""
        if None in record or None in record.values():
            got = sum(record[column] is not None for column in self.header)
            got += len(record.get(None, ()))
            raise ModelError(
                f"{line}: expected {len(self.header)} columns as in the header, got {got}"
            )
        if not any(cell.strip() for cell in record.values()):
            return
        kind = record.get("kind") or "revolute"
        posed = kind in ("base", "tool")
        if record["convention"] or not posed:  # of a pose it may be left out
            self._take_convention(record["convention"], line)
        if statement := record.get("coupling"):
            self.coupling.append(statement)
        if not posed:
            self.rows.append(_row(_as_keys(record, line)))
            return
        if kind in self.poses:
            raise ModelError(f"{line}: a second row of the kind {kind}, expected one at most")
        words = record.get("pose", "").split()
        keys = Keys({"pose": list(map(_cell, words))}, line)
        rows = keys.array("pose", (12,)).reshape(3, 4)
        self.poses[kind] = np.vstack([rows, [0, 0, 0, 1]])

    def _take_convention(self, convention: str, line: str) -> None:
        if self.convention not in (None, convention):
            both = f"{quote(convention)} after {quote(self.convention)}"
            raise ModelError(f"{line}: mixed conventions: {both}")
        self.convention = convention


def _as_keys(record: dict[str, str], line: str) -> Keys:
    """Line of CSV as a table in TOML has it; an empty cell stands for the default."""
    filled = (key for key in ("kind", "name") if record.get(key))
    data: dict[str, Any] = {key: record[key] for key in filled}
    data |= {column: _cell(record[column]) for column in COLUMNS}
    lower = record.get("lower") or "-inf"
    upper = record.get("upper") or "inf"
    data["limits"] = [_cell(lower), _cell(upper)]
    if flip := record.get("flip"):
        data["flip"] = _TRUTHS.get(flip.lower(), flip)
    return Keys(data, line)


def _cell(text: str) -> float | str:
    """Number that a cell says, or its text where it says none."""
    number = real(text.strip())
    if number is None:
        return text
    return number


def _table(
    place: str,
    convention: Any,
    rows: list[Row],
    base: Any,
    tool: Any,
    name: str,
    coupling: tuple[str, ...],
) -> Table:
    try:
        return Table(
            convention,
            rows,
            base=base,
            tool=tool,
            name=name,
            coupling=coupling,
        )
    except PoekinError as fault:
        raise ModelError(f"{place}: {fault}") from fault


def _placed(table: Table) -> dict[str, Array]:
    """Base and tool of a table, where they are not the identity."""
    poses = {"base": table.base, "tool": table.tool}
    return {what: T for what, T in poses.items() if (np.eye(4) != T).any()}


def _to_toml(table: Table) -> str:
    data: dict[str, Any] = {
        "convention": table.convention,
        "name": table.name,
    }
    for what, T in _placed(table).items():
        data[what] = T.tolist()
    if table.coupling:
        data["coupling"] = list(table.coupling)
    joints = []
    for row in table.rows:
        joint = {key: getattr(row, key) for key in _CELLS}
        if row.limits != UNBOUNDED:
            joint["limits"] = list(row.limits)
        joints.append(joint)
    data["joint"] = joints
    return toml_text.make_text(data)


def _to_csv(table: Table) -> str:
    out = io.StringIO()
    columns = CSV_COLUMNS
    if not table.coupling:
        columns = columns[:-1]
    writer: csv.DictWriter[str] = csv.DictWriter(
        out,
        columns,
        restval="",
        extrasaction="ignore",
        lineterminator="\n",
    )
    writer.writeheader()
    for what, T in _placed(table).items():
        numbers = T[:3].ravel().tolist()
        writer.writerow(
            {
                "convention": table.convention,
                "kind": what,
                "pose": " ".join(map(repr, numbers)),
            }
        )
    statements = statements_by_joint(table.coupling, table.names)
    for row, statement in zip(table.rows, statements, strict=True):
        numbers = {column: repr(getattr(row, column)) for column in COLUMNS}
        lower, upper = map(repr, row.limits)
        writer.writerow(
            {
                "convention": table.convention,
                "name": row.name,
                "kind": row.kind,
                **numbers,
                "flip": str(row.flip).lower(),
                "lower": lower,
                "upper": upper,
                "coupling": statement,
            }
        )
    return out.getvalue()


_READERS: dict[str, Callable] = {".toml": _from_toml, ".csv": _from_csv}
_WRITERS: dict[str, Callable] = {".toml": _to_toml, ".csv": _to_csv}
