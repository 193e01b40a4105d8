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

from ....errors import InputError, ShapeError, safe_repr
from ....groups.arrays import numbers
from ...option_checks import is_whole, whole


class ObservabilityIndices(NamedTuple):
    """The four indices of one identification matrix, floats, or arrays (...) of many.

    O1: the volume of the error ellipsoid's inverse, a mean over all directions; larger is better.
    condition: how unlike the best and the worst seen direction are, 1 at best; smaller is better.
    smallest: how well the worst seen direction is seen; larger is better.
    amplification: how little the noise of the measurements is amplified; larger is better.
    """

    O1: Any
    condition: Any
    smallest: Any
    amplification: Any


UNOBSERVED = ObservabilityIndices(O1=0.0, condition=np.inf, smallest=0.0, amplification=0.0)
"""Indices where nothing is seen."""


def observability_indices(J: ArrayLike, m: int, rank: int | None = None) -> ObservabilityIndices:
    """The observability indices of an identification matrix on the space that can be identified.

        O1 = (sigma_1 ... sigma_L)^(1/L) / sqrt(m)      condition = sigma_1 / sigma_L
        smallest = sigma_L                              amplification = sigma_L^2 / sigma_1

    m is the number of measured configurations (not of the matrix' rows): O1 of a set that is
    measured twice stays, and so the index compares sets of different size, while the other indices
    gain sqrt(2), or, the condition, stay.

    Parameters: J (..., rows, P), the parameters' derivatives, scaled; m; rank, L: the number of
    directions that can be seen, by default P. The L largest singular values are taken. Returns:
    ObservabilityIndices, floats for one matrix, else (...).
    A matrix with fewer than L rows, or with sigma_L = 0, has O1 = smallest = amplification = 0,
    condition = inf. Raises: ShapeError, InputError. Accuracy: sigma_L within P u sigma_1.
    Source: O1: Borm and Menq 1989 and 1991 (Int. J. Robotics Research 10, 1); condition: Driels and
    Pathre 1990
    (J. Robotic Systems 7, 2); smallest and amplification: Nahvi, Hollerbach and Hayward 1994
    (ICRA), Nahvi and Hollerbach 1996 (ICRA, "The noise amplification index for optimal pose
    selection in robot calibration"); m as in Daney, Papegay and Madeline 2005 (Int. J. Robotics
    Research 24, 6); all four side by side: Sun and Hollerbach 2008 (ICRA, "Observability index
    selection for robot calibration"), where the condition is inverted.
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
    first = sigma[..., 0]
    last = sigma[..., -1]
    seen = last > 0
    safe = np.where(seen[..., None], sigma, 1.0)
    indices = ObservabilityIndices(
        O1=np.where(seen, np.exp(np.log(safe).mean(-1)) / np.sqrt(m), 0.0),
        condition=np.where(seen, safe[..., 0] / safe[..., -1], np.inf),
        smallest=last,
        amplification=np.where(seen, safe[..., -1] / safe[..., 0] * last, 0.0),
    )
    return ObservabilityIndices(*map(float, indices)) if first.ndim == 0 else indices
