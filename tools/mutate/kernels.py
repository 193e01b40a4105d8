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
_OF_AN_ARM = "arm-"


def main() -> None:
    """Make every kernel of the package ready, in the cache that POEKIN_CACHE_DIR names."""
    from poekin import engine
    from poekin.engine.jit.kernel import Kernel

    for info in pkgutil.walk_packages(engine.__path__, f"{engine.__name__}."):
        for value in vars(importlib.import_module(info.name)).values():
            if isinstance(value, Kernel):
                value.ready()


def prepared(root: Path, place: Path) -> Path:
    """A cache in `place` with every kernel of the package; what this user's own cache has is
    copied.
    """
    place.mkdir(mode=0o700)
    known = _user_cache(root)
    for entry in known.glob("*.kernel") if known else ():
        if not entry.name.startswith(_OF_AN_ARM):
            with contextlib.suppress(OSError):
                shutil.copy2(entry, place)
    settings = {**os.environ, "POEKIN_CACHE_DIR": str(place), "PYTHONPATH": str(root)}
    subprocess.run(
        [sys.executable, "-m", "tools.mutate.kernels"], cwd=root, env=settings, check=True
    )
    return place


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
            if entry.name.rpartition("-")[0] not in without:
                os.link(entry, place / entry.name)  # an entry is never written to, only replaced
        yield str(place)
    finally:
        shutil.rmtree(place, ignore_errors=True)


if __name__ == "__main__":
    main()
