"""A nominal robot with other screws: it moves as the chain says, and its link frames hardly move at
all.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import InputError, ModelError, PoekinError, PoekinWarning, UnknownName
from poekin.formats import rpy
from poekin.formats.relink import relinked
from poekin.model.joint import Joint, Mimic, SafetyController
from poekin.model.robot import Robot
from poekin.testing.accuracy.error_bounds import UNIT
from poekin.testing.strategies.chain_strategies import placements, screws
from poekin.testing.strategies.group_strategies import axes
from tests.model.laws.chain_bounds import budget

KINDS = ("revolute", "continuous", "prismatic", "helical")
TURNS = ("auto", "frames", "axes")


@st.composite
def locked(draw) -> np.ndarray:
    """A placement at which roll and yaw are one turn, or nearly."""
    roll, yaw = draw(st.floats(-3.2, 3.2)), draw(st.floats(-3.2, 3.2))
    pitch = draw(st.sampled_from([-1, 1])) * (math.pi / 2 - draw(st.sampled_from([0, 1e-9, 0.04])))
    return rpy.pose(draw(placements())[:3, 3], (roll, pitch, yaw))


DRIVE = {
    "velocity": 2.5,
    "effort": 87.0,
    "damping": 0.5,
    "friction": 0.25,
    "safety_controller": SafetyController(40, 100, -1, 1),
}


@st.composite
def arms(draw, most: int = 5, mimics: bool = True) -> Robot:
    """A branch of joints of all kinds from "l0" to "tip", fixed ones between them, and a bracket on
    every link.
    """
    kinds = draw(
        st.lists(st.sampled_from((*KINDS, "fixed")), min_size=1, max_size=most).filter(
            lambda k: {*k} - {"fixed"}
        )
    )
    joints = []
    every: list[Any] = [*kinds, "fixed"]
    for i, kind in enumerate(every):
        pitch = draw(st.sampled_from([-0.2, 0.1])) if kind == "helical" else 0.0
        child = f"l{i + 1}" if i < len(kinds) else "tip"
        limits = (-2.0, 3.0) if kind == "revolute" else (-math.inf, math.inf)
        joints.append(
            Joint(
                f"j{i}",
                kind,
                f"l{i}",
                child,
                draw(st.one_of(placements(), locked())),
                draw(axes()),
                limits,
                pitch=pitch,
                **DRIVE,
            )
        )
    moving = [i for i, joint in enumerate(joints) if joint.kind != "fixed"]
    if mimics and len(moving) > 1 and draw(st.booleans()):
        first, last = moving[0], moving[-1]
        joints[last] = replace(joints[last], mimic=Mimic(joints[first].name, -0.5, 0.25))
    joints += [
        Joint(f"b{i}", "fixed", f"l{i}", f"bracket{i}", draw(placements()))
        for i in range(len(kinds) + 1)
    ]
    links = ["l0", *(joint.child for joint in joints)]
    return Robot("arm", draw(st.permutations(links)), draw(st.permutations(joints)))


@st.composite
def cases(draw, **options) -> tuple[Robot, pk.Chain]:
    """A robot, and a chain with other screws and another home pose for its branch from l0 to tip."""
    robot = draw(arms(**options))
    nominal = robot.chain("l0", "tip")
    A = [draw(screws((kind,))) for kind in nominal.kinds]
    C = nominal.coupling
    other = pk.Chain.from_space(
        A,
        draw(placements()),
        joint_names=nominal.joint_names,
        q_names=nominal.q_names,
        coupling=C,
        offset=nominal.offset,
    )
    return robot, other


def moved_links(robot: Robot) -> list[Joint]:
    """The moving joints of the branch, in order."""
    return [robot.joint(name) for name in robot.chain("l0", "tip").joint_names]


def at_zero(robot: Robot) -> dict[str, np.ndarray]:
    """The poses of all links where every joint's own value is 0, whatever it mimics."""
    joints = [replace(joint, mimic=None) for joint in robot.joints]
    free = Robot(robot.name, robot.links, joints)
    return free.fk(np.zeros(free.dof))


