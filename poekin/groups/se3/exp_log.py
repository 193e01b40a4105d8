"""Poses from twists and back: exp, log, and unit screw and angle."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ...engine.kernels import group_kernels
from ...errors import BranchError, show_numbers
from ..arrays import (
    Array,
    direction_and_length,
    element_name,
    map_kernel,
    poses,
    shaped,
    with_rows,
)

ALONG_Z = (0.0, 0.0, 0.0, 0.0, 0.0, 1.0)


class ScrewMotion(NamedTuple):
    """Unit screws and how far the motion goes along each.

    Attributes
    ----------
    screw : (..., 6) ndarray
        Screw (ω; v) in the frame of the twist: |ω| = 1, or ω = 0 and |v| = 1.
    theta : (...) ndarray
        Angle in rad, of a translation its length in m; 0 or more.
    """

    screw: Array
    theta: Array


def exp(xi: ArrayLike) -> Array:
    """Pose exp [xi] of the motion along the twist xi for one unit of time.

    Parameters
    ----------
    xi : (..., 6) array_like
        Twist (ω; v), rad and m.

    Returns
    -------
    T : (..., 4, 4) ndarray
        Pose T_ab where xi is given in frame a.

    Raises
    ------
    ShapeError
        If the last axis of xi is not 6.
    InputError
        If xi holds anything but real numbers.

    Notes
    -----
    Accuracy: rotation within 3 u (1 + √2 θ) in the Frobenius norm, translation p within
    3 u (|p| + |v| + θ |dp/dω|), for θ = |ω| ≤ 10, held by tests/groups/test_accuracy.py.
    Source: Park 1994, Lemma 2 for any |ω|.

    Examples
    --------
    Half a turn about the line along z through (1, 0, 0):

    >>> import numpy as np
    >>> import poekin as pk
    >>> T = pk.se3.exp(np.pi * pk.screw.revolute([0, 0, 1], [1, 0, 0]))
    >>> print(T[:3, 3].round(9) + 0.0)
    [2. 0. 0.]
    """
    return map_kernel(group_kernels.se3_exp, 1, (4, 4), shaped(xi, (6,), "xi"))


def log(T: ArrayLike, near: ArrayLike | None = None) -> Array:
    """Twist xi with exp [xi] = T.

    Parameters
    ----------
    T : (..., 4, 4) array_like
        Pose T_ab, its rotation orthonormal to 1e-5. A smaller defect enters squared.
    near : (..., 6) array_like, optional
        Twist, broadcast against T, of which ω counts: the result is the logarithm whose ω is
        closest to it, of all ω + 2πk ω/|ω|, k an integer.

    Returns
    -------
    xi : (..., 6) ndarray
        Twist (ω; v) in frame a, rad and m. Without near it is on the principal branch,
        0 ≤ |ω| ≤ π; at |ω| = π the component of ω of largest magnitude is positive.

    Raises
    ------
    PoseError
        If T is no pose.
    BranchError
        If there is no logarithm near: at |ω| = 2πk, k ≠ 0, only a translation along ω has one.
    ShapeError
        If T or near has another shape, or one does not broadcast against the other.
    InputError
        If T or near holds anything but real numbers.

    Notes
    -----
    The rotation's part is that of `so3.log`, by the quaternion, and v = J(ω)⁻¹ p in a form that does
    not cancel.

    Accuracy: ω as `so3.log`; v within 3 u (|v| + κ |p| + θ |dv/dω|), κ = (θ/2) / sin(θ/2), held
    by tests/groups/test_accuracy.py. Source: Park 1994, Lemma 4 and Remark 1.

    Examples
    --------
    >>> import numpy as np
    >>> import poekin as pk
    >>> T = pk.se3.exp([0, 0, 1.5, 0.2, 0, 0.1])
    >>> print(pk.se3.log(T).round(9) + 0.0)
    [0.  0.  1.5 0.2 0.  0.1]
    """
    T = poses(T)
    if near is None:
        return map_kernel(group_kernels.se3_log, 2, (6,), T)
    T, rows = with_rows(T, near, 6, "near")
    xi = map_kernel(group_kernels.se3_log_near, 2, (6,), T, rows)
    no_v = np.isnan(xi[..., 3:]).any(-1)
    finite = np.isfinite(T).all((-1, -2)) & np.isfinite(xi[..., :3]).all(-1)
    without_log = np.argwhere(no_v & finite)
    if len(without_log):
        index = tuple(without_log[0])
        raise BranchError(
            f"{element_name('T', index)} has no logarithm near omega ="
            f" {show_numbers(rows[index][:3])}: at |omega| = 2 pi k, k != 0, only a translation"
            f" along omega has one, got p = {show_numbers(T[index][:3, 3])}"
        )
    return xi


def axis_angle(xi: ArrayLike) -> ScrewMotion:
    """Unit screw and angle of a twist, xi = screw · theta.

    Parameters
    ----------
    xi : (..., 6) array_like
        Twist (ω; v), rad and m; `log` makes one of a pose.

    Returns
    -------
    motion : ScrewMotion
        Screw (..., 6) and theta (...). Where ω ≠ 0, theta = |ω| in rad; where ω = 0 it is |v|
        in m, and the screw is the translation along v; of xi = 0 the one along z.

    Raises
    ------
    ShapeError
        If the last axis of xi is not 6.
    InputError
        If xi holds anything but real numbers.

    Notes
    -----
    No tolerance decides whether a motion turns: an ω of 1e-17 rad is a turn, about an axis of a
    very large pitch.

    Accuracy: screw and theta within 6 u of themselves for |ω| ≥ 1e-300 or ω = 0.
    Source: Modern Robotics calls it AxisAng6.

    Examples
    --------
    >>> import poekin as pk
    >>> screw, theta = pk.se3.axis_angle([0, 0, 2, 0, -1, 0])
    >>> print(screw, float(theta))
    [ 0.   0.   1.   0.  -0.5  0. ] 2.0
    >>> screw, theta = pk.se3.axis_angle([0, 0, 0, 0.3, 0, 0])
    >>> print(screw, float(theta))
    [0. 0. 0. 1. 0. 0.] 0.3
    """
    xi = shaped(xi, (6,), "xi")
    axis, angle = direction_and_length(xi[..., :3])
    direction, length = direction_and_length(xi[..., 3:])
    turns = angle != 0.0
    theta = np.where(turns, angle, length)
    with np.errstate(over="ignore", invalid="ignore"):
        v = np.where(
            turns[..., None],
            xi[..., 3:] / np.where(turns, angle, 1.0)[..., None],
            direction,
        )
    screw = np.concatenate([axis, v], axis=-1)
    return ScrewMotion(np.where(theta[..., None] == 0.0, ALONG_Z, screw), theta)
