"""The worst of many cases, picked in extended precision, for `worst_errors` to judge in 60 digits.

Errors are measured here against sizes that leave out derivatives: good enough to tell who is
suspect.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from . import longdouble_oracle

PICKED = 16
"""How many cases are picked for each kind of error."""


def axes(rng: np.random.Generator, count: int) -> np.ndarray:
    """Unit vectors (count, 3), a third of them along an axis of the frame or nearly so."""
    n = rng.normal(size=(count, 3))
    tilt = 10.0 ** rng.uniform(-17, -1, (count, 1)) * (rng.random((count, 1)) < 0.5)
    aligned = rng.permuted(np.tile([1.0, 0.0, 0.0], (count, 1)), axis=1)
    n = np.where(rng.random((count, 1)) < 1 / 3, aligned + tilt * n, n)
    return n / np.linalg.norm(n, axis=1, keepdims=True)


def twists(rng: np.random.Generator, count: int, largest: float) -> np.ndarray:
    """Twists (count, 6) with |ω| evenly from 0.05 to largest, v in every direction, often nearly
    along ω.
    """
    n = axes(rng, count)
    beside = np.where(rng.random((count, 1)) < 0.5, 10.0 ** rng.uniform(-4, 0, (count, 1)), 1e3)
    direction = n + beside * axes(rng, count)
    direction *= 10.0 ** rng.uniform(-2, 2, (count, 1)) / np.linalg.norm(
        direction, axis=1, keepdims=True
    )
    return np.concatenate([rng.uniform(0.05, largest, (count, 1)) * n, direction], axis=1)


def of_exp(pose: Any, xi: np.ndarray) -> np.ndarray:
    """The twists at which R or t of pose.exp looks worst."""
    T, truth = pose.exp(xi), longdouble_oracle.exp(xi)
    R = _norm((T - truth)[:, :3, :3].reshape(-1, 9)) / (1 + np.sqrt(2) * _norm(xi[:, :3]))
    t = _norm((T - truth)[:, :3, 3]) / (_norm(truth[:, :3, 3]) + _norm(xi[:, 3:]))
    return _picked(xi, R, t)


def of_log(pose: Any, T: np.ndarray) -> np.ndarray:
    """The poses at which ω or v of pose.log looks worst; their angles lie from 0.05 to π."""
    xi, truth = pose.log(T), longdouble_oracle.log(T)
    theta = _norm(truth[:, :3])
    kappa = theta / 2 / np.sin(theta / 2)
    w = _norm((xi - truth)[:, :3]) / theta / (1 + 1.22 * kappa * np.minimum(1, 1 / theta))
    v = _norm((xi - truth)[:, 3:]) / (_norm(truth[:, 3:]) + kappa * _norm(T[:, :3, 3]))
    return _picked(T, w, v)


def of_jacobian(pose: Any, name: str, xi: np.ndarray) -> np.ndarray:
    """The twists at which the 3×3 block or the Q block of pose.left_jacobian, or of its inverse,
    looks worst.
    """
    error = getattr(pose, name)(xi) - getattr(longdouble_oracle, name)(xi)
    blocks, corners = _norm(error[:, :3, :3].reshape(-1, 9)), _norm(error[:, 3:, :3].reshape(-1, 9))
    return _picked(xi, blocks, corners / _norm(xi[:, 3:]))


def _picked(cases: np.ndarray, *errors: np.ndarray) -> np.ndarray:
    worst = [np.argsort(np.nan_to_num(e.astype(float), nan=np.inf))[-PICKED:] for e in errors]
    return cases[np.unique(np.concatenate(worst))]


def _norm(x: np.ndarray) -> np.ndarray:
    return np.sqrt(np.sum(x * x, axis=1))
