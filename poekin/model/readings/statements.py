"""Statements such as "J3 = J2 + J3": the value of a joint as a sum of readings.

    statement = name "=" ["+" | "-"] term {("+" | "-") term}
    term = [number ["/" number] ["*"]] name

A name stands as it is, the longest that fits, or in quotes; J1, J2, ... and q1, q2, ... are the
coordinates in their order where nothing has such a name. Nothing else is understood: no constants,
no brackets, no products of names.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

import numpy as np

from ...errors import InputError, quote, safe_repr, suggest
from ...groups.arrays import Array

Statements = str | Sequence[str]
"""One statement, or several."""

LONGEST = 10_000
"""Characters of the longest statement."""
MOST = 1000
"""Coordinates of the largest robot whose readings may be coupled."""
SINGULAR = 1e-9
"""Least singular value, of the largest, of readings that determine the joints."""
_NUMBER = re.compile(r"(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_BLANKS = re.compile(r"\s*")
_NEXT = re.compile(r"'[^']*'|\"[^\"]*\"|\w+|.", re.DOTALL)
_PLAIN = re.compile(r"[^\W\d]\w*")


def parse_statements(given: Any, names: Sequence[str]) -> Array:
    """Matrix K (m, m) of x = K r by one statement or several; a joint without one has its own
    reading.

    Raises: InputError for what is no such statement, a name that is unknown or is said twice, and
    readings that do not determine the joints.
    """
    statements = [given] if isinstance(given, str) else given
    if not isinstance(statements, (list, tuple)):
        raise InputError(
            f"coupling: expected statements such as 'J3 = J2 + J3', got {safe_repr(given)}"
        )
    if len(names) > MOST:
        raise InputError(f"coupling: expected at most {MOST} coordinates, got {len(names)}")
    K = np.eye(len(names))
    said: set[int] = set()
    for statement in statements:
        k, row = _Statement(statement, names).parsed()
        if k in said:
            raise InputError(f"coupling: {quote(names[k])} is said twice")
        said.add(k)
        K[k] = row
    values = np.linalg.svd(K, compute_uv=False)
    if values.min(initial=np.inf) <= SINGULAR * values.max(initial=0.0):
        raise InputError(
            f"coupling: {quote('; '.join(statements))}: different readings give the same values of "
            "the joints, the matrix is singular"
        )
    return K


def make_statements(K: Array | None, names: Sequence[str]) -> tuple[str, ...]:
    """Statements of a matrix K (m, m), one for each joint that is not its own reading alone."""
    if K is None:
        return ()
    return tuple(filter(None, _by_joint(K, names)))


def canonical(given: Any, names: Sequence[str]) -> tuple[str, ...]:
    """Statements in the order of the joints and without what is not needed. Raises: as
    `parse_statements`.
    """
    return tuple(filter(None, statements_by_joint(given, names)))


def statements_by_joint(given: Any, names: Sequence[str]) -> list[str]:
    """Statement of each joint, "" where it is its own reading alone. Raises: as
    `parse_statements`.
    """
    if isinstance(given, (list, tuple)) and not given:
        return [""] * len(names)
    return _by_joint(parse_statements(given, names), names)


def _by_joint(K: Array, names: Sequence[str]) -> list[str]:
    statements = []
    for k, row in enumerate(K):
        text = ""
        if row[k] != 1.0 or np.count_nonzero(row) != 1:
            text = f"{_shown(names[k])} ="
            for j in np.flatnonzero(row).tolist():
                text += _term(float(row[j]), names[j], first=text.endswith("="))
        statements.append(text)
    return statements


def _term(factor: float, name: str, *, first: bool) -> str:
    sign = " - " if factor < 0 else " + "
    if first:
        sign = " -" if factor < 0 else " "
    number = "" if abs(factor) == 1.0 else f"{abs(factor)!r} "
    return sign + number + _shown(name)


def _shown(name: str) -> str:
    """A name as a statement has it: in quotes where it could be taken for anything else."""
    if _PLAIN.fullmatch(name):
        return name
    for mark in "'\"":
        if mark not in name:
            return mark + name + mark
    raise InputError(f"coupling: {quote(name)} has quotes of both kinds and cannot be written")


class _Statement:
    """One statement, taken in from left to right."""

    def __init__(self, text: Any, names: Sequence[str]) -> None:
        if not isinstance(text, str):
            raise InputError(f"coupling: expected a text, got {safe_repr(text)}")
        if len(text) > LONGEST:
            raise InputError(f"coupling: expected at most {LONGEST} characters, got {len(text)}")
        self.text = text
        self.names = names
        self.numbers = {f"{letter}{k + 1}": k for letter in "Jq" for k in range(len(names))}
        self.numbers |= {name: k for k, name in enumerate(names)}
        self.longest_first = sorted(self.numbers, key=len, reverse=True)
        self.at = 0

    def parsed(self) -> tuple[int, Array]:
        """Number of the joint, and its row (m,) of K."""
        k = self._name("the name of a joint")
        if not self._taken("="):
            raise self._fault("'=' after the name of a joint")
        row = np.zeros(len(self.names))
        sign = self._sign()
        while True:
            factor = self._factor()
            row[self._name("the name of a reading")] += (sign or 1.0) * factor
            if not self._rest():
                break
            sign = self._sign()
            if sign is None:
                raise self._fault("'+' or '-' between readings")
        if not np.isfinite(row).all():
            raise InputError(f"coupling: {quote(self.text)} has numbers that are not finite")
        return k, row

    def _rest(self) -> str:
        """Rest of the text, without blanks before it."""
        blanks = _BLANKS.match(self.text, self.at)
        if blanks is not None:
            self.at = blanks.end()
        return self.text[self.at :]

    def _taken(self, mark: str) -> bool:
        there = self._rest().startswith(mark)
        self.at += there
        return there

    def _sign(self) -> float | None:
        if self._taken("+"):
            return 1.0
        return -1.0 if self._taken("-") else None

    def _factor(self) -> float:
        """The number before a name, 1 where there is none."""
        if self._known() is not None:
            return 1.0
        factor = self._number()
        if factor is None:
            return 1.0
        if self._taken("/"):
            divisor = self._number()
            if not divisor:
                raise self._fault("a number other than 0 after '/'")
            factor /= divisor
        self._taken("*")
        return factor

    def _number(self) -> float | None:
        self._rest()
        found = _NUMBER.match(self.text, self.at)
        if found is None:
            return None
        self.at = found.end()
        return float(found[0])

    def _known(self) -> str | None:
        """The name that stands here, without quotes."""
        rest = self._rest()
        for name in self.longest_first:
            if rest.startswith(name):
                behind = rest[len(name) : len(name) + 1]
                if not (_word(name[-1]) and _word(behind)):
                    return name
        return None

    def _name(self, expected: str) -> int:
        """Number of the name that stands here."""
        rest = self._rest()
        mark = rest[:1]
        if mark in ("'", '"') and mark in rest[1:]:
            name = rest[1:].partition(mark)[0]
            length = len(name) + 2
        else:
            name = self._known() or ""
            length = len(name)
        if name not in self.numbers:
            found = _NEXT.match(rest)
            asked = name or (found[0] if found else "")
            raise self._fault(expected, f"; {suggest(asked, self.names)}")
        self.at += length
        return self.numbers[name]

    def _fault(self, expected: str, hint: str = "") -> InputError:
        found = _NEXT.match(self._rest())
        got = "nothing"
        if found is not None:
            got = quote(found[0], 40)
        return InputError(f"coupling: {quote(self.text)}: expected {expected}, got {got}{hint}")


def _word(character: str) -> bool:
    return character == "_" or character.isalnum()
