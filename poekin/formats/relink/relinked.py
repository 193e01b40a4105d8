"""Robots with the screws of a chain and, as nearly as may be, their own link frames."""

from __future__ import annotations

import math
from typing import get_args

import numpy as np

from ...checks import choice
from ...errors import InputError, join_names, quote
from ...groups import so3
from ...groups.arrays import Array
from ...groups.vectors import rotation_part, translation_part
from ...model.chain import Chain
from ...model.joint import Joint
from ...model.provenance import Source, warn
from ...model.readings.coupled import own_readings
from ...model.readings.statements import make_statements
from ...model.robot import Robot
from ...model.tree.tree import path, tree_of
from ..common.names import free_name
from .branch import Turn, branch_of


def relinked(
    robot: Robot,
    chain: Chain,
    *,
    base: str | None = None,
    tip: str | None = None,
    turn: Turn = "auto",
) -> Robot:
    """Robot whose branch from base to tip has the kinematics of a chain: f(q) is the same.

    A calibrated arm comes as screws and a home pose, and whoever draws it or plans with it has
    nominal links: meshes, masses, sensors on brackets. So each link that a joint moves keeps its
    frame as nearly as the joint lets it. All other joints, and the links that hang off the branch,
    stay as they are relative to their parent link. Names, kinds, limits and mimic are the robot's.

    Parameters
    ----------
    robot : Robot
        Nominal robot.
    chain : Chain
        Chain from the frame of base to the frame of tip, with the branch's joints in its order and
        screws and home pose at the robot's zero. Its coordinates are its joints, x = q, or their
        coupled readings, or coupled as the branch is.
    base, tip : str, optional
        Links at which the branch begins and ends, as in `Robot.chain`.
    turn : {"auto", "frames", "axes"}, default "auto"
        Part of a joint that follows a tilted axis: the frame of the link that it moves, so that the
        axis keeps its numbers in it, or the axis in the frame, so that roll, pitch and yaw of the
        origin keep theirs. "auto" is "frames", but "axes" where these are within 0.05 rad of gimbal
        lock, at which a small turn would change roll and yaw by any amount.

    Returns
    -------
    robot : Robot
        Robot with new joint origins along the branch. Where the tip is the link that the last joint
        moves, and the chain's tip is off that joint's axis, there is a new link "TIP_tool", fixed
        to it by the joint "TIP_tool_joint", which is the chain's tip. Where there is such a leaf
        already, as an earlier chain left it, it is moved to the chain's tip.

    Raises
    ------
    InputError
        If the numbers, kinds or order of the joints differ, or the coupling does; if a moving joint
        is passed from child to parent, or there is no joint at all; if `turn` is none of the three.
    UnknownName
        If there is no link of that name.
    ModelError
        If base or tip must be named.

    Warns
    -----
    PoekinWarning
        If a tool link is added or moved, with its name; if the chain's readings are coupled and the
        robot's are not.

    Notes
    -----
    At x = 0 the origin of a link is the point of the new axis nearest to the nominal origin (the
    nominal origin itself where the joint is prismatic), and its axes are the nominal ones turned by
    the smallest angle that makes the joint's axis right; or, where the axis turns in the frame, as
    they were in the link before it. A joint whose new screw points the other way has its axis
    reversed in place of its link. What the last joint moves is fixed to its link up to the tip: the
    first of these fixed joints takes up the rest, and where there is none, the new one to the tool.
    A frame of URDF lies on its joint's axis, so the tip cannot take it up itself: its visuals stay
    where the axis is.

    Accuracy: that of `Chain.fk` for either, and 24 u n (1 + sum |x|) of both reaches, u = 2^-53, n
    the joints of the branch with the fixed ones; 1e-11 more where no link was added to the tip. A
    frame moves by the distance [m] between nominal origin and new axis, and turns by the angle
    [rad] between the axes, whatever a DH table of the same arm looks like
    (tests/formats/relink). Source: the point of a line nearest to another, and so3.exp.

    Examples
    --------
    >>> import numpy as np
    >>> import poekin as pk
    >>> robot = pk.load("ur5e")
    >>> arm = robot.chain()
    >>> shift = np.eye(4)
    >>> shift[2, 3] = 0.001
    >>> calibrated = pk.relinked(robot, arm.rebased(shift))
    >>> float(np.round(calibrated.chain().home[2, 3] - arm.home[2, 3], 9))
    0.001
    """
    if not isinstance(robot, Robot) or not isinstance(chain, Chain):
        raise InputError(
            f"relinked: expected a Robot and a Chain, got {type(robot).__name__} and {type(chain).__name__}"
        )
    choice(turn, get_args(Turn), "turn")
    nominal = robot.chain(base, tip)
    _check_alike(nominal, chain)
    if statements := _coupling_to_drop(nominal, chain):
        warn(
            f"robot {quote(robot.name)}: its joints keep their own values, without the coupling of "
            f"the chain's readings: {'; '.join(statements)}"
        )
    tree = tree_of(robot.links, robot.joints, robot.source or Source(robot.name))
    way = path(tree, robot.links.index(nominal.base), robot.links.index(nominal.tip))
    P = np.eye(4)
    down = []
    for number, forward in way:
        joint = robot.joints[number]
        if forward:
            down.append(number)
        elif joint.kind == "fixed":
            P = joint.origin @ P
        else:
            raise InputError(
                f"joint {quote(joint.name)} lies between {quote(nominal.base)} and the root: choose a base above it"
            )
    branch = branch_of([robot.joints[number] for number in down], chain.rebased(P), turn)
    links = list(robot.links)
    joints = list(robot.joints)
    for number, joint in zip(down, branch.joints, strict=True):
        joints[number] = joint
    if branch.tool is not None:
        tool = _tool(robot, joints[down[-1]], branch.tool)
        links = list(dict.fromkeys((*links, tool.child)))
        joints = list({joint.name: joint for joint in (*joints, tool)}.values())
    return Robot(robot.name, links, joints, robot.source, robot.coupling, robot.masses)


