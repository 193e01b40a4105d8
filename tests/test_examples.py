"""Property tests draw the same examples on every machine; a seed draws others, and the run says how
to keep one.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from tests.conftest import SLOW

ROOT = Path(__file__).resolve().parent.parent
PLANTED = 10**12 + 12345
# Integers of a range without a number of Hypothesis's own list: the one in `local` is drawn where
# its source is read.
SUITE = """
from pathlib import Path
from hypothesis import given, strategies as st
if {local}:
    import local
seen = []
@given(st.integers(10**12, 10**12 + 10**6), st.floats(-1, 1))
def test_drawn(n, x):
    seen.append((n, x))
def test_said():
    Path("drawn").write_text(repr(seen))
@given(st.integers())
def test_broken(n):
    assert n < 100
"""


def drawn(place: Path, *options: str, local: bool = False, **environment: str) -> tuple[str, str]:
    """What a suite with the repository's conftest draws in a directory, and what the run prints."""
    place.mkdir()
    (place / "conftest.py").write_text((ROOT / "tests" / "conftest.py").read_text())
    (place / "local.py").write_text(f"PLANTED = {PLANTED}\n")
    (place / "test_suite.py").write_text(SUITE.format(local=local))
    variables = {
        k: v for k, v in os.environ.items() if k not in ("HYPOTHESIS_PROFILE", "CI")
    } | environment
    command = [
        sys.executable,
        "-m",
        "pytest",
        "-q",
        "-p",
        "no:cacheprovider",
        "-c",
        os.devnull,
        *options,
        ".",
    ]
    done = subprocess.run(
        command, cwd=place, env=variables, capture_output=True, text=True, check=False
    )
    assert done.returncode == 1, done.stdout + done.stderr
    return (place / "drawn").read_text(), done.stdout


def test_the_same_is_drawn_whatever_is_loaded_and_wherever_the_tests_are(tmp_path):
    first, said = drawn(tmp_path / "one")
    assert first == drawn(tmp_path / "two \u00e9", local=True, PYTHONHASHSEED="1", CI="1")[0]
    assert str(PLANTED) not in first
    assert "@example(" not in said


def test_a_seed_draws_others_and_the_run_says_how_to_keep_one_that_fails(tmp_path):
    first, said = drawn(tmp_path / "one", "--hypothesis-seed=1")
    assert first != drawn(tmp_path / "two", "--hypothesis-seed=2", HYPOTHESIS_PROFILE="quick")[0]
    assert "test_broken" in said
    assert "@example(" in said
    assert "@reproduce_failure" in said


def test_every_slow_file_is_there_and_a_fast_run_leaves_it_out():
    files = {path.relative_to(ROOT / "tests").as_posix() for path in ROOT.glob("tests/**/*")}
    for slow in SLOW:
        file, _, test = slow.partition("::")
        assert file in files
        assert not test or f"\ndef {test}" in (ROOT / "tests" / file).read_text(encoding="utf-8")
    command = [
        sys.executable,
        "-m",
        "pytest",
        "--collect-only",
        "-q",
        "-m",
        "not slow",
        "tests/cli",
    ]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    assert "tests/cli/test_model.py" in done.stdout
    assert "tests/cli/test_run.py" not in done.stdout
    assert "deselected" in done.stdout
