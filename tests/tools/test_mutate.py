"""The mutants are cosmic-ray's, the list of equivalents is honest, and what the tests judge is the mutant."""

from __future__ import annotations

import functools
import random
import runpy
import sys
import textwrap
from collections import Counter
from pathlib import Path

import cosmic_ray.plugins
import pytest
from cosmic_ray.mutating import mutate_code

from tools.mutate import __main__ as command
from tools.mutate import campaign, equivalent, report, suites
from tools.mutate.campaign import BrokenSuite, Campaign, Outcome, kept
from tools.mutate.mutants import FILES, Mutant, mutants_of, paths

ROOT = Path(__file__).resolve().parents[2]
SOURCES = {path: (ROOT / path).read_text(encoding="utf-8") for path in paths(ROOT)}


@functools.cache
def every() -> list[Mutant]:
    """All mutants there are: seconds, which collecting the tests does not have to wait for."""
    return [mutant for path, source in SOURCES.items() for mutant in mutants_of(path, source)]


def of(path: str) -> list[Mutant]:
    return [mutant for mutant in every() if mutant.path == path]


ODD = '''\
from __future__ import annotations

import functools


@functools.cache
def f(a: int | None, *rest: int, b: float = -1.0, **more: str) -> int | str:
    """1 + 1"""
    x: int | str = a + 2 if a is not None else [*rest]
    for k in range(3):
        if not k or k == b:
            continue
    return (
        x * 3  # a comment, 7
        - é
    )
'''


def test_the_text_of_a_mutant_is_that_of_cosmic_ray():
    drawn = random.Random(5).sample([m for m in every() if len(SOURCES[m.path]) < 4000], 25)
    pairs = [(m, SOURCES[m.path]) for m in drawn] + [(m, ODD) for m in mutants_of("odd.py", ODD)]
    for mutant, source in pairs:
        operator = cosmic_ray.plugins.get_operator(mutant.operator)()
        assert mutant.applied(source) == mutate_code(source, operator, mutant.occurrence), mutant


def test_every_change_that_runs_is_a_mutant_and_nothing_else_is():
    found = {(m.operator, m.line, m.new) for m in mutants_of("odd.py", ODD)}
    lines = {line for _, line, _ in found}
    assert lines == {6, 7, 9, 10, 11, 12, 14, 15}
    # of the signature the default alone: no annotation, no star
    assert {new for _, line, new in found if line == 7} == {
        f"def f(a: int | None, *rest: int, b: float = {sign}1.0, **more: str) -> int | str:"
        for sign in ("+", "~", "not ", "")
    } | {f"def f(a: int | None, *rest: int, b: float = - {x}, **more: str) -> int | str:" for x in ("2.0", "0.0")}
    assert ("core/RemoveDecorator", 6) in {(operator, line) for operator, line, _ in found}
    assert ("core/ReplaceContinueWithBreak", 12) in {(operator, line) for operator, line, _ in found}
    assert ("core/ZeroIterationForLoop", 10) in {(operator, line) for operator, line, _ in found}


def test_without_the_future_import_annotations_run_and_are_changed():
    source = "def f(a: 3) -> 4:\n    return a\n"
    assert {m.new.replace("  ", " ") for m in mutants_of("f.py", source)} == {
        f"def f(a: {a}) -> {b}:" for a, b in ((2, 4), (4, 4), (3, 3), (3, 5))
    }


def test_two_changes_that_give_the_same_text_count_once():
    assert len({m.key for m in every()}) == len(every())
    assert len({(m.path, m.applied(SOURCES[m.path])) for m in of("poekin/formulas/defect.py")}) == 84


def test_the_modules_named_are_all_there():
    assert len(SOURCES) == 31
    for part in ("algebra", "formulas/logarithm", "groups/se3", "formats/dh/from_chain", "model/screw"):
        assert len(of(f"poekin/{part}.py")) > 200


