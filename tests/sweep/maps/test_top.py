"""The best and the worst configurations of all, in order, of equal ones the first."""

from __future__ import annotations

import pickle
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import InputError
from poekin.sweep import Grid, JointTravel, Random, top
from poekin.sweep.bins import TopList
from poekin.sweep.execution.totals import Totals, part_of
from poekin.sweep.sweep import Sweep
from tests.findings import dataclasses_of, frozen_and_equal_only_where_its_parts_can_be
from tests.sweep.arms import two_links

ARM = pk.load("panda").chain(tip="panda_hand")
SAMPLES = Random.of(ARM, 4000, 6)


@pytest.mark.parametrize("keep", ["best", "worst"])
@pytest.mark.parametrize("name", ["travel", "smallest_singular_value"])
@pytest.mark.parametrize("count", [1, 7, 100])
def test_they_are_those_of_all_configurations_in_order(name, keep, count):
    q = SAMPLES.configurations(np.arange(SAMPLES.count))
    if name == "travel":
        own = np.abs(q - np.clip(0, *ARM.limits.T)).max(axis=1)
        order = np.argsort(own, kind="stable")
    else:
        own = pk.manipulability(ARM, q).pose.smallest
        order = np.argsort(-own, kind="stable")
    if keep == "worst":
        order = order[::-1]
    found = top(ARM, name, count, keep=keep, samples=SAMPLES, chunk=333, workers=3)
    np.testing.assert_array_equal(found.numbers, order[:count])
    np.testing.assert_allclose(found.values, own[order[:count]], atol=1e-14)
    np.testing.assert_array_equal(found.q, q[order[:count]])


@given(st.lists(st.integers(1, 1999), max_size=4, unique=True), st.randoms())
@settings(max_examples=20)
def test_of_equal_measures_the_first_samples_stay_in_any_order_of_the_parts(cuts, order):
    # the first coordinate has fifty values, and the second does not count
    arm = two_links()
    grid = Grid.of(arm, [50, 40])
    sweep = Sweep(arm, grid, TopList(90), JointTravel((0.0, 0.0), (1.0, 1e9)))
    parts = [part_of(pickle.dumps(sweep), a, b) for a, b in pairwise([0, *sorted(cuts), 2000])]
    order.shuffle(parts)
    totals = Totals(sweep)
    for part in parts:
        totals.add(part)
    # the two rows nearest to 0 have 40 each, on either side; then ten of the next
    near = np.arange(24 * 40, 26 * 40)
    assert sorted(totals.attained[:80]) == near.tolist()
    values = -totals.best
    expected = np.lexsort((totals.attained, values))
    assert (expected == np.arange(90)).all()
    whole = Totals(sweep)
    whole.run(0, 2000)
    assert whole.attained.tobytes() == totals.attained.tobytes()
    assert whole.best.tobytes() == totals.best.tobytes()


def test_fewer_samples_are_all_in_the_list():
    found = top(two_links(), "travel", 10, samples=3)
    assert sorted(found.numbers) == [0, 1, 2]
    assert found.summary() == (
        f"3 best of 3 configurations: joint travel {found.values[0]:.4g} to "
        f"{found.values[-1]:.4g} rad or m"
    )


def test_a_store_keeps_and_gives_back_the_list(tmp_path):
    options = {"samples": SAMPLES, "store": tmp_path, "chunk": 1000}
    first = top(ARM, "manipulability", 5, **options)
    again = top(ARM, "manipulability", 5, **options, resume=True)
    assert again.numbers.tobytes() == first.numbers.tobytes()
    assert again.values.tobytes() == first.values.tobytes()
    with pytest.raises(InputError, match="these differ: top"):
        top(ARM, "manipulability", 6, **options, resume=True)


@pytest.mark.parametrize(
    ("measure", "options", "words"),
    [
        ("reach", {}, "measure: expected a measure to keep"),
        ("travel", {"count": 0}, "count: expected a whole number from 1"),
        ("travel", {"keep": "mean"}, "keep: expected 'best' or 'worst', got 'mean'"),
        ("travel", {"workers": 0}, "workers"),
    ],
)
def test_what_cannot_be_found_is_refused(measure, options, words):
    with pytest.raises(InputError, match=words):
        top(ARM, measure, **{"samples": 100} | options)


@pytest.mark.parametrize("kind", dataclasses_of("poekin.sweep.maps", "top"))
def test_a_list_is_frozen_and_equal_only_where_its_parts_can_be(kind):
    assert frozen_and_equal_only_where_its_parts_can_be(kind)
