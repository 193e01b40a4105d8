"""The mutants are cosmic-ray's, the list of equivalents is honest, and what the tests judge is the
mutant.
"""

from __future__ import annotations

import ast
import functools
import math
import random
import runpy
import shutil
import sys
import textwrap
import types
from collections import Counter
from pathlib import Path

import cosmic_ray.plugins
import pytest
import scipy.stats
from cosmic_ray.mutating import mutate_code

from poekin.engine.jit.kernel import Kernel
from poekin.engine.kernels import follow_kernels
from tools.mutate import __main__ as command
from tools.mutate import campaign, equivalent, kernels, names, report, sample, suites
from tools.mutate.campaign import BrokenSuite, Campaign, Outcome, kept
from tools.mutate.mutants import Mutant, mutants_of, paths, room
from tools.mutate.near import NEAR
from tools.mutate.server import EPOCH

ROOT = Path(__file__).resolve().parents[2]
SOURCES = {path: (ROOT / path).read_text(encoding="utf-8") for path in paths(ROOT)}


@functools.cache
def of(path: str) -> list[Mutant]:
    """The mutants of a module; all of the package would take many seconds."""
    return mutants_of(path, SOURCES[path])


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


def _of_cosmic_ray(path: str) -> list[Mutant]:
    return [m for m in of(path) if m.operator.startswith("core/")]


def test_the_text_of_a_mutant_is_that_of_cosmic_ray():
    modules = random.Random(5).sample(
        [path for path in SOURCES if 500 < len(SOURCES[path]) < 4000], 8
    )
    drawn = [
        m
        for path in modules
        for of_it in [_of_cosmic_ray(path)]
        for m in random.Random(path).sample(of_it, min(3, len(of_it)))
    ]
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
    } | {
        f"def f(a: int | None, *rest: int, b: float = - {x}, **more: str) -> int | str:"
        for x in ("2.0", "0.0")
    }
    assert ("core/RemoveDecorator", 6) in {(operator, line) for operator, line, _ in found}
    assert ("core/ReplaceContinueWithBreak", 12) in {
        (operator, line) for operator, line, _ in found
    }
    assert ("core/ZeroIterationForLoop", 10) in {(operator, line) for operator, line, _ in found}


def test_without_the_future_import_annotations_run_and_are_changed():
    source = "def f(a: 3) -> 4:\n    return a\n"
    assert {m.new.replace("  ", " ") for m in mutants_of("f.py", source)} == {
        f"def f(a: {a}) -> {b}:" for a, b in ((2, 4), (4, 4), (3, 3), (3, 5))
    }


def test_an_overload_is_a_hint_and_no_code():
    source = (
        "from __future__ import annotations\n"
        "@overload\ndef f(a: int, b=2): return 3\n"
        "def f(a: int, b=2):\n    return 3\n"
    )
    assert {m.line for m in mutants_of("f.py", source)} == {4, 5}


def test_a_length_that_numpy_takes_for_whatever_is_left_is_no_mutant():
    assert {m.new for m in mutants_of("f.py", "a = b.reshape(-1, 2)\n")} == {
        f"a = b.reshape({first}, {second})"
        for first, second in (
            ("+1", 2),
            ("not 1", 2),
            ("1", 2),
            ("- 0", 2),
            ("-1", "1"),
            ("-1", "3"),
        )
    }


def test_a_number_at_the_begin_of_a_line_is_told_with_the_line_that_it_joins():
    found = {(m.line, m.old, m.new) for m in mutants_of("f.py", "a = f(\n    35,\n    b,\n)\n")}
    assert found == {(1, "a = f(", "a = f( 36,"), (1, "a = f(", "a = f( 34,")}


def test_two_changes_that_give_the_same_text_count_once():
    some = [m for path in SOURCES if room(path) == "groups" for m in of(path)]
    assert len({m.key for m in some}) == len(some)
    of_defect = of(names.module("formulas/defect"))
    assert len(of_defect) > 50
    assert len({m.applied(SOURCES[m.path]) for m in of_defect}) == len(of_defect)


