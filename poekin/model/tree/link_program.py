"""Straight-line program of the poses of all links of a robot."""

from __future__ import annotations

import numpy as np

from ...engine.straight_line.program import Program
from ...engine.straight_line.tree import TracedTree, tree_program
from .link_masses import TWELVE
from .robot_parts import RobotParts


def link_program(parts: RobotParts) -> Program:
    """Program of the pose of each link, in the order of `links`, in the root link's frame; floating
    and planar joints are at identity.
    """
    layout = parts.layout
    K = np.eye(len(parts.coupling.q_names)) if parts.readings is None else parts.readings
    rows = np.vstack(
        [K, np.zeros(K.shape[1])]
    )  # the last, number -1, is that of what does not move
    tree = TracedTree(
        layout.parents.tolist(),
        layout.origins.reshape(-1, 16)[:, TWELVE].tolist(),
        layout.screws.tolist(),
        (layout.ratio[:, None] * rows[layout.coordinate]).tolist(),
        layout.shift.tolist(),
    )
    return tree_program(tree, layout.link_row.tolist())
