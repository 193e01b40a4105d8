"""Tables as files: TOML, or CSV for spreadsheets. Both carry the convention, base and tool; rad and
m only.

TOML: convention, name, base and tool (4x4, identity if left out), and a [[joint]] for each row with
theta, d, a, alpha and, where they differ from the default, kind, flip, name and limits.
CSV: a header of these columns and `convention`; a row whose kind is "base" or "tool" holds a pose's
first three rows, twelve numbers, in the column `pose`.
"""

from __future__ import annotations

import csv
import io
import math
import os
from collections import Counter
from collections.abc import Callable
from typing import Any

import numpy as np

from ...errors import (
    FileError,
    InputError,
    ModelError,
    PoekinError,
    escape_unprintable,
    quote,
    safe_repr,
    suggest,
)
from ...groups.arrays import Array
from ..text import toml_text, xml
from ..text.atomic_write import write_whole
from ..text.numbers import real
from .table import COLUMNS, CONVENTIONS, KINDS, Row, Table

TOP: tuple[str, ...] = ("convention", "name", "source", "base", "tool", "joint")
FIELDS: tuple[str, ...] = ("name", "kind", *COLUMNS, "flip", "limits")
CSV_COLUMNS: tuple[str, ...] = (
    "convention",
    "name",
    "kind",
    *COLUMNS,
    "flip",
    "lower",
    "upper",
    "pose",
)


def read(path: str | os.PathLike[str]) -> Table:
    """The table in a .toml or .csv file.

    Parameters: path, of the file. Returns: Table.
    Raises: FileError for a file that cannot be read; ModelError with the file, and the line of a
    CSV, for a column that is missing or misspelt, mixed conventions, and numbers that are none.
    Accuracy: numbers as they are written.
    """
    name = _path(path)
    try:
        text = xml.read_bytes(path).decode("utf-8-sig")
    except UnicodeDecodeError as fault:
        raise FileError(
            f"{escape_unprintable(name, 400)}: not UTF-8 at byte {fault.start}"
        ) from fault
    return read_text(text, name)


def read_text(text: str, name: str) -> Table:
    """The table in the text of a file of that name; its ending says which kind of text it is.
    Raises as `read`.
    """
    stem, ending = os.path.splitext(os.path.basename(name))
    reader = _reader(name, ending, {".toml": _from_toml, ".csv": _from_csv})
    return reader(text, escape_unprintable(name, 400), stem)


def write(table: Table, path: str | os.PathLike[str]) -> None:
    """Write a table as .toml (extra `formats`) or .csv; numbers keep all their digits.

    The file appears whole or not at all; one that was there stays until the new one is complete.
    Parameters: table; path, of the file, whose ending says which kind it is. Returns: nothing.
    Raises: InputError for what is no Table; FileError where the file cannot be written;
    MissingExtra without tomli-w for .toml.
    """
    if not isinstance(table, Table):
        raise InputError(
            f"write: expected a dh.Table, got {safe_repr(table)}: dh.from_chain(chain).table makes one"
        )
    name = _path(path)
    text = _reader(name, os.path.splitext(name)[1], _WRITERS)(table)
    write_whole(path, text.encode())


def make_text(table: Table, ending: str) -> str:
    """A table as the text of a .toml or .csv file."""
    return _reader(ending, ending, _WRITERS)(table)


def _path(path: str | os.PathLike[str]) -> str:
    if not isinstance(path, (str, bytes, os.PathLike)):
        raise InputError(f"expected the path of a file, got {safe_repr(path)}")
    return os.fsdecode(path)


def _reader(name: str, ending: str, known: dict[str, Callable]) -> Callable:
    if ending.lower() not in known:
        raise InputError(
            f"{escape_unprintable(name, 400)}: expected a file ending in .toml or .csv"
        )
    return known[ending.lower()]


