"""Tests that judge a mutant, those near its module and then all that could see it, and its mode.

Near are the tests that are called like the module, `test_<module>*.py` in its room, those that
import it, and then those of the modules that import it, the nearest ones first. A mutant that these
let through has not survived until the second set, the tests of its room and of the rooms that say
most about it, has let it through too. Where tests are called after topics, as those of the formulas
are, `NEAR` names them.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator
from enum import Enum
from fnmatch import fnmatchcase
from functools import cache
from pathlib import Path

from . import names
from .mutants import PACKAGE, paths, room
from .near import BY_ARMS, CHAINS, DH, EVERYWHERE, GROUPS, LAST, NEAR

ROOT = Path(__file__).resolve().parents[2]
TESTS = ROOT / "tests"


class Mode(Enum):
    """Mode in which the judged code runs."""

    INTERPRETED = "interpreted"
    """Nothing is compiled: a formula, or what Numba compiles, runs as it is written."""
    COLD = "cold"
    """Everything is compiled anew for each mutant, as the mutant is part of what compiles."""
    WARM = "warm"
    """Numba's kernels, whose source is not the mutant's, come from the cache; the code of an arm is
    made anew.
    """
    SHARED = "shared"
    """As WARM for a part of the engine, whose text is in the cache's key: all kernels but those
    that its text is in.
    """


_INTERPRETED = (
    "algebra formulas/ engine/array_io engine/chain_kernels engine/count engine/derivative_kernels"
    " engine/group_kernels engine/interpret engine/program engine/sincos engine/specialise"
    " engine/trace engine/tree_kernels"
)
_COMPILING = (
    "engine/cache engine/cache_size engine/compile engine/kernel engine/locks engine/source_hash"
)

_FACE = "poekin/__init__.py"  # imports everything, and says nothing of what is near
_MOST_NEAR = 6  # files of tests that are found by name

_ALL_FORMULAS = (
    "formulas/ groups/"
    f" {CHAINS} model/compiled model/derivatives model/pose_jacobian model/analytic model/hp"
    " model/tree model/robot_coordinates model/checks model/screw"
    " engine/count engine/interpret engine/trace engine/sincos"
    " testing/error_bounds testing/exact testing/laws testing/differences testing/pinocchio_oracle"
    " analysis/count analysis/axes analysis/manipulability analysis/singularity"
    " formats/dh formats/rpy formats/emit_python formats/objects_pinocchio"
)
_COMPILED_ARMS = "model/compiled formats/emit_c formats/emit_javascript formats/emit_python"
_BY_MODEL = (
    "formats/dh formats/mjcf formats/objects formats/relinked formats/rpy formats/serial formats/ur"
    " formats/urdf analysis/axes analysis/compare_extra testing/chain_strategies cli/info"
)
WHOLE = {
    "__init__ errors": "errors public_names cli/ formats/",
    "checks": "checks model/ formats/ analysis/ solve/",
    f"{_INTERPRETED} groups/": _ALL_FORMULAS,
    "engine/": f"engine/ {_COMPILED_ARMS} {BY_ARMS} {CHAINS} {GROUPS}",
    "model/": f"model/ {_COMPILED_ARMS} {_BY_MODEL}",
    "formats/": "formats/ cli/",
    "formats/dh/": f"{DH} formats/dh_calibrated cli/dh",
    "analysis/": "analysis/ cli/",
    "solve/": "solve/ cli/",
    "solve/calibration/": "solve/calibration/ cli/calibrate",
    "html_page svg": "html_page solve/ view/",
    "view/": "view/ cli/",
    "sweep/": "sweep/ cli/sweep/",
    "testing/": f"testing/ groups/ {CHAINS} cli/conform cli/validate",
    "cli/": "cli/",
}

# Tests that say something about compiled code, and fail in the interpreter without any mutant.
APART = (
    "engine/compile",
    "engine/program::test_machine_code_gives_what_was_recorded",
    # the scalars of a NumPy row warn where compiled code quietly gives NaN
    "groups/near::test_a_reference_that_is_no_number_gives_nan",
    "model/checks::test_what_is_no_pose_is_refused",
)
# Tests that begin processes: the key of the source holds the mutant there, and in the judging one
# the text as it was, so that each refuses what the other has kept, whatever the mutant does.
OF_PROCESSES = (
    "engine/cache",
    "sweep/execution/pose_sweep::test_processes_and_runs_that_were_killed_give_the_same_bytes",
    "sweep/execution/store::test_a_run_that_is_killed_again_and_again_goes_on_where_it_was",
)


def mode(path: str) -> Mode:
    """Mode in which the tests of a module's mutants run."""
    if names.among(_INTERPRETED, path):
        return Mode.INTERPRETED
    if names.among(_COMPILING, path):
        return Mode.COLD
    return Mode.SHARED if room(path) == "engine" else Mode.WARM


