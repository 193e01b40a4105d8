"""What a sweep is asked for cannot be changed on its way, and is no other that happens to look like it."""

from __future__ import annotations

import pytest

from tests.findings import dataclasses_of, frozen_and_equal_only_where_its_parts_can_be

OF_NUMBERS = [
    *dataclasses_of("poekin.sweep.masks", "self_collision"),
    *dataclasses_of("poekin.sweep.measures", "solutions"),
]
OF_CHAINS = dataclasses_of("poekin.sweep", "samples pose_samples sweep")


@pytest.mark.parametrize("kind", OF_NUMBERS)
def test_masks_and_measures_are_equal_where_their_numbers_are(kind):
    assert frozen_and_equal_only_where_its_parts_can_be(kind)


@pytest.mark.parametrize("kind", OF_CHAINS)
def test_samples_and_sweeps_are_equal_to_themselves_alone(kind):
    """They hold a chain, and its arrays cannot be compared as one."""
    assert kind.__dataclass_params__.frozen
    assert kind.__eq__ is object.__eq__
