"""What `import poekin` brings: every public name exists and is documented, and no optional package
comes along.
"""

from __future__ import annotations

import importlib
import inspect
import json
import pkgutil
import subprocess
import sys
import types
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def undocumented(module: types.ModuleType) -> list[str]:
    """Names of `__all__` that do not exist, and modules, classes and functions without a docstring."""
    faults = [] if inspect.getdoc(module) else [f"{module.__name__}: no docstring"]
    for name in getattr(module, "__all__", ()):
        if not hasattr(module, name):
            faults.append(f"{module.__name__}: no {name}")
            continue
        thing = getattr(module, name)
        own = (
            thing.__doc__
            if inspect.isclass(thing) or inspect.ismodule(thing) or inspect.isroutine(thing)
            else "data"
        )
        if not own:
            faults.append(f"{module.__name__}.{name}: no docstring")
    return faults


def test_every_public_name_exists_and_is_documented():
    package = importlib.import_module("poekin")
    names = [
        m.name
        for m in pkgutil.walk_packages(package.__path__, "poekin.")
        if not m.name.endswith("__main__")
    ]
    faults = [f for name in ["poekin", *names] for f in undocumented(importlib.import_module(name))]
    assert faults == []
    assert len(package.__all__) == len(set(package.__all__)) > 0


def test_a_missing_and_an_undocumented_name_are_caught():
    module = types.ModuleType("m", "A module.")
    exec(
        "__all__ = ['gone', 'bare', 'Bare', 'told', 'number']\ndef bare(): pass\nclass Bare: pass\nnumber = 1",
        vars(module),
    )
    exec("def told():\n    'Documented.'\ndef _private(): pass", vars(module))
    assert undocumented(module) == ["m: no gone", "m.bare: no docstring", "m.Bare: no docstring"]
    assert undocumented(types.ModuleType("n")) == ["n: no docstring"]


def modules_loaded_by(statement: str, root: Path) -> set[str]:
    """Top-level modules outside the standard library that are loaded after a statement in a new
    interpreter.
    """
    code = f"import sys, json; sys.path.insert(0, {str(root)!r})\n{statement}\nprint(json.dumps(sorted(sys.modules)))"
    done = subprocess.run(
        [sys.executable, "-I", "-W", "error", "-c", code],
        capture_output=True,
        text=True,
        check=True,
    )
    return {m.split(".")[0] for m in json.loads(done.stdout.splitlines()[-1])} - set(
        sys.stdlib_module_names
    )


def imports_beyond_the_core(root: Path) -> set[str]:
    # The baseline: what the core dependencies themselves load where optional packages happen to be
    # installed.
    core = modules_loaded_by("import numpy, numba, numba.extending, lxml.etree", root)
    return modules_loaded_by("import poekin", root) - core - {"poekin"}


def test_importing_poekin_imports_only_the_core_dependencies():
    assert imports_beyond_the_core(ROOT) == set()


def test_numba_waits_for_the_first_kernel_and_no_command_loads_it_before():
    loaded = modules_loaded_by("import poekin.cli.commands", ROOT)
    assert {"poekin", "typer"} <= loaded
    assert {"numba", "llvmlite"} & loaded == set()
    assert "numba" in modules_loaded_by("import poekin.engine.jit.cache", ROOT)


def test_an_optional_package_imported_with_poekin_is_caught(tmp_path):
    (tmp_path / "poekin").mkdir()
    (tmp_path / "poekin" / "__init__.py").write_text(
        "import numpy\nfrom poekin import chain", encoding="utf-8"
    )
    (tmp_path / "poekin" / "chain.py").write_text("import tomli_w", encoding="utf-8")
    assert imports_beyond_the_core(tmp_path) == {"tomli_w"}
