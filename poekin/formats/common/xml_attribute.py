"""Names as attributes of XML."""

from __future__ import annotations

import re

from ...errors import InputError, quote

# What XML 1.0 can hold at all; and what of that could disappear, break the markup, or be obeyed by
# a terminal.
_IMPOSSIBLE = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_MARKUP = '&<>"'


def quote_attribute(name: str, what: str) -> str:
    """Name as the value of an attribute; markup and unprintable characters by their numbers."""
    bad = _IMPOSSIBLE.search(name)
    if bad:
        raise InputError(
            f"{what} {quote(name)}: XML cannot hold the character U+{ord(bad[0]):04X} of its name"
        )
    escaped = "".join(map(_escaped, name))
    return f'"{escaped}"'


def _escaped(c: str) -> str:
    if c.isprintable() and c not in _MARKUP:
        return c
    return f"&#{ord(c)};"
