"""Targets with all their solutions, found in Python: what an emitted self-test compares to."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ....formulas.inverse import confirmed
from ....groups.arrays import Array
from ....model.chain import Chain
from .closed_arm import ClosedArm

COUNT = 8
TOLERANCE = 1e-9
_DRAWN = 200
_CLEAR = 1e-3
"""Margin of each branch, and least singular value of the Jacobian over the reach: a solution is right
to some 1e-14 over it.
"""


class Targets(NamedTuple):
    """Poses T (N, 4, 4), and of each its solutions (s, m); the last is out of reach, unless
    a prismatic joint goes there.
    """

    T: Array
    solutions: list[Array]


def solutions(chain: Chain, form: ClosedArm, sizes: Array, T: Array) -> Array:
    """Solutions (s, m) of one pose, by the functions that are written as C, compiled by Numba
    or as they are.
    """
    branches = form.branches(T)
    m = chain.dof
    q = np.empty((form.rows, m))

    def forward(x: Array, T_x: Array, J: Array) -> None:
        T_x[:], J[:] = chain.fk_jacobian(x, "hybrid")

    def placed(branch: Array, T_x: Array) -> None:
        T_x[:] = chain.fk(branch[:m])

    with np.errstate(all="ignore"):
        found = confirmed.select(
            forward, placed, T, branches, sizes, np.empty((4, 4)), np.empty((m + 8, m)), q
        )
    return q[:found]


def targets(chain: Chain, form: ClosedArm, sizes: Array) -> Targets:
    """Targets away from where solutions meet, as far as the arm has such."""
    drawn = list(itertools.islice(_drawn(chain, form, sizes), COUNT))
    away = chain.fk(np.zeros(chain.dof))
    away[0, 3] += 4.0 * chain.reach
    found = solutions(chain, form, sizes, away)
    if not len(found) or _is_clear(chain, form, away, found):
        drawn.append((away, found))
    return Targets(np.array([T for T, _ in drawn]), [found for _, found in drawn])


def _drawn(chain: Chain, form: ClosedArm, sizes: Array) -> Iterator[tuple[Array, Array]]:
    """Targets that are clear, and their solutions."""
    rng = np.random.default_rng(1994)
    half = np.where(sizes[: chain.dof] > 0.0, np.pi, 1.0)
    for _ in range(_DRAWN):
        pose = chain.fk(rng.uniform(-half, half))
        found = solutions(chain, form, sizes, pose)
        if _is_clear(chain, form, pose, found):
            yield pose, found


def _is_clear(chain: Chain, form: ClosedArm, pose: Array, found: Array) -> bool:
    margins = form.branches(pose)[:, -1]
    if not (np.abs(margins[np.isfinite(margins)]) > _CLEAR).all():
        return False
    J = chain.jacobian(found, "hybrid")
    J[:, 3:] /= chain.reach
    return bool((np.linalg.svd(J, compute_uv=False)[:, -1] > _CLEAR).all())
