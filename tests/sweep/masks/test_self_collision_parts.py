"""Which pairs of links are looked at, in how many configurations at a time, and what tells masks apart."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError
from poekin.sweep import SelfCollision
from tests.messages import says
from tests.sweep.arms import two_links

BASE, HAND = ("base", [0.0, 0.0, 0.3], 0.1), ("hand", [0.0, 0.0, 0.05], 0.1)
FAR = ("lower", [9.0, 9.0, 0.0], 0.1)


def apart(arm, q):
    """Distances of the two spheres' centres, m."""
    T = arm.fk(q)
    return np.linalg.norm(T[:, :3, :3] @ HAND[1] + T[:, :3, 3] - BASE[1], axis=1)


def test_a_pair_touches_always_from_950_of_1000_random_configurations_on(robot, arm):
    distances = np.sort(apart(arm, arm.random(0, 1000)))
    for touching, is_always in ((949, False), (950, True)):
        radius = distances[touching - 1 : touching + 1].mean() - BASE[2]
        mask = SelfCollision.of_spheres(robot, arm, [BASE, FAR, (*HAND[:2], radius)])
        assert mask.always == ((("base", "hand"),) if is_always else ())
        assert (("base", "hand") in mask.pairs) != is_always
        assert mask.excess == 0


def test_any_number_of_configurations_is_asked_at_once(robot, arm):
    mask = SelfCollision.of_spheres(robot, arm, [BASE, FAR, HAND])
    q = arm.random(5, 2100)
    found = mask.touches(arm, q)
    np.testing.assert_array_equal(found, apart(arm, q) <= 0.2)
    assert found[:1024].any()
    assert found[1024:2048].any()
    assert found[2048:].any()
    assert mask.touches(arm, q[:0]).shape == (0,)


def test_pairs_come_as_the_places_of_their_spheres_and_radii_with_those_around_before(robot, arm):
    given = [BASE, HAND, FAR, ("hand", [0.3, 0, 0], 0.02), ("lower", [8.0, 9.0, 0.0], 0.2)]
    mask = SelfCollision.of_spheres(robot, arm, given)
    pairs, radii = mask.numbers()
    # of base two, of lower and hand three each: the sphere around, the others, and the end
    base, lower, hand = [0, 1, 2], [2, 3, 5], [5, 6, 8]
    assert mask.pairs == (("base", "lower"), ("base", "hand"), ("lower", "hand"))
    assert pairs.reshape(3, 6).tolist() == [base + lower, base + hand, lower + hand]
    own = [0.1, 0.1, 0.2, 0.1, 0.02]
    assert radii[[1, 3, 4, 6, 7]].tolist() == own
    assert (radii[[0, 2, 5]] > [0.1, 0.2, 0.1]).all()


def test_masks_are_known_by_their_spheres_pairs_and_joints(robot, arm):
    def of(*spheres):
        return SelfCollision.of_spheres(robot, arm, spheres).describe()

    one = of(BASE, FAR, HAND)
    others = [
        of(BASE, FAR, ("hand", [0.0, 0.0, 0.05], 0.11)),
        of(BASE, FAR, ("hand", [0.0, 0.0, 0.06], 0.1)),
        of(BASE, FAR, ("wrist", [0.0, 0.0, 0.05], 0.1)),
        of(BASE, HAND),
    ]
    assert of(BASE, FAR, HAND) == one
    assert len({x["sha256"] for x in (one, *others)}) == 5
    assert (one["spheres"], one["pairs"], one["excess"]) == (3, 3, 0.0)
    assert len(str(one["sha256"])) == 64


def test_another_arm_is_refused_with_its_joints(robot, arm):
    mask = SelfCollision.of_spheres(robot, arm, [BASE, HAND])
    other = two_links()
    with pytest.raises(InputError) as caught:
        mask.touches(other, [0, 0])
    assert says(
        caught.value,
        f"mask: it is of an arm with the joints 'j1', 'j2', 'j3', not of {other!r}",
    )
    with pytest.raises(InputError) as caught:
        SelfCollision.of_spheres(robot, other, [BASE])
    assert says(
        caught.value, f"self-collision: {other!r} is no chain of {robot!r}: other links or joints"
    )
    with pytest.raises(InputError) as caught:
        SelfCollision.of_spheres(robot, arm, [BASE, ("upper", [0] * 3, 1)])
    assert says(
        caught.value,
        "self-collision: of the links with spheres, 'base', 'upper', no two can come to touch: "
        "they are rigidly joined, adjacent, or touch always",
    )


def test_geometry_that_there_is_not_is_asked_for():
    bare = pk.load("puma560")
    with pytest.raises(InputError) as caught:
        SelfCollision.of_robot(bare, bare.chain())
    words = f"self-collision: {bare!r} has no <collision> geometry of a URDF; give spheres"
    assert says(caught.value, words)
