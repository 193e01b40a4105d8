"""Robotics Toolbox's elementary transforms: an ETS as a chain, a Robot (ERobot) whose links have
one each as a tree.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from ...errors import InputError, safe_repr
from ...groups import se3
from ...groups.arrays import Array, shaped
from ...model.chain import Chain
from ...model.checks import one_pose
from ...model.joint import Joint, Mimic
from ...model.robot import Robot
from .attributes import as_list, free_name, has

_ET = ("isjoint", "axis", "A")
# Those of space; planar ones (ET2) have other names.
_AXES = ("Rx", "Ry", "Rz", "tx", "ty", "tz")


class Step(NamedTuple):
    """A joint of a sequence: pose of its frame behind the joint before it, kind, screw in that
    frame, coordinate.
    """

    origin: Array
    kind: str
    screw: Array
    coordinate: int
    limits: tuple[float, float]


def fits(obj: Any) -> bool:
    """Whether an object is a sequence of elementary transforms, or one of them."""
    items = [obj] if has(obj, *_ET) else as_list(obj)
    return bool(items) and all(has(item, *_ET) for item in items)


def fits_tree(obj: Any) -> bool:
    """Whether an object has links with a name, a parent and a sequence of elementary transforms
    each.
    """
    links = as_list(getattr(obj, "links", None))
    return bool(links) and all(has(link, "ets", "parent", "name") for link in links)


def make_chain(ets: Any) -> Chain:
    """The chain of an ETS (or of one ET): the product of its constant and variable elementary
    transforms.

    Coordinates are q0, q1, ... in the order of `jindex`, which is the toolbox's own order of q;
    joints of the same `jindex` move together. A flipped joint turns by -q; an offset is added after
    that. Limits are those of `qlim`.

    Parameters: ets. Returns: Chain, joints joint1, joint2, ...
    Raises: InputError with the number of the transform for a planar one, a symbol in place of a
    number, or limits that leave nothing; ShapeError, PoseError for a constant that is no pose.
    Accuracy: rounding of the product, 1e-16 reach a transform. Source: the toolbox's documentation
    of ET and ETS.
    """
    steps, last = _steps([ets] if has(ets, *_ET) else as_list(ets), "ETS")
    screws, T = np.empty((len(steps), 6)), np.eye(4)
    for i, step in enumerate(steps):
        T = T @ step.origin
        screws[i] = se3.adjoint(T) @ step.screw
    used = sorted({step.coordinate for step in steps})
    C = np.array([[float(step.coordinate == k) for k in used] for step in steps]).reshape(
        len(steps), len(used)
    )
    return Chain(
        screws,
        T @ last,
        coupling=C,
        q_names=[f"q{k}" for k in used],
        limits=[_shared(steps, k) for k in used] if used else None,
        pitches=np.zeros(len(steps)),
    )


def make_robot(robot: Any) -> Robot:
    """The tree of a toolbox Robot (ERobot): its links, and a joint for each variable transform of a
    link.

    Coordinates, and the joints that have them, are q0, q1, ... by `jindex`. The root is `base`, in
    which the robot's own `base` places the first links. Where the robot has a `tool`, each link at
    an end carries one, LINK_tool. A gripper is a robot of its own there, and not taken.

    Parameters: robot. Returns: Robot. Raises and accuracy: as `make_chain`; ModelError for links that
    are no tree.
    """
    taken: set[str] = set()
    root = free_name("base", {str(link.name) for link in robot.links})
    names = {id(link): free_name(str(link.name) or "link", taken) for link in robot.links}
    taken.add(root)
    base = _pose(getattr(robot, "base", None), "base")
    tool = _pose(getattr(robot, "tool", None), "tool")
    joints: list[Joint] = []
    links = [root, *names.values()]
    steps_of = {
        id(link): _steps(as_list(link.ets), f"link {safe_repr(link.name)}") for link in robot.links
    }
    used: set[str] = set()
    order: list[tuple[int, Joint]] = []
    for link in robot.links:
        steps, last = steps_of[id(link)]
        parent = root if link.parent is None else names.get(id(link.parent), str(link.parent))
        before = base if link.parent is None else np.eye(4)
        for i, step in enumerate(steps):
            ends = i == len(steps) - 1 and np.array_equal(last, np.eye(4))
            child = names[id(link)] if ends else free_name(f"{names[id(link)]}_{i}", taken)
            links += [] if ends else [child]
            name = free_name(f"q{step.coordinate}", used)
            mimic = Mimic(f"q{step.coordinate}") if name != f"q{step.coordinate}" else None
            axis = step.screw[:3] if step.kind == "revolute" else step.screw[3:]
            joint = Joint(
                name, step.kind, parent, child, before @ step.origin, axis, step.limits, mimic
            )
            order.append((step.coordinate, joint))
            parent, before = child, np.eye(4)
        if parent != names[id(link)]:
            name = free_name(f"{names[id(link)]}_joint", used)
            joints.append(Joint(name, "fixed", parent, names[id(link)], before @ last))
    joints = [joint for _, joint in sorted(order, key=lambda pair: pair[0])] + joints
    if not np.array_equal(tool, np.eye(4)):
        for end in sorted(
            set(names.values()) - {joint.parent for joint in joints}, key=links.index
        ):
            links.append(free_name(f"{end}_tool", taken))
            joints.append(
                Joint(free_name(f"{end}_tool_joint", used), "fixed", end, links[-1], tool)
            )
    return Robot(str(getattr(robot, "name", "") or "robot"), links, joints)


def _steps(items: list[Any], what: str) -> tuple[list[Step], Array]:
    """The joints of a sequence, and the constant pose behind the last one."""
    steps: list[Step] = []
    T = np.eye(4)
    for i, et in enumerate(items):
        where = f"{what}, transform {i}"
        if not et.isjoint:
            T = T @ one_pose(et.A(), where)
            continue
        axis = str(et.axis)
        if axis not in _AXES:
            raise InputError(f"{where}: expected one of {', '.join(_AXES)}, got {safe_repr(axis)}")
        screw = np.eye(6)[_AXES.index(axis)]
        offset = float(shaped(getattr(et, "offset", 0.0), (), f"{where}: offset"))
        if offset:
            T = T @ se3.exp(offset * screw)
        jindex = getattr(et, "jindex", None)
        steps.append(
            Step(
                T,
                "revolute" if axis[0] == "R" else "prismatic",
                -screw if getattr(et, "isflip", False) else screw,
                len(steps) if jindex is None else int(jindex),
                _limits(getattr(et, "qlim", None)),
            )
        )
        T = np.eye(4)
    return steps, T


def _limits(qlim: Any) -> tuple[float, float]:
    if qlim is None:
        return -math.inf, math.inf
    lower, upper = qlim
    return float(lower), float(upper)


def _shared(steps: list[Step], coordinate: int) -> tuple[float, float]:
    """What is left of the limits of the joints that move together."""
    limits = [step.limits for step in steps if step.coordinate == coordinate]
    return max(lower for lower, _ in limits), min(upper for _, upper in limits)


def _pose(T: Any, what: str) -> Array:
    return np.eye(4) if T is None else one_pose(T, what)
