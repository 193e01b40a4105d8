"""Simulated measurements of an arm that is not quite as it is described: what a calibration should
find is known.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ....errors import InputError, ShapeError, safe_repr
from ....groups import se3, so3
from ....groups.arrays import Array, numbers
from ....model.chain import Chain
from ....model.checks import read_only
from ....model.coordinates import coordinates
from ..model.error_model import ErrorModel
from .data import KINDS
from .measurement import Measurement
from .points import Distances, Points
from .poses import EyeInHand, EyeToHand, Poses

GROSS_TURN, GROSS_SHIFT = (0.1, 1.0), (0.05, 0.5)
"""Bounds of how far a gross outlier is off: its angle in rad, its place in reaches of the arm."""


@dataclass(frozen=True, eq=False)
class Simulated:
    """Measurements and the truth behind them.

    truth, the Chain that was measured; parameters (P,), its errors in the order of `calibrate`'s
    "screws" and "home", rad and m; q (n, m), the readings; measurements, one set with its
    covariance; frames, the true value of each frame (4, 4) or point (3,) that the set does not
    know, by name (T_base_board, T_tip_camera, ..., centre); points (k, 3), of the tool, m, in the
    tip frame, None where poses are measured; outliers (n,), True for the rows that are
    grossly wrong.
    """

    truth: Chain
    parameters: Array
    q: Array
    measurements: Measurement
    frames: dict[str, Array]
    points: Array | None
    outliers: np.ndarray

    @property
    def X(self) -> Array | None:
        """T_base_fixed (4, 4) of what stands still: board, camera or device. None where nothing
        does.
        """
        return next((T for name, T in self.frames.items() if name.startswith("T_base")), None)

    @property
    def Z(self) -> Array | None:
        """T_tip_moving (4, 4) of the camera or board on the tip. None where there is none."""
        return next((T for name, T in self.frames.items() if name.startswith("T_tip")), None)


def simulated(
    chain: Chain,
    n: int,
    *,
    kind: str = "poses",
    tilt: float = 2e-3,
    shift: float = 1e-3,
    noise: tuple[float, float] = (1e-4, 1e-4),
    outliers: float = 0.0,
    seed: int = 0,
    q: Any = None,
    points: ArrayLike = (0.0, 0.0, 0.0),
    unknown: bool = False,
) -> Simulated:
    """n measurements of an arm like `chain` but for its axes and home pose, by the model that
    `calibrate` has of errors.

    The truth: A_i <- Ad(e^eta_i) A_i, M <- M e^eta with the minimal parameters of `calibrate`
    ("screws": two tilts and two shifts across each axis, in the joint's own frame; "home": six),
    tilts normal of standard deviation `tilt`, shifts of `shift`. A measured pose: R_measured =
    e^[w] R, p_measured = p + e, w and e normal with standard deviations noise = (rad, m) along each
    axis of the frame in which it is measured; a point p + e; a distance d + e;
    q is read without error. Gross outliers, round(outliers n) rows drawn at random, are turned by
    0.1 to 1 rad about any axis and moved by 0.05 to 0.5 reaches in any direction, uniformly (a
    distance: longer, or shorter where it
    stays positive).

    Parameters: chain, the nominal arm; n, how many; kind, "poses", "eye-in-hand", "eye-to-hand",
    "points" or "distances"; tilt, rad; shift, m; noise; outliers, their part, 0 <= outliers < 1;
    seed: the same one gives the same truth, frames and q whatever is measured of them, and how
    exactly; q (n, m), drawn within the limits where it is not given; points (3,) or (k, 3), of the
    tool, in the tip frame, m (the first of them for distances); unknown, whether the points stand
    in a device's frame, the distances' centre is not known, and calibration has to find it. The
    frames of cameras and boards are never known. Without noise no covariance is said.
    Returns: Simulated. Raises: InputError, ShapeError. Accuracy: axes stay unit and pitches as they
    are to 1e-15. Source: Park 1994, Section II; the errors are those of `Poses`, `Points`,
    `Distances`, `EyeInHand`, `EyeToHand`.
    """
    noise = _check(n, kind, tilt, shift, noise, outliers, seed)
    n = int(n)
    body = np.atleast_2d(numbers(points, "points"))
    if body.ndim != 2 or body.shape[1] != 3 or not len(body) or not np.isfinite(body).all():
        raise ShapeError(
            f"points: expected finite (3,) or (k, 3) in the tip frame, got {safe_repr(points)}"
        )
    for_arm, for_frames, for_errors, for_outliers = (
        np.random.default_rng([seed, part]) for part in range(4)
    )
    model = ErrorModel(chain, ("screws", "home"), None)
    sizes = {"rad": float(tilt), "m": float(shift)}
    p = np.array([sizes[parameter.unit] for parameter in model.parameters])
    p *= for_arm.normal(size=len(p))
    truth = model.chain(p)
    q = _readings(chain, q, n, for_arm)
    gross = np.zeros(n, bool)
    gross[for_outliers.permutation(n)[: round(outliers * n)]] = True
    sensor = _Sensor(chain.reach, noise, for_errors, for_outliers, gross)
    setup = _setup(kind, body, unknown, _random_frames(for_frames, chain.reach))
    return Simulated(
        truth=truth,
        parameters=read_only(p),
        q=read_only(q),
        measurements=_measure(kind, truth.fk(q), setup, sensor),
        frames=setup.unknown,
        points=setup.points,
        outliers=read_only(gross),
    )


class _Frames(NamedTuple):
    """T_base_fixed, T_tip_moving and the centre of distances."""

    X: Array
    Z: Array
    centre: Array


class _Setup(NamedTuple):
    """Frames, those of them that are unknown by name, and the points of the tool, if any."""

    frames: _Frames
    unknown: dict[str, Array]
    points: Array | None


def _setup(kind: str, body: Array, unknown: bool, frames: _Frames) -> _Setup:
    X, Z, centre = frames
    if kind == "eye-in-hand":
        return _Setup(frames, {"T_base_board": X, "T_tip_camera": Z}, None)
    if kind == "eye-to-hand":
        return _Setup(frames, {"T_base_camera": X, "T_tip_board": Z}, None)
    if kind == "points":
        return _Setup(frames, {"T_base_device": X} if unknown else {}, read_only(body))
    if kind == "distances":
        return _Setup(frames, {"centre": centre} if unknown else {}, read_only(body[:1]))
    return _Setup(frames, {}, None)


def _measure(kind: str, T: Array, setup: _Setup, sensor: _Sensor) -> Measurement:
    """Measurements of this kind at the true poses T (N, 4, 4)."""
    X, Z, centre = setup.frames
    if kind == "poses":
        return Poses(sensor.poses(T), sensor.covariance(3, 3))
    if setup.points is None:
        if kind == "eye-in-hand":
            made = EyeInHand
        else:
            made = EyeToHand
        return made(sensor.poses(se3.inverse(X) @ T @ Z), sensor.covariance(3, 3))
    covariance = sensor.covariance(0, setup.points.size)
    if kind == "distances":
        point = setup.points[0]
        d = sensor.distances(T, point, centre)
        return Distances(d, None if setup.unknown else centre, point, sensor.covariance(0, 1))
    if setup.unknown:
        p = sensor.points(se3.inverse(X) @ T, setup.points)
        return Points(p, setup.points, covariance, frame="unknown")
    return Points(sensor.points(T, setup.points), setup.points, covariance)


def _readings(chain: Chain, q: Any, n: int, rng: np.random.Generator) -> Array:
    q = chain.random(rng, n) if q is None else coordinates(q, chain.q_names).copy()
    if q.shape != (n, chain.dof) or not np.isfinite(q).all():
        raise ShapeError(f"q: expected finite ({n}, {chain.dof}), got shape {q.shape}")
    return q


@dataclass(frozen=True, eq=False)
class _Sensor:
    """A sensor that measures with noise, and grossly wrong in some rows."""

    reach: float
    noise: tuple[float, float]
    rng: np.random.Generator
    outlier_rng: np.random.Generator
    gross: np.ndarray

    def poses(self, T: Array) -> Array:
        """Measured poses (N, 4, 4)."""
        count = int(self.gross.sum())
        w, e = (sigma * self.rng.normal(size=(len(T), 3)) for sigma in self.noise)
        turns = self.outlier_rng.uniform(*GROSS_TURN, (count, 1))
        w[self.gross] += turns * _directions(self.outlier_rng, count)
        e[self.gross] += self._gross_shifts()
        T = T.copy()
        T[:, :3, :3] = so3.exp(w) @ T[:, :3, :3]
        T[:, :3, 3] += e
        return T

    def points(self, T: Array, points: Array) -> Array:
        """Measured positions (N, k, 3) of points of the tool."""
        p = points @ np.swapaxes(T[:, :3, :3], 1, 2) + T[:, None, :3, 3]
        p += self.noise[1] * self.rng.normal(size=p.shape)
        p[self.gross] += self._gross_shifts()[:, None]
        return p

    def distances(self, T: Array, point: Array, centre: Array) -> Array:
        """Measured distances (N,) of a point of the tool from the centre."""
        d = np.linalg.norm(T[:, :3, :3] @ point + T[:, :3, 3] - centre, axis=1)
        d += self.noise[1] * self.rng.normal(size=d.shape)
        signs = self.outlier_rng.choice([-1.0, 1.0], len(d))
        off = signs * self.reach * self.outlier_rng.uniform(*GROSS_SHIFT, len(d))
        wrong = np.where(d + off > 0, d + off, d - off)
        return np.where(self.gross, wrong, d)

    def covariance(self, angles: int, lengths: int) -> Array | None:
        """Covariance of one measurement's errors, the angles first; None without noise."""
        diagonal = np.repeat(np.square(self.noise), [angles, lengths])
        return np.diag(diagonal) if diagonal.all() else None

    def _gross_shifts(self) -> Array:
        count = int(self.gross.sum())
        sizes = self.outlier_rng.uniform(*GROSS_SHIFT, (count, 1))
        return self.reach * sizes * _directions(self.outlier_rng, count)


def _directions(rng: np.random.Generator, count: int) -> Array:
    """Unit vectors (count, 3), evenly over the sphere."""
    z = rng.normal(size=(count, 3))
    return z / np.linalg.norm(z, axis=1, keepdims=True)


def _random_frames(rng: np.random.Generator, reach: float) -> _Frames:
    """X anywhere about the base; Z near the tip, by a tenth of the reach; a centre that the arm
    does not come to.
    """
    turns = rng.uniform(0.5, 2.5, (2, 1)) * _directions(rng, 2)
    directions = _directions(rng, 3)
    X, Z = (se3.exp([*turn, 0.0, 0.0, 0.0]) for turn in turns)
    X[:3, 3] = 0.7 * reach * directions[0]
    Z[:3, 3] = 0.1 * reach * directions[1]
    return _Frames(read_only(X), read_only(Z), read_only(2.0 * reach * directions[2]))


def _check(
    n: Any, kind: Any, tilt: Any, shift: Any, noise: Any, outliers: Any, seed: Any
) -> tuple[float, float]:
    """The noise as two numbers. Raises: InputError, ShapeError."""
    if kind not in KINDS:
        raise InputError(f"kind: expected one of {', '.join(KINDS)}, got {safe_repr(kind)}")
    for value, name, least in ((n, "n", 1), (seed, "seed", 0)):
        if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or value < least:
            raise InputError(
                f"{name}: expected a whole number of at least {least}, got {safe_repr(value)}"
            )
    sizes = numbers(noise, "noise")
    if sizes.shape != (2,):
        raise ShapeError(
            f"noise: expected two standard deviations, (rad, m), got {safe_repr(noise)}"
        )
    turn, place = sizes.tolist()
    for value, name in ((tilt, "tilt"), (shift, "shift"), (turn, "noise[0]"), (place, "noise[1]")):
        if numbers(value, name).shape != () or not 0 <= value < np.inf:
            raise InputError(
                f"{name}: expected a finite number of at least 0, got {safe_repr(value)}"
            )
    if numbers(outliers, "outliers").shape != () or not 0 <= outliers < 1:
        raise InputError(
            f"outliers: expected a part of the measurements, 0 <= outliers < 1, got {safe_repr(outliers)}"
        )
    return turn, place
