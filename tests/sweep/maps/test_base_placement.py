"""Places of the base, ranked by what the arm reaches from there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import poekin as pk
from poekin.errors import PoseError, ShapeError
from poekin.sweep import BasePlacement, Cells, Random, Sweep, base_placement, run
from tests.findings import dataclasses_of, frozen_and_equal_only_where_its_parts_can_be

ARM = pk.load("ur5e").chain(tip="tool0")
CELLS = Cells.box([-1.1] * 3, [1.1] * 3, 0.1, side=1)
SAMPLES = Random.of(ARM, 200_000, seed=1)
MAP = run(Sweep(ARM, SAMPLES, CELLS))


def places(*p):
    T = np.tile(np.eye(4), (len(p), 1, 1))
    T[:, :3, 3] = p
    return T


def test_poses_that_were_sampled_are_reached_from_where_the_map_was_made():
    q = SAMPLES.configurations(np.arange(20))
    T_bt = ARM.fk(q)
    T_wb = pk.se3.exp([[0, 0, 1.0, 0.3, -0.2, 0.1], [0, 0, 0, 5.0, 0, 0]])
    ranking = base_placement(MAP, T_wb[0] @ T_bt, T_wb)
    assert ranking.order.tolist() == [0, 1]
    assert ranking.reached.tolist() == [20, 0]
    assert ranking.rarest.tolist() == [MAP.query(T_bt).min(), 0]
    np.testing.assert_array_equal(ranking.T_wb, T_wb)


def test_more_poses_come_first_then_more_samples_then_the_given_order():
    targets = pk.se3.exp([[0, 3.0, 0, 0.5, 0.1, 0.3], [0, 3.0, 0, 0.5, -0.3, 0.2]])
    bases = places([9, 0, 0], [0, 0, 0], [0.2, 0, 0], [0, 0, 0], [8, 0, 0])
    ranking = base_placement(MAP, targets, bases)
    counts = np.array([MAP.query(np.linalg.inv(T) @ targets) for T in bases])
    reached = (counts > 0).sum(axis=1)
    assert ranking.reached.tolist() == sorted(reached.tolist(), reverse=True)
    keys = [
        (-r, -w, k) for r, w, k in zip(ranking.reached, ranking.rarest, ranking.order, strict=True)
    ]
    assert keys == sorted(keys)
    assert ranking.order[-2:].tolist() == [0, 4]


def test_the_summary_says_the_best_and_how_many_serve():
    ranking = base_placement(MAP, places([0.4, 0.2, 0.3]), places([9, 0, 0], [0, 0, 0]))
    assert ranking.summary() == "candidate 1 (0 ... 1) reaches 1 of 1 poses; 1 reach all"
    assert ranking.to_dict()["poses"] == 1


MANY = r"^T_{}: expected poses \(N, 4, 4\), N from 1 on, got {}$"


@pytest.mark.parametrize(
    ("targets", "bases", "error", "words"),
    [
        (np.eye(4), places([0, 0, 0]), ShapeError, MANY.format("wt", r"\(4, 4\)")),
        (places([0, 0, 0]), np.empty((0, 4, 4)), ShapeError, MANY.format("wb", r"\(0, 4, 4\)")),
        (places([0, 0, 0]), 2 * places([0, 0, 0]), PoseError, "T_wb"),
    ],
)
def test_what_are_no_poses_is_refused(targets, bases, error, words):
    with pytest.raises(error, match=words):
        base_placement(MAP, targets, bases)


@pytest.mark.parametrize("kind", dataclasses_of("poekin.sweep.maps", "base_placement"))
def test_a_ranking_is_frozen_and_equal_only_where_its_parts_can_be(kind):
    assert frozen_and_equal_only_where_its_parts_can_be(kind)


def test_its_summary_names_the_best_of_the_candidates_and_counts_those_that_serve_all():
    found = BasePlacement(
        places([0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]),
        np.array([2, 1, 0, 3]),
        np.array([5, 5, 1, 0]),
        np.array([7, 6, 9, 0]),
        5,
    )
    assert found.summary() == "candidate 2 (0 ... 3) reaches 5 of 5 poses; 2 reach all"
    few = replace(found, poses=6)
    assert few.summary() == "candidate 2 (0 ... 3) reaches 5 of 6 poses; 0 reach all"


def test_a_pose_is_reached_by_one_sample_and_the_rarest_is_that_of_the_reached():
    # cubes along x with so many samples each
    line = Cells((0.0, 0.0, 0.0), 1.0, (6, 1, 1))
    counts = np.array([3, 0, 1, 2, 0, 5]).reshape(6, 1, 1)
    found = replace(MAP, cells=line, counts=counts)
    targets = places([0.5, 0.5, 0.5], [1.5, 0.5, 0.5], [2.5, 0.5, 0.5])
    ranking = base_placement(found, targets, places(*([-k, 0, 0] for k in range(5))))
    # counts of the three cubes from k on
    expected = {0: (2, 1), 1: (2, 1), 2: (2, 1), 3: (2, 2), 4: (1, 5)}
    assert ranking.order.tolist() == [3, 0, 1, 2, 4]
    for number, reached, rarest in zip(ranking.order, ranking.reached, ranking.rarest, strict=True):
        assert expected[number] == (reached, rarest)
