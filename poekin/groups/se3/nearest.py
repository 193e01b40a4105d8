"""Nearest pose of a 4x4 matrix that rounding or drift has taken off SE(3)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import TOLERANCE, Array, shaped
from ..so3.nearest import FARTHEST, project, refuse


class NearestPose(NamedTuple):
    """Poses nearest to 4x4 matrices, and how far their rotations were off.

    Attributes
    ----------
    T : (..., 4, 4) ndarray
        Poses, their translations as they were, m.
    moved : (...) ndarray
        Frobenius norm of the difference; about √2 times an angle in rad.
    """

    T: Array
    moved: Array


def nearest(M: ArrayLike, *, max_moved: float = FARTHEST) -> NearestPose:
    """Pose nearest to a matrix that is nearly one, and its distance.

    Parameters
    ----------
    M : (..., 4, 4) array_like
        Rounded or drifted pose T_ab, lengths in m.
    max_moved : float, default 0.1
        Largest accepted Frobenius distance between the rotations, 0 or more, without unit.

    Returns
    -------
    found : NearestPose
        Pose T (..., 4, 4), its translation that of M, and distance moved (...).

    Raises
    ------
    PoseError
        If M is not finite, if its last row misses (0, 0, 0, 1) by more than 1e-5, or if its 3x3
        corner has a determinant of 0 or less or is farther than max_moved from every rotation.
    ShapeError
        If the last axes of M are not (4, 4).
    InputError
        If M holds anything but real numbers, or max_moved is no number, NaN or below 0.

    Notes
    -----
    The rotation is that of `so3.nearest`.

    Accuracy: rotation orthonormal within 1e-14 in each entry, translation exact. Source: the
    orthogonal Procrustes problem, Schönemann 1966; Modern Robotics calls it ProjectToSE3, which
    takes any matrix.

    Examples
    --------
    >>> import poekin as pk
    >>> home = [[0.7071, -0.7071, 0, 0.3], [0.7071, 0.7071, 0, 0], [0, 0, 1, 0.5], [0, 0, 0, 1]]
    >>> T, moved = pk.se3.nearest(home)
    >>> print(T.round(6) + 0.0)
    [[ 0.707107 -0.707107  0.        0.3     ]
     [ 0.707107  0.707107  0.        0.      ]
     [ 0.        0.        1.        0.5     ]
     [ 0.        0.        0.        1.      ]]
    >>> print(round(float(moved), 6))
    1.4e-05
    """
    M = shaped(M, (4, 4), "M")
    off = ~(np.abs(M[..., 3, :] - (0.0, 0.0, 0.0, 1.0)).sum(-1) <= TOLERANCE)
    refuse(off, "M", "expected the last row [0, 0, 0, 1]")
    refuse(~np.isfinite(M[..., :3, 3]).all(-1), "M", "expected finite numbers")
    R, moved = project(M[..., :3, :3], max_moved, "M")
    T = np.zeros(M.shape)
    T[..., :3, :3] = R
    T[..., :3, 3] = M[..., :3, 3]
    T[..., 3, 3] = 1.0
    return NearestPose(T, moved)
