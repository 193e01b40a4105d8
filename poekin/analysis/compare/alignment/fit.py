"""The least-squares alignment of two arms' axes: Levenberg-Marquardt over a base pose and some zero
offsets.
"""

from __future__ import annotations

import numpy as np

from ....groups import se3
from ....groups.arrays import Array
from .lines import Marks, Sides, residuals, signs, suspect_screw, transformed

STEPS = 60


def fit(pair: Sides, P: Array, z: Array, free: Marks, used: Marks) -> tuple[Array, Array]:
    """The base poses P (m, 4, 4) and zero offsets z (m, n) that bring b's axes nearest to a's, from
    m starts.

    Least squares of direction and place, each in tolerances, over the axes in `used` (n) or (m, n,
    bool); zero offsets move where `free` (n) or (m, n, bool) says so. What the axes leave free
    stays where it starts. All starts are stepped at once, each with a damping of its own and until
    it is done.
    """
    P = P.copy()
    z = z.copy()
    free = np.broadcast_to(free, z.shape)
    used = np.broadcast_to(used & pair.alike, z.shape)
    r, J = _linearised(pair, P, z, free, used)
    cost = (r * r).sum(1)
    damping = np.full(len(z), 1e-6)
    going = cost >= 1e-16
    for _ in range(STEPS):
        (live,) = np.nonzero(going)
        if not len(live):
            break
        step = _step(r[live], J[live], damping[live])
        P_new = se3.exp(step[:, :6]) @ P[live]
        z_new = z[live] + step[:, 6:]
        r_new, J_new = _linearised(pair, P_new, z_new, free[live], used[live])
        cost_new = (r_new * r_new).sum(1)
        old = cost[live]
        better = cost_new < old
        going[live] = np.where(
            better,
            (old - cost_new >= 1e-12 * old) & (cost_new >= 1e-16),
            damping[live] <= 1e3,
        )
        damping[live] = np.where(better, np.maximum(damping[live] / 10, 1e-14), damping[live] * 10)
        won = live[better]
        P[won] = P_new[better]
        z[won] = z_new[better]
        r[won] = r_new[better]
        J[won] = J_new[better]
        cost[won] = cost_new[better]
    return P, z


def _step(r: Array, J: Array, damping: Array) -> Array:
    """The steps (m, 6 + n) that lessen residuals r (m, rows) most, held back in proportion to the
    damping (m,).
    """
    scale = np.linalg.norm(J, axis=1)
    most = scale.max(axis=1, keepdims=True)
    scale = np.where(scale < 1e-6 * most, most, scale)
    scale[scale == 0] = 1.0  # where nothing is to be moved
    held = (np.sqrt(damping)[:, None] * scale)[:, None] * np.eye(scale.shape[1])
    system = np.concatenate([J, held], axis=1)
    right = np.concatenate([-r, np.zeros_like(scale)], axis=1)
    # The factor R of the system beside its right side holds both triangular.
    R = np.asarray(np.linalg.qr(np.concatenate([system, right[..., None]], axis=2), mode="r"))
    return np.linalg.solve(R[:, :-1, :-1], R[:, :-1, -1:])[..., 0]


def _linearised(pair: Sides, P: Array, z: Array, free: Marks, used: Marks) -> tuple[Array, Array]:
    """Residuals (m, 6 n), and their derivatives (m, 6 n, 6 + n) by the base's pose and by the zero
    offsets.

    Those of axes that are not used and by zero offsets that are not free are 0.
    """
    screws, axes = transformed(pair, P, z)
    s = signs(pair, axes)
    n = pair.n
    k = pair.suspect_joint
    # d Ad(e^xi) S = ad(xi) S = -ad(S) xi
    base = (s[..., None, None] * pair.weights) @ -se3.ad(axes)
    if k >= 0:
        screws[:, k] = suspect_screw(pair, screws[:, k])
    # A zero offset turns what is behind it as a turn of the base about the joint's axis would.
    columns = base @ np.swapaxes(screws, 1, 2)[:, None]
    if k >= 0:
        # Behind the suspect joint every change further in front is itself turned about a's axis.
        base[:, k + 1 :] @= se3.adjoint(se3.exp(screws[:, k] * z[:, k, None]))[:, None]
        columns[:, k + 1 :, :, :k] = base[:, k + 1 :] @ np.swapaxes(screws[:, :k], 1, 2)[:, None]
    columns *= (free[:, None] & np.tri(n, k=-1, dtype=bool))[:, :, None]
    J = np.concatenate([base, columns], axis=3) * used[..., None, None]
    r = residuals(pair, axes) * used[..., None]
    return r.reshape(len(z), 6 * n), J.reshape(len(z), 6 * n, 6 + n)
