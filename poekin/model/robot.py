"""Robot: a tree of links and joints, from which chains are taken."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ..by_value import ByValue
from ..engine.straight_line.program import Program
from ..errors import InputError, ModelError, UnknownName, quote, safe_repr, suggest
from .chain import Chain
from .joint import Joint
from .methods.peer_names import OF_CHAINS, OF_ROBOTS, no_attribute
from .provenance import Source
from .readings.coupled import with_readings
from .readings.statements import Statements, make_statements
from .show.tables import robot_table
from .tree.all_poses import all_poses
from .tree.chain_between import chain_between, only_leaf
from .tree.coupling import warn_of_torn_limits
from .tree.link_masses import LinkMass
from .tree.link_program import link_program
from .tree.robot_parts import RobotParts, make_parts


@dataclass(frozen=True, slots=True, eq=False)
class Robot(ByValue):
    """Links joined into a tree: a joint's child link is at T_pc(x) = origin e^{S x} in its parent.

    Parameters
    ----------
    name : str
        Name of the robot.
    links : iterable of str
        Names of the links.
    joints : iterable of Joint
        Joints in any order; that order is kept.
    source : Source or str, optional
        File or text that they were read from, for messages.
    coupling : str or sequence of str, optional
        Statements such as "J3 = J2 + J3", by which joints follow the readings that are then the
        robot's coordinates; see `Chain.coupled`.
    masses : iterable of LinkMass, optional
        Masses of links, as far as they are known; chains have those that they move.

    Attributes
    ----------
    name : str
        Name of the robot.
    links : tuple of str
        Names of the links.
    joints : tuple of Joint
        Joints in the order given.
    source : Source or None
        Origin of the robot.
    root : str
        Link without a parent.
    leaves : tuple of str
        Links without a child.
    q_names : tuple of str
        Independent coordinates, named after their master joints, in order of first appearance along
        `joints`. A mimic joint has none of its own: a mimic of a mimic is composed, one of a fixed
        joint constant.
    limits : (m, 2) ndarray
        Lower and upper bound of each coordinate, rad or m, intersected over all joints that follow
        it; where nothing is left of an interval, the master's own limits, and a PoekinWarning. Of
        coupled readings what these limits leave to each.
    coupling : tuple of str
        Statements of the coupling, none where each coordinate is its master joint's own value.
    masses : tuple of LinkMass
        Masses of the links that have one.

    Raises
    ------
    ModelError
        For no link, two roots, a cycle, a link with two parents, names used twice, unknown links,
        and the mimic of an unknown joint, of itself or in a circle; with file and line where the
        source has them.

    Warns
    -----
    PoekinWarning
        If the limits of the joints that follow a coordinate have nothing in common.

    Notes
    -----
    Frozen, with read-only arrays; robots of equal name, links, joints and coupling are equal, wherever they
    were read from, and whatever their masses.

    Examples
    --------
    >>> import poekin as pk
    >>> turn = pk.Joint("turn", "revolute", "base", "arm", axis=(0, 0, 1))
    >>> robot = pk.Robot("one", ["base", "arm"], [turn])
    >>> print(robot)
    Robot('one': 2 links, 1 joints, dof 1, root 'base', 1 leaf: 'arm')
    """

    name: str
    links: tuple[str, ...]
    joints: tuple[Joint, ...]
    source: Source | None = None
    coupling: tuple[str, ...] = ()
    masses: tuple[LinkMass, ...] = ()
    root: str = field(init=False)
    leaves: tuple[str, ...] = field(init=False)
    q_names: tuple[str, ...] = field(init=False)
    limits: np.ndarray = field(init=False)
    _parts: RobotParts = field(init=False)

    def __init__(
        self,
        name: str,
        links: Iterable[str],
        joints: Iterable[Joint],
        source: Source | str | None = None,
        coupling: Statements = (),
        masses: Iterable[LinkMass] = (),
    ) -> None:
        read_from = Source(source) if isinstance(source, str) else source
        if read_from is not None and not isinstance(read_from, Source):
            raise ModelError(
                f"robot {quote(name)}: source must be a Source, a text or None, got {safe_repr(source)}"
            )
        parts = make_parts(name, links, joints, read_from, coupling, masses)
        self._freeze(parts, read_from)
        warn_of_torn_limits(parts.coupling, parts.torn, parts.joints, parts.place)

    def _freeze(self, parts: RobotParts, source: Source | None) -> None:
        parents = {joint.parent for joint in parts.joints}
        fields = {
            "name": parts.name,
            "links": parts.links,
            "joints": parts.joints,
            "source": source,
            "coupling": make_statements(parts.readings, parts.coupling.q_names),
            "masses": parts.masses,
            "root": parts.links[parts.tree.root],
            "leaves": tuple(link for link in parts.links if link not in parents),
            "q_names": parts.coupling.q_names,
            "limits": parts.limits,
            "_parts": parts,
        }
        for field_name, value in fields.items():
            object.__setattr__(self, field_name, value)

    if not TYPE_CHECKING:  # which would take any name for an attribute

        def __getattr__(self, name: str) -> Any:
            of_chain = {
                word: f"chain(tip=...).{word}" for word in dir(Chain) if word not in OF_CHAINS
            }
            raise no_attribute("Robot", name, of_chain | OF_ROBOTS, dir(type(self)))

    @property
    def dof(self) -> int:
        """Number of independent coordinates, m."""
        return len(self.q_names)

    def joint(self, name: str) -> Joint:
        """Joint of a name.

        Parameters
        ----------
        name : str
            Name of the joint.

        Returns
        -------
        joint : Joint
            Joint of that name.

        Raises
        ------
        UnknownName
            If there is none, with the closest names.
        """
        for joint in self.joints:
            if joint.name == name:
                return joint
        names = [joint.name for joint in self.joints]
        raise UnknownName(
            f"{self._parts.place.place()}: no joint {quote(name)}; {suggest(name, names)}"
        )

    def chain(self, base: str | None = None, tip: str | None = None) -> Chain:
        """Chain from link `base` to link `tip`, along the tree or against it.

        f(q) is the pose of tip in base. A joint passed from child to parent has its screw reversed;
        its value keeps its sign. Coordinates are in order of first appearance from base to tip; one
        whose master joint is off the way is named after that master. Limits are intersected over
        the joints on the way that follow a coordinate; where nothing is left, the master's own
        stand. The velocity limit of a coordinate is that of the slowest of these joints.

        Parameters
        ----------
        base : str, optional
            Link that the chain begins at; the root where it is left out.
        tip : str, optional
            Link that the chain ends at; the only leaf where it is left out.

        Returns
        -------
        chain : Chain
            Chain with the pose of tip in base, m.

        Raises
        ------
        UnknownName
            If a link is unknown, with the closest names.
        InputError
            If tip is left out and there are several leaves, which it lists, or the only one is the
            base; or if the matrix C of a coupled chain would have more than 64 million entries.
        ModelError
            If a floating or planar joint is on the way.

        Notes
        -----
        Accuracy: rounding of the product of the origins, about 1e-16 of the reach per joint.

        Examples
        --------
        >>> import poekin as pk
        >>> arm = pk.load("panda").chain(tip="panda_hand")
        >>> print(arm.base, arm.tip, arm.dof)
        panda_link0 panda_hand 7
        """
        base = self.root if base is None else base
        if tip is None:
            tip = only_leaf(self._parts, self.leaves, base)
        screws, home, options = chain_between(self._parts, base, tip)
        chain = Chain.from_space(screws, home, **options)
        if self._parts.readings is None:
            return chain
        return with_readings(chain, self._parts.readings, self.q_names)

    def coupled(self, coupling: Statements) -> Robot:
        """Robot of the same links and joints whose coordinates are readings that joints follow.

        Parameters
        ----------
        coupling : str or sequence of str
            Statements such as "J3 = J2 + J3", as `Chain.coupled` takes them.

        Returns
        -------
        robot : Robot
            Robot whose `fk` and chains take readings.

        Raises
        ------
        InputError
            As `Chain.coupled`, and if this robot's readings are coupled already.

        Examples
        --------
        >>> import poekin as pk
        >>> fanuc = pk.load("puma560").coupled("joint3 = joint2 + joint3")
        >>> fanuc.coupling
        ('joint3 = joint2 + joint3',)
        """
        if self.coupling:
            raise InputError(
                f"coupling: the readings of robot {quote(self.name)} are coupled already: "
                f"{'; '.join(self.coupling)}"
            )
        return Robot(self.name, self.links, self.joints, self.source, coupling, self.masses)

    def fk(self, q: Any, poses: Mapping[str, Any] | None = None) -> dict[str, np.ndarray]:
        """Pose of every link in the root link's frame.

        Parameters
        ----------
        q : (..., m) array_like or dict
            Configurations in `q_names` order, rad or m, or a dict from coordinate to value(s).
        poses : dict, optional
            Pose (..., 4, 4) of each floating or planar joint by its name, which then is at origin
            T; one that is left out is at identity.

        Returns
        -------
        poses : dict of str to (..., 4, 4) ndarray
            Pose of each link, m, in the order of `links`; the leading axes are those of q and of
            poses.

        Raises
        ------
        ShapeError
            If q has another number of coordinates, or the leading axes of q and poses do not
            broadcast.
        InputError
            If values cannot be used, or poses is no dict.
        UnknownName
            If a name is no coordinate, or no floating or planar joint.
        PoseError
            If a matrix is no pose.

        Notes
        -----
        Accuracy: rounding of the product of poses from the root, about 1e-16 of the distance per
        joint. Source: T_pc(x) = origin e^{S x} along the tree, with e^{S x} of Park 1994, Lemma 2.

        Examples
        --------
        >>> import numpy as np
        >>> import poekin as pk
        >>> robot = pk.load("ur5e")
        >>> print(robot.fk(np.zeros(6))["tool0"][:3, 3].round(3) + 0.0)
        [-0.817 -0.233  0.063]
        """
        return all_poses(self._parts, q, poses)

    def program(self) -> Program:
        """Straight-line program of the poses of all links; its `count` says what it costs.

        Returns
        -------
        program : Program
            Operations in an order in which they can be run: twelve numbers of each link's pose, in
            the order of `links`. Floating and planar joints are at identity.

        Notes
        -----
        Accuracy: that of `fk`, and 32 u a joint for the constants that are taken for 0 or ±1,
        u = 2^-53, lengths times the reach (tests/model/tree/test_link_program.py). Source: as `fk`.

        Examples
        --------
        >>> import poekin as pk
        >>> pk.load("ur5e").program().count.sines
        6
        """
        return link_program(self._parts)

    def _data(self) -> tuple[Any, ...]:
        return self.name, self.links, self.joints, self.coupling

    def __reduce__(self) -> tuple[Any, ...]:
        # Not __getstate__: Python 3.11.2 puts one of its own over that of a frozen dataclass with
        # slots.
        return _rebuilt, (*self._data(), self.source, self.masses)

    def _repr_html_(self) -> str:
        return robot_table(self.name, self.joints)

    def __repr__(self) -> str:
        leaves = ", ".join(map(quote, self.leaves[:3]))
        if len(self.leaves) > 3:
            leaves += ", ..."
        word = "leaf" if len(self.leaves) == 1 else "leaves"
        return (
            f"Robot({quote(self.name)}: {len(self.links)} links, {len(self.joints)} joints, dof {self.dof}, root"
            f" {quote(self.root)}, {len(self.leaves)} {word}: {leaves})"
        )


def _rebuilt(
    name: str,
    links: Any,
    joints: Any,
    coupling: tuple[str, ...],
    source: Source | None,
    masses: tuple[LinkMass, ...],
) -> Robot:
    """A robot that was pickled: what there was to warn of was said when it was made."""
    robot = object.__new__(Robot)
    robot._freeze(make_parts(name, links, joints, source, coupling, masses), source)
    return robot
