"""Small URDFs as numbers: each has one thing in it that readers are known to get wrong, and shrinks
to little more.

A joint is twelve numbers: its axis; origin xyz, then rpy; the mimic multiplier less 1, and offset;
its value q. All are 0 where the URDF need not say anything, but for the axis. What it means is put
together here in 80 digits from the format's definition; no reader of poekin's is asked.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np

from ...laws.measures import size
from ...oracles import exact
from .law import Case
from .of_arms import ArmData

EACH = 12
MIMIC = slice(9, 11)
VALUE = 11
"""Places of the mimic numbers, and of q, among those of a joint."""
LIMIT = 10.0
"""Limits are ± this, in rad or m, beyond every q that is drawn."""
TIP = -1
"""The place of the joint that has the link tip: the last one."""


class UrdfJoint(NamedTuple):
    """A joint without its numbers: type, name, whether an axis is written, place of the joint that
    it mimics.
    """

    kind: str
    name: str
    axis: bool = True
    follows: int = -1


class UrdfLayout(NamedTuple):
    """The joints, each with the one before it in `after` (-1: it begins at the base), and the
    file's order of them.
    """

    joints: tuple[UrdfJoint, ...]
    order: tuple[int, ...]
    after: tuple[int, ...]


class JointNumbers(NamedTuple):
    """Numbers of a joint, 0 where the URDF need not say anything, but for the axis.

    The mimic multiplier is `factor` + 1, the mimic offset `shift`.
    """

    axis: np.ndarray
    xyz: np.ndarray
    rpy: np.ndarray
    factor: float
    shift: float
    q: float


def chain(
    joints: tuple[UrdfJoint, ...],
    order: tuple[int, ...] = (),
) -> UrdfLayout:
    """Joints one after the other, in the file in that order or another one."""
    n = len(joints)
    as_they_come = tuple(range(n))
    one_before = tuple(range(-1, n - 1))
    return UrdfLayout(joints, order or as_they_come, one_before)


def rows_of(case: Case) -> np.ndarray:
    """Its numbers (n, 12)."""
    return case.numbers.reshape(-1, EACH)


def numbers_of(case: Case) -> list[JointNumbers]:
    """Numbers of each joint."""
    return [JointNumbers(x[:3], x[3:6], x[6:9], *x[9:].tolist()) for x in rows_of(case)]


def moving(case: Case) -> list[int]:
    """The places of joints that have a coordinate of their own."""
    return [
        k
        for k, joint in enumerate(case.layout.joints)
        if joint.kind != "fixed" and joint.follows < 0
    ]


def link(case: Case, k: int) -> str:
    """The name of the link behind a joint; -1 is none: the root's."""
    if k < 0:
        return "base"
    if k == len(case.layout.joints) - 1:
        return "tip"
    return f"link{k + 1}"


def path(case: Case, k: int) -> list[int]:
    """The places of the joints from the base to the link behind a joint."""
    after = case.layout.after
    places = [k % len(after)]
    while after[places[0]] >= 0:
        places.insert(0, after[places[0]])
    return places


def coordinates(case: Case) -> dict[str, float]:
    """q by the names of the joints that have one of their own."""
    joints = case.layout.joints
    numbers = numbers_of(case)
    return {joints[k].name: numbers[k].q for k in moving(case)}


def text(case: Case) -> str:
    """The URDF."""
    layout = case.layout
    numbers = numbers_of(case)
    names = [link(case, k) for k in range(-1, len(numbers))]
    content = [f'<link name="{name}"/>' for name in names]
    for k in layout.order:
        ends = f'<parent link="{names[layout.after[k] + 1]}"/><child link="{names[k + 1]}"/>'
        content.append(_joint(layout, layout.joints[k], numbers[k], ends))
    return f'<robot name="small">{"".join(content)}</robot>'


def _joint(
    layout: UrdfLayout,
    joint: UrdfJoint,
    numbers: JointNumbers,
    ends: str,
) -> str:
    inside = ends
    if np.any(numbers.xyz) or np.any(numbers.rpy):
        inside += f'<origin xyz="{_text(numbers.xyz)}"{_attribute("rpy", numbers.rpy)}/>'
    if joint.kind != "fixed" and joint.axis:
        inside += f'<axis xyz="{_text(numbers.axis)}"/>'
    if joint.kind in ("revolute", "prismatic"):
        inside += f'<limit lower="-{LIMIT:g}" upper="{LIMIT:g}" effort="1" velocity="1"/>'
    if joint.follows >= 0:
        master = layout.joints[joint.follows].name
        factor = _attribute("multiplier", np.array([numbers.factor]), 1)
        shift = _attribute("offset", np.array([numbers.shift]))
        inside += f'<mimic joint="{master}"{factor}{shift}/>'
    return f'<joint name="{joint.name}" type="{joint.kind}">{inside}</joint>'


def _attribute(
    name: str,
    x: np.ndarray,
    default: float = 0,
) -> str:
    """An attribute of numbers x more than its default; none where nothing is more."""
    if not np.any(x):
        return ""
    return f' {name}="{_text(default + x)}"'


def _text(x: np.ndarray) -> str:
    return " ".join(repr(value + 0.0).removesuffix(".0") for value in x.tolist())


def factors(case: Case, tip: int = TIP) -> list[np.ndarray]:
    """Twists whose exponentials, in order, are the pose of the link behind a joint: of origins and
    of joints, exactly.

    Roll, pitch and yaw are Rz(yaw) Ry(pitch) Rx(roll).
    """
    result = []
    values = _values(case)
    for k in path(case, tip):
        origin, screw = _link(case, k)
        result += origin
        if screw is not None:
            result.append(screw * values[k])
    return result


