"""The least-squares alignment of two arms' axes: Levenberg-Marquardt over a base pose and some zero
offsets.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ....groups import se3
from ....groups.arrays import Array
from ....groups.vectors import applied
from ...axis_lines import Marks
from .alignments import Alignments, Rows
from .lines import Sides

STEPS = 60


@dataclass(frozen=True, eq=False)
class Linearised(Rows):
    """Alignments, their residuals r (m, 6 n) and Jacobians J (m, 6 n, 6 + n), and costs r · r (m)."""

    at: Alignments
    r: Array
    J: Array
    cost: Array


def fit(
    pair: Sides,
    starts: Alignments,
    free: Marks | bool,
    used: Marks | Array | bool,
) -> Alignments:
    """The alignments that bring b's axes nearest to a's, from m starts.

    Least squares of direction and place, each in tolerances, over the axes in `used` (n) or (m, n),
    which may be their shares; zero offsets move where `free` (n) or (m, n, bool) says so: True is
    all, False none. What the axes leave free stays where it starts. All starts are stepped at once,
    each with a damping of its own and until it is done.
    """
    shape = starts.z.shape
    free = np.broadcast_to(free, shape)
    counted = np.where(pair.alike, used, 0.0)
    shares = np.broadcast_to(counted, shape)
    everywhere = np.arange(len(starts))
    best = _linearised(pair, starts[everywhere], free, shares)
    damping = np.full(len(starts), 1e-6)
    going = best.cost >= 1e-16
    for _ in range(STEPS):
        (live,) = np.nonzero(going)
        if not len(live):
            break
        here = best[live]
        held = damping[live]
        steps = _step(here.r, here.J, held)
        change = applied(here.J, steps)
        slope = -(here.r * change).sum(1)
        tried = here.at.moved(steps)
        trial = _linearised(pair, tried, free[live], shares[live])
        least = 1e-12 * here.cost
        better = trial.cost < here.cost
        gains = here.cost - trial.cost >= least
        worth_while = gains & (trial.cost >= 1e-16)
        # Where a step promises nothing, neither does a shorter one.
        promising = (slope >= least) & (held <= 1e3)
        going[live] = np.where(better, worth_while, promising)
        eased = np.maximum(held / 10, 1e-14)
        damping[live] = np.where(better, eased, held * 10)
        best[live[better]] = trial[better]
    return best.at


def _step(r: Array, J: Array, damping: Array) -> Array:
    """The steps (m, 6 + n) that lessen residuals r (m, rows) most, held back in proportion to the
    damping (m,).
    """
    scale = np.linalg.norm(J, axis=1)
    most = scale.max(axis=1, keepdims=True)
    scale = np.where(scale < 1e-6 * most, most, scale)
    scale[scale == 0] = 1.0  # where nothing is to be moved
    held = np.sqrt(damping)[:, None] * scale
    m, rows, columns = J.shape
    # The factor R of the system beside its right side holds both triangular.
    system = np.zeros((m, rows + columns, columns + 1))
    system[:, :rows, :-1] = J
    system[:, :rows, -1] = -r
    system[:, rows:, :-1] = held[:, None] * np.eye(columns)
    triangular = np.asarray(np.linalg.qr(system, mode="r"))
    R = triangular[:, :columns]
    steps = np.linalg.solve(R[..., :-1], R[..., -1:])
    return steps.squeeze(-1)


def _linearised(
    pair: Sides,
    at: Alignments,
    free: Marks,
    used: Array,
) -> Linearised:
    """Residuals at alignments, and their derivatives by the base's pose and by the zero offsets.

    Those of axes that are not used and by zero offsets that are not free are 0.
    """
    b = pair.transformed(at)
    screws = b.screws
    k = pair.suspect_joint
    # d Ad(e^xi) S = ad(xi) S = -ad(S) xi
    weights = b.signs[..., None, None] * pair.weights
    base = weights @ -se3.ad(b.axes)
    if k >= 0:
        screws[:, k] = pair.suspect_screw(screws[:, k])
    # A zero offset turns what is behind it as a turn of the base about the joint's axis would.
    columns = base @ screws.swapaxes(1, 2)[:, None]
    if k >= 0:
        # Behind the suspect joint every change further in front is itself turned about a's axis.
        behind = slice(k + 1, None)
        turn = se3.exp(screws[:, k] * at.z[:, k, None])
        carried = base[:, behind] @ se3.adjoint(turn)[:, None]
        base[:, behind] = carried
        in_front = screws[:, :k].swapaxes(1, 2)
        columns[:, behind, :, :k] = carried @ in_front[:, None]
    earlier = np.tri(pair.n, k=-1, dtype=bool)
    moved = free[:, None] & earlier
    columns *= moved[:, :, None]
    J = np.concatenate([base, columns], axis=3)
    J *= used[..., None, None]
    shape = len(at), 6 * pair.n
    residuals = b.residuals * used[..., None]
    r = residuals.reshape(shape)
    cost = (r * r).sum(1)
    jacobian = J.reshape(*shape, J.shape[-1])
    return Linearised(at, r, jacobian, cost)