def test_every_module_of_the_package_is_changed():
    assert set(SOURCES) == {
        file.relative_to(ROOT).as_posix() for file in (ROOT / "poekin").rglob("*.py")
    }
    rooms = {folder.name for folder in (ROOT / "poekin").iterdir() if list(folder.glob("*.py"))}
    assert {room(path) for path in SOURCES} == {*rooms, "errors"}
    assert set(sample.BARS) <= rooms
    for part in (
        "algebra",
        "formulas/logarithm",
        "groups/arrays",
        "formats/urdf",
        "engine/ik_kernels",
    ):
        assert len(of(names.module(part))) > 200


SAID = '''\
"""Of 3 joints."""
def f(a, b):
    """Of 4 joints."""
    print(f"joint {a!r} of {b:.3f} m, at most 7 of them")
    print(f"{a}", "version 1.5 of 12 parts", "of7", b"of 7 bytes", r"of 7 \\d", "%7d of")
'''


def test_a_message_loses_a_field_swaps_two_and_counts_one_more():
    found = {
        (m.operator.split("/")[1], m.new)
        for m in mutants_of("f.py", SAID)
        if m.operator.startswith("messages/")
    }
    rest = '"of7", b"of 7 bytes", r"of 7 \\d", "%7d of")'
    assert found == {
        ("FieldRemover", 'print(f"joint  of {b:.3f} m, at most 7 of them")'),
        ("FieldRemover", 'print(f"joint {a!r} of  m, at most 7 of them")'),
        ("FieldSwapper", 'print(f"joint {b:.3f} of {a!r} m, at most 7 of them")'),
        ("SentenceNumber", 'print(f"joint {a!r} of {b:.3f} m, at most 8 of them")'),
        ("FieldRemover", f'print(f"", "version 1.5 of 12 parts", {rest}'),
        ("SentenceNumber", f'print(f"{{a}}", "version 1.5 of 13 parts", {rest}'),
    }


def part(path: str, functions: set[str]) -> str:
    """A module without the functions and classes in which none of these is, as the mutants of all
    of it would take many seconds; all of it where one stands outside, as a decorator does.
    """
    lines = SOURCES[path].split("\n")
    for node in ast.parse(SOURCES[path]).body:
        named = {d.name for d in ast.walk(node) if isinstance(d, (ast.FunctionDef, ast.ClassDef))}
        if named and named.isdisjoint(functions) and "" not in functions:
            first = min(d.lineno for d in (node, *getattr(node, "decorator_list", ())))
            for k in range(first - 1, node.end_lineno or 0):
                lines[k] = ""
    return "\n".join(lines)


def test_the_list_of_equivalents_holds_mutants_alone():
    entries = equivalent.entries()
    functions: dict[str, set[str]] = {}
    for entry in entries:
        functions.setdefault(entry.path, set()).add(entry.definition)
    mutants = [m for path, named in functions.items() for m in mutants_of(path, part(path, named))]
    listed, stale = equivalent.listed(mutants, entries)
    assert stale == []
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
    assert (
        equivalent.listed(mutants, equivalent.entries(ENTRY))[1][0].new == "x *  4  # a comment, 7"
    )


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


def files_of(words: list[str]) -> list[str]:
    return [word.split("=")[-1].split("::")[0] for word in words]


def test_every_module_has_tests_that_exist():
    for path in SOURCES:
        files = [
            file for part in (*suites.near(path), suites.whole(path)) for file in files_of(part)
        ]
        assert len(files) > 1
        assert [file for file in files if not (ROOT / file).exists()] == []


@pytest.mark.parametrize(
    "module, test",
    [
        ("formats/urdf", "formats/urdf"),
        ("formats/ur/conf", "formats/ur"),  # by the name of its folder
        ("solve/path_result", "solve/path_result"),
        ("formats/attributes", "formats/objects"),
        ("engine/ik_codes", "engine/ik_kernels"),
        ("model/tree_arrays", "model/link_program"),  # by the tests that import it
        ("solve/measurement", "solve/measurements"),
        ("formulas/circle_roots", "formulas/circle_roots"),  # before all others of the room
    ],
)
def test_the_tests_near_a_module_are_found_by_name_and_by_import(module, test):
    assert suites.near(names.module(module))[0][0] == names.test(test)


@pytest.mark.parametrize("table", [NEAR, suites.WHOLE], ids=["near", "whole"])
def test_a_table_names_a_module_once(table):
    counts = Counter(names.module(name) for key in table for name in key.split())
    assert counts.most_common(1)[0][1] == 1


