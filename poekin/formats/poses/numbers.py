"""Poses of arrays of numbers, and the numbers of poses, as controllers and ROS have them."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ...errors import ShapeError
from ...groups import arrays
from ...groups.arrays import Array
from . import pose_rows
from .layout import PoseFormat, QuaternionOrder, layout


def from_numbers(
    numbers: ArrayLike,
    format: PoseFormat,
    *,
    quaternion: QuaternionOrder | None = None,
    mm: bool | None = None,
    deg: bool | None = None,
) -> Array:
    """Poses of numbers in a controller's or a library's format.

    Parameters
    ----------
    numbers : (..., k) array_like
        Numbers of each pose in the order of the format: 6, of quaternions 7, of "matrix" 12 or 16.
    format : str
        Convention of the numbers. In m and rad: "matrix" (rows of T, 12 or 16 numbers), "quat"
        (x y z and a unit quaternion), "ros" (with the quaternion x y z w), "rotvec" or "ur" (with a
        rotation vector), "rpy" (roll pitch yaw, Rz(yaw) Ry(pitch) Rx(roll)). In mm and degrees:
        "abc" or "kuka" (Rz(A) Ry(B) Rx(C)), "wpr" or "fanuc" (Rz(R) Ry(P) Rx(W)), "yaskawa" and
        "mitsubishi" (numbers of wpr), "staubli" (Rx(rx) Ry(ry) Rz(rz)), "zyz", "doosan" or
        "kawasaki" (Rz Ry Rz), "abb" (x y z and the quaternion w x y z).
    quaternion : {"wxyz", "xyzw"}, optional
        Order of the quaternion, which "quat" needs.
    mm : bool, optional
        Whether lengths are in mm and not in m; by default as the format says. The formats of
        controllers and of ROS have no other units than theirs.
    deg : bool, optional
        Whether angles are in degrees and not in rad; by default as the format says.

    Returns
    -------
    T : (..., 4, 4) ndarray
        Poses of the tool in the frame that the numbers are in, m: p_frame = R p_tool + p. Numbers
        that are not finite give NaN.

    Raises
    ------
    InputError
        If the format or the order is none of those, or the format is not in these units.
    ShapeError
        If the last axis has another length.
    PoseError
        If a matrix misses orthonormality by more than 1e-5, or a quaternion length 1 by more than
        1e-3.

    Notes
    -----
    Accuracy: every entry of R within 8 u, u = 2^-53, of that of the numbers, lengths within u of
    themselves; held by tests/formats/poses/test_vendors.py. Rounded numbers are another matter: 3
    decimals of a degree are 0.001°, 3 decimals of a quaternion 0.1°.
    Source: the controllers' manuals, named in tests/formats/poses/vendors.py.

    Examples
    --------
    >>> import poekin as pk
    >>> T = pk.poses.from_numbers([500, 0, 300, 0, 180, 0], "abc")
    >>> print(T[:3, 3], T[2, 2])
    [0.5 0.  0.3] -1.0
    """
    rows = arrays.numbers(numbers, "numbers")
    count = rows.shape[-1] if rows.ndim else 0
    chosen = layout(format, quaternion, mm=mm, deg=deg)
    expected = len(chosen.columns)
    if count != expected and not (format == "matrix" and count == 12):
        raise ShapeError(
            f"numbers: expected shape (..., {expected}) of {' '.join(chosen.columns)}, got {rows.shape}"
        )
    batch = rows.shape[:-1]
    flat = rows.reshape(-1, count)

    def where(i: int) -> str:
        return arrays.element_name("numbers", np.unravel_index(i, batch))

    return pose_rows.to_poses(flat, chosen, where).reshape(*batch, 4, 4)


def to_numbers(
    T: ArrayLike,
    format: PoseFormat,
    *,
    quaternion: QuaternionOrder | None = None,
    mm: bool | None = None,
    deg: bool | None = None,
) -> Array:
    """Numbers of poses in a controller's or a library's format.

    Parameters
    ----------
    T : (..., 4, 4) array_like
        Poses, m, in any frame.
    format, quaternion, mm, deg : optional
        As in `from_numbers`; "matrix" gives 16 numbers.

    Returns
    -------
    numbers : (..., k) ndarray
        Numbers of each pose, in the frame of T. Angles are within half a turn, B of "abc" and P of
        "wpr" within a quarter turn, the middle one of "zyz" from 0 to half a turn. In the lock the
        angle about x is 0 ("staubli": rx; "zyz": the last). Of two quaternions the one with w >= 0.

    Raises
    ------
    InputError
        If the format or the order is none of those.
    PoseError
        If T is no pose.
    ShapeError
        If T has another shape.

    Notes
    -----
    Accuracy: numbers there and back are the rotation within 1e-15 in every entry, in the lock as
    anywhere; held by tests/formats/poses/test_numbers.py.
    Source: as in `from_numbers`.

    Examples
    --------
    >>> import poekin as pk
    >>> T = pk.poses.from_numbers([0.5, 0, 0.3, 0, 0, 0, 1], "ros")
    >>> print(pk.poses.to_numbers(T, "abc"))
    [500.   0. 300.   0.   0.   0.]
    """
    poses = arrays.poses(T)
    chosen = layout(format, quaternion, mm=mm, deg=deg)
    rows = pose_rows.to_rows(poses.reshape(-1, 4, 4), chosen)
    return rows.reshape(*poses.shape[:-2], len(chosen.columns))
