"""Motions from pose to pose and from q to q: paths over s in 0 ... 1, time scaling s(t), and CSV
files of both.
"""

from .csv_io import read_joints, read_poses, write_joints, write_poses
from .paths import joint, line, path_lengths, screw
from .plot import plot_joints
from .timing import Timing, TimingSample, cubic, minimum_time, quintic, trapezoidal

__all__ = [
    "Timing",
    "TimingSample",
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
    "trapezoidal",
    "write_joints",
    "write_poses",
]
