"""Measured points on the tool: where they are, or how far from a fixed point."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from ....checks import choice
from ....errors import InputError, ShapeError, safe_repr
from ....groups import se3, so3
from ....groups.arrays import Array, numbers
from ....groups.vectors import norms, rotation_part, translation_part
from ....model.checks import finite
from ..fit import initial_guess
from .measurement import Derivatives, Frames, Measurement, UnknownFrame, seen_from

PointFrame = Literal["base", "unknown"]


def velocities(D: Array, y: Array) -> Array:
    """Velocities (..., 3, P) of the points y (..., 3) under the space twists D (..., 6, P): v +
    omega x y.
    """
    omega, v = np.split(D, 2, axis=-2)
    return v - so3.hat(y) @ omega


def points_at(T: Array, points: Array) -> Array:
    """Points (N, k, 3) in the base frame, of points (k, 3) in the tip frame."""
    R = rotation_part(T)
    back = np.swapaxes(R, 1, 2)
    return points @ back + T[:, None, :3, 3]


def point_at(T: Array, point: Array) -> Array:
    """Point (N, 3) in the base frame, of a point (3,) in the tip frame."""
    R = rotation_part(T)
    t = translation_part(T)
    return R @ point + t


def parse_points(points: ArrayLike) -> Array:
    """Points of the tool (k, 3) in the tip frame, of one (3,) or several. Raises: InputError,
    ShapeError.
    """
    body = np.atleast_2d(finite(points, "points"))
    if body.ndim != 2 or body.shape[1] != 3 or not len(body):
        raise ShapeError(
            f"points: expected (3,) or (k, 3) in the tip frame, got {safe_repr(points)}"
        )
    return body


def position(value: ArrayLike | None, name: str) -> Array | None:
    """Three finite numbers, or None. Raises: InputError, ShapeError."""
    if value is None:
        return None
    position = finite(value, name)
    if position.shape != (3,):
        raise ShapeError(f"{name}: expected three numbers, got {safe_repr(value)}")
    return position


@dataclass(frozen=True, eq=False, repr=False)
class Points(Measurement):
    """Measured positions of one or several points of the tool.

    Parameters
    ----------
    p : (N, 3) or (N, k, 3) array_like
        Measured positions of k points, m.
    points : (3,) or (k, 3) array_like, default (0, 0, 0)
        The points in the tip frame, m.
    covariance : (3k, 3k) or (N, 3k, 3k) array_like, optional
        Covariance of p_model − p_measured, m²; by default one standard deviation is estimated from
        the residuals.
    rows : (N,) array_like of int, optional
        Row of q of each measurement; all in order by default.
    frame : {"base", "unknown"}, default "base"
        Frame in which p stands: the base frame, or that of a device whose pose T_base_device is
        estimated jointly.

    Raises
    ------
    ShapeError
        If an array has another shape.
    InputError
        If a number is not finite, a covariance is not symmetric and positive definite, or frame is
        another word.

    Examples
    --------
    A laser tracker that sees a reflector at the tip, in a frame of its own:

    >>> import poekin as pk
    >>> arm = pk.load("ur5").chain()
    >>> made = pk.calibration.simulated(arm, 30, kind="points", unknown=True)
    >>> points = pk.calibration.Points(made.measurements.p, frame="unknown")
    >>> found = pk.calibrate(arm, made.q, points, folds=0)
    >>> found.frames["T_base_device"].shape
    (4, 4)
    """

    p: Any
    points: Any = (0.0, 0.0, 0.0)
    covariance: Any = None
    rows: Any = None
    frame: PointFrame = "base"

    _measured = "p"

    def __post_init__(self) -> None:
        p = finite(self.p, "p")
        points = parse_points(self.points)
        k = len(points)
        if p.ndim == 2:
            p = p[:, None]
        if p.ndim != 3 or p.shape[1:] != points.shape:
            raise ShapeError(
                f"p: expected positions (N, {k}, 3), of {k} points, got shape {np.shape(self.p)}"
            )
        choice(self.frame, get_args(PointFrame), "frame")
        unknown: tuple[UnknownFrame, ...] = ()
        if self.frame == "unknown":
            unknown = (UnknownFrame("T_base_device", 6),)
        self._keep(p=p, points=points, width=3 * k, unknown_frames=unknown)

    def errors(self, T: Array, frame_values: Frames) -> Array:
        """Errors p_model − p_measured (N, 3k), in the frame in which p stands."""
        for T_base_device in frame_values:
            T = se3.inverse(T_base_device) @ T
        errors = points_at(T, self.points) - self.p
        return errors.reshape(len(T), self.width)

    def jacobian(
        self,
        T: Array,
        frame_values: Frames,
        errors: Array,
        D: Array,
    ) -> Derivatives:
        """Points move by v + ω × p; T_base_device <- T_base_device e^[ξ] by −ξ, seen from the device."""
        if not frame_values:
            return self._moved(T, D), []
        seen, twists = seen_from(frame_values[0], T, D)
        jacobian = self._moved(seen, twists)
        return jacobian[..., :-6], [jacobian[..., -6:]]

    def _moved(self, T: Array, D: Array) -> Array:
        """Velocities (N, 3k, P) of the points under the space twists D (N, 6, P)."""
        y = points_at(T, self.points)
        moved = velocities(D[:, None], y)
        return moved.reshape(len(T), self.width, D.shape[2])

    def guesses(self, T: Array) -> list[Array]:
        """The rigid motion that brings the measured points nearest to the nominal ones."""
        if not self.unknown_frames:
            return []
        nominal = points_at(T, self.points).reshape(-1, 3)
        measured = self.p.reshape(-1, 3)
        return [initial_guess.registration(nominal, measured)]


@dataclass(frozen=True, eq=False, repr=False)
class Distances(Measurement):
    """Measured distances d = |p(q) − c| of a point of the tool from a point that stands still.

    A wire sensor or a ball bar measures them.

    Parameters
    ----------
    d : (N,) array_like
        Measured distances, m, above 0.
    centre : (3,) array_like, optional
        The point c in the base frame, m; by default it is estimated jointly.
    point : (3,) array_like, default (0, 0, 0)
        The point of the tool in the tip frame, m.
    covariance : float or (N,) array_like, optional
        Variance of d, m²; by default it is estimated from the residuals.
    rows : (N,) array_like of int, optional
        Row of q of each measurement; all in order by default.
    guess : (3,) array_like, optional
        Rough centre, m, where it is estimated: for points in one plane, on both sides of which a
        centre would fit alike.

    Raises
    ------
    ShapeError
        If an array has another shape.
    InputError
        If a number is not finite, a distance is not above 0, or a variance is not positive.

    Examples
    --------
    >>> import poekin as pk
    >>> pk.calibration.Distances([0.8, 0.9, 1.1], centre=[1.0, 0.0, 0.5]).width
    1
    """

    d: Any
    centre: Any = None
    point: Any = (0.0, 0.0, 0.0)
    covariance: Any = None
    rows: Any = None
    guess: Any = None

    width = 1
    _measured = "d"

    def __post_init__(self) -> None:
        d = finite(self.d, "d")
        if d.ndim != 1:
            raise ShapeError(f"d: expected distances (N,), got shape {d.shape}")
        for row in np.flatnonzero(d <= 0):
            raise InputError(f"d[{row}]: expected a distance above 0, got {d[row]:g}")
        point = position(numbers(self.point, "point"), "point")
        centre = position(self.centre, "centre")
        guess = position(self.guess, "guess")
        unknown: tuple[UnknownFrame, ...] = ()
        if centre is None:
            unknown = (UnknownFrame("centre", 3, guess),)
        self._keep(d=d, centre=centre, point=point, unknown_frames=unknown)

    def _away(self, y: Array, frame_values: Frames) -> Array:
        """Vectors (N, 3) from the centre to y."""
        return y - next(iter(frame_values), self.centre)

    def errors(self, T: Array, frame_values: Frames) -> Array:
        """Errors d_model − d_measured (N, 1)."""
        y = point_at(T, self.point)
        away = self._away(y, frame_values)
        errors = norms(away) - self.d
        return errors[:, None]

    def jacobian(
        self,
        T: Array,
        frame_values: Frames,
        errors: Array,
        D: Array,
    ) -> Derivatives:
        """Derivatives u · (v + ω × y), and −u for c, u the unit vector from c to y; 0 at y = c."""
        y = point_at(T, self.point)
        away = self._away(y, frame_values)
        size = np.linalg.norm(away, axis=1, keepdims=True)
        divisor = np.maximum(size, np.finfo(float).tiny)
        u = (away / divisor)[:, None]
        return u @ velocities(D, y), [-u for _ in frame_values]

    def guesses(self, T: Array) -> list[Array]:
        """The centre as given, or the one nearest to the measured distances."""
        if not self.unknown_frames:
            return []
        guess = self.unknown_frames[0].guess
        if guess is None:
            guess = initial_guess.centre(point_at(T, self.point), self.d)
        return [guess]
