"""Layout: a robot's tree as the arrays that the engine runs through, parents first, and the poses
of all its links.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from ...engine.kernels.tree_kernels import tree_poses
from ..checks import read_only
from ..joint import Joint
from .coupling import Coupling
from .tree import Tree


class TreeLayout(NamedTuple):
    """One row a joint in the order of `Tree.order`; link k + 1 is the child of row k, link 0 the
    root.

    link_row (L,): the row of poses that belongs to each link of the robot. joint_row (J,): the row
    of each joint. parents (J,): the row of the parent link. origins (J, 4, 4). screws (J, 6), zeros
    where a joint does not move. coordinate, ratio, shift (J,): as in `Coupling`, but in this order.
    """

    link_row: np.ndarray
    joint_row: np.ndarray
    parents: np.ndarray
    origins: np.ndarray
    screws: np.ndarray
    coordinate: np.ndarray
    ratio: np.ndarray
    shift: np.ndarray


def layout_of(tree: Tree, joints: Sequence[Joint], coupling: Coupling) -> TreeLayout:
    """The layout of a robot, read-only."""
    order = np.array(tree.order, dtype=np.int64)
    count = len(order)
    child_link = np.array(tree.child_link, dtype=np.int64)
    parent_link = np.array(tree.parent_link, dtype=np.int64)
    link_row = np.zeros(len(tree.parent_joint), dtype=np.int64)
    link_row[child_link[order]] = np.arange(1, count + 1)
    joint_row = np.empty(count, dtype=np.int64)
    joint_row[order] = np.arange(count)
    ordered = [joints[j] for j in tree.order]
    origins = np.array([joint.origin for joint in ordered])
    screws = np.array([joint.screw for joint in ordered])
    arrays: tuple[Any, ...] = (
        link_row,
        joint_row,
        link_row[parent_link[order]],
        origins.reshape(count, 4, 4),
        screws.reshape(count, 6),
        coupling.coordinate[order],
        coupling.ratio[order],
        coupling.shift[order],
    )
    return TreeLayout(*map(read_only, arrays))


def link_poses(
    layout: TreeLayout,
    values: np.ndarray,
    free: Mapping[int, np.ndarray],
) -> np.ndarray:
    """Poses (N, L, 4, 4) of the links in the root's frame, in row order, for values (N, m).

    free: for the number of a floating or planar joint its poses (N, 4, 4); the others are at
    identity.
    """
    count = len(values)
    bodies = len(layout.parents)
    x = np.zeros((count, bodies))
    follows = layout.coordinate >= 0
    followed = values[:, layout.coordinate[follows]]
    x[:, follows] = followed * layout.ratio[follows]
    x += layout.shift
    out = np.empty((count, bodies + 1, 4, 4))
    if not free:
        tree_poses.call(layout.parents, layout.origins, layout.screws, x, out)
        return out
    # The branch below a free joint is first placed as if its link were the root, then moved as one.
    placed = {int(layout.joint_row[joint]): T for joint, T in free.items()}
    cut = sorted(placed)
    parents = layout.parents.copy()
    parents[cut] = 0
    origins = layout.origins.copy()
    origins[cut] = np.eye(4)
    tree_poses.call(parents, origins, layout.screws, x, out)
    branch = [-1]
    for row, parent in enumerate(layout.parents.tolist()):
        branch.append(row if row in placed else branch[parent])
    for row in cut:
        parent = out[:, layout.parents[row]]
        T = parent @ layout.origins[row] @ placed[row]
        members = np.flatnonzero(np.array(branch) == row)
        out[:, members] = T[:, None] @ out[:, members]
    return out