@pytest.fixture
def rooms(tmp_path, monkeypatch):
    """A tree with one room, in which two modules have one stem."""
    for file in ("a", "deep/er/b", "deep/c", "low/c"):
        path = tmp_path / "poekin" / "hall" / f"{file}.py"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
    for file in ("test_a", "deep/er/test_b"):
        path = tmp_path / "tests" / "hall" / f"{file}.py"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
    monkeypatch.setattr(names, "ROOT", tmp_path)


def test_a_name_is_that_of_the_one_file_of_its_stem_in_the_room(rooms):
    assert names.module("hall/a") == "poekin/hall/a.py"
    assert names.module("hall/b") == names.module("hall/deep/b") == "poekin/hall/deep/er/b.py"
    assert names.module("hall/low/c") == "poekin/hall/low/c.py"
    assert names.module("hall/er/") == "poekin/hall/deep/er"
    assert (
        names.argument("--deselect=hall/b::test_one")
        == "--deselect=tests/hall/deep/er/test_b.py::test_one"
    )
    with pytest.raises(
        ValueError, match=r"hall/c .* is poekin/hall/deep/c\.py, poekin/hall/low/c\.py$"
    ):
        names.module("hall/c")
    with pytest.raises(ValueError, match=r"hall/c has to be one place below tests/, and is none$"):
        names.test("hall/c")


def test_of_a_table_the_longest_path_counts(rooms):
    table = {"hall/": "hall/a", "hall/b hall/a": "own hall/", "hall/deep/": "hall/b hall/a hall/b"}
    assert names.longest(table, "poekin/hall/low/c.py") == ["tests/hall/test_a.py"]
    assert names.longest(table, "poekin/hall/deep/er/b.py") == [
        "tests/hall/deep/er/test_b.py",
        "tests/hall",
    ]
    assert names.longest(table, "poekin/hall/deep/c.py") == [
        "tests/hall/deep/er/test_b.py",
        "tests/hall/test_a.py",
    ]
    assert names.longest(table, "poekin/hallway.py") == []


@pytest.mark.parametrize(
    "module, mode",
    [
        ("algebra", "interpreted"),
        ("formulas/logarithm", "interpreted"),
        ("engine/chain_kernels", "interpreted"),
        # there is an intrinsic in it, which the interpreter does not know
        ("engine/ik_kernels", "shared"),
        ("engine/source_hash", "cold"),
        ("model/structure", "warm"),
        ("solve/ik", "warm"),
    ],
)
def test_a_module_runs_as_it_can(module, mode):
    assert suites.mode(names.module(module)).value == mode


def test_no_mutant_meets_tests_whose_processes_have_another_key():
    own = "tests/engine/jit/test_cache.py"
    sweeps = {
        "test_store.py": "test_a_run_that_is_killed_again_and_again_goes_on_where_it_was",
        "test_pose_sweep.py": "test_processes_and_runs_that_were_killed_give_the_same_bytes",
    }
    left_out = {f"--deselect={own}"}
    for file, test in sweeps.items():
        place = f"tests/sweep/execution/{file}"
        # pytest passes over a name that is not there
        assert f"def {test}(" in (ROOT / place).read_text(encoding="utf-8")
        left_out.add(f"--deselect={place}::{test}")
    modes = {suites.Mode.SHARED, suites.Mode.INTERPRETED}
    loaded = [path for path in SOURCES if suites.mode(path) in modes]
    assert {names.module("engine/vector"), names.module("formulas/exponential")} <= {*loaded}
    for path in loaded:
        for part in (*suites.near(path), suites.whole(path)):
            assert left_out <= {*part}
    for name in ("engine/cache", "engine/cache_size", "engine/locks"):
        path = names.module(name)
        assert any(own in part for part in suites.near(path))
        assert not any(f"--deselect={own}" in part for part in suites.near(path))