def test_the_list_of_equivalents_holds_mutants_alone_and_few_of_them():
    listed, stale = equivalent.listed(every(), equivalent.entries())
    assert stale == []
    assert len(listed) <= 0.05 * len(every())
    assert all(len(reason) > 20 for reason in listed.values())


ENTRY = """
[[equivalent]]
file = "odd.py"
function = "f"
line = "x * 3  # a comment, 7"
becomes = ["x *  4  # a comment, 7"]
reason = "nobody looks"
"""


def test_an_entry_names_its_mutant_and_one_that_does_not_is_stale():
    mutants = mutants_of("odd.py", ODD)
    (hit,) = (m for m in mutants if m.new == "x * 4  # a comment, 7")
    entries = equivalent.entries(ENTRY.replace("*  4", "* 4"))
    assert equivalent.listed(mutants, entries) == ({hit.key: "nobody looks"}, [])
    assert equivalent.listed(mutants, equivalent.entries(ENTRY))[1][0].new == "x *  4  # a comment, 7"


@pytest.mark.parametrize(
    "text, error, message",
    [
        (ENTRY.replace("nobody looks", " "), ValueError, r"without a reason"),
        (ENTRY.replace('reason = "nobody looks"', ""), KeyError, r"reason"),
        (ENTRY + ENTRY, ValueError, r"listed twice"),
    ],
    ids=["empty", "missing", "twice"],
)
def test_an_entry_without_a_reason_or_twice_is_refused(text, error, message):
    with pytest.raises(error, match=message):
        equivalent.entries(text)


def test_every_module_has_tests_that_exist():
    for path in SOURCES:
        named = [word for part in (*suites.near(path), suites.whole(path)) for word in part]
        files = [word.split("=")[-1].split("::")[0] for word in named]
        assert len(files) > 3
        assert [file for file in files if not (ROOT / file).exists()] == []


CALCULATOR = "def double(x):\n    return x * 2\n\n\ndef forever(n):\n    while n > 0:\n        n -= 1\n    return n\n"
TESTS = """
from poekin.calculator import double, forever

def test_double():
    assert double(3) == 6

def test_forever():
    assert forever(3) == 0
"""


@pytest.fixture
def small(tmp_path, monkeypatch):
    """A project of one module, judged by one file of tests."""
    root = tmp_path / "project"
    for file, text in {
        "poekin/__init__.py": "",
        "poekin/calculator.py": CALCULATOR,
        "tests/test_calculator.py": TESTS,
        "tests/conftest.py": "from hypothesis import settings\nsettings.register_profile('quick')\n",
        "pyproject.toml": '[tool.pytest]\npythonpath = ["."]\naddopts = ["--import-mode=importlib"]\n',
    }.items():
        (root / file).parent.mkdir(parents=True, exist_ok=True)
        (root / file).write_text(textwrap.dedent(text), encoding="utf-8")
    (root / "tools").symlink_to(ROOT / "tools")
    monkeypatch.setattr(suites, "near", lambda path: [["tests/test_calculator.py"]])
    monkeypatch.setattr(suites, "whole", lambda path: ["tests"])
    monkeypatch.setattr(campaign, "LIBRARIES", ("hypothesis", "pytest", "not_installed"))  # what it needs, and more
    return root


def run(root: Path, choose=lambda m: True, listed: frozenset[str] = frozenset()) -> dict[str, str]:
    """The outcomes of the calculator's mutants, by the line that each makes."""
    found: dict[str, str] = {}
    mutants = [m for m in mutants_of("poekin/calculator.py", CALCULATOR) if choose(m)]
    sources = {"poekin/calculator.py": CALCULATOR}
    campaign = Campaign(root, root.parent / "copies", sources, set(listed), root.parent / "results.jsonl", False)
    campaign.run(mutants, 1, lambda m, outcome: found.update({m.new: str(outcome["outcome"])}))
    return found


