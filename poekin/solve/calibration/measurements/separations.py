"""Distances between points of the tool whose places in the tip frame are not known."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ....errors import InputError, ShapeError, safe_repr
from ....groups.arrays import Array, numbers
from ....groups.vectors import normalised_or_zero, norms
from .measurement import Derivatives, Frames, Measurement
from .points import unknown_points

_EVEN = 1e-9  # m: a table whose halves differ by more is not one of distances


@dataclass(frozen=True, eq=False)
class Separations(Measurement):
    """Known distances between points of the tool that `Points` of the same name measures.

    They are soft: each has its variance. Of a plate of reflectors that was measured by itself.

    Parameters
    ----------
    d : (k, k) array_like
        Distances d[i, j] between points i and j, m, symmetric; NaN where one is not known.
    points : str
        Name of the points, as `Points(p, points="plate")` has it.
    covariance : float or (K,) array_like
        Variance of the K known distances, in the order of d's rows above its diagonal, m².

    Raises
    ------
    ShapeError
        If d is no table of two points or more.
    InputError
        If d is not symmetric, a distance is not above 0, none is known, a variance is not positive,
        or there is no name.

    Examples
    --------
    >>> import poekin as pk
    >>> plate = [[0, 0.2, 0.2], [0.2, 0, 0.3], [0.2, 0.3, 0]]
    >>> len(pk.calibration.Separations(plate, "plate", 1e-5**2))
    3
    """

    d: Any
    points: Any
    covariance: Any

    rows = None
    pairs = np.empty((0, 2), np.intp)
    width = 1
    sees_arm = False
    _measured = "d"
    _others = ("pairs",)

    def __post_init__(self) -> None:
        d = numbers(self.d, "d")
        square = d.ndim == 2 and d.shape[0] == d.shape[1]
        if not square or len(d) < 2:
            raise ShapeError(
                f"d: expected a table (k, k) of distances between points, got shape {d.shape}"
            )
        if not isinstance(self.points, str):
            raise InputError(f"points: expected the name of points, got {safe_repr(self.points)}")
        same = np.isclose(d, d.T, rtol=0.0, atol=_EVEN, equal_nan=True)
        for i, j in np.argwhere(~same).tolist():
            raise InputError(f"d[{i}, {j}] is {d[i, j]:g} and d[{j}, {i}] {d[j, i]:g}")
        is_known = ~np.isnan(d)
        pairs = np.argwhere(np.triu(is_known, 1))
        first, second = pairs.T
        known = d[first, second]
        for i, j in pairs[~((known > 0) & (known < np.inf))].tolist():
            raise InputError(f"d[{i}, {j}]: expected a distance above 0, got {d[i, j]:g}")
        if not len(pairs):
            raise InputError("d: expected a distance that is known, got none")
        if self.covariance is None:
            raise InputError("covariance: expected the variance of d, m², got None")
        unknown = tuple(unknown_points(len(d), self.points))
        # they belong to no reading: each counts as measured with the first
        self._set_fields(rows=np.zeros(len(pairs), np.intp))
        self._keep(d=known, pairs=pairs, unknown_frames=unknown)

    def _apart(self, frame_values: Frames) -> Array:
        """Vectors (K, 3) from the second to the first point of each pair."""
        y = np.array(frame_values)
        first, second = self.pairs.T
        return y[first] - y[second]

    def errors(self, T: Array, frame_values: Frames) -> Array:
        """Errors d_model − d_measured (K, 1), of no pose."""
        errors = norms(self._apart(frame_values)) - self.d
        return errors[:, None]

    def jacobian(
        self,
        T: Array,
        frame_values: Frames,
        errors: Array,
        D: Array,
    ) -> Derivatives:
        """Derivatives u and −u for the two points, u the unit vector between them; none for the arm."""
        u = normalised_or_zero(self._apart(frame_values))
        numbered = np.arange(len(frame_values))
        firsts = self.pairs[:, :1] == numbered
        seconds = self.pairs[:, 1:] == numbered
        signs = firsts.astype(float) - seconds
        of_points = signs[:, :, None] * u[:, None]
        nothing = np.zeros((len(u), 1, D.shape[2]))
        return nothing, np.split(of_points, len(frame_values), axis=1)

    def guesses(self, T: Array) -> list[Array]:
        """The points as another set shows them. Raises: InputError where none does."""
        found = []
        for frame in self.unknown_frames:
            if frame.guess is None:
                raise InputError(
                    f"Separations: no Points with points={self.points!r} measure {frame.name}"
                )
            found.append(frame.guess)
        return found