def _check_alike(nominal: Chain, chain: Chain) -> None:
    """Check that the chain can be put in the place of the nominal one."""
    mine = nominal.joint_names
    theirs = chain.joint_names
    if len(mine) != len(theirs):
        raise InputError(
            f"the robot has {len(mine)} joints from {quote(nominal.base)} to {quote(nominal.tip)}: {join_names(mine)};"
            f" the chain has {len(theirs)}: {join_names(theirs)}"
        )
    if not mine:
        raise InputError(f"no joint moves between {quote(nominal.base)} and {quote(nominal.tip)}")
    if mine != theirs and set(mine) == set(theirs):
        raise InputError(
            f"the joints come in another order: the robot's are {join_names(mine)}, the chain's {join_names(theirs)}"
        )
    for a, b, kind, other in zip(mine, theirs, nominal.kinds, chain.kinds, strict=True):
        if kind != other:
            raise InputError(
                f"joint {quote(a)} of the robot is {kind}, and {quote(b)} of the chain is {other}"
            )
    uncoupled = np.array_equal(chain.coupling, np.eye(len(mine)))
    readings = _coupling_to_drop(nominal, chain)
    free = (uncoupled or readings) and not chain.offset.any()
    coupled_alike = np.array_equal(chain.coupling, nominal.coupling)
    same = coupled_alike and np.array_equal(chain.offset, nominal.offset)
    if not (free or same):
        raise InputError(
            "the chain's joints follow its coordinates otherwise than the robot's: x = C q + c differs"
        )


def _coupling_to_drop(nominal: Chain, chain: Chain) -> tuple[str, ...]:
    """Coupling of the chain's readings where the robot's joints have their own values."""
    readings = own_readings(chain)
    if readings is None or own_readings(nominal) is not None:
        return ()
    return make_statements(readings, chain.joint_names)


def _tool(robot: Robot, last: Joint, origin: Array) -> Joint:
    """The fixed joint that holds the chain's tip, off the axis of the last joint. Warns of it."""
    link = f"{last.child}_tool"
    name = f"{link}_joint"
    new, moved = "", " already, and moved there"
    held = {(j.name, j.kind, j.parent, j.child) for j in robot.joints if j.child in robot.leaves}
    if (name, "fixed", last.child, link) not in held:  # by an earlier chain
        link = free_name(link, set(robot.links))
        name = free_name(f"{link}_joint", {joint.name for joint in robot.joints})
        new, moved = "new ", ""
    warn(
        f"link {quote(last.child)} stays on the axis of joint {quote(last.name)}, and the chain's tip is"
        f" {np.linalg.norm(translation_part(origin)) * 1e3:.3g} mm and"
        f" {math.degrees(np.linalg.norm(so3.log(rotation_part(origin)))):.3g}° from it: the tip is the {new}link"
        f" {quote(link)}, fixed to it{moved}"
    )
    return Joint(name, "fixed", last.child, link, origin)
