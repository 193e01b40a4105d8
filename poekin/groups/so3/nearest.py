"""Nearest rotation of a 3x3 matrix that rounding or drift has taken off SO(3)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ...checks import is_real
from ...errors import InputError, PoseError, safe_repr
from ..arrays import Array, first_place, shaped

FARTHEST = 0.1  # a rotation given to one decimal moves by up to 0.15, to two by up to 0.015


class NearestRotation(NamedTuple):
    """Rotations nearest to 3x3 matrices, and how far these were off.

    Attributes
    ----------
    R : (..., 3, 3) ndarray
        Rotations.
    moved : (...) ndarray
        Frobenius norm of the difference; about √2 times an angle in rad.
    """

    R: Array
    moved: Array


def nearest(M: ArrayLike, *, max_moved: float = FARTHEST) -> NearestRotation:
    """Rotation nearest to a matrix that is nearly one, and its distance.

    Parameters
    ----------
    M : (..., 3, 3) array_like
        Rounded or drifted rotation R_ab.
    max_moved : float, default 0.1
        Largest accepted Frobenius distance between M and the rotation, 0 or more, without unit.

    Returns
    -------
    found : NearestRotation
        Rotation R (..., 3, 3) and distance moved (...).

    Raises
    ------
    PoseError
        If M is not finite, has a determinant of 0 or less, or is farther than max_moved from every
        rotation.
    ShapeError
        If the last axes of M are not (3, 3).
    InputError
        If M holds anything but real numbers, or max_moved is no number, NaN or below 0.

    Notes
    -----
    R = U Vᵀ of the singular value decomposition M = U Σ Vᵀ minimises the Frobenius norm of R - M.

    Accuracy: R orthonormal within 1e-14 in each entry. Source: the orthogonal Procrustes problem,
    Schönemann 1966; Modern Robotics calls it ProjectToSO3, which takes any matrix.

    Examples
    --------
    >>> import poekin as pk
    >>> R, moved = pk.so3.nearest([[0.866, -0.5, 0], [0.5, 0.866, 0], [0, 0, 1]])
    >>> print(R.round(6) + 0.0)
    [[ 0.866019 -0.500011  0.      ]
     [ 0.500011  0.866019  0.      ]
     [ 0.        0.        1.      ]]
    >>> print(round(float(moved), 6))
    3.1e-05
    """
    return project(shaped(M, (3, 3), "M"), max_moved, "M")


def project(M: Array, max_moved: float, what: str) -> NearestRotation:
    """`nearest` of an array that messages call `what`."""
    if not is_real(max_moved) or not max_moved >= 0:
        raise InputError(f"max_moved: expected a number from 0 up, got {safe_repr(max_moved)}")
    finite = np.isfinite(M).all((-1, -2))
    refuse(~finite, what, "expected finite numbers")
    sign, _ = np.linalg.slogdet(M)
    refuse(sign <= 0.0, what, "near no rotation, its determinant is 0 or less")
    U, _, V = np.linalg.svd(M)
    R = U @ V
    with np.errstate(over="ignore"):
        moved = np.linalg.norm(R - M, axis=(-2, -1))
    refuse(
        moved > max_moved,
        what,
        f"farther than {max_moved:g} (Frobenius norm) from every rotation",
    )
    return NearestRotation(R, moved)


def refuse(bad: ArrayLike, what: str, reason: str) -> None:
    """Raises PoseError with the place of the first matrix that is bad."""
    if np.any(bad):
        raise PoseError(f"{first_place(bad, what)}: {reason}")
