"""The box of a map, and its options."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError
from poekin.sweep import Random, reach
from tests.findings import defaults_are_those_of_the_docstring
from tests.messages import says
from tests.sweep.arms import two_links

ARM = two_links()
SAMPLES = 500
P = ARM.fk(Random.of(ARM, SAMPLES, 6).configurations(np.arange(SAMPLES)))[:, :3, 3]


@pytest.mark.parametrize("size", [0.13, 0.3])
def test_the_map_has_two_cubes_more_on_each_side_than_its_samples_take(size):
    found = reach(ARM, resolution=size, samples=SAMPLES, seed=6)
    # corners are whole numbers of cubes, and no place lies within a rounding of one here
    lower, upper = np.floor(P.min(axis=0) / size) - 2, np.ceil(P.max(axis=0) / size) + 2
    np.testing.assert_allclose(np.divide(found.cells.corner, size)[:2], lower[:2], atol=1e-9)
    assert found.cells.shape[:2] == tuple((upper - lower)[:2])
    assert (found.counts.sum(), found.outside) == (SAMPLES, 0)


def test_options_left_out_are_those_of_the_docstring():
    assert defaults_are_those_of_the_docstring(reach)
    found = reach(ARM, samples=SAMPLES)
    assert (found.cells.resolution, found.cells.side) == (0.05, 0)
    assert (found.about["measure"], found.about["keep"]) == ("reach", "best")
    assert found.about["samples"] == Random.of(ARM, SAMPLES, 0).describe()


def test_poses_are_tried_around_100_000_configurations_however_few_they_are():
    arm = pk.load("ur5e").chain(tip="tool0")
    found = reach(arm, resolution=0.7, by="poses", samples=5, seed=9)
    q = Random.of(arm, 100_000, 0).configurations(np.arange(100_000))
    p = arm.fk(q)[:, :3, 3]
    lower, upper = np.floor(p.min(axis=0) / 0.7 - 2), np.ceil(p.max(axis=0) / 0.7 + 2)
    np.testing.assert_allclose(np.divide(found.cells.corner, 0.7), lower, atol=1e-9)
    assert found.cells.shape == tuple(upper - lower)
    middles = reach(arm, resolution=1.1, by="middles", turns=2)
    assert middles.samples.count == 2 * middles.cells.count


def test_turns_are_of_middles_alone():
    with pytest.raises(InputError) as caught:
        reach(ARM, samples=5, turns=0)
    assert says(caught.value, "turns: expected 1 unless by is 'middles', got 0")
