"""Kinematics of a page: poses of links and Jacobians of tips, as the text of a JavaScript module."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from ..algebra import IDENTITY
from ..engine.straight_line.program import Program
from ..engine.straight_line.tree import TracedTree, tree_program
from ..formats.emit.javascript import links_task, module
from ..formats.emit.messages import EmittedFunction
from ..groups import se3
from ..model.chain import Chain
from ..model.joint import FREE
from ..model.robot import Robot
from .scene import SceneTip

MOST_TIPS = 12
"""Tips of a page, beyond those that are asked for."""

Model = Robot | Chain
_LINES = (
    "links(q): poses of the links in the base frame, 4 x 4 row by row, one after the other.",
    "tips[k].fk_jacobian(q): pose T of a tip and its hybrid Jacobian J, axes of the base, v of the",
    "origin of the tip; a column for each coordinate that moves it.",
)


def page_tips(model: Model, names: Iterable[str] = ()) -> tuple[SceneTip, ...]:
    """Tips of a page: those asked for by the names of their links, then `default_tips`; of a chain
    its own. Raises: UnknownName for a name that is no link.
    """
    if isinstance(model, Chain):
        every = tuple(range(model.dof))
        return (SceneTip(model.tip, len(model.kinds), every, model.reach),)
    tips = []
    for name in dict.fromkeys((*names, *default_tips(model))):
        chain = tip_chain(model, name)
        moving = tuple(map(model.q_names.index, chain.q_names))
        body = model.links.index(name)
        tips.append(SceneTip(name, body, moving, chain.reach))
    return tuple(tips)


def default_tips(robot: Robot) -> tuple[str, ...]:
    """Links whose Jacobian a page shows, at most `MOST_TIPS`.

    First the last link that carries all leaves, where something moves it: what a gripper's fingers
    are on. Then leaves; of those that the same joint moves, the one below most joints stands for
    all. Each next leaf is the one that most coordinates move which move no tip before it, of
    several the one that most coordinates move. Leaves that no joint moves are left out, unless
    there are no others.
    """
    held = fix_free_joints(robot)
    above = {joint.child: joint.parent for joint in robot.joints}
    depths = {link: len(_way(link, above)) for link in robot.links}
    last: dict[str, Chain] = {}
    for leaf in robot.leaves:
        chain = held.chain(tip=leaf)
        moved_by = chain.joint_names[-1] if chain.joint_names else ""
        other = last.setdefault(moved_by, chain)
        if depths[leaf] > depths[other.tip]:
            last[moved_by] = chain
    last = {name: chain for name, chain in last.items() if name} or last
    left = list(last.values())
    chosen: list[str] = []
    moving: set[str] = set()
    carrier = held.chain(tip=_carrier(last.values(), above))
    if len(left) > 1 and carrier.dof:
        chosen.append(carrier.tip)
        moving.update(carrier.q_names)
    while left and len(chosen) < MOST_TIPS:
        best = max(left, key=lambda chain: (len({*chain.q_names} - moving), chain.dof))
        left.remove(best)
        chosen.append(best.tip)
        moving.update(best.q_names)
    return tuple(chosen)


def _carrier(chains: Iterable[Chain], above: dict[str, str]) -> str:
    """The last link on the ways from the root to the tips of all of these."""
    ways = [_way(chain.tip, above) for chain in chains]
    shared = set(ways[0]).intersection(*ways)
    return next(link for link in ways[0] if link in shared)


def _way(link: str, above: dict[str, str]) -> list[str]:
    """A link, and all that it hangs on."""
    way = [link]
    while way[-1] in above:
        way.append(above[way[-1]])
    return way


def kinematics(model: Model, tips: Iterable[SceneTip]) -> str:
    """Text of a module that exports links(q) and tips, of q with all coordinates of the model.

    Notes
    -----
    links(q): a robot's as `Robot.fk`, floating and planar joints at their zero pose; of a chain of
    n joints n + 1 bodies, each by its displacement from where it is at q = 0, in the base frame.
    Accuracy: that of `pk.emit.javascript` (tests/view/test_kinematics.py).
    """
    tips = tuple(tips)
    if isinstance(model, Chain):
        bodies = len(model.kinds) + 1
        links = EmittedFunction("link_poses", bodies, False, _body_program(model))
    else:
        links = links_task(model)
    chains = (tip_chain(model, tip.name).compile() for tip in tips)
    tasks = [
        EmittedFunction(f"tip{k}", 1, True, chain.program("hybrid", pose=True))
        for k, chain in enumerate(chains)
    ]
    text = module("an arm of a page", [links, *tasks], _LINES, "")
    return f"{text}\nexport const links = (q) => link_poses(q);\n\n{_tips(tips)}"


def _tips(tips: Iterable[SceneTip]) -> str:
    """The tips, each with a function that picks its coordinates."""
    lines = []
    for k, tip in enumerate(tips):
        picked = ", ".join(f"q[{i}]" for i in tip.coordinates)
        lines.append(f"    {{ fk_jacobian: (q) => tip{k}([{picked}]) }},")
    return "\n".join(["export const tips = [", *lines, "];", ""])


def tip_chain(model: Model, name: str) -> Chain:
    """Chain from the root to a link, floating and planar joints at their zero pose; a chain itself."""
    if isinstance(model, Chain):
        return model
    return fix_free_joints(model).chain(tip=name)


def fix_free_joints(robot: Robot) -> Robot:
    """The robot with its floating and planar joints fixed at their zero pose, so that chains cross
    them.
    """
    if not any(joint.kind in FREE for joint in robot.joints):
        return robot
    joints = list(robot.joints)
    for k, joint in enumerate(joints):
        if joint.kind in FREE:
            joints[k] = replace(joint, kind="fixed")
    return Robot(robot.name, robot.links, joints, robot.source, robot.coupling)


def _body_program(chain: Chain) -> Program:
    """Program of the displacements of n + 1 bodies, e^{A_1 y_1} ... e^{A_k y_k} with y = C q and the
    screws at q = 0.
    """
    n = len(chain.kinds)
    S = np.zeros((n, 6, 1))
    S[:, 2, 0] = chain.local.rotates
    S[:, 5, 0] = chain.local.slides
    bodies = chain.joint_poses(np.zeros(chain.dof))
    A = se3.adjoint(bodies) @ S
    C = chain.coupling.tolist()
    screws = A[..., 0].tolist()
    tree = TracedTree(range(n), [IDENTITY] * n, screws, C, [0.0] * n)
    return tree_program(tree, range(n + 1))
