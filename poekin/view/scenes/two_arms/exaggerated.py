"""Model b of a comparison as a chain of which one more coordinate says by how much it differs.

The rigid motion e^ξ_i takes the axis of a to that of b, and the joint e^{B_i y_i} is drawn as

    e^{ξ_i (k - 1)} e^{B_i y_i} e^{-ξ_i (k - 1)}

so that its axis is a's at k = 0, b's at k = 1, and differs k times as much at any k: a product of
exponentials again, and so a chain, which the page moves as any other. The zero of b's joints is where
a's are at 0: there y_i = 0, and what is behind a joint stays in its place whatever k is.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from ....analysis.axis_lines import Marks, direction, place, prismatic, uncoupled_at_zero
from ....analysis.compare.alignment.lines import lines
from ....analysis.compare.comparison import NOISE, Comparison
from ....groups import se3, so3
from ....groups.arrays import Array
from ....groups.vectors import angular_part, linear_part, norm
from ....model.chain import Chain

FACTOR = "exaggeration"
"""Name of the coordinate k."""

VISIBLE = 0.1
"""Share of a size that what is enlarged is drawn as at most."""

STEPS = (100.0, 50.0, 20.0, 10.0, 5.0, 2.0)
"""Factors to choose from, beside 1."""


class Exaggerated(NamedTuple):
    """Chain whose last coordinate is k; where its bodies and axes are among its bodies.

    Parameters
    ----------
    b : Chain
        Model b as it is, its zero where a's joints are at 0.
    chain : Chain
        The same, exaggerated; its coordinates are b's and, where something differs, k.
    bodies : tuple of int
        Numbers of b's n + 1 bodies, and last of the body that carries the tool.
    axes : tuple of int
        Numbers of the n bodies that the axes are drawn on.
    moves : (n + 1, 6) ndarray
        Twists ξ_i of the axes and, last, of the tool, in b's base, where all joints are at 0; rad
        and m.
    factor : float
        The k at which the largest difference can be seen; 1 where nothing differs.
    """

    b: Chain
    chain: Chain
    bodies: tuple[int, ...]
    axes: tuple[int, ...]
    moves: Array
    factor: float


def compared_rows(found: Comparison) -> list[int]:
    """Numbers of a's joints that were compared with b's."""
    more = found.unmatched_joints or ("b",)
    dropped = more[1:] if more[0] == "a" else ()
    names = enumerate(found.a.joint_names)
    return [k for k, name in names if name not in dropped]


def exaggerated(found: Comparison) -> Exaggerated:
    """Model b of a comparison, with the coordinate k where an axis differs."""
    a = uncoupled_at_zero(found.a)
    b = found.b
    moves = np.zeros((len(b.screws) + 1, 6))
    if found.base is None:
        return _assembled(b, moves, 1.0)
    b = b.rezeroed([joint.zero_offset for joint in found.joints])
    to_a = se3.adjoint(found.base)
    to_b = se3.adjoint(se3.inverse(found.base))
    ours = lines(a)
    centre = ours.centre
    largest = 0.0
    rows = zip(compared_rows(found), found.joints, strict=True)
    for i, (k, joint) in enumerate(rows):
        if joint.axis_differs:
            axes = np.stack([a.screws[k], to_a @ b.screws[i]])
            slides = np.array([prismatic(a)[k], prismatic(b)[i]])
            move = _motion(axes, slides, ours.places[k] + centre)
            largest = max(largest, _size(move, centre, a.reach))
            moves[i] = to_b @ move
    factor = 1.0
    if largest > NOISE:
        factor = visible_factor(largest, a.reach)
    tip_of_b = found.base @ b.home
    tool = se3.log(tip_of_b @ se3.inverse(a.home))
    if factor * _size(tool, centre, a.reach) < a.reach:
        moves[-1] = to_b @ tool
    return _assembled(b, moves, factor)


def visible_factor(largest: float, size: float, steps: Iterable[float] = STEPS) -> float:
    """The first of some factors by which a length stays within `VISIBLE` of a size; else 1."""
    most = VISIBLE * size
    return next((k for k in steps if k * largest <= most), 1.0)


def _motion(axes: Array, slides: Marks, point: Array) -> Array:
    """Twist ξ that takes the first of two axes (2, 6) to the other by the shortest way at a point of
    the first; where one is that of a slide, its direction alone.
    """
    own, other = direction(axes, slides)
    if own @ other < 0:
        other = -other
    cosine = own @ other
    across = so3.hat(np.cross(own, other))
    R = np.eye(3) + across + across @ across / (1 + cosine)
    p = point - R @ point
    if not slides.any():
        gap = place(axes[1]) - point
        p = p + gap - other * (other @ gap)
    return se3.log(se3.pose(R, p))


def _size(move: Array, centre: Array, reach: float) -> float:
    """Length that a difference is seen as near the arm's middle: a shift, or a tilt over a tenth of
    the reach.
    """
    turn = angular_part(move)
    shift = linear_part(move) + np.cross(turn, centre)
    return norm(shift) + 0.1 * reach * norm(turn)


def _assembled(b: Chain, moves: Array, factor: float) -> Exaggerated:
    """The chain of b's joints, each between the motion of its axis there and back."""
    n = len(b.screws)
    if factor == 1:
        bodies = (*range(n + 1), n)
        return Exaggerated(b, b, bodies, tuple(range(n)), np.zeros((n + 1, 6)), 1.0)
    joints: list[_ChainJoint] = []
    own = np.eye(n + 1)
    bodies = [0]
    axes = []
    for i, move in enumerate(moves):
        screw, size = _unit(move)
        way = np.r_[np.zeros(n), size]
        if size:
            joints.append(_ChainJoint(screw, way, -size, f"{FACTOR} {i + 1}"))
        axes.append(len(joints))
        if i < n:
            joints.append(_ChainJoint(b.screws[i], own[i], 0.0, b.joint_names[i]))
            if size:
                joints.append(_ChainJoint(screw, -way, size, f"{FACTOR} {i + 1} back"))
        bodies.append(len(joints))
    screws, rows, offset, names = zip(*joints, strict=True)
    chain = Chain(
        screws,
        b.home,
        frame="space",
        joint_names=names,
        q_names=[*b.joint_names, FACTOR],
        limits=[*b.limits, (0.0, factor)],
        coupling=np.array(rows),
        offset=offset,
        base=b.base,
        tip=b.tip,
    )
    return Exaggerated(
        b,
        chain,
        bodies=tuple(bodies),
        axes=tuple(axes[:n]),
        moves=moves,
        factor=factor,
    )


class _ChainJoint(NamedTuple):
    """Screw of a joint, its row of the coupling and its offset, and its name."""

    screw: Array
    row: Array
    offset: float
    name: str


def _unit(move: Array) -> tuple[Array, float]:
    """Unit screw and size of a motion, 0 where it is rounding."""
    turn = angular_part(move)
    if norm(turn) <= NOISE:
        turn = np.zeros(3)
    screw, size = se3.axis_angle(np.r_[turn, linear_part(move)])
    return screw, float(size * (size > NOISE))
