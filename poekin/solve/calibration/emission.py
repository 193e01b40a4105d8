"""Non-geometric terms of a calibration as code: traced from the formulas that it was fitted with."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal, NamedTuple, get_args

import numpy as np

from ...checks import choice
from ...engine.straight_line.program import Angles, Program, program
from ...engine.straight_line.trace import Graph
from ...errors import InputError, escape_unprintable
from ...formats.emit.c import CSource
from ...formats.emit.correction.c_text import c_text
from ...formats.emit.correction.correction import Correction
from ...formats.emit.correction.python_text import python_text
from ...formats.emit.messages import identifier, quote_ascii
from ...groups.arrays import Array
from ...groups.vectors import normalised
from .compensation import true_joints
from .result import CalibrationData
from .terms.conditions import at_rest, drift_source
from .terms.scalars import Scalars
from .terms.term import Formula, Term

Language = Literal["c", "python"]
_VECTORS = 8  # readings that the self-test has
_UNITS = {"payload": "kg", "temperature": "K", "time": "s"}


def emit(found: CalibrationData, language: Language, name: str, origin: str) -> str | CSource:
    """See `Calibration.emit`."""
    choice(language, get_args(Language), "language")
    word = identifier(name)
    made = correction(found)
    if language == "c":
        return c_text(made, word, origin)
    return python_text(made, origin)


class Column(NamedTuple):
    """A condition that the terms read: its name, and words on each of its numbers."""

    name: str
    words: tuple[str, ...]


def correction(found: CalibrationData) -> Correction:
    """Correction of a calibration. Raises: InputError without terms, or with one that is a user's own."""
    terms = found.error_model.terms
    if not terms:
        raise InputError(
            "emit: there are no non-geometric terms, and the calibrated chain takes the readings:"
            " pk.emit.c(found.chain, ...) writes it"
        )
    columns = _columns(found)
    rng = np.random.default_rng(1994)
    q = found.nominal.random(rng, _VECTORS)
    conditions = {column.name: _example(column, found, rng) for column in columns}
    given = [np.reshape(values, (_VECTORS, -1)) for values in conditions.values()]
    return Correction(
        found.nominal,
        _traced(found, columns),
        tuple(words for column in columns for words in column.words),
        tuple(dict.fromkeys(term.name for term in terms)),
        q,
        np.concatenate([np.empty((_VECTORS, 0)), *given], axis=1),
        true_joints(found, q, conditions),
    )


def _columns(found: CalibrationData) -> list[Column]:
    """The conditions that the terms read."""
    reference = found.error_model.reference
    names = {term.name for term in found.error_model.terms}
    quoted = [quote_ascii(name) for name in found.nominal.q_names]
    columns = []
    if "compliance" in names and "payload" in reference:
        columns.append(_measured("payload", reference["payload"]))
    if "compliance" in names and "gravity" in reference:
        axes = zip("xyz", reference["gravity"], strict=True)
        words = (f"gravity, a unit vector in the base frame, {axis}; {x:.6g}" for axis, x in axes)
        columns.append(Column("gravity", tuple(words)))
    if "backlash" in names:
        words = (f"sign of the last move of {name}; 0 where it is not known" for name in quoted)
        columns.append(Column("approach", tuple(words)))
    if "lag" in names:
        words = (f"reading of {name} before the last move; its q at rest" for name in quoted)
        columns.append(Column("previous", tuple(words)))
    source = drift_source(reference)
    if "drift" in names and source is not None:
        columns.append(_measured(source, reference[source]))
    return columns


def _measured(name: str, mean: float) -> Column:
    return Column(name, (f"{name}, {_UNITS[name]}; {mean:.6g}",))


def _example(column: Column, found: CalibrationData, rng: np.random.Generator) -> Array:
    """Values of a condition to test with."""
    if column.name == "previous":
        return found.nominal.random(rng, _VECTORS)
    size = _VECTORS if len(column.words) == 1 else (_VECTORS, len(column.words))
    values = rng.normal(size=size)
    if column.name == "approach":
        return np.sign(values)
    if column.name == "gravity":
        return normalised(values)
    return found.error_model.reference[column.name] + values


def _traced(found: CalibrationData, columns: Sequence[Column]) -> Program:
    """Program from q (m) and the conditions to q + B(q) c / (1 + g)."""
    model = found.error_model
    dof = found.nominal.dof
    graph = Graph()
    angles = Angles(graph)
    q = [graph.input(-1 - k) for k in range(dof)]
    rest = at_rest(np.zeros((1, dof)), model.reference)
    given: dict[str, list[Any]] = {
        "payload": rest.payload.tolist(),
        "gravity": rest.gravity[0].tolist(),
        "approach": rest.approach[0].tolist(),
        "previous": q,
    }
    first = dof
    for column in columns:
        behind = first + len(column.words)
        given[column.name] = [graph.input(-1 - k) for k in range(first, behind)]
        first = behind
    source = drift_source(model.reference)
    drift: Any = 0.0
    if source is not None and source in given:
        drift = given[source][0] - model.reference[source]
    x = Scalars(
        q,
        given["payload"][0],
        given["gravity"],
        given["approach"],
        given["previous"],
        drift,
        lambda factors, offset: angles.sine_cosine(factors, offset, 0),
    )
    outputs: list[Any] = list(q)
    p = found.values[: len(model.parameters)]
    gains = model.errors(p).gains.tolist()
    first = len(p) - sum(len(term.parameters) for term in model.terms)
    for term in model.terms:
        behind = first + len(term.parameters)
        owners, columns_of = _formula(term)
        own = p[first:behind].tolist()
        values = zip(owners.tolist(), columns_of(x), own, strict=True)
        for owner, value, c in values:
            outputs[owner] = outputs[owner] + c / (1.0 + gains[owner]) * value
        first = behind
    return program(graph, angles, outputs)


def _formula(term: Term) -> Formula:
    """Formula of a term. Raises: InputError."""
    if term.formula is None:
        raise InputError(
            f"emit: the term '{escape_unprintable(term.name, 60)}' is a function of arrays, of which no"
            " code can be written; poekin's own terms are formulas"
        )
    return term.formula
