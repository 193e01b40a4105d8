"""Solutions of several targets are kept, placed, joined and replaced with all that belongs to each."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from poekin.solve.ik_all.solution_sets.found import Found, joined, reduce_parts, replaced, scattered
from poekin.solve.ik_all.solution_sets.self_motion import SelfMotion
from poekin.solve.ragged import Ragged

A, B, C = (SelfMotion((name,), np.zeros(2)) for name in "abc")


def made(counts: list[int], first: int, **self_motion: SelfMotion) -> Found:
    """Solutions [n, -n] and hits 10 n, with n from `first` on; numbers of targets from 100 n on."""
    n = np.arange(first, first + sum(counts))
    targets = np.arange(len(counts)) + first
    return Found(
        q=Ragged(np.stack([n, -n], axis=1).astype(float), np.array(counts)),
        hits=np.asarray(10.0 * n, np.float64),
        ends=100 * targets,
        restarts=1000 * targets,
        full=targets % 2 > 0,
        singular=targets % 2 < 1,
        self_motion={int(k[1:]): motion for k, motion in self_motion.items()},
    )


def told(found: Found) -> dict[str, object]:
    """All of it, each solution by its n, which rows and hits have in common."""
    n = found.q.rows[:, 0]
    np.testing.assert_array_equal(found.q.rows[:, 1], -n)
    np.testing.assert_array_equal(found.hits, 10 * n)
    np.testing.assert_array_equal(found.restarts, 10 * found.ends)
    return {
        "n": [part[:, 0].tolist() for part in found.q],
        "ends": found.ends.tolist(),
        "full": found.full.tolist(),
        "singular": found.singular.tolist(),
        "moving": {k: motion.names[0] for k, motion in found.self_motion.items()},
    }


THREE = made([2, 0, 1], 1, t0=A, t2=B)


def test_the_rarest_solution_of_each_target_is_found_and_tallied():
    assert replace(THREE, hits=np.array([5.0, 3.0, 4.0])).least_hits().tolist() == [3, 0, 4]
    assert len(THREE) == 3
    tally = THREE.tally(True)
    assert tally.found.tolist() == [2, 0, 1]
    assert tally.least_hits.tolist() == [10, 0, 30]
    assert (tally.ends.tolist(), tally.restarts.tolist()) == ([100, 200, 300], [1000, 2000, 3000])
    assert (tally.full.tolist(), tally.sure.tolist()) == ([True, False, True], [True, True, True])
    assert tally.self_motion == {0: A, 2: B}
    assert THREE.tally(False).sure.tolist() == [False, False, False]


def test_rows_that_are_not_kept_leave_their_targets():
    kept = told(THREE.kept(np.array([False, True, False])))
    assert kept == told(THREE) | {"n": [[2], [], []]}


def test_solutions_are_placed_among_more_targets():
    assert told(THREE.placed(np.array([1, 2, 4]), 6)) == {
        "n": [[], [1, 2], [], [], [3], []],
        "ends": [0, 100, 200, 0, 300, 0],
        "full": [False, True, False, False, True, False],
        "singular": [False, False, True, False, False, False],
        "moving": {1: "a", 4: "b"},
    }


def test_parts_are_joined_one_after_the_other():
    assert told(joined([THREE, made([1, 1], 4, t1=C)], 2)) == {
        "n": [[1, 2], [], [3], [4], [5]],
        "ends": [100, 200, 300, 400, 500],
        "full": [True, False, True, False, True],
        "singular": [False, True, False, True, False],
        "moving": {0: "a", 2: "b", 4: "c"},
    }
    nothing = joined([], 3)
    assert (len(nothing), nothing.q.rows.shape, nothing.hits.shape) == (0, (0, 3), (0,))


def test_targets_are_replaced_with_all_that_belongs_to_them():
    both = told(replaced(THREE, np.array([0, 1]), made([1, 2], 7, t1=C)))
    assert both == {
        "n": [[7], [8, 9], [3]],
        "ends": [700, 800, 300],
        "full": [True, False, True],
        "singular": [False, True, False],
        "moving": {1: "c", 2: "b"},
    }
    assert replaced(THREE, np.zeros(0, int), made([], 7)) is THREE


@pytest.mark.parametrize(("function", "expected"), [
    (np.minimum, [[1.0, -4.0], [7.0, 7.0], [5.0, 6.0], [7.0, 7.0]]),
    (np.add, [[4.0, -2.0], [7.0, 7.0], [5.0, 6.0], [7.0, 7.0]]),
])  # fmt: skip
def test_parts_are_reduced_and_those_of_nothing_are_empty(function, expected):
    parts = Ragged(np.zeros((3, 0)), np.array([2, 0, 1, 0]))
    values = np.array([[1.0, 2.0], [3.0, -4.0], [5.0, 6.0]])
    np.testing.assert_array_equal(reduce_parts(function, values, parts, 7.0), expected)
    none = Ragged(np.zeros((0, 0)), np.array([0, 0]))
    np.testing.assert_array_equal(
        reduce_parts(function, values[:0], none, 7.0), np.full((2, 2), 7.0)
    )


def test_values_of_parts_are_scattered_and_the_others_are_0():
    parts = [np.array([3, 0]), np.array([1])]
    whole = scattered(parts, [np.array([True, True]), np.array([True])], 5)
    assert whole.tolist() == [True, True, False, True, False]
    assert whole.dtype == bool
