"""Which completion of an arm is solved most sharply, found by poses whose joints are known."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ....engine.kernels.branches import closed_arm
from ....groups.arrays import Array
from ...chain import Chain
from ..other_frames import without_offset
from .arm_array import arm_array
from .completions import completions
from .joints import Tolerance, joints_of

ROUNDING = 1e-13
"""rad, and m per metre of reach: axes that are parallel or meet within this are so but for rounding."""

# poses, and rad or m: what solutions are within where the arm is far from singular everywhere, and
# where it is not singular
_ASKED = 8
_SHARP = 1e-11
_FOUND = 1e-6


class SharpArm(NamedTuple):
    """The array of `closed_arm` of an arm, and in words the three axes by which it is solved."""

    arm: Array
    words: str


def sharp_arm(chain: Chain) -> SharpArm | None:
    """The arm of a chain of up to six revolute and prismatic joints that is exact but for rounding:
    the first completion that is sharp, else the sharpest one; None where there is none.
    """
    tolerance = Tolerance(ROUNDING, ROUNDING * chain.reach)
    home = without_offset(chain).home
    q, T = _known(chain)
    best = None
    least = _FOUND
    for completion in completions(joints_of(chain), chain.reach, tolerance):
        arm = arm_array(completion, home)
        error = _error(arm, q, T)
        if error < least:
            least = error
            best = SharpArm(arm, completion.words)
        if least < _SHARP:
            break
    return best


def branch_rows(arm: Array, dof: int, T: Array) -> Array:
    """Branches (N, 8, m + 1) of targets (N, 4, 4), coordinates and margin, NaN where there are
    fewer.
    """
    from ....engine.kernels.branches import closed_kernels as kernel  # which imports Numba

    rows = np.empty((len(T), closed_arm.BRANCHES, dof + 1))
    targets = np.array(T, np.float64, order="C")
    kernel.branches_of(arm).call(arm, targets, rows)
    return rows


def _known(chain: Chain) -> tuple[Array, Array]:
    """Configurations and their poses, the same ones every time."""
    rng = np.random.default_rng(0)
    q = rng.uniform(-np.pi, np.pi, (_ASKED, chain.dof))
    slides = np.array(chain.kinds) == "prismatic"
    q[:, slides] *= chain.reach / (2 * np.pi)
    return q, chain.fk(q)


def _error(arm: Array, q: Array, T: Array) -> float:
    """Largest distance of the nearest branch from the configurations that poses were made of; inf
    without any.
    """
    rows = branch_rows(arm, q.shape[1], T)
    off = np.abs(rows[:, :, :-1] - q[:, None])  # angles are from -pi to pi in both
    worst = np.where(np.isnan(off), np.inf, off).max(axis=2)
    return float(worst.min(axis=1).max())
