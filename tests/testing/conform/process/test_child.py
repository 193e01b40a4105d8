"""Subjects that end their process, do not answer, print or take all memory: graded and said, and
the rest goes on.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from types import ModuleType, SimpleNamespace

import numpy as np
import pytest

from benchmarks.subjects import Poekin
from poekin.errors import InputError
from poekin.testing.conform import Grade, Limits, conform, search
from poekin.testing.conform.process import child
from poekin.testing.conform.process.child import POOLS, Child, isolated, obstacle
from poekin.testing.conform.run import opened

ROOT = Path(__file__).resolve().parents[3]

MODULE = """
import ctypes, os, sys, time
import numpy as np
from poekin.testing.oracles import exact  # unlike poekin's own functions it is not compiled

class Sound:
    def so3_exp(self, w):
        if w @ w > 1:
            self._fails()
        return exact.rounded(exact.exp(w))
    def so3_log(self, R):
        return exact.rounded(exact.log(R))
    def _fails(self):
        pass

class Crashes(Sound):
    def _fails(self):
        ctypes.string_at(0)

class Ends(Sound):
    def _fails(self):
        os._exit(0)

class Exits(Sound):
    def _fails(self):
        sys.exit(3)

class Hangs(Sound):
    def _fails(self):
        time.sleep(1000)

class Eats(Sound):
    def _fails(self):
        self.kept = np.ones(2**34)

class Compiles(Sound):
    def so3_exp(self, w):
        if not os.path.exists(__file__ + ".compiled"):
            open(__file__ + ".compiled", "w").close()
            time.sleep(1000)
        return super().so3_exp(w)

class Imports(Sound):
    def so3_exp(self, w):
        import no_such_package
        return no_such_package.exp(w)

class Prints(Sound):
    def so3_exp(self, w):
        print("from Python")
        ctypes.CDLL(None).puts(b"from C")
        ctypes.CDLL(None).fflush(None)
        return super().so3_exp(w)

class Reads:
    def read_urdf(self, text, base, tip):
        os._exit(7)

class CannotBeMade(Sound):
    def __init__(self):
        ctypes.string_at(0)

class MadeOnce(Sound):
    def __init__(self):
        if os.path.exists(FLAG):
            raise RuntimeError("made before")
        open(FLAG, "w").close()
    def _fails(self):
        os._exit(1)

FLAG = __file__ + ".made"
"""
FAULTS = {
    "Crashes": "ended the process (SIGSEGV)",
    "Ends": "ended the process (exit code 0)",
    "Exits": "SystemExit: 3",
    "Hangs": "no answer in 1 s",
    "Eats": "MemoryError: Unable to allocate",
}
unix = pytest.mark.skipif(not hasattr(os, "fork"), reason="this system has no fork")


@pytest.fixture
def module(tmp_path, monkeypatch):
    name = f"subjects_{tmp_path.name}".replace("-", "_")
    (tmp_path / f"{name}.py").write_text(MODULE, encoding="utf-8")
    monkeypatch.syspath_prepend(tmp_path)
    return name


def test_a_subject_that_takes_its_process_along_is_broken_and_the_rest_goes_on(module, monkeypatch):
    monkeypatch.setattr(search, "SHRINKING", 0.1)
    report = conform(f"{module}:Crashes", ["so3_exp", "so3_log"], examples=12)
    assert (report["so3_log"].grade, report["so3_log"].examples) == (Grade.EXACT, 12)
    (outcome,) = report.findings
    assert (outcome.law, outcome.grade) == ("so3_exp", Grade.BROKEN)
    assert outcome.fault == "ended the process (SIGSEGV)"
    assert "Crashes().so3_exp(np.array([" in outcome.paste
    assert module not in sys.modules


@unix
def test_a_class_that_is_there_runs_in_a_fork(module):
    # In a process of its own: this one may have threads that keep it from being forked.
    script = f"""
import os, {module}
from poekin.testing.conform import Limits, conform, search
search.SHORT = 0.3
search.SHRINKING = 1.5
here = os.getpid()
{module}.Sound.__init__ = lambda self: None if os.getpid() != here else os.abort()
for kind in {list(FAULTS)}:
    report = conform(getattr({module}, kind), ["so3_exp", "so3_log"], examples=12, limits=Limits(1.0, 2**30))
    faults = [outcome.fault[:27] for outcome in report.outcomes]
    print(faults, report.outcomes[0].numbers, report.outcomes[1].examples, report.notes)
