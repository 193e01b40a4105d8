"""Which tests judge a mutant, and how its code runs: first the tests near its module, then all that could see it.

Near are the tests that are called like the module, `tests/<room>/test_<module>*.py`, those that import it, and then
those of the modules that import it, the nearest ones first. A mutant that these let through has not survived until the
second set, the tests of its room and of the rooms that say most about it, has let it through too. Where tests are
called after topics, as those of the formulas are, `NEAR` names them.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator
from enum import Enum
from functools import cache
from pathlib import Path

from .mutants import PACKAGE, paths, room
from .near import BY_ARMS, CHAINS, DH, GROUPS, NEAR

ROOT = Path(__file__).resolve().parents[2]


class Mode(Enum):
    """How the code runs that is judged."""

    INTERPRETED = "interpreted"
    """Nothing is compiled: a mutant of a formula, or of what Numba compiles, runs as it is written."""
    COLD = "cold"
    """Everything is compiled anew for each mutant, as the mutant is part of what compiles."""
    WARM = "warm"
    """Numba's kernels, whose source is not the mutant's, come from the cache; the code of an arm is made anew."""
    SHARED = "shared"
    """As WARM for a part of the engine, whose text is in the cache's key: all kernels but those that its text is in."""


_INTERPRETED = (
    "chain_kernels", "count", "derivative_kernels", "group_kernels", "interpret", "program", "rows", "sincos",
    "specialise", "trace", "tree_kernels",
)  # fmt: skip
_COMPILING = tuple(f"poekin/engine/{name}.py" for name in ("__init__", "cache", "compile", "kernel", "source"))
_FORMULAS = ("poekin/algebra.py", "poekin/formulas/", *(f"poekin/engine/{name}.py" for name in _INTERPRETED))

_FACE = "poekin/__init__.py"  # imports everything, and says nothing of what is near
_MOST_NEAR = 6  # files of tests that are found by name

_ALL_FORMULAS = (
    "tests/formulas",
    "tests/groups",
    *(f"tests/model/test_{name}.py" for name in (
        "chain", "chain_laws", "compiled", "derivatives", "evaluation", "analytic", "hp", "tree", "robot_coordinates",
        "parts", "screw")),
    *(f"tests/engine/test_{name}.py" for name in ("count", "interpret", "trace", "sincos")),
    *(f"tests/testing/test_{name}.py" for name in ("attainable", "exact", "laws", "differences", "pinocchio_oracle")),
    *(f"tests/analysis/test_{name}.py" for name in ("count", "axes", "manipulability", "singularity")),
    *(f"tests/formats/test_{name}.py" for name in ("dh", "rpy", "emit_python", "objects_pinocchio")),
)  # fmt: skip
_ALL_DH = (*DH, "tests/formats/test_dh_calibrated.py", "tests/cli/test_dh.py")
_COMPILED_ARMS = ("tests/model/test_compiled.py", "tests/formats/test_emit_c.py", "tests/formats/test_emit_python.py")
_BY_MODEL = (
    *(f"tests/formats/test_{name}.py" for name in ("dh", "mjcf", "objects", "relink", "rpy", "serial", "ur", "urdf")),
    *(f"tests/analysis/test_{name}.py" for name in ("axes", "compare_extra")),
    "tests/testing/test_chain_strategies.py",
    "tests/cli/test_info.py",
)
WHOLE: dict[str, tuple[str, ...]] = {
    "poekin/": ("tests/test_errors.py", "tests/test_public_names.py", "tests/cli", "tests/formats"),
    "poekin/algebra.py": _ALL_FORMULAS,
    "poekin/formulas/": _ALL_FORMULAS,
    "poekin/groups/": _ALL_FORMULAS,
    "poekin/engine/": ("tests/engine", *_COMPILED_ARMS, *BY_ARMS, *CHAINS, *GROUPS),
    **{f"poekin/engine/{name}.py": _ALL_FORMULAS for name in _INTERPRETED},
    "poekin/model/": ("tests/model", *_COMPILED_ARMS, *_BY_MODEL),
    "poekin/formats/": ("tests/formats", "tests/cli"),
    "poekin/formats/dh/": _ALL_DH,
    "poekin/analysis/": ("tests/analysis", "tests/cli"),
    "poekin/solve/": ("tests/solve", "tests/cli"),
    "poekin/solve/calibration/": ("tests/solve/calibration", "tests/cli/test_calibrate.py"),
    "poekin/testing/": (
        "tests/testing", "tests/groups", *CHAINS, "tests/cli/test_conform.py", "tests/cli/test_validate.py"),
    "poekin/cli/": ("tests/cli",),
}  # fmt: skip

# Tests that say something about compiled code, and fail in the interpreter without any mutant.
APART = (
    "tests/engine/test_compile.py",
    "tests/engine/test_program.py::test_machine_code_gives_what_was_recorded",
    # the scalars of a NumPy row warn where compiled code quietly gives NaN
    "tests/groups/test_near.py::test_a_reference_that_is_no_number_gives_nan",
    "tests/model/test_parts.py::test_what_is_no_pose_is_refused",
)


