"""Spheres on links come in the base frame, a sphere that holds those of its link before them."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError, ShapeError, UnknownName
from poekin.sweep.masks.spheres import moved_links
from poekin.sweep.masks.touching import touching
from tests.messages import says

GIVEN = [
    ("hand", [0.1, 0.0, 0.02], 0.03),
    ("base", [0.0, 0.0, 0.1], 0.1),
    ("hand", [-0.2, 0.1, 0.0], 0.06),
    ("hand", [0.0, 0.05, -0.1], 0.01),
    ("upper", [0.25, 0.0, 0.25], 0.15),
    ("base", [0.3, -0.1, 0.2], 0.12),
]


@pytest.fixture(scope="module")
def links(robot, arm):
    return moved_links(robot, arm, GIVEN)


def test_links_come_in_the_robot_s_order_behind_the_joints_that_move_them(links):
    assert [(link.name, link.joints) for link in links] == [("base", 0), ("upper", 1), ("hand", 3)]
    for link in links:
        own = [(centre, radius) for name, centre, radius in GIVEN if name == link.name]
        assert [(list(one.centre), one.radius) for one in link.spheres] == own


def test_a_sphere_is_where_its_link_is_and_the_first_one_is_around_the_box_of_the_others(
    robot, links
):
    poses = robot.fk(dict.fromkeys(robot.q_names, 0.0))
    for link in links:
        T = poses[link.name]
        centres = np.array([T[:3, :3] @ one.centre + T[:3, 3] for one in link.spheres])
        radii = np.array([one.radius for one in link.spheres])
        # a few roundings of numbers below 1
        np.testing.assert_allclose(link.centres[1:], centres, rtol=0, atol=1e-15)
        assert list(link.radii[1:]) == radii.tolist()
        ends = [centres - radii[:, None], centres + radii[:, None]]
        middle = (ends[0].min(axis=0) + ends[1].max(axis=0)) / 2
        np.testing.assert_allclose(link.centres[0], middle, rtol=0, atol=1e-15)
        farthest = (np.linalg.norm(centres - middle, axis=1) + radii).max()
        # a part in 10^9 larger, which is no rounding of it
        assert link.radii[0] == pytest.approx(farthest * (1 + 1e-9), rel=1e-13)


def test_two_links_touch_where_any_two_of_their_spheres_do(robot, arm, links):
    q = arm.random(2, 600)
    pairs = [(0, 2), (2, 1), (0, 1)]
    found = touching(arm, q, links, pairs)
    for row, x in zip(found, q, strict=True):
        poses = robot.fk(dict(zip(arm.q_names, x, strict=True)))
        places = {
            link.name: [(poses[link.name] @ [*one.centre, 1])[:3] for one in link.spheres]
            for link in links
        }
        for answer, (i, j) in zip(row, pairs, strict=True):
            gaps = [
                np.linalg.norm(a - b) - one.radius - other.radius
                for a, one in zip(places[links[i].name], links[i].spheres, strict=True)
                for b, other in zip(places[links[j].name], links[j].spheres, strict=True)
            ]
            assert answer == (min(gaps) <= 0)
            assert abs(min(gaps)) > 1e-12  # none so near that rounding decides
    assert (found.sum(axis=0) > 5).all()
    assert not found.all(axis=0).any()


def test_spheres_that_just_touch_touch(robot, arm, links):
    base = links[0]
    at = [(0.0, 0.0, 0.0), (0.0, 0.0, 0.0)]
    still = [
        base._replace(centres=at, radii=(9.0, 2.0)),
        base._replace(centres=[(3.0, 4.0, 0.0)] * 2, radii=(9.0, 3.0)),
        base._replace(centres=[(3.0, 4.0, 0.0)] * 2, radii=(9.0, 2.9999)),
    ]
    assert touching(arm, np.zeros((1, 3)), still, [(0, 1), (0, 2)]).tolist() == [[True, False]]


def test_every_sphere_of_a_long_link_touches_what_is_there(arm, links):
    along = [(0.0, 0.0, 0.0), (10.0, 0.0, 0.0), (20.0, 0.0, 0.0)]
    long = links[0]._replace(centres=[(10.0, 0.0, 0.0), *along], radii=(10.2, 0.1, 0.1, 0.1))
    every = [long]
    for place in [*along, (15.0, 0.0, 0.0)]:
        every.append(long._replace(centres=[place, place], radii=(0.1, 0.1)))
    q = np.zeros((1, 3))
    for pairs in ([(0, k) for k in range(1, 5)], [(k, 0) for k in range(1, 5)]):
        assert touching(arm, q, every, pairs).tolist() == [[True, True, True, False]]


@pytest.mark.parametrize(
    ("one", "kind", "words"),
    [
        (
            ("uper", [0] * 3, 1),
            UnknownName,
            "spheres[1]: there is no link 'uper'; did you mean 'upper'?...",
        ),
        (
            3,
            InputError,
            "spheres[1]: expected (link, centre, radius), got 3",
        ),
        (
            ("hand", [0, 1], 1),
            ShapeError,
            "spheres[1]: expected three finite numbers, m, got [0, 1]",
        ),
        (("hand", [0] * 3, 0), InputError, "spheres[1]: radius: expected a positive number, got 0"),
    ],
)
def test_a_sphere_that_is_none_is_named_by_its_number(robot, arm, one, kind, words):
    with pytest.raises(kind) as caught:
        moved_links(robot, arm, [GIVEN[0], one])
    assert says(caught.value, words)


def test_links_touch_where_the_offsets_of_the_coordinates_bring_them(robot, arm, links):
    q = arm.random(4, 600)
    offset = np.array([0.5, -0.9, 1.1])
    found = touching(arm.replace(offset=offset), q, links, [(0, 2), (1, 2)])
    np.testing.assert_array_equal(found, touching(arm, q + offset, links, [(0, 2), (1, 2)]))
    assert (found != touching(arm, q, links, [(0, 2), (1, 2)])).any()


def test_a_sphere_on_another_branch_moves_with_the_joints_before_the_fork_alone():
    step = pk.se3.exp([0, 0, 0, 0.3, 0, 0])
    ways = [("body", "chest"), ("chest", "a 1"), ("a 1", "a 2"), ("chest", "b 1"), ("b 1", "b 2")]
    joints = [pk.Joint(f"to {ends[1]}", "revolute", *ends, step) for ends in ways]
    robot = pk.Robot("fork", ["body", *(joint.child for joint in joints)], joints)
    given = [(link, [0.0, 0.0, 0.1], 0.05) for link in robot.links]
    found = moved_links(robot, robot.chain(tip="a 2"), given)
    assert {link.name: link.joints for link in found} == {
        "body": 0, "chest": 1, "a 1": 2, "a 2": 3, "b 1": 1, "b 2": 1,
    }  # fmt: skip