def rounding(robot: Robot) -> float:
    """How far a link's frame may be off by rounding alone, in rad and in reaches; u = 2^-53.

    It is a product of the origins of the branch, each of them an inverse and a product, made the
    nearest rotation:
    24 u a joint, fixed ones and the tool counted.
    """
    return 24 * UNIT * sum(not joint.name.startswith("b") for joint in robot.joints)


def off(case: tuple[Robot, pk.Chain], seed: int, rows: int = 3, turn: Any = "auto") -> np.ndarray:
    """How far the relinked branch is from the chain ÷ what it may be by rounding, at so many
    configurations.

    `fk` of either is within its budget. A screw of the branch is off as its frame is, and moves
    what is behind it by that times its x. The way to a link's nominal place and back is longer than
    the chain: both count.
    """
    robot, chain = case
    branch = relinked(robot, chain, base="l0", tip="tip", turn=turn).chain("l0", "tip")
    q = np.random.default_rng(seed).uniform(-2, 2, (rows, chain.dof))
    x = np.abs(q @ chain.coupling.T + chain.offset)
    size = chain.reach + robot.chain("l0", "tip").reach + x @ np.abs(chain.local.slides)
    angular, linear = np.add(budget(chain, q), budget(branch, q))
    frames = rounding(robot) * (1 + x.sum(axis=1))
    error = np.abs(branch.fk(q) - chain.fk(q))
    turned, moved = error[:, :3, :3].max(axis=(1, 2)), error[:, :3, 3].max(axis=1)
    return np.maximum(turned / (angular + frames), moved / (linear + frames * size))


@given(case=cases(), seed=st.integers(0, 2**32), turn=st.sampled_from(TURNS))
def test_the_branch_moves_as_the_chain_says(case, seed, turn):
    assert off(case, seed, turn=turn).max() <= 1


def is_locked(joint: Joint) -> bool:
    """Whether a small turn may change the roll and yaw of a joint's origin by twenty times as much."""
    return abs(rpy.angles(joint.origin[:3, :3])[1]) > math.acos(0.05)


def frames_off(case: tuple[Robot, pk.Chain], turn: Any = "auto") -> np.ndarray:
    """How far each frame is from where it belongs ÷ `rounding`: on the new axis, nearest, and
    turned the least; or turned not at all against the link before it, where the axis turns.
    """
    robot, chain = case
    result = relinked(robot, chain, base="l0", tip="tip", turn=turn)
    reach = chain.reach + robot.chain("l0", "tip").reach
    old = Robot("free", robot.links, [replace(joint, mimic=None) for joint in robot.joints])
    before, after = at_zero(old), at_zero(result)
    worst = []
    for i, joint in enumerate(moved_links(robot)):
        H, G = before[joint.child], after[joint.child]
        moving = result.joint(joint.name)
        turns = chain.kinds[i] != "prismatic"
        w = chain.screws[i, :3] if turns else chain.screws[i, 3:]
        nominal = H[:3, :3] @ joint.axis
        angle = math.atan2(np.linalg.norm(np.cross(nominal, w)), abs(nominal @ w))
        turned = np.linalg.norm(pk.so3.log(H[:3, :3].T @ G[:3, :3]))
        if turn == "axes" or (turn == "auto" and is_locked(joint)):
            angle = 0.0
            turned = np.linalg.norm(pk.so3.log(joint.origin[:3, :3].T @ moving.origin[:3, :3]))
        p, foot = H[:3, 3], np.cross(w, chain.screws[i, 3:]) if turns else H[:3, 3]
        distance = np.linalg.norm(np.cross(p - foot, w)) if turns else 0.0
        missed = np.abs(G[:3, :3] @ moving.axis - w).max()
        away = abs(np.linalg.norm(G[:3, 3] - p) - distance) / reach
        worst.append(max(missed, abs(turned - angle) / 2, away / 2))  # both frames are off
    return np.array(worst) / rounding(robot)


@given(case=cases(), turn=st.sampled_from(TURNS))
def test_each_frame_stands_on_its_axis_where_that_is_nearest_and_is_turned_as_asked(case, turn):
    assert frames_off(case, turn).max() <= 1