def mode(path: str) -> Mode:
    """How the tests of a module's mutants run."""
    if path.startswith(_FORMULAS):
        return Mode.INTERPRETED
    if path in _COMPILING:
        return Mode.COLD
    return Mode.SHARED if room(path) == "engine" else Mode.WARM


def kernels_of(path: str) -> list[str]:
    """The kernels that a module of the engine is compiled into: its own, and those of the modules that import it."""
    seen, row = {path}, [path]
    while row:
        row = [other for module in row for other in importers().get(module, ()) if other not in seen]
        row = [other for other in row if room(other) == "engine"]
        seen.update(row)
    return sorted(name for module in seen for name in _kernels_in(module))


def _kernels_in(path: str) -> Iterator[str]:
    for node in ast.parse((ROOT / path).read_text(encoding="utf-8")).body:
        calls = [call.func for call in getattr(node, "decorator_list", ()) if isinstance(call, ast.Call)]
        if isinstance(node, ast.FunctionDef) and any(isinstance(f, ast.Name) and f.id == "kernel" for f in calls):
            yield node.name


def near(path: str) -> list[list[str]]:
    """What pytest is given first for a module, in one run after the other: the quickest file, then the others."""
    declared = [start for start in NEAR if path.startswith(start)]
    files = NEAR[max(declared, key=len)] if declared else tuple(_called_like(path))
    return [[*part, *_apart(path)] for part in (files[:1], files[1:]) if part]


def whole(path: str) -> list[str]:
    """What pytest is given to judge what is left."""
    return [*WHOLE[_longest(WHOLE, path)], *_apart(path)]


def _called_like(path: str) -> list[str]:
    """The tests of a module, then those of what imports it; a room's own before another's."""
    found: dict[str, None] = {}
    seen, row = {path}, [path]
    while row and len(found) < _MOST_NEAR:
        for module in row:
            found.update(dict.fromkeys(_own_tests(module)))
        for module in row:
            found.update(dict.fromkeys(_importing_tests(module)))
        row = [other for module in row for other in importers().get(module, ()) if other not in seen]
        row = sorted(set(row), key=lambda other: (room(other) != room(path), other))
        seen.update(row)
    return list(found)[:_MOST_NEAR] or [WHOLE[_longest(WHOLE, path)][0]]


def _own_tests(path: str) -> Iterator[str]:
    """The files of tests that have a module's name, or that of its folder and its own."""
    *folders, name = path.removesuffix(".py").split("/")[1:]
    folder = ROOT / "tests" / "/".join(folders)
    names = [name]
    while not folder.is_dir():  # the tests of a folder may lie beside one another
        names = [f"{folder.name}_{names[0]}", *names[:1], folder.name]
        folder = folder.parent
    for word in names:
        for pattern in (f"test_{word}.py", f"test_{word}_*.py", f"test_{word}?.py"):
            yield from (file.relative_to(ROOT).as_posix() for file in sorted(folder.glob(pattern)))


@cache
def importers() -> dict[str, list[str]]:
    """Of each module those that import it."""
    return _users([path for path in paths(ROOT) if path != _FACE])


@cache
def _tests_by_module() -> dict[str, list[str]]:
    rooms = [folder for folder in (ROOT / "tests").iterdir() if (ROOT / PACKAGE / folder.name).is_dir()]
    return _users([file.relative_to(ROOT).as_posix() for folder in rooms for file in folder.rglob("test_*.py")])


def _importing_tests(path: str) -> list[str]:
    """The files of tests that import a module, those of its room first."""
    return sorted(_tests_by_module().get(path, ()), key=lambda test: (test.split("/")[1] != room(path), test))


def _users(files: Iterable[str]) -> dict[str, list[str]]:
    known = set(paths(ROOT)) - {_FACE}
    found: dict[str, list[str]] = {}
    for path in sorted(files):
        for imported in sorted(set(_imports(path)) & known - {path}):
            found.setdefault(imported, []).append(path)
    return found


def _imports(path: str) -> Iterator[str]:
    """What a file imports of the package, as paths; some of them may be no files."""
    for node in ast.walk(ast.parse((ROOT / path).read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.level:
            base = "/".join([*path.split("/")[: -node.level], *(node.module or "").split(".")]).rstrip("/")
            yield f"{base}.py"
            yield f"{base}/__init__.py"
            yield from (f"{base}/{alias.name}.py" for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and (node.module or "").startswith(PACKAGE):
            base = (node.module or "").replace(".", "/")
            yield f"{base}.py"
            yield from (f"{base}/{alias.name}{end}" for alias in node.names for end in (".py", "/__init__.py"))


def _longest(known: Iterable[str], path: str) -> str:
    return max((start for start in known if path.startswith(start)), key=len)


def _apart(path: str) -> list[str]:
    return [f"--deselect={test}" for test in APART] if mode(path) is Mode.INTERPRETED else []
