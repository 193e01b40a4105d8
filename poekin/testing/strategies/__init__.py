"""Hypothesis strategies for rotations, twists, poses, chains, configurations, robots, DH tables and
URDF texts.
"""

from .batch_strategies import batch_shapes, batches
from .chain_strategies import chains, coordinates, placements, points, screws
from .configuration_strategies import at_limits, singular_cases, within_limits
from .dh_strategies import tables
from .group_strategies import (
    angles,
    axes,
    group_cases,
    magnitudes,
    noisy_rotations,
    poses,
    quaternions_wxyz,
    rotation_vectors,
    rotations,
    twists,
    vectors,
)
from .near_strategies import (
    near_angles,
    near_poses,
    near_rotation_vectors,
    near_rotations,
    near_twists,
)
from .robot_strategies import robots
from .urdf_strategies import odd_urdfs

__all__ = [
    "angles",
    "at_limits",
    "axes",
    "batch_shapes",
    "batches",
    "chains",
    "coordinates",
    "group_cases",
    "magnitudes",
    "near_angles",
    "near_poses",
    "near_rotation_vectors",
    "near_rotations",
    "near_twists",
    "noisy_rotations",
    "odd_urdfs",
    "placements",
    "points",
    "poses",
    "quaternions_wxyz",
    "robots",
    "rotation_vectors",
    "rotations",
    "screws",
    "singular_cases",
    "tables",
    "twists",
    "vectors",
    "within_limits",
]
