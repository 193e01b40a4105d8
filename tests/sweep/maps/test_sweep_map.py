"""What a map answers."""

from __future__ import annotations

from dataclasses import FrozenInstanceError, replace

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError, UnknownName
from poekin.sweep import Cells, Grid, Random, Sweep, run
from poekin.sweep.bins import TopList
from poekin.sweep.maps.sweep_map import map_of
from tests.findings import dataclasses_of, frozen_and_equal_only_where_its_parts_can_be
from tests.sweep.arms import measured, two_links

ARM = two_links()
CELLS = Cells.box([-1] * 3, [1] * 3, 0.1, side=1)
SAMPLES = Random.of(ARM, 5000, seed=1)
MEASURED = run(Sweep(ARM, SAMPLES, CELLS, "manipulability"))
COUNTED = run(Sweep(ARM, Grid.of(ARM, 50), Cells.box([-1] * 3, [1] * 3, 0.1)))


def test_a_pose_that_was_sampled_is_found_and_one_out_of_reach_not():
    q = SAMPLES.configurations([17])[0]
    assert MEASURED.query(ARM.fk(q)) >= 1
    far = np.eye(4)
    far[0, 3] = 0.95
    outside = np.eye(4)
    outside[0, 3] = 5.0
    assert MEASURED.query([far, outside]).tolist() == [0, 0]


def test_every_cell_answers_for_its_centre():
    counts = np.arange(1, COUNTED.cells.count + 1).reshape(COUNTED.counts.shape)
    found = replace(COUNTED, counts=counts)
    T = np.tile(np.eye(4), (*counts.shape, 1, 1))
    T[..., :3, 3] = COUNTED.cells.centres()
    np.testing.assert_array_equal(found.query(T), counts)


def test_a_layer_is_that_of_the_place():
    np.testing.assert_array_equal(MEASURED.slice("z", 0.05), MEASURED.counts[:, :, 10])
    np.testing.assert_array_equal(MEASURED.slice("x", -0.95), MEASURED.counts[0])
    assert COUNTED.slice("y", 0.31).shape == (20, 20)
    with pytest.raises(UnknownName, match=r"^axis: expected 'x', 'y' or 'z', got 'w'$"):
        MEASURED.slice("w", 0.0)
    with pytest.raises(InputError, match=r"^at: expected y within -1 \.\.\. 1 m, got 1\.5$"):
        MEASURED.slice("y", 1.5)
    for at in (np.nan, np.inf, "a", None):
        with pytest.raises(InputError, match=r"^at: expected y within -1 \.\.\. 1 m, got "):
            MEASURED.slice("y", at)  # pyright: ignore[reportArgumentType]
    layer = MEASURED.slice("y", np.nextafter(1.0, 0.0))
    np.testing.assert_array_equal(layer, MEASURED.counts[:, -1])


def test_configurations_with_the_best_measure_lie_in_their_cells():
    filled = np.argwhere(MEASURED.counts > 0)
    q = MEASURED.configurations()
    assert q.shape == (*MEASURED.counts.shape, 2)
    assert np.isnan(q[MEASURED.counts == 0]).all()
    own = q[MEASURED.counts > 0]
    index = np.ravel_multi_index(filled.T, MEASURED.counts.shape)
    np.testing.assert_array_equal(CELLS.find(ARM.fk(own)), index)
    one = tuple(filled[0])
    np.testing.assert_array_equal(MEASURED.configurations(one), own[0])
    with pytest.raises(InputError, match="only counts"):
        COUNTED.configurations()


def test_capability_is_the_share_of_directions():
    # the tool's axis never turns: one of twelve directions
    assert set(np.unique(MEASURED.capability)) == {0.0, 1 / 12}
    assert MEASURED.capability_range == (pytest.approx(1 / 12), pytest.approx(1 / 12))
    assert COUNTED.capability_range is None
    with pytest.raises(InputError, match=r"^capability: the sweep has no directions \(side=0\)$"):
        _ = COUNTED.capability


def test_the_summary_says_volume_directions_and_measure():
    lines = MEASURED.summary().split("\n")
    assert lines[0] == "5000 configurations, 0 of them outside the map"
    volume = np.count_nonzero(MEASURED.reached) * 1e-3
    assert lines[1] == f"{volume:.4g} m³ of 8 m³ reached, in cubes of 100 mm"
    assert lines[2] == (
        "of 12 directions of the tool 8.33 % in the mean of these cubes, 8.33 % in the best"
    )
    best = measured(MEASURED)[0]
    ends = f"{np.nanmin(best):.4g} to {np.nanmax(best):.4g}"
    assert lines[3] == f"best manipulability of a cell: {ends}"
    once = np.count_nonzero(MEASURED.counts == 1) / 5000
    assert (
        lines[4]
        == f"a further configuration would fall into an empty cell with a chance of {100 * once:.2g} %"
    )
    assert len(COUNTED.summary().split("\n")) == 3
    assert MEASURED.to_dict()["reached_volume"] == pytest.approx(volume)
    assert 0 < once < 0.1


def test_a_map_shows_itself_in_a_notebook():
    assert "reached" in MEASURED._repr_html_()
    assert pk.sweep.SweepMap is type(MEASURED)


def test_a_sweep_is_frozen_and_not_compared_number_by_number():
    sweep = Sweep(ARM, MEASURED.samples, CELLS)
    with pytest.raises(FrozenInstanceError):
        sweep.keep = "worst"  # type: ignore[misc]
    assert sweep != Sweep(ARM, MEASURED.samples, CELLS)


def test_of_other_than_cells_there_is_no_map():
    sweep = Sweep(ARM, MEASURED.samples, TopList(3), "manipulability")
    with pytest.raises(InputError, match=r"^map: expected a sweep of Cells, got TopList$"):
        map_of(sweep, None)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "kind",
    [*dataclasses_of("poekin.sweep.maps", "sweep_map"), *dataclasses_of("poekin.sweep", "bins")],
)
def test_a_map_is_frozen_and_equal_only_where_its_parts_can_be(kind):
    assert frozen_and_equal_only_where_its_parts_can_be(kind)


def test_samples_that_are_in_no_cell_and_not_outside_were_left_out_by_the_mask():
    inside = int(COUNTED.counts.sum())
    for outside in (0, 1, 3):
        left = replace(COUNTED, outside=outside).masked
        assert left == COUNTED.samples.count - inside - outside