def test_a_mutant_finds_no_kernel_of_another(tmp_path):
    known = tmp_path / "known"
    known.mkdir()
    for name in ("so3_log-1.kernel", "arm-2.kernel"):
        (known / name).write_text(name)
    (known / "arm-2.kernel").unlink()
    for mode, found in ((suites.Mode.WARM, {"so3_log-1.kernel"}), (suites.Mode.COLD, set())):
        with kernels.offered(known, mode, tmp_path / "job", ["so3_log"]) as place:
            assert list(Path(place).iterdir()) == []
        with kernels.offered(known, mode, tmp_path / "job") as place:
            assert {file.name for file in Path(place).iterdir()} == found
            (Path(place) / "new.kernel").write_text("a mutant's")
            (Path(place) / "other").write_text("a mutant's")
            (Path(place) / "other").replace(Path(place) / "so3_log-1.kernel")
        assert not Path(place).exists()
        assert {file.name: file.read_text() for file in known.iterdir()} == {
            "so3_log-1.kernel": "so3_log-1.kernel"
        }
    with kernels.offered(known, suites.Mode.INTERPRETED, tmp_path / "job") as place:
        assert place == ""


def test_a_mutant_of_the_engine_finds_no_kernel_that_it_is_compiled_into():
    assert suites.kernels_of(names.module("engine/arm_code")) == []
    own = set(suites.kernels_of(names.module("engine/follow_kernels")))
    assert own == {
        name for name, value in vars(follow_kernels).items() if isinstance(value, Kernel)
    }
    assert own < set(suites.kernels_of(names.module("engine/ik_kernels")))  # which it calls


def test_every_kernel_of_the_engine_is_made_ready_by_one_of_the_processes(monkeypatch):
    ready: list[Kernel] = []
    monkeypatch.setattr(Kernel, "ready", lambda self: ready.append(self))
    kernels.main(0, 2)
    kernels.main(1, 2)
    assert len({id(kernel) for kernel in ready}) == len(ready)
    assert {kernel.function.__name__ for kernel in ready} == {
        name for path in SOURCES if room(path) == "engine" for name in suites.kernels_of(path)
    }


def test_of_this_user_s_cache_no_arm_s_code_is_taken(tmp_path, monkeypatch):
    own = tmp_path / "own"
    own.mkdir()
    for name in (
        "so3_log-1.kernel",
        "so3_log-2.kernel",
        "of_a_test-2.kernel",
        "arm-2.kernel",
        "notes.txt",
    ):
        (own / name).write_text(name)
    monkeypatch.setattr(kernels, "_user_cache", lambda root: own)
    monkeypatch.setattr(kernels, "_making", lambda root, place: {"so3_log-1.kernel"})
    place = kernels.prepared(tmp_path, tmp_path / "known")
    # nor a kernel of another source
    assert {file.name for file in place.iterdir()} == {"so3_log-1.kernel", "of_a_test-2.kernel"}


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
    monkeypatch.setattr(suites, "mode", lambda path: suites.Mode.INTERPRETED)
    # what it needs, and more
    monkeypatch.setattr(campaign, "LIBRARIES", ("hypothesis", "pytest", "not_installed"))
    return root


def run(
    root: Path,
    choose=lambda m: True,
    listed: frozenset[str] = frozenset(),
    seconds: float = math.inf,
) -> dict[str, str]:
    """The outcomes of the calculator's mutants, by the line that each makes."""
    found: dict[str, str] = {}
    mutants = [m for m in mutants_of("poekin/calculator.py", CALCULATOR) if choose(m)]
    sources = {"poekin/calculator.py": CALCULATOR}
    shutil.rmtree(root.parent / "copies", ignore_errors=True)
    campaign = Campaign(
        root,
        root.parent / "copies",
        sources,
        set(listed),
        root.parent / "results.jsonl",
        quick=False,
        seconds=seconds,
    )
    campaign.run(mutants, 1, lambda m, outcome: found.update({m.new: str(outcome["outcome"])}))
    return found


def test_a_mutant_that_a_test_sees_is_caught_and_one_that_none_sees_survives(small):
    caught = ("return x * 3", "return x + 2", "return x << 2", "while n >= 0:")
    found = run(small, lambda m: m.new in (*caught, "while n != 0:"))
    assert found == {**dict.fromkeys(caught, "caught"), "while n != 0:": "passed"}
    results = kept(small.parent / "results.jsonl")
    assert len(results) == len(found)
    tests = [f"tests/test_calculator.py::test_{name}" for name in ("double", "forever")]
    assert {outcome["by"] for outcome in results.values()} == {"", *tests}
    assert (small / "poekin/calculator.py").read_text(encoding="utf-8") == CALCULATOR


