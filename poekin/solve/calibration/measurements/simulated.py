"""Simulated measurements of an arm that is not quite as it is described: what a calibration should
find is known.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ....errors import InputError, ShapeError, safe_repr
from ....groups import se3, so3
from ....groups.arrays import Array, numbers
from ....model.chain import Chain
from ....model.checks import read_only
from ....model.coordinates import coordinates
from ..model.parameters import Arm
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
    arm: Chain,
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
    """n measurements of an arm like `arm` but for its axes and home pose, by the model that
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

    Parameters: arm, the nominal Chain; n, how many; kind, "poses", "eye-in-hand", "eye-to-hand",
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
    n, noise = _checked(n, kind, tilt, shift, noise, outliers, seed)
    body = np.atleast_2d(numbers(points, "points"))
    if body.ndim != 2 or body.shape[1] != 3 or not len(body) or not np.isfinite(body).all():
        raise ShapeError(
            f"points: expected finite (3,) or (k, 3) in the tip frame, got {safe_repr(points)}"
        )
    arms, places, errors, wild = (np.random.default_rng([seed, part]) for part in range(4))
    moved = Arm(arm, ("screws", "home"), None)
    p = np.array(
        [float(tilt if parameter.unit == "rad" else shift) for parameter in moved.parameters]
    )
    p *= arms.normal(size=len(p))
    truth = moved.chain(p)
    q = arm.random(arms, n) if q is None else coordinates(q, arm.q_names).copy()
    if q.shape != (n, arm.dof) or not np.isfinite(q).all():
        raise ShapeError(f"q: expected finite ({n}, {arm.dof}), got shape {q.shape}")
    gross = np.zeros(n, bool)
    gross[wild.permutation(n)[: round(outliers * n)]] = True
    T, made = truth.fk(q), _Made(arm.reach, noise, errors, wild, gross)
    X, Z, centre = _frames(places, arm.reach)
    frames: dict[str, Array] = {}
    if kind == "poses":
        measured: Measurement = Poses(made.poses(T), made.covariance(6))
    elif kind == "eye-in-hand":
        frames = {"T_base_board": X, "T_tip_camera": Z}
        measured = EyeInHand(made.poses(se3.inverse(X) @ T @ Z), made.covariance(6))
    elif kind == "eye-to-hand":
        frames = {"T_base_camera": X, "T_tip_board": Z}
        measured = EyeToHand(made.poses(se3.inverse(X) @ T @ Z), made.covariance(6))
    elif kind == "points":
        frames = {"T_base_device": X} if unknown else {}
        there = made.points(se3.inverse(X) @ T if unknown else T, body)
        measured = Points(
            there, body, made.covariance(3 * len(body)), frame="unknown" if unknown else "base"
        )
    else:
        body, frames = body[:1], {"centre": centre} if unknown else {}
        d = made.distances(T, body[0], centre)
        measured = Distances(d, None if unknown else centre, body[0], made.covariance(1))
    tool = read_only(body) if kind in ("points", "distances") else None
    return Simulated(truth, read_only(p), read_only(q), measured, frames, tool, read_only(gross))


@dataclass(frozen=True, eq=False)
class _Made:
    """Measurements at true poses T (N, 4, 4), with noise and gross errors."""

    reach: float
    noise: tuple[float, float]
    errors: np.random.Generator
    wild: np.random.Generator
    gross: np.ndarray

    def poses(self, T: Array) -> Array:
        """Measured poses (N, 4, 4)."""
        count = int(self.gross.sum())
        w, e = (sigma * self.errors.normal(size=(len(T), 3)) for sigma in self.noise)
        w[self.gross] += self.wild.uniform(*GROSS_TURN, (count, 1)) * _directions(self.wild, count)
        e[self.gross] += self._gross_shifts()
        T = T.copy()
        T[:, :3, :3], T[:, :3, 3] = so3.exp(w) @ T[:, :3, :3], T[:, :3, 3] + e
        return T

    def points(self, T: Array, points: Array) -> Array:
        """Measured positions (N, k, 3) of points of the tool."""
        p = points @ np.swapaxes(T[:, :3, :3], 1, 2) + T[:, None, :3, 3]
        p += self.noise[1] * self.errors.normal(size=p.shape)
        p[self.gross] += self._gross_shifts()[:, None]
        return p

    def distances(self, T: Array, point: Array, centre: Array) -> Array:
        """Measured distances (N,) of a point of the tool from the centre."""
        d = np.linalg.norm(T[:, :3, :3] @ point + T[:, :3, 3] - centre, axis=1)
        d += self.noise[1] * self.errors.normal(size=d.shape)
        off = (
            self.wild.choice([-1.0, 1.0], len(d))
            * self.reach
            * self.wild.uniform(*GROSS_SHIFT, len(d))
        )
        return np.where(self.gross, np.where(d + off > 0, d + off, d - off), d)

    def covariance(self, width: int) -> Array | None:
        """Of the errors of one measurement: of an angle and a place (6), or of places alone."""
        angle, length = np.square(self.noise)
        diagonal = np.repeat([angle, length], 3) if width == 6 else np.full(width, length)
        return np.diag(diagonal) if diagonal.all() else None

    def _gross_shifts(self) -> Array:
        count = int(self.gross.sum())
        return (
            self.reach * self.wild.uniform(*GROSS_SHIFT, (count, 1)) * _directions(self.wild, count)
        )


def _directions(rng: np.random.Generator, count: int) -> Array:
    """Unit vectors (count, 3), evenly over the sphere."""
    z = rng.normal(size=(count, 3))
    return z / np.linalg.norm(z, axis=1, keepdims=True)


def _frames(rng: np.random.Generator, reach: float) -> tuple[Array, Array, Array]:
    """X anywhere about the base; Z near the tip, by a tenth of the reach; a centre that the arm
    does not come to.
    """
    turns, directions = rng.uniform(0.5, 2.5, (2, 1)) * _directions(rng, 2), _directions(rng, 3)
    X, Z = (se3.exp([*turn, 0.0, 0.0, 0.0]) for turn in turns)
    X[:3, 3], Z[:3, 3] = 0.7 * reach * directions[0], 0.1 * reach * directions[1]
    return read_only(X), read_only(Z), read_only(2.0 * reach * directions[2])


def _checked(
    n: Any, kind: Any, tilt: Any, shift: Any, noise: Any, outliers: Any, seed: Any
) -> tuple[int, tuple[float, float]]:
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
    return int(n), (turn, place)
