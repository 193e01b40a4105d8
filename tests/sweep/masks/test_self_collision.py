"""Samples in which an arm touches itself are left out, those of Pinocchio's and coal's distances among
them, and the same ones however a sweep is run.
"""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.errors import FileError, InputError, ShapeError, UnknownName
from poekin.sweep import Cells, Random, SelfCollision, Sweep, histogram, run, top
from tests.sweep.arms import bits, two_links
from tests.sweep.masks.arm_of_all_shapes import SHAPES, robot_in, urdf

CELLS = Cells.box([-2.0] * 3, [2.0] * 3, 0.5)
COUNT = 1000


@pytest.fixture(scope="module")
def mask(robot, arm):
    return SelfCollision.of_robot(robot, arm)


def samples(arm):
    drawn = Random.of(arm, COUNT, 3)
    return drawn, drawn.configurations(np.arange(COUNT))


def closest(robot, q, pairs):
    """Least distance (N, pairs) of the collision geometry of pairs of links, by Pinocchio and coal."""
    pin = pytest.importorskip("pinocchio", reason="the package pin is not installed")
    path = str(robot.source)
    folder = path.rpartition("/")[0]
    model = pin.buildModelFromUrdf(path)
    text = urdf().replace("part.stl", f"{folder}/part.stl")
    shapes = pin.buildGeomFromUrdfString(model, text, pin.GeometryType.COLLISION)
    order = [model.frames[shape.parentFrame].name for shape in shapes.geometryObjects]
    for a, b in pairs:
        shapes.addCollisionPair(pin.CollisionPair(order.index(a), order.index(b)))
    data = model.createData()
    found = pin.GeometryData(shapes)
    distances = np.empty((len(q), len(pairs)))
    for row, x in zip(distances, q, strict=True):
        pin.updateGeometryPlacements(model, data, shapes, found, x)
        pin.computeDistances(shapes, found)
        row[:] = [result.min_distance for result in found.distanceResults]
    return distances


def test_every_collision_of_the_geometry_is_left_out_and_nothing_that_is_far(robot, arm, mask):
    _, q = samples(arm)
    left = mask.touches(arm, q)
    away = closest(robot, q, mask.pairs).min(axis=1)
    assert 20 < np.count_nonzero(away <= 0) < np.count_nonzero(left) < COUNT / 2
    assert left[away <= 0].all()
    # two spheres that touch stand out of their links by the excess at most, and by what is between
    # its 48 points: a quarter of a radius, below 0.1 m
    assert away[left].max() <= 2 * (mask.excess + 0.025)
    assert 0 < mask.excess <= 0.021


@pytest.mark.parametrize("measure", ["reach", "manipulability", "inverse_condition", "travel"])
def test_a_sweep_counts_the_samples_that_do_not_touch(arm, mask, measure):
    drawn, q = samples(arm)
    left = mask.touches(arm, q)
    found = run(Sweep(arm, drawn, CELLS, measure, mask=mask), chunk=333, workers=2)
    free = CELLS.find(arm.fk(q))[~left]
    counts = np.bincount(free, minlength=CELLS.count)
    np.testing.assert_array_equal(found.counts.reshape(-1), counts)
    assert (found.masked, found.outside) == (left.sum(), 0)
    assert f"outside the map, {left.sum()} left out as the arm touches itself" in found.summary()
    if found.attained is not None:
        assert not left[found.attained[found.attained >= 0]].any()


def test_any_chunk_threads_and_a_mask_that_leaves_all_give_the_same_bytes(robot, arm, mask):
    drawn, _ = samples(arm)
    whole = bits(run(Sweep(arm, drawn, CELLS, "manipulability", mask=mask), workers=1))
    for chunk in (1, 63, 500):
        again = run(Sweep(arm, drawn, CELLS, "manipulability", mask=mask), chunk=chunk, workers=3)
        assert bits(again) == whole
    nothing = SelfCollision.of_spheres(
        robot, arm, [("base", [9, 9, 9], 0.1), ("hand", [0] * 3, 0.1)]
    )
    same = run(Sweep(arm, drawn, CELLS, "manipulability", mask=nothing))
    assert bits(same) == bits(run(Sweep(arm, drawn, CELLS, "manipulability")))
    assert same.masked == 0


def test_the_best_and_the_histogram_are_of_what_is_left(arm, mask):
    drawn, q = samples(arm)
    free = np.flatnonzero(~mask.touches(arm, q))
    best = top(arm, "travel", COUNT, samples=drawn, mask=mask)
    assert sorted(best.numbers) == free.tolist()
    found = histogram(arm, "travel", samples=drawn, mask=mask, ends=(0, 9))
    assert (found.counts.sum(), found.outside) == (len(free), 0)


