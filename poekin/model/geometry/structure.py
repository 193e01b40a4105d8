"""A chain taken apart into what makes its kinematics cheap: right angles, parallel and intersecting
axes.

Frames follow the common normals of the axes, as Denavit and Hartenberg's do, where the axes let
them: between nearly parallel axes (an angle below `SLANT`) the frame goes straight across instead,
so that nothing blows up. All of it is found in 50 digits: what is not exactly 0 here is not 0 in
the chain's own numbers.
"""

from __future__ import annotations

import math
from decimal import Decimal
from typing import TYPE_CHECKING

import numpy as np

from ...algebra import add, cross, dot, scale, subtract
from ...engine.straight_line.specialise import Pose, Structure
from ...engine.straight_line.trace import FOLDED
from ...groups.arrays import Array
from .local import turned_least
from .normals import Vector, across, axis_near, digits, exact, length, unit

if TYPE_CHECKING:
    from ..chain import Chain

SLANT = 0.1
"""The sine of the angle below which the common normal of two axes is too far away."""


def structure(chain: Chain) -> Structure:
    """The structure of a chain. Its kinematics are the chain's within 1e-15 reach a joint (see
    `trace.FOLDED`).
    """
    with digits():
        return _structure(chain)


def _structure(chain: Chain) -> Structure:
    n = len(chain.screws)
    slides = [kind == "prismatic" for kind in chain.kinds]
    links, alongs, parallel, signs, turns = [], [0.0] * n, [0] * n, [1.0] * n, []
    R, o = np.eye(3), exact((0.0, 0.0, 0.0))
    axes = _columns(R)
    base = _pose(axes, o)
    homes = []
    for i in range(n):
        z, p = axis_near(chain.screws[i], slides[i], o)
        if i == 0:
            axes, o = _columns(turned_least(np.array(z, float))), p
            axes = (*axes[:2], z)
            base = _pose(axes, o)
            links.append((0.0, 1.0, 0.0, 0.0))
            continue
        X, Y, Z = axes
        sine, cosine = length(cross(Z, z)), dot(Z, z)
        if sine <= FOLDED:
            signs[i], parallel[i] = math.copysign(1.0, cosine), 1
            z, sine, cosine = Z, Decimal(0), Decimal(1)
            w = across(subtract(p, o), Z)
            a = length(w)
            x = unit(w) if a > FOLDED else X
            step = (a, Decimal(0), Decimal(0))
        else:
            x = unit(cross(Z, z))
            y, w = cross(Z, x), subtract(p, o)
            if slides[i]:
                step = (Decimal(0),) * 3
            elif sine < SLANT:
                w = subtract(w, scale(dot(w, Z) / cosine, z))
                step = (dot(w, x), dot(w, y), Decimal(0))
            else:
                w = subtract(w, scale(dot(w, y) / dot(z, y), z))
                step = (dot(w, x), Decimal(0), dot(w, Z))
        turns.append((dot(x, X), dot(x, Y)))
        y = cross(Z, x)
        alongs[i - 1] += float(step[2])
        o = add(o, scale(step[2], Z))
        homes.append(_pose((x, y, Z), o))
        links.append((float(sine), float(cosine), float(step[0]), float(step[1])))
        o = add(o, add(scale(step[0], x), scale(step[1], y)))
        axes = (x, cross(z, x), z)
    tip = [exact(column) for column in chain.home[:3].T]
    if n:
        X, Y, Z = axes
        u = np.array([dot(column, Z) for column in tip[:3]], float)
        x = unit(across(_combined(tip[:3], turned_least(u)[:, 0]), Z))
        turns.append((dot(x, X), dot(x, Y)))
        axes = (x, cross(Z, x), Z)
        homes.append(_pose(axes, o))
    p = subtract(tip[3], o)
    seen = [tuple(dot(axis, column) for axis in axes) for column in (*tip[:3], p)]
    quarters, offsets = zip(*map(_angle, turns), strict=True) if n else ((), ())
    return Structure(
        links=tuple(links),
        alongs=tuple(alongs),
        parallel=tuple(parallel),
        rotates=tuple(s * float(r) for s, r in zip(signs, chain.local.rotates, strict=True)),
        slides=tuple(s * float(h) for s, h in zip(signs, chain.local.slides, strict=True)),
        coupling=tuple(map(tuple, chain.coupling.tolist())),
        shift=tuple(chain.offset.tolist()),
        offsets=offsets,
        quarters=quarters,
        base=base,
        tool=_pose(seen[:3], seen[3]),
        frames=tuple(_in_local(chain, k, T) for k, T in enumerate(homes)),
        coordinates=chain.dof,
    )


def _angle(turn: tuple[Decimal, Decimal]) -> tuple[int, float]:
    """An angle given by cosine and sine: whole quarter turns, and what is left, which is 0 within
    rounding or not.
    """
    angle = math.atan2(turn[1], turn[0])
    quarters = round(angle / (math.pi / 2))
    sine = float(turn[1] if quarters % 2 == 0 else turn[0])
    return (quarters % 4, 0.0) if abs(sine) <= FOLDED else (0, angle)


def _columns(R: Array) -> tuple[Vector, Vector, Vector]:
    x, y, z = (exact(column) for column in R.T)
    return x, y, z


def _combined(columns, factors) -> Vector:
    x, y, z = (scale(Decimal(float(f)), column) for f, column in zip(factors, columns, strict=True))
    return add(add(x, y), z)


def _pose(axes, o) -> Pose:
    X, Y, Z = axes
    return tuple(map(float, (X[0], Y[0], Z[0], X[1], Y[1], Z[1], X[2], Y[2], Z[2], *o)))


def _in_local(chain: Chain, k: int, T: Pose) -> Pose:
    """A pose at x = 0 in the base frame, seen from the chain's own frame of joint k."""
    local = np.eye(4)
    for link in chain.local.frames[: k + 1]:
        local = local @ link
    R, o = np.array(T[:9]).reshape(3, 3), np.array(T[9:])
    seen, there = local[:3, :3].T @ R, local[:3, :3].T @ (o - local[:3, 3])
    return (*seen.ravel().tolist(), *there.tolist())
