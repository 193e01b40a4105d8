"""Sobol's sequence, bit for bit that of SciPy where it is not scrambled, and scrambled as even."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import qmc

import poekin as pk
from poekin.errors import InputError
from poekin.sweep import Cells, Sobol, Sweep, run
from poekin.sweep.direction_numbers import MOST
from tests.sweep.arms import bits, two_links


def units(dimension, numbers, seed=None):
    samples = Sobol(np.zeros(dimension), np.ones(dimension), 2**50, seed)
    return samples.configurations(numbers)


def test_it_is_that_of_scipy_bit_for_bit_in_every_coordinate():
    theirs = qmc.Sobol(MOST, scramble=False, bits=53).random(2**12)
    assert units(MOST, np.arange(2**12)).tobytes() == theirs.tobytes()


@given(st.integers(1, 2**29), st.integers(1, MOST))
@settings(max_examples=20)
def test_far_numbers_are_those_of_scipy_too(number, dimension):
    theirs = qmc.Sobol(dimension, scramble=False)  # of 30 bits
    theirs.fast_forward(number)
    assert units(dimension, [number]).tobytes() == theirs.random(1).tobytes()


@given(st.integers(0, 2**62 - 1), st.integers(0, 2**45), st.lists(st.integers(0, 500), max_size=9))
def test_a_sample_is_a_function_of_seed_and_number_alone(seed, first, others):
    numbers = first + np.array([0, *others])
    whole = units(3, first + np.arange(501), seed)
    assert units(3, numbers, seed).tobytes() == whole[numbers - first].tobytes()


@pytest.mark.parametrize("seed", [None, 0, 1, 2**61])
@pytest.mark.parametrize("start", [0, 3])
def test_every_part_of_a_range_has_its_share_of_a_power_of_two(seed, start):
    # of 2^10 numbers in a row each of 2^10 equal parts of a coordinate has one, scrambled or not
    rows = units(MOST, start * 2**10 + np.arange(2**10), seed)
    parts = np.sort(np.floor(rows * 2**10).astype(int), axis=0)
    assert (parts == np.arange(2**10)[:, None]).all()


def test_seeds_scramble_each_coordinate_in_its_own_way():
    first, second = units(8, np.arange(256), 1), units(8, np.arange(256), 2)
    assert len({column.tobytes() for column in np.hstack([first, second]).T}) == 16
    # a shift alone would leave the digits' differences of two numbers as they are
    whole = (units(8, np.arange(256)) * 2**53).astype(np.int64)
    mixed = (first * 2**53).astype(np.int64)
    assert ((mixed[1:] ^ mixed[:-1]) != (whole[1:] ^ whole[:-1])).any(axis=0).all()


def bits_of(number):
    """Its 64 bits, the highest first."""
    return np.array([number >> k & 1 for k in range(63, -1, -1)])


@pytest.mark.parametrize("seed", [0, 5])
def test_a_scrambled_number_is_a_matrix_of_bits_times_the_number_and_a_shift(seed):
    rng = np.random.Generator(np.random.PCG64(seed))
    numbers = [0, 1, 2, 1000, 2**40 + 3]
    plain, mixed = units(3, numbers), units(3, numbers, seed)
    for i in range(3):
        # 65 words of eight bytes: rows of a triangle with ones on its diagonal, and the shift
        words = [bits_of(int.from_bytes(rng.bytes(8), "little")) for _ in range(65)]
        L = np.tril(words[:64], -1) + np.eye(64, dtype=int)
        for before, after in zip(plain[:, i], mixed[:, i], strict=True):
            # the highest 53 bits of the result depend on no lower ones
            bits = (L @ bits_of(int(before * 2**53) << 11) + words[64]) % 2
            assert after == sum(int(bit) / 2 ** (k + 1) for k, bit in enumerate(bits[:53]))


def test_the_mean_of_a_scrambled_number_over_seeds_is_a_half():
    firsts = np.array([units(2, [0, 77], seed) for seed in range(400)])
    # standard deviation of a mean of n uniform numbers: 1 / sqrt(12 n); six of them
    assert np.abs(firsts.mean(axis=0) - 0.5).max() < 6 / np.sqrt(12 * 400)


def test_its_map_does_not_depend_on_the_chunk():
    arm = two_links()
    cells = Cells.box([-1, -1, -0.1], [1, 1, 0.1], 0.05)
    sweep = Sweep(arm, Sobol.of(arm, 3000, seed=7), cells, "manipulability")
    whole = bits(run(sweep, workers=1))
    assert bits(run(sweep, chunk=77, workers=3)) == whole


def test_a_map_keeps_its_samples_in_a_file(tmp_path):
    arm = two_links()
    cells = Cells.box([-1, -1, -0.1], [1, 1, 0.1], 0.05)
    found = run(Sweep(arm, Sobol.of(arm, 100, seed=None), cells, "manipulability"))
    found.save(tmp_path / "map.npz")
    again = pk.sweep.load_map(tmp_path / "map.npz")
    assert again.samples.describe() == {
        "sobol": 100,
        "seed": None,
        "lower": [-np.pi, -np.pi],
        "upper": [np.pi, np.pi],
    }
    assert again.configurations().tobytes() == found.configurations().tobytes()


@pytest.mark.parametrize(
    ("count", "seed", "words"), [(0, 0, "count"), (8, -1, "seed"), (8, 0.5, "seed")]
)
def test_what_cannot_be_sampled_is_refused(count, seed, words):
    with pytest.raises(InputError, match=words):
        Sobol.of(two_links(), count, seed)


def test_an_arm_of_more_coordinates_is_refused():
    screws = [pk.screw.revolute([0, 0, 1], [x, 0, 0]) for x in range(MOST + 1)]
    with pytest.raises(InputError, match="at most 32 coordinates, got 33"):
        Sobol.of(pk.Chain(screws, np.eye(4), frame="space"), 10)
