"""Ends of a histogram that nobody gave, its options, and what they may be."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from poekin.errors import InputError
from poekin.sweep import Random, histogram
from poekin.sweep.maps.histogram import _tried
from tests.findings import defaults_are_those_of_the_docstring
from tests.messages import says
from tests.sweep.arms import two_links

ARM = two_links()


@pytest.mark.parametrize(("count", "tried"), [(7, 7), (10**6, 100_000)])
@pytest.mark.parametrize(
    ("best", "worst", "expected"),
    [(3.0, 1.0, (1.0, 3.002)), (1.0, 3.0, (1.0, 3.002)), (2.0, 2.0, (2.0, 3.0))],
)
def test_ends_are_those_of_up_to_100_000_samples_and_a_thousandth_of_the_range_more(
    monkeypatch, count, tried, best, worst, expected
):
    asked = []

    def top(chain, measure, number, *, keep, samples):
        asked.append((chain, measure, number, keep, samples.count, samples.seed))
        return SimpleNamespace(values=[{"best": best, "worst": worst}[keep]])

    monkeypatch.setattr("poekin.sweep.maps.histogram.top", top)
    assert _tried(ARM, Random.of(ARM, count, 8), "travel") == pytest.approx(expected, rel=1e-15)
    assert asked == [(ARM, "travel", 1, keep, tried, 8) for keep in ("best", "worst")]


def test_options_left_out_are_those_of_the_docstring(tmp_path):
    assert defaults_are_those_of_the_docstring(histogram)
    samples = Random.of(ARM, 50)
    found = histogram(ARM, "travel", samples=samples, store=tmp_path, ends=(0, 4))
    assert found.counts.shape == (100,)
    # a store that was begun is gone on with only where that is asked for
    with pytest.raises(InputError, match="resume=True goes on with it"):
        histogram(ARM, "travel", samples=samples, store=tmp_path, ends=(0, 4))


def test_there_are_fewer_than_2_to_the_24_bins(monkeypatch):
    def run_totals(sweep, **options):
        raise FloatingPointError(sweep.cells.count)

    monkeypatch.setattr("poekin.sweep.maps.histogram.run_totals", run_totals)
    with pytest.raises(FloatingPointError, match=str(2**24 - 1)):
        histogram(ARM, "travel", bins=2**24 - 1, ends=(0, 4))
    with pytest.raises(InputError) as caught:
        histogram(ARM, "travel", bins=2**24, ends=(0, 4))
    assert says(caught.value, "bins: expected a whole number from 1 on, got 16777216")