def arm(
    case: Case,
    tip: int = TIP,
) -> tuple[ArmData, np.ndarray, list[str]]:
    """The arm to the link behind a joint in exact numbers, q, and the names of its coordinates.

    These are those of `coordinates`, in that order, which the pose depends on.
    """
    joints = case.layout.joints
    numbers = numbers_of(case)
    on = path(case, tip)
    masters = [_master(case, k) for k in on]
    own = [k for k in moving(case) if k in masters]
    T = exact.exactly(np.eye(4))
    screws = []
    coupling = []
    offset = []
    for k, master in zip(on, masters, strict=True):
        origin, screw = _link(case, k)
        T = exact.product([T, *map(exact.exp, origin)])
        if screw is None:
            continue
        screws.append(exact.adjoint(T) @ screw)
        # Of a joint that mimics none, factor and shift are 0.
        coupling.append(np.equal(own, master) * (1 + numbers[k].factor))
        offset.append(numbers[k].shift)
    n = len(screws)
    turns = np.abs([numbers[k].rpy for k in on])
    found = ArmData(
        screws=np.array(screws, dtype=object).reshape(n, 6),
        home=T,
        coupling=np.reshape(coupling, (n, len(own))),
        offset=np.array(offset, dtype=float),
        dof=len(own),
        reach=sum(size(numbers[k].xyz) for k in on),
        # A fixed joint is a factor, too.
        turned=float(turns.sum()) + len(on),
    )
    q = np.array([numbers[k].q for k in own])
    names = [joints[k].name for k in own]
    return found, q, names


def _master(case: Case, k: int) -> int:
    """The place of the joint whose coordinate moves a joint: of the one that it mimics, or its own."""
    follows = case.layout.joints[k].follows
    if follows < 0:
        return k
    return follows


def simpler(case: Case) -> Iterable[Case]:
    """With a joint or a mimic less, with the file in order, one joint after the other, with all
    axes written.
    """
    layout = case.layout
    rows = rows_of(case)
    for k in range(len(rows)):
        mimicked = any(joint.follows == k for joint in layout.joints)
        if len(rows) > 1 and not mimicked:
            yield _without_joint(case, k)
    for k, joint in enumerate(layout.joints):
        if joint.follows >= 0:
            joints = list(layout.joints)
            joints[k] = joint._replace(follows=-1)
            numbers = rows.copy()
            numbers[k, MIMIC] = 0.0
            free = layout._replace(joints=tuple(joints))
            yield Case(numbers.ravel(), free)
    plain = chain(layout.joints)
    written = tuple(joint._replace(axis=True) for joint in layout.joints)
    in_order = layout._replace(order=plain.order)
    all_written = layout._replace(joints=written)
    for other in (plain, in_order, all_written):
        if other != layout:
            yield case._replace(layout=other)


def _without_joint(case: Case, k: int) -> Case:
    """The case without joint k, which no other mimics; joints behind it follow the one before."""
    layout = case.layout

    def moved(j: int) -> int:
        return j - (j > k)

    others = [j for j in range(len(layout.joints)) if j != k]
    joints = (layout.joints[j] for j in others)
    after = list(layout.after)
    for j in others:
        if after[j] == k:
            after[j] = after[k]
    shorter = UrdfLayout(
        joints=tuple(joint._replace(follows=moved(joint.follows)) for joint in joints),
        order=tuple(moved(j) for j in layout.order if j != k),
        after=tuple(moved(after[j]) for j in others),
    )
    return Case(rows_of(case)[others].ravel(), shorter)


def allowed(case: Case) -> bool:
    """There is a joint, and every value stays within the limits."""
    if not len(rows_of(case)):
        return False
    values = np.array(_values(case), dtype=object)
    return all(abs(x) <= LIMIT for x in exact.rounded(values))


def triples(case: Case) -> Iterable[int]:
    """The xyz and rpy of origins."""
    return [k + at for k in range(0, len(case.numbers), EACH) for at in (3, 6)]


def axes(case: Case) -> Iterable[int]:
    """Axes."""
    return range(0, len(case.numbers), EACH)


def _values(case: Case) -> list[Any]:
    numbers = numbers_of(case)
    values = []
    for joint, own in zip(case.layout.joints, numbers, strict=True):
        if joint.follows < 0:
            q = own.q * (joint.kind != "fixed")
            values.append(exact.mp.mpf(q))
        else:
            # The multiplier is what is written: the sum, rounded.
            factor = exact.mp.mpf(1 + own.factor)
            q = numbers[joint.follows].q
            values.append(factor * q + own.shift)
    return values


def _link(
    case: Case,
    k: int,
) -> tuple[list[np.ndarray], np.ndarray | None]:
    """The twists of a joint's origin, and its screw in its own frame, with a unit axis."""
    joint = case.layout.joints[k]
    numbers = numbers_of(case)[k]
    roll, pitch, yaw = numbers.rpy
    origin = [
        [0, 0, 0, *numbers.xyz],
        [0, 0, yaw, 0, 0, 0],
        [0, pitch, 0, 0, 0, 0],
        [roll, 0, 0, 0, 0, 0],
    ]
    origin = [exact.exactly(xi) for xi in origin if np.any(xi)]
    if joint.kind == "fixed":
        return origin, None
    axis = exact.exactly([1.0, 0.0, 0.0])
    if joint.axis:
        axis = exact.exactly(numbers.axis)
    screw = exact.exactly(np.zeros(6))
    half = slice(3)
    if joint.kind == "prismatic":
        half = slice(3, 6)
    screw[half] = axis / exact.norm(axis)
    return origin, screw
