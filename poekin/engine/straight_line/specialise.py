"""The formulas of `structured` run for one arm on scalars that record: straight-line programs of
poses and Jacobians.

A Jacobian can be had in several ways, which are equal in mathematics and not in cost: all are
traced, and the cheapest is taken.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import product
from typing import Any

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
Walk = tuple[Any, Any, Any, list[Any], list[Any]]


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
    return min(
        (_traced(arm, frame, pose, *ways) for ways in product((False, True), repeat=2)),
        key=_cost,
    )


def cheapest_frame(arm: Structure) -> tuple[int, float]:
    """The joint k in whose frame the Jacobian costs least, and how far the structure's frame k
    stands from that frame's origin, along z: 0 or the joint's d (m).
    """
    places = [(k, h) for k, along in enumerate(arm.d_offsets) for h in dict.fromkeys((0.0, along))]
    return min(
        places,
        key=lambda place: _cost(cheapest_program(with_frame_at(arm, *place), place[0], pose=False)),
    )


def with_frame_at(arm: Structure, k: int, h: float) -> Structure:
    """The arm for a user whose frame of joint k has the structure's frame at (0, 0, h) and is
    turned as it.
    """
    frames = tuple((*IDENTITY[:11], h) if i == k else T for i, T in enumerate(arm.frames))
    return replace(arm, frames=frames)


def _cost(way: Program) -> int:
    # a pair of sine and cosine, or a division, takes about as long as ten products
    count = way.count
    return count.multiplications + count.additions + 10 * (count.sines + count.divisions)


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
    return program(
        trace.graph,
        trace.angles,
        [
            *(T if pose or frame is None else ()),
            *(x for row in J for x in row),
        ],
    )


def manipulability_program(arm: Structure, frame: str | int) -> Program:
    """The cheapest program of an arm's pose and det(J Jᵀ), or det(Jᵀ J) with fewer than six
    coordinates, of the Jacobian in a frame. Outputs: the twelve numbers of the pose, the
    determinant.
    """
    return min(
        (_measured(arm, frame, *ways) for ways in product((False, True), repeat=2)),
        key=_cost,
    )


def _measured(arm: Structure, frame: str | int, inner: bool, outer: bool) -> Program:
    trace = _Trace(arm)
    T, J = _pose_and_jacobian(trace, frame, True, inner, outer)
    m = arm.coordinates
    if m < _ROWS:
        J = [list(column) for column in zip(*J, strict=True)]
    sides = min(m, _ROWS), max(m, _ROWS)
    G: list[list[Any]] = [[0.0] * sides[0] for _ in range(sides[0])]
    return program(trace.graph, trace.angles, [*T, gram.determinant(J, *sides, G)])


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


class _Trace:
    """One recording: an arm's walks on the scalars of one graph."""

    def __init__(self, arm: Structure):
        self.arm = arm
        self.n = len(arm.links)
        self.graph = Graph()
        self.angles = Angles(self.graph)
        self.driven_by = [
            [(k, factor) for k, factor in enumerate(row) if factor] for row in arm.coupling
        ]
        self.d_offsets = [d + self._slide(i) for i, d in enumerate(arm.d_offsets)]
        self.rows: list[list[Any]] = [[0.0] * 12 for _ in range(self.n)]
        self.points: list[list[Any]] = [[0.0] * 2 for _ in range(self.n)]

    def hybrid(self, seen: bool):
        """The pose, and the Jacobian in the axes of the base and at the tip."""
        walk, T = self._outward_from_base()
        if seen:
            tool = translation(self.arm.tool)
            T = self._with_tip(T, structured.tip_seen(tool, *walk, self.n, self.points))
        return T, self._jacobian([(0, self.n, seen)], translation(T))

    def space(self, seen: bool):
        """The pose, and the Jacobian in the base frame."""
        walk, T = self._outward_from_base()
        structured.seen_outward(translation(inverse(self.arm.base)), *walk, 0, self.points)
        return T, self._jacobian([(0, self.n, seen)])

    def body(self, seen: bool):
        """The pose, and the Jacobian in the frame of the tip."""
        arm = self.arm
        last = self.n - 1
        walk = self._inward_walk(last)
        T = inverse(compose(self._inward(inverse(arm.tool), last, walk), inverse(arm.base)))
        p = structured.seen_inward(translation(arm.tool), *walk, last, self.points)
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
        return self._jacobian([(0, k + 1, inner), (k + 1, self.n, outer)])

    def _outward_from_base(self):
        """The outward walk from the base, and the pose of the tip that it leads to."""
        walk = self._outward_walk(0)
        return walk, compose(self._outward(self.arm.base, 0, walk), self.arm.tool)

    def _with_tip(self, T, p):
        """The pose T with its origin at p, given in the frame before joint 0."""
        return make_pose(T, transform(self.arm.base, p))

    def _outward(self, T, begin: int, walk: Walk):
        """The pose of the frame after the last joint where T is the one before joint `begin`."""
        return from_axes(*structured.outward(axes(T), *walk, begin, self.rows))

    def _inward(self, T, begin: int, walk: Walk):
        """The pose of the frame before joint 0 where T is the one after joint `begin`."""
        return from_axes(*structured.inward(axes(T), *walk, begin, self.rows))

    def _jacobian(self, parts, p=(0, 0, 0)):
        """J from what the walks have written: velocity of the point p; parts are (begin, end,
        seen).
        """
        J: list[list[Any]] = [[0.0] * self.n for _ in range(6)]
        rotates = self.arm.rotates
        slides = self.arm.slides
        for i in range(self.n):
            set_column(J, i, self.rows[i][6:])
        columns.about_point(J, rotates, slides, self.n, p)
        for begin, end, seen in parts:
            if seen:
                structured.columns_of_axes(self.rows, self.points, rotates, slides, begin, end, J)
        J_q: list[list[Any]] = [[0.0] * self.arm.coordinates for _ in range(6)]
        columns.coupled(J, self.arm.coupling, self.n, self.arm.coordinates, J_q)
        return J_q

    def _slide(self, i: int):
        """s x_i, what joint i slides."""
        slide = self.arm.slides[i]
        if not slide:
            return 0.0
        terms = [(k, slide * factor) for k, factor in self.driven_by[i]]
        return self.graph.linear(terms, slide * self.arm.shift[i])

    def _outward_walk(self, begin: int) -> Walk:
        """Walk from joint `begin` to the last: a run of axes adds its angles up from its beginning."""
        joints = {}
        start = begin
        for i in range(begin, self.n):
            start = start if self.arm.parallel[i] else i
            joints[i] = range(start, i + 1)
        return self._walk(joints)

    def _inward_walk(self, begin: int) -> Walk:
        """Walk from joint `begin` to the first: a run of axes adds its angles up from its end."""
        joints = {}
        end = begin
        for i in range(begin, -1, -1):
            joints[i] = range(i, end + 1)
            end = end if self.arm.parallel[i] else i - 1
        return self._walk(joints)

    def _walk(self, joints: dict[int, range]) -> Walk:
        """Arguments of a walk, its sines and cosines of the sums of the angles of `joints`."""
        pairs: list[tuple[Any, Any]] = [(0.0, 1.0)] * self.n
        for i, summed in joints.items():
            pairs[i] = self._sine_cosine(summed)
        sines = [sine for sine, _ in pairs]
        cosines = [cosine for _, cosine in pairs]
        return self.arm.links, self.d_offsets, self.arm.parallel, sines, cosines

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