def test_no_mutant_takes_the_bytecode_of_another_of_the_same_length(small):
    # written within one second, they differ by nothing that Python asks about a file but by its time
    lines = [f"return x * {k}" for k in (3, 1)]
    assert run(small, lambda m: m.new in lines) == dict.fromkeys(lines, "caught")
    place = small.parent / "copies" / "tree0" / "poekin"
    assert list(place.rglob("calculator.*.pyc"))
    compiled = [*place.rglob("__init__.*.pyc"), *place.rglob("calculator.*.pyc")]
    times = [int.from_bytes(file.read_bytes()[8:12], "little") - EPOCH for file in compiled]
    assert times[0] == 0 < times[1]


def test_no_environment_is_copied_with_the_tree(tmp_path):
    folders = ["poekin", ".venv", ".venv-3.12-lowest"]
    for name in folders:
        (tmp_path / "root" / name).mkdir(parents=True)
    campaign.copy(tmp_path / "root", tmp_path / "tree")
    assert [folder.name for folder in (tmp_path / "tree").iterdir()] == ["poekin"]


def test_after_the_time_that_is_given_no_mutant_is_begun(small):
    assert run(small, seconds=0) == {}
    assert run(small, lambda m: m.new == "return x * 3", seconds=600) == {"return x * 3": "caught"}


def test_what_has_to_be_made_ready_for_the_first_mutant_takes_none_of_the_time(small, monkeypatch):
    clock = [0.0]

    class Slow(campaign.Server):
        def __init__(self, *arguments):
            clock[0] += 1000
            super().__init__(*arguments)

    monkeypatch.setattr(campaign, "Server", Slow)
    monkeypatch.setattr(campaign, "time", types.SimpleNamespace(monotonic=lambda: clock[0]))
    assert run(small, lambda m: m.new == "return x * 3", seconds=10) == {"return x * 3": "caught"}


@pytest.fixture
def hasty(small):
    """The project, with half a second for a test."""
    (small / "tools").unlink()
    (small / "tools" / "mutate").mkdir(parents=True)
    for file in (ROOT / "tools" / "mutate").glob("*.py"):
        text = file.read_text(encoding="utf-8").replace("SECONDS = 30.0", "SECONDS = 0.5")
        (small / "tools" / "mutate" / file.name).write_text(text, encoding="utf-8")
    return small


def test_a_loop_without_an_end_is_ended(hasty):
    assert run(hasty, lambda m: m.new == "n -= 0") == {"n -= 0": "timeout"}


def test_a_test_that_may_have_to_compile_kernels_has_more_time(hasty, monkeypatch):
    slow = "import time\nstart = time.process_time()\nwhile time.process_time() < start + 1:\n    pass\n"
    (hasty / "tests" / "test_calculator.py").write_text(
        f"{TESTS}\ndef test_slow():\n{textwrap.indent(slow, '    ')}    assert double(4) == 8\n",
        encoding="utf-8",
    )
    with pytest.raises(BrokenSuite, match=r"::test_slow: timeout"):
        run(hasty, lambda m: m.new == "while n != 0:")
    monkeypatch.setattr(suites, "mode", lambda path: suites.Mode.COLD)
    assert run(hasty, lambda m: m.new == "while n != 0:") == {"while n != 0:": "passed"}


def test_a_suite_that_fails_by_itself_proves_nothing(small):
    (small / "tests" / "test_calculator.py").write_text(
        TESTS.replace("== 6", "== 7"), encoding="utf-8"
    )
    with pytest.raises(
        BrokenSuite, match=r"without any mutant tests/test_calculator.py::test_double: caught"
    ):
        run(small)


def test_a_test_that_is_called_by_what_a_mutant_changes_is_looked_for_without_it(small):
    (small / "tests" / "test_calculator.py").write_text(
        "import pytest\nfrom poekin.calculator import double\n\n"
        "@pytest.mark.parametrize('six', [double(3)])\ndef test_six(six):\n    assert six == 6\n",
        encoding="utf-8",
    )
    outcomes = run(small, lambda m: "x" in m.new)
    assert len(outcomes) > 3
    assert set(outcomes.values()) == {"caught"}


def mutant(key: str, path: str = "a.py") -> Mutant:
    return Mutant(path, "core/NumberReplacer", 0, 3, "f", "x = 1", "x = 2", key, 0, 1, "2")


