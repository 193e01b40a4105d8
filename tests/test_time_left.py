"""The options of tests/conftest.py by which as many tests are run as there is time for."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

from tests import conftest

ROOT = Path(__file__).resolve().parent.parent
TESTS = [f"tests/{file}.py::test_{k}" for file in "abcdefgh" for k in range(3)]


def drawn(seed: str | None) -> list[str]:
    """The order of the tests."""
    items = [SimpleNamespace(nodeid=name) for name in TESTS]
    conftest.pytest_collection_modifyitems(SimpleNamespace(getoption=lambda _: seed), items)
    return [item.nodeid for item in items]


def test_files_stay_whole_in_an_order_that_the_seed_draws():
    one, other = drawn("2026-11-29"), drawn("2026-11-30")
    assert drawn(None) == TESTS
    assert TESTS != one != other != TESTS
    assert drawn("2026-11-29") == one
    for order in (one, other):
        assert sorted(order) == TESTS
        firsts = order[::3]
        assert [name.replace("test_0", f"test_{k}") for name in firsts for k in range(3)] == order


def test_without_time_no_test_begins_and_each_file_is_named():
    files = ["tests/test_algebra.py", "tests/test_checks.py"]
    command = [sys.executable, "-m", "pytest", "--within", "0", "-p", "no:cacheprovider", *files]
    run = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stdout
    for file in files:
        assert f"no time left for {file}" in run.stdout
    assert "passed" not in run.stdout
