"""pytest: a test with the fixture `conform` fails with the counterexample, where it was asked for."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

from benchmarks.subjects import FAULTS, Poekin
from poekin.testing.conform import Grade
from poekin.testing.conform.plugin import check_conformance
from poekin.testing.laws.laws import LawViolation

ROOT = Path(__file__).resolve().parents[3]

TEST = """
import pytest
from benchmarks.subjects import FAULTS, Poekin

@pytest.fixture(scope="module")
def report(conform):
    return conform(Poekin, ["so3_log"], examples=10)

def test_a_fixture_may_use_it(report):
    assert report.conforms

def test_sound(conform):
    conform(Poekin, ["so3_exp"], examples=20)

def test_faulty(conform):
    conform(FAULTS["d"][0], examples=60)
"""


def test_a_faulty_subject_fails_its_test_with_the_counterexample_and_a_sound_one_passes(tmp_path):
    (tmp_path / "test_mine.py").write_text(TEST, encoding="utf-8")
    # As its users have it: declared in the conftest at the top, with warnings as errors, and beside
    # imports of poekin.
    (tmp_path / "conftest.py").write_text(
        'from poekin.testing.conform import Grade\n\npytest_plugins = ["poekin.testing.conform.plugin"]\n',
        encoding="utf-8",
    )
    command = [sys.executable, "-m", "pytest", "-q", "-W", "error", "-p", "no:cacheprovider",
               f"--rootdir={tmp_path}", "-c", "/dev/null", str(tmp_path)]  # fmt: skip
    done = subprocess.run(command, capture_output=True, text=True, cwd=ROOT, check=False)
    assert done.returncode == 1, done.stdout + done.stderr
    assert "1 failed, 2 passed" in done.stdout
    assert "ExpOfNothing does not conform" in done.stdout
    assert "ExpOfNothing().so3_exp(np.array([" in done.stdout


def test_a_report_is_returned_where_nothing_is_worse_than_asked_for():
    assert check_conformance(Poekin, ["so3_exp"], examples=10, at_most=Grade.EXACT).conforms
    kind, law = FAULTS["d"]
    assert check_conformance(kind, [law], examples=60, at_most=Grade.BROKEN).findings
    with pytest.raises(
        LawViolation, match=r"ExpOfNothing does not conform: error .* exceeds 1e-10"
    ):
        check_conformance(kind, [law], examples=60)


def test_the_plugin_which_imports_pytest_is_imported_by_nothing_of_poekin():
    # That nothing else imports pytest is held by tests/test_architecture.py.
    files = list((ROOT / "poekin" / "testing").rglob("*.py")) + list(
        (ROOT / "poekin" / "cli").glob("*.py")
    )
    importing = re.compile(r"^\s*(from|import)\b.*\bplugin\b", re.MULTILINE)
    assert not [file for file in files if importing.search(file.read_text(encoding="utf-8"))]
