"""An arm's machine code is made for the processor of Numba's own kernels, and kept apart by
processor.
"""

from __future__ import annotations

import platform

import numpy as np
import pytest
from llvmlite import binding, ir
from numba import njit
from numba.core import config

from poekin.engine.kernels import arm_kernels
from poekin.engine.kernels.arm_kernels import run_columns as columns_of_four
from poekin.engine.kernels.arm_kernels import sines_of_block
from poekin.engine.straight_line.arm_code import ArmCode, arm_code
from poekin.engine.straight_line.machine_code import (
    FUNCTIONS,
    LANES,
    _Function,
    object_code,
    processor,
)
from poekin.formats.load import load
from poekin.model import screw
from poekin.model.chain import Chain


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


@pytest.mark.parametrize(("layout", "fused"), [("rows", True), ("columns", False)])
def test_products_and_sums_may_be_fused_in_rows_and_not_in_columns(program, layout, fused):
    module = ir.Module("arm")
    for name, lanes in FUNCTIONS[layout].items():
        _Function(module, name, lanes, layout).write(program, True)
    steps = [line for line in str(module).splitlines() if " fadd " in line or " fmul " in line]
    assert {"contract" in line for line in steps} == {fused}


def test_the_code_of_each_processor_is_kept_by_itself(monkeypatch, tmp_path, program):
    monkeypatch.setenv("POEKIN_CACHE_DIR", str(tmp_path / "cache"))
    for name in (None, "generic"):
        named(monkeypatch, name)
        arm_code("key", lambda: program, 6, True)
    assert len(list((tmp_path / "cache").glob("arm-*.kernel"))) == 2


def test_the_code_of_each_source_of_programs_is_kept_by_itself(monkeypatch, tmp_path, program):
    monkeypatch.setenv("POEKIN_CACHE_DIR", str(tmp_path / "cache"))
    made = []

    def make():
        made.append(program)
        return program

    arm_code("key", make, 6, True)
    for source, count in (("another", 2), ("another", 2), ("a third", 3)):
        monkeypatch.setattr("poekin.engine.straight_line.arm_code.LOADED_PROGRAMS", source)
        arm_code("key", make, 6, True)
        assert len(made) == count


def coupled() -> Chain:
    """Axes driven by two coordinates, one of them backwards, with an offset, and a slide."""
    axes = [screw.revolute([0, 0, 1], [0, 0, 0]), screw.revolute([0, 1, 0], [0, 0, 0.3])]
    screws = [*axes, screw.prismatic([1, 0, 0])]
    coupling = [[1, -1], [2, 0.5], [0, 1]]
    return Chain.from_space(screws, np.eye(4), coupling=coupling, offset=[0, 0.2, 0.1])


@pytest.mark.parametrize("make", [lambda: load("puma560").chain(), coupled])
def test_columns_hold_the_numbers_of_four_configurations_side_by_side(make):
    chain = make()
    m = chain.dof
    q = np.random.default_rng(1).uniform(-1, 1, (arm_kernels.BLOCK, m))
    made = chain.compile().program("hybrid", pose=True)
    arm = ArmCode(object_code(made, True, "columns"), len(made.angles), m, "columns")
    sines = np.empty((len(made.angles), arm_kernels.BLOCK))
    cosines = np.empty_like(sines)
    R_p = np.full((12, arm_kernels.BLOCK), 77.0)
    J = np.empty((6 * m, LANES))
    first = 8
    four = slice(first, first + LANES)
    arm_kernels.pose_one.ready()  # which lets compiled code call the functions of its module
    run_columns(arm.address, q.T.copy(), sines, cosines, first, R_p, J)
    T_own, J_own = chain.fk_jacobian(q[four], "hybrid")
    np.testing.assert_allclose(R_p[:9, four].T, T_own[:, :3, :3].reshape(LANES, 9), atol=1e-14)
    np.testing.assert_allclose(R_p[9:, four].T, T_own[:, :3, 3], atol=1e-14)
    np.testing.assert_allclose(J.T, J_own.reshape(LANES, 6 * m), atol=1e-14)
    assert (np.delete(R_p, four, axis=1) == 77).all()


@njit
def run_columns(address, q, sines, cosines, first, R_p, J):
    """As a kernel of sweeps calls it."""
    sines_of_block(address, q, sines, cosines)
    columns_of_four(address, sines, cosines, first, q, R_p, J)
