"""Samples uncompiled, against whole numbers of Python and Sobol's sequence in SciPy."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import qmc

from poekin.engine.kernels.sweep import samples
from poekin.sweep import Sobol
from tests.sweep.test_samples import unit

BOUNDS = np.array([[-1.0, 2.0, 0.0], [2.0, 3.0, 0.5]])  # lower ends and widths
NUMBERS = st.integers(0, 2**40)


def written(said, first: int, count: int = 3) -> np.ndarray:
    q = np.full((3, count), np.nan)
    with np.errstate(over="ignore"):  # of unsigned numbers, as it is meant
        samples.write_samples(np.array(said), BOUNDS, first, q)
    return q.T


@given(st.integers(0, 2**62 - 1), NUMBERS)
@settings(max_examples=20)
def test_a_random_sample_is_a_function_of_seed_and_number(seed, first):
    units = [[unit(seed, 3 * (first + k) + i) for i in range(3)] for k in range(3)]
    expected = BOUNDS[0] + BOUNDS[1] * units
    np.testing.assert_array_equal(written((samples.RANDOM, seed), first), expected)


@given(st.tuples(*[st.integers(1, 2**10)] * 3), NUMBERS)
def test_a_sample_of_a_grid_is_the_middle_of_its_part_the_last_coordinate_first(counts, first):
    first = first % int(np.prod(counts))
    (q,) = written((samples.GRID, 0, *counts), first, 1)
    parts = np.unravel_index(first, counts)
    expected = BOUNDS[0] + BOUNDS[1] * (np.array(parts) + 0.5) / counts
    np.testing.assert_allclose(q, expected, rtol=4 * 2.0**-53)


@pytest.mark.parametrize("first", [0, 1, 6, 7, 127])
def test_samples_of_sobol_s_sequence_follow_each_other_as_in_scipy(first):
    said = Sobol(np.zeros(3), np.ones(3), 2**20, None).numbers()
    sequence = qmc.Sobol(3, scramble=False, bits=53).random(256)[first : first + 9]
    expected = BOUNDS[0] + BOUNDS[1] * sequence
    np.testing.assert_array_equal(written(said, first, 9), expected)
