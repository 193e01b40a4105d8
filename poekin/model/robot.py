"""Robot: a tree of links and joints, from which chains are taken."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..algebra import IDENTITY, adjoint, compose, inverse
from ..errors import (
    InputError,
    ModelError,
    ShapeError,
    UnknownName,
    join_names,
    quote,
    safe_repr,
    suggest,
)
from ..groups.arrays import poses as pose_arrays
from .chain import Chain
from .checks import read_only
from .coordinates import coordinates
from .joint import FREE, Joint
from .provenance import Source
from .tree.coupling import Coupling, coupling_of, shared_limits, warn_of_torn_limits
from .tree.tree import Tree, path, tree_of
from .tree.tree_arrays import Layout, layout_of, link_poses

# The twelve numbers of a pose (R, p), as algebra.py orders them, out of a flattened 4x4 matrix.
TWELVE = [0, 1, 2, 4, 5, 6, 8, 9, 10, 3, 7, 11]
# Entries of the largest coupling matrix that is made, half a gigabyte.
LARGEST = 64_000_000


@dataclass(frozen=True, slots=True)
class Robot:
    """Links joined into a tree; a joint's child link stands at T_pc(x) = origin e^{S x} in its
    parent link.

    Parameters: name; links, their names; joints, in any order (that order is kept); source, where
    they were read
    from: a `Source`, a text, or None.

    Further fields
    - root, leaves: the link without a parent, and those without a child.
    - q_names (m), dof = m: the independent coordinates, named after their master joints, in order
      of first appearance along `joints`; a mimic joint has none of its own (a mimic of a mimic is
      composed, one of a fixed joint constant).
    - limits (m, 2): lower and upper bound of each coordinate [rad or m], intersected over all
      joints that follow it; where nothing is left of an interval, the master's own limits, and a
      PoekinWarning.

    Frozen, with read-only arrays; robots of equal name, links and joints are equal, wherever they
    were read from. Raises: ModelError, with file and line where the source has them, for no link,
    two roots, a cycle, a link with two parents, names used twice, unknown links, and the mimic of
    an unknown joint, of itself or in a circle.
    """

    name: str
    links: tuple[str, ...]
    joints: tuple[Joint, ...]
    source: Source | None = None
    root: str = field(init=False)
    leaves: tuple[str, ...] = field(init=False)
    q_names: tuple[str, ...] = field(init=False)
    limits: np.ndarray = field(init=False)
    _numbers: dict[str, int] = field(init=False)
    _tree: Tree = field(init=False)
    _coupling: Coupling = field(init=False)
    _bounds: np.ndarray = field(init=False)
    _layout: Layout = field(init=False)

    def __init__(
        self,
        name: str,
        links: Iterable[str],
        joints: Iterable[Joint],
        source: Source | str | None = None,
    ) -> None:
        read_from = Source(source) if isinstance(source, str) else source
        if read_from is not None and not isinstance(read_from, Source):
            raise ModelError(
                f"robot {quote(name)}: source must be a Source, a text or None, got {safe_repr(source)}"
            )
        torn = _build(
            self, name, _items(links, "links", name), _items(joints, "joints", name), read_from
        )
        warn_of_torn_limits(self._coupling, torn, self.joints, _source(self))

    @property
    def dof(self) -> int:
        """Number of independent coordinates, m."""
        return len(self.q_names)

    def joint(self, name: str) -> Joint:
        """The joint of that name. Raises: UnknownName with the closest names."""
        for joint in self.joints:
            if joint.name == name:
                return joint
        names = [joint.name for joint in self.joints]
        raise UnknownName(
            f"{_source(self).place()}: no joint {quote(name)}; {suggest(name, names)}"
        )

    def chain(self, base: str | None = None, tip: str | None = None) -> Chain:
        """The chain from link `base` to link `tip`, along the tree or against it.

        f(q) is the pose of tip in base. A joint passed from child to parent has its screw reversed;
        its value keeps its sign. Coordinates are in order of first appearance from base to tip; one
        whose master joint is off the way is named after that master. Limits are intersected over
        the joints on the way that follow a coordinate; where nothing is left, the master's own
        stand.

        Parameters: base, by default the root; tip, by default the only leaf. Returns: Chain.
        Raises: UnknownName with the closest names for an unknown link; InputError that lists the
        leaves when tip is left out and there are several, and for a coupled chain whose matrix C
        would have more than 64 million
        entries; ModelError when a floating or planar joint is on the way.
        Accuracy: rounding of the product of the origins, about 1e-16 of the reach per joint.
        """
        base = self.root if base is None else base
        if tip is None:
            if len(self.leaves) != 1:
                leaves = join_names(self.leaves, 20)
                raise InputError(
                    f"{_source(self).place()}: tip must be given, there are several leaves: {leaves}"
                )
            tip = self.leaves[0]
        way = path(self._tree, _link(self, base, "base"), _link(self, tip, "tip"))
        screws = []
        moving = []
        H: Any = IDENTITY
        for number, forward in way:
            joint = self.joints[number]
            if joint.kind in FREE:
                raise ModelError(
                    f"{_source(self).of_joint(number)}: the way from {quote(base)} to {quote(tip)} crosses the"
                    f" {joint.kind} joint {quote(joint.name)}; a chain cannot"
                )
            origin = joint.origin.ravel()[TWELVE].tolist()
            if forward:
                H = compose(H, origin)
            if joint.kind != "fixed":
                moved = np.array(adjoint(H, joint.screw))
                screws.append(moved if forward else -moved)
                moving.append(number)
            if not forward:
                H = compose(H, inverse(origin))
        home = np.eye(4)
        home.ravel()[TWELVE] = H
        return self._coupled_chain(
            np.reshape(screws, (-1, 6)), home, np.array(moving, dtype=np.int64), base, tip
        )

    def _coupled_chain(
        self, screws: np.ndarray, home: np.ndarray, moving: np.ndarray, base: str, tip: str
    ) -> Chain:
        whole = self._coupling
        followed = whole.coordinate[moving]
        used = list(dict.fromkeys(followed[followed >= 0].tolist()))
        names = tuple(self.joints[j].name for j in moving)
        q_names = tuple(whole.q_names[k] for k in used)
        C = c = None
        if names != q_names:
            if len(names) * len(q_names) > LARGEST:
                raise InputError(
                    f"{_source(self).place()}: the chain from {quote(base)} to {quote(tip)} has joints that follow"
                    f" others, and its coupling matrix of {len(names)} x {len(q_names)} would be too large: at most"
                    f" {LARGEST} entries are made (Robot.fk needs none)"
                )
            column = {k: place for place, k in enumerate(used)}
            c = whole.shift[moving]
            C = np.zeros((len(moving), len(used)))
            for row, k in enumerate(followed.tolist()):
                if k >= 0:
                    C[row, column[k]] = whole.ratio[moving[row]]
        limits = shared_limits(whole, self._bounds, moving)[0][used]
        return Chain(
            screws,
            home,
            joint_names=names,
            q_names=q_names,
            limits=limits,
            coupling=C,
            offset=c,
            base=base,
            tip=tip,
            pitches=[self.joints[j].pitch for j in moving],
        )

    def fk(self, q: Any, poses: Mapping[str, Any] | None = None) -> dict[str, np.ndarray]:
        """Pose of every link in the root link's frame [m].

        Parameters: q (..., m) in `q_names` order [rad or m], or a dict from coordinate to value(s);
        poses, a dict from floating or planar joint to its pose (..., 4, 4), which then stands at
        origin T; one that is left out is at identity.
        Returns: a dict from link to (..., 4, 4), in the order of `links`, the leading axes those of
        q and of poses. Raises: ShapeError, InputError, UnknownName as `Chain.fk` for q; ShapeError
        where the leading axes of q and poses do not broadcast; InputError where poses is no dict;
        UnknownName or InputError for a name in poses
        that is no floating or planar joint, PoseError or ShapeError for a matrix that is no pose.
        Accuracy: rounding of the product of poses from the root, about 1e-16 of the distance per
        joint.
        Source: T_pc(x) = origin e^{S x} along the tree, with e^{S x} of Park 1994, Lemma 2.
        """
        values = coordinates(q, self.q_names, f"robot {quote(self.name)}")
        free = _free_poses(self, {} if poses is None else poses)
        batch = _common_batch(
            self, values.shape[:-1], {joint: T.shape[:-2] for joint, T in free.items()}
        )
        count = math.prod(batch)  # said, not inferred: -1 means nothing where an axis is empty
        flat = np.broadcast_to(values, (*batch, self.dof)).reshape(count, self.dof)
        free = {
            joint: np.broadcast_to(T, (*batch, 4, 4)).reshape(count, 4, 4)
            for joint, T in free.items()
        }
        out = link_poses(self._layout, flat, free).reshape(*batch, len(self.links), 4, 4)
        rows = self._layout.link_row.tolist()
        return {link: out[..., row, :, :] for link, row in zip(self.links, rows, strict=True)}

    def _data(self) -> tuple[Any, ...]:
        return self.name, self.links, self.joints

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Robot):
            return NotImplemented
        return self._data() == other._data()

    def __hash__(self) -> int:
        return hash(self._data())

    def __reduce__(self) -> tuple[Any, ...]:
        # Not __getstate__: Python 3.11.2 puts one of its own over that of a frozen dataclass with
        # slots.
        return _rebuilt, (*self._data(), self.source)

    def __repr__(self) -> str:
        leaves = ", ".join(map(quote, self.leaves[:3]))
        if len(self.leaves) > 3:
            leaves += ", ..."
        word = "leaf" if len(self.leaves) == 1 else "leaves"
        return (
            f"Robot({quote(self.name)}: {len(self.links)} links, {len(self.joints)} joints, dof {self.dof}, root"
            f" {quote(self.root)}, {len(self.leaves)} {word}: {leaves})"
        )


def _rebuilt(*parts: Any) -> Robot:
    """A robot that was pickled: what there was to warn of was said when it was made."""
    robot = object.__new__(Robot)
    _build(robot, *parts)
    return robot


def _build(
    robot: Robot,
    name: str,
    links: tuple[str, ...],
    joints: tuple[Joint, ...],
    source: Source | None,
) -> np.ndarray:
    """Check the parts of a robot and set all its fields; returns the coordinates without common
    limits.
    """
    fields: dict[str, Any] = {"name": str(name), "links": links, "joints": joints, "source": source}
    where = source or Source(f"robot {quote(name)}")
    for joint in joints:
        if not isinstance(joint, Joint):
            raise ModelError(
                f"{where.place()}: joints must be Joint objects, got {safe_repr(joint)}"
            )
    tree = tree_of(links, joints, where)
    coupling = coupling_of(joints, where)
    bounds = np.array([joint.limits for joint in joints]).reshape(len(joints), 2)
    limits, torn = shared_limits(coupling, bounds, np.arange(len(joints)))
    parents = {joint.parent for joint in joints}
    fields |= {
        "root": links[tree.root],
        "leaves": tuple(link for link in links if link not in parents),
        "q_names": coupling.q_names,
        "limits": read_only(limits),
        "_numbers": {link: number for number, link in enumerate(links)},
        "_tree": tree,
        "_coupling": coupling,
        "_bounds": read_only(bounds),
        "_layout": layout_of(tree, joints, coupling),
    }
    for field_name, value in fields.items():
        object.__setattr__(robot, field_name, value)
    return torn


def _items(values: Any, what: str, name: str) -> tuple[Any, ...]:
    """Links or joints as a tuple; a text is not taken for its letters, nor a set for an order."""
    if isinstance(values, (str, bytes, set, frozenset)) or not isinstance(values, Iterable):
        raise ModelError(f"robot {quote(name)}: {what} must be a list, got {safe_repr(values)}")
    return tuple(values)


def _source(robot: Robot) -> Source:
    return robot.source or Source(f"robot {quote(robot.name)}")


def _link(robot: Robot, name: str, role: str) -> int:
    if not isinstance(name, str) or name not in robot._numbers:
        raise UnknownName(
            f"{_source(robot).place()}: no {role} link {quote(name)}; {suggest(str(name), robot.links)}"
        )
    return robot._numbers[name]


def _free_poses(robot: Robot, poses: Mapping[str, Any]) -> dict[int, np.ndarray]:
    """The poses of floating and planar joints, checked, by the number of the joint."""
    if not isinstance(poses, Mapping):
        where = _source(robot).place()
        raise InputError(
            f"{where}: poses must be a dict from joint to pose (..., 4, 4), got {safe_repr(poses)}"
        )
    if not poses:
        return {}
    free = {joint.name: number for number, joint in enumerate(robot.joints) if joint.kind in FREE}
    checked = {}
    for name, value in poses.items():
        if name not in free:
            raise UnknownName(
                f"{_source(robot).place()}: poses names {quote(name)}, which is no floating or planar joint;"
                f" {suggest(str(name), free)}"
            )
        checked[free[name]] = pose_arrays(value, f"pose of joint {quote(name)}")
    return checked


def _common_batch(
    robot: Robot, q: tuple[int, ...], poses: Mapping[int, tuple[int, ...]]
) -> tuple[int, ...]:
    """The leading axes that those of q and of the poses broadcast to."""
    batch = q
    for joint, shape in poses.items():
        try:
            batch = np.broadcast_shapes(batch, shape)
        except ValueError as fault:
            named = quote(robot.joints[joint].name)
            raise ShapeError(
                f"{_source(robot).place()}: the leading axes of q and poses do not broadcast: the pose of joint {named}"
                f" has {shape}, and what comes before it {batch}"
            ) from fault
    return batch
