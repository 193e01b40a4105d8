"""Numbers in the help of the sweeps are those of what is computed."""

from __future__ import annotations

from typing import get_args

from poekin.cli.sweep import histogram, options, reach
from poekin.sweep.maps.histogram import _TRIED


def help_of(option) -> str:
    return get_args(option)[1].help


def test_directions_are_twelve_times_the_square_of_a_side():
    assert f"12 SIDE² directions of the tool's z axis apart (4: {12 * 4**2} of them)" in help_of(
        reach.Side
    )


def test_bins_have_their_ends_of_as_many_configurations_as_are_tried_first():
    assert f"(default: of {_TRIED} configurations)" in help_of(histogram.Ends)


def test_a_number_of_samples_may_be_written_in_both_ways():
    for text, count in (("10000000", 10**7), ("1e8", 10**8)):
        assert text in help_of(options.Samples)
        assert options.count_from(text) == count
