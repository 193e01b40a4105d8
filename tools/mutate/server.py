"""The process that runs mutants: it has the libraries loaded, and forks a child for each run of
pytest.

It works in its own copy of the tree (the current directory), where it writes a mutant and takes it
back. One job a line comes in as JSON, one answer goes out. The first argument is the place of the
kernels that are compiled already, or "".
"""

from __future__ import annotations

import contextlib
import functools
import gc
import importlib
import itertools
import json
import os
import resource
import select
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

from . import kernels
from .suites import Mode

LIBRARIES = (
    "csv", "lxml.etree", "numpy", "numpy.testing", "llvmlite.binding", "numba", "numba.extending",
    "numba.core.serialize", "mpmath", "hypothesis", "hypothesis.strategies", "hypothesis.extra.numpy", "pytest",
    "_pytest.assertion.rewrite", "scipy.linalg", "scipy.optimize", "scipy.spatial.transform", "pinocchio", "yaml",
    "tomli_w", "typer", "rich", "spatialmath", "example_robot_data",
)  # fmt: skip
# what they do at the end of a run takes longer than most runs
_NOT_NEEDED = ("cacheprovider", "faulthandler", "unraisableexception", "threadexception")
SETTINGS = {
    "CI": "1",
    "PYTHONHASHSEED": "0",
    "OPENBLAS_NUM_THREADS": "1",
    "OMP_NUM_THREADS": "1",
    "JUPYTER_PLATFORM_DIRS": "1",
    "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1",
}
KEY = "MUTANTS_SOURCE_KEY"
COMPILES = "MUTANTS_COMPILE_KERNELS"
PLUGINS = ("_hypothesis_pytestplugin", "pytest_timeout", *(f"no:{name}" for name in _NOT_NEEDED))
# when the files of a copy were written; each mutant a second later than the one before it, so that no
# bytecode can pass for that of another text
EPOCH = 1_000_000_000
_SECONDS_LATER = itertools.count(1)
_MEMORY = 4 * 2**30
_WALL = 1800.0  # s, of one run of pytest: only a child that sleeps gets there


def main() -> None:
    """Answer jobs until the input ends, with the libraries loaded that the command line names."""
    known = Path(sys.argv[1]) if sys.argv[1] else None
    for name in sys.argv[2:]:
        with contextlib.suppress(ImportError):  # what the tests do without, or skip
            importlib.import_module(name)
    gc.freeze()
    for line in sys.stdin:
        job = json.loads(line)
        mode = Mode(job["mode"])
        with kernels.offered(known, mode, Path(f"{Path.cwd()}-kernels"), job["without"]) as place:
            compiling = {
                "POEKIN_CACHE_DIR": place,
                "NUMBA_DISABLE_JIT": str(int(mode is Mode.INTERPRETED)),
            }
            shared = _source_key(Path.cwd()) if mode is Mode.SHARED else ""
            answer = answered(
                Path.cwd(),
                job["path"],
                job["source"],
                job["sessions"],
                {**compiling, KEY: shared, COMPILES: str(int(mode in kernels.MAKING))},
            )
        print(json.dumps(answer), flush=True)


@functools.cache
def _source_key(tree: Path) -> str:
    """The cache's key of the source as it is; asked in a child, as this process is to load nothing
    of the package.
    """
    ask = "from poekin.engine.jit.source_hash import LOADED; print(LOADED)"
    return subprocess.run(
        [sys.executable, "-c", ask], cwd=tree, capture_output=True, text=True, check=True
    ).stdout.strip()


def answered(
    tree: Path, path: str, source: str | None, sessions: list[list[str]], settings: dict[str, str]
) -> dict[str, Any]:
    """The outcome of the sessions, run in order up to the first that fails, with the mutant in
    place of its module.
    """
    file = tree / path if source is not None else None
    original = file.read_bytes() if file else b""
    start, before = time.monotonic(), _of_children()
    try:
        if file and source is not None:
            file.write_text(source, encoding="utf-8")
            written = EPOCH + next(_SECONDS_LATER)
            os.utime(file, (written, written))
        answer = {"outcome": "passed", "by": ""}
        for arguments in sessions:
            found = _session(tree, arguments, settings)
            if found["outcome"] != "passed":
                answer = found
                break
    finally:
        if file:
            file.write_bytes(original)
            os.utime(file, (EPOCH, EPOCH))
    used = round(_of_children() - before, 2)
    return {**answer, "seconds": round(time.monotonic() - start, 2), "processor": used}


def _of_children() -> float:
    """Seconds of the processor that children took."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def _session(tree: Path, arguments: list[str], settings: dict[str, str]) -> dict[str, str]:
    """One run of pytest in a child: what came of it, and by which test."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(reading)
        _set(settings)
        _judge(tree, arguments, writing)
    os.close(writing)
    in_time = bool(select.select([reading], [], [], _WALL)[0])
    # whole: it is shorter than what a pipe takes at once
    message = os.read(reading, 1 << 16) if in_time else b""
    os.close(reading)
    with contextlib.suppress(ProcessLookupError):
        os.killpg(child, signal.SIGKILL)  # and whatever its tests have started
    status = os.waitpid(child, 0)[1]
    if message:
        return json.loads(message)
    signalled = os.WTERMSIG(status) if os.WIFSIGNALED(status) else 0
    if not in_time or signalled == signal.SIGXCPU:
        return {"outcome": "timeout", "by": "the whole run"}
    return {"outcome": "caught", "by": f"the interpreter ended (status {status})"}


def _set(settings: dict[str, str]) -> None:
    """In the child: the environment of what it runs and starts."""
    os.environ.update(settings)
    with contextlib.suppress(ImportError):
        from numba.core import config

        config.reload_config()


def _judge(tree: Path, arguments: list[str], writing: int) -> None:
    """In the child: run pytest, send what came of it, and end."""
    os.setsid()
    resource.setrlimit(resource.RLIMIT_AS, (_MEMORY, _MEMORY))
    said = os.open(tree / "last_run.txt", os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600)
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    os.dup2(said, 1)
    os.dup2(said, 2)
    sys.path.insert(0, str(tree))

    def send(outcome: str, by: str) -> None:
        os.write(writing, json.dumps({"outcome": outcome, "by": by}).encode())
        os._exit(0)

    import pytest

    from .plugin import COMPILING, SECONDS, Judge

    if os.environ.get(KEY):
        with contextlib.suppress(Exception):  # what cannot be imported, the tests will find
            vars(importlib.import_module("poekin.engine.jit.source_hash"))["LOADED"] = os.environ[
                KEY
            ]
    options = ["-q", "-W", "ignore::pytest.PytestAssertRewriteWarning"]
    options += [word for plugin in PLUGINS for word in ("-p", plugin)]
    seconds = COMPILING if os.environ[COMPILES] == "1" else SECONDS
    code = int(pytest.main([*options, *arguments], plugins=[Judge(send, seconds)]))
    if code in (pytest.ExitCode.OK, pytest.ExitCode.NO_TESTS_COLLECTED):
        send("passed", "")
    send("caught", f"pytest itself (exit code {code})")


if __name__ == "__main__":
    main()
