"""Observability indices: how well a set of measured configurations shows the parameters of a
calibration.

All are functions of the singular values sigma_1 >= ... >= sigma_L of the identification matrix J,
the stacked derivatives of the m measured configurations with respect to the parameters, on the L
directions that can be seen at all. They depend on units: poekin takes rad for angles and lengths
divided by the arm's reach, in rows and columns.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ....checks import is_whole, whole
from ....errors import InputError, ShapeError, safe_repr
from ....groups.arrays import numbers


class ObservabilityIndices(NamedTuple):
    """Observability indices of one identification matrix, floats, or arrays (...) of many.

    Parameters
    ----------
    O1 : float or (...) ndarray
        Geometric mean of the singular values ÷ √m; larger is better.
    condition : float or (...) ndarray
        Largest ÷ smallest singular value, 1 at best; smaller is better.
    smallest : float or (...) ndarray
        Smallest singular value; larger is better.
    amplification : float or (...) ndarray
        Noise amplification index, smallest² ÷ largest singular value; larger is better.
    """

    O1: Any
    condition: Any
    smallest: Any
    amplification: Any


UNOBSERVED = ObservabilityIndices(O1=0.0, condition=np.inf, smallest=0.0, amplification=0.0)
"""Indices where nothing is seen."""


def observability_indices(J: ArrayLike, m: int, rank: int | None = None) -> ObservabilityIndices:
    """Observability indices of an identification matrix on the space that can be identified.

    With the singular values σ_1 >= ... >= σ_L of J, O1 = (σ_1 ... σ_L)^(1/L) / √m, condition =
    σ_1 / σ_L, smallest = σ_L and amplification = σ_L² / σ_1. O1 of a set that is measured twice
    stays; of the others, the condition stays and the other two gain √2.

    Parameters
    ----------
    J : (..., rows, P) array_like
        Derivatives of the measured values with respect to the parameters, scaled: angles in rad,
        lengths in reaches of the arm, for instance.
    m : int
        Number of measured configurations, not of the rows.
    rank : int, optional
        L, the number of directions that can be seen, P by default: the L largest singular values
        are taken.

    Returns
    -------
    indices : ObservabilityIndices
        Floats for one matrix, else arrays (...). A matrix with fewer than L rows, or with σ_L = 0,
        has O1 = smallest = amplification = 0 and condition = inf.

    Raises
    ------
    ShapeError
        If J is no matrix.
    InputError
        If m or rank is no whole number in its range.

    Notes
    -----
    Accuracy: σ_L within P u σ_1. Source: O1: Borm and Menq 1989 and 1991 (Int. J. Robotics Research
    10, 1); condition: Driels and Pathre 1990 (J. Robotic Systems 7, 2); smallest and amplification:
    Nahvi, Hollerbach and Hayward 1994 (ICRA), Nahvi and Hollerbach 1996 (ICRA, "The noise
    amplification index for optimal pose selection in robot calibration"); m as in Daney, Papegay
    and Madeline 2005 (Int. J. Robotics Research 24, 6); all four side by side: Sun and Hollerbach
    2008 (ICRA, "Observability index selection for robot calibration"), where the condition is
    inverted.

    Examples
    --------
    >>> import poekin as pk
    >>> indices = pk.calibration.observability_indices([[2, 0], [0, 1], [0, 0]], m=1)
    >>> indices.condition, indices.amplification
    (2.0, 0.5)
    """
    matrix = numbers(J, "J")
    if matrix.ndim < 2:
        raise ShapeError(f"J: expected a matrix (..., rows, P), got shape {matrix.shape}")
    most = matrix.shape[-1]
    L = most if rank is None else rank
    if not is_whole(L, 1) or most < L:
        raise InputError(
            f"rank: expected a whole number from 1 to the {most} parameters, got {safe_repr(rank)}"
        )
    whole(m, "m", 1)
    if matrix.shape[-2] < L:
        return from_singular_values(np.zeros((*matrix.shape[:-2], L)), m)
    return from_singular_values(np.linalg.svd(matrix, compute_uv=False)[..., :L], m)


def from_singular_values(sigma: np.ndarray, m: int) -> ObservabilityIndices:
    """Observability indices of the L singular values (..., L), in descending order."""
    smallest = sigma[..., -1]
    seen = smallest > 0
    safe = np.where(seen[..., None], sigma, 1.0)
    first = safe[..., 0]
    last = safe[..., -1]
    mean = np.exp(np.log(safe).mean(-1))
    indices = ObservabilityIndices(
        O1=np.where(seen, mean / np.sqrt(m), 0.0),
        condition=np.where(seen, first / last, np.inf),
        smallest=smallest,
        amplification=np.where(seen, last / first * last, 0.0),
    )
    if sigma.ndim == 1:
        return ObservabilityIndices(*map(float, indices))
    return indices
