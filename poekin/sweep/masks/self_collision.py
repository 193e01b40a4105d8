"""SelfCollision: leaves out samples in which an arm touches itself, by spheres on its links."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import accumulate, combinations
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...algebra import transform
from ...checks import positive
from ...errors import InputError, join_names
from ...groups.arrays import Array
from ...model.chain import Chain
from ...model.kinematics.arm import Arm, chain_of
from ...model.kinematics.configurations import configurations
from ...model.robot import Robot
from ...results import Result
from ..measures.error_program import traced_products
from .covering import covering
from .spheres import LinkSphere, MovedLink, moved_links
from .touching import touching

if TYPE_CHECKING:
    from ...engine.straight_line.program import Program

_TRIED = 1000
_ALWAYS = 0.95
_AT_ONCE = 1024


class LinkPair(NamedTuple):
    """Names of two links."""

    first: str
    second: str


@dataclass(frozen=True)
class SelfCollision(Result):
    """Mask of a sweep: samples in which spheres on links of an arm touch count nowhere.

    It is made by `of_robot`, from collision geometry, or by `of_spheres`. Pairs of links that no
    joint of the arm moves to one another are no matter; `adjacent` and `always` are left out too.
    Joints that are not the arm's, such as a gripper's, are at 0.

    Attributes
    ----------
    joint_names : tuple of str
        Joints of the arm.
    spheres : tuple of LinkSphere
        Spheres: link, centre in its frame, m, and radius, m.
    pairs : tuple of LinkPair
        Pairs of links that are looked at.
    adjacent : tuple of LinkPair
        Pairs that are left out as one joint joins them.
    always : tuple of LinkPair
        Pairs that are left out as they touch in 950 of 1000 random configurations or more.
    excess : float
        How far spheres that were made for geometry stand out of it, m, found at 48 points of each; 0
        of spheres that were given.
    moved : tuple
        The same spheres in the base frame, by link.

    Examples
    --------
    >>> import poekin as pk
    >>> robot = pk.load("ur5e")
    >>> arm = robot.chain(tip="tool0")
    >>> wrist = [("wrist_3_link", (0, 0, 0.1), 0.2), ("upper_arm_link", (-0.2, 0, 0.14), 0.08)]
    >>> mask = pk.sweep.SelfCollision.of_spheres(robot, arm, wrist)
    >>> bool(mask.touches(arm, [0, 0, 0, 0, 0, 0])), bool(mask.touches(arm, [0, 0, 3.0, 0, 0, 0]))
    (False, True)
    """

    joint_names: tuple[str, ...]
    spheres: tuple[LinkSphere, ...]
    pairs: tuple[LinkPair, ...]
    adjacent: tuple[LinkPair, ...]
    always: tuple[LinkPair, ...]
    excess: float
    moved: tuple[MovedLink, ...]

    @classmethod
    def of_robot(cls, robot: Robot, chain: Arm, tolerance: float = 0.02) -> SelfCollision:
        """Mask by the <collision> geometry of a robot that was read from a URDF.

        Parameters
        ----------
        robot : Robot
            The robot.
        chain : Chain or CompiledChain
            Chain of it.
        tolerance : float, default 0.02
            Distance by which spheres stand out of the surface, m: with a smaller one there are more
            of them, and samples take longer.

        Returns
        -------
        mask : SelfCollision
            The mask; it leaves out all configurations in which surfaces of a pair of links touch,
            and some in which they are near.

        Raises
        ------
        InputError
            If there is no such geometry, or what `of_spheres` refuses.
        FileError
            If a mesh is not found or cannot be read.
        MissingExtra
            If there are meshes and trimesh is not installed (extra "view").
        """
        positive(tolerance, "tolerance")
        arm = chain_of(chain)
        _check_of(robot, arm)
        spheres, excess = covering(robot, tolerance)
        return _made(cls, robot, arm, spheres, excess)

    @classmethod
    def of_spheres(cls, robot: Robot, chain: Arm, spheres: Iterable[Any]) -> SelfCollision:
        """Mask by spheres that are given.

        Parameters
        ----------
        robot : Robot
            The robot, for its links.
        chain : Chain or CompiledChain
            Chain of it.
        spheres : iterable of (str, (3,) array_like, float)
            Spheres: link, centre in its frame, m, and radius, m.

        Returns
        -------
        mask : SelfCollision
            The mask.

        Raises
        ------
        InputError
            If a number cannot be used, the chain is not of the robot, or no pair of links is left to
            look at.
        ShapeError
            If a centre has another shape.
        UnknownName
            If there is no such link.
        """
        arm = chain_of(chain)
        _check_of(robot, arm)
        return _made(cls, robot, arm, spheres, 0.0)

    def touches(self, chain: Arm, q: Any) -> np.ndarray:
        """Whether spheres of a pair of links touch in configurations.

        Parameters
        ----------
        chain : Chain or CompiledChain
            The arm.
        q : (..., m) array_like or dict
            Configurations, rad or m.

        Returns
        -------
        found : (...) ndarray of bool
            Whether a sweep would leave them out.

        Raises
        ------
        InputError
            If the mask is another arm's.
        ShapeError
            If q has another shape.

        Notes
        -----
        Accuracy: rounding of the product of exponentials decides where spheres just touch
        (tests/sweep/masks/test_self_collision.py). Source: Park 1994, eq. (1), of each link.
        """
        arm = chain_of(chain)
        self.check(arm)
        batch, rows = configurations(arm, q)
        numbers = self._pair_numbers()
        found = np.empty(len(rows), bool)
        for first in range(0, len(rows), _AT_ONCE):
            part = slice(first, first + _AT_ONCE)
            found[part] = touching(arm, rows[part], self.moved, numbers).any(axis=1)
        return found.reshape(batch)

    def check(self, chain: Chain) -> None:
        """Refuse another arm.

        Parameters
        ----------
        chain : Chain
            Arm of a sweep.

        Raises
        ------
        InputError
            If it is not of the joints that the mask is of.
        """
        if chain.joint_names != self.joint_names:
            raise InputError(
                f"mask: it is of an arm with the joints {join_names(self.joint_names)}, not of {chain!r}"
            )

    def program(self, chain: Chain) -> Program:
        """Program of the centres of spheres, which the kernel of sweeps runs.

        Parameters
        ----------
        chain : Chain
            The arm.

        Returns
        -------
        program : Program
            Centres in the base frame, m: of each link, that of the sphere around all first.

        Raises
        ------
        InputError
            If it is another arm.
        """
        from ...engine.straight_line.program import program

        self.check(chain)
        graph, angles, P = traced_products(chain)
        outputs: list[Any] = []
        for link in self.moved:
            for centre in link.centres:
                outputs += transform(tuple(P[link.joints]), centre)
        return program(graph, angles, outputs)

    def numbers(self) -> tuple[np.ndarray, Array]:
        """Pairs of links and radii, as `engine.kernels.sweep.self_collision` has them.

        Returns
        -------
        pairs : (6 pairs,) ndarray of int
            Of both links, the first sphere, the one behind it and the end.
        radii : (spheres,) ndarray
            Radii, m.
        """
        starts = list(accumulate((len(link.radii) for link in self.moved), initial=0))
        rows = []
        for pair in self._pair_numbers():
            for i in pair:
                rows += [starts[i], starts[i] + 1, starts[i + 1]]
        radii = [radius for link in self.moved for radius in link.radii]
        return np.array(rows, np.int64), np.array(radii)

    def describe(self) -> dict[str, object]:
        """Plain data from which the same mask is known again.

        Returns
        -------
        data : dict
            SHA-256 of spheres and pairs, how many there are, and the excess, m.
        """
        pairs, radii = self.numbers()
        whole = hashlib.sha256(pairs.tobytes() + radii.tobytes())
        for link in self.moved:
            whole.update(np.array([[link.joints] * 3, *link.centres]).tobytes())
        return {
            "spheres": len(self.spheres),
            "pairs": len(self.pairs),
            "excess": self.excess,
            "sha256": whole.hexdigest(),
        }

    def summary(self) -> str:
        """Numbers of spheres and pairs, and what is left out.

        Returns
        -------
        text : str
            Lines such as "64 spheres on 8 links, within 83 mm of the geometry".
        """
        count = len(self.moved)
        numbers = f"{len(self.spheres)} spheres on {count} links, {len(self.pairs)} pairs of links"
        if self.excess:
            numbers += f"; they stand out of the geometry by up to {1e3 * self.excess:.3g} mm"
        lines = [numbers]
        for words, left in (("adjacent", self.adjacent), ("always touching", self.always)):
            names = ", ".join(f"{pair.first} - {pair.second}" for pair in left)
            lines.append(f"left out, {words}: {names or 'none'}")
        return "\n".join(lines)

    def _pair_numbers(self) -> list[tuple[int, int]]:
        places = {link.name: i for i, link in enumerate(self.moved)}
        return [(places[pair.first], places[pair.second]) for pair in self.pairs]


def _made(
    cls: type[SelfCollision],
    robot: Robot,
    chain: Chain,
    given: Iterable[Any],
    excess: float,
) -> SelfCollision:
    """The mask of spheres."""
    moved = moved_links(robot, chain, given)
    adjacent = []
    others = []
    joined = {frozenset((joint.parent, joint.child)) for joint in robot.joints}
    for i, j in combinations(range(len(moved)), 2):
        if moved[i].joints == moved[j].joints:
            continue
        names = {moved[i].name, moved[j].name}
        kind = adjacent if names in joined else others
        kind.append((i, j))
    q = chain.random(0, _TRIED)
    often = touching(chain, q, moved, others).mean(axis=0) >= _ALWAYS
    pairs = [pair for pair, left in zip(others, often, strict=True) if not left]
    always = [pair for pair, left in zip(others, often, strict=True) if left]
    if not pairs:
        names = join_names(link.name for link in moved)
        raise InputError(
            f"self-collision: of the links with spheres, {names or 'none'}, no two can come to touch: "
            "they are rigidly joined, adjacent, or touch always"
        )
    spheres = [sphere for link in moved for sphere in link.spheres]
    return cls(
        chain.joint_names,
        tuple(spheres),
        _named(moved, pairs),
        _named(moved, adjacent),
        _named(moved, always),
        excess,
        tuple(moved),
    )


def _named(moved: list[MovedLink], pairs: list[tuple[int, int]]) -> tuple[LinkPair, ...]:
    return tuple(LinkPair(moved[i].name, moved[j].name) for i, j in pairs)


def _check_of(robot: Robot, chain: Chain) -> None:
    """Refuses a chain that is not the robot's. Raises: InputError."""
    is_known = chain.base in robot.links and chain.tip in robot.links
    if not is_known or robot.chain(chain.base, chain.tip).joint_names != chain.joint_names:
        raise InputError(
            f"self-collision: {chain!r} is no chain of {robot!r}: other links or joints"
        )
