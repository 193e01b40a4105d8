"""The scene of a map: a point in each cube that was reached, with its value."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError
from poekin.sweep import Cells, Random, Sweep, load_map, run
from poekin.view.nodes import Cloud
from poekin.view.scenes.sweep_map import sweep_map_scene

ROBOT = pk.load("ur5e")
ARM = ROBOT.chain(tip="tool0")
CELLS = Cells.box([-1.1] * 3, [1.1] * 3, 0.2, side=1)
SAMPLES = Random.of(ARM, 5000)


def cloud(scene):
    (node,) = [node for node in scene.nodes if isinstance(node, Cloud)]
    return node


@pytest.mark.parametrize(
    ("measure", "side", "words"),
    [
        ("reach", 1, "share of directions"),
        ("reach", 0, "number of samples"),
        ("manipulability", 1, "best manipulability"),
        ("manipulability", 0, "best manipulability"),
    ],
)
def test_a_point_in_each_cube_has_the_value_that_the_words_say(measure, side, words):
    cells = Cells(CELLS.corner, CELLS.resolution, CELLS.shape, side)
    found = run(Sweep(ARM, SAMPLES, cells, measure))
    scene = sweep_map_scene(found)
    node = cloud(scene)
    np.testing.assert_array_equal(node.points, cells.centres()[found.reached])
    if found.best is not None:
        every = np.fmax.reduce(found.best.reshape(*cells.shape, -1), axis=-1)
    else:
        every = found.capability if side else found.counts
    np.testing.assert_array_equal(node.values, every[found.reached])
    assert node.size == pytest.approx(0.2 * 0.2, rel=1e-15)  # a fifth of a cube's side
    assert node.attachment.name == f"cubes that tool0 reaches, by {words}"
    assert scene.title == "What tool0 reaches"
    assert list(scene.words[: len(found.summary().split("\n"))]) == found.summary().split("\n")
    assert f"Blue to orange: {words}, 0 to {every[found.reached].max():.4g}." in scene.words
    assert "cloud" in scene.shown


@pytest.mark.parametrize("keep", ["best", "worst", "mean"])
@pytest.mark.parametrize("name", ["travel", "limit_margin"])
def test_a_cube_has_the_colour_of_what_is_kept_of_all_its_directions(name, keep):
    flat = Cells(CELLS.corner, CELLS.resolution, CELLS.shape)
    expected = run(Sweep(ARM, SAMPLES, flat, name, keep))
    scene = sweep_map_scene(run(Sweep(ARM, SAMPLES, CELLS, name, keep)))
    # of means in units of 2^-40, and divided
    values = np.asarray(cloud(scene).values)
    np.testing.assert_allclose(
        values, np.asarray(expected.best)[expected.reached], rtol=1e-13, atol=1e-12
    )
    words = {"travel": "joint travel", "limit_margin": "distance to the joint limits"}[name]
    unit = {"travel": " rad or m.", "limit_margin": " % of half the range."}[name]
    (said,) = [line for line in scene.words if line.startswith("Blue")]
    assert said.startswith(f"Blue to orange: {keep} {words}, 0 to ")
    assert said.endswith(unit)


def test_a_map_out_of_a_file_is_drawn_in_the_robot_that_is_named(tmp_path):
    found = run(Sweep(ARM, SAMPLES, CELLS))
    found.save(tmp_path / "map.npz")
    read = load_map(tmp_path / "map.npz")
    with pytest.raises(InputError, match="does not know its arm; robot= names it"):
        pk.view(read)
    scene = sweep_map_scene(read, ROBOT)
    np.testing.assert_array_equal(cloud(scene).points, cloud(sweep_map_scene(found)).points)
    assert pk.view(found, robot=ROBOT) is not None


@pytest.mark.parametrize("keep", ["best", "worst", "mean"])
def test_the_words_say_the_largest_value_of_the_points_that_are_drawn(keep):
    scene = sweep_map_scene(run(Sweep(ARM, SAMPLES, CELLS, "travel", keep)))
    largest = np.asarray(cloud(scene).values).max()
    assert f"Blue to orange: {keep} joint travel, 0 to {largest:.4g} rad or m." in scene.words


def test_a_map_of_a_part_out_of_a_file_hangs_on_the_link_where_the_part_begins(tmp_path):
    part = ROBOT.chain(base="upper_arm_link", tip="tool0")
    run(Sweep(part, Random.of(part, 100), CELLS)).save(tmp_path / "map.npz")
    node = cloud(sweep_map_scene(load_map(tmp_path / "map.npz"), ROBOT))
    assert node.attachment.link == ROBOT.links.index("upper_arm_link")


def test_a_map_of_nothing_is_refused():
    far = Cells((5.0, 5.0, 5.0), 0.1, (2, 2, 2))
    with pytest.raises(InputError, match="no cube of the map was reached"):
        pk.view(run(Sweep(ARM, SAMPLES, far)))
