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
from ....groups.vectors import normalised_or_zero, norms, rotation_part, translation_part
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
    points : (3,) or (k, 3) array_like, str or None, default (0, 0, 0)
        The points in the tip frame, m; None where they are not known and estimated jointly; or a
        name, such as "plate": sets in which it is the same have these points in common.
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
        if p.ndim == 2:
            p = p[:, None]
        points = self.points
        unknown: list[UnknownFrame] = []
        count = p.shape[1] if p.ndim == 3 else 1
        if points is None or isinstance(points, str):
            unknown = unknown_points(count, points)
        else:
            points = parse_points(points)
            count = len(points)
        if p.shape[1:] != (count, 3):
            raise ShapeError(
                f"p: expected positions (N, {count}, 3), of {count} points, got shape "
                f"{np.shape(self.p)}"
            )
        choice(self.frame, get_args(PointFrame), "frame")
        if self.frame == "unknown":
            unknown.insert(0, UnknownFrame("T_base_device", 6))
        self._keep(p=p, points=points, width=3 * count, unknown_frames=tuple(unknown))

    def errors(self, T: Array, frame_values: Frames) -> Array:
        """Errors p_model − p_measured (N, 3k), in the frame in which p stands."""
        if self.frame == "unknown":
            T = se3.inverse(frame_values[0]) @ T
        errors = points_at(T, points_of(self, frame_values)) - self.p
        return errors.reshape(len(T), self.width)

    def jacobian(
        self,
        T: Array,
        frame_values: Frames,
        errors: Array,
        D: Array,
    ) -> Derivatives:
        """Points move by v + ω × p, by −ξ of T_base_device <- T_base_device e^[ξ], and by R dy.

        The second is seen from the device, the third of a point y of the tool.
        """
        of_device = frame_values[: self.frame == "unknown"]
        points = points_of(self, frame_values)
        P = D.shape[2]
        for T_base_device in of_device:
            T, D = seen_from(T_base_device, T, D)
        moved = velocities(D[:, None], points_at(T, points))
        jacobian = moved.reshape(len(T), self.width, -1)
        of_frames = [jacobian[..., P:]] * len(of_device)
        own = np.eye(len(points))
        for k in range(len(frame_values) - len(of_device)):
            of_point = np.kron(own[:, [k]], rotation_part(T))
            of_frames.append(np.asarray(of_point, float))
        return jacobian[..., :P], of_frames

    def guesses(self, T: Array) -> list[Array]:
        """Unknown points from where the nominal arm is, and the rigid motion to the measured ones."""
        has_device = self.frame == "unknown"
        points = self.points
        n_unknown = len(self.unknown_frames) - has_device
        if n_unknown:
            points = self._guessed_points(T)
        if points is None:
            X, points = initial_guess.device_and_points(T, self.p)
            return [X, *points]
        of_points = list(points[:n_unknown])
        if not has_device:
            return of_points
        nominal = points_at(T, points).reshape(-1, 3)
        measured = self.p.reshape(-1, 3)
        X = initial_guess.registration(nominal, measured)
        return [X, *of_points]

    def _guessed_points(self, T: Array) -> Array | None:
        """Points (k, 3) as another set shows them, or as seen from the nominal arm; None without
        either.
        """
        given = [frame.guess for frame in self.unknown_frames if frame.size == 3]
        if all(y is not None for y in given):
            return np.array(given)
        if self.frame == "unknown":
            return None
        from_tip = self.p - translation_part(T)[:, None]
        back = from_tip @ rotation_part(T)
        found = map(initial_guess.mean_position, np.swapaxes(back, 0, 1))
        return np.array(list(found))


def points_of(s: Points, frame_values: Frames) -> Array:
    """Points (k, 3) of the tool in the tip frame, as given or as estimated."""
    estimated = frame_values[s.frame == "unknown" :]
    return np.array(estimated) if len(estimated) else s.points


def unknown_points(count: int, shared: str | None) -> list[UnknownFrame]:
    """Points of the tool that are estimated jointly, `shared` by the sets that call them so.

    Raises: InputError.
    """
    if shared == "":
        raise InputError("points: expected positions, a name or None, got ''")
    names = [f"point {k + 1}" for k in range(count)]
    return [UnknownFrame(name, 3, shared=shared) for name in names]


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
            self._set_fields(frame="unknown")
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
        u = normalised_or_zero(away)[:, None]
        return u @ velocities(D, y), [-u for _ in frame_values]

    def guesses(self, T: Array) -> list[Array]:
        """The centre as given, or the one nearest to the measured distances."""
        if not self.unknown_frames:
            return []
        guess = self.unknown_frames[0].guess
        if guess is None:
            guess = initial_guess.centre(point_at(T, self.point), self.d)
        return [guess]
