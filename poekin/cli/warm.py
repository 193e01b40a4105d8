"""`poekin warm`: all kernels compiled and kept, for images and classrooms."""

from __future__ import annotations

import time

from ..engine.warm import kernels
from ..errors import FileError
from ..progress_line import ProgressLine
from .kinematics.arm import Json
from .output import as_json, path_text, say


def command(json: Json = False) -> None:
    """Compile all kernels once and keep them in the cache directory (POEKIN_CACHE_DIR, or the
    user's). Exit code 0 done, 2 where nothing can be kept.
    """
    from ..engine.jit import cache  # which loads Numba: no other command has to wait for it

    place = cache.usable_directory()
    if place is None:
        raise FileError(
            "no cache directory can be used: POEKIN_CACHE_DIR=DIRECTORY names one that nobody else may write"
        )
    start = time.monotonic()
    found = kernels()
    with ProgressLine("compiling") as progress:
        for done, (name, kernel) in enumerate(found.items()):
            progress(done, len(found), name)
            kernel.ready()
    kept = [entry for entry in cache.used if entry.parent == place and entry.exists()]
    if len(kept) < len(found):
        raise FileError(
            f"{len(found)} kernels were compiled, and {path_text(place)} keeps {len(kept)}: it cannot be written, or"
            " POEKIN_CACHE_SIZE is too small"
        )
    seconds = time.monotonic() - start
    if json:
        print(as_json({"kernels": len(found), "directory": str(place), "seconds": seconds}))
    else:
        size = sum(entry.stat().st_size for entry in kept) / cache.MIB
        say(f"{len(found)} kernels in {path_text(place)}, {size:.1f} MiB, {seconds:.0f} s")
