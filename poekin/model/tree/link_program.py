"""Straight-line program of the poses of all links of a robot."""

from __future__ import annotations

import numpy as np

from ...engine.straight_line.program import Program, Terms
from ...engine.straight_line.tree import TracedTree, tree_program
from .chain_between import TWELVE
from .robot_parts import RobotParts


def link_program(parts: RobotParts) -> Program:
    """Program of the pose of each link, in the order of `links`, in the root link's frame; floating
    and planar joints are at identity.
    """
    layout = parts.layout
    tree = TracedTree(
        layout.parents.tolist(),
        layout.origins.reshape(-1, 16)[:, TWELVE].tolist(),
        layout.screws.tolist(),
        [
            _terms(parts, k, ratio)
            for k, ratio in zip(layout.coordinate.tolist(), layout.ratio.tolist(), strict=True)
        ],
        layout.shift.tolist(),
        len(parts.coupling.q_names),
    )
    return tree_program(tree, layout.link_row.tolist())


def _terms(parts: RobotParts, coordinate: int, ratio: float) -> Terms:
    """Coordinates that a joint follows, and their factors."""
    if coordinate < 0:
        return ()
    if parts.readings is None:
        return ((coordinate, ratio),)
    row = parts.readings[coordinate]
    return tuple((k, ratio * float(row[k])) for k in np.flatnonzero(row).tolist())
