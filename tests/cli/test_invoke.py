"""What is said of a command that warns, or whose arguments are refused: each thing once."""

from __future__ import annotations

import warnings
from typing import Any

import pytest
import typer

from poekin.cli import commands
from poekin.errors import PoekinWarning


def test_a_warning_is_said_once_however_often_it_comes_up(poekin, monkeypatch):
    def command(**_: object) -> None:
        for text in ("first", "second", "first"):
            warnings.warn(text, PoekinWarning, stacklevel=1)

    monkeypatch.setattr(commands, "command", command)
    assert poekin("fk") == (0, "", "poekin: warning: first\npoekin: warning: second\n")
    assert poekin("fk")[2].count("first") == 1  # by the next command once more


def test_the_help_of_an_option_follows_where_it_is_missing_and_not_where_its_value_is_wrong(
    refused,
):
    app: Any = commands.command
    helps = {
        parameter.name: parameter.help
        for name in ("conform", "jacobian")
        for parameter in app.commands[name].params
    }
    wrong = refused("conform", "module:Class", "--seconds", "soon")
    assert "--seconds" in wrong
    assert helps["seconds"] not in wrong
    assert helps["frame"] in refused("jacobian", "ur5e")


@pytest.mark.parametrize(
    ("end", "code"),
    [(typer.Abort(), 130), (KeyboardInterrupt(), 130), (SystemExit(1), 141)],
    ids=repr,
)
def test_an_end_that_is_no_error_is_an_exit_code_of_its_own(poekin, monkeypatch, end, code):
    def command(**_: object) -> None:
        raise end

    monkeypatch.setattr(commands, "command", command)
    assert poekin("fk") == (code, "", "")


NAMES = [module.__name__.rpartition(".")[2].replace("_", "-") for module in commands.COMMANDS]


@pytest.mark.parametrize("name", sorted({*NAMES} - {"fk", "jacobian", "singularity", "ik"}))
def test_an_option_that_there_is_not_is_said_by_its_name_where_no_number_is_taken(name, refused):
    said = refused(name, "a", "b", "--nonsense", "0.5")
    assert "--nonsense" in said
    assert "extra argument" not in said