def test_the_table_counts_every_kind():
    mutants = [mutant(k) for k in "abcdef"] + [mutant("g", "b.py")]
    outcomes: dict[str, Outcome] = {
        k: {"outcome": o}
        for k, o in zip("abcde", ("caught", "timeout", "passed", "passed", "caught"), strict=True)
    }
    listed = {"d": "it does the same", "e": "so it was thought"}
    counts = report.counted(mutants, outcomes, listed, lambda m: m.path)
    lines = [line.split() for line in report.table(counts, "module").splitlines()]
    assert lines[1] == ["a.py", "6", "5", "3", "1", "1", "1", "75.00", "%"]
    assert lines[2] == ["b.py", "1", "0", "0", "0", "0", "0"]
    assert lines[3] == ["all", "7", "5", "3", "1", "1", "1", "75.00", "%"]
    assert report.kind(mutants[4], outcomes, listed) == "wrong"
    assert report.told(mutants[0]) == "a.py:3: in f\n  - x = 1\n  + x = 2"


def of_rooms(**sizes: int) -> list[Mutant]:
    return [
        mutant(f"{name}{k}", f"poekin/{name}/a.py")
        for name, size in sizes.items()
        for k in range(size)
    ]


def test_a_sample_holds_of_each_room_in_proportion_and_the_same_for_a_seed():
    mutants = of_rooms(solve=600, groups=25, cli=75)
    counts = Counter(m.room for m in sample.drawn(mutants, 70, 0))
    # 7.5 and 2.5: of equal remainders the first by name
    assert counts == {"solve": 60, "cli": 8, "groups": 2}
    assert (
        sample.drawn(mutants, 70, 0) == sample.drawn(mutants, 70, 0) != sample.drawn(mutants, 70, 1)
    )
    assert sample.drawn(mutants, 700, 0) == mutants


def test_the_chance_of_so_many_survivors_is_that_of_the_binomial_distribution():
    for size, survivors in ((20, 0), (20, 3), (60, 9)):
        assert sample.chance(survivors, {"solve": size}) == pytest.approx(
            scipy.stats.binom.sf(survivors - 1, size, 0.05), rel=1e-12
        )
    apart = [sample.chance(k, {"solve": 8}) - sample.chance(k + 1, {"solve": 8}) for k in range(9)]
    together = sum(p * sample.chance(max(2 - k, 0), {"model": 5}) for k, p in enumerate(apart))
    assert sample.chance(2, {"solve": 8, "model": 5}) == pytest.approx(together, rel=1e-12)


def test_a_sample_fails_where_its_survivors_are_too_many_for_the_bar():
    assert not sample.room_is_sound("solve", 6, 100, whole=True)  # all were run: the bar itself
    assert sample.room_is_sound("solve", 5, 100, whole=True)
    assert sample.most("solve", 100) == 13  # 14 would be seen in less than one sample of a thousand
    assert sample.room_is_sound("solve", 13, 100, whole=False)
    assert not sample.room_is_sound("solve", 14, 100, whole=False)


@pytest.mark.parametrize("survivors, code", [(0, 0), (40, 1)])
def test_the_exit_code_and_the_table_say_what_the_sample_proves(
    survivors, code, tmp_path, monkeypatch, capsys
):
    _project(tmp_path, monkeypatch)
    assert command.main(["--report", "--sample", "60"]) == 0
    chosen = sample.drawn([m for path in FILES for m in mutants_of(path, CALCULATOR)], 60, 0)
    results = tmp_path / "build" / "mutants" / "results.jsonl"
    with results.open("a") as file:
        file.writelines(
            f'{{"key": "{m.key}", "outcome": "passed", "by": ""}}\n' for m in chosen[:survivors]
        )
    assert command.main(["--report", "--sample", "60"]) == code
    said = capsys.readouterr().out
    assert ("FAILED: all: 40 of 60 survived" in said) == bool(code)


