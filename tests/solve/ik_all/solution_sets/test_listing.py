"""Listings of parts of the targets become one, in the order of the targets."""

from __future__ import annotations

import numpy as np

from poekin.solve.ik_all.solution_sets.found import Tally
from poekin.solve.ik_all.solution_sets.listing import ListedPart, Listing, gathered
from poekin.solve.ik_all.solution_sets.places import Places
from poekin.solve.ik_all.solution_sets.self_motion import SelfMotion

A, B = (SelfMotion((name,), np.zeros(1)) for name in "ab")


def listing(n: list[int], owner: list[int], targets: list[int], **moving: SelfMotion) -> Listing:
    """Rows of numbers n with their targets; of each target numbers made of its own."""
    rows, of = np.array(n), np.array(targets)
    return Listing(
        Places(rows[:, None] + 0.5, np.array(owner), 2 * rows, 3 * of),
        np.stack([4.0 * rows, 5.0 * rows], axis=1),
        Tally(6 * of, 7.0 * of, 8 * of, 9 * of, of % 2 > 0, of % 2 < 1,
              {int(k[1:]): motion for k, motion in moving.items()}),
    )  # fmt: skip


FIRST = listing([1, 2, 3], [0, 0, 1], [11, 12], t1=A)
SECOND = listing([4, 5], [0, 1], [13, 14], t0=B)


def check(whole: Listing, n: list[int], owner: list[int], targets: list[int]) -> None:
    rows, of = np.array(n), np.array(targets)
    np.testing.assert_array_equal(whole.places.q[:, 0], rows + 0.5)
    np.testing.assert_array_equal(whole.places.owner, owner)
    np.testing.assert_array_equal(whole.places.number, 2 * rows)
    np.testing.assert_array_equal(whole.places.within, 3 * of)
    np.testing.assert_array_equal(whole.errors, np.stack([4 * rows, 5 * rows], axis=1))
    tally = whole.tally
    for factor, name in enumerate(("found", "least_hits", "ends", "restarts"), start=6):
        np.testing.assert_array_equal(getattr(tally, name), factor * of)
    np.testing.assert_array_equal(tally.full, (of > 0) & (of % 2 > 0))
    np.testing.assert_array_equal(tally.sure, (of > 0) & (of % 2 < 1))


def test_parts_are_put_together_in_the_order_of_the_targets_and_others_have_no_solutions():
    parts = [ListedPart(np.array([0, 3]), FIRST), ListedPart(np.array([2, 4]), SECOND)]
    whole = gathered(parts, 6)
    check(whole, [1, 2, 4, 3, 5], [0, 0, 2, 3, 4], [11, 0, 13, 12, 14, 0])
    assert whole.tally.self_motion == {3: A, 2: B}


def test_parts_that_follow_one_another_stay_in_their_order():
    parts = [ListedPart(np.array([0, 1]), FIRST), ListedPart(np.array([2, 3]), SECOND)]
    whole = gathered(parts, 4)
    check(whole, [1, 2, 3, 4, 5], [0, 0, 1, 2, 3], [11, 12, 13, 14])
    assert whole.tally.self_motion == {1: A, 2: B}


def test_a_part_takes_the_place_of_what_one_before_has_of_its_targets():
    all_of_them = ListedPart(np.arange(3), listing([1, 2], [0, 0], [11, 0, 0], t0=A))
    whole = gathered([all_of_them, ListedPart(np.array([1, 2]), SECOND)], 3)
    check(whole, [1, 2, 4, 5], [0, 0, 1, 2], [11, 13, 14])
    assert whole.tally.self_motion == {0: A, 1: B}


def test_the_only_part_is_the_listing_where_it_has_all_targets():
    assert gathered([ListedPart(np.arange(2), FIRST)], 2) is FIRST
    check(gathered([ListedPart(np.array([1, 2]), FIRST)], 3), [1, 2, 3], [1, 1, 2], [0, 11, 12])
    assert gathered([ListedPart(np.array([1, 2]), FIRST)], 3).tally.self_motion == {2: A}