def test_a_mutant_that_a_test_sees_is_caught_and_one_that_none_sees_survives(small):
    found = run(small, lambda m: m.line in (2, 8) or m.new in ("while n >= 0:", "while n != 0:"))
    assert (
        found["return x * 3"] == found["return x + 2"] == found["return x << 2"] == found["while n >= 0:"] == "caught"
    )
    assert found["while n != 0:"] == "passed"
    assert Counter(found.values())["passed"] == 1
    results = kept(small.parent / "results.jsonl")
    assert len(results) == len(found)
    assert {outcome["by"] for outcome in results.values()} == {
        "", "tests/test_calculator.py::test_double", "tests/test_calculator.py::test_forever"
    }  # fmt: skip
    assert (small / "poekin/calculator.py").read_text(encoding="utf-8") == CALCULATOR


def test_a_loop_without_an_end_is_ended(small, monkeypatch):
    plugin = small.parent / "tools"
    plugin.mkdir()
    (small / "tools").unlink()
    (small / "tools" / "mutate").mkdir(parents=True)
    for file in (ROOT / "tools" / "mutate").glob("*.py"):
        text = file.read_text(encoding="utf-8").replace("SECONDS = 30.0", "SECONDS = 0.5")
        (small / "tools" / "mutate" / file.name).write_text(text, encoding="utf-8")
    assert run(small, lambda m: m.new == "n -= 0") == {"n -= 0": "timeout"}


def test_a_suite_that_fails_by_itself_proves_nothing(small):
    (small / "tests" / "test_calculator.py").write_text(TESTS.replace("== 6", "== 7"), encoding="utf-8")
    with pytest.raises(BrokenSuite, match=r"without any mutant tests/test_calculator.py::test_double: caught"):
        run(small)


def mutant(key: str, path: str = "a.py") -> Mutant:
    return Mutant(path, "core/NumberReplacer", 0, 3, "f", "x = 1", "x = 2", key, 0, 1, "2")


def test_the_table_counts_every_kind():
    mutants = [mutant(k) for k in "abcdef"] + [mutant("g", "b.py")]
    outcomes: dict[str, Outcome] = {
        k: {"outcome": o} for k, o in zip("abcde", ("caught", "timeout", "passed", "passed", "caught"), strict=True)
    }
    listed = {"d": "it does the same", "e": "so it was thought"}
    lines = [line.split() for line in report.table(mutants, outcomes, listed).splitlines()]
    assert lines[1] == ["a.py", "6", "5", "3", "1", "1", "1", "75.00", "%"]
    assert lines[2] == ["b.py", "1", "0", "0", "0", "0", "0"]
    assert lines[3] == ["all", "7", "5", "3", "1", "1", "1", "75.00", "%"]
    assert report.kind(mutants[4], outcomes, listed) == "wrong"
    assert report.told(mutants[0]) == "a.py:3: in f\n  - x = 1\n  + x = 2"


def test_a_sample_run_afresh_leaves_what_is_known_of_the_others(tmp_path, monkeypatch, capsys):
    for path in FILES:
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).write_text(CALCULATOR, encoding="utf-8")
    known = [m.key for path in FILES for m in mutants_of(path, CALCULATOR)]
    results = tmp_path / "build" / "mutants" / "results.jsonl"
    results.parent.mkdir(parents=True)
    results.write_text("".join(f'{{"key": "{key}", "outcome": "caught", "by": ""}}\n' for key in known))
    monkeypatch.setattr(command, "ROOT", tmp_path)
    monkeypatch.setattr(equivalent, "entries", list)
    assert command.main(["--report", "--sample", "3"]) == 0
    assert "3 of 3 were caught in earlier runs" in capsys.readouterr().out
    assert command.main(["--report", "--sample", "3", "--afresh"]) == 0
    assert "earlier runs" not in capsys.readouterr().out
    assert set(kept(results)) == set(known)


def test_without_cosmic_ray_the_extra_that_has_it_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "cosmic_ray", None)
    with pytest.raises(SystemExit, match=r"needs the package cosmic-ray: pip install -e '\.\[dev\]'"):
        runpy.run_path(str(ROOT / "tools" / "mutate" / "__main__.py"))
