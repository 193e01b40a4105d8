"""Measurements in a small cube, which hardly tell some parameters: the search follows the valley."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

import poekin as pk
from poekin.groups import se3, so3
from poekin.solve.calibration import Points, calibrate
from poekin.solve.calibration.model.error_model import ErrorModel

ARMS = {"ur5": None, "panda": "panda_link8", "puma560": None, "ur10e": None, "stanford": None}
POINT = np.array([0.05, 0.02, 0.1])
DEVICE = se3.exp([0.3, -0.5, 0.2, 2.0, 1.4, -0.3])
SIDE = 0.2
COUNT = 200
NOISE = 5e-4
MOST = 50


def cube(arm: pk.Chain, rng: np.random.Generator) -> np.ndarray:
    """Readings (200, m) with the tip in a cube of 0.2 m, turned by 0.02 rad about one orientation."""
    while True:
        q0 = arm.random(rng)
        T0 = arm.fk(q0)
        if not 0.3 < np.linalg.norm(T0[:3, 3]) / arm.reach < 0.7:
            continue
        T = np.tile(T0, (COUNT, 1, 1))
        T[:, :3, 3] += rng.uniform(-SIDE / 2, SIDE / 2, (COUNT, 3))
        T[:, :3, :3] = so3.exp(0.02 * rng.normal(size=(COUNT, 3))) @ T[:, :3, :3]
        q = np.tile(q0, (COUNT, 1))
        for _ in range(8):  # Newton's steps
            now = arm.fk(q)
            turn = so3.log(T[:, :3, :3] @ np.swapaxes(now[:, :3, :3], 1, 2))
            off = np.concatenate([turn, T[:, :3, 3] - now[:, :3, 3]], axis=1)
            q = q + np.einsum("nij,nj->ni", np.linalg.pinv(arm.jacobian(q, frame="hybrid")), off)
        if np.abs(off).max() < 1e-9 and np.abs(q - q0).max() < 2.0:
            return q


def cubes() -> Iterator[tuple[pk.Chain, np.ndarray, Points]]:
    """Ten cubes of each of five arms, every third in a device's frame, with 0.5 mm of noise."""
    for name, tip in ARMS.items():
        arm = pk.load(name).chain(tip=tip)
        model = ErrorModel(arm, ("screws", "home"), None)
        sizes = np.array([{"rad": 2e-3, "m": 1e-3}[p.unit] for p in model.parameters])
        for seed in range(10):
            rng = np.random.default_rng([seed, 5])
            q = cube(arm, rng)
            T = model.chain(sizes * rng.normal(size=len(sizes))).fk(q)
            p = T[:, :3, :3] @ POINT + T[:, :3, 3] + NOISE * rng.normal(size=(COUNT, 3))
            if seed % 3:
                yield arm, q, Points(p, POINT)
            else:
                yield arm, q, Points((p - DEVICE[:3, 3]) @ DEVICE[:3, :3], POINT, frame="unknown")


def test_small_cubes_of_points_converge_within_fifty_steps():
    conditions = []
    for arm, q, measured in cubes():
        found = calibrate(arm, q, measured, folds=0, on_rank_deficiency="fix", iterations=MOST)
        assert found.success
        conditions.append(found.identification.condition)
    assert len(conditions) == 50
    assert np.median(conditions) > 1e3
