"""Simulated calibrations: an arm that is off its nominal model by known amounts, and measurements
with known noise.
"""

from __future__ import annotations

import numpy as np

from poekin import Chain, so3
from poekin.solve.calibration.model.error_model import ErrorModel

KINDS = ("screws", "home")
# how far each parameter of the true arm is off the nominal one, rad and m: as real arms are
OFF = 3e-3
ANGLE, LENGTH = (
    3e-4,
    2e-4,
)  # how far measurements scatter, rad and m: as those of a good camera or tracker
SPREADS = np.array([ANGLE] * 3 + [LENGTH] * 3)


def displaced(
    nominal: Chain, rng: np.random.Generator, directions: np.ndarray | None = None
) -> tuple[Chain, np.ndarray]:  # fmt: skip
    """A true arm and its parameters p (P,) as `calibrate` counts them.

    directions (P, k), orthonormal, in rad and reaches: those that p may be made of, all where None.
    """
    arm, scale = ErrorModel(nominal, KINDS, None), scales(nominal)
    p = OFF * rng.normal(size=len(scale))
    if directions is not None:
        p = scale * (directions @ (directions.T @ (p / scale)))
    return arm.chain(p), p


def scales(nominal: Chain) -> np.ndarray:
    """1 for angles, the reach for lengths, of each parameter of the arm."""
    return np.array(
        [
            nominal.reach if p.unit == "m" else 1.0
            for p in ErrorModel(nominal, KINDS, None).parameters
        ]
    )


def noisy(T: np.ndarray, noise: np.ndarray) -> np.ndarray:
    """Measured poses whose errors, model minus measurement, are noise (N, 6): turns in rad, then
    shifts in m.
    """
    measured = T.copy()
    measured[:, :3, :3] = so3.exp(-noise[:, :3]) @ T[:, :3, :3]
    measured[:, :3, 3] -= noise[:, 3:]
    return measured


def white(rng: np.random.Generator, count: int) -> np.ndarray:
    """Independent normal errors (count, 6) of `ANGLE` and `LENGTH`."""
    return rng.normal(size=(count, 6)) * SPREADS


def correlated(rng: np.random.Generator) -> np.ndarray:
    """A covariance (6, 6) of errors of about `SPREADS` that depend on each other."""
    mixed = rng.normal(size=(6, 12)) / np.sqrt(12)
    return np.outer(SPREADS, SPREADS) * (mixed @ mixed.T)


def errors(arm: Chain, true: Chain, q: np.ndarray) -> tuple[float, float]:
    """Root mean square error of position (m) and of rotation (rad) over the configurations q."""
    T, expected = arm.fk(q), true.fk(q)
    turns = so3.log(T[:, :3, :3] @ np.swapaxes(expected[:, :3, :3], 1, 2))
    shifts = T[:, :3, 3] - expected[:, :3, 3]
    return tuple(float(np.sqrt(np.mean(np.sum(x * x, axis=1)))) for x in (shifts, turns))  # type: ignore[return-value]
