"""Robots with the screws of a chain and, as nearly as may be, their own link frames."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..errors import InputError, join_names, quote
from ..groups import se3, so3
from ..groups.arrays import Array
from ..model.chain import Chain
from ..model.joint import Joint
from ..model.provenance import Source
from ..model.robot import Robot
from ..model.tree.tree import path, tree_of

ON_AXIS = 1e-11
"""Distance [rad, and in reaches] of a tip from the axis that moves it, below which it is rounding."""


def relinked(
    robot: Robot,
    chain: Chain,
    *,
    base: str | None = None,
    tip: str | None = None,
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
        screws and home pose at the robot's zero. Its coordinates are its joints, x = q, or coupled
        as the branch is.
    base, tip : str, optional
        Links at which the branch begins and ends, as in `Robot.chain`.

    Returns
    -------
    robot : Robot
        Robot with new joint origins along the branch.

    Raises
    ------
    InputError
        If the numbers, kinds or order of the joints differ, or the coupling does; if a moving joint
        is passed from child to parent, or there is no joint at all; if the tip is fixed to nothing
        and off its joint's axis.
    UnknownName
        If there is no link of that name.
    ModelError
        If base or tip must be named.

    Notes
    -----
    At x = 0 the origin of a link is the point of the new axis nearest to the nominal origin (the
    nominal origin itself where the joint is prismatic), and its axes are the nominal ones turned by
    the smallest angle that makes the joint's axis right. A joint whose new screw points the other
    way has its axis reversed in place of its link. What the last joint moves is fixed to its link
    up to the tip: the first of these fixed joints takes up the rest, and where there is none, the
    tip's frame is the chain's own.

    Accuracy: that of `Chain.fk` for either, and 24 u n (1 + sum |x|) of both reaches, u = 2^-53, n
    the joints of the branch with the fixed ones; 1e-11 more where the tip is fixed to nothing. A
    frame moves by the distance [m] between nominal origin and new axis, and turns by the angle
    [rad] between the axes, whatever a DH table of the same arm looks like
    (tests/formats/test_relink.py). Source: the point of a line nearest to another, and so3.exp.

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
    nominal = robot.chain(base, tip)
    _check_alike(nominal, chain)
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
    origins = _origins([robot.joints[number] for number in down], chain.rebased(P))
    joints = list(robot.joints)
    for number, joint in zip(down, origins, strict=True):
        joints[number] = joint
    return Robot(robot.name, robot.links, joints, robot.source)


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
    free = uncoupled and not chain.offset.any()
    coupled_alike = np.array_equal(chain.coupling, nominal.coupling)
    same = coupled_alike and np.array_equal(chain.offset, nominal.offset)
    if not (free or same):
        raise InputError(
            "the chain's joints follow its coordinates otherwise than the robot's: x = C q + c differs"
        )


def _origins(joints: Sequence[Joint], chain: Chain) -> list[Joint]:
    """Joints of a way down the tree with new origins: in the top link they move as the chain does.

    H and G are the poses of a link in the top link's frame at x = 0: the nominal one and the new
    one.
    """
    moving = (k for k, joint in enumerate(joints) if joint.kind != "fixed")
    last = max(moving)
    H = G = np.eye(4)
    result: list[Joint] = []
    i = 0
    for k, joint in enumerate(joints):
        H = H @ joint.origin
        above = G
        if joint.kind == "fixed":
            G = G @ joint.origin
            if k == last + 1:
                behind = np.eye(4)
                for other in joints[k + 1 :]:
                    behind = behind @ other.origin
                G = chain.home @ se3.inverse(behind)
                joint = replace(joint, origin=se3.inverse(above) @ G)
        else:
            at_tip = k == last == len(joints) - 1
            joint, G = _moved(joint, H, chain, i, at_tip)
            joint = replace(joint, origin=se3.inverse(above) @ G)
            i += 1
        result.append(joint)
    return result


def _moved(
    joint: Joint,
    H: Array,
    chain: Chain,
    i: int,
    at_tip: bool,
) -> tuple[Joint, Array]:
    """Joint i of the chain and the pose of the link that it moves, which is the tip if `at_tip`."""
    screw = chain.screws[i]
    turns = chain.local.rotates[i] != 0
    w = screw[:3] if turns else screw[3:]
    G = (chain.home if at_tip else H).copy()
    z = G[:3, :3] @ joint.axis
    if z @ w < 0:
        joint = replace(joint, axis=tuple(-a for a in joint.axis))
        z = -z
    if turns:
        joint = replace(joint, pitch=float(chain.local.slides[i]))
        foot = np.cross(w, screw[3:])
        along = w @ (G[:3, 3] - foot)
        G[:3, 3] = foot + w * along
    off = np.cross(z, w)
    sine = float(np.linalg.norm(off))
    if at_tip:
        apart = float(np.linalg.norm(G[:3, 3] - chain.home[:3, 3]))
        if max(sine, apart / chain.reach) > ON_AXIS:
            raise InputError(
                f"link {quote(joint.child)} is the tip and what joint {quote(joint.name)} moves, and the chain's tip is"
                f" off that joint's axis, by {apart * 1e3:.3g} mm and {math.degrees(math.asin(min(sine, 1.0))):.3g}°:"
                " the tip must be a link that is fixed to it"
            )
        return joint, chain.home
    if sine:
        angle = math.atan2(sine, float(z @ w))
        turn = so3.exp(off / sine * angle)
        G[:3, :3] = turn @ G[:3, :3]
    return joint, G
