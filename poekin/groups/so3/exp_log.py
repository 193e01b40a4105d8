"""Rotations from rotation vectors and back: exp, log, and axis and angle."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ...engine.kernels import group_kernels
from ...errors import ShapeError
from ..arrays import Array, direction_and_length, map_kernel, rotations, shaped, with_rows

Z_AXIS = (0.0, 0.0, 1.0)


class AxisAngle(NamedTuple):
    """Axis and angle of rotation vectors.

    Attributes
    ----------
    axis : (..., 3) ndarray
        Unit vector, in the frame of the rotation vector.
    angle : (...) ndarray
        Angle about the axis, rad, 0 or more.
    """

    axis: Array
    angle: Array


def exp(w: ArrayLike) -> Array:
    """Rotation exp [w] by the angle |w| about w.

    Parameters
    ----------
    w : (..., 3) array_like
        Rotation vector, axis times angle, rad. A skew-symmetric matrix [w] is refused: `vee` of it
        is w.

    Returns
    -------
    R : (..., 3, 3) ndarray
        Rotation R_ab where w is the turn of frame b in frame a.

    Raises
    ------
    ShapeError
        If the last axis of w is not 3, or if w is a skew-symmetric 3x3 matrix other than zero.
    InputError
        If w holds anything but real numbers.

    Notes
    -----
    R = I + A [w] + B [w]², A = sin θ / θ and B = (1 - cos θ) / θ² with θ = |w|.

    Accuracy: Frobenius error at most 3 u (1 + √2 θ) for θ ≤ 10, held by
    tests/groups/test_accuracy.py. Source: Park 1994, Lemma 1.

    Examples
    --------
    >>> import numpy as np
    >>> import poekin as pk
    >>> R = pk.so3.exp([0, 0, np.pi / 2])
    >>> print(np.round(R @ [1, 0, 0], 9))
    [0. 1. 0.]
    """
    return exp_of_vectors(rotation_vectors(w))


def rotation_vectors(w: ArrayLike) -> Array:
    """Values as rotation vectors (..., 3); a matrix [w] in their place is refused."""
    w = shaped(w, (3,), "w")
    if w.shape == (3, 3) and (w == -w.T).all() and w.any():
        raise ShapeError(
            "w: expected rotation vectors (..., 3), got a skew-symmetric 3x3 matrix [w]: pk.so3.vee"
            " of it is w; three rotation vectors that happen to look so go in as w[None]"
        )
    return w


def exp_of_vectors(w: Array) -> Array:
    """`exp` of rows that are known to be rotation vectors, whatever matrix they make together."""
    return map_kernel(group_kernels.so3_exp, 1, (3, 3), w)


def log(R: ArrayLike, near: ArrayLike | None = None) -> Array:
    """Rotation vector w with exp [w] = R.

    Parameters
    ----------
    R : (..., 3, 3) array_like
        Rotation R_ab, orthonormal to 1e-5. A smaller defect enters squared.
    near : (..., 3) array_like, optional
        Rotation vector, rad, broadcast against R: the result is the closest to it of all
        w + 2πk w/|w|, k an integer.

    Returns
    -------
    w : (..., 3) ndarray
        Rotation vector in frame a, rad. Without near it is on the principal branch, 0 ≤ |w| ≤ π;
        at |w| = π, where w and -w both serve, the component of largest magnitude is positive.

    Raises
    ------
    PoseError
        If R is no rotation.
    ShapeError
        If R or near has another shape, or one does not broadcast against the other.
    InputError
        If R or near holds anything but real numbers.

    Notes
    -----
    The angle comes from the quaternion of R's polar projection, by neither acos nor a division by
    sin θ, so it is as exact near π as anywhere.

    Accuracy: relative error at most 3 u (1 + 1.22 κ min(1, 1/θ)), κ = (θ/2) / sin(θ/2), held by
    tests/groups/test_accuracy.py. Source: Park 1994, Lemma 3 and Remark 1.

    Examples
    --------
    >>> import poekin as pk
    >>> R = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
    >>> print(pk.so3.log(R).round(6))
    [0.       0.       1.570796]
    >>> print(pk.so3.log(R, near=[0, 0, 7]).round(6))
    [0.       0.       7.853982]
    """
    R = rotations(R)
    if near is None:
        return map_kernel(group_kernels.so3_log, 2, (3,), R)
    R, rows = with_rows(R, near, 3, "near")
    return map_kernel(group_kernels.so3_log_near, 2, (3,), R, rows)


def axis_angle(w: ArrayLike) -> AxisAngle:
    """Unit axis and angle of a rotation vector, w = axis · angle.

    Parameters
    ----------
    w : (..., 3) array_like
        Rotation vector, rad; `log` makes one of a rotation.

    Returns
    -------
    turn : AxisAngle
        Axis (..., 3), a unit vector, and angle (...), rad. The axis of w = 0 is (0, 0, 1).

    Raises
    ------
    ShapeError
        If the last axis of w is not 3, or if w is a skew-symmetric 3x3 matrix other than zero.
    InputError
        If w holds anything but real numbers.

    Notes
    -----
    Accuracy: the axis is within 5 u of itself, from the smallest numbers to the largest, and so is
    an angle that is no subnormal number.
    Source: Modern Robotics calls it AxisAng3.

    Examples
    --------
    >>> import poekin as pk
    >>> axis, angle = pk.so3.axis_angle([0, 3, 4])
    >>> print(axis, float(angle))
    [0.  0.6 0.8] 5.0
    """
    w = rotation_vectors(w)
    axis, angle = direction_and_length(w)
    axis = np.where(angle[..., None] == 0.0, Z_AXIS, axis)
    return AxisAngle(axis, angle)
