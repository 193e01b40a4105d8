"""The Jacobian algorithms of the paper's table and their variants, as `count` runs them.

Each takes `Links` of scalars and returns J (six rows) and a function that goes on to the pose.
Source: Park 1994, Sections III and IV.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

from ...algebra import (
    IDENTITY,
    add,
    compose,
    cross,
    make_pose,
    pose,
    rotate,
    set_column,
    translation,
)
from ...formulas.kinematics import recursive
from ...formulas.paper import dh_recursive, direct

Row = Sequence[Any]
Rows = list[list[Any]]


@dataclass(frozen=True)
class Links:
    """The input of an algorithm: n joints, the poses of their links and, where a formula has them,
    their screws.

    `poses` are of whatever kind the algorithm's form wants: exponentials, or poses of link frames.
    The integers 0 and 1 in rotates and slides are structure and cost nothing.
    """

    n: int
    rotates: Sequence[float]
    slides: Sequence[float]
    screws: Sequence[Row]
    poses: Sequence[Row]
    tool: Row

    @property
    def joints(self) -> tuple[Sequence[float], Sequence[float], int]:
        """rotates, slides and n, as the formulas take them."""
        return self.rotates, self.slides, self.n


JacobianThenPose = tuple[Rows, Callable[[], Row]]


def empty_rows(columns: int) -> Rows:
    """Six rows of zeros, to be written into."""
    return [[0.0] * columns for _ in range(6)]


def direct_space(links: Links) -> JacobianThenPose:
    """Section III in the base frame. The pose takes two products more."""
    J = empty_rows(links.n)
    T = direct.space(links.screws, links.poses, links.n, J)
    return J, lambda: compose(compose(T, links.poses[-1]), links.tool)


def direct_body(links: Links) -> JacobianThenPose:
    """Section III in the tool's frame. The pose takes two products more."""
    J = empty_rows(links.n)
    T = direct.body(links.screws, links.poses, links.n, J)
    return J, lambda: compose(links.tool, compose(links.poses[0], T))


def general_frames(links: Links) -> JacobianThenPose:
    """Section IV's recursion where link frames are attached anywhere: column i is Ad(f_{i,i+1} ...
    f_{n-1,n})^-1 S_i.

    That is the direct method's own loop with S_i in place of B_i and f_{i-1,i} in place of e^{B_i
    x_i}.
    """
    J = empty_rows(links.n)
    T = direct.body(links.screws, links.poses, links.n, J)
    return J, lambda: compose(links.poses[0], T)


def z_aligned(links: Links) -> JacobianThenPose:
    """Section IV's recursion in z-aligned frames, the tool in the last link's frame."""
    J = empty_rows(links.n)
    T = recursive.body(links.poses, *links.joints, J)
    return J, lambda: compose(links.poses[0], T)


def with_tool(links: Links) -> JacobianThenPose:
    """Section IV's recursion in z-aligned frames, the constant tool behind the last link."""
    J = empty_rows(links.n)
    T = recursive.body_with_tool(links.poses, links.tool, *links.joints, J)
    return J, lambda: compose(links.poses[0], T)


def orin_schrader(links: Links) -> JacobianThenPose:
    """The recursion on Paul's frames as the paper charges Denavit and Hartenberg: tool and first
    link included.
    """
    J = empty_rows(links.n)
    T = dh_recursive.body(links.poses, links.tool, *links.joints, J)
    return J, lambda: T


def paul(links: Links) -> JacobianThenPose:
    """The recursion on Paul's frames without a tool: J in the last link's frame, as the POE
    recursion of the paper's table has it.
    """
    return orin_schrader(replace(links, tool=IDENTITY))


def by_cross(links: Links) -> JacobianThenPose:
    """Section IV's recursion, z-aligned, each product's third column of R as the cross product of
    the first two.
    """
    J = empty_rows(links.n)
    *joints, (r, s) = zip(links.rotates, links.slides, strict=True)
    set_column(J, -1, (0.0, 0.0, r, 0.0, 0.0, s))
    T = pose(links.poses[-1])
    from_last = reversed(list(enumerate(joints)))
    for i, (r, s) in from_last:
        set_column(J, i, recursive.z_column(T, r, s))
        if i:
            T = product_by_cross(links.poses[i], T)
    return J, lambda: product_by_cross(links.poses[0], T)


def product_by_cross(a: Row, b: Row) -> Row:
    """T_ac = T_ab T_bc with the third column of R as X x Y: 33 multiplications and 24 additions."""
    X = rotate(a, b[0:9:3])
    Y = rotate(a, b[1:9:3])
    rows = zip(X, Y, cross(X, Y), strict=True)
    turned = rotate(a, translation(b))
    p = add(turned, translation(a))
    R = [x for row in rows for x in row]
    return make_pose(R, p)
