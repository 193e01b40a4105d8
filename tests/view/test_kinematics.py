"""Kinematics of a page, by Node: poses of links and Jacobians of tips against `Robot.fk` and chains."""

from __future__ import annotations

import re
import warnings
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.errors import PoekinWarning, UnknownName
from poekin.formats.erd import example_robots
from poekin.groups import se3
from poekin.view.kinematics import MOST_TIPS, default_tips, kinematics, page_tips
from tests.formats.emitted import ARMS, HOSTILE, arm, bound, with_name
from tests.formats.node import Calls

# Both exports of a page's module as one list of numbers.
ALL = """
export const all = (q) => [...links(q), ...tips.flatMap((tip) => {
    const { T, J } = tip.fk_jacobian(q);
    return [...T, ...J];
})];
"""
FREE = pk.Robot(
    "free",
    ["world", "lift", "body", "arm", "sled", "hand"],
    [
        pk.Joint(
            "lift", "prismatic", "world", "lift", se3.exp([0.1, 0.2, 0.3, 1, 2, 3]), (0, 0, 1)
        ),
        pk.Joint("float", "floating", "lift", "body", se3.exp([0.4, 0, 0.3, 0, 0.2, 0])),
        pk.Joint("turn", "revolute", "body", "arm", se3.exp([0, 0.7, 0, 0, 0, 1]), (1, 1, 0)),
        pk.Joint("plane", "planar", "arm", "sled", se3.exp([0.3, 0, 0, 0.5, 0, 0])),
        pk.Joint(
            "screw", "helical", "sled", "hand", se3.exp([1, 0, 0, 0, 0, 0.1]), (0, 1, 2), pitch=0.2
        ),
    ],
)


class Pages:
    """Modules of several models, run in one process, and what they have to give."""

    def __init__(self, folder: Any) -> None:
        self.calls = Calls(folder)
        self.bounds: list[np.ndarray] = []

    def add(
        self, model: Any, q: np.ndarray, tips: Any, wanted: np.ndarray, within: np.ndarray
    ) -> None:
        """A model, its tips, rows that it has to give at configurations, and how exactly."""
        text = kinematics(model, tips) + ALL
        self.calls.add(text, "all", [[row] for row in q], wanted)
        self.bounds.append(np.broadcast_to(within, wanted.shape))

    def add_robot(self, robot: pk.Robot, q: np.ndarray, names: Any = ()) -> None:
        """A robot without floating joints: its links, and Jacobians of its chains."""
        tips = page_tips(robot, names)
        poses = robot.fk(q)
        wanted = [poses[link].reshape(len(q), 16) for link in robot.links]
        within = np.repeat(link_bounds(robot, q), 16)
        for tip in tips:
            chain = robot.chain(tip=tip.name)
            own = q[:, list(tip.coordinates)]
            T, J = chain.fk_jacobian(own, "hybrid")
            wanted += [T.reshape(len(q), 16), J.reshape(len(q), -1)]
            within = np.append(within, np.full(16 + 6 * chain.dof, bound(chain, own)))
        self.add(robot, q, tips, np.concatenate(wanted, axis=1), within)

    def worst(self) -> list[float]:
        """Worst error of each model, in bounds."""
        return [
            float((np.abs(got - wanted) / within).max(initial=0.0))
            for (got, wanted), within in zip(self.calls.run(), self.bounds, strict=True)
        ]


def link_bounds(robot: pk.Robot, q: np.ndarray) -> np.ndarray:
    """Twice what rounding leaves of each link's pose: 8 u R for each product above it and 4 u R for
    each unit of x, R the lengths on its way (`forward.frame`).
    """
    x = {}
    for leaf in robot.leaves:
        chain = robot.chain(tip=leaf)
        own = q[:, [robot.q_names.index(name) for name in chain.q_names]]
        moved = np.abs(own @ chain.coupling.T + chain.offset).max(axis=0)
        x.update(zip(chain.joint_names, moved, strict=True))
    above = {joint.child: joint for joint in robot.joints}
    bounds = []
    for link in robot.links:
        depth, moved, reach = 1, 0.0, 1.0
        while link in above:
            joint = above[link]
            depth += 1
            moved += x.get(joint.name, 0.0)
            reach += np.linalg.norm(joint.origin[:3, 3]) + (joint.kind == "prismatic")
            link = joint.parent
        bounds.append(2 * 2.0**-53 * (8 * depth + 4 * moved) * reach)
    return np.array(bounds)


def load(model: str) -> pk.Robot:
    with warnings.catch_warnings(action="ignore", category=PoekinWarning):
        return pk.load(model)


@pytest.fixture
def pages(tmp_path):
    return Pages(tmp_path)


def test_links_and_jacobians_of_all_leaves_of_example_robot_data_are_the_robots(pages):
    rng = np.random.default_rng(0)
    for path in example_robots()[0].values():
        robot = load(path)
        pages.add_robot(robot, rng.uniform(-3, 3, (2, robot.dof)), robot.leaves)
    assert len(pages.bounds) > 60
    assert max(pages.worst()) <= 1
