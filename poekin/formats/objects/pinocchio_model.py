"""Pinocchio's Model: joints, and the frames that they carry, as a tree of links and joints."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from ...errors import ModelError, quote
from ...groups import se3
from ...groups.arrays import Array
from ...model.checks import one_pose
from ...model.joint import MOVING, Joint, Mimic
from ...model.provenance import warn
from ...model.robot import Robot
from ..common.limits import (
    UNBOUNDED,
    Interval,
    known_effort,
    known_loss,
    known_velocity,
    without_absurd,
)
from ..common.names import free_name
from .attributes import has
from .pinocchio_joint import extracted, joint_type, motions

_MODEL = (
    "njoints",
    "joints",
    "names",
    "parents",
    "jointPlacements",
    "frames",
    "lowerPositionLimit",
)
_OF_DRIVES: dict[str, tuple[str, Callable[[float], float]]] = {
    "velocity": ("velocityLimit", known_velocity),
    "effort": ("effortLimit", known_effort),
    "damping": ("damping", known_loss),
    "friction": ("friction", known_loss),
}
"""By field of a Joint: the model's array of it, and what is known by its numbers."""
_LIMITED = ("revolute", "prismatic", "helical")


class ModelFrame(NamedTuple):
    """Frame of the model: name, kind, the joint that carries it, its pose there, and `above`.

    `above`: number of the frame that it hangs on, its own where that is no earlier one.
    """

    name: str
    kind: str
    joint: int
    pose: Array
    above: int


class LinkPlace(NamedTuple):
    """A link, and its pose in the frame of the model's joint that carries it."""

    link: str
    pose: Array


def fits(obj: Any) -> bool:
    """Whether an object has the attributes of a Pinocchio model."""
    return has(obj, *_MODEL)


def make_robot(model: Any) -> Robot:
    """The tree of a Pinocchio model: links are its frames, joints its joints and what fixes its
    frames.

    A model that was built from a URDF gives the links and joints of that URDF: a frame of kind BODY
    that stands alone on one of kind JOINT or FIXED_JOINT, or on the universe, is that joint's child
    link (or the root). Every other frame is a link under its own name, held by a fixed joint; so is
    a joint that has no frame.

    A continuous joint has one angle. A free-flyer is a floating joint, planar a planar one;
    universal, translation, spherical ZYX and composite joints are several in series, JOINT_1,
    JOINT_2, .... A joint that mimics another one does so here. Limits of 1e4 and more bound
    nothing; nor do equal ones, with a PoekinWarning, as in a URDF. Velocity and effort limits,
    damping and friction are the model's; a velocity limit of 0 is not known, as in a URDF. What
    mimics another joint has none: Pinocchio keeps none for it.

    Parameters: model. Returns: Robot; its q is in the order of the model's.
    Raises: ModelError that names the joint where Robot has no such kind: spherical, ellipsoid, and
    for a model of Pinocchio 2.
    Accuracy: placements as they are; that of a frame on another one within 4 u of their distances
    from the joint. Source: Pinocchio's documentation of Model and ModelFrame.
    """
    names = [str(name) for name in model.names]
    frames = [_frame(frame, i) for i, frame in enumerate(model.frames)]
    own = _own_frames(frames, names)
    bodies = _bodies(frames, set(own.values()))
    links, holders, taken = _link_names(frames, names, own, bodies)
    places = {j: LinkPlace(holder, np.eye(4)) for j, holder in enumerate(holders)}

    def above(joint: int, i: int | None) -> LinkPlace:
        """The link below which something on a joint hangs: the frame i's own parent, or the joint's
        link.
        """
        if i is not None and frames[i].above != i:
            k = frames[i].above
            if frames[k].joint == joint:
                return LinkPlace(links[k], frames[k].pose)
        return places[joint]

    joints: list[Joint] = []
    unusable: list[str] = []
    used = set(names)
    for j in range(1, len(names)):
        place = above(int(model.parents[j]), own.get(j))
        origin = se3.inverse(place.pose) @ one_pose(
            model.jointPlacements[j],
            f"placement of joint {quote(names[j])}",
        )
        joints += _moving(model, j, place.link, origin, holders[j], taken, used, unusable)
    # The frames of fixed joints first: their names are joints' names already.
    of_joints = {*own.values(), *bodies.values()}
    hanging = [i for i in range(len(frames)) if i not in of_joints]
    for i in sorted(hanging, key=lambda i: frames[i].kind != "FIXED_JOINT"):
        place = above(frames[i].joint, i)
        name = free_name(frames[i].name, used)
        origin = se3.inverse(place.pose) @ frames[i].pose
        joints.append(Joint(name, "fixed", place.link, links[i], origin))
    if unusable:
        warn(f"joints without usable limits are taken as unlimited: {', '.join(unusable)}")
    children = (joint.child for joint in joints)
    every = [holders[0], *links, *holders, *children]
    called = str(getattr(model, "name", "") or "robot")
    return Robot(called, dict.fromkeys(every), joints)


