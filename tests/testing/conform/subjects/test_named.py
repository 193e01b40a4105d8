"""Subjects by name: what is misspelt is said with what may have been meant; what is printed can be
pasted.
"""

from __future__ import annotations

import contextlib
import io
import json
import sys
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
import pytest

from benchmarks.subjects import Poekin
from poekin.errors import InputError
from poekin.testing.conform import Subject, conform, loaded
from poekin.testing.conform.laws.law import typed
from poekin.testing.conform.subjects import named

MODULE = """
import numpy as np

class Given:
    def so3_exp(self, w):
        return np.eye(3)

class Outer:
    class Inner(Given):
        pass

class Scaled(Given):
    def __init__(self, factor):
        self.factor = factor
    def so3_exp(self, w):
        return self.factor * np.eye(3)

def made():
    return type("Made", (Given,), {"__module__": __name__})

Alias, instance, number = made(), Scaled(2.0), 3
"""


@pytest.fixture
def somebodys(tmp_path, monkeypatch):
    (tmp_path / "somebodys.py").write_text(MODULE, encoding="utf-8")
    monkeypatch.syspath_prepend(tmp_path)
    yield tmp_path
    sys.modules.pop("somebodys", None)


def test_a_subject_is_found_by_its_name(somebodys):
    assert loaded("benchmarks.subjects:Poekin") is Poekin
    assert loaded("somebodys:Outer.Inner").__name__ == "Inner"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("somebodys", r"expected MODULE:CLASS, such as my_arm:Kinematics, got 'somebodys'"),
        ("somebodys:", r"expected MODULE:CLASS, such as"),
        (":Given", r"expected MODULE:CLASS, such as"),
        ("somebodys.Given", r"expected MODULE:CLASS, such as"),
        (
            "somebodys.py:Given",
            r"as Python imports it from this directory, such as somebodys:Given; got 'somebodys.py:",
        ),
        ("./somebodys.py:Given", r"such as somebodys:Given; got"),
        ("src/somebodys.py:Given", r"such as src.somebodys:Given; got"),
        ("somebodys::Given", r"such as somebodys:Given; got"),
        ("somebodys: Given", r"such as somebodys:Given; got"),
        ("..somebodys:Given", r"such as .*:Given; got"),
        (
            "nowhere:X",
            r"^the module 'nowhere' cannot be imported: ModuleNotFoundError: No module named 'nowhere'$",
        ),
        (
            "somebodys:given",
            r"'somebodys' \('.*somebodys.py'\) has no 'given'; of its classes: did you mean 'Given'",
        ),
        ("somebodys:number.Inner", r"has no 'number.Inner'; of its classes: there are none"),
    ],
    ids=lambda x: x if ":" in x or "." in x[:12] else None,
)
def test_a_name_that_cannot_be_used_is_refused_with_what_may_have_been_meant(
    somebodys, text, words
):
    with pytest.raises(InputError, match=words):
        loaded(text)


@pytest.mark.parametrize(
    ("source", "words"),
    [
        ("def f(:", r"SyntaxError: invalid syntax \(fails.py, line 1\)"),
        ("import nowhere_at_all", r"No module named 'nowhere_at_all' \(fails.py, line 1\)"),
        ("\n\ndef f():\n    raise KeyError('x')\nf()", r"KeyError: 'x' \(fails.py, line 4\)"),
        ("import sys\nsys.exit()", r"cannot be imported: SystemExit \(fails.py, line 2\)"),
    ],
    ids=["syntax", "import", "exception", "exit"],
)
def test_a_module_that_cannot_be_imported_is_refused_with_file_and_line(
    tmp_path, monkeypatch, source, words
):
    (tmp_path / "fails.py").write_text(source, encoding="utf-8")
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(InputError, match=words):
        loaded("fails:X")


@pytest.mark.parametrize(
    ("given", "expression"),
    [
        ("somebodys:Given", "Given()"),
        ("somebodys:Outer.Inner", "Outer.Inner()"),
        ("somebodys:Alias", "Alias()"),
        ("somebodys:instance", "instance"),
    ],
)
def test_what_is_printed_can_be_pasted_however_the_subject_was_given(somebodys, given, expression):
    thing = loaded(given)
    for subject in (given, thing):
        (outcome,) = conform(subject, examples=20).findings
        assert f"{expression}.so3_exp(np.array([" in outcome.paste
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(outcome.paste, {})
    subject = thing() if isinstance(thing, type) else thing
    np.testing.assert_array_equal(json.loads(printed.getvalue()), subject.so3_exp(np.zeros(3)))


def test_what_has_no_name_is_called_as_it_is_there():
    class Local:
        def so3_exp(self, w):
            return np.eye(3)

    assert (
        Subject(Local).call("so3_exp", w="x")
        == "import numpy as np; print(np.asarray(Local().so3_exp(x)).tolist())"
    )
    assert "subject.so3_exp(x)" in Subject(Local()).call("so3_exp", w="x")


def test_two_hundred_characters_of_a_module_s_file_are_said(monkeypatch):
    there: Any = ModuleType("there")
    there.__file__ = "/" + "x" * 199
    monkeypatch.setitem(sys.modules, "there", there)
    assert named._file("there") == f" ('{there.__file__}')"
    there.__file__ += "x"
    assert named._file("there") == f" ('{there.__file__[:199]}…')"


def test_a_script_is_imported_by_the_name_of_its_file(monkeypatch):
    script: Any = ModuleType("__main__")
    monkeypatch.setitem(sys.modules, "__main__", script)
    script.Mine = type("Mine", (), {"__module__": "__main__", "so3_exp": lambda self, w: w})
    line = "from {} import Mine"
    assert Subject(script.Mine).source.lines == (line.format("__main__"),)
    script.__file__ = "/somewhere/script.py"
    assert Subject(script.Mine).source.lines == (line.format("script"),)
    script.__spec__ = SimpleNamespace(name="package.script")
    assert Subject(script.Mine).source.lines == (line.format("package.script"),)


@pytest.mark.parametrize(
    ("x", "text"),
    [
        ([0, 0, 0], "[0.0, 0.0, 0.0]"),
        ([0, -0.0, 1e-300], "[0, 0, 1e-300]"),
        ([[1, 0], [0, 0.5]], "[[1.0, 0], [0, 0.5]]"),
        ([], "[]"),
    ],
    ids=["zeros", "small", "matrix", "empty"],
)
def test_a_pasted_array_is_one_of_floats(x, text):
    assert typed(x) == text
    assert np.array(eval(text)).dtype == float
