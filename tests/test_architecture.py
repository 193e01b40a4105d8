"""The house's rules: floors, pure formulas, optional packages in one place, no asserts, short
files.

Each rule is a function of a directory that holds a package `poekin`, and returns what breaks it,
one line a place.
It is run on this repository, and on a planted package for each of the ways to break it.
"""

from __future__ import annotations

import ast
import functools
import sys
from collections import Counter
from collections.abc import Callable, Iterator
from importlib.util import resolve_name
from pathlib import Path

import pytest

from tools import readable

ROOT = Path(__file__).resolve().parent.parent

FLOORS = {
    "errors": 0, "checks": 0, "algebra": 0, "by_value": 0, "results": 0, "version": 0,
    "svg": 0, "html_page": 0, "progress_line": 0,
    "formulas": 1, "engine": 2, "groups": 3, "model": 4, "formats": 5,
    "testing": 6, "analysis": 6.5, "solve": 7, "view": 8, "sweep": 8, "cli": 9,
}  # fmt: skip
FACE = 9  # poekin/__init__.py: the public names; only the command line may use them from inside

CORE = {"numpy", "numba", "llvmlite", "lxml"}

# An optional package is imported in one file only, or in the files of one room.
OPTIONAL: dict[str, str | None] = dict.fromkeys(
    (
        "pinocchio",
        "scipy",
        "mpmath",
        "sympy",
        "matplotlib",
        "jinja2",
        "yaml",
        "tomli_w",
        "mujoco",
        "xacrodoc",
        "xacro",
        "eaik",
        "k3d",
        "trimesh",
        "collada",
        "xarray",
        "zarr",
        "distributed",
    )
)
OPTIONAL |= {"hypothesis": "poekin/testing/", "typer": "poekin/cli/", "rich": "poekin/cli/"}
OPTIONAL |= {"pytest": "poekin/testing/conform/plugin.py"}  # which pytest alone loads

# Files of the package that may be longer than 400 lines, each with its reason.
LONG: dict[str, str] = {}

Rule = Callable[[Path], list[str]]


def sources(root: Path) -> Iterator[tuple[str, str, ast.Module]]:
    """Path relative to root, text and syntax tree of each file of the package."""
    for file in sorted((root / "poekin").rglob("*.py")):
        text = file.read_text(encoding="utf-8")
        yield file.relative_to(root).as_posix(), text, parsed(text)


@functools.cache
def parsed(text: str) -> ast.Module:
    """The syntax tree of a text, which no rule changes."""
    return ast.parse(text)


@functools.cache
def nodes(tree: ast.Module) -> list[ast.AST]:
    """All nodes of a tree."""
    return list(ast.walk(tree))


@functools.cache
def imports(path: str, tree: ast.Module, root: Path) -> tuple[tuple[int, str], ...]:
    """Line and absolute dotted name of all that a file imports: anywhere in it, relative too, and
    by import_module.
    """
    return tuple(_imports(path, tree, root))


