"""Small URDFs as numbers: each has one thing in it that readers are known to get wrong, and shrinks to little more.

A joint is twelve numbers: its axis; origin xyz, then rpy; the mimic multiplier less 1, and offset; its value q. All are
0 where the URDF need not say anything, but for the axis. What it means is put together here in 80 digits from the
format's definition; no reader of poekin's is asked.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from .. import exact
from ..measures import size
from .law import Case
from .of_arms import Arm

EACH = 12
LIMIT = 10.0
"""Limits are ± this, in rad or m, beyond every q that is drawn."""
SIDE = "side"
"""The joint beside the way from base to tip, where there is one; who reads the whole tree has its coordinate."""
SIDE_VALUE = 0.5


class Joint(NamedTuple):
    """What of a joint is no number: its type, its name, whether an axis is written, the place of what it mimics."""

    kind: str
    name: str
    axis: bool = True
    follows: int = -1


class Layout(NamedTuple):
    """The joints from base to tip, the order in which the file has them, and whether another one branches off."""

    joints: tuple[Joint, ...]
    order: tuple[int, ...]
    side: bool = False


def layout_of(case: Case) -> Layout:
    """The layout of a URDF's case."""
    if not isinstance(case.layout, Layout):
        raise TypeError(f"a case of a URDF expected, got {case.layout!r}")
    return case.layout


def rows_of(case: Case) -> np.ndarray:
    """Its numbers (n, 12)."""
    return case.numbers.reshape(-1, EACH)


def moving(case: Case) -> list[int]:
    """The places of joints that have a coordinate of their own."""
    return [k for k, joint in enumerate(layout_of(case).joints) if joint.kind != "fixed" and joint.follows < 0]


def coordinates(case: Case) -> dict[str, float]:
    """q by the names of the joints that have one of their own, from base to tip."""
    layout, rows = layout_of(case), rows_of(case)
    return {layout.joints[k].name: float(rows[k, 11]) for k in moving(case)}


def text(case: Case) -> str:
    """The URDF."""
    layout, rows = layout_of(case), rows_of(case)
    links = ["base", *(f"link{k}" for k in range(1, len(rows))), "tip"]
    elements = [_joint(layout, k, rows[k], links[k], links[k + 1]) for k in layout.order]
    if layout.side:
        links.append("beside")
        limits = '<limit lower="-10" upper="10" effort="1" velocity="1"/>'
        elements.insert(
            0, f'<joint name="{SIDE}" type="revolute"><parent link="base"/><child link="beside"/>{limits}</joint>'
        )
    content = [*(f'<link name="{link}"/>' for link in links), *elements]
    return f'<robot name="small">{"".join(content)}</robot>'


def _joint(layout: Layout, k: int, row: np.ndarray, parent: str, child: str) -> str:
    joint = layout.joints[k]
    inside = f'<parent link="{parent}"/><child link="{child}"/>'
    if np.any(row[3:9]):
        rpy = f' rpy="{_numbers(row[6:9])}"' if np.any(row[6:9]) else ""
        inside += f'<origin xyz="{_numbers(row[3:6])}"{rpy}/>'
    if joint.kind != "fixed" and joint.axis:
        inside += f'<axis xyz="{_numbers(row[:3])}"/>'
    if joint.kind in ("revolute", "prismatic"):
        inside += f'<limit lower="-{LIMIT:g}" upper="{LIMIT:g}" effort="1" velocity="1"/>'
    if joint.follows >= 0:
        factor = f' multiplier="{_numbers(1 + row[9:10])}"' if row[9] else ""
        shift = f' offset="{_numbers(row[10:11])}"' if row[10] else ""
        inside += f'<mimic joint="{layout.joints[joint.follows].name}"{factor}{shift}/>'
    return f'<joint name="{joint.name}" type="{joint.kind}">{inside}</joint>'


def _numbers(x: np.ndarray) -> str:
    return " ".join(repr(value + 0.0).removesuffix(".0") for value in x.tolist())


def factors(case: Case) -> list[np.ndarray]:
    """Twists whose exponentials, in order, are the pose of the tip in the base: of origins and of joints, exactly.

    Roll, pitch and yaw are Rz(yaw) Ry(pitch) Rx(roll).
    """
    result = []
    for k, x in enumerate(_values(case)):
        origin, screw = _link(case, k)
        result += [*origin, *([] if screw is None else [screw * x])]
    return result


