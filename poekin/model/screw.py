"""Screws of joints: six numbers (ω; v), the angular part first, of the lines in space that they
stand for.

A screw is in the frame in which its direction and point are given; a chain wants those of its base.

revolute   (z; -z × p)             z a unit vector along the axis, p any point on it
helical    (z; -z × p + h z)       h the pitch in m per rad
prismatic  (0; z)                  a direction; it has no place
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from .. import algebra
from ..errors import InputError, ScrewError
from ..groups.arrays import Array, element_name, shaped
from ..groups.vectors import angular_part, linear_part, norm, norms
from .checks import finite
from .screw_rows.remedies import ROUNDED, UNIT
from .screw_rows.unit_screws import pitch_of, unit_screws, with_pitches

__all__ = ["Axis", "axis_of", "helical", "normalised", "prismatic", "revolute"]


class Axis(NamedTuple):
    """Axis of a screw.

    Attributes
    ----------
    direction : (3,) ndarray
        Unit vector along the axis.
    point : (3,) ndarray or None
        Point of the axis nearest to the origin, m; None for a prismatic joint, which has no place.
    pitch : float
        Pitch, m per rad: 0 for a revolute joint, infinite for a prismatic one.
    """

    direction: Array
    point: Array | None
    pitch: float


def revolute(axis: ArrayLike, point: ArrayLike) -> Array:
    """Screw (z; -z × p) of a revolute joint.

    Parameters
    ----------
    axis : (3,) array_like
        Direction of the axis, of any length but zero.
    point : (3,) array_like
        Any point p on the axis, m, in the frame of `axis`.

    Returns
    -------
    S : (6,) ndarray
        Screw, per rad.

    Raises
    ------
    ScrewError
        If the axis is zero.
    ShapeError
        If one of them has another shape.
    InputError
        If a number is not finite.

    Notes
    -----
    Accuracy: z within 6 u in each entry, its moment within 12 u |p|, u = 2^-53
    (tests/model/test_screw.py). Source: Park 1994, Section II.

    Examples
    --------
    >>> import poekin as pk
    >>> print(pk.screw.revolute([0, 0, 2], [0.5, 0, 0]))
    [ 0.   0.   1.   0.  -0.5  0. ]
    """
    return helical(axis, point, 0.0)


def helical(axis: ArrayLike, point: ArrayLike, pitch: float) -> Array:
    """Screw (z; -z × p + h z) of a helical joint.

    Parameters
    ----------
    axis : (3,) array_like
        Direction of the axis, of any length but zero.
    point : (3,) array_like
        Any point p on the axis, m, in the frame of `axis`.
    pitch : float
        Pitch h, m per rad.

    Returns
    -------
    S : (6,) ndarray
        Screw, per rad.

    Raises
    ------
    ScrewError
        If the axis is zero.
    ShapeError
        If one of them has another shape.
    InputError
        If a number is not finite.

    Notes
    -----
    Accuracy: as `revolute`, with |p| + |h| in place of |p|. Source: Park 1994, Section II.
    """
    z = _unit(axis)
    p = shaped(point, (3,), "point")
    h = float(shaped(pitch, (), "pitch"))
    if p.ndim != 1 or not np.isfinite([*p, h]).all():
        raise InputError(
            f"expected a finite point (3,) and pitch, got point {p.tolist()} and pitch {h}"
        )
    # The cross product with a far point has the rounding of that distance along z too, which would
    # pass for a pitch.
    S = np.array([*z, *algebra.cross(p, z)])
    (S,) = with_pitches(S[None], np.zeros(1))
    S[3:] += h * z
    return S


def prismatic(axis: ArrayLike) -> Array:
    """Screw (0; z) of a prismatic joint.

    Parameters
    ----------
    axis : (3,) array_like
        Direction of the motion, of any length but zero.

    Returns
    -------
    S : (6,) ndarray
        Screw, per m, in the frame of `axis`.

    Raises
    ------
    ScrewError
        If the axis is zero.
    ShapeError
        If it has another shape.
    InputError
        If a number is not finite.

    Notes
    -----
    Accuracy: as z of `revolute`. Source: Park 1994, Section II.
    """
    return np.concatenate([np.zeros(3), _unit(axis)])


def axis_of(screw: ArrayLike) -> Axis:
    """Direction, point and pitch of a screw: the inverse of `revolute`, `prismatic` and `helical`.

    The point is ω × v, the foot of the perpendicular from the origin.

    Parameters
    ----------
    screw : (6,) array_like
        Unit screw (ω; v), per rad or m, in any frame.

    Returns
    -------
    axis : Axis
        Its axis in the same frame, m.

    Raises
    ------
    ScrewError
        If it is no unit screw.
    ShapeError
        If it has another shape.
    InputError
        If it holds anything but real numbers.

    Notes
    -----
    Accuracy: direction within 4 u, point within 12 u |v|; the pitch is exactly 0 where it is
    rounding, below 4e-15 max(1 m, |v|) (tests/model/test_screw.py). Source: Park 1994, Section II:
    "ω × v is a point on the axis" holds for |ω| = 1.

    Examples
    --------
    >>> import poekin as pk
    >>> axis = pk.screw.axis_of([0, 0, 1, 0, -0.5, 0.1])
    >>> print(axis.direction, axis.point + 0.0, axis.pitch)
    [0. 0. 1.] [0.5 0.  0. ] 0.1
    """
    (S,) = unit_screws(shaped(screw, (6,), "screw")[None])
    w = angular_part(S)
    v = linear_part(S)
    if not w.any():
        return Axis(v, None, np.inf)
    return Axis(w, np.cross(w, v), float(pitch_of(S)))


def normalised(screws: ArrayLike, tolerance: float = ROUNDED) -> Array:
    """Unit screws on the lines of screws that were rounded, such as (0, 0.5, 0.866; ...).

    Parameters
    ----------
    screws : (..., 6) array_like
        Screws (ω; v), per rad or m, in any frame, nearly of unit length: |ω| = 1, or ω = 0 and
        |v| = 1.
    tolerance : float, default 0.01
        Largest difference from unit length.

    Returns
    -------
    S : (..., 6) ndarray
        Unit screws in the same frame.

    Raises
    ------
    ScrewError
        If a screw is further from unit length than the tolerance, with its index.
    ShapeError
        If the last axis is not of length 6.
    InputError
        If a number is not finite.

    Notes
    -----
    The whole row is divided by |ω|, or by |v| for a prismatic joint, which leaves the axis in its
    place; ω of at most 1e-9 is taken for 0. The pitch ω · v of rounded numbers is rounded as well,
    and seldom 0: give the pitches that are meant to `Chain`, as `pitches=`.
    Accuracy: within 2 u of unit length, u = 2^-53. Source: Park 1994, Lemmas 1 and 2, which need
    unit screws.

    Examples
    --------
    >>> import poekin as pk
    >>> S = pk.screw.normalised([0, 0.5, 0.866, 0, 0, 0])
    >>> print(S[:3].round(6))
    [0.       0.500011 0.866019]
    """
    given = finite(screws, "screws")
    S = shaped(given, (6,), "screws").copy()
    turns = norms(angular_part(S))[..., None]
    sliding = turns <= UNIT
    S[..., :3] *= ~sliding
    speeds = norms(linear_part(S))[..., None]
    lengths = np.where(sliding, speeds, turns)
    far = np.argwhere(np.abs(lengths - 1.0) > tolerance)
    if len(far):
        where = element_name("screws", far[0][:-1])
        raise ScrewError(
            f"{where}: expected |omega| = 1, or omega = 0 and |v| = 1, within {tolerance:g}; got"
            f" {S[tuple(far[0][:-1])].tolist()}"
        )
    return S / lengths + 0.0


def _unit(axis: ArrayLike) -> Array:
    z = shaped(axis, (3,), "axis")
    if z.ndim != 1 or not np.isfinite(z).all():
        raise InputError(f"axis: expected one finite vector (3,), got {z.tolist()}")
    largest = max(np.abs(z).max(), np.finfo(float).tiny)
    z = z / largest
    length = norm(z)
    if length == 0:
        raise ScrewError("axis: expected a direction, got the zero vector")
    return z / length
