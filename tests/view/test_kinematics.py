"""Kinematics of a page, by Node: poses of links and Jacobians of tips against `Robot.fk` and chains."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.errors import PoekinWarning, UnknownName
from poekin.formats.catalogue import NAMES
from poekin.formats.erd import example_robots
from poekin.groups import se3, so3
from poekin.view.kinematics import MOST_TIPS, default_tips, kinematics, page_tips
from tests.formats.emitted import ARMS, HOSTILE, arm, bound, link_bounds, with_name
from tests.model.test_robot import two_arms
from tests.nodejs import Calls

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
        self,
        text: str,
        q: np.ndarray,
        wanted: list[np.ndarray],
        within: Any,
    ) -> None:
        """A module, what it has to give at configurations (N, m), and how exactly."""
        rows = np.concatenate([values.reshape(len(q), -1) for values in wanted], axis=1)
        self.calls.add(text + ALL, "all", [[row] for row in q], rows)
        self.bounds.append(np.broadcast_to(within, rows.shape))

    def add_robot(
        self,
        robot: pk.Robot,
        q: np.ndarray,
        names: Any = (),
        change: Callable[[str], str] = str,
    ) -> None:
        """A robot without floating joints: its links, and Jacobians of its chains."""
        tips = page_tips(robot, names)
        wanted = list(robot.fk(q).values())
        within = np.repeat(link_bounds(robot, q), 16)
        for tip in tips:
            chain = robot.chain(tip=tip.name)
            own = q[:, [robot.q_names.index(name) for name in chain.q_names]]
            wanted += chain.fk_jacobian(own, "hybrid")
            within = np.append(within, np.full(16 + 6 * chain.dof, bound(chain, own)))
        self.add(change(kinematics(robot, tips)), q, wanted, within)

    def add_chain(self, chain: pk.Chain, q: np.ndarray) -> None:
        """A chain: its bodies' displacements, and its Jacobian."""
        poses = chain.joint_poses(q) @ se3.inverse(chain.joint_poses(np.zeros(chain.dof)))
        base = np.broadcast_to(np.eye(4), (len(q), 4, 4))
        within = 2 * bound(chain, q)  # of a displacement: of both poses that it leads between
        wanted = [base, poses, *chain.fk_jacobian(q, "hybrid")]
        self.add(kinematics(chain, page_tips(chain)), q, wanted, within)

    def worst(self) -> list[float]:
        """Worst error of each model, in bounds."""
        return [
            float((np.abs(got - wanted) / within).max(initial=0.0))
            for (got, wanted), within in zip(self.calls.run(), self.bounds, strict=True)
        ]


def load(model: str) -> pk.Robot:
    with warnings.catch_warnings(action="ignore", category=PoekinWarning):
        return pk.load(model)


@pytest.fixture
def pages(tmp_path):
    return Pages(tmp_path)


def test_links_and_jacobians_of_all_leaves_of_every_other_example_robot_are_the_robots(pages):
    rng = np.random.default_rng(0)
    # neighbours are variants of one robot
    for path in list(example_robots()[0].values())[::2]:
        robot = load(path)
        pages.add_robot(robot, rng.uniform(-3, 3, (2, robot.dof)), robot.leaves)
    assert len(pages.bounds) > 30
    assert max(pages.worst()) <= 1


def test_so_are_those_of_built_in_arms_mimics_and_readings(pages):
    rng = np.random.default_rng(1)
    robots = [load(name) for name in NAMES]
    robots.append(
        load("puma560").coupled(["joint3 = joint2 + joint3", "joint6 = 2 joint6 - 1/80 joint5"])
    )
    robots += [two_arms(), two_arms().coupled("r = r - 0.5 h"), pk.Robot("one", ["a"], [])]
    for robot in robots:
        pages.add_robot(robot, rng.uniform(-3, 3, (5, robot.dof)), [robot.root])
    assert max(pages.worst()) <= 1


def test_bodies_of_a_chain_are_displaced_from_where_they_are_at_zero(pages):
    rng = np.random.default_rng(2)
    for name in ARMS:
        pages.add_chain(arm(name), rng.uniform(-3, 3, (5, arm(name).dof)))
    fanuc = load("puma560").chain().coupled("joint3 = joint2 + joint3")
    pages.add_chain(fanuc, rng.uniform(-3, 3, (5, 6)))
    assert max(pages.worst()) <= 1


def test_floating_and_planar_joints_stay_at_zero_and_tips_beyond_them_are_seen_from_the_root(pages):
    q = np.random.default_rng(3).uniform(-2, 2, (4, 3))
    tips = page_tips(FREE, ["arm"])
    assert [(tip.name, tip.coordinates) for tip in tips] == [("arm", (0, 1)), ("hand", (0, 1, 2))]
    poses = FREE.fk(q)
    wanted = list(poses.values())
    for tip in tips:
        wanted += [poses[tip.name], by_differences(tip.name, q)[..., list(tip.coordinates)]]
    # differences over 2 h, h = 1e-5: h^2 / 6 for what they leave out, 2^-53 / h for rounding
    pages.add(kinematics(FREE, tips), q, wanted, 1e-9)
    assert max(pages.worst()) <= 1


