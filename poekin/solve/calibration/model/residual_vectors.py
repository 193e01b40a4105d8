"""Residuals as vectors, in axes of the base, of the tool, or of the path."""

from __future__ import annotations

from typing import Literal, NamedTuple, get_args

import numpy as np

from ....checks import choice
from ....groups.arrays import Array
from ....groups.vectors import applied, normalised_or_zero, norms, rotation_part
from ....results import brief
from ..measurements.measurement import Frames, Measurement, Rows
from ..measurements.points import Distances, Points, point_at, points_at, points_of
from .residuals import rms

Axes = Literal["base", "tool", "path"]
_STILL = 1e-9  # m: a point that moved by less has no path
_STEEP = 1e-6  # sine of the angle to the vertical: a path that is nearer to it has no level


class ResidualVectors(NamedTuple):
    """Differences model − measured of all measured points, in the base frame.

    Parameters
    ----------
    q : (N, m) ndarray
        Readings, rad or m.
    rows : (K,) ndarray of int
        Row of q of each point.
    places : (K, 3) ndarray
        Where the calibrated arm has the point, m.
    before, after : (K, 3) ndarray
        Differences of the nominal and of the calibrated arm, m; of a measured distance along the
        line to its centre.
    R : (K, 3, 3) ndarray
        Rotations R_base_tip of the calibrated arm.
    moves : (K, 3) ndarray
        Ways of the points from the readings before, m.
    """

    q: Array
    rows: Rows
    places: Array
    before: Array
    after: Array
    R: Array
    moves: Array

    def summary(self) -> str:
        """Number of the points, and root mean squares before and after, in words.

        Returns
        -------
        text : str
            One sentence.
        """
        before, after = (1e3 * rms(norms(errors)) for errors in (self.before, self.after))
        return f"{len(self.rows)} points, {before:.3g} mm rms before, {after:.3g} mm after"

    def __repr__(self) -> str:
        return brief(self, self.summary())

    def in_axes(self, axes: Axes) -> ResidualVectors:
        """The differences in other axes; all else stays in the base frame.

        Parameters
        ----------
        axes : {"base", "tool", "path"}
            Of the base; of the tool; or along the last move of the point, across it on the level, and
            across both.

        Returns
        -------
        residuals : ResidualVectors
            With `before` and `after` in these axes; NaN along the path of a point that did not move.

        Raises
        ------
        InputError
            If axes is none of these.

        Examples
        --------
        >>> import poekin as pk
        >>> arm = pk.load("ur5").chain()
        >>> made = pk.calibration.simulated(arm, 30, kind="points", seed=2)
        >>> found = pk.calibrate(arm, made.q, made.measurements, folds=0)
        >>> found.residuals.in_axes("path").after.shape
        (30, 3)
        """
        choice(axes, get_args(Axes), "axes")
        if axes == "base":
            return self
        R = self.R if axes == "tool" else self._path()
        back = np.swapaxes(R, 1, 2)
        return self._replace(before=applied(back, self.before), after=applied(back, self.after))

    def _path(self) -> Array:
        """Axes (K, 3, 3) of the path as columns; of a move straight up the second is across x."""
        lengths = np.linalg.norm(self.moves, axis=1, keepdims=True)
        along = np.where(lengths > _STILL, self.moves, np.nan) / np.maximum(lengths, _STILL)
        level = np.cross([0.0, 0.0, 1.0], along)
        steep = np.linalg.norm(level, axis=1, keepdims=True) < _STEEP
        across = np.where(steep, np.cross([1.0, 0.0, 0.0], along), level)
        across = across / np.linalg.norm(across, axis=1, keepdims=True)
        return np.stack([along, across, np.cross(along, across)], axis=2)


def places_and_errors(s: Measurement, T: Array, frame_values: Frames) -> tuple[Array, Array]:
    """Points (N, k, 3) of the arm at poses T (N, 4, 4), and their errors, both in base axes."""
    if not s.sees_arm:
        nothing = np.empty((len(T), 0, 3))
        return nothing, nothing
    errors = s.errors(T, frame_values)[:, s.angular :]
    if isinstance(s, Distances):
        places = point_at(T, s.point)
        away = places - next(iter(frame_values), s.centre)
        along = errors * normalised_or_zero(away)
        return places[:, None], along[:, None]
    vectors = errors.reshape(len(T), -1, 3)
    if s.frame == "unknown":  # the errors stand in it, too
        vectors = vectors @ rotation_part(frame_values[0]).T
    if isinstance(s, Points):
        return points_at(T, points_of(s, frame_values)), vectors
    return T[:, None, :3, 3], vectors
