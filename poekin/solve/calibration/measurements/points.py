"""Measured points on the tool: where they are, or how far from a fixed point."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ....errors import InputError, ShapeError, safe_repr
from ....groups import se3, so3
from ....groups.arrays import Array, numbers
from ..fit import initial_guess
from .measurement import (
    Measurement,
    UnknownFrame,
    covariances,
    finite_rows,
    parse_rows,
    transform_twists,
)


def _velocities(D: Array, y: Array) -> Array:
    """Velocities (..., 3, P) of the points y (..., 3) under the space twists D (..., 6, P): v +
    omega x y.
    """
    return D[..., 3:, :] - so3.hat(y) @ D[..., :3, :]


def parse_points(points: ArrayLike) -> Array:
    """Points of the tool (k, 3) in the tip frame, of one (3,) or several. Raises: ShapeError."""
    body = np.atleast_2d(numbers(points, "points"))
    if body.ndim != 2 or body.shape[1] != 3 or not len(body) or not np.isfinite(body).all():
        raise ShapeError(
            f"points: expected finite (3,) or (k, 3) in the tip frame, got shape {body.shape}"
        )
    return body.copy()


def _position(value: ArrayLike | None, name: str) -> Array | None:
    """Three finite numbers, or None. Raises: ShapeError."""
    if value is None:
        return None
    if np.shape(value) != (3,) or not np.isfinite(numbers(value, name)).all():
        raise ShapeError(f"{name}: expected three finite numbers, got {safe_repr(value)}")
    return numbers(value, name).copy()


@dataclass(frozen=True, eq=False)
class Points(Measurement):
    """Positions of one or several points of the tool.

    p (N, 3), or (N, k, 3) for k points, m; points (3,) or (k, 3): where they are in the tip frame,
    m; covariance (3k, 3k) or (N, 3k, 3k) of p_model - p_measured, m^2 (None: one standard deviation is
    estimated from the residuals); rows (N,) as `Poses`; frame: "base" if p stands in the base frame, "unknown" if in
    the frame of a device whose pose T_base_device is estimated jointly. Raises: ShapeError, InputError.
    """

    p: Any
    points: Any = (0.0, 0.0, 0.0)
    covariance: Any = None
    rows: Any = None
    frame: str = "base"

    what = "Points"
    _per_measurement = ("p", "rows")

    def __post_init__(self):
        p = finite_rows(numbers(self.p, "p"), "p")
        points = parse_points(self.points)
        k = len(points)
        if p.ndim == 2:
            p = p[:, None]
        if p.ndim != 3 or p.shape[1:] != points.shape:
            raise ShapeError(
                f"p: expected positions (N, {k}, 3), of {k} points, got shape {np.shape(self.p)}"
            )
        if self.frame not in ("base", "unknown"):
            raise InputError(f"frame: expected 'base' or 'unknown', got {safe_repr(self.frame)}")
        device = (UnknownFrame("T_base_device", 6, None),)
        self._set_fields(
            p=p.copy(),
            points=points,
            covariance=covariances(self.covariance, len(p), 3 * k, self.what),
            rows=parse_rows(self.rows, len(p)),
            width=3 * k,
            unknown_frames=device if self.frame == "unknown" else (),
        )

    def __len__(self) -> int:
        return len(self.p)

    def _at(self, T: Array) -> Array:
        """The points (N, k, 3) in the base frame."""
        return self.points @ np.swapaxes(T[:, :3, :3], 1, 2) + T[:, None, :3, 3]

    def errors(self, T: Array, frame_values: Sequence[Array]) -> Array:
        """p_model - p_measured (N, 3k), in the frame in which p stands."""
        for T_base_device in frame_values:
            T = se3.inverse(T_base_device) @ T
        return (self._at(T) - self.p).reshape(len(T), self.width)

    def jacobian(
        self, T: Array, frame_values: Sequence[Array], errors: Array, D: Array
    ) -> tuple[Array, list[Array]]:
        """Points move by v + omega x p; T_base_device <- T_base_device e^xi by -xi, seen from the
        device.
        """
        if not frame_values:
            return self._moved(T, D), []
        back = se3.inverse(frame_values[0])
        device = np.broadcast_to(-np.eye(6), (len(T), 6, 6))
        twists = np.concatenate([transform_twists(back, D), device], axis=2)
        both = self._moved(back @ T, twists)
        return both[..., :-6], [both[..., -6:]]

    def _moved(self, T: Array, D: Array) -> Array:
        """Velocities (N, 3k, P) of the points under the space twists D (N, 6, P)."""
        return _velocities(D[:, None], self._at(T)).reshape(len(T), self.width, D.shape[2])

    def guesses(self, T: Array) -> list[Array]:
        """The rigid motion that brings the measured points nearest to the nominal ones."""
        if not self.unknown_frames:
            return []
        return [initial_guess.registration(self._at(T).reshape(-1, 3), self.p.reshape(-1, 3))]


@dataclass(frozen=True, eq=False)
class Distances(Measurement):
    """Distances d = |p(q) - c| of a point of the tool from a point that stands still: a wire
    sensor, a ball bar.

    d (N,), m; centre c (3,) in the base frame, m (None: estimated jointly); point (3,) in the tip
    frame, m; covariance: the variance of d, a number or (N,), m^2 (None: estimated from the residuals); rows (N,) as
    `Poses`; guess (3,): a rough centre where it is estimated, for points in one plane, on both
    sides of which one would fit alike.
    Raises: ShapeError, InputError.
    """

    d: Any
    centre: Any = None
    point: Any = (0.0, 0.0, 0.0)
    covariance: Any = None
    rows: Any = None
    guess: Any = None

    what = "Distances"
    width = 1
    _per_measurement = ("d", "rows")

    def __post_init__(self):
        d = finite_rows(numbers(self.d, "d"), "d")
        if d.ndim != 1:
            raise ShapeError(f"d: expected distances (N,), got shape {d.shape}")
        if (d <= 0).any():
            row = int(np.argmax(d <= 0))
            raise InputError(f"d[{row}]: expected a distance above 0, got {d[row]:g}")
        point = _position(numbers(self.point, "point"), "point")
        centre = _position(self.centre, "centre")
        guess = _position(self.guess, "guess")
        self._set_fields(
            d=d.copy(),
            centre=centre,
            point=point,
            covariance=covariances(self.covariance, len(d), 1, self.what),
            rows=parse_rows(self.rows, len(d)),
            unknown_frames=(UnknownFrame("centre", 3, guess),) if centre is None else (),
        )

    def __len__(self) -> int:
        return len(self.d)

    def _point(self, T: Array) -> Array:
        """The point y (N, 3) in the base frame."""
        return T[:, :3, :3] @ self.point + T[:, :3, 3]

    def _centre(self, frame_values: Sequence[Array]) -> Array:
        return frame_values[0] if frame_values else self.centre

    def errors(self, T: Array, frame_values: Sequence[Array]) -> Array:
        """d_model - d_measured (N, 1)."""
        away = self._point(T) - self._centre(frame_values)
        return (np.linalg.norm(away, axis=1) - self.d)[:, None]

    def jacobian(
        self, T: Array, frame_values: Sequence[Array], errors: Array, D: Array
    ) -> tuple[Array, list[Array]]:
        """With u the unit vector from c to y: u . (v + omega x y), and -u for c. At y = c there is
        no u: zero.
        """
        y = self._point(T)
        away = y - self._centre(frame_values)
        size = np.linalg.norm(away, axis=1, keepdims=True)
        u = np.divide(away, size, out=np.zeros_like(away), where=size > 0)[:, None]
        return u @ _velocities(D, y), [-u for _ in frame_values]

    def guesses(self, T: Array) -> list[Array]:
        """The point as given, or that whose distances to the nominal positions are nearest to the
        measured ones.
        """
        if not self.unknown_frames:
            return []
        if self.unknown_frames[0].guess is not None:
            return [self.unknown_frames[0].guess]
        return [initial_guess.centre(self._point(T), self.d)]