@given(case=cases())
def test_all_else_stays_what_it_was(case):
    robot, chain = case
    result = relinked(robot, chain, base="l0", tip="tip")
    assert (result.name, result.links, result.q_names) == (robot.name, robot.links, robot.q_names)
    np.testing.assert_array_equal(result.limits, robot.limits)
    last = moved_links(robot)[-1].child
    free = {"l0", last}
    for old, new in zip(robot.joints, result.joints, strict=True):
        same = ("name", "kind", "parent", "child", "limits", "mimic", *DRIVE)
        assert [getattr(old, f) for f in same] == [getattr(new, f) for f in same]
        if old.kind == "fixed" and old.parent not in free:
            assert old == new
        if old.name.startswith("b"):
            assert old == new


@given(robot=arms())
def test_its_own_chain_leaves_a_robot_as_it_is(robot):
    chain = robot.chain("l0", "tip")
    result = relinked(robot, chain, base="l0", tip="tip")
    before, after = at_zero(robot), at_zero(result)
    # the brackets are off the branch, up to 3 m from a link that is off
    within = 2 * rounding(robot) * (chain.reach + 3)
    assert max(np.abs(before[link] - after[link]).max() for link in robot.links) <= within
    for a, b in zip(robot.joints, result.joints, strict=True):
        # an axis that turns in its frame is a product with two rotations, each of them rounded
        assert np.abs(np.subtract(a.axis, b.axis)).max() <= rounding(robot) * is_locked(a)


@given(robot=arms(mimics=False), data=st.data())
def test_a_frame_moves_no_more_than_its_axis_does(robot, data):
    chain = robot.chain("l0", "tip")
    # Each axis is moved by a twist of its own, at most a micrometre and a microradian.
    twists = [
        data.draw(st.lists(st.floats(-1e-6, 1e-6), min_size=6, max_size=6)) for _ in chain.kinds
    ]
    A = np.array(
        [pk.se3.adjoint(pk.se3.exp(t)) @ S for t, S in zip(twists, chain.screws, strict=True)]
    )
    other = pk.Chain.from_space(A, chain.home)
    result = relinked(robot, other, base="l0", tip="tip", turn="frames")
    before, after = at_zero(robot), at_zero(result)
    for joint in moved_links(robot):
        H, G = before[joint.child], after[joint.child]
        # A turn by sqrt(3) 1e-6 rad about the base moves a point by that times its distance.
        assert np.linalg.norm(H[:3, 3] - G[:3, 3]) <= 2e-6 * (1 + np.linalg.norm(H[:3, 3]))
        assert np.linalg.norm(pk.so3.log(H[:3, :3].T @ G[:3, :3])) <= 2e-6


def test_a_screw_that_points_the_other_way_turns_the_axis_and_not_the_link():
    robot = pk.load("ur5e")
    chain = robot.chain()
    A = chain.screws.copy()
    A[2] *= -1
    result = relinked(robot, pk.Chain.from_space(A, chain.home))
    assert result.joint("elbow_joint").axis == (0, 0, -1)
    before, after = robot.fk(np.zeros(6)), result.fk(np.zeros(6))
    assert max(np.abs(before[link] - after[link]).max() for link in robot.links) <= 1e-15
    q = np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6])
    assert np.abs(result.chain().fk(q) - chain.fk(q * [1, 1, -1, 1, 1, 1])).max() <= 1e-15


def test_the_first_joint_behind_the_last_moving_one_takes_up_the_rest():
    z = (0.0, 0.0, 1.0)
    shift = pk.se3.exp([0, 0, 0, 0.1, 0, 0])
    joints = [
        Joint("turn", "revolute", "base", "wrist", np.eye(4), z, (-1, 1)),
        Joint("mount", "fixed", "wrist", "flange", shift),
        Joint("tool", "fixed", "flange", "tip", shift),
    ]
    robot = Robot("r", ["base", "wrist", "flange", "tip"], joints)
    home = pk.se3.exp([0, 0, 0, 0.25, 0.01, 0])
    result = relinked(robot, pk.Chain.from_space([pk.screw.revolute(z, [0, 0, 0])], home))
    assert result.joint("tool") == robot.joint("tool")
    assert result.joint("mount").origin[:2, 3].tolist() == pytest.approx([0.15, 0.01], abs=1e-16)