@pytest.mark.parametrize("let_through, tries", [(0, 1), (2, 1), (30, 2)])
def test_what_the_near_tests_let_through_is_tried_on_all_only_where_the_sample_fails_else(
    let_through, tries, tmp_path, monkeypatch
):
    keys = _project(tmp_path, monkeypatch)
    ran: list[tuple[int, bool]] = []

    def run(waiting, *, outcomes, quick, **_):
        ran.append((len(waiting), quick))
        for k, mutant in enumerate(waiting):
            outcomes[mutant.key] = {
                "outcome": "passed" if quick and k < let_through else "caught",
                "by": "",
            }

    monkeypatch.setattr(command, "_run", run)
    assert command.main(["--sample", "60", "--afresh"]) == 0
    assert ran == [(60, True), (let_through, False)][:tries]
    ran.clear()
    # all: each is tried on all tests
    assert command.main(["--sample", str(len(keys) + 1), "--afresh"]) == 0
    assert ran == [(len(keys), False)]


def test_a_run_without_time_for_any_mutant_proves_nothing(tmp_path, monkeypatch, capsys):
    _project(tmp_path, monkeypatch)
    given: list[float] = []
    monkeypatch.setattr(command, "_run", lambda *_, **more: given.append(more["seconds"]))
    assert command.main(["--sample", "60", "--afresh", "--seconds", "50"]) == 1
    assert "no time for any mutant" in capsys.readouterr().out
    # a fifth is kept for what the tests near a module let through
    assert given == [40]


def test_a_large_sample_is_judged_as_well():
    assert sample.chance(800, {"solve": 16_000}) == pytest.approx(0.5, abs=0.02)
    assert sample.chance(0, {}) == 1


FILES = ("poekin/solve/a.py", "poekin/solve/b.py", "poekin/cli/c.py", "poekin/algebra.py")


def _project(root: Path, monkeypatch) -> list[str]:
    """A package of the calculator, several times, of which every mutant was caught; the mutants'
    keys.
    """
    for path in FILES:
        (root / path).parent.mkdir(parents=True, exist_ok=True)
        (root / path).write_text(CALCULATOR, encoding="utf-8")
    known = [m.key for path in FILES for m in mutants_of(path, CALCULATOR)]
    results = root / "build" / "mutants" / "results.jsonl"
    results.parent.mkdir(parents=True)
    results.write_text(
        "".join(f'{{"key": "{key}", "outcome": "caught", "by": ""}}\n' for key in known)
    )
    monkeypatch.setattr(command, "ROOT", root)
    monkeypatch.setattr(equivalent, "entries", list)
    return known


def test_a_sample_run_afresh_leaves_what_is_known_of_the_others(tmp_path, monkeypatch, capsys):
    known = _project(tmp_path, monkeypatch)
    results = tmp_path / "build" / "mutants" / "results.jsonl"
    assert command.main(["--report", "--sample", "3"]) == 0
    assert "3 of 3 were caught in earlier runs" in capsys.readouterr().out
    assert command.main(["--report", "--sample", "3", "--afresh"]) == 0
    assert "earlier runs" not in capsys.readouterr().out
    assert set(kept(results)) == set(known)


def test_without_cosmic_ray_the_extra_that_has_it_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "cosmic_ray", None)
    with pytest.raises(
        SystemExit, match=r"needs the package cosmic-ray: pip install -e '\.\[dev\]'"
    ):
        runpy.run_path(str(ROOT / "tools" / "mutate" / "__main__.py"))


def test_of_a_room_its_mutants_alone_are_counted_and_its_entries_alone_are_stale(
    tmp_path, monkeypatch, capsys
):
    _project(tmp_path, monkeypatch)
    paths = ("poekin/solve/a.py", "poekin/cli/c.py")
    entries = [equivalent.Entry(path, "double", "return x", "return y", "-") for path in paths]
    monkeypatch.setattr(equivalent, "entries", lambda: entries)
    assert command.main(["--count", "--room", "solve"]) == 1
    said = capsys.readouterr().out
    assert "no mutant: poekin/solve/a.py: double: return x -> return y" in said
    assert not any(other in said for other in ("cli", "formulas"))
    count = 2 * len(mutants_of("poekin/solve/a.py", CALCULATOR))
    assert f"listed as equivalent: 0 of {count}, 0.00 %" in said


def test_a_room_that_is_none_is_refused_with_those_that_are(capsys):
    with pytest.raises(SystemExit) as ended:
        command.main(["--room", "nowhere", "--count"])
    assert ended.value.code == 2
    assert (
        "no room called 'nowhere'; there are analysis, cli, engine, errors, formats"
        in capsys.readouterr().err
    )
