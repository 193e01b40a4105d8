"""Lists that are not full, their length, and their words."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError
from poekin.sweep import PoseSamples, Random, top
from poekin.sweep.maps.top import TopSamples
from tests.findings import defaults_are_those_of_the_docstring
from tests.sweep.arms import two_links

ARM = two_links()


def test_of_fewer_reached_poses_than_are_asked_for_there_are_no_more():
    arm = pk.load("ur5e").chain(tip="tool0")
    poses = PoseSamples.random([0.2, 0.2, 0.2], [0.9, 0.9, 0.9], 40, seed=1)
    counts = pk.ik_all(arm, poses.poses(np.arange(40))).counts
    found = top(arm, "solutions", 30, samples=poses)
    reached = np.count_nonzero(counts)
    assert 0 < reached < 30
    assert found.numbers.tolist() == np.lexsort((np.arange(40), -counts))[:reached].tolist()
    assert found.values.tolist() == counts[found.numbers].tolist()
    assert found.T is not None
    assert (len(found.q), len(found.T)) == (reached, reached)


def test_a_summary_says_how_many_of_how_many_and_the_first_and_the_last_measure():
    about = {"measure": "limit_margin", "keep": "worst", "samples": {}, "count": 77}
    values = np.array([0.012, 0.5, 0.75])
    found = TopSamples(about, values, np.arange(3), np.zeros((3, 2)))
    assert found.summary() == (
        "3 worst of 77 configurations: distance to the joint limits 1.2 to 75 % of half the range"
    )


def test_a_list_has_ten_by_default_and_fewer_than_2_to_the_20(monkeypatch):
    def run_totals(sweep, **options):
        raise FloatingPointError(sweep.cells.length)

    assert defaults_are_those_of_the_docstring(top)
    samples = Random.of(ARM, 2**30)
    monkeypatch.setattr("poekin.sweep.maps.top.run_totals", run_totals)
    with pytest.raises(FloatingPointError, match=r"^1048575$"):
        top(ARM, "travel", 2**20 - 1, samples=samples)
    with pytest.raises(FloatingPointError, match=r"^10$"):
        top(ARM, "travel", samples=samples)
    with pytest.raises(InputError, match="count: expected a whole number from 1 on, got 1048576"):
        top(ARM, "travel", 2**20, samples=samples)
