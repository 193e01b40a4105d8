"""Validation of a robot against Pinocchio: every chain from root to leaf, pose and Jacobians in all
three frames.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from ..checks import whole
from ..errors import quote
from ..formats import urdf
from ..formats.load import load
from ..formats.urdf_text import to_urdf
from ..model.chain import Chain
from ..model.joint import FREE, MOVING, Joint
from ..model.kinematics.pose_jacobian import FRAME_NAMES
from ..model.robot import Robot
from ..results import Result
from ..testing.oracles.pinocchio_oracle import PinocchioOracle

BAR = 2e-14
"""Largest error that passes, as a multiple of the chain's reach R."""

Progress = Callable[[int, int, str], None]
"""Called before each chain with the number done, the number of all, and the chain's tip."""


@dataclass(frozen=True)
class ChainErrors(Result):
    """Worst errors of one chain against Pinocchio, each ÷ R, the chain's reach.

    Attributes
    ----------
    base, tip : str
        Links at the ends of the chain.
    joints, dof : int
        Numbers of joints n and coordinates m.
    reach : float
        Reach R, m.
    pose, space, body, hybrid : float
        Errors of the pose and of the Jacobian in three frames, ÷ R.
    configuration : dict
        Worst configuration: coordinate -> value, rad or m.
    note : str
        Text on where the chain starts or ends; empty for a chain from root to leaf.
    """

    derived: ClassVar = ("worst", "passed")

    base: str
    tip: str
    joints: int
    dof: int
    reach: float
    pose: float
    space: float
    body: float
    hybrid: float
    configuration: dict[str, float] = field(default_factory=dict)
    note: str = ""

    @property
    def worst(self) -> float:
        """The largest of the four errors ÷ R; infinite where one is not a number."""
        errors = (self.pose, self.space, self.body, self.hybrid)
        if not all(map(math.isfinite, errors)):
            return math.inf
        return max(errors)

    @property
    def passed(self) -> bool:
        """Whether the errors hold the bar of 2e-14."""
        return self.worst <= BAR

    def summary(self) -> str:
        """Largest error, and the configuration at which it is beyond the bar.

        Returns
        -------
        text : str
            Line such as "base → tool is off by 1e-3 R; worst at elbow = 0.25".
        """
        note = f" ({self.note})" if self.note else ""
        if self.passed:
            return f"{self.base} → {self.tip} is within {self.worst:.3g} R{note}"
        at = ", ".join(f"{name} = {x + 0.0:.9g}" for name, x in self.configuration.items())
        off = f"is off by {self.worst:.3g} R{note}; worst at {at or 'home'}"
        return f"{self.base} → {self.tip} {off}"


@dataclass(frozen=True)
class Validation(Result):
    """Errors of every chain of a robot, and the bar that they must hold; the result of `validate`.

    Attributes
    ----------
    robot : str
        Name of the robot.
    source : str
        File that it came from.
    chains : tuple of ChainErrors
        Errors of each chain.
    bar : float
        Largest error ÷ R that passes.
    samples, seed : int
        Random configurations of each chain, beside the zero configuration, and their seed.
    pinocchio : str
        Version of Pinocchio.
    moving : int
        Number of the robot's joints that move.
    """

    derived: ClassVar = ("passed", "error")

    robot: str
    source: str
    chains: tuple[ChainErrors, ...]
    bar: float
    samples: int
    seed: int
    pinocchio: str
    moving: int = 0

    @property
    def worst(self) -> ChainErrors | None:
        """The chain with the largest error, or None for a robot without a link to go to."""
        return max(self.chains, key=lambda row: row.worst, default=None)

    @property
    def error(self) -> float:
        """The largest error ÷ R of all chains."""
        return max((row.worst for row in self.chains), default=0.0)

    @property
    def passed(self) -> bool:
        """Whether there is a chain and all hold the bar; an error that is not a number never does.

        Where joints of the robot move, there must be a chain that has some.
        """
        proof = any(row.joints or not self.moving for row in self.chains)
        return proof and self.error <= self.bar

    def summary(self) -> str:
        """Whether the robot passed, its largest error, and the chains beyond the bar.

        Returns
        -------
        text : str
            Line on the robot, and a line for each chain that fails.
        """
        head = "fails"
        if self.passed:
            head = "passes"
        lines = [
            f"{self.robot} {head}: {len(self.chains)} chains against Pinocchio {self.pinocchio}, "
            f"largest error {self.error:.3g} R, the bar is {self.bar:g} R"
        ]
        failed = [row.summary() for row in self.chains if not row.passed]
        return "\n".join(lines + failed)


