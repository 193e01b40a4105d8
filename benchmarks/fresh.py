"""Fresh Python processes: for import times, first calls, and for what must work in an odd
environment.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


@dataclass(frozen=True)
class Outcome:
    """How a process ended: its exit code and what it printed."""

    code: int
    out: str
    err: str


def run(
    script: str, environment: Mapping[str, str | None], *, package_home: Path = ROOT
) -> Outcome:
    """Run a script in a new interpreter with poekin importable from package_home; None takes a
    variable away.
    """
    # Byte code is kept, as it is for any user: without it every import would be a cold one.
    kept = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
    variables = (
        kept
        | {"PYTHONPATH": str(package_home)}
        | {k: v for k, v in environment.items() if v is not None}
    )
    for name, value in environment.items():
        if value is None:
            variables.pop(name, None)
    done = subprocess.run(
        [sys.executable, "-c", script],
        env=variables,
        cwd=package_home,
        capture_output=True,
        text=True,
        timeout=300,
    )
    return Outcome(done.returncode, done.stdout, done.stderr)
