"""Warnings of a command: lines on stderr, each text once."""

from __future__ import annotations

import warnings

from poekin.cli import commands
from poekin.errors import PoekinWarning


def test_a_warning_is_said_once_however_often_it_comes_up(poekin, monkeypatch):
    def command(**_: object) -> None:
        for text in ("first", "second", "first"):
            warnings.warn(text, PoekinWarning, stacklevel=1)

    monkeypatch.setattr(commands, "command", command)
    assert poekin("fk") == (0, "", "poekin: warning: first\npoekin: warning: second\n")
    assert poekin("fk")[2].count("first") == 1  # by the next command once more