def by_differences(link: str, q: np.ndarray) -> np.ndarray:
    """Hybrid Jacobian (N, 6, m) of a link of FREE."""
    T = FREE.fk(q)[link]
    J = np.zeros((len(q), 6, FREE.dof))
    for k in range(FREE.dof):
        h = 1e-5 * np.eye(FREE.dof)[k]
        dT = (FREE.fk(q + h)[link] - FREE.fk(q - h)[link]) / 2e-5
        J[:, :3, k] = so3.vee((dT @ se3.inverse(T))[:, :3, :3])
        J[:, 3:, k] = dT[:, :3, 3]
    return J


@pytest.mark.parametrize(
    "found, planted",
    [
        (r"(?<=v\d) - (?=v)", " + "),
        (r"T\[\d+\] = (?=v)", "T[12] = "),
        (r"J\[\d+\] = (?=v)", "J[0] = "),
        (r"tip0\(\[q\[0\], q\[1\]", "tip0([q[1], q[0]"),
        (r"(?<=c2 = c\[)2", "1"),
    ],
)
def test_a_planted_error_is_seen(pages, found, planted):
    def change(text: str) -> str:
        changed, count = re.subn(found, planted, text, count=1)
        assert count == 1
        return changed

    pages.add_robot(load("panda"), np.random.default_rng(4).uniform(-2, 2, (3, 8)), (), change)
    assert max(pages.worst()) > 1e6


def test_no_name_comes_into_the_text():
    texts = {
        kinematics(model, page_tips(model))
        for name in (*HOSTILE, "a")
        for model in [with_name(name)]
    }
    joints = [pk.Joint(name, "revolute", name, f"{name}2") for name in HOSTILE]
    robots = [pk.Robot("a", [joint.parent, joint.child], [joint]) for joint in joints]
    texts |= {kinematics(robot, page_tips(robot)) for robot in robots}
    assert len(texts) == 2
    assert all(text.isascii() and "</" not in text and "<!--" not in text for text in texts)


def test_a_module_says_what_it_exports():
    model = with_name("a")
    text = kinematics(model, page_tips(model))
    assert "links(q): poses of the links in the base frame, 4 x 4 row by row, one after" in text
    assert "tips[k].fk_jacobian(q): pose T of a tip and its hybrid Jacobian J" in text


def test_a_tip_stands_for_all_that_are_fixed_to_its_body():
    assert default_tips(load("ur5e")) == ("tool0",)
    assert default_tips(load("panda")) == ("panda_hand", "panda_leftfinger", "panda_rightfinger")
    still = pk.Robot(
        "still",
        ["a", "b", "c"],
        [pk.Joint("b", "fixed", "a", "b"), pk.Joint("c", "fixed", "a", "c")],
    )
    assert default_tips(still) == ("b",)
    # of those behind one joint the farthest, whatever their order
    joints = [
        pk.Joint("turn", "revolute", "a", "arm"),
        pk.Joint("long", "fixed", "arm", "hand"),
        pk.Joint("longer", "fixed", "hand", "finger"),
        pk.Joint("short", "fixed", "arm", "lamp"),
    ]
    for leaves in (["finger", "lamp"], ["lamp", "finger"]):
        lit = pk.Robot("lit", ["a", "arm", "hand", *leaves], joints)
        assert default_tips(lit) == ("finger",)
    assert default_tips(pk.Robot("one", ["a"], [])) == ("a",)


def test_every_limb_has_a_tip_before_the_second_finger_has():
    robot = load("erd:talos_full_v2")
    tips = default_tips(robot)
    assert len(tips) == MOST_TIPS
    assert tips[:5] == (
        "gripper_left_motor_double_link",
        "gripper_right_motor_double_link",
        "left_sole_link",
        "right_sole_link",
        "rgbd_depth_optical_frame",
    )


def test_tips_that_are_asked_for_come_first_and_once():
    robot = load("panda")
    names = [
        tip.name for tip in page_tips(robot, ["panda_link3", "panda_rightfinger", "panda_link3"])
    ]
    assert names == ["panda_link3", "panda_rightfinger", "panda_hand", "panda_leftfinger"]
    with pytest.raises(UnknownName, match="no tip link 'elbow'"):
        page_tips(robot, ["elbow"])


def test_a_humanoid_takes_a_third_of_a_megabyte_at_most():
    for name in ("talos_full_v2", "romeo"):
        robot = load(f"erd:{name}")
        assert len(kinematics(robot, page_tips(robot))) < 330_000
