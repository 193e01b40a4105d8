"""pytest: a test with the argument `conform` fails with the counterexample, where it was asked for."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from benchmarks.subjects import FAULTS, Poekin
from poekin.testing.conform import Grade
from poekin.testing.conform.plugin import conform
from poekin.testing.laws import LawViolation

ROOT = Path(__file__).resolve().parents[3]

TEST = """
from benchmarks.subjects import FAULTS, Poekin

def test_sound(conform):
    conform(Poekin, ["so3_exp"], examples=20)

def test_faulty(conform):
    conform(FAULTS["d"][0], examples=60)
"""


def test_a_faulty_subject_fails_its_test_with_the_counterexample_and_a_sound_one_passes(tmp_path):
    (tmp_path / "test_mine.py").write_text(TEST, encoding="utf-8")
    command = [sys.executable, "-m", "pytest", "-q", "-p", "poekin.testing.conform.plugin", "-p", "no:cacheprovider",
               f"--rootdir={tmp_path}", "-c", "/dev/null", str(tmp_path)]  # fmt: skip
    done = subprocess.run(command, capture_output=True, text=True, cwd=ROOT, check=False)
    assert done.returncode == 1, done.stdout + done.stderr
    assert "1 failed, 1 passed" in done.stdout
    assert "ExpOfNothing does not conform" in done.stdout
    assert "print(ExpOfNothing().so3_exp(np.array([" in done.stdout


def test_a_report_is_returned_where_nothing_is_worse_than_asked_for():
    assert conform(Poekin, ["so3_exp"], examples=10, at_most=Grade.EXACT).conforms
    kind, law = FAULTS["d"]
    assert not conform(kind, [law], examples=60, at_most=Grade.BROKEN).conforms
    with pytest.raises(LawViolation, match=r"ExpOfNothing does not conform: error .* exceeds 1e-10"):
        conform(kind, [law], examples=60)
