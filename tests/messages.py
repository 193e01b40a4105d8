"""Whole messages, compared word by word."""

from __future__ import annotations


def says(fault: Exception, message: str) -> bool:
    """Whether this is the whole message, or its beginning up to `...`: the rest is another
    library's.
    """
    return str(fault).startswith(message[:-3]) if message.endswith("...") else str(fault) == message
