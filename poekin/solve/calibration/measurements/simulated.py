"""Simulated measurements of an arm that is not quite as it is described, with the truth."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ....checks import choice, whole
from ....errors import InputError, ShapeError, safe_repr
from ....groups import se3, so3
from ....groups.arrays import Array, numbers
from ....groups.vectors import normalised, norms, rotation_part
from ....model.chain import Chain
from ....model.checks import finite, read_only
from ....model.coordinates import coordinates
from ....results import Result
from ..model.error_model import ErrorModel
from .data import KINDS
from .measurement import Measurement, MeasurementKind
from .points import Distances, PointFrame, Points, parse_points, point_at, points_at
from .poses import EyeInHand, EyeToHand, Poses

GROSS_TURN = (0.1, 1.0)
"""Bounds of the angle in rad by which a gross outlier is off."""
GROSS_SHIFT = (0.05, 0.5)
"""Bounds of the distance in reaches of the arm by which a gross outlier is off."""


@dataclass(frozen=True, eq=False, repr=False)
class Simulated(Result):
    """Simulated measurements and the truth behind them.

    Attributes
    ----------
    truth : Chain
        The arm that was measured.
    parameters : (P,) ndarray
        Its errors, "screws" and "home" in the order of `calibrate`, rad and m.
    q : (n, m) ndarray
        Joint readings, rad or m.
    measurements : Measurement
        One set, with its covariance where there is noise.
    frames : dict of str to ndarray
        True value of each frame (4, 4) or point (3,), m, that the set does not know, by name
        (T_base_board, T_tip_camera, ..., centre).
    points : (k, 3) ndarray or None
        Points of the tool in the tip frame, m; None where poses are measured.
    outliers : (n,) ndarray of bool
        True for the rows that are grossly wrong.
    """

    left_out: ClassVar = ("truth", "measurements")

    truth: Chain
    parameters: Array
    q: Array
    measurements: Measurement
    frames: dict[str, Array]
    points: Array | None
    outliers: np.ndarray

    @property
    def X(self) -> Array | None:
        """Pose T_base_fixed (4, 4) of the board, camera or device that stands still, or None."""
        return self._frame("T_base")

    @property
    def Z(self) -> Array | None:
        """Pose T_tip_moving (4, 4) of the camera or board on the tip, or None."""
        return self._frame("T_tip")

    def _frame(self, beginning: str) -> Array | None:
        named = (T for name, T in self.frames.items() if name.startswith(beginning))
        return next(named, None)

    def summary(self) -> str:
        """Number and kind of the measurements, and number of gross outliers, as text."""
        kind = self.measurements.what
        return f"{len(self.q)} simulated {kind}, {self.outliers.sum()} of them gross outliers"


def simulated(  # noqa: PLR0913 - options by keyword
    chain: Chain,
    n: int,
    *,
    kind: MeasurementKind = "poses",
    tilt: float = 2e-3,
    shift: float = 1e-3,
    noise: tuple[float, float] = (1e-4, 1e-4),
    outliers: float = 0.0,
    seed: int = 0,
    q: Any = None,
    points: ArrayLike = (0.0, 0.0, 0.0),
    unknown: bool = False,
) -> Simulated:
    """Simulated measurements of an arm that differs from `chain` by its axes and home pose.

    The true arm is A_i <- Ad(e^[η_i]) A_i, M <- M e^[η] with the minimal parameters of `calibrate`.
    Noise is normal: a measured pose is R_measured = e^[w] R, p_measured = p + e in the frame in
    which it is measured, a point p + e, a distance d + e; q is read without error.

    Parameters
    ----------
    chain : Chain
        The nominal arm.
    n : int
        Number of measurements.
    kind : {"poses", "eye-in-hand", "eye-to-hand", "points", "distances"}, default "poses"
        Kind of the measurements.
    tilt, shift : float
        Standard deviations of the errors of the arm, rad and m.
    noise : (2,) tuple of float
        Standard deviations of w (rad) and e (m) along each axis; without noise the measurements
        have no covariance.
    outliers : float, default 0
        Part of the rows, 0 <= outliers < 1, that are grossly wrong: turned by 0.1 to 1 rad about
        any axis and moved by 0.05 to 0.5 reaches in any direction, uniformly (a distance: longer,
        or shorter where it stays positive).
    seed : int, default 0
        Seed of all that is drawn; the same seed gives the same truth, frames and q whatever is
        measured of them, and how exactly.
    q : (n, m) array_like, optional
        Joint readings, rad or m; by default drawn within the limits.
    points : (3,) or (k, 3) array_like, default (0, 0, 0)
        Points of the tool in the tip frame, m; the first of them for distances.
    unknown : bool, default False
        Whether the points stand in a device's frame, or the centre of distances is not known, so
        that calibration has to find it. Frames of cameras and boards are never known.

    Returns
    -------
    made : Simulated
        The measurements and the truth.

    Raises
    ------
    InputError
        If an option is out of its range.
    ShapeError
        If q, points or noise have another shape.

    Notes
    -----
    Accuracy: axes stay unit and pitches what they are to 1e-15. Source: Park 1994, Section II.

    Examples
    --------
    >>> import poekin as pk
    >>> arm = pk.load("ur5").chain()
    >>> made = pk.calibration.simulated(arm, 40, kind="eye-in-hand", seed=1)
    >>> print(made)
    40 simulated EyeInHand, 0 of them gross outliers
    >>> sorted(made.frames)
    ['T_base_board', 'T_tip_camera']
    """
    choice(kind, KINDS, "kind")
    whole(n, "n", 1)
    whole(seed, "seed", 0)
    deviations = _deviations(tilt, shift, noise)
    part = numbers(outliers, "outliers")
    if part.shape != () or not 0 <= outliers < 1:
        raise InputError(
            "outliers: expected a part of the measurements, 0 <= outliers < 1, got "
            f"{safe_repr(outliers)}"
        )
    body = parse_points(points)
    if kind == "distances":
        body = body[:1]
    for_arm, for_frames, for_errors, for_outliers = (
        np.random.default_rng([seed, part]) for part in range(4)
    )
    model = ErrorModel(chain, ("screws", "home"), None)
    sizes = {"rad": tilt, "m": shift}
    p = np.array([sizes[parameter.unit] for parameter in model.parameters], float)
    p *= for_arm.normal(size=len(p))
    truth = model.chain(p)
    q = _readings(chain, q, int(n), for_arm)
    gross = np.zeros(n, bool)
    gross[for_outliers.permutation(n)[: round(outliers * n)]] = True
    sensor = _Sensor(
        chain.reach,
        deviations,
        for_errors,
        for_outliers,
        gross,
    )
    X, Z, centre = _random_frames(for_frames, chain.reach)
    measured = _measure(
        kind,
        truth.fk(q),
        (X, Z, centre),
        body,
        unknown,
        sensor,
    )
    unknown_frames = [frame.name for frame in measured.unknown_frames]
    values = [centre] if kind == "distances" else [X, Z]
    return Simulated(
        truth=truth,
        parameters=read_only(p),
        q=read_only(q),
        measurements=measured,
        frames=dict(zip(unknown_frames, values, strict=False)),
        points=None if measured.angular else read_only(body),
        outliers=read_only(gross),
    )


_HAND_EYE = {"eye-in-hand": EyeInHand, "eye-to-hand": EyeToHand}


def _measure(
    kind: str,
    T: Array,
    frames: tuple[Array, ...],
    points: Array,
    unknown: bool,
    sensor: _Sensor,
) -> Measurement:
    """Measurements of this kind at the true poses T (N, 4, 4), of the frames X and Z or from the
    centre.
    """
    X, Z, centre = frames
    if kind == "poses":
        return Poses(sensor.poses(T), sensor.covariance(3, 3))
    if kind in _HAND_EYE:
        seen = sensor.poses(se3.inverse(X) @ T @ Z)
        return _HAND_EYE[kind](seen, sensor.covariance(3, 3))
    if kind == "distances":
        (point,) = points
        d = sensor.distances(T, point, centre)
        known = None if unknown else centre
        return Distances(
            d,
            known,
            point,
            sensor.covariance(0, 1),
        )
    frame: PointFrame = "base"
    if unknown:
        frame = "unknown"
        T = se3.inverse(X) @ T
    p = sensor.points(T, points)
    return Points(
        p,
        points,
        sensor.covariance(0, points.size),
        frame=frame,
    )


def _readings(
    chain: Chain,
    q: Any,
    n: int,
    rng: np.random.Generator,
) -> Array:
    if q is None:
        return chain.random(rng, n)
    q = finite(coordinates(q, chain.q_names), "q")
    if q.shape != (n, chain.dof):
        raise ShapeError(f"q: expected shape ({n}, {chain.dof}), got {q.shape}")
    return q


class _Sensor(NamedTuple):
    """A sensor that measures with noise, and grossly wrong in some rows."""

    reach: float
    noise: tuple[float, float]
    rng: np.random.Generator
    outlier_rng: np.random.Generator
    gross: np.ndarray

    def poses(self, T: Array) -> Array:
        """Measured poses (N, 4, 4)."""
        shape = (len(T), 3)
        w, e = (self._drawn(sigma, shape) for sigma in self.noise)
        w[self.gross] += self._gross_vectors(GROSS_TURN)
        e[self.gross] += self._gross_vectors(GROSS_SHIFT, self.reach)
        T = T.copy()
        R = rotation_part(T)
        T[:, :3, :3] = so3.exp(w) @ R
        T[:, :3, 3] += e
        return T

    def points(self, T: Array, points: Array) -> Array:
        """Measured positions (N, k, 3) of points of the tool."""
        p = points_at(T, points)
        p += self._drawn(self.noise[1], p.shape)
        shifts = self._gross_vectors(GROSS_SHIFT, self.reach)
        p[self.gross] += shifts[:, None]
        return p

    def distances(
        self,
        T: Array,
        point: Array,
        centre: Array,
    ) -> Array:
        """Measured distances (N,) of a point of the tool from the centre."""
        away = point_at(T, point) - centre
        d = norms(away)
        d += self._drawn(self.noise[1], d.shape)
        count = len(d)
        signs = self.outlier_rng.choice([-1.0, 1.0], count)
        sizes = self.outlier_rng.uniform(*GROSS_SHIFT, count)
        off = signs * self.reach * sizes
        wrong = np.where(d + off > 0, d + off, d - off)
        return np.where(self.gross, wrong, d)

    def covariance(self, angles: int, lengths: int) -> Array | None:
        """Covariance of one measurement's errors, the angles first; None without noise."""
        variances = np.square(self.noise)
        diagonal = np.repeat(variances, [angles, lengths])
        if diagonal.all():
            return np.diag(diagonal)
        return None

    def _drawn(self, sigma: float, shape: tuple[int, ...]) -> Array:
        return sigma * self.rng.normal(size=shape)

    def _gross_vectors(
        self,
        bounds: tuple[float, float],
        unit: float = 1.0,
    ) -> Array:
        count = int(self.gross.sum())
        sizes = self.outlier_rng.uniform(*bounds, (count, 1))
        return unit * sizes * _directions(self.outlier_rng, count)


