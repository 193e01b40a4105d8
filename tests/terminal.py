"""A stream that is a terminal."""

from __future__ import annotations

import io


class Terminal(io.StringIO):
    """What is written, and what of it is on the screen."""

    seen = ""

    def isatty(self) -> bool:
        return True

    def flush(self) -> None:
        self.seen = self.getvalue()