def validate(
    robot: Robot | str | os.PathLike[str],
    *,
    samples: int = 100,
    seed: int = 0,
    progress: Progress | None = None,
) -> Validation:
    """Poses and Jacobians of every chain from the root to a leaf, against Pinocchio.

    Parameters
    ----------
    robot : Robot, str or path-like
        Anything that `load` takes, or the text of a URDF (it begins with <), or a Robot.
    samples : int, default 100
        Random configurations of each chain, beside the zero configuration: revolute over ±π and
        prismatic over ±1 m whatever the limits, all coordinates of the robot at once, so that one
        which a chain overlooks shows up too.
    seed : int, default 0
        Seed of the configurations.
    progress : callable, optional
        Called before each chain as progress(chains done, chains in all, tip).

    Returns
    -------
    found : Validation
        Errors of each chain, and whether they hold the bar of 2e-14 reaches.

    Raises
    ------
    FileError
        If a file cannot be read; further errors are those of `load`.
    MissingExtra
        If Pinocchio is not installed (extra `validate`).
    ModelError
        If Pinocchio refuses the URDF.
    InputError
        If `samples` is negative, or a Robot did not come from a URDF and cannot be written as one
        (helical joints).

    Notes
    -----
    Where a robot came from a URDF (a file, a text, a pipe, evaluated xacro), Pinocchio reads that
    very text. Any other (a DH table, MJCF, a Robot that was built or changed since) goes to
    Pinocchio as the text of `to_urdf`: then what was read is not judged, but all that is computed
    from it. A chain that would cross a floating or planar joint starts at the child link of the
    last such joint, and what moves above that joint is a chain of its own; the notes of the chains
    say so. Each error is the largest absolute entry of a difference, lengths ÷ R.
    """
    whole(samples, "samples", 0)
    model, oracle = _both(robot)
    rng = np.random.default_rng(seed)
    q = oracle.random(rng, samples + 1)
    for values in q.values():
        values[0] = 0.0
    rows = []
    ways = list(routes(model))
    for done, (base, tip, note) in enumerate(ways):
        if progress is not None:
            progress(done, len(ways), tip)
        chain = model.chain(base=base, tip=tip)
        rows.append(chain_errors(chain, oracle, q, note=note))
    moving = sum(joint.kind in MOVING for joint in model.joints)
    return Validation(
        model.name,
        str(model.source),
        tuple(rows),
        BAR,
        samples,
        seed,
        oracle.version,
        moving,
    )


