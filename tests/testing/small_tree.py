"""A URDF of five joints as a case: each thing that a small URDF may have is in it once at least."""

from __future__ import annotations

import numpy as np

from poekin.testing.conform.laws.law import Case
from poekin.testing.conform.laws.small_urdf import UrdfJoint, UrdfLayout

JOINTS = (
    UrdfJoint("revolute", "j0"), UrdfJoint("fixed", "j1"), UrdfJoint("prismatic", "j2", axis=False),
    UrdfJoint("revolute", "j3", follows=0), UrdfJoint("prismatic", "j4", follows=2),
)  # fmt: skip
# Of xyz and of rpy each number stands alone somewhere, and what stands beside them is not 0
# somewhere.
ROWS = [
    [0, 0, 1.0, 0, 0, 0, 0, 0, 0, 0, 0, 0.5],
    [0, 0, 1.0, 0, 0, 0.25, 0, 0, 0, 0, 0, 0],
    [1.0, 0, 0, 0.5, 0, 0, 0, 0, 0.1, 0, 0, -1.0],
    [0, 1.0, 0, 0, 0, 0, 0.2, 0, 0, 1.0, 0.25, 0],
    [-0.0, 0, -1.0, 0, 0.75, 0, 0, 0, 0, -2.0, 0, 0],
]
CASE = Case(np.array(ROWS).ravel(), UrdfLayout(JOINTS, (3, 1, 0, 2, 4), (-1, 0, -1, 2, 1)))
