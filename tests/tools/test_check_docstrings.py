"""The check of docstrings sees what numpydoc's validator sees, and fields that are not told."""

from __future__ import annotations

import sys

import pytest

pytest.importorskip("numpydoc", reason="numpydoc comes with make lint")

from tools import check_docstrings

SOUND = '''
class Base:
    """Base of the package."""

    def f(self, q):
        """Pose of the tool.

        Parameters
        ----------
        q : float
            Angle, rad.

        Returns
        -------
        x : float
            Position, m.
        """
        return q


class Result(Base):
    """Result with a field.

    Attributes
    ----------
    x : float
        Position, m.
    """

    def __init__(self, x):
        self.x = x

    def f(self, q):
        """Same angle, another equation."""
        return 2 * q
'''
NAMES = ("Base.f", "Result", "Result.f")


@pytest.fixture
def faults(monkeypatch, tmp_path):
    """Function of a source: codes of the faults in it."""

    def of(source: str) -> list[str]:
        (tmp_path / "planted.py").write_text(source, encoding="utf-8")
        monkeypatch.syspath_prepend(tmp_path)
        monkeypatch.delitem(sys.modules, "planted", raising=False)
        monkeypatch.setattr(check_docstrings.docs_names, "own", lambda base: base is not object)
        found = [fault for n in NAMES for fault in check_docstrings.faults(f"planted.{n}")]
        return [f"{fault.name.removeprefix('planted.')} {fault.code}" for fault in found]

    return of


def test_a_sound_docstring_has_no_fault_and_what_overrides_keeps_the_words_of_its_base(faults):
    assert faults(SOUND) == []


@pytest.mark.parametrize(
    ("here", "there", "fault"),
    [
        ("q : float\n            Angle, rad.", "p : float\n            Angle.", "Base.f PR02"),
        ("            Angle, rad.", "            angle, rad.", "Base.f PR08"),
        ("        x : float\n            Position, m.", "        None", "Base.f RT03"),
        ("Pose of the tool.", "pose of the tool.", "Base.f SS02"),
        ("Pose of the tool.", "Pose of the tool", "Base.f SS03"),
        (
            "    x : float\n        Position, m.",
            "    y : float\n        Position, m.",
            "Result PR01",
        ),
    ],
    ids=["name", "capital", "returned", "summary", "full stop", "field"],
)
def test_a_planted_fault_is_caught(faults, here, there, fault):
    assert here in SOUND
    assert fault in faults(SOUND.replace(here, there))


def test_a_name_that_nobody_has_is_no_success():
    assert check_docstrings.main(["no such name"]) == 1
