"""The least-squares alignment of two arms' axes: Levenberg-Marquardt over a base pose and some zero offsets."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..groups import se3
from ..groups.arrays import Array
from .lines import Marks, Sides, carried, hinge_screw, residuals, signs, weighted

STEPS = 60


def fit(pair: Sides, P: Array, z: Array, free: Marks, used: Marks) -> tuple[Array, Array]:
    """The base pose P (4, 4) and zero offsets z (n,) that bring b's axes nearest to a's.

    Least squares of direction and place, each in tolerances, over the axes in `used` (n, bool); zero offsets move
    where `free` (n, bool) says so. What the axes leave free stays where it starts.
    """
    index = np.flatnonzero(free)
    used = used & pair.alike
    P, z = P.copy(), z.copy()
    r, J = _linearised(pair, P, z, index, used)
    cost, damping = float(r @ r), 1e-6
    for _ in range(STEPS):
        if cost < 1e-16:
            break
        scale = np.linalg.norm(J, axis=0)
        scale[scale < 1e-6 * scale.max(initial=1e-300)] = scale.max(initial=1.0)
        system = np.concatenate([J, np.sqrt(damping) * np.diag(scale)])
        step = np.linalg.lstsq(system, np.concatenate([-r, np.zeros(len(scale))]), rcond=1e-14)[0]
        P_new, z_new = se3.exp(step[:6]) @ P, z.copy()
        z_new[index] += step[6:]
        r_new, J_new = _linearised(pair, P_new, z_new, index, used)
        cost_new = float(r_new @ r_new)
        if cost_new < cost:
            done = cost - cost_new < 1e-12 * cost
            P, z, r, J, cost = P_new, z_new, r_new, J_new, cost_new
            damping = max(damping / 10, 1e-14)
            if done:
                break
        elif damping > 1e3:
            break
        else:
            damping *= 10
    return P, z


def _linearised(pair: Sides, P: Array, z: Array, index: NDArray[np.intp], used: Marks) -> tuple[Array, Array]:
    """Residuals, and their derivatives with respect to a turn and move of the base and to the free zero offsets."""
    screws, axes = carried(pair, P, z)
    s = signs(pair, axes)[:, None]
    columns = np.zeros((pair.n, 6, 6 + len(index)))
    columns[:, :, :6] = -se3.ad(axes)  # d Ad(e^xi) S = ad(xi) S = -ad(S) xi
    for c, k in enumerate(index):
        turner = hinge_screw(pair, screws[k]) if k == pair.hinge else screws[k]
        columns[k + 1 :, :, 6 + c] = axes[k + 1 :] @ se3.ad(turner).T
    if pair.hinge >= 0:
        # Behind the hinge every change further in front is itself turned about a's axis.
        turn = se3.adjoint(se3.exp(hinge_screw(pair, screws[pair.hinge]) * z[pair.hinge]))
        behind = slice(pair.hinge + 1, None)
        columns[behind, :, :6] = columns[behind, :, :6] @ turn
        for c, k in enumerate(index):
            if k < pair.hinge:
                columns[behind, :, 6 + c] = axes[behind] @ se3.ad(turn @ screws[k]).T
    J = weighted(pair, s[:, :, None] * columns)
    return residuals(pair, axes)[used].ravel(), J[used].reshape(-1, columns.shape[2])
