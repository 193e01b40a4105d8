"""Simulated sweeps of one joint at a time."""

from __future__ import annotations

import numpy as np

import poekin as pk
from poekin.groups import se3, so3
from poekin.model.chain import Chain
from poekin.solve.calibration import JointSweep

DEVICE = se3.exp([0.1, 0.2, 0.3, 1.0, 2.0, 0.5])
TOOL = se3.pose(np.eye(3), [0.1, 0.05, 0.2])


def in_the_device(arm: Chain) -> Chain:
    """The arm in the frame of a device, its tip a reflector beside the tool."""
    return arm.retooled(TOOL).rebased(DEVICE)


UR5 = in_the_device(pk.load("ur5").chain())
SCARA = in_the_device(
    Chain.from_space(
        [[0, 0, 1, 0, 0, 0], [0, 0, 1, 0, -0.4, 0], [0, 0, 0, 0, 0.1**0.5, -(0.9**0.5)], [0, 0, -1, 0, 0.7, 0]],
        se3.pose(so3.exp([np.pi, 0, 0]), [0.7, 0, 0.2]),
    )
)  # fmt: skip
ARMS = {"ur5": UR5, "scara": SCARA}


def swept(
    true: Chain, joint: int, held: np.ndarray, half: float = 1.0, count: int = 16
) -> np.ndarray:
    """Readings (count, n) of a sweep by `half` (a third of it, m, of a joint that slides) both ways."""
    slides = true.kinds[joint] == "prismatic"
    q = np.tile(held, (count, 1))
    q[:, joint] += np.linspace(-half, half, count) / (3.0 if slides else 1.0)
    return q


def noisy(T: np.ndarray, noise: float, rng: np.random.Generator, poses: bool) -> np.ndarray:
    """Poses, or the points at their origins, with noise of this deviation along each axis, rad and m."""
    turn, move = noise * rng.normal(size=(2, len(T), 3))
    measured = T[:, :3, 3] + move
    if poses:
        return se3.pose(so3.exp(turn) @ T[:, :3, :3], measured)
    return measured


def sweep_all(
    true: Chain,
    held: np.ndarray,
    *,
    half: float = 1.0,
    count: int = 16,
    poses: bool = False,
    noise: float = 0.0,
    rng: np.random.Generator | None = None,
) -> list[JointSweep]:
    """A sweep of each joint; noise: deviation of each axis, m and rad."""
    rng = rng or np.random.default_rng(0)
    sweeps = []
    for joint, kind in enumerate(true.kinds):
        q = swept(true, joint, held, half, count)
        measured = noisy(true.fk(q), noise, rng, poses)
        sweeps.append(
            JointSweep(joint, q, measured, "prismatic" if kind == "prismatic" else "revolute")
        )
    return sweeps