def test_a_base_beside_the_branch_is_the_chain_s_frame():
    arm = pk.load("ur5e")
    half = pk.se3.exp([0, 0, math.pi, 0.2, 0, 0])
    links = ["world", "beside", *arm.links]
    joints = [
        Joint("up", "fixed", "world", "beside", half),
        Joint("on", "fixed", "world", "base", half),
        *arm.joints,
    ]
    robot = Robot("r", links, joints)
    other = pk.load("ur10e").chain()
    result = relinked(robot, other, base="beside", tip="tool0")
    q = np.full(6, 0.3)
    assert np.abs(result.chain("beside", "tool0").fk(q) - other.fk(q)).max() <= 1e-15
    assert result.joint("up") == robot.joint("up")
    assert result.joint("on") == robot.joint("on")


def test_a_base_two_fixed_joints_beside_the_branch_is_the_chain_s_frame():
    arm, other = pk.load("ur5e"), pk.load("ur10e").chain()
    joints = [
        Joint("up", "fixed", "near", "beside", pk.se3.exp([0.5, 0, 0, 0, 0, 0.2])),
        Joint("on", "fixed", arm.root, "near", pk.se3.exp([0, 0.5, 0, 0.1, 0, 0])),
        *arm.joints,
    ]
    robot = Robot("r", ["near", "beside", *arm.links], joints)
    result = relinked(robot, other, base="beside", tip="tool0")
    q = np.full(6, 0.3)
    found = result.chain("beside", "tool0").fk(q)
    np.testing.assert_allclose(found, other.fk(q), rtol=0, atol=3e-15)


def test_a_tip_that_its_joint_moves_itself_is_the_chain_s_tip_where_it_lies_on_the_axis():
    robot, z = pk.load("ur5e"), pk.load("ur5e").chain(tip="wrist_3_link")
    along = pk.se3.exp([0, 0, 0.1, 0, 0, 0.02])
    result = relinked(robot, z.retooled(along), tip="wrist_3_link")
    q = np.full(6, 0.3)
    assert np.abs(result.chain(tip="wrist_3_link").fk(q) - z.retooled(along).fk(q)).max() <= 1e-15


@pytest.mark.parametrize(
    ("tool", "words"),
    [([0, 0, 0, 0.02, 0, 0], "20 mm and 0°"), ([0.1, 0, 0, 0, 0, 0], r"0 mm and 5\.73°")],
)
def test_a_tip_off_the_axis_that_moves_it_is_a_new_link_and_the_old_one_stays_on_the_axis(
    tool, words
):
    robot, tip = pk.load("ur5e"), "wrist_3_link"
    chain = robot.chain(tip=tip).retooled(pk.se3.exp(tool))
    said = (
        rf"^link '{tip}' stays on the axis of joint 'wrist_3_joint', and the chain's tip is {words} "
        rf"from it: the tip is the new link '{tip}_tool', fixed to it$"
    )
    with pytest.warns(PoekinWarning, match=said):
        result = relinked(robot, chain, tip=tip)
    assert result.links == (*robot.links, f"{tip}_tool")
    assert result.joints[-1].name == f"{tip}_tool_joint"
    q = np.full(6, 0.3)
    # two products of eight poses of an arm of 1.2 m
    assert np.abs(result.chain(tip=f"{tip}_tool").fk(q) - chain.fk(q)).max() <= 2e-15
    for a, b in zip(robot.joints, result.joints, strict=False):
        assert a.axis == b.axis
        assert np.abs(a.origin - b.origin).max() <= 1e-15


