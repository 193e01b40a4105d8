"""The tests run as other processors would: the environment changes what every part takes this
machine for.
"""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from tools import processors

SHOWN = """
import numpy as np
from numpy._core import _multiarray_umath as core
from poekin.engine.straight_line.machine_code import processor
from numba.core.registry import cpu_target
print(processor()[0], *cpu_target.target_context.codegen().magic_tuple()[1:])
print([name for name in core.__cpu_dispatch__ if core.__cpu_features__[name]])
"""

here = pytest.mark.skipif(
    bool(processors.missing(processors.PROCESSORS["haswell"])), reason="needs x86-64 with AVX2"
)


@here
def test_numba_machine_code_and_numpy_take_this_machine_for_another():
    changed = processors.environment(processors.PROCESSORS["nehalem"])
    done = subprocess.run(
        [sys.executable, "-c", SHOWN], env=os.environ | changed, cwd=processors.ROOT, capture_output=True, text=True,
        check=True,
    )  # fmt: skip
    llvm, numpy = done.stdout.splitlines()
    assert llvm.split() == ["nehalem", "nehalem"]
    assert "V3" not in numpy
    assert "AVX" not in numpy


@here
def test_a_processor_keeps_what_it_has_and_loses_what_it_lacks():
    old, new = (
        processors.environment(processors.PROCESSORS[name]) for name in ("sandybridge", "haswell")
    )
    assert "-FMA," in old["GLIBC_TUNABLES"]
    assert "-FMA," not in new["GLIBC_TUNABLES"]
    assert set(new["NPY_DISABLE_CPU_FEATURES"].split()) < set(
        old["NPY_DISABLE_CPU_FEATURES"].split()
    )
    assert {p.threads > 1 for p in map(processors.PROCESSORS.get, processors.USUAL) if p} == {
        True,
        False,
    }


def test_a_processor_that_cannot_run_here_is_left_out_and_said_so(monkeypatch, capsys):
    monkeypatch.setattr(processors, "missing", lambda processor: ["avx512f"])
    monkeypatch.setattr(processors, "run", lambda *_: pytest.fail("it ran"))
    assert processors.main(["skylake-avx512"]) == 0
    assert "left out, this machine has no avx512f" in capsys.readouterr().out


def test_one_failure_fails_the_whole_and_names_the_processor(monkeypatch, capsys):
    monkeypatch.setattr(processors, "missing", lambda processor: [])
    monkeypatch.setattr(processors, "run", lambda name, tests, fast: name != "haswell" and not fast)
    assert processors.main([]) == 1
    assert "failed as: haswell" in capsys.readouterr().out
    assert processors.main(["generic"]) == 0
    assert processors.main(["generic", "--fast"]) == 1


def test_an_unknown_processor_is_refused(capsys):
    with pytest.raises(SystemExit):
        processors.main(["z80"])
    assert "unknown processor 'z80'" in capsys.readouterr().err
