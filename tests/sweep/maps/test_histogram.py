"""Histograms of measures over all configurations."""

from __future__ import annotations

import math
import re
from concurrent.futures import ProcessPoolExecutor

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError
from poekin.sweep import Grid, JointTravel, Random, Sobol, histogram, top
from tests.findings import dataclasses_of, frozen_and_equal_only_where_its_parts_can_be
from tests.sweep.arms import slide, two_links

ARM = pk.load("panda").chain(tip="panda_hand")


def margins(chain, samples):
    q = samples.configurations(np.arange(samples.count))
    lower, upper = chain.limits.T
    return 1 - (np.abs(q - (lower + upper) / 2) * 2 / (upper - lower)).max(axis=1)


@pytest.mark.parametrize("samples", [Random.of(ARM, 5000, 3), Sobol.of(ARM, 5000)])
def test_it_counts_as_numpy_does_and_says_what_is_outside(samples):
    found = histogram(ARM, "limit_margin", bins=37, ends=(0.1, 0.4), samples=samples)
    own = margins(ARM, samples)
    counts, edges = np.histogram(own, 37, (0.1, 0.4))
    # one within rounding of a border may be on either side
    place = (own - 0.1) * 37 / 0.3
    tied = np.count_nonzero(np.abs(place - np.round(place)) < 1e-9)
    assert np.abs(found.counts - counts).sum() <= 2 * tied
    assert found.outside == 5000 - found.counts.sum()
    assert 0 < found.outside < 5000
    np.testing.assert_array_equal(found.edges, edges)


def test_the_counts_are_the_same_however_it_is_run(tmp_path):
    options = {"bins": 50, "ends": (0.0, 0.2), "samples": 10_001}
    whole = histogram(ARM, "manipulability", **options, workers=1)
    with ProcessPoolExecutor(2) as pool:
        others = [
            histogram(ARM, "manipulability", **options, workers=3, chunk=700),
            histogram(ARM, "manipulability", **options, executor=pool, chunk=2500),
            histogram(ARM, "manipulability", **options, store=tmp_path, chunk=3000),
            histogram(ARM, "manipulability", **options, store=tmp_path, chunk=3000, resume=True),
        ]
    for other in others:
        assert other.counts.tobytes() == whole.counts.tobytes()
        assert other.outside == whole.outside


def test_without_ends_the_bins_hold_all_of_few_configurations():
    found = histogram(ARM, "manipulability", bins=10, samples=3000)
    own = pk.manipulability(
        ARM, Random.of(ARM, 3000).configurations(np.arange(3000))
    ).pose.yoshikawa
    assert found.outside == 0
    assert found.counts.sum() == 3000
    assert found.edges[0] == pytest.approx(own.min(), abs=1e-7)
    assert found.edges[-1] == pytest.approx(own.max() + 1e-3 * np.ptp(own), abs=1e-7)


def test_a_measure_that_is_one_number_has_a_bin_all_the_same():
    middle = Grid.of(slide(), 1)
    found = histogram(slide(), JointTravel((0.2, 0.5)), bins=4, samples=middle)
    assert found.counts.tolist() == [1, 0, 0, 0]
    assert (found.edges == np.arange(5) / 4).all()


def test_the_summary_names_measure_and_quantiles():
    found = histogram(two_links(), "travel", bins=100, ends=(0.0, 2 * math.pi), samples=20_000)
    lines = found.summary().split("\n")
    assert lines[0] == "20000 configurations, 0 more outside of the bins"
    # of two even numbers from 0 to π the larger one is below π √p with probability p
    edges = np.pi * np.sqrt([0.05, 0.5, 0.95])
    said = [
        float(word)
        for word in lines[1].replace("5 %", "").split()
        if word[0].isdigit() and "." in word
    ]
    assert lines[1].startswith("joint travel: 5 % below ")
    # a bin's width, and chance, some 1 / sqrt(20000)
    np.testing.assert_allclose(said, edges, atol=2 * np.pi / 100 + 0.05)
    far = histogram(two_links(), "travel", ends=(8.0, 9.0), samples=10)
    assert far.summary() == "0 configurations, 10 more outside of the bins"


@pytest.mark.parametrize(
    ("measure", "options", "words"),
    [
        ("reach", {}, "measure: expected a measure to keep, got 'reach'"),
        ("travel", {"bins": 0}, "bins: expected a whole number from 1"),
        ("travel", {"bins": 2**24}, "bins"),
        (
            "travel",
            {"ends": (1.0, 1.0)},
            r"^ends: expected two numbers, the smaller one first, got \(1\.0, 1\.0\)$",
        ),
        ("travel", {"ends": (2.0, 1.0)}, "ends: expected two numbers, the smaller one first"),
        ("travel", {"ends": (0.0, math.inf)}, "ends: expected two numbers"),
        ("travel", {"ends": (math.nan, 1.0)}, "ends: expected two numbers"),
        *[("travel", {"ends": ends}, "ends: expected two") for ends in ((0, 1, 2), (0,), 5, "ab")],
        (
            "travel",
            {"resume": True},
            "^resume: expected a store, which keeps what is done, got none$",
        ),
        ("travel", {"samples": 0}, "count: expected a whole number"),
        ("travel", {"chunk": 0}, "chunk"),
    ],
)
def test_what_cannot_be_counted_is_refused(measure, options, words):
    with pytest.raises(InputError, match=words):
        histogram(ARM, measure, **{"samples": 100} | options)


@pytest.mark.parametrize("how", [histogram, top])
def test_an_option_that_there_is_not_is_refused(how):
    count = {"count": 1} if how is top else {"bins": 2}
    with pytest.raises(InputError, match=r"^sweep: no option 'worker'; did you mean 'workers'\?"):
        how(ARM, "travel", samples=100, worker=3, **count)


def test_its_summary_says_below_which_value_a_share_of_the_configurations_is():
    found = histogram(two_links(), "manipulability", bins=100, ends=(0.0, 1.0), samples=2000)
    first, second = found.summary().split("\n")
    assert first == f"{found.counts.sum()} configurations, {found.outside} more outside of the bins"
    said = re.fullmatch(
        r"manipulability.*: 5 % below (.*), half below (.*), 95 % below (.*)", second
    )
    assert said is not None
    for text, share in zip(said.groups(), (0.05, 0.5, 0.95), strict=True):
        edge = round(100 * float(text.split()[0]))
        # the first of the edges below which there are as many
        assert (
            found.counts[:edge].sum() >= share * found.counts.sum() > found.counts[: edge - 1].sum()
        )
    empty = histogram(two_links(), "manipulability", bins=1, ends=(8.0, 9.0), samples=10)
    assert empty.summary() == "0 configurations, 10 more outside of the bins"


@pytest.mark.parametrize("kind", dataclasses_of("poekin.sweep.maps", "histogram"))
def test_a_histogram_is_frozen_and_equal_only_where_its_parts_can_be(kind):
    assert frozen_and_equal_only_where_its_parts_can_be(kind)


def test_a_summary_has_the_shares_of_what_is_in_the_bins():
    edges = np.linspace(0.0, 1.0, 11)
    counts = np.full(10, 10)
    found = pk.sweep.MeasureHistogram(
        {"measure": "manipulability", "samples": {"random": 400}}, edges, counts, 300
    )
    _, words = found.summary().split("\n")
    assert words == "manipulability: 5 % below 0.1, half below 0.5, 95 % below 1"
