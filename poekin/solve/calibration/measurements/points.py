"""Measured points on the tool: where they are, or how far from a fixed point."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ....errors import InputError, ShapeError, safe_repr
from ....groups import se3, so3
from ....groups.arrays import Array, numbers
from ..fit import initial_guess
from .measurement import Measurement, Unknown, carried, covariances, finite_rows, rows_of


def _moved(D: Array, y: Array) -> Array:
    """Velocities (..., 3, P) of the points y (..., 3) under the space twists D (..., 6, P): v +
    omega x y.
    """
    return D[..., 3:, :] - so3.hat(y) @ D[..., :3, :]


@dataclass(frozen=True, eq=False)
class Points(Measurement):
    """Positions of one or several points of the tool.

    p (N, 3), or (N, k, 3) for k points, m; points (3,) or (k, 3): where they are in the tip frame,
    m; covariance
    (3k, 3k) or (N, 3k, 3k) of p_model - p_measured, m^2 (None: one spread is estimated from the
    residuals); rows (N,) as `Poses`; frame: "base" if p stands in the base frame, "unknown" if in
    the frame of a device whose pose T_base_device is solved along. Raises: ShapeError, InputError.
    """

    p: Any
    points: Any = (0.0, 0.0, 0.0)
    covariance: Any = None
    rows: Any = None
    frame: str = "base"

    what = "Points"
    _along = ("p", "rows")

    def __post_init__(self):
        p, points = (
            finite_rows(numbers(self.p, "p"), "p"),
            np.atleast_2d(numbers(self.points, "points")),
        )
        if p.ndim == 2:
            p = p[:, None]
        if (
            points.ndim != 2
            or points.shape[1] != 3
            or not len(points)
            or not np.isfinite(points).all()
        ):
            raise ShapeError(
                f"points: expected finite (3,) or (k, 3) in the tip frame, got shape {points.shape}"
            )
        if p.ndim != 3 or p.shape[1:] != points.shape:
            k = len(points)
            raise ShapeError(
                f"p: expected positions (N, {k}, 3), of {k} points, got shape {np.shape(self.p)}"
            )
        if self.frame not in ("base", "unknown"):
            raise InputError(f"frame: expected 'base' or 'unknown', got {safe_repr(self.frame)}")
        width = 3 * len(points)
        C = covariances(self.covariance, len(p), width, self.what)
        unknowns = (Unknown("T_base_device", 6, None),) if self.frame == "unknown" else ()
        settled = {
            "p": p.copy(),
            "points": points.copy(),
            "covariance": C,
            "rows": rows_of(self.rows, len(p)),
        }
        self._settle(**settled, width=width, unknowns=unknowns)

    def __len__(self) -> int:
        return len(self.p)

    def _at(self, T: Array) -> Array:
        """The points (N, k, 3) in the base frame."""
        return self.points @ np.swapaxes(T[:, :3, :3], 1, 2) + T[:, None, :3, 3]

    def errors(self, T: Array, places: Sequence[Array]) -> Array:
        """p_model - p_measured (N, 3k), in the frame in which p stands."""
        T = se3.inverse(places[0]) @ T if places else T
        return (self._at(T) - self.p).reshape(len(T), self.width)

    def slopes(
        self, T: Array, places: Sequence[Array], errors: Array, D: Array
    ) -> tuple[Array, list[Array]]:
        """Points move by v + omega x p; T_base_device <- T_base_device e^xi by -xi, seen from the
        device.
        """
        if places:
            back = se3.inverse(places[0])
            T = back @ T
            D = np.concatenate(
                [carried(back, D), np.broadcast_to(-np.eye(6), (len(T), 6, 6))], axis=2
            )
        slopes = _moved(D[:, None], self._at(T)).reshape(len(T), self.width, D.shape[2])
        return (slopes[..., :-6], [slopes[..., -6:]]) if places else (slopes, [])

    def guesses(self, T: Array) -> list[Array]:
        """The rigid motion that brings the measured points nearest to the nominal ones."""
        if not self.unknowns:
            return []
        return [initial_guess.registration(self._at(T).reshape(-1, 3), self.p.reshape(-1, 3))]


@dataclass(frozen=True, eq=False)
class Distances(Measurement):
    """Distances d = |p(q) - c| of a point of the tool from a point that stands still: a wire
    sensor, a ball bar.

    d (N,), m; centre c (3,) in the base frame, m (None: solved along); point (3,) in the tip frame,
    m; covariance:
    the variance of d, a number or (N,), m^2 (None: estimated from the residuals); rows (N,) as
    `Poses`; guess (3,): a rough centre where it is solved along, for points in one plane, on both
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
    _along = ("d", "rows")

    def __post_init__(self):
        d, point = finite_rows(numbers(self.d, "d"), "d"), numbers(self.point, "point")
        if d.ndim != 1:
            raise ShapeError(f"d: expected distances (N,), got shape {d.shape}")
        if (d <= 0).any():
            raise InputError(
                f"d[{int(np.argmax(d <= 0))}]: expected a distance above 0, got {d[d <= 0][0]:g}"
            )
        for value, name in ((point, "point"), (self.centre, "centre"), (self.guess, "guess")):
            if value is not None and (
                np.shape(value) != (3,) or not np.isfinite(numbers(value, name)).all()
            ):
                raise ShapeError(f"{name}: expected three finite numbers, got {safe_repr(value)}")
        centre, guess = (
            None if c is None else numbers(c, "centre").copy() for c in (self.centre, self.guess)
        )
        C = covariances(self.covariance, len(d), 1, self.what)
        unknowns = () if centre is not None else (Unknown("centre", 3, guess),)
        settled = {"d": d.copy(), "centre": centre, "point": point.copy(), "covariance": C}
        self._settle(**settled, rows=rows_of(self.rows, len(d)), unknowns=unknowns)

    def __len__(self) -> int:
        return len(self.d)

    def _from(self, T: Array, places: Sequence[Array]) -> tuple[Array, Array]:
        """The point y (N, 3) in the base frame, and y - c."""
        y = T[:, :3, :3] @ self.point + T[:, :3, 3]
        return y, y - (places[0] if places else self.centre)

    def errors(self, T: Array, places: Sequence[Array]) -> Array:
        """d_model - d_measured (N, 1)."""
        return (np.linalg.norm(self._from(T, places)[1], axis=1) - self.d)[:, None]

    def slopes(
        self, T: Array, places: Sequence[Array], errors: Array, D: Array
    ) -> tuple[Array, list[Array]]:
        """With u the unit vector from c to y: u . (v + omega x y), and -u for c. At y = c there is
        no u: zero.
        """
        y, away = self._from(T, places)
        size = np.linalg.norm(away, axis=1, keepdims=True)
        u = np.divide(away, size, out=np.zeros_like(away), where=size > 0)[:, None]
        return u @ _moved(D, y), [-u] if places else []

    def guesses(self, T: Array) -> list[Array]:
        """The point as given, or that whose distances to the nominal positions are nearest to the
        measured ones.
        """
        if not self.unknowns:
            return []
        if self.unknowns[0].guess is not None:
            return [self.unknowns[0].guess]
        return [initial_guess.centre(T[:, :3, :3] @ self.point + T[:, :3, 3], self.d)]
