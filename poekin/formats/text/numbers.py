"""Numbers in text: one rule for URDF files, CSV files and the command line."""

from __future__ import annotations

from collections.abc import Iterable

from ...errors import InputError, quote


def real(text: str) -> float | None:
    """The number that a text says, nan and inf among them, or None where it says none.

    Blanks around it are passed over. 1_000 and digits of other scripts, which Python would take,
    are no numbers: no other reader of such files takes them.
    """
    if "_" in text or not text.isascii():
        return None
    try:
        return float(text)
    except ValueError:
        return None


def expected(text: str, place: str) -> float:
    """The number that a text is. Raises: InputError where it is none."""
    value = real(text)
    if value is None:
        raise InputError(f"{place}: a number expected, got {quote(text)}")
    return value


def shortest(values: Iterable[float]) -> str:
    """Numbers apart by blanks, each in the shortest form that reads back as the same float."""
    return " ".join(repr(float(x) + 0.0).removesuffix(".0") for x in values)
