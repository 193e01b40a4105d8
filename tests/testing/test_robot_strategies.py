"""Robots as they are drawn: trees, mimic joints, limits, the order in the file, and what they shrink to."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import find, settings

from poekin.formats import urdf
from poekin.formats.urdf_text import to_urdf
from poekin.model.joint import KINDS, Mimic
from poekin.model.robot import Robot
from poekin.testing import configuration_strategies, robot_strategies
from poekin.testing.chain_strategies import RATIOS
from tests.testing.drawing import QUICK, drawn
from tests.versions import SHRINKS, needs

QUICK = settings(QUICK, max_examples=20)


@pytest.fixture(scope="module")
def robots() -> list[Robot]:
    """Made with warnings as errors: no limits of a coordinate exclude each other."""
    return drawn(robot_strategies.robots(), 150)


def depth(robot: Robot, link: str) -> int:
    above = {joint.child: joint.parent for joint in robot.joints}
    steps = 0
    while link in above:
        link, steps = above[link], steps + 1
    return steps


def test_there_are_0_to_7_joints_of_every_kind_that_urdf_readers_know(robots):
    assert {len(robot.joints) for robot in robots} == set(range(8))
    assert {joint.kind for robot in robots for joint in robot.joints} == set(robot_strategies.URDF_KINDS)


def test_trees_have_several_leaves_and_long_branches(robots):
    assert np.mean([len(robot.leaves) > 1 for robot in robots]) > 1 / 3
    assert np.mean([max(depth(robot, link) for link in robot.leaves) >= 4 for robot in robots]) > 1 / 10


def test_neither_links_nor_joints_are_in_the_order_of_the_tree(robots):
    mixed = [robot for robot in robots if robot.links[0] != robot.root]
    below = [
        robot
        for robot in robots
        if any(a.parent == b.child for a, b in zip(robot.joints, robot.joints[1:], strict=False))
    ]
    assert min(len(mixed), len(below)) > 20


def test_joints_mimic_others_by_any_ratio_and_mimics_are_mimicked(robots):
    mimics = [(robot, joint) for robot in robots for joint in robot.joints if joint.mimic]
    assert len({robot.name + str(robot.joints) for robot, _ in mimics}) > 50
    ratios = {joint.mimic.multiplier for _, joint in mimics if joint.mimic}
    assert {1.0, -1.0, 0.0} <= ratios
    assert any(joint.mimic and robot.joint(joint.mimic.joint).mimic for robot, joint in mimics)
    assert any(joint.mimic and joint.mimic.offset for _, joint in mimics)
    assert {joint.kind for _, joint in mimics} == {"revolute", "continuous", "prismatic"}


def test_limits_hold_0_or_not_and_some_followers_narrow_those_of_their_coordinate(robots):
    limits = np.concatenate([robot.limits for robot in robots])
    finite = limits[np.isfinite(limits).all(axis=1)]
    assert np.all(finite[:, 0] < finite[:, 1])
    held = (finite[:, 0] <= 0) & (finite[:, 1] >= 0)
    assert 0.2 < np.mean(held) < 0.95
    assert np.isinf(limits).any(), "continuous joints have none"
    narrowed = [
        robot
        for robot in robots
        for name, own in zip(robot.q_names, robot.limits.tolist(), strict=True)
        if tuple(own) != robot.joint(name).limits
    ]
    assert len(narrowed) > 5


def test_configurations_of_a_robot_stay_within_its_limits(robots):
    robot = max(robots, key=lambda robot: np.isfinite(robot.limits).all(axis=1).sum())
    q = np.array(drawn(configuration_strategies.within_limits(robot), 50))
    lower, upper = configuration_strategies.bounds(robot).T
    assert np.all((q >= lower) & (q <= upper))
    assert q.shape == (50, robot.dof)


def test_what_is_asked_for_is_drawn():
    for robot in drawn(robot_strategies.robots(KINDS, 2, 3, mimics=False, limits=False), 30):
        assert 2 <= len(robot.joints) <= 3
        assert not any(joint.mimic for joint in robot.joints)
        assert np.all(np.isinf(robot.limits))
    still = drawn(robot_strategies.robots(("fixed", "prismatic"), 3, 3, still=True), 40)
    mimics = [(robot, joint) for robot in still for joint in robot.joints if joint.mimic]
    assert any(joint.kind == "fixed" for _, joint in mimics)
    assert any(joint.mimic and robot.joint(joint.mimic.joint).kind == "fixed" for robot, joint in mimics)


def test_as_urdf_they_are_read_back(robots):
    for robot in robots[:40]:
        again = urdf.read_text(to_urdf(robot))
        assert (again.links, again.q_names) == (robot.links, robot.q_names)
        assert [joint.mimic for joint in again.joints] == [joint.mimic for joint in robot.joints]


def test_a_robot_shrinks_to_one_link_and_a_failing_one_to_what_matters():
    needs("hypothesis", SHRINKS)
    alone = find(robot_strategies.robots(max_joints=1), lambda robot: True, settings=QUICK)
    assert (alone.links, alone.joints) == (("l0",), ())
    small = find(
        robot_strategies.robots(("revolute", "prismatic"), max_joints=2),
        lambda robot: any(joint.mimic for joint in robot.joints),
        settings=QUICK,
    )
    assert (small.links, len(small.joints)) == (("l0", "l1", "l2"), 2)
    assert {joint.kind for joint in small.joints} == {"revolute"}
    assert all(np.array_equal(joint.origin, np.eye(4)) for joint in small.joints)
    (follower,) = (joint for joint in small.joints if joint.mimic)
    assert follower.mimic in (Mimic("j1", 1.0, 0.0), Mimic("j2", 1.0, 0.0))


@pytest.mark.parametrize(
    "matters",
    [
        lambda joint: joint.limits[1] > 1.3,
        lambda joint: joint.mimic and joint.mimic.multiplier not in RATIOS,
        lambda joint: joint.mimic and joint.mimic.offset > 0.3,
        lambda joint: any(joint.origin[:3, 3]),
    ],
    ids=["limits", "multiplier", "offset", "origin"],
)
def test_a_robot_shrinks_to_round_numbers(matters):
    needs("hypothesis", SHRINKS)
    several = settings(QUICK, max_examples=300)
    robot = find(robot_strategies.robots(), lambda robot: any(map(matters, robot.joints)), settings=several)
    assert len(robot.joints) <= 2
    for joint in robot.joints:
        values = np.array([*joint.limits, *joint.axis, *joint.origin.ravel()])
        if joint.mimic:
            values = np.append(values, [joint.mimic.multiplier, joint.mimic.offset])
        values = values[np.isfinite(values)]
        np.testing.assert_array_equal(values, np.round(values, 2))
