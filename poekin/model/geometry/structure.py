"""A chain taken apart into what makes its kinematics cheap: right angles, parallel and intersecting
axes.

Frames follow the common normals of the axes, as Denavit and Hartenberg's do, where the axes let
them: between nearly parallel axes (an angle below `SLANT`) the frame goes straight across instead,
so that nothing blows up. All of it is found in 50 digits: what is not exactly 0 here is not 0 in
the chain's own numbers.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from decimal import Decimal
from typing import NamedTuple

import numpy as np

from ...algebra import add, cross, dot, scale, subtract
from ...engine.straight_line.specialise import Pose, Structure
from ...engine.straight_line.trace import FOLD_TOLERANCE
from ...groups.vectors import rotation_part, translation_part
from ..chain_data import ChainData
from .local import turned_least
from .normals import (
    BASE,
    ZERO,
    Frame,
    Vector,
    across,
    axis_near,
    digits,
    exact,
    frame_on_line,
    length,
    unit,
)

SLANT = 0.1
"""The sine of the angle below which the common normal of two axes is too far away."""


@dataclass
class _Joint:
    """Numbers of one joint, as `Structure` has them: the link before it, its own angle at zero and
    length, and the pose of its frame.
    """

    link: tuple[float, float, float, float] = (0.0, 1.0, 0.0, 0.0)
    parallel: int = 0
    sign: float = 1.0
    along: float = 0.0
    quarters: int = 0
    offset: float = 0.0
    pose: Pose = ()

    def end(self, before: Frame, after: Frame) -> None:
        """Sets its angle, which turns x from the frame before to the frame after, about z."""
        cosine, sine, _ = before.of(after.x)
        self.quarters, self.offset = _angle(cosine, sine)
        self.pose = _pose(after)


class _Step(NamedTuple):
    """From one axis to the next: x is perpendicular to both, z is the next direction. The lengths
    are a along x, b along y and d along the first axis.
    """

    x: Vector
    z: Vector
    sine: Decimal
    cosine: Decimal
    a: Decimal = ZERO
    b: Decimal = ZERO
    d: Decimal = ZERO
    parallel: int = 0
    sign: float = 1.0


def structure(chain: ChainData) -> Structure:
    """The structure of a chain. Its kinematics are the chain's within 1e-15 reach a joint (see
    `trace.FOLD_TOLERANCE`).
    """
    with digits():
        return _structure(chain)


def _structure(chain: ChainData) -> Structure:
    frame = BASE
    base = _pose(frame)
    joints: list[_Joint] = []
    for S, kind in zip(chain.screws, chain.kinds, strict=True):
        slides = kind == "prismatic"
        z, p = axis_near(S, slides, frame.o)
        if not joints:
            R = turned_least(*map(float, z))
            x, y = map(exact, (R[0::3], R[1::3]))
            frame = Frame(x, y, z, p)
            base = _pose(frame)
            joints.append(_Joint())
            continue
        step = _step(frame, z, p, slides)
        o = add(frame.o, scale(step.d, frame.z))
        end = frame_on_line(step.x, frame.z, o)
        last = joints[-1]
        last.along += float(step.d)
        last.end(frame, end)
        link = float(step.sine), float(step.cosine), float(step.a), float(step.b)
        joints.append(_Joint(link, step.parallel, step.sign))
        o = add(o, scale(step.a, end.x))
        o = add(o, scale(step.b, end.y))
        frame = frame_on_line(step.x, step.z, o)
    tip = Frame(*map(exact, chain.home[:3].T))
    if joints:
        end = frame_on_line(_least_turned(tip, frame.z), frame.z, frame.o)
        joints[-1].end(frame, end)
        frame = end
    return _as_structure(chain, joints, base, _pose(tip.seen_by(frame)))


def _step(frame: Frame, z: Vector, p: Vector, slides: bool) -> _Step:
    """To the axis of direction z through p, which is of no matter where the joint only slides."""
    normal = cross(frame.z, z)
    sine = length(normal)
    cosine = dot(frame.z, z)
    w = subtract(p, frame.o)
    if sine <= FOLD_TOLERANCE:
        w = across(w, frame.z)
        a = length(w)
        x = unit(w) if a > FOLD_TOLERANCE else frame.x
        sign = math.copysign(1.0, cosine)
        return _Step(x, frame.z, ZERO, Decimal(1), a, parallel=1, sign=sign)
    x = unit(normal)
    y = cross(frame.z, x)
    if slides:
        return _Step(x, z, sine, cosine)
    if sine < SLANT:
        along = dot(w, frame.z) / cosine
        w = subtract(w, scale(along, z))
        return _Step(x, z, sine, cosine, a=dot(w, x), b=dot(w, y))
    along = dot(w, y) / dot(z, y)
    w = subtract(w, scale(along, z))
    return _Step(x, z, sine, cosine, a=dot(w, x), d=dot(w, frame.z))


def _least_turned(tip: Frame, z: Vector) -> Vector:
    """Direction x beside z that is turned from the tip's as little as possible."""
    x = turned_least(*map(float, tip.of(z)))[0::3]
    return unit(across(tip.out(exact(x)), z))


def _as_structure(
    chain: ChainData,
    joints: list[_Joint],
    base: Pose,
    tool: Pose,
) -> Structure:
    signs = np.array([joint.sign for joint in joints])
    return Structure(
        links=tuple(joint.link for joint in joints),
        d_offsets=tuple(joint.along for joint in joints),
        parallel=tuple(joint.parallel for joint in joints),
        rotates=tuple((signs * chain.local.rotates).tolist()),
        slides=tuple((signs * chain.local.slides).tolist()),
        coupling=tuple(map(tuple, chain.coupling.tolist())),
        shift=tuple(chain.offset.tolist()),
        offsets=tuple(joint.offset for joint in joints),
        quarters=tuple(joint.quarters for joint in joints),
        base=base,
        tool=tool,
        frames=tuple(_in_local(chain, k, joint.pose) for k, joint in enumerate(joints)),
        coordinates=chain.dof,
    )


def _angle(cosine: Decimal, sine: Decimal) -> tuple[int, float]:
    """An angle given by cosine and sine: whole quarter turns, and what is left, which is 0 within
    rounding or not.
    """
    angle = math.atan2(sine, cosine)
    quarters = round(angle / (math.pi / 2))
    left = sine if quarters % 2 == 0 else cosine
    if abs(float(left)) <= FOLD_TOLERANCE:
        return quarters % 4, 0.0
    return 0, angle


def _pose(frame: Frame) -> Pose:
    """The twelve numbers of a frame, rotation row by row, then position."""
    *columns, o = frame
    return (
        *(float(value) for row in zip(*columns, strict=True) for value in row),
        *map(float, o),
    )


def _in_local(chain: ChainData, k: int, T: Pose) -> Pose:
    """A pose at x = 0 in the base frame, seen from the chain's own frame of joint k."""
    local = np.eye(4)
    for link in chain.local.frames[: k + 1]:
        local = local @ link
    R = np.array(T[:9]).reshape(3, 3)
    o = np.array(T[9:])
    seen = rotation_part(local).T @ R
    there = rotation_part(local).T @ (o - translation_part(local))
    return (*seen.ravel().tolist(), *there.tolist())
