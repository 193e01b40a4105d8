"""Links under which joints that one model has beyond the other are left out."""

from __future__ import annotations

from itertools import pairwise

import pytest

from poekin.analysis.compare.differences.ends import Chosen, _without_joints
from poekin.model.joint import Joint
from poekin.model.robot import Robot

LINKS = ("l0", "l1", "l2", "l3")


@pytest.mark.parametrize("names", [("a", "b", "c"), ("c", "b", "a"), ("b", "c", "a")])
def test_joints_are_left_out_at_the_end_where_they_are_and_nowhere_on_a_way_to_the_root(names):
    ways = zip(names, pairwise(LINKS), strict=True)
    joints = [Joint(name, "revolute", parent, child) for name, (parent, child) in ways]
    robot = Robot("r", LINKS, joints)
    first, _, last = names
    ahead = Chosen(robot, robot.chain())
    found = [list(_without_joints("a", ahead, [name])) for name in (first, last)]
    assert [(r.end, r.link) for (r,) in found] == [("base", "l1"), ("tip", "l2")]
    # from the tip to the root a joint's child is before it: its links leave out another joint
    back = Chosen(robot, robot.chain(base="l3", tip="l0"))
    for name in (first, last):
        assert list(_without_joints("a", back, [name])) == []
