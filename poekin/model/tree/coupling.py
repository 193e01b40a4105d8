"""Coupling: which coordinate each joint of a robot follows, and how, x = ratio q + shift."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ...errors import ModelError, quote, suggest
from ..checks import read_only
from ..joint import FREE, MOVING, Joint, Mimic
from ..provenance import Source, warn


class Coupling(NamedTuple):
    """x_j = ratio_j q_{coordinate_j} + shift_j for every joint j of a robot.

    q_names (m): coordinates in order of first appearance, each named after its master joint; master
    (m,): the number of that joint. coordinate (J,): the number of the coordinate, -1 where the
    joint stands still; ratio, shift (J,).
    A mimic of a mimic is composed, a mimic of a fixed joint is constant.
    """

    q_names: tuple[str, ...]
    master: np.ndarray
    coordinate: np.ndarray
    ratio: np.ndarray
    shift: np.ndarray


_Value = tuple[int, float, float]
"""The master's number of a joint, or -1 where it stands still, and its ratio and shift."""


def coupling_of(joints: Sequence[Joint], source: Source) -> Coupling:
    """The coupling of a robot's joints, in linear time and without recursion.

    Raises: ModelError, with file and line where the source has them, for the mimic of a joint that
    does not exist, of itself or in a circle, of a floating or planar joint, and for multipliers
    whose product is not finite.
    """
    numbers = {joint.name: index for index, joint in enumerate(joints)}
    known: dict[int, _Value] = {}
    for start in range(len(joints)):
        _resolve(start, joints, numbers, known, source)
    values = [known[index] for index in range(len(joints))]
    coordinates: dict[int, int] = {}
    for master, _, _ in values:
        if master >= 0:
            coordinates.setdefault(master, len(coordinates))
    return Coupling(
        tuple(joints[master].name for master in coordinates),
        _frozen(list(coordinates), np.int64),
        _frozen([coordinates.get(master, -1) for master, _, _ in values], np.int64),
        _frozen([ratio for _, ratio, _ in values], np.float64),
        _frozen([shift for _, _, shift in values], np.float64),
    )


def shared_limits(
    coupling: Coupling,
    bounds: np.ndarray,
    joints: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Limits (m, 2) on q that keep every one of `joints` (numbers) within its bounds (J, 2), and
    where there are none.

    Each joint's interval is mapped through q = (x - shift) / ratio, and the intervals of one
    coordinate are intersected. Where no more than a point is left, the joints contradict each
    other: the master's own limits stand, and the coordinate is listed in the second array.
    """
    own = bounds[coupling.master]
    lower = np.full(len(own), -np.inf)
    upper = np.full(len(own), np.inf)
    followers = joints[(coupling.coordinate[joints] >= 0) & (coupling.ratio[joints] != 0)]
    with np.errstate(over="ignore"):  # a bound beyond the largest number is no bound
        ends = (bounds[followers] - coupling.shift[followers, None]) / coupling.ratio[
            followers,
            None,
        ]
    coordinate = coupling.coordinate[followers]
    np.maximum.at(lower, coordinate, ends.min(axis=1))
    np.minimum.at(upper, coordinate, ends.max(axis=1))
    torn = (lower >= upper) & ((lower != own[:, 0]) | (upper != own[:, 1]))
    limits = np.where(torn[:, None], own, np.stack([lower, upper], axis=1))
    return limits, np.flatnonzero(torn)


def warn_of_torn_limits(
    coupling: Coupling,
    torn: np.ndarray,
    joints: Sequence[Joint],
    source: Source,
) -> None:
    """One warning for all coordinates whose followers' limits leave nothing in common."""
    if len(torn):
        first = int(coupling.master[torn[0]])
        more = f" (nor do those of {len(torn) - 1} more coordinates)" if len(torn) > 1 else ""
        warn(
            f"{source.of_joint(first)}: the limits of the joints that follow {quote(joints[first].name)} have no"
            f" interval in common{more}: its own limits {list(joints[first].limits)} stand"
        )


def _resolve(
    start: int,
    joints: Sequence[Joint],
    numbers: dict[str, int],
    known: dict[int, _Value],
    source: Source,
) -> None:
    # Up the mimics to the first joint that is settled or follows none, then back down, composing.
    walk: dict[int, None] = {}
    index = start
    while index not in known:
        joint = joints[index]
        if index in walk:
            through = ", through others" if len(walk) > 1 else ""
            raise ModelError(f"{_where(index, joints, source)} mimics itself{through}")
        walk[index] = None
        if joint.mimic is None:
            known[index] = (-1, 0.0, 0.0)
            if joint.kind in MOVING:
                known[index] = (index, 1.0, 0.0)
            break
        if joint.mimic.joint not in numbers:
            name = joint.mimic.joint
            where = _where(index, joints, source)
            raise ModelError(
                f"{where} mimics {quote(name)}, which does not exist; {suggest(name, numbers)}"
            )
        master = numbers[joint.mimic.joint]
        if joints[master].kind in FREE:
            free = joints[master]
            where = _where(index, joints, source)
            raise ModelError(
                f"{where} mimics {quote(free.name)}, but a {free.kind} joint has no single value"
            )
        index = master
    for index in reversed(walk):
        mimic = joints[index].mimic
        if mimic is not None:
            known[index] = _composed(index, mimic, known[numbers[mimic.joint]], joints, source)


def _composed(
    index: int,
    mimic: Mimic,
    followed: _Value,
    joints: Sequence[Joint],
    source: Source,
) -> _Value:
    """Value of a joint that mimics another, of which this is the value."""
    if joints[index].kind == "fixed":
        return -1, 0.0, 0.0
    master, ratio, shift = followed
    ratio = mimic.multiplier * ratio
    shift = mimic.multiplier * shift + mimic.offset
    if not (math.isfinite(ratio) and math.isfinite(shift)):
        where = _where(index, joints, source)
        raise ModelError(f"{where}: the product of its chain of multipliers is not finite")
    return master, ratio, shift


def _where(index: int, joints: Sequence[Joint], source: Source) -> str:
    return f"{source.of_joint(index)}: joint {quote(joints[index].name)}"


def _frozen(values: list, dtype: type) -> np.ndarray:
    return read_only(np.array(values, dtype=dtype))
