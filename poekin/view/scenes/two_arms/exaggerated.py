"""Model b of a comparison as a chain of which one more coordinate says by how much it differs.

The rigid motion e^ξ_i takes the axis of a to that of b, and the joint e^{B_i y_i} is drawn as

    e^{ξ_i (k - 1)} e^{B_i y_i} e^{-ξ_i (k - 1)}

so that its axis is a's at k = 0, b's at k = 1, and differs k times as much at any k: a product of
exponentials again, and so a chain, which the page moves as any other.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ....analysis.axis_lines import direction, place, prismatic
from ....analysis.compare.alignment.lines import lines
from ....analysis.compare.comparison import NOISE, Comparison
from ....groups import se3, so3
from ....groups.arrays import Array
from ....model.chain import Chain

FACTOR = "exaggeration"
"""Name of the coordinate k."""

VISIBLE = 0.1
"""Share of the arm's size that the largest difference is drawn as."""

STEPS = (100.0, 50.0, 20.0, 10.0, 5.0, 2.0, 1.0)
"""Factors to choose from."""


class Exaggerated(NamedTuple):
    """Chain whose last coordinate is k; where its bodies and axes are among its bodies.

    Parameters
    ----------
    chain : Chain
        Model b; its coordinates are b's and, where something differs, k.
    bodies : tuple of int
        Numbers of b's n + 1 bodies, and last of the body that carries the tool.
    axes : tuple of int
        Numbers of the n bodies that the axes are drawn on.
    moves : (n, 6) ndarray
        Twists ξ_i in b's base, where all of b's joints are at 0; rad and m.
    factor : float
        The k at which the largest difference can be seen; 1 where nothing differs.
    """

    chain: Chain
    bodies: tuple[int, ...]
    axes: tuple[int, ...]
    moves: Array
    factor: float


def zeros_and_directions(found: Comparison) -> tuple[Array, Array]:
    """Positions of b's joints when a's are at 0, rad or m, and their signs, ±1."""
    zeros = np.array([joint.zero_offset for joint in found.joints])
    return zeros, np.array([-1.0 if joint.reversed else 1.0 for joint in found.joints])


def compared_rows(found: Comparison) -> list[int]:
    """Numbers of a's joints that were compared with b's."""
    more = found.unmatched_joints or ("b",)
    dropped = more[1:] if more[0] == "a" else ()
    return [k for k, name in enumerate(found.a.joint_names) if name not in dropped]


def exaggerated(found: Comparison) -> Exaggerated:
    """Model b of a comparison, with the coordinate k where an axis differs."""
    b = found.b
    n = len(b.screws)
    if not found.joints:
        return Exaggerated(b, (*range(n + 1), n), tuple(range(n)), np.zeros((n, 6)), 1.0)
    carriers = _carriers(found)
    rows = compared_rows(found)
    ours = lines(found.a)
    moves = np.zeros((n + 1, 6))
    sizes = [0.0]
    for i, joint in enumerate(found.joints):
        if joint.axis_differs:
            theirs = se3.adjoint(carriers[i]) @ b.screws[i]
            move = _motion(found.a, b, (rows[i], i), theirs, ours.places[rows[i]] + ours.centre)
            sizes.append(_size(move, ours.centre, found.a.reach))
            moves[i] = se3.adjoint(se3.inverse(carriers[i])) @ move
    factor = _factor(max(sizes), found.a.reach)
    tool = se3.log(carriers[n] @ b.home @ se3.inverse(found.a.home))
    if factor > 1 and factor * _size(tool, ours.centre, found.a.reach) < found.a.reach:
        moves[n] = se3.adjoint(se3.inverse(carriers[n])) @ tool
    return _assembled(b, moves, factor)


def _carriers(found: Comparison) -> list[Array]:
    """Poses in a's base of what b's joints carry at a's zeros: base e^{B_1 z_1} ... e^{B_i z_i}."""
    carriers = [np.eye(4) if found.base is None else found.base]
    zeros, _ = zeros_and_directions(found)
    for screw, zero in zip(found.b.screws, zeros, strict=True):
        carriers.append(carriers[-1] @ se3.exp(screw * zero))
    return carriers


def _motion(a: Chain, b: Chain, numbers: tuple[int, int], theirs: Array, point: Array) -> Array:
    """Twist ξ that takes a's axis to b's, `theirs` in a's base, by the shortest way at a point of
    a's.
    """
    i, j = numbers
    slides = np.array([prismatic(a)[i], prismatic(b)[j]])
    own, other = direction(np.stack([a.screws[i], theirs]), slides)
    if own @ other < 0:
        other = -other
    turn = np.eye(4)
    turn[:3, :3] = _turn(own, other)
    moved = np.eye(4)
    if not slides.any():
        without_pitch = theirs - np.r_[0.0, 0.0, 0.0, theirs[:3] * b.pitches[j]]
        gap = place(without_pitch) - point
        moved[:3, 3] = gap - other * (other @ gap)
    there = np.eye(4)
    there[:3, 3] = point
    return se3.log(moved @ there @ turn @ se3.inverse(there))


def _turn(own: Array, other: Array) -> Array:
    """The smallest rotation that takes one unit vector to another that is less than π away."""
    across = np.cross(own, other)
    sine = float(np.linalg.norm(across))
    if sine == 0:
        return np.eye(3)
    return so3.exp(across / sine * np.arctan2(sine, own @ other))


def _size(move: Array, centre: Array, reach: float) -> float:
    """Length that a difference is seen as near the arm's middle: a shift, or a tilt over a tenth of
    the reach.
    """
    shift = move[3:] + np.cross(move[:3], centre)
    return float(np.linalg.norm(shift) + 0.1 * reach * np.linalg.norm(move[:3]))


def _factor(largest: float, reach: float) -> float:
    """The largest factor of `STEPS` by which a difference stays within `VISIBLE`."""
    if largest <= NOISE:
        return 1.0
    return next((k for k in STEPS if k * largest <= VISIBLE * reach), 1.0)


def _assembled(b: Chain, moves: Array, factor: float) -> Exaggerated:
    """The chain of b's joints, each between the motion of its axis there and back."""
    n = len(b.screws)
    if factor == 1:
        return Exaggerated(b, (*range(n + 1), n), tuple(range(n)), np.zeros((n, 6)), 1.0)
    screws: list[Array] = []
    rows: list[Array] = []
    offset: list[float] = []
    names: list[str] = []
    bodies = [0]
    axes = []

    def add(screw: Array, row: Array, constant: float, name: str) -> None:
        screws.append(screw)
        rows.append(row)
        offset.append(constant)
        names.append(name)

    for i, move in enumerate(moves):
        size, unit = _unit(move)
        way = np.r_[np.zeros(n), size]
        if size:
            add(unit, way, -size, f"{FACTOR} {i + 1}")
        axes.append(len(screws))
        if i < n:
            add(b.screws[i], np.eye(n + 1)[i], 0.0, b.joint_names[i])
            if size:
                add(unit, -way, size, f"{FACTOR} {i + 1} back")
        bodies.append(len(screws))
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
    return Exaggerated(chain, tuple(bodies), tuple(axes[:n]), moves[:n], factor)


def _unit(move: Array) -> tuple[float, Array]:
    """Size and unit screw of a motion; a size of 0 where there is none."""
    turned = float(np.linalg.norm(move[:3]))
    if turned > NOISE:
        return turned, move / turned
    shifted = float(np.linalg.norm(move[3:]))
    if shifted <= NOISE:
        return 0.0, move
    return shifted, np.r_[0.0, 0.0, 0.0, move[3:] / shifted]
