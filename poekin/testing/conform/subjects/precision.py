"""Precisions that a subject may compute in, and what its errors are held to in each."""

from __future__ import annotations

from typing import Any, Literal, NamedTuple

import numpy as np

PrecisionName = Literal["float64", "float32"]


class Precision(NamedTuple):
    """Precision that a subject may compute in.

    The grades of float32 end at about the same share of its digits as those of float64.

    Parameters
    ----------
    name : {"float64", "float32"}
        Name of the floats.
    unit : float
        Half the distance from 1 to the next float, u.
    good, poor : float
        Errors at which these grades end.
    smallest : float
        Smallest angle whose square is no subnormal, rad.
    """

    name: PrecisionName
    unit: float
    good: float
    poor: float
    smallest: float

    @property
    def coarser(self) -> float:
        """Ratio of its unit to that of float64."""
        return self.unit / DOUBLE.unit

    def rounded(self, x: np.ndarray) -> np.ndarray:
        """Floats of this precision nearest to x, as float64; what would be subnormal is 0."""
        if self is not SINGLE:
            return x
        near = np.asarray(x, dtype=np.float32).astype(float)
        return np.where(np.abs(near) < 1e-30, 0.0, near)


DOUBLE = Precision("float64", 2.0**-53, 1e-10, 1e-6, 1e-150)
SINGLE = Precision("float32", 2.0**-24, 1e-5, 1e-3, 1e-18)
PRECISIONS = {precision.name: precision for precision in (DOUBLE, SINGLE)}


def seen(value: Any) -> Precision:
    """Precision of a result, by its `dtype`; float64 where it has none that is known."""
    return PRECISIONS.get(str(getattr(value, "dtype", "")).rpartition(".")[2], DOUBLE)
