"""A chain as a robot of one branch, for formats that know links and joints.

A link's joint follows one coordinate at most, and its own value *is* that coordinate where no other
joint is its master. x = C q + c says more than that, so each row of C is told apart here: a
constant, a master, a follower.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..errors import InputError, join_names, quote
from ..groups import se3
from ..model.chain import Chain
from ..model.joint import Joint, Mimic
from ..model.kinematics.arm import Arm, chain_of
from ..model.provenance import warn
from ..model.readings.coupled import own_limits, own_readings, own_speeds
from ..model.readings.statements import make_statements
from ..model.robot import Robot
from ..model.tree.link_masses import LinkMass, is_mass
from .common.limits import UNBOUNDED, Interval
from .common.names import free_name


class Value(NamedTuple):
    """Value of joint i of the chain from the value y of the robot's joint: x = sign y + start.

    Fields: sign, start; limits of y; mimic, of y; moves, False where x is constant; velocity limit.
    """

    sign: float = 1.0
    start: float = 0.0
    limits: Interval = UNBOUNDED
    mimic: Mimic | None = None
    moves: bool = True
    velocity: float = math.inf


def serial_robot(chain: Arm) -> Robot:
    """The robot of one branch with the kinematics of a chain: base, a link after each joint, tip.

    Frames are the z-aligned ones of `chain.local`: a chain does not know its links' own. Joint i
    has its name in the chain, its axis is z or -z, and its link is called after it; a last, fixed
    joint holds the tip.

    Of the joints that follow a coordinate, the first one with x = q is its master and gives it its
    name, and the others mimic that one. If none has, the first one with x = q + c or x = -q + c is,
    its c moved into its origin and its axis turned round, so that the values of q stay what they
    are. If none has that either, the first that follows it is, and the robot's coordinate is that
    joint's own x. A joint that follows no coordinate becomes a fixed one. Limits of masters are
    those of the chain to the last digit, velocity limits too; a follower's are as wide as its master's
    leave it.

    Parameters: chain. Returns: Robot, called BASE_to_TIP; its q is in order of first appearance.
    Where a joint follows several readings of the joints' own names, the robot's joints have their
    own values, and its readings are coupled.
    Raises: InputError for a joint that follows several other coordinates, for base and tip of the same
    name, and for what is no chain. Warns: PoekinWarning where q is no longer the same: another
    scale, another order, a coordinate left out because no joint follows it.
    Accuracy: that of the local form; about 1e-16 reach a joint. Source: Park 1994, Section IV.
    """
    chain = chain_of(chain)
    name = f"{chain.base}_to_{chain.tip}"
    if chain.base == chain.tip:
        if not chain.joint_names and np.array_equal(chain.home, np.eye(4)):
            return Robot(name, [chain.base], [])
        raise InputError(
            f"the chain's base and tip are both called {quote(chain.base)}, and two links cannot be: give one another"
            ' name, as in chain.retooled(np.eye(4), tip="tool")'
        )
    readings = own_readings(chain)
    if readings is not None:
        own = chain.replace(
            coupling=None,
            q_names=chain.joint_names,
            limits=own_limits(chain) - chain.offset[:, None],
            velocity_limits=own_speeds(chain),
        )
        return serial_robot(own).coupled(make_statements(readings, chain.joint_names))
    ends = {chain.base, chain.tip}
    links = [
        chain.base,
        *(free_name(f"{joint}_link", ends) for joint in chain.joint_names),
        chain.tip,
    ]
    values, masters, changes = _values(chain)
    joints = [_joint(chain, i, value, links[i], links[i + 1]) for i, value in enumerate(values)]
    fixed = free_name(f"{chain.tip}_joint", set(chain.joint_names))
    origin = chain.local.frames[-1]
    joints.append(Joint(fixed, "fixed", links[-2], links[-1], origin))
    robot = Robot(name, links, joints, masses=_masses(chain, links[1:-1]))
    if list(robot.q_names) != masters:
        changes.append(f"the order is {', '.join(map(quote, robot.q_names))}")
    if changes:
        warn(
            f"the chain from {quote(chain.base)} to {quote(chain.tip)} has other coordinates as a robot: "
            + "; ".join(changes)
        )
    return robot


def _masses(chain: Chain, links: Sequence[str]) -> list[LinkMass]:
    """Masses of the links that joints move; none where a link cannot have one of them."""
    if chain.masses is None:
        return []
    found = []
    T = np.eye(4)
    frames = chain.local.frames[:-1]
    for link, frame, row in zip(links, frames, chain.masses, strict=True):
        T = T @ frame
        mass, *centre = row.tolist()
        x, y, z, _ = se3.inverse(T) @ [*centre, 1.0]
        if mass:
            found.append(LinkMass(link, mass, (float(x), float(y), float(z))))
    if all(is_mass(own.mass, own.centre) for own in found):
        return found
    return []


def _joint(
    chain: Chain,
    i: int,
    value: Value,
    parent: str,
    child: str,
) -> Joint:
    name = chain.joint_names[i]
    kind = chain.kinds[i]
    origin = chain.local.frames[i]
    slide = chain.local.slides[i]
    if value.start:
        screw = np.array([0.0, 0.0, chain.local.rotates[i], 0.0, 0.0, slide])
        origin = origin @ se3.exp(value.start * screw)
    if not value.moves:
        return Joint(name, "fixed", parent, child, origin)
    pitch = 0.0
    if kind == "helical":
        pitch = float(slide)
    axis = (0.0, 0.0, value.sign)
    return Joint(
        name,
        kind,
        parent,
        child,
        origin,
        axis,
        value.limits,
        value.mimic,
        pitch,
        value.velocity,
    )


def _values(chain: Chain) -> tuple[list[Value], list[str], list[str]]:
    """Values of the joints, names of the masters in the order of q, and changes in words."""
    C = chain.coupling
    c = chain.offset.tolist()
    values = [Value(start=shift, moves=False) for shift in c]
    masters: list[str] = []
    changes: list[str] = []
    for joint, row in zip(chain.joint_names, C, strict=True):
        if np.count_nonzero(row) > 1:
            ks = np.flatnonzero(row)
            several = join_names(chain.q_names[k] for k in ks)
            raise InputError(
                f"joint {quote(joint)} follows several coordinates, {several}: a robot's joint follows one"
            )
    for k, (q_name, column) in enumerate(zip(chain.q_names, C.T, strict=True)):
        ratios = {int(i): float(column[i]) for i in np.flatnonzero(column)}
        if not ratios:
            changes.append(f"{quote(q_name)} is left out, no joint follows it")
            continue
        master = _master(ratios, c)
        name = chain.joint_names[master]
        ratio = ratios[master]
        shift = c[master]
        lower, upper = chain.limits[k].tolist()
        velocity = float(chain.velocity_limits[k])
        if abs(ratio) == 1.0:
            values[master] = Value(ratio, shift, (lower, upper), velocity=velocity)
            ratio = 1.0
            shift = 0.0
        else:
            values[master] = Value(
                limits=_image((lower, upper), ratio, shift),
                velocity=_faster(velocity, ratio),
            )
            changes.append(
                f"in the place of {quote(q_name)} is {quote(name)} = {ratio!r} {quote(q_name)} + {shift!r}"
            )
        for i, own in ratios.items():
            if i != master:
                multiplier = own / ratio
                mimic = Mimic(name, multiplier, c[i] - multiplier * shift)
                values[i] = _follower(values[master], mimic)
        masters.append(name)
    return values, masters, changes


def _follower(master: Value, mimic: Mimic) -> Value:
    return Value(
        limits=_image(master.limits, mimic.multiplier, mimic.offset),
        mimic=mimic,
        velocity=_faster(master.velocity, mimic.multiplier),
    )


def _master(
    ratios: dict[int, float],
    shifts: list[float],
) -> int:
    """The first joint with x = q, else with x = q + c, else with x = -q + c, else the first."""

    def rank(i: int) -> tuple[bool, ...]:
        ratio = ratios[i]
        return ratio != 1 or shifts[i] != 0, ratio != 1, ratio != -1

    return min(sorted(ratios), key=rank)


def _faster(velocity: float, ratio: float) -> float:
    """Velocity limit of ratio y, wide enough that seen from y it is no less than that of y."""
    return _image((-velocity, velocity), ratio, 0.0)[1]


def _image(limits: Interval, ratio: float, shift: float) -> Interval:
    """Interval of ratio y + shift, wide enough that seen from y it contains that of y."""
    ends = []
    for bound, outward in zip(limits, (-1.0, 1.0), strict=True):
        end = ratio * bound + shift
        while outward * ((end - shift) / ratio - bound) < 0:
            end = math.nextafter(end, math.copysign(math.inf, outward * ratio))
        ends.append(end)
    return min(ends), max(ends)
