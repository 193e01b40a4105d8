"""Whole numbers, transpiled: quotients and rests as Python has them, and 64 bits that wrap around."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from .compiled_c import WRITTEN, library, run, text_of

STEP = np.uint64(0x9E3779B97F4A7C15)


def whole_numbers(a, out):
    i = int(a[0])
    j = int(a[1])
    if j == 0:
        j = 3
    out[0] = i // j
    out[1] = i % j
    out[2] = i // 4
    out[3] = i % 5
    out[4] = i // -3
    out[5] = math.floor(a[2])
    out[6] = math.floor(-a[2])
    out[7] = math.sqrt(j * j + 1)


def words(a, out):
    x = np.uint64(int(abs(a[0]))) * STEP + np.uint64(3)
    y = (x ^ (x >> np.uint64(30))) * STEP - np.uint64(5)
    out[0] = np.int64(x >> np.uint64(11))
    out[1] = np.int64((y ^ x) >> np.uint64(40)) * 0.5
    out[2] = np.int64((x >> np.uint64(60)) + (y >> np.uint64(63)))


@pytest.fixture(scope="module")
def unit(tmp_path_factory):
    return library(tmp_path_factory.mktemp("c"), text_of(whole_numbers, words))


LARGEST = 2**31 - 1  # of an integer of C


@pytest.mark.parametrize("function", [whole_numbers, words], ids=lambda f: f.__name__)
@given(
    i=st.integers(-LARGEST, LARGEST),
    j=st.integers(-9, 9),
    x=st.floats(-1e6, 1e6),
)
@example(i=-7, j=2, x=-0.5)
@example(i=7, j=-2, x=-3.0)
@example(i=-8, j=-4, x=0.0)
def test_c_computes_what_python_does(function, unit, i, j, x):
    a = [float(i), float(j), x, 0.0, 0.0, 0.0]
    out = np.zeros(WRITTEN)
    with np.errstate(over="ignore"):
        function(np.array(a), out)
    assert run(unit, function, a).tolist() == out.tolist()
