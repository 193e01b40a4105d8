"""The tree of a robot: whatever is none is refused by name, and none is too long."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from poekin.errors import ModelError
from poekin.model.joint import Joint, Mimic
from poekin.model.robot import Robot
from tests.messages import says


def revolute(name: str, parent: str, child: str, **fields) -> Joint:
    return Joint(name, "revolute", parent, child, axis=(0, 0, 1), **fields)


NO_TREES = {
    "no links": ([], [], "robot 'r': a robot needs at least one link, this one has none"),
    "a link twice": (
        ["a", "a"],
        [],
        "robot 'r': the link name 'a' is used twice (first: robot 'r')",
    ),
    "a joint twice": (
        ["a", "b", "c"],
        [revolute("j", "a", "b"), revolute("j", "b", "c")],
        "robot 'r': the joint name 'j' is used twice (first: robot 'r')",
    ),
    "a nameless link": ([""], [], "robot 'r': a link needs a name that is not empty, got ''"),
    "a link that is no name": ([7], [], "robot 'r': a link needs a name that is not empty, got 7"),
    "an unknown parent": (
        ["left", "b"],
        [revolute("j", "lift", "b")],
        "robot 'r': joint 'j': its parent link 'lift' does not exist; did you mean 'left'?",
    ),
    "an unknown child": (
        ["a", "right"],
        [revolute("j", "a", "rigth")],
        "robot 'r': joint 'j': its child link 'rigth' does not exist; did you mean 'right'?",
    ),
    "two roots": (
        ["a", "b", "c"],
        [revolute("j", "a", "b")],
        "robot 'r': a robot has one root, but 2 links have no parent: 'a' (robot 'r'), 'c' (robot 'r')",
    ),
    "five roots": (
        [*"abcde"],
        [],
        "robot 'r': a robot has one root, but 5 links have no parent: "
        + ", ".join(f"'{link}' (robot 'r')" for link in "abcde"),
    ),
    "seven roots": (
        [*"abcdefg"],
        [],
        "robot 'r': a robot has one root, but 7 links have no parent: "
        + ", ".join(f"'{link}' (robot 'r')" for link in "abcde")
        + " and 2 more",
    ),
    "two parents": (
        ["a", "b", "c"],
        [revolute("i", "a", "c"), revolute("j", "b", "c")],
        "robot 'r': link 'c' has two parents: joint 'j' and joint 'i' (robot 'r')",
    ),
    "two parents by later joints": (
        ["a", "b", "c"],
        [revolute("h", "a", "b"), revolute("i", "a", "c"), revolute("j", "b", "c")],
        "robot 'r': link 'c' has two parents: joint 'j' and joint 'i' (robot 'r')",
    ),
    "a joint onto itself": (
        ["a", "b"],
        [revolute("j", "b", "b")],
        "robot 'r': the links form a cycle of 1 joint(s): 'b'",
    ),
    "nothing but a cycle": (
        ["a", "b"],
        [revolute("i", "a", "b"), revolute("j", "b", "a")],
        "robot 'r': the links form a cycle of 2 joint(s): 'a' -> 'b'",
    ),
    "a cycle beside the tree": (
        ["o", "a", "b", "c"],
        [revolute("i", "a", "b"), revolute("j", "b", "a"), revolute("k", "b", "c")],
        "robot 'r': the links form a cycle of 2 joint(s): 'a' -> 'b'",
    ),
    "no joint": (["a"], ["j"], "robot 'r': joints must be Joint objects, got 'j'"),
    "one text for all links": ("a", [], "robot 'r': links must be a list, got 'a'"),
    "a number for links": (5, [], "robot 'r': links must be a list, got 5"),
    "links in no order": ({"a", "b"}, [], "robot 'r': links must be a list, got {..."),
    "nothing for joints": (["a"], None, "robot 'r': joints must be a list, got None"),
    "mimic of an unknown joint": (
        ["a", "b"],
        [revolute("j", "a", "b", mimic=Mimic("k"))],
        "robot 'r': joint 'j' mimics 'k', which does not exist; available: 'j'",
    ),
    "mimic of itself": (
        ["a", "b"],
        [revolute("j", "a", "b", mimic=Mimic("j"))],
        "robot 'r': joint 'j' mimics itself",
    ),
    "mimics in a circle": (
        ["a", "b", "c"],
        [revolute("i", "a", "b", mimic=Mimic("j")), revolute("j", "b", "c", mimic=Mimic("i"))],
        "robot 'r': joint 'i' mimics itself, through others",
    ),
    "mimic of a floating joint": (
        ["a", "b", "c"],
        [Joint("f", "floating", "a", "b"), revolute("j", "b", "c", mimic=Mimic("f"))],
        "robot 'r': joint 'j' mimics 'f', but a floating joint has no single value",
    ),
    "multipliers without end": (
        ["a", "b", "c", "d"],
        [
            revolute("i", "a", "b"),
            revolute("j", "b", "c", mimic=Mimic("i", 1e200)),
            revolute("k", "c", "d", mimic=Mimic("j", 1e200)),
        ],
        "robot 'r': joint 'k': the product of its chain of multipliers is not finite",
    ),
}


@pytest.mark.parametrize("links, joints, message", NO_TREES.values(), ids=NO_TREES)
def test_what_is_no_tree_is_refused_by_name(links, joints, message):
    with pytest.raises(ModelError) as caught:
        Robot("r", links, joints)
    assert says(caught.value, message)
    assert str(caught.value).isprintable()


def test_a_source_that_is_none_is_refused():
    with pytest.raises(ModelError, match="'r': source must be a Source, a text or None, got 5"):
        Robot("r", ["a"], [], source=5)  # pyright: ignore[reportArgumentType]


def test_a_chain_of_twenty_thousand_links_is_legal():
    count = 20_000
    shift = np.eye(4)
    shift[2, 3] = 1e-3
    joints = [Joint(f"j{i}", "fixed", f"l{i}", f"l{i + 1}", shift) for i in range(count - 1)]
    joints[500] = replace(joints[500], kind="revolute")
    robot = Robot("long", [f"l{i}" for i in range(count)], joints[::-1])
    assert (robot.root, robot.leaves, robot.dof) == ("l0", (f"l{count - 1}",), 1)
    chain = robot.chain()
    assert abs(chain.fk([0.0])[2, 3] - (count - 1) * 1e-3) <= 1e-9
    assert abs(robot.fk([0.0])[chain.tip][2, 3] - (count - 1) * 1e-3) <= 1e-9
    assert robot.chain(f"l{count - 1}", "l0").dof == 1
    assert hash(robot) == hash(robot)
