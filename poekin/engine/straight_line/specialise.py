"""The formulas of `structured` run for one arm on scalars that record: straight-line programs of
poses and Jacobians.

A Jacobian can be had in several ways, which are equal in mathematics and not in cost: all are
traced, and the cheapest is taken.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from itertools import product
from typing import Any, NamedTuple

from ...algebra import (
    IDENTITY,
    axes,
    compose,
    from_axes,
    inverse,
    make_pose,
    set_column,
    transform,
    translation,
)
from ...formulas.kinematics import columns, gram, structured
from .program import Angles, Program, program
from .trace import Graph

_ROWS = 6
Pose = tuple[float, ...]
Matrix = list[list[Any]]


class JointWalk(NamedTuple):
    """Arguments of a walk of `structured`: links, offsets along their axes, whether an axis is parallel
    to the one before, and sines and cosines of its sums of angles.
    """

    links: Any
    d_offsets: Any
    parallel: Any
    sines: list[Any]
    cosines: list[Any]


@dataclass(frozen=True)
class Structure:
    """An arm of n joints and m coordinates as the formulas of `structured` take it.

    `links` (n, 4): sin alpha, cos alpha, a, b; `d_offsets` (n): d, without what slides; `parallel`
    (n).
    Joint i turns by rotates[i] x_i and slides by slides[i] x_i along its z axis, x = C q + c with
    `coupling` (n, m) and `shift` (n). Its angle at x = 0 is offsets[i] (rad) plus quarters[i] right
    angles.
    `base` is the pose of the frame before joint 0 in the base frame, `tool` that of the tip in the
    frame after the last joint; `frames` (n) are the poses of the joints' frames here in those that
    the arm's user knows (`Chain.local`).
    """

    links: tuple[tuple[float, float, float, float], ...]
    d_offsets: tuple[float, ...]
    parallel: tuple[int, ...]
    rotates: tuple[float, ...]
    slides: tuple[float, ...]
    coupling: tuple[tuple[float, ...], ...]
    shift: tuple[float, ...]
    offsets: tuple[float, ...]
    quarters: tuple[int, ...]
    base: Pose
    tool: Pose
    frames: tuple[Pose, ...]
    coordinates: int


def cheapest_program(arm: Structure, frame: str | int | None, pose: bool) -> Program:
    """The cheapest program of an arm's Jacobian in a frame ("space", "body", "hybrid" or a joint's
    index), or of its pose alone where frame is None; of both where `pose`. Outputs: the twelve
    numbers of the pose, then six rows of J.
    """
    programs = (_traced(arm, frame, pose, *way) for way in _ways(frame))
    return min(programs, key=_cost)


def _ways(frame: str | int | None) -> Iterable[tuple[bool, bool]]:
    """The walks inward and outward, each by the point that the axes see or by their origins; only in a
    joint's own frame are there both.
    """
    either = (False, True)
    if frame is None or isinstance(frame, str):
        return zip(either, either, strict=True)
    return product(either, either)


def cheapest_frame(arm: Structure) -> tuple[int, float]:
    """The joint k in whose frame the Jacobian costs least, and how far the structure's frame k
    stands from that frame's origin, along z: 0 or the joint's d (m).
    """
    places = []
    for k, along in enumerate(arm.d_offsets):
        places += [(k, h) for h in dict.fromkeys((0.0, along))]
    return min(places, key=lambda place: _cost_in_frame(arm, *place))


def _cost_in_frame(arm: Structure, k: int, h: float) -> int:
    moved = with_frame_at(arm, k, h)
    return _cost(cheapest_program(moved, k, pose=False))


def with_frame_at(arm: Structure, k: int, h: float) -> Structure:
    """The arm for a user whose frame of joint k has the structure's frame at (0, 0, h) and is
    turned as it.
    """
    frames = list(arm.frames)
    frames[k] = (*IDENTITY[:11], h)
    return replace(arm, frames=tuple(frames))


def _cost(way: Program) -> int:
    # a pair of sine and cosine, or a division, takes about as long as ten products
    count = way.count
    products = count.multiplications + count.additions
    return products + 10 * (count.sines + count.divisions)


def _traced(
    arm: Structure,
    frame: str | int | None,
    pose: bool,
    inner: bool,
    outer: bool,
) -> Program:
    """One way: velocities of the axes, inward and outward, by the point that they see (True) or by
    their origins.
    """
    trace = _Trace(arm)
    T, J = _pose_and_jacobian(trace, frame, pose, inner, outer)
    outputs = [x for row in J for x in row]
    if pose or frame is None:
        outputs = [*T, *outputs]
    return program(trace.graph, trace.angles, outputs)


def measured_program(arm: Structure) -> Program:
    """The cheapest program of an arm's pose and the square of its manipulability, in whatever frame: of
    six coordinates or more it is the same in all.
    """
    if arm.coordinates < _ROWS:
        return manipulability_program(arm, "hybrid")
    k, h = cheapest_frame(arm)
    return manipulability_program(with_frame_at(arm, k, h), k)


def manipulability_program(arm: Structure, frame: str | int) -> Program:
    """The cheapest program of an arm's pose and det(J Jᵀ), or det(Jᵀ J) with fewer than six
    coordinates, of the Jacobian in a frame. Outputs: the twelve numbers of the pose, the
    determinant.
    """
    programs = (_measured(arm, frame, *way) for way in _ways(frame))
    return min(programs, key=_cost)


def _measured(arm: Structure, frame: str | int, inner: bool, outer: bool) -> Program:
    trace = _Trace(arm)
    T, J = _pose_and_jacobian(trace, frame, True, inner, outer)
    m = arm.coordinates
    if m < _ROWS:
        J = [list(column) for column in zip(*J, strict=True)]
    less = min(m, _ROWS)
    more = max(m, _ROWS)
    determinant = gram.determinant(J, less, more, _zeros(less, less))
    return program(trace.graph, trace.angles, [*T, determinant])


def _pose_and_jacobian(
    trace: _Trace,
    frame: str | int | None,
    pose: bool,
    inner: bool,
    outer: bool,
) -> tuple[Any, list[list[Any]]]:
    """The pose, or nothing where it is not asked and costs more, and the Jacobian."""
    if frame is None:
        return trace.hybrid(outer)[0], []
    if frame == "hybrid":
        return trace.hybrid(outer)
    if frame == "space":
        return trace.space(outer)
    if frame == "body":
        return trace.body(inner)
    J = trace.joint(int(frame), inner, outer)
    return trace.hybrid(outer)[0] if pose else (), J


def _zeros(rows: int, columns: int) -> Matrix:
    return [[0.0] * columns for _ in range(rows)]


class _Trace:
    """One recording: an arm's walks on the scalars of one graph."""

    def __init__(self, arm: Structure):
        self.arm = arm
        self.n = len(arm.links)
        self.graph = Graph()
        self.angles = Angles(self.graph)
        # the coordinates (k, factor) of each joint
        self.driven_by: list[list[tuple[int, float]]] = []
        for row in arm.coupling:
            self.driven_by.append([(k, factor) for k, factor in enumerate(row) if factor])
        self.d_offsets = [d + self._slide(i) for i, d in enumerate(arm.d_offsets)]
        self.rows = _zeros(self.n, 12)
        self.points = _zeros(self.n, 2)

    def hybrid(self, seen: bool):
        """The pose, and the Jacobian in the axes of the base and at the tip."""
        walk, T = self._outward_from_base()
        if seen:
            tool = translation(self.arm.tool)
            seen_tip = structured.tip_seen(tool, *walk, self.n, self.points)
            T = self._with_tip(T, seen_tip)
        return T, self._jacobian([(0, self.n, seen)], translation(T))

    def space(self, seen: bool):
        """The pose, and the Jacobian in the base frame."""
        walk, T = self._outward_from_base()
        point = translation(inverse(self.arm.base))
        structured.seen_outward(point, *walk, 0, self.points)
        return T, self._jacobian([(0, self.n, seen)])

    def body(self, seen: bool):
        """The pose, and the Jacobian in the frame of the tip."""
        arm = self.arm
        last = self.n - 1
        walk = self._inward_walk(last)
        to_base = self._inward(inverse(arm.tool), last, walk)
        T = inverse(compose(to_base, inverse(arm.base)))
        tool = translation(arm.tool)
        p = structured.seen_inward(tool, *walk, last, self.points)
        if seen:
            T = self._with_tip(T, p)
        return T, self._jacobian([(0, self.n, seen)])

    def joint(self, k: int, inner: bool, outer: bool):
        """The Jacobian in the frame of joint k."""
        T_k = self.arm.frames[k]
        point = translation(inverse(T_k))
        walk = self._inward_walk(k)
        self._inward(T_k, k, walk)
        structured.seen_inward(point, *walk, k, self.points)
        walk = self._outward_walk(k + 1)
        self._outward(T_k, k + 1, walk)
        structured.seen_outward(point, *walk, k + 1, self.points)
        inward = (0, k + 1, inner)
        outward = (k + 1, self.n, outer)
        return self._jacobian([inward, outward])

    def _outward_from_base(self):
        """The outward walk from the base, and the pose of the tip that it leads to."""
        walk = self._outward_walk(0)
        last = self._outward(self.arm.base, 0, walk)
        return walk, compose(last, self.arm.tool)

    def _with_tip(self, T, p):
        """The pose T with its origin at p, given in the frame before joint 0."""
        return make_pose(T, transform(self.arm.base, p))

    def _outward(self, T, begin: int, walk: JointWalk):
        """The pose of the frame after the last joint where T is the one before joint `begin`."""
        frame = structured.outward(axes(T), *walk, begin, self.rows)
        return from_axes(*frame)

    def _inward(self, T, begin: int, walk: JointWalk):
        """The pose of the frame before joint 0 where T is the one after joint `begin`."""
        frame = structured.inward(axes(T), *walk, begin, self.rows)
        return from_axes(*frame)

    def _jacobian(self, parts, p=(0, 0, 0)):
        """J from what the walks have written: velocity of the point p; parts are (begin, end,
        seen).
        """
        J = _zeros(_ROWS, self.n)
        rotates = self.arm.rotates
        slides = self.arm.slides
        for i in range(self.n):
            set_column(J, i, self.rows[i][6:])
        columns.about_point(J, rotates, slides, self.n, p)
        for begin, end, seen in parts:
            if seen:
                seen_by = (self.rows, self.points, rotates, slides)
                structured.columns_of_axes(*seen_by, begin, end, J)
        m = self.arm.coordinates
        own = [[(k, 1.0)] for k in range(m)]
        if self.driven_by == own:  # else n m products with 0 and 1 are recorded, and fall away
            return J
        J_q = _zeros(_ROWS, m)
        columns.coupled(J, self.arm.coupling, self.n, m, J_q)
        return J_q

    def _slide(self, i: int):
        """s x_i, what joint i slides."""
        slide = self.arm.slides[i]
        if not slide:
            return 0.0
        terms = [(k, slide * factor) for k, factor in self.driven_by[i]]
        offset = slide * self.arm.shift[i]
        return self.graph.linear(terms, offset)

    def _outward_walk(self, begin: int) -> JointWalk:
        """Walk from joint `begin` to the last: a run of axes adds its angles up from its beginning."""
        joints = {}
        start = begin
        for i in range(begin, self.n):
            start = start if self.arm.parallel[i] else i
            joints[i] = range(start, i + 1)
        return self._walk(joints)

    def _inward_walk(self, begin: int) -> JointWalk:
        """Walk from joint `begin` to the first: a run of axes adds its angles up from its end."""
        joints = {}
        end = begin
        for i in range(begin, -1, -1):
            joints[i] = range(i, end + 1)
            end = end if self.arm.parallel[i] else i - 1
        return self._walk(joints)

    def _walk(self, joints: dict[int, range]) -> JointWalk:
        """Arguments of a walk, its sines and cosines of the sums of the angles of `joints`."""
        sines: list[Any] = [None] * self.n
        cosines: list[Any] = [None] * self.n
        for i, summed in joints.items():
            sine, cosine = self._sine_cosine(summed)
            sines[i] = sine
            cosines[i] = cosine
        return JointWalk(self.arm.links, self.d_offsets, self.arm.parallel, sines, cosines)

    def _sine_cosine(self, joints: range):
        """Sine and cosine of the sum of the joints' angles."""
        arm = self.arm
        factors = [0.0] * arm.coordinates
        for i in joints:
            for k, factor in self.driven_by[i]:
                factors[k] += arm.rotates[i] * factor
        offset = sum(arm.rotates[i] * arm.shift[i] + arm.offsets[i] for i in joints)
        quarters = sum(arm.quarters[i] for i in joints)
        return self.angles.sine_cosine(factors, offset, quarters)