def chain_errors(
    chain: Chain,
    oracle: PinocchioOracle,
    q: dict[str, np.ndarray],
    *,
    note: str = "",
) -> ChainErrors:
    """Worst errors of one chain over configurations of *all* the robot's coordinates, by name, (N,)
    values each.

    Every error is the largest absolute entry of a difference, ÷ R (the chain's reach) where it is a
    length:
    the pose's rotation part as it is and its translation ÷ R; a Jacobian's angular rows as they are
    and its linear rows ÷ R. This is never milder than the whole ÷ R, as R ≥ 1. Columns of
    coordinates that the chain does not have are zero here, and so they must be in Pinocchio. A
    coordinate that Pinocchio does not know is an infinite error.
    """
    unknown = [name for name in chain.q_names if name not in oracle.coordinates]
    if unknown:
        note = f"Pinocchio has no coordinate {quote(unknown[0])}"
        return _row(chain, [math.inf] * 4, {}, note)
    expected, columns = oracle.evaluate(q, chain.tip, chain.base)
    configurations = np.zeros((len(expected), chain.dof))
    for i, name in enumerate(chain.q_names):
        configurations[:, i] = q[name]
    differences = chain.fk(configurations) - expected
    apart = differences[:, :3]
    apart[..., 3] *= 1 / chain.reach
    errors = [np.abs(apart).max((1, 2))]
    own = [oracle.coordinates.index(name) for name in chain.q_names]
    for frame in FRAME_NAMES:
        apart = -columns[frame]
        apart[..., own] += chain.jacobian(configurations, frame)
        apart[:, 3:] *= 1 / chain.reach
        size = np.abs(apart)
        errors.append(size.max((1, 2), initial=0.0))
    largest = np.nan_to_num(np.max(errors, axis=0), nan=np.inf)
    worst = int(np.argmax(largest))
    q_worst = configurations[worst].tolist()
    configuration = dict(zip(chain.q_names, q_worst, strict=True))
    # np.max hands on a NaN, so that one wrong configuration cannot hide among right ones.
    of_parts = np.max(errors, axis=1).tolist()
    return _row(chain, of_parts, configuration, note)


def _row(
    chain: Chain,
    errors: list[float],
    configuration: dict[str, float],
    note: str,
) -> ChainErrors:
    ends = (
        chain.base,
        chain.tip,
        len(chain.joint_names),
        chain.dof,
        chain.reach,
    )
    pose, space, body, hybrid = errors
    return ChainErrors(*ends, pose, space, body, hybrid, configuration, note)


def routes(robot: Robot) -> Iterator[tuple[str, str, str]]:
    """(base, tip, note) of the chains that together have every joint that moves.

    First one a leaf, in the order of `robot.leaves`: from the root, or from below the last joint
    that no chain can cross. Then, where a joint moves above a floating or planar joint and is in
    none of those, the chain that ends at that joint's parent link. The note names the joints that
    were not crossed, else it is empty.
    """
    above = {joint.child: joint for joint in robot.joints}
    covered: set[str] = set()
    for leaf in robot.leaves:
        base, moving, note = _way(robot, above, leaf)
        covered.update(moving)
        yield base, leaf, note
    # The longer of two comes first, as it may have all that is in the shorter one.
    free_joints = [joint for joint in robot.joints if joint.kind in FREE]
    ends = [(*_way(robot, above, joint.parent), joint) for joint in free_joints]
    for base, moving, note, free in sorted(ends, key=lambda end: -len(end[1])):
        if not covered.issuperset(moving):
            covered.update(moving)
            end = f"ends above the {free.kind} joint {quote(free.name)}"
            if note:
                end = f"{note}, {end}"
            yield base, free.parent, end


def _way(
    robot: Robot,
    above: dict[str, Joint],
    tip: str,
) -> tuple[str, list[str], str]:
    """The link that the longest chain to a link starts at, its joints that move, and the note on
    its start.
    """
    link = tip
    moving = []
    while link in above:
        joint = above[link]
        if joint.kind in FREE:
            return link, moving, f"starts below the {joint.kind} joint {quote(joint.name)}"
        if joint.kind in MOVING:
            moving.append(joint.name)
        link = joint.parent
    return robot.root, moving, ""


def _both(robot: Robot | str | os.PathLike[str]) -> tuple[Robot, PinocchioOracle]:
    """poekin's model and Pinocchio's, of the same text; of the model's own as URDF where it did not
    come from one, or was changed since.
    """
    if isinstance(robot, str) and robot.lstrip().startswith("<"):
        return urdf.read_text(robot), PinocchioOracle(robot)
    model = robot if isinstance(robot, Robot) else load(robot)
    if model.coupling:  # Pinocchio knows joints, and so do both
        model = Robot(model.name, model.links, model.joints, model.source)
    text: str | bytes = b""
    if model.source is not None:
        text = model.source.text
    if text and urdf.read_text(text, tell=False) == model:
        return model, PinocchioOracle(text)
    return model, PinocchioOracle(to_urdf(model))