def _directions(rng: np.random.Generator, count: int) -> Array:
    """Unit vectors (count, 3), evenly over the sphere."""
    z = rng.normal(size=(count, 3))
    return normalised(z)


def _random_frames(rng: np.random.Generator, reach: float) -> tuple[Array, ...]:
    """X = T_base_fixed anywhere about the base; Z = T_tip_moving near the tip, by a tenth of the
    reach; a centre of distances that the arm does not come to.
    """
    angles = rng.uniform(0.5, 2.5, (2, 1))
    turns = so3.exp(angles * _directions(rng, 2))
    directions = _directions(rng, 3)
    X = se3.pose(turns[0], 0.7 * reach * directions[0])
    Z = se3.pose(turns[1], 0.1 * reach * directions[1])
    centre = 2.0 * reach * directions[2]
    return tuple(map(read_only, (X, Z, centre)))


def _deviations(
    tilt: Any,
    shift: Any,
    noise: Any,
) -> tuple[float, float]:
    """The noise as two numbers. Raises: InputError, ShapeError, of the others too."""
    sizes = numbers(noise, "noise")
    if sizes.shape != (2,):
        raise ShapeError(
            f"noise: expected two standard deviations, (rad, m), got {safe_repr(noise)}"
        )
    turn, place = sizes.tolist()
    named = {
        "tilt": tilt,
        "shift": shift,
        "noise[0]": turn,
        "noise[1]": place,
    }
    for name, value in named.items():
        if numbers(value, name).shape != () or not 0 <= value < np.inf:
            raise InputError(
                f"{name}: expected a finite number of at least 0, got {safe_repr(value)}"
            )
    return turn, place
