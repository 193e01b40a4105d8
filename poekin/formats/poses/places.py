"""Lines of a text at which something begins, for messages."""

from __future__ import annotations

import bisect
from collections.abc import Iterable


def places(text: str, starts: Iterable[int], where: str) -> list[str]:
    """The file and line, `where:line`, of each position in a text."""
    breaks = [at for at, letter in enumerate(text) if letter == "\n"]
    return [f"{where}:{bisect.bisect_left(breaks, start) + 1}" for start in starts]
