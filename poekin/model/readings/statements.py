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
_NUMBER = re.compile(r"\s*((?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)")
_QUOTED = re.compile(r"\s*(['\"])(?P<name>.*?)\1", re.DOTALL)
_NEXT = re.compile(r"\s*('[^']*'|\"[^\"]*\"|\w+|.|)", re.DOTALL)
_EQUALS, _SIGN, _OVER, _TIMES = map(re.compile, (r"\s*(=)", r"\s*([+-])", r"\s*(/)", r"\s*(\*)"))
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
        longest_first = sorted(self.numbers, key=len, reverse=True)
        ends = (re.escape(name) + r"(?!\w)" * _is_word(name[-1]) for name in longest_first)
        self.known = re.compile(rf"\s*(?P<name>{'|'.join(ends)})")
        self.at = 0

    def parsed(self) -> tuple[int, Array]:
        """Number of the joint, and its row (m,) of K."""
        k = self._name("the name of a joint")
        if not self._taken(_EQUALS):
            raise self._fault("'=' after the name of a joint")
        row = np.zeros(len(self.names))
        sign = self._taken(_SIGN)
        while True:
            factor = float(f"{sign}1") * self._factor()
            row[self._name("the name of a reading")] += factor
            if not self._next():
                break
            sign = self._taken(_SIGN)
            if not sign:
                raise self._fault("'+' or '-' between readings")
        if not np.isfinite(row).all():
            raise InputError(f"coupling: {quote(self.text)} has numbers that are not finite")
        return k, row

    def _taken(self, pattern: re.Pattern[str]) -> str:
        """Text that fits, blanks before it apart, which is taken in; "" where none does."""
        found = pattern.match(self.text, self.at)
        if found is None:
            return ""
        self.at = found.end()
        return found[1]

    def _factor(self) -> float:
        """The number before a name, 1 where there is none."""
        if self.known.match(self.text, self.at):
            return 1.0
        number = self._taken(_NUMBER)
        if not number:
            return 1.0
        factor = float(number)
        if self._taken(_OVER):
            divisor = float(self._taken(_NUMBER) or 0.0)
            if not divisor:
                raise self._fault("a number other than 0 after '/'")
            factor /= divisor
        self._taken(_TIMES)
        return factor

    def _name(self, expected: str) -> int:
        """Number of the name that stands here."""
        found = _QUOTED.match(self.text, self.at) or self.known.match(self.text, self.at)
        name = found["name"] if found else ""
        if found is None or name not in self.numbers:
            raise self._fault(expected, f"; {suggest(name or self._next(), self.names)}")
        self.at = found.end()
        return self.numbers[name]

    def _next(self) -> str:
        """Name, number or mark that stands here, "" at the end."""
        found = _NEXT.match(self.text, self.at)
        return found[1] if found else ""

    def _fault(self, expected: str, hint: str = "") -> InputError:
        got = quote(self._next(), 40) if self._next() else "nothing"
        if "=" not in self.text:
            hint += "; a statement is a joint as a sum of readings, as in 'J3 = J2 + J3'"
        return InputError(f"coupling: {quote(self.text)}: expected {expected}, got {got}{hint}")


def _is_word(character: str) -> bool:
    return character == "_" or character.isalnum()
