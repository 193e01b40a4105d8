"""Motions from pose to pose and from q to q: paths over s in 0 ... 1, time scaling s(t), the
fastest trajectory along a path, and files of all of them.
"""

from .csv_io import read_joints, read_poses, write_joints, write_poses
from .parameterization.time_optimal import time_optimal
from .paths import joint, line, path_lengths, screw
from .plot import plot_joints
from .timing import Timing, TimingSample, cubic, minimum_time, quintic, trapezoidal
from .trajectory.trajectory import Trajectory, TrajectorySample

__all__ = [
    "Timing",
    "TimingSample",
    "Trajectory",
    "TrajectorySample",
    "cubic",
    "joint",
    "line",
    "minimum_time",
    "path_lengths",
    "plot_joints",
    "quintic",
    "read_joints",
    "read_poses",
    "screw",
    "time_optimal",
    "trapezoidal",
    "write_joints",
    "write_poses",
]