"""
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True, cwd=ROOT,
                          env=os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)})  # fmt: skip
    assert done.stdout.splitlines() == [f"{[fault[:27], '']} 1 12 ()" for fault in FAULTS.values()]


def test_what_is_printed_by_python_or_c_is_not_on_stdout(module):
    command = [
        sys.executable,
        "-m",
        "poekin.cli",
        "conform",
        f"{module}:Prints",
        "--law",
        "so3_exp",
        "--examples",
        "3",
    ]
    done = subprocess.run([*command, "--json"], capture_output=True, text=True, check=True, cwd=ROOT,
                          env=os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)})  # fmt: skip
    assert json.loads(done.stdout)["subject"] == "Prints"
    assert sorted(done.stderr.split("\n")) == ["", *["from C"] * 3, *["from Python"] * 3]


def test_a_reader_that_ends_its_process_is_broken(module):
    (outcome,) = conform(f"{module}:Reads", ["urdf"], examples=3).findings
    assert outcome.fault == "ended the process (exit code 7)"


def test_a_subject_whose_making_ends_the_process_is_refused(module):
    with pytest.raises(
        InputError,
        match=r":CannotBeMade cannot be imported and made: ended the process \(SIGSEGV\)",
    ):
        conform(f"{module}:CannotBeMade")


def test_a_subject_that_cannot_be_made_again_says_so(module):
    report = conform(f"{module}:MadeOnce", ["so3_exp", "so3_log"], examples=5)
    assert report["so3_exp"].fault.startswith("ended the process (exit code 1)")
    assert report["so3_log"].fault.startswith(
        "cannot be made again: MadeOnce cannot be made as MadeOnce(): RuntimeError"
    )


def test_a_first_call_that_compiles_for_too_long_is_asked_again(module):
    (outcome,) = conform(f"{module}:Compiles", ["so3_exp"], examples=3, limits=Limits(1.0)).outcomes
    assert (outcome.grade, outcome.fault) == (Grade.EXACT, "")


def test_of_a_missing_package_it_is_said_that_nothing_was_judged(module):
    (outcome,) = conform(f"{module}:Imports", ["so3_exp"], examples=3).findings
    assert outcome.fault == "ModuleNotFoundError: No module named 'no_such_package'"
    assert outcome.hint == "a package that the subject imports is not installed: nothing was judged"


def test_a_named_subject_is_opened_in_a_process_of_its_own_unless_that_is_declined(module):
    named = f"{module}:Sound"
    with opened(named, Limits()) as subject:
        assert subject.title == "Sound"
        assert module not in sys.modules
    with opened(named, None):
        assert module in sys.modules


@pytest.mark.parametrize("loaded", ["torch", "no_library"])
def test_limits_are_positive_numbers(loaded, monkeypatch):
    monkeypatch.setitem(
        sys.modules, loaded, ModuleType(loaded)
    )  # a class that is there runs here beside torch
    for limits in (Limits(0.0), Limits(1.0, -1), Limits(float("nan"))):
        with pytest.raises(InputError, match=r"expected a positive number, got"):
            conform(Poekin, ["so3_exp"], limits=limits)


def test_a_subject_in_a_child_is_what_it_is_here():
    with isolated("benchmarks.subjects:Poekin", Limits()) as subject:
        w, R = np.array([0.1, 0.2, 0.3]), np.eye(3)
        np.testing.assert_array_equal(subject.function("so3_exp")(w), Poekin.so3_exp(w))
        np.testing.assert_array_equal(subject.function("so3_log")(R), np.zeros(3))
        assert (subject.title, subject.batch, subject.frame, subject.noise) == (
            "Poekin",
            True,
            "body",
            1e-8,
        )


def test_no_process_is_left(module):
    child = Child(f"{module}:Sound", Limits())
    child.subject.own.so3_exp(np.zeros(3))
    assert child.close() == 0


def test_an_interrupted_call_ends_the_process(module, monkeypatch):
    one = Child(f"{module}:Sound", Limits())
    own = one.subject.own

    def interrupted(_replies):
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(child.worker, "receive", interrupted)
        with pytest.raises(KeyboardInterrupt):
            own.so3_exp(np.zeros(3))
    assert one._process is None


@unix
def test_what_does_not_survive_a_fork_is_run_here_and_said(monkeypatch):
    for name in POOLS:
        monkeypatch.delitem(sys.modules, name, raising=False)
    assert obstacle(Poekin) == ""
    monkeypatch.setitem(sys.modules, "torch", ModuleType("torch"))
    assert obstacle("benchmarks.subjects:Poekin") == ""
    report = conform(Poekin, ["so3_exp"], examples=2)
    assert (
        "note: run in this process, with no limit on its calls: the threads of torch, loaded here"
        in str(report)
    )


def test_where_processes_have_no_groups_the_process_itself_is_ended(monkeypatch):
    ended = []
    fresh = child._Fresh.__new__(child._Fresh)
    monkeypatch.setattr(fresh, "_process", SimpleNamespace(kill=lambda: ended.append(1)), False)
    monkeypatch.setattr(child, "os", SimpleNamespace(name="nt"))
    fresh.kill()
    assert ended == [1]
