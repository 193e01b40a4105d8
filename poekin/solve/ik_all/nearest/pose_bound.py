"""Bound of the pose difference of two arms that have the same joints, over all coordinates.

    f = e^{A_1 x_1} ... e^{A_n x_n} M,   f' = E_1 e^{A_1 x_1} E_1^-1 ... E_n e^{A_n x_n} E_n^-1 E_n+1 M

where E_i moves axis i of one arm to that of the other, and E_n+1 M is its home pose. With
g_i = E_i^-1 E_i+1 (E_0 = 1) in place of 1, one after the other from the tip on, what stands before
is a rigid motion and what stands behind moves the tip to a point no further from the point o_i+1 of
axis i + 1 than all lengths between the axes' points, one after the other:

    |p' - p| <= sum |g_i o_i+1 - o_i+1| + 2 sin(θ_i / 2) l_i+1,   θ <= sum θ_i

with θ_i the angle of g_i and l_i that length. A turn of E_i about axis i and a slide along it change
nothing in f'; they are chosen to make the sums small, by reweighted least squares.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ....analysis.axis_lines import Marks, place, prismatic
from ....groups import se3, so3
from ....groups.arrays import ROUNDOFF, Array
from ....groups.vectors import (
    applied,
    directions,
    dots,
    norms,
    rotation_part,
    translation_part,
)
from ....model.chain_data import ChainData
from ....model.sampling import largest_slides

_REWEIGHTED = 6  # rounds after which the sums hardly become less


class PoseBound(NamedTuple):
    """Bounds of the distance of two arms' tips, m, and of the angle between them, rad."""

    position: float
    rotation: float


class _Links(NamedTuple):
    """Motions E (n + 2, 4, 4) of base, axes and tool, points o (n + 2, 3) of the given ones, lever
    arms (n + 1,) behind each but the base, and twists (n, 6, 4) that are free of each axis.
    """

    E: Array
    o: Array
    lever: Array
    free: Array


def pose_bound(given: ChainData, other: ChainData) -> PoseBound:
    """Bound of the pose difference of two chains of the same kinds of joints and the same coupling,
    for every x of joints that turn, and within the ranges of joints that slide.
    """
    links = _links(given, other)
    n = len(links.o) - 2
    rounding = 16 * ROUNDOFF * (n + 2)
    farthest = float(np.abs(links.o).max())
    size = max(given.reach, float(links.lever.max()), farthest)
    for_position = _chosen(links, links.lever, 1.0)
    for_rotation = _chosen(links, np.ones(n + 1), 0.0)
    position = _sums(links, for_position).position
    rotation = _sums(links, for_rotation).rotation
    return PoseBound(position + rounding * size, rotation + rounding)


def _links(given: ChainData, other: ChainData) -> _Links:
    n = len(given.kinds)
    slides = prismatic(given)
    w = directions(given.screws)
    u = directions(other.screws)
    feet = place(given.screws)
    there = place(other.screws)
    o = _shortest_way(w, feet, slides, translation_part(given.home))
    on_axes = o[1:-1]
    R = _least_turn(w, u)
    along = dots(on_axes - there, u)
    ends = np.where(slides[:, None], on_axes, there + along * u)
    E = np.zeros((n + 2, 4, 4))
    E[:] = np.eye(4)
    E[1:-1, :3, :3] = R
    E[1:-1, :3, 3] = ends - applied(R, on_axes)
    E[-1] = other.home @ se3.inverse(given.home)
    gaps = norms(np.diff(o[1:], axis=0))
    lengths = gaps + largest_slides(given)
    from_tip = np.cumsum(lengths[::-1])
    lever = np.append(from_tip[::-1], 0.0)
    return _Links(E, o, lever, _free_twists(w, on_axes, slides))


def _shortest_way(w: Array, feet: Array, slides: Marks, tip: Array) -> Array:
    """Points (n + 2, 3): the base's, of each axis, and the tip, on a short way through all axes; a
    joint that slides has its point anywhere.
    """
    o = np.concatenate([feet[:1], feet, tip[None]])
    n = len(w)
    identity = np.eye(3)
    across = identity - w[:, :, None] * w[:, None]
    across[slides] = 0
    # Least squares of the lengths: a chain of springs, each end kept on its axis.
    springs = np.zeros((n, 3, n, 3))
    right = np.zeros((n, 3))
    stiff = 1e6
    for i in range(n):
        kept = stiff * across[i]
        springs[i, :, i] += kept
        right[i] += kept @ feet[i]
        for j in (i - 1, i + 1):
            if 0 <= j < n:
                springs[i, :, i] += identity
                springs[i, :, j] -= identity
            elif j == n:
                springs[i, :, i] += identity
                right[i] += tip
    stiffness = springs.reshape(3 * n, 3 * n)
    found = np.linalg.solve(stiffness, right.ravel()).reshape(n, 3)
    along = dots(found - feet, w)
    o[1:-1] = np.where(slides[:, None], found, feet + along * w)
    o[0] = o[1]
    return o