def _frame(frame: Any, i: int) -> ModelFrame:
    kind = str(getattr(frame.type, "name", frame.type))
    pose = one_pose(frame.placement, f"placement of frame {quote(frame.name)}")
    if not hasattr(frame, "parentFrame"):
        raise ModelError(
            f"expected a model of Pinocchio 3 or newer; its frame {quote(frame.name)} has no parentFrame"
        )
    above = int(frame.parentFrame)
    if not 0 <= above < i:
        above = i
    name = str(frame.name) or f"frame{i}"
    return ModelFrame(name, kind, int(frame.parentJoint), pose, above)


def _own_frames(
    frames: list[ModelFrame],
    names: list[str],
) -> dict[int, int]:
    """Numbers of the joints' own frames, in their very places; of the universe too."""
    own: dict[int, int] = {}
    for i, frame in enumerate(frames):
        kind = "JOINT" if frame.joint else "FIXED_JOINT"
        same = frame.kind == kind and frame.name == names[frame.joint]
        if same and np.array_equal(frame.pose, np.eye(4)):
            own.setdefault(frame.joint, i)
    return own


def _bodies(
    frames: list[ModelFrame],
    own: set[int],
) -> dict[int, int]:
    """Numbers of the BODY frames that are joints' child links: the only ones in their places."""
    on: dict[int, list[int]] = {}
    for i, frame in enumerate(frames):
        below = frames[frame.above]
        joins = frame.above in own or below.kind == "FIXED_JOINT"
        same = frame.joint == below.joint and np.array_equal(frame.pose, below.pose)
        if frame.kind == "BODY" and frame.above != i and joins and same:
            on.setdefault(frame.above, []).append(i)
    return {i: bodies[0] for i, bodies in on.items() if len(bodies) == 1}


def _link_names(
    frames: list[ModelFrame],
    names: list[str],
    own: dict[int, int],
    bodies: dict[int, int],
) -> tuple[list[str], list[str], set[str]]:
    """Link of each frame, link of each joint, and all names taken; BODY frames keep theirs first."""
    taken: set[str] = set()
    links = [""] * len(frames)
    bodies_first = sorted(range(len(frames)), key=lambda i: frames[i].kind != "BODY")
    for i in bodies_first:
        if i not in bodies:
            links[i] = free_name(frames[i].name, taken)
    for i, body in bodies.items():
        links[i] = links[body]
    holders = []
    for j, name in enumerate(names):
        if j in own:
            holders.append(links[own[j]])
        else:
            holders.append(free_name(name, taken))
    return links, holders, taken


def _moving(
    model: Any,
    j: int,
    parent: str,
    origin: Array,
    child: str,
    taken: set[str],
    used: set[str],
    unusable: list[str],
) -> list[Joint]:
    """The joints of joint j of the model, one after the other, from a parent link to its own."""
    joint = model.joints[j]
    name = str(model.names[j])
    parts = motions(joint, name)
    mimic = _mimic(model, j, joint)
    joints = []
    for k, part in enumerate(parts):
        numbered = f"{name}_{k + 1}"
        called = name if len(parts) == 1 else free_name(numbered, used)
        end = child if k == len(parts) - 1 else free_name(numbered, taken)
        limits = UNBOUNDED
        if mimic is None and part.kind in _LIMITED:
            coordinate = int(joint.idx_q) + k
            limits = _limits(model, coordinate, called, unusable)
        drive: dict[str, Any] = {}
        if mimic is None and part.kind in MOVING:
            drive = _drive(model, joint, k)
        pose = origin @ part.origin
        joints.append(
            Joint(
                called,
                part.kind,
                parent,
                end,
                pose,
                part.axis,
                limits,
                mimic,
                part.pitch,
                **drive,
            )
        )
        parent = end
        origin = np.eye(4)
    return joints


def _mimic(model: Any, j: int, joint: Any) -> Mimic | None:
    if joint_type(joint) != "Mimic":
        return None
    bare = extracted(joint)
    mimicking = map(int, model.mimicking_joints)
    mimicked = map(int, model.mimicked_joints)
    masters = dict(zip(mimicking, mimicked, strict=True))
    master = str(model.names[masters[j]])
    return Mimic(master, float(bare.scaling), float(bare.offset))


def _drive(model: Any, joint: Any, k: int) -> dict[str, float]:
    """Velocity and effort limits, damping and friction of velocity k of the joint."""
    drive = {}
    for field, (array, known) in _OF_DRIVES.items():
        values = getattr(model, array, None)
        if values is not None:
            drive[field] = known(float(values[int(joint.idx_v) + k]))
    return drive


def _limits(
    model: Any,
    k: int,
    name: str,
    unusable: list[str],
) -> Interval:
    """Bounds of coordinate k of the model."""
    lower = float(model.lowerPositionLimit[k])
    upper = float(model.upperPositionLimit[k])
    if lower == upper:
        unusable.append(f"{quote(name)} (equal, {lower!r})")
        return UNBOUNDED
    return without_absurd(lower, upper)
