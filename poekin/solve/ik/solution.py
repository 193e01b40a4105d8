"""Solutions of inverse kinematics, and the reasons where there are none."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...errors import ShapeError, quote
from ...groups.arrays import Array

SOLVED = "solved"
UNREACHABLE = "unreachable"
LIMITS = "limits"
ITERATIONS = "iterations"
BAD_TARGET = "bad target"
REASONS = (SOLVED, UNREACHABLE, LIMITS, ITERATIONS, BAD_TARGET)
"""All reasons.

- "solved": the pose of q is the target within both tolerances
- "unreachable": the target is beyond the arm's reach, or no try came nearer and all of them had
  come to rest
- "limits": the target can be reached, but only outside the limits of some coordinates
- "iterations": the nearest try was still moving when its iterations ended
- "bad target": the target holds NaN, or infinity
"""


def place(index: tuple[int, ...], shape: tuple[int, ...], what: str) -> int:
    """Index of an element when the batch is made flat. Raises: ShapeError, IndexError."""
    if len(index) != len(shape):
        raise ShapeError(f"{what}: expected an index of {len(shape)} numbers, got {len(index)}")
    return int(np.arange(math.prod(shape)).reshape(shape)[index])


@dataclass(frozen=True, eq=False)
class Solution:
    """One solution for each target; arrays over the batch (...), of the shape () for a single
    target.

    q (..., m), rad or m: where `success` is False, the nearest that was found. success (...): the
    errors are within
    the tolerances. reason (...): one of `REASONS`. position_error (m), rotation_error (rad): of q,
    computed anew by `Chain.fk`; of what the task asks, else 0. iterations and restarts, of all
    tries. distance_beyond_reach (...): how much farther the target is than the arm's reach (m),
    else 0. limits_hit: for each target (in order, the batch made flat) the names of the coordinates whose
    limits are in the way.
    """

    q: Array
    success: np.ndarray
    reason: np.ndarray
    position_error: Array
    rotation_error: Array
    iterations: np.ndarray
    restarts: np.ndarray
    distance_beyond_reach: Array
    limits_hit: tuple[tuple[str, ...], ...] = ()

    def why(self, *index: int) -> str:
        """Reason in words, with its numbers; index of the target in the batch. Raises: ShapeError,
        IndexError.
        """
        flat = place(index, self.success.shape, "why")
        reason = str(self.reason[index])
        position = float(self.position_error[index])
        rotation = float(self.rotation_error[index])
        off = f"{1e3 * position:.4g} mm and {1e3 * rotation:.4g} mrad off"
        if reason == SOLVED:
            return f"solved: {off}"
        if reason == BAD_TARGET:
            return "bad target: it is not made of finite numbers"
        nearest = f"the nearest pose found is {off}"
        if reason == LIMITS:
            names = ", ".join(map(quote, self.limits_hit[flat]))
            return (
                f"limits: solvable without them, in the way are those of {names}; "
                f"within them {nearest}"
            )
        if reason == ITERATIONS:
            return f"iterations: the nearest try was still moving when they ended; {nearest}"
        beyond = self.distance_beyond_reach[index]
        if beyond > 0:
            return (
                f"unreachable: the target is farther than the arm's reach by {beyond:.4g} m; "
                f"{nearest}"
            )
        return f"unreachable: {nearest}"

    def __repr__(self) -> str:
        if self.success.ndim == 0:
            return f"<Solution {self.why()}: q = {self.q.tolist()}>"
        solved = int(self.success.sum())
        others = {reason: int((self.reason == reason).sum()) for reason in REASONS[1:]}
        rest = "".join(f", {count} {reason}" for reason, count in others.items() if count)
        return f"<Solution {solved} of {self.success.size} solved{rest}>"
