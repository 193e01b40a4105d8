"""Residuals as vectors in the base frame: what a picture of a calibration shows."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ....groups.arrays import Array
from ....groups.vectors import rotation_part
from ..measurements.measurement import Frames, Measurement, Rows
from ..measurements.points import Distances, Points, point_at, points_at


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
    """

    q: Array
    rows: Rows
    places: Array
    before: Array
    after: Array


def places_and_errors(s: Measurement, T: Array, frame_values: Frames) -> tuple[Array, Array]:
    """Points (N, k, 3) of the arm at poses T (N, 4, 4), and their errors, both in base axes."""
    if not s.sees_arm:
        nothing = np.empty((len(T), 0, 3))
        return nothing, nothing
    errors = s.errors(T, frame_values)[:, s.angular :]
    if isinstance(s, Distances):
        places = point_at(T, s.point)
        away = places - next(iter(frame_values), s.centre)
        size = np.linalg.norm(away, axis=1, keepdims=True)
        along = errors * away / np.maximum(size, np.finfo(float).tiny)
        return places[:, None], along[:, None]
    vectors = errors.reshape(len(T), -1, 3)
    if len(frame_values) and frame_values[0].ndim == 2:  # the frame in which the errors stand
        vectors = vectors @ rotation_part(frame_values[0]).T
    if isinstance(s, Points):
        unknown = [y for y in frame_values if y.ndim == 1]
        return points_at(T, np.array(unknown) if unknown else s.points), vectors
    return T[:, None, :3, 3], vectors
