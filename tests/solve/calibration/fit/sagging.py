"""Measurements of an arm that sags: errors of a configuration's numbers that depend on each other."""

from __future__ import annotations

import numpy as np

import poekin as pk
from poekin.groups import se3
from poekin.solve.calibration import Distances, EyeInHand, Measurement, Points, Poses
from poekin.solve.calibration.model.error_model import ErrorModel

ARM = pk.load("ur5").chain()
POINTS = np.array([[0.05, 0, 0.02], [-0.03, 0.05, 0.02], [0, -0.04, 0.06]])
CENTRE = np.array([1.5, -1.0, 1.2])
BOARD = se3.exp([0.3, -0.5, 0.2, 1.0, 0.4, -0.3])
CAMERA = se3.exp([-0.1, 0.2, 0.4, 0.05, -0.08, 0.12])
NOISE = 5e-5
SAG = 1e-3
"""rad per m of lever, of joints 2 and 3: about 1 mm at the tool."""


def true_arm(rng: np.random.Generator) -> pk.Chain:
    """An arm off by 1 mrad and 1 mm."""
    model = ErrorModel(ARM, ("screws", "home"), None)
    return model.chain(1e-3 * rng.normal(size=len(model.parameters)))


def sagged(chain: pk.Chain, q: np.ndarray, sag: float) -> np.ndarray:
    """Poses (N, 4, 4) of the arm at q whose joints 2 and 3 give way to a weight at the tip."""
    tip = chain.fk(q)[:, :3, 3]
    J = chain.jacobian(q, frame="space")
    moved = q.copy()
    for j in (1, 2):
        lever = (J[:, 3:, j] + np.cross(J[:, :3, j], tip))[:, 2]
        moved[:, j] -= sag * lever
    return chain.fk(moved)


def measured(kind: str, T: np.ndarray, rng: np.random.Generator) -> Measurement:
    """Measurements of this kind with normal noise."""
    if kind == "camera":
        return EyeInHand(_noisy(se3.inverse(BOARD) @ T @ CAMERA, rng))
    if kind == "poses":
        return Poses(_noisy(T, rng))
    points = POINTS if kind == "reflectors" else POINTS[:1]
    p = points @ np.swapaxes(T[:, :3, :3], 1, 2) + T[:, None, :3, 3]
    if kind == "distance":
        d = np.linalg.norm(p[:, 0] - CENTRE, axis=1)
        return Distances(d + NOISE * rng.normal(size=len(d)), CENTRE, POINTS[0])
    return Points(p + NOISE * rng.normal(size=p.shape), points)


def _noisy(T: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    T = T.copy()
    T[:, :3, :3] = pk.so3.exp(1e-4 * rng.normal(size=(len(T), 3))) @ T[:, :3, :3]
    T[:, :3, 3] += NOISE * rng.normal(size=(len(T), 3))
    return T