@pytest.mark.parametrize("twist", [[1e-10, 0, 0, 0, 0, 0], [0, 0, 0, 0, 1e-10, 0]])
def test_a_tip_off_its_axis_by_rounding_alone_is_no_tool(twist):
    robot, tip = pk.load("ur5e"), "wrist_3_link"
    chain = robot.chain(tip=tip)
    with pytest.warns(PoekinWarning, match="wrist_3_link_tool"):
        relinked(robot, chain.retooled(pk.se3.exp(twist)), tip=tip)
    rounded = chain.retooled(pk.se3.exp(np.multiply(twist, 0.05)))
    assert relinked(robot, rounded, tip=tip).links == robot.links


def test_the_tool_link_has_a_name_of_its_own():
    z = (0.0, 0.0, 1.0)
    joints = [
        Joint("turn", "revolute", "base", "arm", np.eye(4), z),
        Joint("arm_tool_joint", "fixed", "base", "arm_tool"),
    ]
    robot = Robot("r", ["base", "arm", "arm_tool"], joints)
    chain = robot.chain(tip="arm").retooled(pk.se3.exp([0, 0, 0, 0.1, 0, 0]))
    with pytest.warns(PoekinWarning, match="'arm_tool_'"):
        result = relinked(robot, chain, tip="arm")
    assert result.links[-1] == "arm_tool_"
    assert result.joints[-1].name == "arm_tool__joint"


@given(case=cases(mimics=False), data=st.data())
def test_another_number_or_kind_of_joints_is_refused(case, data):
    robot, chain = case
    n = len(chain.kinds)
    keep = data.draw(st.integers(0, n - 1))
    shorter = pk.Chain.from_space(chain.screws[:keep], chain.home)
    with pytest.raises(
        InputError, match=rf"has {n} joints from 'l0' to 'tip': 'j\d+'.*; the chain has {keep}: "
    ):
        relinked(robot, shorter, base="l0", tip="tip")
    i = data.draw(st.integers(0, n - 1))
    assume(chain.kinds[i] != "prismatic")
    A = chain.screws.copy()
    A[i] = [0, 0, 0, 0, 0, 1]
    name = chain.joint_names[i]
    with pytest.raises(
        InputError,
        match=rf"joint '{name}' of the robot is \w+, and '{name}' of the chain is prismatic",
    ):
        relinked(
            robot,
            pk.Chain.from_space(A, chain.home, joint_names=chain.joint_names),
            base="l0",
            tip="tip",
        )


UR5E = pk.load("ur5e")
SIX = UR5E.chain()
ANY_CHAIN: Any = SIX
ANY_ROBOT: Any = UR5E
BACK = SIX.joint_names[::-1]
COUPLED = pk.Chain.from_space(SIX.screws, SIX.home, coupling=np.eye(6) * 2, q_names=SIX.q_names)
FLOATING = Robot("r", ["a", "b"], [Joint("free", "floating", "a", "b")])


