"""Build the wheel, and use it in a new environment where the source tree cannot be imported.

Run by `make wheel-check`. The wheel is built from the source distribution, so both are checked. The
environment holds the core dependencies only; `wheel_use.py` runs there, isolated and with warnings
as errors, from a temporary directory.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tarfile
import tempfile
import venv
import zipfile
from collections.abc import Iterable
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def faults_of_wheel(names: Iterable[str]) -> list[str]:
    """What is wrong with a wheel of these files: something else than the package in it, or
    something lacking.
    """
    names = list(names)
    faults = [
        f"not a part of the package: {n}" for n in names if not n.startswith(("poekin/", "poekin-"))
    ]
    faults += [
        f"not wanted in a wheel: {n}"
        for n in names
        if "__pycache__" in n or n.endswith((".pyc", ".nbi", ".nbc"))
    ]
    wanted = {
        "poekin/__init__.py": 1,
        "poekin/py.typed": 1,
        "/LICENSE": 1,
        "entry_points.txt": 1,
        ".urdf": 3,
    }
    for ending, least in wanted.items():
        found = sum(n.endswith(ending) for n in names)
        if found < least:
            faults.append(f"{least} file(s) *{ending} expected, {found} found")
    return faults


def faults_of_sdist(names: Iterable[str]) -> list[str]:
    """What a source distribution of these files lacks: a packager runs the tests from it."""
    inside = {n.split("/", 1)[1] for n in names if "/" in n}
    wanted = (
        "pyproject.toml",
        "README.md",
        "LICENSE",
        "Makefile",
        "constraints.txt",
        "constraints-lowest.txt",
        "CITATION.cff",
        "SECURITY.md",
        "recipe/recipe.yaml",
        "poekin/__init__.py",
        "tests/conftest.py",
    )
    folders = ("tests/", "benchmarks/", "docs/", "notebooks/", "tools/")
    return [f"not in the source distribution: {n}" for n in wanted if n not in inside] + [
        f"nothing of {f} in the source distribution"
        for f in folders
        if not any(n.startswith(f) for n in inside)
    ]


def run(*command: str | Path, cwd: Path) -> None:
    """Run a command without this process's Python settings, and end with its message when it fails."""
    clean = {
        k: v for k, v in os.environ.items() if not k.startswith("PYTHON") and k != "VIRTUAL_ENV"
    }
    done = subprocess.run(
        [str(c) for c in command], cwd=cwd, env=clean, text=True, capture_output=True
    )
    print(done.stdout, end="", flush=True)
    if done.returncode:
        sys.exit(
            f"{done.stderr}failed with exit code {done.returncode}: {' '.join(map(str, command))}"
        )


def main() -> None:
    with tempfile.TemporaryDirectory(prefix="poekin-wheel-") as place:
        there = Path(place)
        print("Building the source distribution, and the wheel from it", flush=True)
        dist = there / "dist"
        # No isolation: the build uses the pinned hatchling of this environment.
        run(sys.executable, "-m", "build", "--no-isolation", "--outdir", dist, ROOT, cwd=there)
        (wheel,), (sdist,) = dist.glob("*.whl"), dist.glob("*.tar.gz")
        with zipfile.ZipFile(wheel) as z, tarfile.open(sdist) as t:
            faults = faults_of_wheel(z.namelist()) + faults_of_sdist(t.getnames())
        if faults:
            sys.exit("\n".join(faults))

        print("Installing the wheel with its core dependencies only", flush=True)
        venv.create(there / "env", with_pip=True)
        python = there / "env" / "bin" / "python"
        pip = (python, "-m", "pip", "install", "-qq", "--disable-pip-version-check")
        run(*pip, "-c", ROOT / "constraints.txt", wheel, cwd=there)

        print("Using it", flush=True)
        shutil.copy(ROOT / "tools" / "wheel_use.py", there)
        # -I: neither the current directory nor PYTHONPATH nor a user site can lend a module.
        run(python, "-I", "-W", "error", "wheel_use.py", ROOT, cwd=there)


if __name__ == "__main__":
    main()
