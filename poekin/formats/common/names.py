"""Names that nothing else has."""

from __future__ import annotations


def free_name(name: str, taken: set[str]) -> str:
    """Name that is not taken yet, with underscores behind it; it is taken from now on."""
    while name in taken:
        name += "_"
    taken.add(name)
    return name