def _least_turn(w: Array, u: Array) -> Array:
    """Rotations (n, 3, 3) by the least angle from unit directions w to u."""
    c = np.cross(w, u)
    sine = np.linalg.norm(c, axis=1, keepdims=True)
    angle = np.arctan2(sine, dots(w, u))
    with np.errstate(invalid="ignore", divide="ignore"):
        axis = np.where(sine > 0, c / sine, 0.0)
    return so3.exp(axis * angle)


def _free_twists(w: Array, o: Array, slides: Marks) -> Array:
    """Twists (n, 6, 4) that change nothing of an axis: a turn and a slide, and any shift of a joint
    that slides; 0 where there are fewer.
    """
    free = np.zeros((len(w), 6, 4))
    free[:, :3, 0] = w
    free[:, 3:, 0] = np.cross(o, w)
    free[:, 3:, 1] = w
    free[slides, 3:, 1:] = np.eye(3)
    return free


class _Differences(NamedTuple):
    """Turn and velocity at each axis' point between neighbouring motions, of first order: `constant`
    (n + 1, 2, 3) and what the free twists' amounts (4 n,) add, (n + 1, 2, 3, 4 n).
    """

    constant: Array
    rows: Array


def _differences(links: _Links) -> _Differences:
    n = len(links.o) - 2
    eta = se3.log(links.E)
    rows = np.zeros((n + 1, 2, 3, n, 4))
    constant = np.zeros((n + 1, 2, 3))
    for i in range(n + 1):
        point = links.o[i + 1]
        constant[i] = _at(eta[i + 1] - eta[i], point)
        if i < n:
            rows[i, :, :, i] += _at(links.free[i], point)
        if i > 0:
            rows[i, :, :, i - 1] -= _at(links.free[i - 1], point)
    return _Differences(constant, rows.reshape(n + 1, 2, 3, 4 * n))


def _chosen(links: _Links, levers: Array, of_shift: float) -> Array:
    """Motions E with the turns and slides that make the sum of |shift| and angle times lever small."""
    constant, rows = _differences(links)
    unknowns = rows.shape[-1]
    shifts = np.full(len(levers), of_shift)
    scale = np.stack([levers, shifts], axis=1)
    weight = np.ones_like(scale)
    x = np.zeros(unknowns)
    for _ in range(_REWEIGHTED):
        W = (scale * weight)[:, :, None]
        A = (W[..., None] * rows).reshape(-1, unknowns)
        b = -(W * constant).ravel()
        x, *_ = np.linalg.lstsq(A, b, rcond=1e-12)
        left = constant + (rows.reshape(-1, unknowns) @ x).reshape(constant.shape)
        size = scale * norms(left)
        if not size.any():
            break
        weight = 1 / np.sqrt(size + 1e-3 * size.max())
    E = links.E.copy()
    # E_i e^{a A_i}: the turn comes first, so that it is about the given axis.
    amounts = np.asarray(x, float).reshape(len(links.free), 4)
    E[1:-1] = E[1:-1] @ se3.exp(applied(links.free, amounts))
    return E


def _at(twist: Array, point: Array) -> Array:
    """Turn and velocity (2, 3, ...) of a twist (6, ...) at a point."""
    w = twist[:3]
    v = twist[3:] + np.cross(w, point, axisa=0, axisc=0)
    return np.stack([w, v])


def _sums(links: _Links, E: Array) -> PoseBound:
    g = se3.inverse(E[:-1]) @ E[1:]
    R = rotation_part(g)
    angle = norms(so3.log(R))
    o = links.o[1:]
    shift = norms(applied(R, o) + translation_part(g) - o)
    swing = 2 * np.sin(angle / 2) * links.lever
    position = (shift + swing).sum()
    return PoseBound(float(position), float(angle.sum()))
