"""Names of a subject's own that mean nothing to a law: they are said, so that none is dropped
silently.
"""

from __future__ import annotations

import difflib
import inspect
from collections.abc import Sequence
from typing import Any

from ....errors import join_names, quote


def misspelt(own: Any, known: Sequence[str]) -> list[str]:
    """Remarks on the public names of a subject that are not known.

    Parameters: own, the subject; known, all names that mean something. Returns: a sentence for each
    name that looks like a known one, and one for all other functions.
    """
    meant = {name: _meant(name, known) for name in _public(own) if name not in known}
    notes = [
        f"{quote(name)} is no name of a subject's; did you mean {quote(other)}?"
        for name, other in meant.items()
        if other
    ]
    others = [name for name, other in meant.items() if not other and _callable(own, name)]
    if others:
        notes.append(f"no function of a subject's, and held to nothing: {join_names(others)}")
    return notes


def _public(own: Any) -> list[str]:
    """Names that the subject and its classes have, without asking for their values."""
    names: dict[str, None] = {}
    for holder in (own, *type(own).__mro__):
        if holder is not object:
            names |= dict.fromkeys(getattr(holder, "__dict__", {}))
    return [name for name in names if not name.startswith("_")]


def _meant(name: str, known: Sequence[str]) -> str:
    """The known name that one looks like: with other capitals or underscores, its words in another
    order, or a slip.
    """
    plain = {_words(other): other for other in known}
    if _words(name) in plain:
        return plain[_words(name)]
    bare = {other.replace("_", ""): other for other in known}
    asked = name.lower().replace("_", "")
    close = difflib.get_close_matches(asked, bare, n=1, cutoff=0.8)
    return bare.get("".join(close), "")


def _words(name: str) -> str:
    return "_".join(sorted(name.lower().split("_")))


def _callable(own: Any, name: str) -> bool:
    value = inspect.getattr_static(own, name)
    return callable(value) or isinstance(value, staticmethod | classmethod)
