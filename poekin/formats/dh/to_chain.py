"""From a table of Denavit-Hartenberg parameters to a chain or a robot, by the paper's own route."""

from __future__ import annotations

import math

import numpy as np

from ...algebra import compose
from ...formulas import dh
from ...groups import se3
from ...groups.arrays import Array
from ...groups.vectors import rotation_part, translation_part
from ...model.chain import Chain
from ...model.joint import Joint
from ...model.robot import Robot
from ..common.names import free_name
from .table import Table, check_table


def link_poses(table: Table) -> list[tuple[float, ...]]:
    """K_0 ... K_n of `formulas.dh`, twelve numbers each: f = K_0 e^{P_1 x_1} K_1 ... e^{P_n x_n}
    K_n.
    """
    rows = table.rows
    links = [_twelve(table.base)]
    normals = [(row.a, row.alpha) for row in rows]
    if table.convention == "modified" and rows:
        normals.append((0.0, 0.0))
        before_first = _link(0.0, 0.0, *normals.pop(0))
        links[0] = compose(links[0], before_first)
    for row, (a, alpha) in zip(rows, normals, strict=True):
        links.append(_link(row.theta, row.d, a, alpha))
    links[-1] = compose(links[-1], _twelve(table.tool))
    return links


def to_chain(table: Table) -> Chain:
    """Chain of a Denavit-Hartenberg table, with the table's names, limits and coupling.

    Its screws are A_i = Ad(K_0 ... K_{i-1}) P_i, reversed for a flipped joint, and its home pose is
    M = K_0 ... K_n, K the constant link poses.

    Parameters
    ----------
    table : Table
        Table in either convention.

    Returns
    -------
    chain : Chain
        Chain from the table's base to its tool.

    Raises
    ------
    InputError
        If `table` is no Table.

    Notes
    -----
    Accuracy: pose within 8 u (n + 1) (2 + sum |x|) of the reach and what slides, u = 2^-53, where
    |d| and |a| are at most the reach; longer ones count in place of it (tests/formats/test_dh.py).
    Source: Park 1994, Section II.

    Examples
    --------
    >>> import poekin as pk
    >>> arm = pk.dh.to_chain(pk.dh.published("puma560"))
    >>> arm
    <Chain 'base' -> 'tool': 6 revolute joints, reach 1.69 m>
    >>> arm.fk([0.0] * 6).round(3)[:3, 3]
    array([ 0.452, -0.15 ,  1.104])
    """
    check_table(table, "to_chain")
    signs = 1.0 - 2.0 * np.array(table.flips, float)
    kinds = np.array(table.kinds, str)
    rotates = (signs * (kinds == "revolute")).tolist()
    slides = (signs * (kinds == "prismatic")).tolist()
    A = np.zeros((len(table), 6))
    K = link_poses(table)
    M = dh.screws(K, rotates, slides, len(table), A)
    chain = Chain.from_space(
        A,
        _matrix(M),
        joint_names=table.names,
        limits=table.limits,
        pitches=np.zeros(len(table)),
    )
    if table.coupling:
        return chain.coupled(table.coupling)
    return chain


def _link(
    theta: float,
    d: float,
    a: float,
    alpha: float,
) -> tuple[float, ...]:
    turn = math.sin(theta), math.cos(theta)
    twist = math.sin(alpha), math.cos(alpha)
    return dh.link(*turn, d, a, *twist)


def _twelve(T: Array) -> tuple[float, ...]:
    R = rotation_part(T).ravel()
    return (*R.tolist(), *translation_part(T).tolist())


def to_robot(table: Table) -> Robot:
    """Robot of a Denavit-Hartenberg table: one branch, a link for each joint, z along the joint's axis.

    Parameters
    ----------
    table : Table
        Table in either convention.

    Returns
    -------
    robot : Robot
        Robot with links base, link1, ..., tool.

    Raises
    ------
    InputError
        If `table` is no Table.

    Notes
    -----
    Accuracy and source: as `to_chain`.

    Examples
    --------
    >>> import poekin as pk
    >>> robot = pk.dh.to_robot(pk.dh.published("stanford"))
    >>> robot.links
    ('base', 'link1', 'link2', 'link3', 'link4', 'link5', 'link6', 'tool')
    """
    check_table(table, "to_robot")
    numbered = (f"link{i + 1}" for i in range(len(table)))
    links = ["base", *numbered, "tool"]
    origins = list(map(_matrix, link_poses(table)))
    joints = []
    frames = zip(table.rows, links, links[1:], origins, strict=False)
    for row, parent, child, origin in frames:
        axis = (0.0, 0.0, 1.0 - 2.0 * row.flip)
        joints.append(
            Joint(
                row.name,
                row.kind,
                parent,
                child,
                origin,
                axis,
                row.limits,
            )
        )
    fixed = free_name("tool_mount", set(table.names))
    joints.append(Joint(fixed, "fixed", links[-2], "tool", origins[-1]))
    return Robot(table.name, links, joints, coupling=table.coupling)


def _matrix(K: tuple[float, ...]) -> Array:
    R = np.reshape(K[:9], (3, 3))
    return se3.pose(R, K[9:])