def kernels_of(path: str) -> list[str]:
    """The kernels that a module of the engine is compiled into: its own, and those of the modules
    that import it.
    """
    seen, row = {path}, [path]
    while row:
        row = [
            other for module in row for other in importers().get(module, ()) if other not in seen
        ]
        row = [other for other in row if room(other) == "engine"]
        seen.update(row)
    return sorted(name for module in seen for name in _kernels_in(module))


def _kernels_in(path: str) -> Iterator[str]:
    for node in ast.parse((ROOT / path).read_text(encoding="utf-8")).body:
        calls = [
            call.func for call in getattr(node, "decorator_list", ()) if isinstance(call, ast.Call)
        ]
        if isinstance(node, ast.FunctionDef) and any(
            isinstance(f, ast.Name) and f.id == "kernel" for f in calls
        ):
            yield node.name


def near(path: str) -> list[list[str]]:
    """Arguments of pytest's first two runs for a module: the quickest file, and the others."""
    files = names.longest(NEAR, path, _own_tests(path)) or _called_like(path)
    last = names.longest(LAST, path) or [names.test(name) for name in EVERYWHERE.split()]
    files = list(dict.fromkeys([*files, *last]))
    return [[*part, *_apart(path)] for part in (files[:1], files[1:]) if part]


def whole(path: str) -> list[str]:
    """Arguments of pytest for the mutants that are left."""
    return [*names.longest(WHOLE, path), *_apart(path)]


def _called_like(path: str) -> list[str]:
    """The tests of a module, then those of what imports it; a room's own before another's."""
    found: dict[str, None] = {}
    seen, row = {path}, [path]
    while row and len(found) < _MOST_NEAR:
        for module in row:
            found.update(dict.fromkeys(_own_tests(module)))
        for module in row:
            found.update(dict.fromkeys(_importing_tests(module)))
        row = [
            other for module in row for other in importers().get(module, ()) if other not in seen
        ]
        row = sorted(set(row), key=lambda other: _rank(other, path))
        seen.update(row)
    return list(found)[:_MOST_NEAR] or names.longest(WHOLE, path)[:1]


def _own_tests(path: str) -> Iterator[str]:
    """Files of tests in a module's room that have its name, or its folder's before it or alone."""
    *folders, name = path.removesuffix(".py").split("/")[1:]
    words = [name]
    if not TESTS.joinpath(*folders).is_dir():  # the tests of a folder may lie beside one another
        words = [f"{folders[-1]}_{name}", name, folders[-1]]
    for word in words:
        for pattern in (f"test_{word}.py", f"test_{word}_*.py", f"test_{word}?.py"):
            yield from _nearest(tuple(folders), pattern)


@cache
def _nearest(folders: tuple[str, ...], pattern: str) -> list[str]:
    """Files of tests with such a name in the innermost folder around a module that has any."""
    for k in range(len(folders), -1, -1):
        folder = "/".join(["tests", *folders[:k], ""])
        below = [file for file in _test_files() if file.startswith(folder)]
        if k == 0:
            below = [file for file in below if file.count("/") == 1]
        found = [file for file in below if fnmatchcase(file.rpartition("/")[2], pattern)]
        if found:
            return found
    return []


@cache
def _test_files() -> list[str]:
    """All files of tests, relative to the root of the repository."""
    return sorted(file.relative_to(ROOT).as_posix() for file in TESTS.rglob("test_*.py"))


@cache
def importers() -> dict[str, list[str]]:
    """Of each module those that import it."""
    return _users([path for path in paths(ROOT) if path != _FACE])


@cache
def _tests_by_module() -> dict[str, list[str]]:
    rooms = {folder.name for folder in TESTS.iterdir() if (ROOT / PACKAGE / folder.name).is_dir()}
    return _users([file for file in _test_files() if file.split("/")[1] in rooms])


def _importing_tests(path: str) -> list[str]:
    """The files of tests that import a module, those of its room first."""
    return sorted(_tests_by_module().get(path, ()), key=lambda test: _rank(test, path))


def _rank(file: str, path: str) -> tuple[bool, str, str, str]:
    """Order of files beside a module: its room, then others; in a room by name, in any folder."""
    place = file.split("/")[1]
    return place != path.split("/")[1], place, file.split("/")[-1], file


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
            base = "/".join(
                [*path.split("/")[: -node.level], *(node.module or "").split(".")]
            ).rstrip("/")
            yield f"{base}.py"
            yield f"{base}/__init__.py"
            yield from (f"{base}/{alias.name}.py" for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and (node.module or "").startswith(PACKAGE):
            base = (node.module or "").replace(".", "/")
            yield f"{base}.py"
            yield from (
                f"{base}/{alias.name}{end}"
                for alias in node.names
                for end in (".py", "/__init__.py")
            )


def _apart(path: str) -> list[str]:
    left_out = {Mode.INTERPRETED: (*APART, *OF_PROCESSES), Mode.SHARED: OF_PROCESSES}.get(
        mode(path), ()
    )
    return [names.argument(f"--deselect={test}") for test in left_out]
