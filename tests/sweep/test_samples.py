"""Samples by number, against whole numbers of Python and what is published of the generator."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import InputError, ShapeError
from poekin.sweep import Cells, Grid, Random, Sobol, Sweep, run
from tests.sweep.arms import slide, two_links

MASK = 2**64 - 1
GOLDEN = 0x9E3779B97F4A7C15
# first outputs of SplitMix64 with the state 0, as its authors' reference program prints them
PUBLISHED = (0xE220A8397B1DCDAF, 0x6E789E6AA1B965F4, 0x06C45D188009454F, 0xF88BB8A8724C81EC)


def mixed(x):
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9 & MASK
    x = (x ^ (x >> 27)) * 0x94D049BB133111EB & MASK
    return x ^ (x >> 31)


def unit(seed, number):
    return (mixed((mixed(seed) + (number + 1) * GOLDEN) & MASK) >> 11) / 2**53


def test_the_random_numbers_are_those_of_splitmix64():
    samples = Random(np.zeros(1), np.ones(1), 10)
    found = samples.configurations(np.arange(4))[:, 0]
    assert found.tolist() == [(bits >> 11) / 2**53 for bits in PUBLISHED]


@given(st.integers(0, 2**62 - 1), st.integers(0, 2**50))
def test_a_sample_is_a_function_of_seed_and_number_alone(seed, number):
    lower, upper = np.array([-1.0, 2.0, 0.0]), np.array([1.0, 5.0, 0.5])
    samples = Random(lower, upper, 2**51, seed)
    (q,) = samples.configurations([number])
    units = np.array([unit(seed, 3 * number + i) for i in range(3)])
    assert q.tolist() == (lower + (upper - lower) * units).tolist()


def test_samples_fill_their_range_evenly_and_independently():
    chain = pk.load("ur5e").chain()
    q = Random.of(chain, 10**6, seed=3).configurations(np.arange(40_000))
    units = (q - chain.limits[:, 0]) / np.ptp(chain.limits, axis=1)
    # standard deviations: of a mean 1 / sqrt(12 N), of a correlation 1 / sqrt(N); six of them
    assert np.abs(units.mean(axis=0) - 0.5).max() < 6 / np.sqrt(12 * len(q))
    off_diagonal = np.corrcoef(units.T) - np.eye(6)
    assert np.abs(off_diagonal).max() < 6 / np.sqrt(len(q))
    again = Random.of(chain, 10**6, seed=4).configurations(np.arange(40_000))
    assert abs(np.corrcoef(q[:, 0], again[:, 0])[0, 1]) < 6 / np.sqrt(len(q))


@pytest.mark.parametrize(
    "samples",
    [
        Grid.of(two_links(), [13, 17]),
        Random.of(two_links(), 200, seed=2),
        Sobol.of(two_links(), 200, seed=2),
    ],
    ids=lambda samples: type(samples).__name__,
)
def test_a_sweep_counts_the_configurations_that_its_samples_are(samples):
    # cells of a size with which no grid lies on a border
    cells = Cells.box([-0.9, -0.9, -0.9], [0.9, 0.9, 0.9], 0.37)
    q = samples.configurations(np.arange(samples.count))
    expected = np.bincount(cells.find(two_links().fk(q)), minlength=cells.count)
    assert (run(Sweep(two_links(), samples, cells)).counts.reshape(-1) == expected).all()


def test_a_grid_has_the_middles_of_equal_parts_the_last_coordinate_first():
    grid = Grid.of(slide(), [2, 3])
    assert grid.count == 6
    q = grid.configurations(np.arange(6))
    expected = [[x, y] for x in (0.1, 0.3) for y in (-0.5, 0.5, 1.5)]
    np.testing.assert_allclose(q, expected, rtol=1e-15)


def test_one_number_of_parts_is_that_of_every_coordinate():
    assert Grid.of(two_links(), 4).counts == (4, 4)


def test_coordinates_without_limits_have_one_turn():
    chain = pk.Chain(two_links().screws, np.eye(4), frame="space")
    samples = Random.of(chain, 10)
    np.testing.assert_allclose(samples.bounds, [[-np.pi] * 2, [2 * np.pi] * 2])


@pytest.mark.parametrize(
    ("make", "error", "words"),
    [
        (lambda: Random.of(two_links(), 0), InputError, "count: expected a whole number from 1"),
        (lambda: Random.of(two_links(), 2**56), InputError, "count: expected a whole number"),
        (lambda: Random.of(two_links(), 10, seed=-1), InputError, "seed"),
        (lambda: Grid.of(two_links(), [2, 3, 4]), ShapeError, "expected one or 2 numbers, got 3"),
        (lambda: Grid.of(two_links(), [2, 0]), InputError, "counts"),
        (lambda: Grid.of(two_links(), 2**40), InputError, "product of the counts"),
        (lambda: Random.of(pk.Chain([], np.eye(4), frame="space"), 3), InputError, "no coordinate"),
    ],
)
def test_what_cannot_be_sampled_is_refused(make, error, words):
    with pytest.raises(error, match=words):
        make()


def test_as_many_samples_as_64_coordinates_of_each_can_be_counted():
    assert Random.of(two_links(), 2**56 - 1).count == 2**56 - 1
    assert Grid.of(two_links(), 2**27).count == 2**54


def test_an_arm_whose_joints_cut_corners_off_its_coordinates_is_refused():
    coupled = pk.Chain(
        two_links().screws,
        np.eye(4),
        frame="space",
        coupling=[[1, 0], [1, 1]],
        q_names=["a", "b"],
        limits=[[-2, 2], [-2, 2]],
        joint_limits=[[-2, 2], [-1, 1]],
    )
    with pytest.raises(InputError, match="beyond their own"):
        Random.of(coupled, 10)


@pytest.mark.parametrize("numbers", [[-1], [10]])
def test_numbers_of_no_sample_are_refused(numbers):
    with pytest.raises(InputError, match=r"expected 0 ... 9"):
        Random.of(two_links(), 10).configurations(numbers)


@pytest.mark.parametrize(
    ("numbers", "words"),
    [([0.5], r"got float64 \(1,\)"), ([[1]], r"got int\d+ \(1, 1\)"), (3, r"got int\d+ \(\)")],
)
def test_what_are_no_numbers_of_samples_is_refused(numbers, words):
    with pytest.raises(ShapeError, match=f"numbers: expected whole numbers .N,., {words}"):
        Random.of(two_links(), 10).configurations(numbers)
