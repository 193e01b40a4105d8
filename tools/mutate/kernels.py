"""Compiled kernels for mutants: made once from the source as it is, handed out by links, and never
taken from a mutant.

The cache's key covers the source of algebra, formulas and engine, so a mutant there finds nothing
of the others. Where it takes part in compiling it is given an empty place. Any other mutant is
given a place of its own with the kernels of Numba, whose whole source is in their key, but not with
the code of an arm, which depends on what the model makes of the arm, and so on the mutant. To use
kernels with a mutant of the engine, its process is told the key of the source as it is, and the
kernels that the mutant is compiled into are not among them either.
"""

from __future__ import annotations

import contextlib
import importlib
import os
import pkgutil
import shutil
import subprocess
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path

from .suites import Mode

TAKING = (Mode.WARM, Mode.SHARED)
MAKING = (Mode.COLD, Mode.SHARED)  # a test may have to compile kernels
_OF_AN_ARM = "arm-"
_PROCESSES = 2  # each compiles on one processor


def main(begin: int = 0, step: int = 1) -> None:
    """Make the kernels of the package ready, in the cache that POEKIN_CACHE_DIR names: of their row
    every `step`-th one. Names the files that hold them, one a line.
    """
    from poekin import engine
    from poekin.engine.jit import cache
    from poekin.engine.jit.kernel import Kernel

    found: dict[int, Kernel] = {}
    for info in pkgutil.walk_packages(engine.__path__, f"{engine.__name__}."):
        for value in vars(importlib.import_module(info.name)).values():
            if isinstance(value, Kernel):
                found[id(value)] = value
    for kernel in list(found.values())[begin::step]:
        kernel.ready()
    for file in sorted(cache.used):
        print(file.name)


def prepared(root: Path, place: Path) -> Path:
    """A cache in `place` with every kernel of the package, each once; what this user's own cache has
    is copied.
    """
    place.mkdir(mode=0o700)
    known = _user_cache(root)
    for entry in known.glob("*.kernel") if known else ():
        if not entry.name.startswith(_OF_AN_ARM):
            with contextlib.suppress(OSError):
                shutil.copy2(entry, place)
    of_this_source = _making(root, place)
    names = {_name(file) for file in of_this_source}
    for entry in place.iterdir():  # each is linked for every mutant: none of another source
        if entry.name not in of_this_source and _name(entry.name) in names:
            entry.unlink()
    return place


def _making(root: Path, place: Path) -> set[str]:
    """The files of all kernels of the source, which are made by several processes at a time."""
    settings = {**os.environ, "POEKIN_CACHE_DIR": str(place), "PYTHONPATH": str(root)}
    command = [sys.executable, "-m", "tools.mutate.kernels"]
    making = [
        subprocess.Popen(
            [*command, str(k), str(_PROCESSES)],
            cwd=root,
            env=settings,
            stdout=subprocess.PIPE,
            text=True,
        )
        for k in range(_PROCESSES)
    ]
    of_this_source: set[str] = set()
    for process in making:
        said, _ = process.communicate()
        if process.returncode:
            raise subprocess.CalledProcessError(process.returncode, process.args)
        of_this_source.update(said.split())
    return of_this_source


def _name(file: str) -> str:
    """The name of the kernel that an entry of the cache holds."""
    return file.rpartition("-")[0]


def _user_cache(root: Path) -> Path | None:
    ask = "from poekin.engine.jit.cache import directory; print(directory() or '')"
    command = [sys.executable, "-c", ask]
    said = subprocess.run(command, cwd=root, capture_output=True, text=True, check=True)
    return Path(said.stdout.strip()) if said.stdout.strip() else None


@contextlib.contextmanager
def offered(
    known: Path | None, mode: Mode, place: Path, without: Iterable[str] = ()
) -> Iterator[str]:
    """What POEKIN_CACHE_DIR is for one job: nothing, or a place of its own, without the kernels of
    these names.
    """
    if mode is Mode.INTERPRETED:
        yield ""
        return
    place.mkdir(mode=0o700)
    try:
        for entry in known.iterdir() if known and mode in TAKING else ():
            if _name(entry.name) not in without:
                os.link(entry, place / entry.name)  # an entry is never written to, only replaced
        yield str(place)
    finally:
        shutil.rmtree(place, ignore_errors=True)


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
