"""The paper's local form with z-aligned link frames, computed from the screws alone.

    f = M_1 e^{S x_1} M_2 e^{S x_2} ... M_n e^{S x_n} M_{n+1},  S = (0, 0, r; 0, 0, s)

Where a link frame sits along its axis and how it is turned about it is free. Here its origin is the
point of the axis nearest to the previous frame's origin and its axes are turned as little as
possible: so the numbers stay small, and nothing blows up where axes are parallel.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ... import algebra
from ...engine.kernels import chain_kernels
from ...groups.arrays import Array
from ...groups.vectors import angular_part, rotation_part, translation_part
from ..checks import read_only


class LocalForm(NamedTuple):
    """Constant poses and z-aligned screws of a chain of n joints.

    Attributes
    ----------
    frames : (n + 1, 4, 4) ndarray
        Poses M_1 ... M_{n+1} of each joint's frame in the one before, and of the tool, m.
    rotates : (n,) ndarray
        Factors: joint i turns by rotates[i] x_i about its z axis, rad.
    slides : (n,) ndarray
        Factors: joint i slides by slides[i] x_i along its z axis, m.

    Notes
    -----
    Source: Park 1994, Section IV, with a trailing tool M_{n+1}.
    """

    frames: Array
    rotates: Array
    slides: Array


def local_form(screws: Array, home: Array, pitches: Array) -> LocalForm:
    """The local form of checked screws (n, 6) in the base frame, the home pose (4, 4) and the
    pitches (n,).
    """
    turning = np.any(angular_part(screws), axis=1)
    here = algebra.IDENTITY  # T_base_link
    links = []
    for S, turns in zip(screws.tolist(), turning.tolist(), strict=True):
        before = algebra.translation(here)
        z = algebra.linear(S)
        origin = before
        if turns:
            z = algebra.angular(S)
            foot = algebra.cross(z, algebra.linear(S))
            gap = algebra.subtract(before, foot)
            origin = algebra.add(foot, algebra.scale(algebra.dot(z, gap), z))
        moved = algebra.subtract(origin, before)
        turned = turned_least(*algebra.unrotate(here, z))
        link = algebra.make_pose(turned, algebra.unrotate(here, moved))
        links.append(link)
        here = algebra.make_pose(algebra.compose(here, link), origin)
    X, Y, Z, tip = home[:3].T.tolist()
    to_tip = algebra.subtract(tip, algebra.translation(here))
    tool = (algebra.unrotate(here, a) for a in (X, Y, Z, to_tip))
    rows = np.array([*links, algebra.from_axes(*tool)]) + 0.0  # no zero with a sign
    frames = np.zeros((len(rows), 4, 4))
    frames[:, :3, :3] = rows[:, :9].reshape(-1, 3, 3)
    frames[:, :3, 3] = rows[:, 9:]
    frames[:, 3, 3] = 1.0
    slides = np.where(turning, pitches, 1.0)
    return LocalForm(read_only(frames), read_only(turning.astype(float)), read_only(slides))


def turned_least(x: float, y: float, z: float) -> tuple[float, ...]:
    """The rotation, row by row, that takes (0, 0, 1) to the direction of (x, y, z) by the smallest
    angle; by way of diag(1, -1, -1) where that points down, so that it has no singularity.
    """
    length = math.hypot(x, y, z)
    s = 1.0 if z >= 0 else -1.0
    x /= length
    y *= s / length
    c = s * z / length
    k = 1.0 / (1.0 + c)
    return (
        *(1.0 - k * x * x, -k * x * y, x),
        *(-s * k * x * y, s - s * k * y * y, s * y),
        *(-s * x, -s * y, s * c),
    )


def kernel_table(form: LocalForm, coupling: Array | None, offset: Array) -> Array:
    """The numbers of a chain as the kernels read them; see `poekin.engine.kernels.chain_kernels`."""
    n = len(offset)
    if coupling is None and offset.any():
        coupling = np.eye(n)
    width = chain_kernels.OFFSET
    if coupling is not None:
        width = chain_kernels.COUPLING + coupling.shape[1]
    table = np.zeros((n + 1, width))
    table[:, :9] = rotation_part(form.frames).reshape(n + 1, 9)
    table[:, 9:12] = translation_part(form.frames)
    table[:n, chain_kernels.ROTATES] = form.rotates
    table[:n, chain_kernels.SLIDES] = form.slides
    if coupling is not None:
        table[:n, chain_kernels.OFFSET] = offset
        table[:n, chain_kernels.COUPLING :] = coupling
    return table
