"""Run mutants: copies of the tree, a server in each, jobs by module, and each outcome kept as soon
as it is known.
"""

from __future__ import annotations

import contextlib
import json
import math
import os
import queue
import shutil
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from . import kernels, suites
from .mutants import Mutant
from .server import EPOCH, LIBRARIES, SETTINGS

Outcome = dict[str, object]
_LEFT_OUT = shutil.ignore_patterns(
    ".git", ".venv*", "build", "dist", "_build", "__pycache__", ".*_cache", ".hypothesis"
)
NOT_FOUND = "pytest itself (exit code 4)"
"""What catches a mutant where a test that was asked for is not there."""
_KEPT = 2  # tests that caught a neighbour are tried first


class BrokenSuite(Exception):
    """The tests fail without any mutant: nothing would be proven."""


def copy(root: Path, place: Path) -> None:
    """Copy the tree to a place, every file of one time."""
    shutil.copytree(root, place, ignore=_LEFT_OUT)
    for file in place.rglob("*"):
        os.utime(file, (EPOCH, EPOCH))


class Server:
    """A copy of the tree and the process that runs mutants in it."""

    def __init__(self, root: Path, place: Path, known: Path | None):
        copy(root, place)
        kept = {k: v for k, v in os.environ.items() if not k.startswith("PYTHON")}
        self._process = subprocess.Popen(
            [sys.executable, "-m", "tools.mutate.server", str(known or ""), *LIBRARIES],
            cwd=place,
            env={**kept, **SETTINGS, "PYTHONPATH": str(place)},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def ask(self, path: str, source: str | None, sessions: list[list[str]]) -> Outcome:
        """The outcome of the sessions with that source in place of the module's, or as it is where
        that is None.
        """
        assert self._process.stdin
        assert self._process.stdout
        mode = suites.mode(path)
        without = suites.kernels_of(path) if mode is suites.Mode.SHARED else []
        job = {
            "path": path,
            "source": source,
            "sessions": sessions,
            "mode": mode.value,
            "without": without,
        }
        self._process.stdin.write(json.dumps(job) + "\n")
        self._process.stdin.flush()
        line = self._process.stdout.readline()
        if not line:
            raise BrokenSuite(f"the process that runs the mutants ended: {self._process.wait()}")
        return json.loads(line)

    def close(self) -> None:
        """End the process."""
        for pipe in (self._process.stdin, self._process.stdout):
            if pipe:
                pipe.close()
        self._process.wait()


def kept(file: Path) -> dict[str, Outcome]:
    """The outcomes in a file of earlier runs, by the mutant's key; the last one counts."""
    if not file.exists():
        return {}
    lines = file.read_text(encoding="utf-8").splitlines()
    return {outcome["key"]: outcome for outcome in map(json.loads, lines)}


class Campaign:
    """Mutants to run with some workers; `finished` is called with each one and its outcome. A worker
    begins none after so many `seconds` from when it could begin the first. `processor` is what all of
    it took, s: tests that are seen to pass without a mutant too.
    """

    def __init__(
        self,
        root: Path,
        place: Path,
        sources: dict[str, str],
        listed: set[str],
        file: Path,
        quick: bool,
        seconds: float = math.inf,
    ):
        self.root, self.place, self.sources, self.listed, self.file = (
            root,
            place,
            sources,
            listed,
            file,
        )
        self.quick = quick
        self.seconds = seconds
        self.processor = 0.0
        self._jobs: queue.SimpleQueue[Mutant] = queue.SimpleQueue()
        self._known: Path | None = None
        self._killers: dict[tuple[str, str], list[str]] = {}
        self._sound: set[str] = set()
        self._passing: set[str] = set()  # tests that are there with one mutant alone
        self._lock = threading.Lock()
        self._faults: list[BaseException] = []

    def run(
        self, mutants: list[Mutant], workers: int, finished: Callable[[Mutant, Outcome], None]
    ) -> None:
        """Run all of them. Raises BrokenSuite when the tests fail by themselves."""
        if any(suites.mode(mutant.path) in kernels.TAKING for mutant in mutants):
            self._known = kernels.prepared(self.root, self.place / "kernels")
        for mutant in mutants:
            self._jobs.put(mutant)
        threads = [threading.Thread(target=self._work, args=(k, finished)) for k in range(workers)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        if self._faults:
            raise self._faults[0]

    def _work(self, number: int, finished: Callable[[Mutant, Outcome], None]) -> None:
        try:
            with contextlib.closing(
                Server(self.root, self.place / f"tree{number}", self._known)
            ) as server:
                until = time.monotonic() + self.seconds
                for mutant in self._taken(until):
                    outcome = self._judged(server, mutant)
                    with self._lock, self.file.open("a", encoding="utf-8") as file:
                        file.write(json.dumps(outcome) + "\n")
                        finished(mutant, outcome)
        except (OSError, ValueError, BrokenSuite) as fault:
            self._faults.append(fault)

    def _taken(self, until: float) -> Iterator[Mutant]:
        with contextlib.suppress(queue.Empty):
            while not self._faults and time.monotonic() < until:
                yield self._jobs.get_nowait()

    def _judged(self, server: Server, mutant: Mutant) -> Outcome:
        source = mutant.applied(self.sources[mutant.path])
        killers = self._killers.setdefault((mutant.path, mutant.definition), [])
        sessions = [*([test] for test in killers[:_KEPT]), *suites.near(mutant.path)]
        outcome = self._asked(server, mutant.path, source, sessions)
        if outcome["outcome"] == "passed" and mutant.key not in self.listed and not self.quick:
            sessions = [suites.whole(mutant.path)]
            outcome = self._asked(server, mutant.path, source, sessions)
        if outcome["outcome"] != "passed":
            by = str(outcome["by"])
            self._hold(server, mutant.path, by, sessions)
            if "::" in by and by not in self._passing:
                killers[:] = [by, *(other for other in killers if other != by)][:_KEPT]
        return {
            "key": mutant.key,
            "path": mutant.path,
            "line": mutant.line,
            "new": mutant.new,
            **outcome,
        }

    def _asked(
        self, server: Server, path: str, source: str | None, sessions: list[list[str]]
    ) -> Outcome:
        outcome = server.ask(path, source, sessions)
        with self._lock:
            self.processor += float(str(outcome["processor"]))
        return outcome

    def _hold(self, server: Server, path: str, by: str, sessions: list[list[str]]) -> None:
        """See once that what has caught a mutant passes without one, run in the same way."""
        alone = [by] if "::" in by else [by, "--collect-only"] if by.endswith(".py") else None
        what = f"{suites.mode(path).value}: {alone or sessions}"
        if what in self._sound:
            return
        outcome = self._asked(server, path, None, [alone] if alone else sessions)
        if "[" in by and outcome["by"] == NOT_FOUND:
            # an id made of a text that the mutant changes: without it there is no such test
            self._passing.add(by)
            outcome = self._asked(server, path, None, [[by.partition("[")[0]]])
        if outcome["outcome"] != "passed":
            raise BrokenSuite(
                f"without any mutant {outcome['by'] or by}: {outcome['outcome']} ({path}; {what})"
            )
        self._sound.add(what)
