"""Robots as they are drawn: trees, mimic joints, limits, the order in the file, and what they
shrink to.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import find, settings

from poekin.formats import urdf
from poekin.formats.urdf_text import to_urdf
from poekin.groups import se3
from poekin.model.joint import KINDS, Mimic
from poekin.model.robot import Robot
from poekin.testing.strategies import configuration_strategies, robot_strategies
from poekin.testing.strategies.chain_strategies import RATIOS
from poekin.testing.strategies.decoding.bytes_reader import BytesReader
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
    assert {joint.kind for robot in robots for joint in robot.joints} == set(
        robot_strategies.URDF_KINDS
    )


def test_trees_have_several_leaves_and_long_branches(robots):
    assert np.mean([len(robot.leaves) > 1 for robot in robots]) > 1 / 3
    assert (
        np.mean([max(depth(robot, link) for link in robot.leaves) >= 4 for robot in robots])
        > 1 / 10
    )


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
    assert any(
        joint.mimic and robot.joint(joint.mimic.joint).kind == "fixed" for robot, joint in mimics
    )


# The bytes of a row: 0 or 255 for the choices, then the lowest or the highest of each number.
LOW, HIGH = [0, 255, 0, 0], [255, 0, 255, 255]


def row(*values: int) -> Any:
    return robot_strategies._row(BytesReader(bytes(values)), ("revolute", "fixed"))


def test_zeros_are_the_simplest_row():
    simplest = row()
    assert simplest[:11] == (
        "revolute",
        False,
        0,
        False,
        0,
        1.0,
        0.0,
        (0.0, 0.0),
        (0.0, 0.0),
        0,
        (0, 0, 0),
    )
    assert np.array_equal(simplest.origin, np.eye(4))
    assert simplest.axis.tolist() == [1, 0, 0]
    assert simplest.pitch == 0


def test_a_row_is_read_off_its_bytes_in_order():
    origin = [0, 0, 0, 10, 0, 128, 0, 255, 0, 255, 255, 0, 0, 0]  # turned about x, 3 m along x
    angle = 32768 / 65535
    low = row(
        128,
        128,
        7,
        128,
        9,
        128,
        *LOW,
        *LOW,
        *LOW * 2,
        *LOW * 2,
        11,
        13,
        17,
        19,
        *origin,
        0,
        1,
        0,
        *LOW,
    )
    assert low[:5] == ("fixed", True, 7, True, 9)
    assert low[5:9] == (-2.0, -1.0, (-1.0, -0.9), (-0.9, -0.9))
    assert low[9:11] == (11, (13, 17, 19))
    assert low.origin == pytest.approx(
        se3.exp([angle, 0, 0, 0, 0, 0]) + 3.0 * np.eye(4, k=3), abs=1e-15
    )
    assert low.axis.tolist() == [0, 1, 0]
    assert low.pitch == -0.5
    high = row(
        127,
        127,
        0,
        127,
        0,
        128,
        0,
        130,
        255,
        255,
        *HIGH,
        *HIGH * 2,
        *HIGH * 2,
        *[0] * 4,
        *[0] * 15,
        *[0] * 3,
        *HIGH,
    )
    assert high[:5] == ("revolute", False, 0, False, 0)
    assert high[5:9] == (2.0, 1.0, (1.0, 1.0), (1.0, 1.0))
    assert high.pitch == 0.5
    assert [row(0, 0, 0, 0, 0, 127, k).multiplier for k in (0, 52, 103, 154, 255)] == list(RATIOS)


def names(robot: Robot) -> list[tuple[str, str, str]]:
    return [(joint.name, joint.parent, joint.child) for joint in robot.joints]


def robot_of(
    rows: list[Any], mimics: bool = True, limits: bool = True, still: bool = False
) -> Robot:
    return robot_strategies._robot(rows, mimics, limits, still)


def test_a_joint_goes_on_from_the_link_before_or_branches_off_any_above():
    for parents, links in (
        ((255, 255, 255), (0, 1, 2)),
        ((0, 127, 85), (0, 0, 0)),
        ((9, 128, 86), (0, 1, 1)),
    ):
        rows = [row()._replace(branches=True, parent=parent) for parent in parents]
        assert [parent for _, parent, _ in names(robot_of(rows))] == [f"l{k}" for k in links]
        rows = [row()._replace(parent=parent) for parent in parents]
        assert names(robot_of(rows)) == [("j1", "l0", "l1"), ("j2", "l1", "l2"), ("j3", "l2", "l3")]


def test_links_and_joints_are_put_in_the_order_that_is_drawn():
    rows = [
        row()._replace(places=(3 - k, (k + 1) % 3, first)) for k, first in enumerate((171, 0, 0))
    ]
    robot = robot_of(rows)
    assert robot.links == ("l3", "l2", "l0", "l1")
    assert [joint.name for joint in robot.joints] == ["j3", "j1", "j2"]
    for first, place in ((0, 0), (85, 0), (86, 1), (170, 1), (255, 2)):
        rows[0] = row()._replace(places=(0, 0, first))
        assert robot_of(rows).links.index("l0") == place


def test_a_joint_follows_any_one_of_an_earlier_rank():
    ranks = (5, 3, 9, 7)  # j2, j1, j4, j3
    for masters, followed in ((0, "222"), (127, "221"), (128, "211"), (255, "214")):
        rows = [
            row()._replace(rank=rank, follows=True, master=masters, multiplier=-0.5, offset=0.2)
            for rank in ranks
        ]
        robot = robot_of(rows)
        assert [joint.mimic for joint in robot.joints if joint.name == "j2"] == [None]
        found = [robot.joint(name).mimic for name in ("j1", "j3", "j4")]
        assert found == [Mimic(f"j{k}", -0.5, 0.2) for k in (followed[0], followed[2], followed[1])]
        assert not any(joint.mimic for joint in robot_of(rows, mimics=False).joints)
    rows[0] = rows[0]._replace(follows=False)
    assert robot_of(rows).joint("j1").mimic is None
    rows = [
        row()._replace(kind=kind, follows=True)
        for kind in ("fixed", "revolute", "fixed", "prismatic")
    ]
    assert [bool(joint.mimic) for joint in robot_of(rows).joints] == [False, False, False, True]
    assert [bool(joint.mimic) for joint in robot_of(rows, still=True).joints] == [
        False,
        True,
        True,
        True,
    ]


def test_only_a_helical_joint_has_a_pitch():
    rows = [
        row()._replace(kind=kind, pitch=0.5)
        for kind in KINDS
        if kind in ("revolute", "helical", "prismatic")
    ]
    assert {joint.kind: joint.pitch for joint in robot_of(rows).joints} == {
        "revolute": 0.0, "helical": 0.5, "prismatic": 0.0
    }  # fmt: skip


def test_limits_are_as_wide_as_what_is_drawn_and_hold_what_is_followed():
    def limits(
        kind: str, first: tuple[float, float], margins: tuple[float, float], still: bool = False
    ) -> list[Any]:
        master = row()._replace(kind=kind, limits=first, margins=(0.7, 0.7))
        follower = row()._replace(
            kind=kind, follows=True, rank=1, multiplier=-2.0, offset=0.5, margins=margins
        )
        return [joint.limits for joint in robot_of([master, follower], still=still).joints]

    # The follower's middle is -2 times the master's and 0.5 more; its margins are 1 and what is
    # drawn.
    assert limits("prismatic", (-1.0, 0.5), (0.0, 1.0)) == [(-1.0, 0.5), (0.0, 3.0)]
    assert limits("prismatic", (0.5, -0.9), (1.0, -0.9)) == [(0.5, 0.6), (-2.6, -0.5)]
    assert limits("revolute", (0.0, 1.0), (1.0, -0.5)) == [(0.0, 3.0), (-5.5, -2.0)]
    assert limits("helical", (1.0, -0.5), (0.5, 0.5))[0] == (3.142, 3.642)
    assert robot_of([row()._replace(limits=(1.0, 1.0))], limits=False).joints[0].limits == (
        -math.inf,
        math.inf,
    )
    assert robot_of([row()._replace(kind="continuous")]).joints[0].limits == (-math.inf, math.inf)


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
    robot = find(
        robot_strategies.robots(), lambda robot: any(map(matters, robot.joints)), settings=several
    )
    assert len(robot.joints) <= 2
    for joint in robot.joints:
        values = np.array([*joint.limits, *joint.axis, *joint.origin.ravel()])
        if joint.mimic:
            values = np.append(values, [joint.mimic.multiplier, joint.mimic.offset])
        values = values[np.isfinite(values)]
        np.testing.assert_array_equal(values, np.round(values, 2))
