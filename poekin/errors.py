"""The one error tree: every error that poekin raises on purpose is a `PoekinError`.

A message says what was expected, what arrived, where (file and line, batch element, joint name) and
what is available.
"""

from __future__ import annotations

import difflib
import math
from collections.abc import Iterable


class PoekinError(Exception):
    """Base of all errors raised by poekin."""


class InputError(PoekinError, ValueError):
    """A value that cannot be used: wrong number, wrong type, wrong property."""


class ShapeError(InputError):
    """An array of the wrong shape."""


class ScrewError(InputError):
    """Six numbers that are no screw of a joint."""


class PoseError(InputError):
    """A matrix that is no rotation or no pose."""


class BranchError(InputError):
    """A logarithm was asked for on a branch that does not exist."""


class ModelError(PoekinError, ValueError):
    """A robot description that cannot be understood; says file and line where there is one."""


class UnknownName(PoekinError, KeyError):
    """A name of a link, joint, coordinate or model that does not exist; lists the closest ones."""

    def __str__(self) -> str:
        # KeyError shows the repr of its argument, which would put the whole message in quotes.
        return str(self.args[0]) if self.args else ""


class FileError(PoekinError, OSError):
    """A file that cannot be read or written."""


class MissingExtra(PoekinError, ImportError):
    """An optional package is not installed; names the extra that brings it."""

    def __init__(self, package: str, extra: str, purpose: str) -> None:
        super().__init__(f"{purpose} needs the package {package}: pip install 'poekin[{extra}]'")
        self.package = package
        self.extra = extra
        self.purpose = purpose

    def __reduce__(self) -> tuple[object, ...]:
        return type(self), (self.package, self.extra, self.purpose)


class PoekinWarning(UserWarning):
    """Something in the input was repaired or ignored; says what and where."""


def escape_unprintable(
    text: object,
    width: int | None = None,
    keep: str = "",
) -> str:
    """Text whose unprintable characters are escaped, except those in `keep`, cut at `width`."""

    def shown(c: str) -> str:
        if c.isprintable() or c in keep:
            return c
        return c.encode("unicode_escape").decode()

    most = None if width is None else width + 1  # a character is shown as one at least
    plain = "".join(map(shown, str(text)[:most]))
    if width is None or len(plain) <= width:
        return plain
    return plain[: width - 1] + "…"


def quote(name: object, width: int = 80) -> str:
    """Name in single quotes, its unprintable characters escaped once."""
    return f"'{escape_unprintable(name, width)}'"


def safe_repr(value: object) -> str:
    """`repr` of a value, its unprintable characters escaped, cut at 80."""
    return escape_unprintable(repr(value), 80)


def show_numbers(values: Iterable[float]) -> str:
    """Numbers to six digits in brackets; what is rounding beside the largest of them is 0."""
    row = [float(x) for x in values]
    sizes = (abs(x) for x in row if math.isfinite(x))
    small = 1e-12 * max(sizes, default=0.0)
    shown = [0.0 if abs(x) <= small else float(f"{x:.6g}") for x in row]
    return str(shown)


def join_names(names: Iterable[object], most: int = 12) -> str:
    """First `most` names, quoted and joined by commas, and the number of the others."""
    every = list(names)
    listed = ", ".join(map(quote, every[:most]))
    if len(every) <= most:
        return listed
    return f"{listed} and {len(every) - most} more"


def close_names(
    name: object,
    available: Iterable[str],
    most: int = 5,
) -> list[str]:
    """Available names closest to a name, or those alone that differ from it in case only."""
    asked = str(name).casefold()
    spelled: dict[str, list[str]] = {}
    # difflib takes time as the square of a name's length, for each name: of long names only the
    # first are looked at.
    for known in list(available)[: 2_000_000 // max(len(asked), 1) ** 2]:
        spelled.setdefault(known.casefold(), []).append(known)
    near = difflib.get_close_matches(asked, spelled, n=most, cutoff=0.6)
    if asked in spelled:
        near = [asked]
    found = [known for folded in near for known in spelled[folded]]
    return found[:most]


def suggest(
    name: object,
    available: Iterable[str],
    most: int = 5,
) -> str:
    """End of a message about an unknown name: the available names closest to it."""
    names = list(available)
    if not names:
        return "there are none"
    close = close_names(name, names, most)
    if close:
        meant = " or ".join(map(quote, close))
        return f"did you mean {meant}?"
    return "available: " + join_names(names, most)
