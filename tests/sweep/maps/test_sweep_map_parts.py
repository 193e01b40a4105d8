"""Borders of layers and of maps, shares, and a summary whose numbers all differ."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from poekin.errors import InputError
from poekin.sweep import Cells, Grid, PoseSamples, Random, Sweep, run
from poekin.sweep.execution.totals import Totals
from poekin.sweep.maps.sweep_map import map_of
from poekin.sweep.pose_samples import NumberedPoses
from tests.messages import says
from tests.sweep.arms import two_links

ARM = two_links()
CELLS = Cells((-1.0, 0.0, 2.0), 0.5, (4, 3, 2), 1)
SAMPLES = Grid.of(ARM, [40, 5])
# of the first layer along x three cubes are reached, of the second one; by one to four tiles
COUNTS = np.zeros(CELLS.array_shape, np.int64)
COUNTS[0, 0, 0, :4] = 1
COUNTS[0, 1, 1, 5] = 30
COUNTS[0, 2, 0, :2] = 9
COUNTS[1, 2, 1, 11] = 2
BEST = np.where(COUNTS > 0, 0.1 * COUNTS, np.nan)
MAP = replace(
    map_of(Sweep(ARM, SAMPLES, CELLS, "travel"), Totals(Sweep(ARM, SAMPLES, CELLS, "travel"))),
    counts=COUNTS,
    best=BEST,
    outside=7,
)


def test_its_summary_has_each_number_at_its_place():
    assert MAP.reached_volume == 4 * 0.125
    assert MAP.capability_range == (pytest.approx(2 / 12), pytest.approx(4 / 12))
    assert MAP.capability[0, :, 0] * 12 == pytest.approx([4, 0, 2])
    assert MAP.summary().split("\n") == [
        "200 configurations, 7 of them outside the map",
        "0.5 m³ of 3 m³ reached, in cubes of 500 mm",
        "of 12 directions of the tool 16.7 % in the mean of these cubes, 33.3 % in the best",
        "best joint travel of a cell: 0.1 to 3 rad or m",
        "a further configuration would fall into an empty cell with a chance of 2 %",
    ]
    empty = replace(MAP, counts=0 * COUNTS, best=np.full(COUNTS.shape, np.nan))
    assert empty.capability_range is None
    assert [line.split(" ")[0] for line in empty.summary().split("\n")] == ["200", "0", "a"]


def test_a_summary_of_poses_counts_those_that_are_reached():
    poses = PoseSamples.random([0] * 3, [1] * 3, 80)
    lines = replace(MAP, samples=poses).summary().split("\n")
    # 54 are in cells and 7 outside
    assert lines[0] == "80 poses, 61 of them reached (76.2 %), 7 of these outside the map"
    assert len(lines) == 4


@pytest.mark.parametrize(
    ("axis", "at", "number"),
    [("x", -1.0, 0), ("x", 0.999, 3), ("y", 0.5, 1), ("z", 2.0, 0), ("z", 2.75, 1), ("y", 0.0, 0)],
)
def test_a_layer_begins_at_its_lower_border(axis, at, number):
    along = "xyz".index(axis)
    np.testing.assert_array_equal(MAP.slice(axis, at), np.take(COUNTS, number, along))


@pytest.mark.parametrize(
    ("axis", "at", "ends"),
    [
        ("x", 1.0, "-1 ... 1"),
        ("x", -1.001, "-1 ... 1"),
        ("z", 3.0, "2 ... 3"),
        ("y", 9, "0 ... 1.5"),
    ],
)
def test_beyond_the_last_layer_there_is_none(axis, at, ends):
    with pytest.raises(InputError) as caught:
        MAP.slice(axis, at)
    assert says(caught.value, f"at: expected {axis} within {ends} m, got {at!r}")


def test_outside_there_is_no_sample_though_every_cell_has_some():
    full = replace(MAP, counts=COUNTS + 1)
    T = np.tile(np.eye(4), (3, 1, 1))
    T[:, :3, 3] = [[-1.1, 0.1, 2.1], [0.9, 1.4, 2.9], [1.0, 0.1, 2.1]]
    counts = full.query(T)
    assert counts.tolist() == [0, full.counts[3, 2, 1, CELLS.find(T[1]) % 12], 0]
    assert full.query(T[1]) == 1


class Still(NumberedPoses):
    """One pose for all numbers, which are kept."""

    def __init__(self, count: int) -> None:
        super().__init__(count)
        self.__dict__["asked"] = []

    def describe(self):
        return {"poses": {}}

    def poses(self, numbers):
        rows = np.asarray(numbers)
        self.__dict__["asked"].append((rows[0], len(rows)))
        return np.tile(np.eye(4), (len(rows), 1, 1))


def test_a_share_is_asked_of_65536_poses_at_a_time():
    still = Still(2**16 + 5)
    two = Cells((0.0, -1.0, -1.0), 2.0, (2, 1, 1))
    counts = np.array([1000, 0]).reshape(2, 1, 1)
    share = replace(MAP, cells=two, samples=still, counts=counts).reached_share
    np.testing.assert_array_equal(share.ravel(), [1000 / (2**16 + 5), np.nan])
    assert still.__dict__["asked"] == [(0, 2**16), (2**16, 5)]


@pytest.mark.parametrize("keep", ["best", "worst", "mean"])
def test_cells_that_no_sample_fell_into_have_no_measure_and_no_sample(keep):
    found = run(Sweep(ARM, Random.of(ARM, 40), CELLS, "travel", keep))
    assert found.best is not None
    np.testing.assert_array_equal(np.isnan(found.best), found.counts == 0)
    if found.attained is not None:
        np.testing.assert_array_equal(found.attained == -1, found.counts == 0)
    assert Totals(Sweep(ARM, SAMPLES, CELLS)).best.size == 0


@pytest.mark.parametrize(
    ("what", "place"),
    [
        ("screws", (1, 4)),
        ("home", (0, 3)),
        ("coupling", (1, 0)),
        ("offset", 1),
        ("limits", (0, 1)),
    ],
)
def test_sweeps_of_arms_that_differ_in_one_number_have_other_keys(what, place):
    key = Sweep(ARM, SAMPLES, CELLS).key()
    assert Sweep(two_links(), SAMPLES, CELLS).key() == key
    numbers = getattr(ARM, what).copy()
    numbers[place] -= 2.0**-40
    assert Sweep(ARM.replace(**{what: numbers}), SAMPLES, CELLS).key() != key


def test_so_do_sweeps_of_arms_of_which_one_has_a_limit_of_a_joint_that_the_other_has_not():
    keys = set()
    for upper in (np.inf, 5.0, 6.0):
        arm = ARM.replace(joint_limits=[[-np.inf, np.inf], [-5.0, upper]])
        keys.add(Sweep(arm, SAMPLES, CELLS).key())
    assert len(keys) == 3