def _imports(path: str, tree: ast.Module, root: Path) -> Iterator[tuple[int, str]]:
    package = Path(path).with_suffix("").parts[:-1]
    for node in nodes(tree):
        if isinstance(node, ast.Import):
            yield from ((node.lineno, alias.name) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            above = package[: len(package) - node.level + 1] if node.level else ()
            stem = ".".join((*above, *([node.module] if node.module else [])))
            for alias in node.names:
                name = f"{stem}.{alias.name}"
                inside = root.joinpath(*name.split("."))
                # `from package import module` imports that module, `from module import name` the
                # one it is in.
                yield (
                    node.lineno,
                    name if inside.is_dir() or inside.with_suffix(".py").exists() else stem,
                )
        elif isinstance(node, ast.Call) and node.args and isinstance(node.args[0], ast.Constant):
            called = (
                node.func.attr
                if isinstance(node.func, ast.Attribute)
                else getattr(node.func, "id", "")
            )
            if called in ("import_module", "__import__"):
                yield node.lineno, resolve_name(str(node.args[0].value), ".".join(package))


def floor(dotted: str) -> float | None:
    parts = dotted.split(".")
    return FACE if len(parts) == 1 or parts[1] == "__init__" else FLOORS.get(parts[1])


def imports_upward(root: Path) -> list[str]:
    faults = []
    for path, _, tree in sources(root):
        here = floor(".".join(Path(path).with_suffix("").parts))
        if here is None:
            faults.append(f"{path}: has no floor")
            continue
        for line, name in imports(path, tree, root):
            if name.split(".")[0] != "poekin":
                continue
            there = floor(name)
            if there is None:
                faults.append(f"{path}:{line}: {name} has no floor")
            elif there > here:
                faults.append(f"{path}:{line}: floor {here:g} imports {name} of floor {there:g}")
    return faults


def formulas_that_know_arrays(root: Path) -> list[str]:
    """Formulas are undecorated scalar code: no third-party import, no decorator."""
    faults = []
    for path, _, tree in sources(root):
        if path != "poekin/algebra.py" and not path.startswith("poekin/formulas/"):
            continue
        for line, name in imports(path, tree, root):
            if name.split(".")[0] not in {"poekin", *sys.stdlib_module_names}:
                faults.append(f"{path}:{line}: imports {name}")
        for node in nodes(tree):
            for decorator in getattr(node, "decorator_list", []):
                faults.append(
                    f"{path}:{decorator.lineno}: decorator on {getattr(node, 'name', '?')}"
                )
    return faults


def optional_packages_out_of_place(root: Path) -> list[str]:
    faults, homes = [], {}
    for path, _, tree in sources(root):
        for line, name in imports(path, tree, root):
            package = name.split(".")[0]
            if package in {"poekin", *CORE, *sys.stdlib_module_names}:
                continue
            if package not in OPTIONAL:
                faults.append(
                    f"{path}:{line}: {package} is neither a core nor an optional dependency"
                )
                continue
            home = OPTIONAL[package] or homes.setdefault(package, path)
            if not (path.startswith(home) if home.endswith("/") else path == home):
                faults.append(f"{path}:{line}: {package} is imported here and belongs in {home}")
    return faults


def asserts_and_blind_excepts(root: Path) -> list[str]:
    faults = []
    for path, _, tree in sources(root):
        for node in nodes(tree):
            if isinstance(node, ast.Assert):
                faults.append(
                    f"{path}:{node.lineno}: assert (python -O drops it, and it has no message)"
                )
            elif isinstance(node, ast.ExceptHandler):
                caught = node.type.elts if isinstance(node.type, ast.Tuple) else [node.type]
                if any(
                    c is None or getattr(c, "id", "") in ("Exception", "BaseException")
                    for c in caught
                ):
                    faults.append(f"{path}:{node.lineno}: catches everything")
    return faults


def long_files(root: Path) -> list[str]:
    lengths = {path: len(text.splitlines()) for path, text, _ in sources(root)}
    return [f"{path}: {n} lines" for path, n in lengths.items() if n > 400 and path not in LONG]


def crowded_folders(root: Path) -> list[str]:
    """A folder of more than ten files wants sub-folders."""
    folders = Counter(str(Path(path).parent) for path, _, _ in sources(root))
    return [f"{folder}: {n} files" for folder, n in folders.items() if n > 10]


def circles(root: Path) -> list[str]:
    """No two modules know each other, by way of others or for types only; a package's face stands apart."""
    graph: dict[str, set[str]] = {}
    for path, _, tree in sources(root):
        if not path.endswith("__init__.py"):
            graph[module_of(path)] = {name for _, name in imports(path, tree, root)}
    reached = {module: known_through(module, graph) for module in graph}
    rings = {
        tuple(
            sorted(
                {
                    module,
                    *(
                        other
                        for other in graph
                        if other in reached[module] and module in reached[other]
                    ),
                }
            )
        )
        for module in graph
        if module in reached[module]
    }
    return [
        f"{path_of(ring[0])}: in a circle with {', '.join(ring[1:]) or 'itself'}"
        for ring in sorted(rings)
    ]


def known_through(module: str, graph: dict[str, set[str]]) -> set[str]:
    """All modules that a module imports, and that these import, and so on."""
    found: set[str] = set()
    ahead = [module]
    while ahead:
        for name in graph.get(ahead.pop(), set()) - found:
            found.add(name)
            ahead.append(name)
    return found


def module_of(path: str) -> str:
    return ".".join(Path(path).with_suffix("").parts)


def path_of(module: str) -> str:
    return module.replace(".", "/") + ".py"


def private_names_read(root: Path) -> list[str]:
    """No module takes another module's `_name`, by an import or as an attribute of the module."""
    faults = []
    for path, _, tree in sources(root):
        modules = set()
        for node in nodes(tree):
            if not isinstance(node, ast.ImportFrom) or not (
                node.level or (node.module or "").startswith("poekin")
            ):
                continue
            modules.update(alias.asname or alias.name for alias in node.names)
            for alias in node.names:
                if private(alias.name):
                    faults.append(f"{path}:{node.lineno}: imports {alias.name}")
        for node in nodes(tree):
            if not isinstance(node, ast.Attribute) or not private(node.attr):
                continue
            owner = getattr(node.value, "id", None)
            if owner in modules:
                faults.append(f"{path}:{node.lineno}: reads {owner}.{node.attr}")
    return faults


NAMED_TUPLES = ("_fields", "_replace", "_asdict", "_make")  # public, as Python's documentation says


def private(name: str) -> bool:
    return name.startswith("_") and not name.startswith("__") and name not in NAMED_TUPLES


def class_names_twice(root: Path) -> list[str]:
    """A class that others may read has a name of its own."""
    places: dict[str, list[str]] = {}
    for path, _, tree in sources(root):
        for node in nodes(tree):
            if isinstance(node, ast.ClassDef) and not private(node.name):
                places.setdefault(node.name, []).append(f"{path}:{node.lineno}")
    return [f"{' and '.join(found)}: {name}" for name, found in places.items() if len(found) > 1]


RULES: list[Rule] = [
    imports_upward, formulas_that_know_arrays, optional_packages_out_of_place, asserts_and_blind_excepts, long_files,
    crowded_folders, circles, private_names_read, class_names_twice,
]  # fmt: skip


@pytest.mark.parametrize("rule", RULES, ids=lambda r: r.__name__)
def test_the_package_keeps_the_rule(rule):
    assert list(sources(ROOT)), "no source found: nothing was checked"
    assert rule(ROOT) == []


PLANTED: list[tuple[Rule, str, str]] = [
    (imports_upward, "poekin/algebra.py", "from poekin.model import chain"),
    (imports_upward, "poekin/algebra.py", "from .model.chain import Chain"),
    (imports_upward, "poekin/algebra.py", "from . import formulas"),
    (imports_upward, "poekin/engine/run.py", "def f():\n    from ..groups import so3\n    return so3"),
    (imports_upward, "poekin/engine/run.py", "def f():\n    import poekin.model.chain as c\n    return c"),
    (imports_upward, "poekin/engine/run.py", "import importlib\nx = importlib.import_module('poekin.cli')"),
    (imports_upward, "poekin/engine/run.py", "import importlib as i\nx = i.import_module('..cli', 'poekin.engine')"),
    (imports_upward, "poekin/testing/laws.py", "import typing\nif typing.TYPE_CHECKING:\n    import poekin.analysis"),
    (imports_upward, "poekin/model/chain.py", "import poekin as pk"),
    (imports_upward, "poekin/model/chain.py", "from poekin import Chain"),
    (imports_upward, "poekin/helpers.py", "x = 1"),
    (imports_upward, "poekin/cli/main.py", "from poekin.helpers import x"),
    (formulas_that_know_arrays, "poekin/algebra.py", "import numpy as np"),
    (formulas_that_know_arrays, "poekin/formulas/forward.py", "def f():\n    from numba import njit\n    return njit"),
    (formulas_that_know_arrays, "poekin/formulas/forward.py", "import mpmath"),
    (formulas_that_know_arrays, "poekin/formulas/forward.py", "import functools\n@functools.cache\ndef f(): return 1"),
    (formulas_that_know_arrays, "poekin/formulas/forward.py", "import enum\n@enum.unique\nclass A: pass"),
    (optional_packages_out_of_place, "poekin/model/chain.py", "def f():\n    import hypothesis\n    return hypothesis"),
    (optional_packages_out_of_place, "poekin/model/robot.py", "from rich.table import Table"),
    (optional_packages_out_of_place, "poekin/model/robot.py", "import pandas"),
    (asserts_and_blind_excepts, "poekin/model/chain.py", "def f(q):\n    assert q"),
    (asserts_and_blind_excepts, "poekin/model/chain.py", "try:\n    x = 1\nexcept:\n    x = 2"),
    (asserts_and_blind_excepts, "poekin/model/chain.py", "try:\n    x = 1\nexcept Exception as e:\n    x = e"),
    (asserts_and_blind_excepts, "poekin/model/chain.py", "try:\n    x = 1\nexcept (OSError, Exception):\n    x = 2"),
    (long_files, "poekin/model/chain.py", "x = 1\n" * 401),
    (circles, "poekin/engine/run.py", "from .run import x"),
    (circles, "poekin/formulas/forward.py", "from ..formulas.forward import x"),
    (private_names_read, "poekin/model/chain.py", "from ..engine.run import _x"),
    (private_names_read, "poekin/model/chain.py", "from poekin.engine.run import _x as x"),
    (private_names_read, "poekin/model/chain.py", "from ..engine import run\ny = run._x"),
    (class_names_twice, "poekin/model/chain.py", "class Chain: pass\ndef f():\n    class Chain: pass"),
    (private_names_read, "poekin/model/chain.py", "def f():\n    from ..engine import run as r\n    return r._x()"),
]  # fmt: skip


def plant(root: Path, files: dict[str, str]) -> Path:
    """A small package that breaks no rule, with these files put in or replaced."""
    sound = {
        "poekin/__init__.py": "from poekin.model.chain import Chain",
        "poekin/errors.py": "class PoekinError(Exception): pass",
        "poekin/algebra.py": "from __future__ import annotations\nimport math",
        "poekin/formulas/__init__.py": "",
        "poekin/formulas/forward.py": "from poekin import algebra\nfrom ..algebra import math",
        "poekin/engine/run.py": "import numba\nimport numpy as np\nfrom ..formulas import forward",
        "poekin/model/chain.py": "from poekin.errors import PoekinError\nfrom ..engine.run import np\nChain = 1",
        "poekin/testing/oracle.py": "import pinocchio\nimport hypothesis",
        "poekin/testing/laws.py": "import hypothesis\nfrom poekin.model import chain",
        "poekin/analysis/validation.py": "from poekin.testing import oracle",
        "poekin/cli/main.py": "import rich\nimport typer\nfrom poekin.analysis import validation",
    }
    for path, text in {**sound, **files}.items():
        (root / path).parent.mkdir(parents=True, exist_ok=True)
        (root / path).write_text(text, encoding="utf-8")
    return root


# What `make readable` prints may not get worse than this; where a bar is reached, the bar holds.
REACHED = {"code tokens": 489_500}


def test_the_code_reads_no_worse_than_it_did():
    found = {measure.name: measure for measure in readable.measures(ROOT / "poekin")}
    bars = {name: REACHED.get(name, measure.bar) for name, measure in found.items()}
    assert [str(measure) for name, measure in found.items() if measure.value > bars[name]] == []
    # a bar that holds is no longer put lower
    assert all(found[name].value > found[name].bar for name in REACHED)


@pytest.mark.parametrize("rule", RULES, ids=lambda r: r.__name__)
def test_a_sound_package_breaks_no_rule(rule, tmp_path):
    assert rule(plant(tmp_path, {})) == []


@pytest.mark.parametrize(("rule", "path", "text"), PLANTED, ids=lambda x: getattr(x, "__name__", x))
def test_a_planted_fault_is_caught(rule, path, text, tmp_path):
    faults = rule(plant(tmp_path, {path: text}))
    assert len(faults) == 1, faults
    assert faults[0].startswith(path)


CIRCLES = [
    {"poekin/model/a.py": "from .b import x", "poekin/model/b.py": "from .a import y"},
    {"poekin/model/a.py": "from . import b", "poekin/model/b.py": "def f():\n    from .a import y"},
    {
        "poekin/model/a.py": "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from .b import x",
        "poekin/model/b.py": "from .c import y",
        "poekin/model/c.py": "from .a import z",
    },
]


@pytest.mark.parametrize("files", CIRCLES)
def test_a_circle_is_named_once_with_all_that_are_in_it(files, tmp_path):
    (first, *others) = (module_of(path) for path in files)
    assert circles(plant(tmp_path, files)) == [
        f"{path_of(first)}: in a circle with {', '.join(others)}"
    ]


def test_the_eleventh_file_of_a_folder_is_caught(tmp_path):
    ten = {f"poekin/model/m{k}.py": "" for k in range(9)}
    assert crowded_folders(plant(tmp_path, ten)) == []
    assert crowded_folders(plant(tmp_path, {"poekin/model/m9.py": ""})) == [
        "poekin/model: 11 files"
    ]


def test_an_optional_package_in_two_files_is_caught(tmp_path):
    twice = {
        "poekin/analysis/a.py": "import scipy",
        "poekin/solve/b.py": "def f():\n    import scipy.optimize",
    }
    faults = optional_packages_out_of_place(plant(tmp_path, twice))
    assert faults == [
        "poekin/solve/b.py:2: scipy is imported here and belongs in poekin/analysis/a.py"
    ]
