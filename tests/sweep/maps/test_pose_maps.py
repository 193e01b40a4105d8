"""What a map of poses says of them, and the best of all."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError
from poekin.sweep import Cells, PoseSamples, Random, Sweep, load_map, run
from tests.messages import says
from tests.sweep.arms import measured

ARM = pk.load("ur5e").chain(tip="tool0")
CELLS = Cells.box([-1.2] * 3, [1.2] * 3, 0.6)
POSES = PoseSamples.random([-1.1] * 3, [1.1] * 3, 3000, seed=2)
T = POSES.poses(np.arange(3000))
EVERY = pk.ik_all(ARM, T)
BESTS = pk.manipulability(ARM, EVERY.q).pose.yoshikawa
# by pose, the best of its solutions
BEST = np.full(3000, -np.inf)
np.maximum.at(BEST, EVERY.target_number, BESTS)
MAP = run(Sweep(ARM, POSES, CELLS, "manipulability"))


def test_the_best_pose_of_a_cell_has_the_best_solution_there():
    best, attained = measured(MAP)
    cell = CELLS.find(T)
    q = MAP.configurations()
    poses = MAP.poses()
    for number, index in enumerate(np.ndindex(*CELLS.shape)):
        if not MAP.counts[index]:
            assert np.isnan(q[index]).all()
            assert np.isnan(poses[index]).all()
            continue
        # the root of a determinant that is right to some 1e-13
        assert best[index] == pytest.approx(BEST[cell == number].max(), abs=1e-6)
        assert poses[index].tolist() == T[attained[index]].tolist()
        own = pk.manipulability(ARM, q[index]).pose.yoshikawa
        assert own == pytest.approx(best[index], abs=1e-6)
        np.testing.assert_allclose(ARM.fk(q[index]), poses[index], atol=1e-9)
    assert 0 < np.count_nonzero(MAP.counts) < CELLS.count


def test_a_share_is_of_the_poses_that_were_tried_in_the_cell(monkeypatch):
    tried = np.bincount(CELLS.find(T), minlength=CELLS.count).reshape(CELLS.shape)
    monkeypatch.setattr("poekin.sweep.maps.sweep_map._AT_ONCE", 700)
    np.testing.assert_allclose(MAP.reached_share, MAP.counts / tried, rtol=1e-15)
    beside = Cells.box([0.9, 0, 0], [1.5, 0.6, 0.6], 0.3)
    found = run(Sweep(ARM, POSES, beside))
    assert np.isnan(found.reached_share[1]).all()
    assert (found.reached_share[0] < 1).all()
    assert found.outside + found.counts.sum() == np.count_nonzero(EVERY.counts)


def test_the_best_poses_of_all_come_with_their_solutions():
    found = pk.sweep.top(ARM, "manipulability", 5, samples=POSES)
    np.testing.assert_allclose(found.values, np.sort(BEST)[::-1][:5], atol=1e-6)
    assert found.T is not None
    np.testing.assert_array_equal(found.T, T[found.numbers])
    np.testing.assert_allclose(ARM.fk(found.q), found.T, atol=1e-9)
    assert found.summary().startswith("5 best of 3000 poses: manipulability ")
    assert pk.sweep.top(ARM, "manipulability", samples=100).T is None


def test_the_best_solutions_under_a_mask_are_those_in_which_the_arm_does_not_touch_itself():
    spheres = [("wrist_3_link", (0, 0, 0.1), 0.2), ("upper_arm_link", (-0.2, 0, 0.14), 0.08)]
    mask = pk.sweep.SelfCollision.of_spheres(pk.load("ur5e"), ARM, spheres)
    masked = run(Sweep(ARM, POSES, CELLS, "manipulability", keep="worst", mask=mask))
    plain = run(Sweep(ARM, POSES, CELLS, "manipulability", keep="worst"))
    touching = []
    for found in (masked, plain):
        q = found.configurations(found.counts > 0)
        touching.append(np.count_nonzero(mask.touches(ARM, q)))
        own = pk.manipulability(ARM, q).pose.yoshikawa
        best, _ = measured(found)
        np.testing.assert_allclose(own, best[found.counts > 0], atol=1e-6)
    assert touching[0] == 0 < touching[1]
    least = [
        pk.sweep.top(ARM, "manipulability", 20, keep="worst", samples=POSES, mask=one)
        for one in (mask, None)
    ]
    assert [mask.touches(ARM, found.q).any() for found in least] == [False, True]


def test_poses_are_counted_by_the_measure_of_their_best_solution():
    found = pk.sweep.histogram(ARM, "solutions", bins=8, ends=(0.5, 8.5), samples=POSES)
    expected = np.bincount(EVERY.counts, minlength=9)[1:]
    np.testing.assert_array_equal(found.counts, expected)
    reached = np.count_nonzero(EVERY.counts)
    first = f"{reached} reached poses, 0 more outside of the bins"
    assert found.summary().split("\n")[0] == first
    tried = pk.sweep.histogram(ARM, "solutions", samples=POSES)
    assert tried.edges[0] == EVERY.counts[EVERY.counts > 0].min()
    assert tried.edges[-1] == pytest.approx(8 + 6e-3)


def test_a_map_of_poses_comes_back_from_a_file_without_its_arm(tmp_path):
    MAP.save(tmp_path / "map.npz")
    read = load_map(tmp_path / "map.npz")
    assert read.to_dict() == MAP.to_dict()
    np.testing.assert_array_equal(read.poses(), MAP.poses())
    np.testing.assert_array_equal(read.reached_share, MAP.reached_share)
    assert (read.chain, MAP.chain) == (None, ARM)
    with pytest.raises(InputError) as caught:
        read.configurations()
    assert says(
        caught.value,
        "configurations: a map of poses out of a file does not know its arm; ik_all of `poses` does",
    )


FAR = PoseSamples.random([5] * 3, [6] * 3, 10)
JOINTS = run(Sweep(ARM, Random.of(ARM, 10), CELLS, "manipulability"))


@pytest.mark.parametrize(
    ("ask", "words"),
    [
        (
            lambda: JOINTS.reached_share,
            "reached_share: expected a map of poses, this is of configurations",
        ),
        (JOINTS.poses, "poses: expected a map of poses, this is of configurations"),
        (
            run(Sweep(ARM, FAR, CELLS)).poses,
            "poses: the sweep only counts (measure='reach'), or keeps means",
        ),
        (
            lambda: pk.sweep.top(ARM, "travel", samples=FAR),
            "top: no sample has a measure, or all are left out or not reached",
        ),
    ],
)
def test_what_a_map_does_not_hold_is_refused(ask, words):
    with pytest.raises(InputError) as caught:
        ask()
    assert says(caught.value, words)
