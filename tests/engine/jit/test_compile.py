"""Kernels take any layout and read-only input without compiling anew, and release the interpreter's
lock.
"""

import os
import threading
import time

import numpy as np
import pytest
from numba.core import types

import poekin as pk
from poekin.engine.jit import compile as compile_module
from poekin.engine.jit.compile import array_type, compiled, modules_used
from poekin.engine.jit.kernel import Kernel
from poekin.engine.kernels import (
    arm_kernels,
    chain_kernels,
    follow_kernels,
    group_kernels,
    ik_all_kernel,
    ik_kernels,
    tree_kernels,
)
from poekin.errors import FileError

ARM = pk.load("panda").chain(tip="panda_hand")
Q = np.random.default_rng(0).normal(size=(6, 7))


def layouts(a):
    """The same numbers in memory laid out in every way that NumPy knows."""
    read_only = a.copy()
    read_only.flags.writeable = False
    wide = np.zeros((a.shape[0], 2 * a.shape[1]))
    wide[:, ::2] = a
    unaligned = np.zeros(a.nbytes + 1, np.uint8)[1:].view(np.float64).reshape(a.shape)
    unaligned[...] = a
    return {
        "C": a.copy(),
        "read-only": read_only,
        "Fortran": np.asfortranarray(a),
        "strided": wide[:, ::2],
        "backwards": a[::-1, ::-1].copy()[::-1, ::-1],
        "unaligned": unaligned,
        "big-endian": a.astype(">f8"),
        "repeated": np.broadcast_to(a, (1, *a.shape))[0],
        "list": a.tolist(),
    }


def kernels():
    modules = (chain_kernels, group_kernels, tree_kernels)
    return {
        f"{m.__name__}.{k}": v for m in modules for k, v in vars(m).items() if isinstance(v, Kernel)
    }


@pytest.mark.parametrize("layout", layouts(Q))
def test_every_layout_gives_the_same_and_compiles_nothing(layout):
    q = layouts(Q)[layout]
    expected = ARM.fk_jacobian(Q, "body")
    ARM.fk_jacobian(Q[0].copy(), "body")
    before = {name: kernel.call for name, kernel in kernels().items()}
    for got in (ARM.fk_jacobian(q, "body"), (ARM.fk(q), ARM.jacobian(q, "body"))):
        np.testing.assert_array_equal(got[0], expected[0])
        np.testing.assert_array_equal(got[1], expected[1])
    one = ARM.fk_jacobian(q[0], "body")
    np.testing.assert_allclose(one[0], expected[0][0], rtol=0, atol=1e-15)
    np.testing.assert_allclose(one[1], expected[1][0], rtol=0, atol=1e-15)
    changed = {name for name, kernel in kernels().items() if kernel.call is not before[name]}
    assert changed <= {"poekin.engine.kernels.chain_kernels.pose_many"}
    assert len(chain_kernels.pose_jacobian_many.call.signatures) == 1


@pytest.mark.parametrize("dtype", [np.float32, np.int64, np.int8, np.uint16, np.float16])
def test_other_numbers_are_computed_in_float64(dtype):
    q = np.ones((2, 7), dtype)
    T = ARM.fk(q)
    assert T.dtype == np.float64
    np.testing.assert_array_equal(T, ARM.fk(q.astype(float)))
    np.testing.assert_allclose(ARM.fk(q[0]), T[0], rtol=0, atol=1e-15)


def test_a_batch_lets_other_threads_run():
    q = ARM.random(0, 300_000)
    ARM.fk(q[:2])
    ticks, done = [], threading.Event()

    def tick():
        while not done.is_set():
            ticks.append(time.perf_counter())
            time.sleep(1e-4)

    thread = threading.Thread(target=tick)
    thread.start()
    start = time.perf_counter()
    ARM.fk(q)
    end = time.perf_counter()
    done.set()
    thread.join()
    assert sum(start < t < end for t in ticks) > 3


def test_a_subclass_of_an_array_is_taken_for_its_numbers():
    class Tagged(np.ndarray):
        pass

    q = Q[0].copy().view(Tagged)
    np.testing.assert_allclose(
        ARM.fk_jacobian(q, "hybrid")[1],
        ARM.fk_jacobian(Q[0].copy(), "hybrid")[1],
        rtol=0,
        atol=1e-15,
    )


def test_nan_stays_in_its_element():
    q = Q.copy()
    q[2, 3] = np.nan
    q[4, 0] = np.inf
    T, J = ARM.fk_jacobian(q, "hybrid")
    for k in range(6):
        assert np.isfinite(T[k]).all() == (k not in (2, 4))
        assert np.isfinite(J[k]).all() == (k not in (2, 4))
    assert np.isnan(ARM.fk(q[2])).any()


def test_the_code_of_an_argument_says_what_it_is_and_how_many_axes_it_has():
    assert array_type("int") == types.int64
    for code, element, axes in (
        ("i1", types.int64, 1),
        ("r1", types.float64, 1),
        ("r3", types.float64, 3),
    ):
        assert array_type(code) == types.Array(element, axes, "A", readonly=True, aligned=False)
    for axes in (1, 5):
        assert array_type(f"w{axes}") == types.Array(types.float64, axes, "C")


@pytest.mark.parametrize(
    ("module", "others"),
    [
        (chain_kernels, []),
        (ik_kernels, [arm_kernels, chain_kernels]),
        (follow_kernels, [ik_kernels, arm_kernels, chain_kernels]),
        (ik_all_kernel, [ik_kernels, arm_kernels, chain_kernels]),
    ],
    ids=lambda x: getattr(x, "__name__", ""),
)
def test_a_kernel_may_be_the_first_one_that_is_compiled(module, others):
    """The functions that it calls are known to the compiler, those that these call as well."""
    used = modules_used(module)
    assert set(used) & {arm_kernels, chain_kernels, follow_kernels, ik_kernels} == {
        *others,
        *({module} - {ik_all_kernel}),
    }
    assert len(used) == len(set(used))


@pytest.mark.skipif(os.name == "nt", reason="a directory in use stays")
def test_in_a_directory_that_was_deleted_compiling_is_refused_with_what_helps(
    tmp_path, monkeypatch
):
    monkeypatch.setenv("POEKIN_CACHE_DIR", "")
    here = tmp_path / "here"
    here.mkdir()
    monkeypatch.chdir(here)
    here.rmdir()
    known = group_kernels.first_defect
    with pytest.raises(FileError) as caught:
        compiled(known)
    assert str(caught.value) == (
        "compiling kernels: the working directory is gone; change to another one, or run "
        "`poekin warm` elsewhere once, after which no kernel is compiled"
    )


def test_another_file_that_is_missing_as_kernels_are_compiled_is_said_as_it_is(monkeypatch):
    monkeypatch.setenv("POEKIN_CACHE_DIR", "")

    def missing(*_):
        raise FileNotFoundError("a source")

    monkeypatch.setattr(compile_module.KernelCache, "load_overload", missing)
    known = group_kernels.first_defect
    with pytest.raises(FileNotFoundError, match=r"^a source$"):
        compiled(known)
