"""Robotics Toolbox's elementary transforms: an ETS as a chain, a Robot (ERobot) as a tree."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ...errors import InputError, safe_repr
from ...groups import se3
from ...groups.arrays import Array, shaped
from ...groups.vectors import angular_part, linear_part
from ...model.chain import Chain
from ...model.checks import one_pose
from ...model.joint import Joint, JointKind, Mimic
from ...model.robot import Robot
from ..common.limits import UNBOUNDED, Interval
from ..common.names import free_name
from .attributes import as_list, has

_ET = ("isjoint", "axis", "A")
# Those of space; planar ones (ET2) have other names.
_KINDS: dict[str, JointKind] = {"R": "revolute", "t": "prismatic"}
_AXES = ("Rx", "Ry", "Rz", "tx", "ty", "tz")


class SequenceJoint(NamedTuple):
    """Joint of a sequence: pose of its frame behind the joint before, kind, screw, coordinate."""

    origin: Array
    kind: JointKind
    screw: Array
    coordinate: int
    limits: Interval


def fits(obj: Any) -> bool:
    """Whether an object is a sequence of elementary transforms, or one of them."""
    items = _items(obj)
    return bool(items) and all(has(item, *_ET) for item in items)


def _items(ets: Any) -> list[Any]:
    """The transforms of a sequence; of one transform, itself."""
    return [ets] if has(ets, *_ET) else as_list(ets)


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
    steps, last = _steps(_items(ets), "ETS")
    screws = np.empty((len(steps), 6))
    T = np.eye(4)
    for i, step in enumerate(steps):
        T = T @ step.origin
        screws[i] = se3.adjoint(T) @ step.screw
    used = sorted({step.coordinate for step in steps})
    rows = [[float(step.coordinate == k) for k in used] for step in steps]
    C = np.array(rows).reshape(len(steps), len(used))
    return Chain.from_space(
        screws,
        T @ last,
        coupling=C,
        q_names=[f"q{k}" for k in used],
        limits=[_shared(steps, k) for k in used] or None,
        pitches=np.zeros(len(steps)),
    )


def make_robot(robot: Any) -> Robot:
    """Tree of a toolbox Robot (ERobot): its links, and a joint for each variable transform.

    Coordinates, and the joints that have them, are q0, q1, ... by `jindex`. The root is `base`, in
    which the robot's own `base` places the first links. Where the robot has a `tool`, each link at
    an end carries one, LINK_tool. A gripper is a robot of its own there, and not taken.

    Parameters: robot. Returns: Robot. Raises and accuracy: as `make_chain`; ModelError for links that
    are no tree.
    """
    tree = _Tree(robot)
    tool = _pose(getattr(robot, "tool", None), "tool")
    for link in robot.links:
        tree.add_link(link)
    in_order = sorted(tree.moving, key=lambda pair: pair[0])
    joints = [joint for _, joint in in_order] + tree.fixed
    if not np.array_equal(tool, np.eye(4)):
        parents = {joint.parent for joint in joints}
        ends = set(tree.names.values()) - parents
        for end in sorted(ends, key=tree.links.index):
            link = free_name(f"{end}_tool", tree.taken)
            tree.links.append(link)
            name = free_name(f"{end}_tool_joint", tree.used)
            joints.append(Joint(name, "fixed", end, link, tool))
    called = str(getattr(robot, "name", "") or "robot")
    return Robot(called, tree.links, joints)


class _Tree:
    """Links and joints of a toolbox Robot, added link by link."""

    def __init__(self, robot: Any) -> None:
        self.taken: set[str] = set()  # names of links
        self.used: set[str] = set()  # names of joints
        given = {str(link.name) for link in robot.links}
        self.root = free_name("base", given)
        self.names = {
            id(link): free_name(str(link.name) or "link", self.taken) for link in robot.links
        }
        self.taken.add(self.root)
        self.base = _pose(getattr(robot, "base", None), "base")
        self.links = [self.root, *self.names.values()]
        self.moving: list[tuple[int, Joint]] = []  # with their coordinates
        self.fixed: list[Joint] = []

    def add_link(self, link: Any) -> None:
        """Add the joints from a link's parent to itself, and the links between them."""
        own = self.names[id(link)]
        steps, last = _steps(as_list(link.ets), f"link {safe_repr(link.name)}")
        parent = self.root
        before = self.base
        identity = np.eye(4)
        if link.parent is not None:
            parent = self.names.get(id(link.parent), str(link.parent))
            before = identity
        ends = np.array_equal(last, identity)
        for i, step in enumerate(steps):
            child = own
            if step is not steps[-1] or not ends:
                child = free_name(f"{own}_{i}", self.taken)
                self.links.append(child)
            self._add_joint(step, parent, child, before @ step.origin)
            parent = child
            before = identity
        if parent != own:
            name = free_name(f"{own}_joint", self.used)
            self.fixed.append(Joint(name, "fixed", parent, own, before @ last))

    def _add_joint(
        self,
        step: SequenceJoint,
        parent: str,
        child: str,
        origin: Array,
    ) -> None:
        coordinate = f"q{step.coordinate}"
        mimic = Mimic(coordinate) if coordinate in self.used else None
        name = free_name(coordinate, self.used)
        axis = angular_part(step.screw) if step.kind == "revolute" else linear_part(step.screw)
        joint = Joint(
            name,
            step.kind,
            parent,
            child,
            origin,
            axis,
            step.limits,
            mimic,
        )
        self.moving.append((step.coordinate, joint))


def _steps(
    items: list[Any],
    what: str,
) -> tuple[list[SequenceJoint], Array]:
    """The joints of a sequence, and the constant pose behind the last one."""
    steps: list[SequenceJoint] = []
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
        given = getattr(et, "offset", 0.0)
        offset = float(shaped(given, (), f"{where}: offset"))
        if offset:
            T = T @ se3.exp(offset * screw)
        if getattr(et, "isflip", False):
            screw = -screw
        jindex = getattr(et, "jindex", None)
        if jindex is None:
            jindex = len(steps)
        limits = _limits(getattr(et, "qlim", None))
        kind = _KINDS[axis[0]]
        steps.append(SequenceJoint(T, kind, screw, int(jindex), limits))
        T = np.eye(4)
    return steps, T


def _limits(qlim: Any) -> Interval:
    if qlim is None:
        return UNBOUNDED
    lower, upper = qlim
    return float(lower), float(upper)


def _shared(steps: list[SequenceJoint], coordinate: int) -> Interval:
    """Intersection of the limits of the joints that move together."""
    limits = [step.limits for step in steps if step.coordinate == coordinate]
    highest = max(lower for lower, _ in limits)
    lowest = min(upper for _, upper in limits)
    return highest, lowest


def _pose(T: Any, what: str) -> Array:
    if T is None:
        return np.eye(4)
    return one_pose(T, what)