def _from_toml(text: str, place: str, stem: str) -> Table:
    data = toml_text.parse(text, place)
    _only(data, TOP, place)
    joints = data.get("joint", [])
    if not isinstance(joints, list) or not all(isinstance(joint, dict) for joint in joints):
        raise ModelError(f"{place}: expected [[joint]] tables")
    rows = [_row(joint, f"{place}: joint {i + 1}") for i, joint in enumerate(joints)]
    return _table(
        place,
        data.get("convention"),
        rows,
        data.get("base"),
        data.get("tool"),
        data.get("name", stem),
    )


def _row(joint: dict[str, Any], place: str) -> Row:
    _only(joint, FIELDS, place)
    for column in COLUMNS:
        if column not in joint:
            raise ModelError(f"{place}: {column} is missing; needed are {', '.join(COLUMNS)}")
        if not math.isfinite(_float(joint[column])):
            raise ModelError(
                f"{place}: {column}: expected a finite number, got {quote(joint[column])}"
            )
    limits = joint.get("limits", [-math.inf, math.inf])
    if (
        not isinstance(limits, list)
        or len(limits) != 2
        or any(map(math.isnan, map(_float, limits)))
    ):
        raise ModelError(f"{place}: limits: expected [lower, upper], got {quote(limits)}")
    if not isinstance(joint.get("flip", False), bool):
        raise ModelError(f"{place}: flip: expected true or false, got {quote(joint['flip'])}")
    if not isinstance(joint.get("name", ""), str):
        raise ModelError(f"{place}: name: expected a text, got {quote(joint['name'])}")
    numbers = {column: _float(joint[column]) for column in COLUMNS}
    return _checked(
        Row(**{**joint, **numbers, "limits": (_float(limits[0]), _float(limits[1]))}), place
    )


