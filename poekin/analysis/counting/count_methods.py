"""The Jacobian algorithms of the paper's table and their variants, as `count` runs them.

Each takes an `Arm` of scalars and returns J (six rows) and a function that goes on to the pose.
Source: Park 1994, Sections III and IV.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from ...algebra import IDENTITY, compose, cross, pose, pose_of, set_column
from ...formulas.kinematics import recursive
from ...formulas.paper import dh_recursive, direct

Row = Sequence[Any]
Rows = list[list[Any]]


@dataclass(frozen=True)
class Arm:
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


Result = tuple[Rows, Callable[[], Row]]


def empty_rows(columns: int) -> Rows:
    """Six rows of zeros, to be written into."""
    return [[0.0] * columns for _ in range(6)]


def direct_space(arm: Arm) -> Result:
    """Section III in the base frame. The pose takes two products more."""
    J = empty_rows(arm.n)
    T = direct.space(arm.screws, arm.poses, arm.n, J)
    return J, lambda: compose(compose(T, arm.poses[-1]), arm.tool)


def direct_body(arm: Arm) -> Result:
    """Section III in the tool's frame. The pose takes two products more."""
    J = empty_rows(arm.n)
    T = direct.body(arm.screws, arm.poses, arm.n, J)
    return J, lambda: compose(arm.tool, compose(arm.poses[0], T))


def general_frames(arm: Arm) -> Result:
    """Section IV's recursion where link frames are attached anywhere: column i is Ad(f_{i,i+1} ...
    f_{n-1,n})^-1 S_i.

    That is the direct method's own loop with S_i in place of B_i and f_{i-1,i} in place of e^{B_i
    x_i}.
    """
    J = empty_rows(arm.n)
    T = direct.body(arm.screws, arm.poses, arm.n, J)
    return J, lambda: compose(arm.poses[0], T)


def z_aligned(arm: Arm) -> Result:
    """Section IV's recursion in z-aligned frames, the tool in the last link's frame."""
    J = empty_rows(arm.n)
    T = recursive.body(arm.poses, arm.rotates, arm.slides, arm.n, J)
    return J, lambda: compose(arm.poses[0], T)


def with_tool(arm: Arm) -> Result:
    """Section IV's recursion in z-aligned frames, the constant tool behind the last link."""
    J = empty_rows(arm.n)
    T = recursive.body_with_tool(arm.poses, arm.tool, arm.rotates, arm.slides, arm.n, J)
    return J, lambda: compose(arm.poses[0], T)


def orin_schrader(arm: Arm) -> Result:
    """The recursion on Paul's frames as the paper charges Denavit and Hartenberg: tool and first
    link included.
    """
    J = empty_rows(arm.n)
    T = dh_recursive.body(arm.poses, arm.tool, arm.rotates, arm.slides, arm.n, J)
    return J, lambda: T


def paul(arm: Arm) -> Result:
    """The recursion on Paul's frames without a tool: J in the last link's frame, as the POE
    recursion of the paper's table has it.
    """
    J = empty_rows(arm.n)
    T = dh_recursive.body(arm.poses, IDENTITY, arm.rotates, arm.slides, arm.n, J)
    return J, lambda: T


def by_cross(arm: Arm) -> Result:
    """Section IV's recursion, z-aligned, each product's third column of R as the cross product of
    the first two.
    """
    J = empty_rows(arm.n)
    set_column(J, -1, (0.0, 0.0, arm.rotates[-1], 0.0, 0.0, arm.slides[-1]))
    T = pose(arm.poses[-1])
    for i in reversed(range(arm.n - 1)):
        set_column(J, i, recursive.z_column(T, arm.rotates[i], arm.slides[i]))
        if i:
            T = product_by_cross(arm.poses[i], T)
    return J, lambda: product_by_cross(arm.poses[0], T)


def product_by_cross(a: Row, b: Row) -> Row:
    """T_ac = T_ab T_bc with the third column of R as X x Y: 33 multiplications and 24 additions."""
    X, Y = (
        [a[k] * b[j] + a[k + 1] * b[j + 3] + a[k + 2] * b[j + 6] for k in (0, 3, 6)] for j in (0, 1)
    )
    Z = cross(X, Y)
    p = [a[k] * b[9] + a[k + 1] * b[10] + a[k + 2] * b[11] + a[9 + k // 3] for k in (0, 3, 6)]
    return pose_of((X[0], Y[0], Z[0], X[1], Y[1], Z[1], X[2], Y[2], Z[2]), p)