def arm(case: Case) -> tuple[Arm, np.ndarray, list[str]]:
    """The arm in exact numbers, q, and the names of its coordinates: those of `coordinates`, in that order."""
    named = coordinates(case)
    names, own = list(named), moving(case)
    layout = layout_of(case)
    T, screws, coupling, offset = exact.exactly(np.eye(4)), [], [], []
    for k, joint in enumerate(layout.joints):
        origin, screw = _link(case, k)
        for xi in origin:
            T = T @ exact.exp(xi)
        if screw is None:
            continue
        screws.append(exact.adjoint(T) @ screw)
        master = joint.follows if joint.follows >= 0 else k
        row = rows_of(case)[k]
        factor, shift = (1 + row[9], row[10]) if joint.follows >= 0 else (1.0, 0.0)
        coupling.append([factor if at == own.index(master) else 0.0 for at in range(len(names))])
        offset.append(shift)
    n, m = len(screws), len(names)
    A, rows = np.array(screws, dtype=object).reshape(n, 6), rows_of(case)
    C, c = np.reshape(coupling, (n, m)), np.array(offset, dtype=float)
    reach, turned = sum(map(size, rows[:, 3:6])), float(np.abs(rows[:, 6:9]).sum())
    # A fixed joint is a factor, too.
    turned += len(rows)
    return Arm(A, T, C, c, m, reach, turned), np.array([*named.values()]), names


def simpler(case: Case) -> Iterable[Case]:
    """With a joint less, with the file in order, without what branches off."""
    layout, rows = layout_of(case), rows_of(case)
    if layout.side:
        yield case._replace(layout=layout._replace(side=False))
    for k in range(len(rows)):
        if len(rows) == 1 or any(joint.follows == k for joint in layout.joints):
            continue
        kept = [j for j in range(len(rows)) if j != k]
        joints = tuple(
            joint._replace(follows=joint.follows - (joint.follows > k))
            for j, joint in enumerate(layout.joints)
            if j != k
        )
        order = tuple(j - (j > k) for j in layout.order if j != k)
        yield Case(rows[kept].ravel(), Layout(joints, order, layout.side))
    if layout.order != tuple(range(len(rows))):
        yield case._replace(layout=layout._replace(order=tuple(range(len(rows)))))


def allowed(case: Case) -> bool:
    """No written axis may vanish, and every value stays within the limits."""
    rows = rows_of(case)
    if len(rows) == 0 or not all(np.any(row[:3]) for row in rows):
        return False
    return all(abs(x) <= LIMIT for x in exact.rounded(np.array(_values(case), dtype=object)))


def triples(case: Case) -> Iterable[int]:
    """Axes, xyz and rpy."""
    return [k + at for k in range(0, len(case.numbers), EACH) for at in (0, 3, 6)]


def _values(case: Case) -> list:
    layout, rows = layout_of(case), rows_of(case)
    values = []
    for row, joint in zip(rows, layout.joints, strict=True):
        if joint.follows < 0:
            values.append(exact.mp.mpf(0) if joint.kind == "fixed" else exact.mp.mpf(float(row[11])))
        else:
            # The multiplier is what is written: the sum, rounded.
            values.append(exact.mp.mpf(float(1 + row[9])) * float(rows[joint.follows, 11]) + float(row[10]))
    return values


def _link(case: Case, k: int) -> tuple[list[np.ndarray], np.ndarray | None]:
    """The twists of a joint's origin, and its screw in its own frame, with a unit axis."""
    joint, row = layout_of(case).joints[k], rows_of(case)[k]
    roll, pitch, yaw = row[6:9]
    origin = [[0, 0, 0, *row[3:6]], [0, 0, yaw, 0, 0, 0], [0, pitch, 0, 0, 0, 0], [roll, 0, 0, 0, 0, 0]]
    origin = [exact.exactly(xi) for xi in origin if np.any(xi)]
    if joint.kind == "fixed":
        return origin, None
    axis = exact.exactly(row[:3] if joint.axis else [1.0, 0.0, 0.0])
    n, nought = axis / exact.norm(axis), exact.exactly(np.zeros(3))
    screw = np.concatenate([nought, n] if joint.kind == "prismatic" else [n, nought])
    return origin, screw
