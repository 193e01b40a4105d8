"""The tree of a robot: whatever is none is refused by name, and none is too long."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from poekin.errors import ModelError
from poekin.model.joint import Joint, Mimic
from poekin.model.robot import Robot


def revolute(name: str, parent: str, child: str, **fields) -> Joint:
    return Joint(name, "revolute", parent, child, axis=(0, 0, 1), **fields)


NO_TREES = {
    "no links": ([], [], "at least one link"),
    "a link twice": (["a", "a"], [], "link name 'a' is used twice"),
    "a joint twice": (
        ["a", "b", "c"],
        [revolute("j", "a", "b"), revolute("j", "b", "c")],
        "joint name 'j' is used twice",
    ),
    "a nameless link": ([""], [], "a link needs a name"),
    "a link that is no name": ([7], [], "a link needs a name"),
    "an unknown parent": (["left", "b"], [revolute("j", "lift", "b")], "'j': its parent link 'lift' .* 'left'"),
    "an unknown child": (["a", "right"], [revolute("j", "a", "rigth")], "'j': its child link 'rigth' .* 'right'"),
    "two roots": (["a", "b", "c"], [revolute("j", "a", "b")], "2 links have no parent: 'a' .*'c'"),
    "two parents": (
        ["a", "b", "c"],
        [revolute("i", "a", "c"), revolute("j", "b", "c")],
        "'c' has two parents.*'j'.*'i'",
    ),
    "a joint onto itself": (["a", "b"], [revolute("j", "b", "b")], "cycle of 1 joint"),
    "nothing but a cycle": (["a", "b"], [revolute("i", "a", "b"), revolute("j", "b", "a")], "cycle of 2 joint"),
    "a cycle beside the tree": (
        ["o", "a", "b", "c"],
        [revolute("i", "a", "b"), revolute("j", "b", "a"), revolute("k", "b", "c")],
        "cycle of 2 joint.*: '[ab]' -> '[ab]'$",
    ),
    "no joint": (["a"], ["j"], "must be Joint objects"),
    "one text for all links": ("a", [], "'r': links must be a list, got 'a'"),
    "a number for links": (5, [], "'r': links must be a list, got 5"),
    "links in no order": ({"a", "b"}, [], "'r': links must be a list"),
    "nothing for joints": (["a"], None, "'r': joints must be a list, got None"),
    "mimic of an unknown joint": (
        ["a", "b"],
        [revolute("j", "a", "b", mimic=Mimic("k"))],
        "mimics 'k', which does not exist",
    ),
    "mimic of itself": (["a", "b"], [revolute("j", "a", "b", mimic=Mimic("j"))], "'j' mimics itself$"),
    "mimics in a circle": (
        ["a", "b", "c"],
        [revolute("i", "a", "b", mimic=Mimic("j")), revolute("j", "b", "c", mimic=Mimic("i"))],
        "mimics itself, through others",
    ),
    "mimic of a floating joint": (
        ["a", "b", "c"],
        [Joint("f", "floating", "a", "b"), revolute("j", "b", "c", mimic=Mimic("f"))],
        "'j' mimics 'f', but a floating joint has no single value",
    ),
    "multipliers without end": (
        ["a", "b", "c", "d"],
        [
            revolute("i", "a", "b"),
            revolute("j", "b", "c", mimic=Mimic("i", 1e200)),
            revolute("k", "c", "d", mimic=Mimic("j", 1e200)),
        ],
        "'k': the product of its chain of multipliers is not finite",
    ),
}


@pytest.mark.parametrize("links, joints, message", NO_TREES.values(), ids=NO_TREES)
def test_what_is_no_tree_is_refused_by_name(links, joints, message):
    with pytest.raises(ModelError, match=message) as caught:
        Robot("r", links, joints)
    assert str(caught.value).isprintable()


def test_a_source_that_is_none_is_refused():
    with pytest.raises(ModelError, match="'r': source must be a Source, a text or None, got 5"):
        Robot("r", ["a"], [], source=5)  # pyright: ignore[reportArgumentType]


def test_a_chain_of_a_hundred_thousand_links_is_legal():
    count = 100_000
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