def _float(value: Any) -> float:
    """A number of TOML, NaN for all that is none, and for an integer that no float can hold."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return math.nan
    try:
        return float(value)
    except OverflowError:
        return math.nan


def _checked(row: Row, place: str) -> Row:
    """The row, if it can stand in a table: here the place of it is known."""
    if row.kind not in KINDS:
        raise ModelError(
            f"{place}: kind: expected 'revolute' or 'prismatic', got {quote(row.kind)}"
        )
    if not row.limits[0] <= row.limits[1]:
        raise ModelError(
            f"{place}: limits: expected lower <= upper, got {row.limits[0]} and {row.limits[1]}"
        )
    return row


def _from_csv(text: str, place: str, stem: str) -> Table:
    reader = csv.DictReader(io.StringIO(text), strict=True)
    rows: list[Row] = []
    poses: dict[str, Array] = {}
    convention = None
    try:
        header = list(reader.fieldnames or ())
        _only(dict.fromkeys(header), CSV_COLUMNS, f"{place}:1")
        for column, times in Counter(header).items():
            if times > 1:
                raise ModelError(
                    f"{place}:1: column {column} is there {times} times, expected once"
                )
        for column in ("convention", *COLUMNS):
            if column not in header:
                raise ModelError(
                    f"{place}:1: column {column} is missing; needed are convention, {', '.join(COLUMNS)}"
                )
        for record in reader:
            line = f"{place}:{reader.line_num}"
            if None in record or None in record.values():
                got = len(record.get(None, ())) + sum(
                    record[column] is not None for column in header
                )
                raise ModelError(
                    f"{line}: expected {len(header)} columns as in the header, got {got}"
                )
            kind = record.get("kind") or "revolute"
            posed = kind in ("base", "tool")
            if not (posed and not record["convention"]):  # of a pose it may be left out
                if convention not in (None, record["convention"]):
                    told_apart = f"{quote(record['convention'])} after {quote(convention)}"
                    raise ModelError(f"{line}: mixed conventions: {told_apart}")
                convention = record["convention"]
            if posed:
                if kind in poses:
                    raise ModelError(
                        f"{line}: a second row of the kind {kind}, expected one at most"
                    )
                poses[kind] = _pose(record.get("pose", ""), f"{line}: pose")
                continue
            theta, d, a, alpha = (
                _number(record[column], f"{line}: {column}") for column in COLUMNS
            )
            flip = {"": False, "false": False, "true": True}.get((record.get("flip") or "").lower())
            if flip is None:
                raise ModelError(
                    f"{line}: flip: expected true or false, got {quote(record['flip'])}"
                )
            bounds = [
                _number(record.get(side) or default, f"{line}: {side}", True)
                for side, default in _SIDES
            ]
            row = Row(
                theta, d, a, alpha, kind, flip, record.get("name") or "", (bounds[0], bounds[1])
            )
            rows.append(_checked(row, line))
    except csv.Error as fault:
        raise ModelError(f"{place}:{max(reader.line_num, 1)}: {fault}") from fault
    return _table(place, convention, rows, poses.get("base"), poses.get("tool"), stem)


_SIDES = (("lower", "-inf"), ("upper", "inf"))


def _number(text: str, place: str, infinite: bool = False) -> float:
    value = real(text.strip())
    if value is None or (not infinite and not math.isfinite(value)):
        raise ModelError(
            f"{place}: expected a {'' if infinite else 'finite '}number, got {quote(text)}"
        )
    return value


def _pose(text: str, place: str) -> Array:
    numbers = [_number(word, place) for word in text.split()]
    if len(numbers) != 12:
        raise ModelError(
            f"{place}: expected twelve numbers, a pose's first three rows, got {len(numbers)}"
        )
    return np.vstack([np.reshape(numbers, (3, 4)), [0, 0, 0, 1]])


def _only(data: dict[str, Any], known: tuple[str, ...], place: str) -> None:
    for key in data:
        if key not in known:
            raise ModelError(f"{place}: no such column: {quote(key)}; {suggest(str(key), known)}")


def _table(place: str, convention: Any, rows: list[Row], base: Any, tool: Any, name: str) -> Table:
    if convention not in CONVENTIONS:
        raise ModelError(
            f"{place}: convention: expected 'standard' or 'modified', got {quote(convention)}"
        )
    try:
        return Table(convention, rows, base=base, tool=tool, name=name)
    except PoekinError as fault:
        raise ModelError(f"{place}: {fault}") from fault


def _to_toml(table: Table) -> str:
    data: dict[str, Any] = {"convention": table.convention, "name": table.name}
    data |= {
        key: T.tolist()
        for key, T in (("base", table.base), ("tool", table.tool))
        if (np.eye(4) != T).any()
    }
    data["joint"] = [
        {
            "name": r.name,
            "kind": r.kind,
            **{column: getattr(r, column) for column in COLUMNS},
            "flip": r.flip,
        }
        | ({} if r.limits == (-math.inf, math.inf) else {"limits": list(r.limits)})
        for r in table.rows
    ]
    return toml_text.make_text(data)


def _to_csv(table: Table) -> str:
    out = io.StringIO()
    writer: csv.DictWriter[str] = csv.DictWriter(out, CSV_COLUMNS, restval="", lineterminator="\n")
    writer.writeheader()
    for kind, T in (("base", table.base), ("tool", table.tool)):
        if (np.eye(4) != T).any():
            pose = " ".join(map(repr, T[:3].ravel().tolist()))
            writer.writerow({"convention": table.convention, "kind": kind, "pose": pose})
    for r in table.rows:
        numbers = {column: repr(getattr(r, column)) for column in COLUMNS}
        lower, upper = map(repr, r.limits)
        rest = {
            "name": r.name,
            "kind": r.kind,
            "flip": str(r.flip).lower(),
            "lower": lower,
            "upper": upper,
        }
        writer.writerow({"convention": table.convention, **numbers, **rest})
    return out.getvalue()


_WRITERS: dict[str, Callable] = {".toml": _to_toml, ".csv": _to_csv}
