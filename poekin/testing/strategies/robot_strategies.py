"""Hypothesis strategies for robots: whole trees of links and joints, with mimic joints, limits and
several leaves.

The links and joints of a robot are in any order, as they are in files, and not in the tree's. As
URDF: `robots().map(poekin.to_urdf)`. Configurations:
`configuration_strategies.within_limits(robot)` and the like.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from ...model.joint import KINDS, MOVING, Joint, JointKind, Mimic
from ...model.robot import Robot
from . import arguments
from .chain_strategies import RATIOS, REACHES
from .decoding import decoders
from .decoding.bytes_reader import BytesReader
from .group_strategies import pose, read, st

URDF_KINDS = ("revolute", "continuous", "prismatic", "fixed")
"""The kinds that every reader of URDF has to know."""
TRAVEL = {"revolute": math.pi, "helical": math.pi, "prismatic": 1.0}
"""How far from 0 a lower limit lies at most, in rad or m; the upper one lies 0.1 to 3 from it, of
what slides to 2.
"""


def robots(
    kinds: Sequence[str] = URDF_KINDS,
    min_joints: int = 0,
    max_joints: int = 7,
    *,
    mimics: bool = True,
    limits: bool = True,
    still: bool = False,
) -> st.SearchStrategy[Robot]:
    """Robots: trees of joints, of which some mimic others.

    Half of the joints go on from the link before, the others branch off anywhere. Origins are as in
    `chain_strategies.placements` (m), axes as in `strategies.axes`, each in its own joint's frame. A
    mimic joint follows any other one that moves, above it, below it or beside, by a ratio (also 0 and
    negative) and an offset, also by way of a third. Limits hold 0 or not, and are missing on continuous
    joints; those of a mimic joint may be narrower than what follows from its master, and always leave
    something of it. Multipliers, offsets, limits and pitches have one decimal or three, and shrink to 0,
    1 or one decimal.

    Parameters
    ----------
    kinds : sequence of str
        Kinds of joints, of `poekin.model.joint.KINDS`.
    min_joints, max_joints : int, default 0 and 7
        Smallest and largest number of joints, fixed ones included.
    mimics : bool, default True
        Whether there are mimic joints.
    limits : bool, default True
        Whether revolute, prismatic and helical joints have limits.
    still : bool, default False
        Whether fixed joints, too, mimic and are mimicked (what follows one is constant).

    Returns
    -------
    strategy : SearchStrategy
        Strategy of `Robot` with links "l0" (the root), "l1", … and joints "j1", …, joint jk moving link
        lk, each in any order; shrinks to one link, then to short chains.

    Raises
    ------
    InputError
        For kinds or numbers of joints that there are not.

    Notes
    -----
    Source: what URDF readers are known to get wrong (`conform.laws.urdf_cases`).

    Examples
    --------
    >>> from hypothesis import given
    >>> import poekin as pk
    >>> from poekin.testing import strategies
    >>> @given(strategies.robots(min_joints=1).map(pk.to_urdf))
    ... def test_a_joint_is_written(text):
    ...     assert "<joint" in text
    >>> test_a_joint_is_written()
    """
    least, most = arguments.counts(min_joints, max_joints)
    some = arguments.some("kinds", kinds, KINDS)
    row = read(_BYTES, lambda r: _row(r, some))
    rows = st.lists(row, min_size=least, max_size=most)
    return rows.map(lambda rows: _robot(rows, mimics, limits, still))


class _Row(NamedTuple):
    """Draws for one joint, as far as it goes without the others; whole numbers are bytes."""

    kind: JointKind
    branches: bool
    parent: int
    follows: bool
    master: int
    multiplier: float
    offset: float
    limits: tuple[float, float]
    margins: tuple[float, float]
    rank: int
    places: tuple[int, int, int]
    origin: np.ndarray
    axis: np.ndarray
    pitch: float


_BYTES = 87


def _row(r: BytesReader, kinds: Sequence[Any]) -> _Row:
    # Zeros: the first kind, onwards from the link before, of its own, in the tree's order, at the
    # origin, about x.
    return _Row(
        kind=r.pick(kinds),
        branches=r.byte() >= 128,
        parent=r.byte(),
        follows=r.byte() >= 128,
        master=r.byte(),
        multiplier=_multiplier(r),
        offset=r.decimal(-1.0, 1.0),
        limits=(r.decimal(-1.0, 1.0), r.decimal(-0.9, 1.0)),
        margins=(r.decimal(-0.9, 1.0), r.decimal(-0.9, 1.0)),
        rank=r.byte(),
        places=(r.byte(), r.byte(), r.byte()),
        origin=pose(decoders.rotation(r), decoders.vector(r, REACHES)),
        axis=decoders.axis(r),
        pitch=r.decimal(-0.5, 0.5),
    )


def _multiplier(r: BytesReader) -> float:
    if r.byte() < 128:
        return r.pick(RATIOS)
    return r.decimal(-2.0, 2.0)


def _width(share: float, travel: float) -> float:
    """A width or margin in rad or m, 0.1 to 3, of what slides to 2; 1 for 0."""
    return 1.0 + share * (2.0 if travel > 1 and share > 0 else 1.0)


def _robot(
    rows: list[_Row],
    mimics: bool,
    limits: bool,
    still: bool,
) -> Robot:
    joints = []
    for k, row in enumerate(rows):
        parent = k
        if row.branches:
            parent = row.parent * (k + 1) // 256
        joint = Joint(f"j{k + 1}", row.kind, f"l{parent}", f"l{k + 1}", row.origin, row.axis)
        if row.kind == "helical":
            joint = replace(joint, pitch=row.pitch)
        joints.append(joint)
    numbers = range(len(rows))
    order = sorted(numbers, key=lambda k: rows[k].rank)
    kinds = (*MOVING, "fixed") if still else MOVING
    able = [k for k in order if joints[k].kind in kinds]
    for place, k in enumerate(able):
        row = rows[k]
        # A joint mimics one that comes earlier in this order, so that no circle can arise.
        if mimics and place and row.follows:
            earlier = able[row.master * place // 256]
            mimic = Mimic(joints[earlier].name, row.multiplier, row.offset)
            joints[k] = replace(joints[k], mimic=mimic)
    if limits:
        joints = _limited(joints, rows, order)
    of_links = sorted(numbers, key=lambda k: rows[k].places[0])
    links = [f"l{k + 1}" for k in of_links]
    root = rows[0].places[2] * len(links) // 256 if rows else 0
    links.insert(root, "l0")
    of_joints = sorted(numbers, key=lambda k: rows[k].places[1])
    return Robot("robot", links, [joints[k] for k in of_joints])


def _limited(
    joints: list[Joint],
    rows: list[_Row],
    order: list[int],
) -> list[Joint]:
    """With limits on what has some; the middle of each coordinate's own is within those of all that
    follow it.
    """
    result = list(joints)
    middles = {}
    for k in order:
        joint = joints[k]
        travel = TRAVEL.get(joints[k].kind, 0.0)
        if joint.mimic is not None and joint.kind != "fixed":
            master = middles[joint.mimic.joint]
            middle = joint.mimic.multiplier * master + joint.mimic.offset
            lower, upper = (
                middle + sign * _width(x, travel)
                for sign, x in zip((-1, 1), rows[k].margins, strict=True)
            )
        else:
            lower = travel * rows[k].limits[0]
            upper = lower + _width(rows[k].limits[1], travel)
            middle = (lower + upper) / 2
        middles[joint.name] = middle
        if travel:
            interval = (round(lower, 3), round(upper, 3))
            result[k] = replace(joint, limits=interval)
    return result
