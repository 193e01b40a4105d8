"""Examples in docstrings: each runs alone, in a directory of its own, and prints what it says."""

from __future__ import annotations

import doctest
import inspect
from pathlib import Path

import pytest

from tools import docs_names

OPTIONS = doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS
FEWEST = 100


def examples() -> dict[str, doctest.DocTest]:
    """The examples of each public name that has some; without the globals of its module."""
    found = {}
    parser = doctest.DocTestParser()
    for name in docs_names.documented():
        text = inspect.getdoc(docs_names.resolved(name)) or ""
        test = parser.get_doctest(text, {}, name, None, None)
        if test.examples:
            found[name] = test
    return found


EXAMPLES = examples()


def failures(test: doctest.DocTest) -> str:
    """The report of the examples that fail."""
    said: list[str] = []
    doctest.DocTestRunner(optionflags=OPTIONS).run(test, out=said.append, clear_globs=False)
    return "".join(said)


@pytest.mark.parametrize("name", EXAMPLES)
def test_an_example_prints_what_it_says(name, tmp_path: Path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert failures(EXAMPLES[name]) == ""


def test_there_are_examples():
    assert len(EXAMPLES) >= FEWEST


@pytest.mark.parametrize("text", [">>> 1 + 1\n3", ">>> np.pi\n3.14..."])
def test_an_example_that_fails_is_caught(text):
    test = doctest.DocTestParser().get_doctest(text, {}, "planted", None, None)
    assert "Failed example" in failures(test)
