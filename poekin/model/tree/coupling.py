"""Coupling: which coordinate each joint of a robot follows, and how, x = ratio q + shift;
`chain_between` makes C and c of x = C q + c of it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from ...errors import ModelError, quote, suggest
from ..checks import read_only
from ..joint import FREE, MOVING, Joint, Mimic
from ..provenance import Source, warn

SLOWEST = float(np.finfo(np.float64).smallest_subnormal)
"""Velocity limit [rad/s or m/s] in place of a quotient that is too small to be a number."""


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


class _Value(NamedTuple):
    """A joint's value: ratio times that of its master, by number, plus shift; -1 stands still."""

    master: int = -1
    ratio: float = 0.0
    shift: float = 0.0


def coupling_of(joints: Sequence[Joint], source: Source) -> Coupling:
    """The coupling of a robot's joints, in linear time and without recursion.

    Raises: ModelError, with file and line where the source has them, for the mimic of a joint that
    does not exist, of itself or in a circle, of a floating or planar joint, and for multipliers
    whose product is not finite.
    """

    def where(index: int) -> str:
        return f"{source.of_joint(index)}: joint {quote(joints[index].name)}"

    numbers = {joint.name: index for index, joint in enumerate(joints)}
    known: dict[int, _Value] = {}
    for start in range(len(joints)):
        _resolve(start, joints, numbers, known, where)
    values = [known[index] for index in range(len(joints))]
    masters = dict.fromkeys(value.master for value in values if value.master >= 0)
    coordinates = {master: number for number, master in enumerate(masters)}
    return Coupling(
        tuple(joints[master].name for master in masters),
        _frozen(list(masters), np.int64),
        _frozen([coordinates.get(value.master, -1) for value in values], np.int64),
        _frozen([value.ratio for value in values], np.float64),
        _frozen([value.shift for value in values], np.float64),
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
    followers = joints[_follow(coupling, joints)]
    with np.errstate(over="ignore"):  # a bound beyond the largest number is no bound
        moved = bounds[followers] - coupling.shift[followers, None]
        ends = moved / coupling.ratio[followers, None]
    coordinate = coupling.coordinate[followers]
    np.maximum.at(lower, coordinate, ends.min(axis=1))
    np.minimum.at(upper, coordinate, ends.max(axis=1))
    torn = (lower >= upper) & ((lower != own[:, 0]) | (upper != own[:, 1]))
    limits = np.where(torn[:, None], own, np.stack([lower, upper], axis=1))
    return limits, np.flatnonzero(torn)


def shared_velocity_limits(
    coupling: Coupling,
    velocities: np.ndarray,
    joints: np.ndarray,
) -> np.ndarray:
    """Greatest |dq| (m,) that keeps each of `joints` (numbers) within its own of `velocities`."""
    shared = np.full(len(coupling.master), np.inf)
    follows = _follow(coupling, joints)
    followers = joints[follows]
    with np.errstate(over="ignore"):  # a velocity beyond the largest number is no bound
        own = velocities[follows] / np.abs(coupling.ratio[followers])
    own = np.maximum(own, SLOWEST)
    np.minimum.at(shared, coupling.coordinate[followers], own)
    return shared


def _follow(coupling: Coupling, joints: np.ndarray) -> np.ndarray:
    """Which of the joints move with a coordinate."""
    return (coupling.coordinate[joints] >= 0) & (coupling.ratio[joints] != 0)


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
    where: Callable[[int], str],
) -> None:
    # Up the mimics to the first joint that is settled or follows none, then back down, composing.
    walk: dict[int, None] = {}
    index = start
    while index not in known:
        joint = joints[index]
        if index in walk:
            through = ", through others" if len(walk) > 1 else ""
            raise ModelError(f"{where(index)} mimics itself{through}")
        walk[index] = None
        if joint.mimic is None:
            known[index] = _Value()
            if joint.kind in MOVING:
                known[index] = _Value(index, 1.0)
            break
        name = joint.mimic.joint
        if name not in numbers:
            close = suggest(name, numbers)
            raise ModelError(f"{where(index)} mimics {quote(name)}, which does not exist; {close}")
        master = numbers[name]
        free = joints[master]
        if free.kind in FREE:
            raise ModelError(
                f"{where(index)} mimics {quote(free.name)}, but a {free.kind} joint has no single value"
            )
        index = master
    for index in reversed(walk):
        joint = joints[index]
        if joint.mimic is None:
            continue
        known[index] = _Value()
        if joint.kind != "fixed":
            followed = known[numbers[joint.mimic.joint]]
            known[index] = _composed(joint.mimic, followed, where(index))


def _composed(mimic: Mimic, followed: _Value, where: str) -> _Value:
    """Value of a joint that mimics another, of which this is the value."""
    ratio = mimic.multiplier * followed.ratio
    shift = mimic.multiplier * followed.shift + mimic.offset
    if not (math.isfinite(ratio) and math.isfinite(shift)):
        raise ModelError(f"{where}: the product of its chain of multipliers is not finite")
    return _Value(followed.master, ratio, shift)


def _frozen(values: list, dtype: type) -> np.ndarray:
    return read_only(np.array(values, dtype=dtype))