def test_spheres_that_are_given_touch_as_far_apart_as_their_radii(robot, arm):
    given = [("base", [0, 0, 0.3], 0.2), ("hand", [0, 0, 0.05], 0.1), ("lower", [9, 9, 0], 0.1)]
    mask = SelfCollision.of_spheres(robot, arm, given)
    _, q = samples(arm)
    T = arm.fk(q)
    p = T[:, :3, :3] @ [0, 0, 0.05] + T[:, :3, 3]
    apart = np.linalg.norm(p - [0, 0, 0.3], axis=1)
    np.testing.assert_array_equal(mask.touches(arm, q), apart <= 0.3)
    # whatever the order of a robot's links
    backwards = pk.Robot(robot.name, robot.links[::-1], robot.joints)
    same = SelfCollision.of_spheres(backwards, arm, given)
    assert same.pairs == tuple(pair[::-1] for pair in mask.pairs[::-1])
    np.testing.assert_array_equal(same.touches(arm, q), apart <= 0.3)
    assert mask.pairs == (("base", "lower"), ("base", "hand"), ("lower", "hand"))
    assert mask.touches(arm, q[0]).shape == ()
    assert mask.touches(arm, q[:6].reshape(2, 3, 3)).shape == (2, 3)
    assert mask.summary() == (
        "3 spheres on 3 links, 3 pairs of links\nleft out, adjacent: none\n"
        "left out, always touching: none"
    )


def test_adjacent_links_and_those_that_always_touch_are_left_out_and_named(robot, arm, mask):
    assert mask.adjacent == (("base", "upper"), ("upper", "lower"))
    assert mask.pairs == (("base", "lower"), ("base", "hand"), ("upper", "hand"), ("lower", "hand"))
    assert mask.summary().startswith(
        f"{len(mask.spheres)} spheres on 4 links, 4 pairs of links; they stand out of the geometry "
        f"by up to {1e3 * mask.excess:.3g} mm\nleft out, adjacent: base - upper, upper - lower\n"
    )
    large = [("base", [0, 0, 0], 3.0), ("hand", [0, 0, 0], 0.1), ("lower", [9, 0, 0], 0.1)]
    found = SelfCollision.of_spheres(robot, arm, large)
    assert found.always == (("base", "hand"),)
    assert found.summary().endswith("left out, always touching: base - hand")


def test_a_mask_is_part_of_what_a_sweep_is(robot, arm, mask):
    drawn, _ = samples(arm)
    plain = Sweep(arm, drawn, CELLS)
    assert "mask" not in plain.describe()
    masked = Sweep(arm, drawn, CELLS, mask=mask)
    other = [*mask.spheres[:-1], mask.spheres[-1]._replace(radius=0.061)]
    changed = Sweep(arm, drawn, CELLS, mask=SelfCollision.of_spheres(robot, arm, other))
    assert len({sweep.key() for sweep in (plain, masked, changed)}) == 3
    assert mask.describe()["spheres"] == len(mask.spheres)


@pytest.mark.parametrize(
    ("spheres", "kind", "words"),
    [
        ([("elbow", [0] * 3, 1)], UnknownName, r"spheres\[0\]: there is no link 'elbow'"),
        (
            [("hand", [0] * 3, -1)],
            InputError,
            r"spheres\[0\]: radius: expected a positive number, got -1",
        ),
        ([("hand", [0] * 2, 1)], ShapeError, r"spheres\[0\]: expected three finite numbers, m"),
        ([("hand", [0, 0, np.nan], 1)], ShapeError, "finite numbers"),
        (
            [("hand", 1)],
            InputError,
            r"spheres\[0\]: expected \(link, centre, radius\), got \('hand', 1\)",
        ),
        ([("hand", [0] * 3, 1)], InputError, "of the links with spheres, 'hand', no two can come"),
        ([], InputError, "with spheres, none, no two"),
    ],
)
def test_spheres_that_cannot_be_used_are_refused(robot, arm, spheres, kind, words):
    with pytest.raises(kind, match=words):
        SelfCollision.of_spheres(robot, arm, spheres)


def test_another_arm_and_geometry_that_is_missing_are_refused(robot, arm, mask, tmp_path):
    other = two_links()
    with pytest.raises(InputError) as caught:
        Sweep(other, Random.of(other, 5), CELLS, mask=mask)
    assert str(caught.value) == (
        f"mask: it is of an arm with the joints 'j1', 'j2', 'j3', not of {other!r}"
    )
    with pytest.raises(InputError, match="no chain of Robot"):
        SelfCollision.of_spheres(robot, other, [])
    with pytest.raises(InputError, match="no chain of Robot"):
        SelfCollision.of_robot(robot, arm.replace(joint_names=["a", "b", "c"]))
    bare = pk.load("puma560")
    with pytest.raises(InputError, match="has no <collision> geometry of a URDF; give spheres"):
        SelfCollision.of_robot(bare, bare.chain())
    with pytest.raises(InputError, match="tolerance: expected a positive number"):
        SelfCollision.of_robot(robot, arm, 0.0)
    lost = robot_in(tmp_path, urdf(SHAPES | {"lower": '<mesh filename="lost.stl"/>'}))
    with pytest.raises(
        FileError, match=r"self-collision: .*r\.urdf.*'lost.stl': there is no such file"
    ):
        SelfCollision.of_robot(lost, lost.chain(tip="hand"))
    lost = robot_in(tmp_path, urdf(SHAPES | {"lower": f'<mesh filename="{"m" * 197}.stl"/>'}))
    with pytest.raises(FileError, match=r"'m{197}\.s…': there is no such file"):
        SelfCollision.of_robot(lost, lost.chain(tip="hand"))
    wrong = robot_in(tmp_path, urdf(SHAPES | {"lower": '<sphere radius="-1"/>'}))
    with pytest.raises(
        InputError,
        match=r"self-collision: .*r\.urdf:1: link 'lower': <collision>: .*expected positive lengths",
    ):
        SelfCollision.of_robot(wrong, wrong.chain(tip="hand"))
