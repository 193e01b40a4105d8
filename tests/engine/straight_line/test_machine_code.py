"""An arm's machine code is made for the processor of Numba's own kernels, and kept apart by
processor.
"""

from __future__ import annotations

import platform

import pytest
from llvmlite import binding
from numba.core import config

from poekin.engine.straight_line.arm_code import arm_code
from poekin.engine.straight_line.machine_code import object_code, processor
from poekin.formats.load import load


def named(monkeypatch, name: str | None) -> None:
    """As with NUMBA_CPU_NAME=name and NUMBA_CPU_FEATURES empty, which leaves the features that the
    name implies.
    """
    monkeypatch.setattr(config, "CPU_NAME", name)
    monkeypatch.setattr(config, "CPU_FEATURES", "" if name else None)


@pytest.fixture(scope="module")
def program():
    return load("puma560").chain().compile().program(None)


def test_the_processor_is_this_one_where_none_is_named(monkeypatch):
    named(monkeypatch, None)
    monkeypatch.setattr(config, "ENABLE_AVX", True)
    assert processor() == (binding.get_host_cpu_name(), binding.get_host_cpu_features().flatten())


@pytest.mark.skipif(
    platform.machine() not in ("x86_64", "AMD64"), reason="the names are those of x86-64 processors"
)
def test_machine_code_is_that_of_the_processor_named(monkeypatch, program):
    codes = {}
    for name in ("nehalem", "haswell"):  # without and with fused multiply-add
        named(monkeypatch, name)
        assert processor() == (name, "")
        codes[name] = object_code(program, True)
    assert codes["nehalem"] != codes["haswell"]


def test_the_code_of_each_processor_is_kept_by_itself(monkeypatch, tmp_path, program):
    monkeypatch.setenv("POEKIN_CACHE_DIR", str(tmp_path / "cache"))
    for name in (None, "generic"):
        named(monkeypatch, name)
        arm_code("key", lambda: program, 6, True)
    assert len(list((tmp_path / "cache").glob("arm-*.kernel"))) == 2
