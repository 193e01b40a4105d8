"""Names of modules and of tests by room and stem, which a file keeps wherever it moves in its room.

`model/hp` is the one hp.py below poekin/model, and of tests the one test_hp.py below tests/model;
`cli/__init__` is that of poekin/cli itself.
Folders in between tell files of one stem apart: `testing/conform/search`. A slash at the end makes
it a folder: `formats/dh/`.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path, PurePosixPath

from .mutants import PACKAGE

ROOT = Path(__file__).resolve().parents[2]
OWN = "own"  # among the tests of a module: those of its name


@cache
def module(name: str) -> str:
    """The path of a module or a folder of modules; ValueError unless exactly one has the name."""
    return _only(PACKAGE, name, f"{name}.py")


@cache
def test(name: str) -> str:
    """The path of a file or a folder of tests; ValueError unless exactly one has the name."""
    path = PurePosixPath(name)
    return _only("tests", name, str(path.with_name(f"test_{path.name}.py")))


def _only(top: str, name: str, file: str) -> str:
    parts = (name[:-1] if name.endswith("/") else file).split("/")
    between = "/(?:.*/)?".join(map(re.escape, parts)).replace("(?:.*/)?__init__", "__init__")
    pattern = re.compile(f"{top}/{between}")
    found = [path for path in _listed(ROOT, top) if pattern.fullmatch(path)]
    if len(found) != 1:
        places = ", ".join(found) or "none"
        raise ValueError(f"{name} has to be one place below {top}/, and is {places}")
    return found[0]


@cache
def _listed(root: Path, top: str) -> list[str]:
    """All files and folders below one of the root's."""
    return sorted(path.relative_to(root).as_posix() for path in (root / top).rglob("*"))


def argument(word: str) -> str:
    """The argument of pytest for a name, with an option before it, or with one test after it."""
    option, equals, rest = word.rpartition("=")
    name, colons, one = rest.partition("::")
    return f"{option}{equals}{test(name)}{colons}{one}"


def among(names: str, path: str) -> bool:
    """Whether a module is among those named, or in one of the folders."""
    return any(_within(module(name), path) for name in names.split())


def longest(table: Mapping[str, str], path: str, called_like: Iterable[str] = ()) -> list[str]:
    """Arguments of pytest for a module, by the entry of a table whose path is the longest.

    In a folder's entry `own` stands for the files that are called like the module, then the folder.
    """
    rows = [(name, tests) for names, tests in table.items() for name in names.split()]
    fitting = [row for row in rows if _within(module(row[0]), path)]
    if not fitting:
        return []
    own, tests = max(fitting, key=lambda row: len(module(row[0])))
    found: list[str] = []
    for word in tests.split():
        if word == OWN and own.endswith("/"):
            found += called_like
        found.append(argument(own if word == OWN else word))
    return list(dict.fromkeys(found))


def _within(place: str, path: str) -> bool:
    return f"{path}/".startswith(f"{place}/")