@pytest.mark.parametrize(
    ("make", "error", "message"),
    [
        (
            lambda: relinked(ANY_CHAIN, SIX),
            InputError,
            "relinked: expected a Robot and a Chain, got Chain and Chain",
        ),
        (
            lambda: relinked(ANY_CHAIN, ANY_ROBOT),
            InputError,
            "relinked: expected a Robot and a Chain, got Chain and Robot",
        ),
        (
            lambda: relinked(UR5E, ANY_ROBOT),
            InputError,
            "relinked: expected a Robot and a Chain, got Robot and Robot",
        ),
        (
            lambda: relinked(UR5E, SIX, turn=ANY_ROBOT.name),
            InputError,
            "turn: expected 'auto', 'frames' or 'axes', got 'ur5e'",
        ),
        (
            lambda: relinked(UR5E, SIX, tip="tool"),
            UnknownName,
            "catalogue/ur5e.urdf: no tip link 'tool'; did you mean 'tool0'?",
        ),
        (
            lambda: relinked(UR5E, pk.Chain.from_space(SIX.screws, SIX.home, joint_names=BACK)),
            InputError,
            (
                "the joints come in another order: the robot's are 'shoulder_pan_joint', "
                "'shoulder_lift_joint', 'elbow_joint', 'wrist_1_joint', 'wrist_2_joint', "
                "'wrist_3_joint', the chain's 'wrist_3_joint', 'wrist_2_joint', 'wrist_1_joint', "
                "'elbow_joint', 'shoulder_lift_joint', 'shoulder_pan_joint'"
            ),
        ),
        (
            lambda: relinked(UR5E, COUPLED),
            InputError,
            (
                "the chain's joints follow its coordinates otherwise than the robot's: x = C q + c differs"
            ),
        ),
        (
            lambda: relinked(FLOATING, SIX),
            ModelError,
            (
                "robot 'r': the way from 'a' to 'b' crosses the floating joint 'free'; a chain cannot"
            ),
        ),
        (
            lambda: relinked(UR5E, UR5E.chain("tool0", "base"), base="tool0", tip="base"),
            InputError,
            "joint 'wrist_3_joint' lies between 'tool0' and the root: choose a base above it",
        ),
        (
            lambda: relinked(UR5E, pk.Chain.from_space([], np.eye(4)), base="wrist_3_link"),
            InputError,
            "no joint moves between 'wrist_3_link' and 'tool0'",
        ),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_what_cannot_be_relinked_is_refused_by_name(make, error, message):
    with pytest.raises(PoekinError) as caught:
        make()
    assert isinstance(caught.value, error)
    assert str(caught.value) == message


def test_a_calibrated_arm_as_urdf_keeps_its_links():
    robot = pk.load("ur5e")
    chain = robot.chain()
    tilts = np.random.default_rng(0).normal(scale=1e-3, size=(6, 6))
    A = np.array(
        [pk.se3.adjoint(pk.se3.exp(t)) @ S for t, S in zip(tilts, chain.screws, strict=True)]
    )
    text = pk.to_urdf(
        relinked(robot, pk.Chain.from_space(A, chain.home, joint_names=chain.joint_names))
    )
    assert text.count('lower="-6.283185307179586"') == 6
    assert all(f'<link name="{link}"/>' in text for link in robot.links)


def test_a_chain_put_on_again_moves_the_tool_link_that_is_there():
    robot, tip = pk.load("ur5e"), "wrist_3_link"
    chain = robot.chain(tip=tip).retooled(pk.se3.exp([0, 0, 0, 0.02, 0, 0]))
    further = chain.retooled(pk.se3.exp([0, 0.1, 0, 0.01, 0, 0]))
    with pytest.warns(PoekinWarning, match=f"the tip is the new link '{tip}_tool'"):
        once = relinked(robot, chain, tip=tip)
    with pytest.warns(
        PoekinWarning, match=f"the tip is the link '{tip}_tool', fixed to it already, and moved"
    ):
        twice = relinked(once, further, tip=tip)
    assert (twice.links, len(twice.joints)) == (once.links, len(once.joints))
    q = np.full(6, 0.3)
    # two products of eight poses of an arm of 1.2 m
    assert np.abs(twice.chain(tip=f"{tip}_tool").fk(q) - further.fk(q)).max() <= 2e-15


@pytest.mark.parametrize("change", ["parent", "kind", "name", "leaf"])
def test_another_link_of_the_tool_s_name_stays_where_it_is(change):
    own: dict[str, Any] = {
        "name": "arm_tool_joint",
        "kind": "fixed",
        "parent": "arm",
        "child": "arm_tool",
    }
    own |= {
        "parent": {"parent": "base"},
        "kind": {"kind": "revolute"},
        "name": {"name": "grip"},
    }.get(change, {})
    joints = [Joint("turn", "revolute", "base", "arm", axis=(0, 0, 1)), Joint(**own)]
    links = ["base", "arm", "arm_tool"]
    if change == "leaf":
        joints.append(Joint("finger_joint", "fixed", "arm_tool", "finger"))
        links.append("finger")
    robot = Robot("r", links, joints)
    chain = robot.chain(tip="arm").retooled(pk.se3.exp([0, 0, 0, 0.1, 0, 0]))
    with pytest.warns(PoekinWarning, match="the new link 'arm_tool_'"):
        result = relinked(robot, chain, tip="arm")
    assert result.joint(own["name"]) == robot.joint(own["name"])
    assert result.links == (*robot.links, "arm_tool_")
