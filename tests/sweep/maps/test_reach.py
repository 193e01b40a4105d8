"""Maps of where a tool can be, against workspaces that are known."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError
from poekin.sweep import PoseSamples, reach
from tests.messages import says
from tests.sweep.arms import measured, two_links

UR5E = pk.load("ur5e").chain(tip="tool0")


def test_two_links_reach_their_annulus_to_a_cube():
    arm = two_links(0.5, 0.3)
    found = pk.sweep.reach(arm, resolution=0.05, samples=400_000, seed=2)
    centres = found.cells.centres()
    radius = np.linalg.norm(centres[..., :2], axis=-1)
    half = 0.5 * 0.05
    layer = np.abs(centres[..., 2]) <= half + 1e-12
    certain = (radius > 0.2 + np.sqrt(2) * half) & (radius < 0.8 - np.sqrt(2) * half) & layer
    possible = (radius >= 0.2 - np.sqrt(2) * half) & (radius <= 0.8 + np.sqrt(2) * half) & layer
    in_plane = np.asarray(found.reached.any(axis=2))
    assert in_plane[certain.any(axis=2)].all()
    assert not found.reached[~possible].any()


def test_a_wrist_reaches_a_sphere():
    axes = [pk.screw.revolute(w, [0, 0, 0]) for w in ([0, 0, 1], [0, 1, 0], [0, 0, 1])]
    home = np.eye(4)
    home[:3, 3] = 0, 0, 0.4
    arm = pk.Chain(np.array(axes), home, frame="space")
    found = pk.sweep.reach(arm, resolution=0.05, samples=200_000, side=1)
    distance = np.linalg.norm(found.cells.centres(), axis=-1)
    half = np.sqrt(3) * 0.5 * 0.05
    assert (np.abs(distance[found.reached] - 0.4) <= half).all()
    inner = np.abs(distance - 0.4) < 0.1 * 0.05
    # the poles of the sphere are where the samples are densest, its equator where they are rarest
    assert found.reached[inner].all()
    assert found.outside == 0


def test_the_map_is_around_all_that_is_reached_and_repeats():
    arm = pk.load("ur5e").chain(tip="tool0")
    one = pk.sweep.reach(arm, resolution=0.1, samples=50_000, side=1, seed=3)
    two = pk.sweep.reach(arm, resolution=0.1, samples=50_000, side=1, seed=3, workers=3, chunk=777)
    assert one.counts.tobytes() == two.counts.tobytes()
    assert one.outside == 0
    other = pk.sweep.reach(arm, resolution=0.1, samples=50_000, side=1, seed=4)
    assert other.about["samples"]["seed"] == 4
    assert not np.array_equal(one.counts, other.counts) or one.counts.shape != other.counts.shape


def test_a_compiled_chain_is_taken_and_measured():
    arm = pk.load("ur5e").chain(tip="tool0").compile()
    found = pk.sweep.reach(arm, resolution=0.2, samples=20_000, measure="manipulability")
    best, _ = measured(found)
    q = found.configurations(np.unravel_index(np.nanargmax(best), best.shape))
    own = float(pk.manipulability(arm.chain, q).pose.yoshikawa)
    assert np.nanmax(best) == pytest.approx(own, rel=1e-9)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"resolution": -1}, "resolution"),
        ({"samples": 0}, "count"),
        ({"side": -1}, "side"),
        ({"measure": "speed"}, "measure"),
        ({"seed": -1}, "seed"),
    ],
)
def test_what_cannot_be_used_is_refused(options, words):
    with pytest.raises(InputError, match=words):
        pk.sweep.reach(two_links(), **options)


def test_what_is_no_arm_is_refused():
    with pytest.raises(InputError, match="expected a Chain"):
        pk.sweep.reach("ur5e")  # type: ignore[arg-type]


def test_poses_are_drawn_in_the_cells_around_what_an_arm_reaches():
    options = {"resolution": 0.3, "by": "poses", "measure": "solutions", "seed": 5}
    found = reach(UR5E, samples=3000, **options)
    again = PoseSamples.random(found.cells.corner, found.cells.upper, 3000, 5)
    assert found.about["samples"] == again.describe()
    assert found.cells == reach(UR5E, samples=100_000, resolution=0.3).cells
    reached = np.count_nonzero(pk.ik_all(UR5E, again.poses(np.arange(3000))).counts)
    assert (found.counts.sum(), found.outside, found.masked) == (reached, 0, 3000 - reached)
    cubes = found.reached_volume
    whole = found.cells.count * 0.3**3
    assert found.summary().split("\n") == [
        f"3000 poses, {reached} of them reached ({reached / 30:.3g} %), 0 of these outside the map",
        f"{cubes:.4g} m³ of {whole:.4g} m³ reached, in cubes of 300 mm",
        "best number of IK solutions of a cell: 2 to 8",
    ]


def test_middles_of_cells_are_tried_with_each_turn():
    found = reach(UR5E, resolution=0.4, by="middles", turns=3, side=1)
    T = found.cells.poses(3)
    counts = pk.ik_all(UR5E, T).counts
    np.testing.assert_array_equal(found.counts, (counts > 0).sum(axis=-1))


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"by": "joints"}, "by: expected 'configurations', 'poses' or 'middles', got 'joints'"),
        ({"by": "poses", "turns": 2}, "turns: expected 1 unless by is 'middles', got 2"),
        ({"by": "middles", "turns": 0}, "turns: expected a whole number from 1 on, got 0"),
    ],
)
def test_samples_that_there_are_not_are_refused(options, words):
    with pytest.raises(InputError) as caught:
        reach(UR5E, resolution=0.5, **options)
    assert says(caught.value, words)
