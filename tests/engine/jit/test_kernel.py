"""Kernels that keep the lock, check nothing, or fuse nothing, and those that do as all others do."""

from __future__ import annotations

import importlib
import pkgutil

import numpy as np
import pytest
from numba.core import types

import poekin as pk
from poekin.engine import kernels
from poekin.engine.jit.kernel import Kernel, kernel
from poekin.engine.kernels import chain_kernels
from poekin.engine.kernels.sweep import sweep_kernel


def every() -> dict[str, Kernel]:
    """The kernels of the package by the module that they are in and their name."""
    found = {}
    for info in pkgutil.walk_packages(kernels.__path__, f"{kernels.__name__}."):
        for value in vars(importlib.import_module(info.name)).values():
            if isinstance(value, Kernel):
                found[f"{value.function.__module__}.{value.function.__name__}"] = value
    return found


def test_a_kernel_has_no_result_and_is_none_of_the_special_ones_unless_it_says_so():
    plain = kernel("r1 w1")(len)
    said = plain.function, plain.arguments, plain.returns, plain.quick, plain.bare, plain.portable
    assert said == (len, "r1 w1", "", False, False, False)
    other = kernel("int", "int", True, True, True)(max)
    said = other.function, other.arguments, other.returns, other.quick, other.bare, other.portable
    assert said == (max, "int", "int", True, True, True)


def test_those_of_sweeps_alone_give_the_same_bits_on_every_processor():
    portable = {name for name, one in every().items() if one.portable}
    of_sweeps = {name for name in every() if name.startswith("poekin.engine.kernels.sweep.")}
    assert portable == of_sweeps
    assert len(of_sweeps) == 6


def test_whoever_is_called_for_one_configuration_checks_nothing():
    names = {name.rpartition(".")[2] for name, one in every().items() if one.bare}
    assert names
    assert all("one" in name for name in names), names


@pytest.fixture(scope="module")
def called():
    """An arm whose kernels of batches, of one configuration and of sweeps have been called."""
    arm = pk.load("ur5e").chain(tip="tool0")
    arm.fk_jacobian(np.zeros((2, 6)), "hybrid")
    pk.sweep.Random.of(arm, 3).configurations([0])
    return arm


def test_products_and_sums_are_fused_but_in_portable_kernels_and_the_lock_is_released(called):
    batch = chain_kernels.pose_jacobian_many.call.targetoptions
    assert (batch["nogil"], batch["fastmath"]) == (True, {"contract"})
    portable = sweep_kernel.sampled.call.targetoptions
    assert (portable["nogil"], portable["fastmath"]) == (True, False)
    assert portable["error_model"] == batch["error_model"] == "numpy"
    for one in (chain_kernels.pose_jacobian_many, sweep_kernel.sampled):
        (signature,) = one.call.overloads
        assert one.call.overloads[signature].signature.return_type == types.void
        assert not one.call._can_compile


def test_a_kernel_is_compiled_once_and_its_call_is_what_was_compiled(called):
    first = sweep_kernel.sampled.call
    assert sweep_kernel.sampled.ready() is first
    assert sweep_kernel.sampled.call is first
