"""Solutions of inverse kinematics, and the reasons where there are none."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...errors import ShapeError, quote
from ...groups.arrays import Array
from ...model.chain import Chain
from ...results import Result
from .task import TaskNames

SOLVED = "solved"
UNREACHABLE = "unreachable"
LIMITS = "limits"
ITERATIONS = "iterations"
BAD_TARGET = "bad target"
REASONS = (SOLVED, UNREACHABLE, LIMITS, ITERATIONS, BAD_TARGET)
"""All reasons, as `Solution.reason` explains them."""

FAR = 30.0
"""Distance beyond the reach, m, that no tool goes to, and one in mm taken for m has."""

Names = tuple[str, ...]


def place(index: tuple[int, ...], shape: tuple[int, ...], what: str) -> int:
    """Index of an element when the batch is made flat. Raises: ShapeError, IndexError."""
    if len(index) != len(shape):
        raise ShapeError(f"{what}: expected an index of {len(shape)} numbers, got {len(index)}")
    return int(np.arange(math.prod(shape)).reshape(shape)[index])


@dataclass(frozen=True, eq=False)
class Solution(Result):
    """One solution for each target, by `ik`; arrays over the batch (...), () for a single target.

    Attributes
    ----------
    q : (..., m) ndarray
        Coordinates, rad or m: where `success` is False, the nearest that was found.
    success : (...) ndarray of bool
        Whether both errors are within the tolerances.
    reason : (...) ndarray of str
        "solved"; "unreachable", beyond the arm's reach, or no try came nearer and all of them had
        come to rest; "limits", solvable, but as far as these tries see only outside the limits of
        some coordinates; "iterations", the nearest try was still moving when its iterations ended;
        "bad target", NaN or infinity in it.
    position_error, rotation_error : (...) ndarray
        Errors of q, m and rad, computed anew by `Chain.fk`; 0 for what the task does not ask.
    iterations, restarts : (...) ndarray of int
        Numbers of steps and of restarts, of all tries.
    distance_beyond_reach : (...) ndarray
        Distance of the target beyond the arm's reach, m; 0 within it.
    limits_hit : tuple of tuple of str
        Names of the coordinates whose limits are in the way, or of the joints whose own are, for
        each target of the batch in C order; empty where all are solved.
    reachable_tasks : tuple of tuple of str
        Tasks that reach the target of an arm with too few coordinates for the one asked, for each
        target in C order; empty where it has enough, or all are solved.
    chain : Chain or None
        The arm; None of a result that was put together by hand.
    target : (..., 4, 4) ndarray or None
        Target poses of the tip in the base frame, m.
    """

    left_out = ("chain", "target")

    q: Array
    success: np.ndarray
    reason: np.ndarray
    position_error: Array
    rotation_error: Array
    iterations: np.ndarray
    restarts: np.ndarray
    distance_beyond_reach: Array
    limits_hit: tuple[Names, ...] = ()
    reachable_tasks: tuple[TaskNames, ...] = ()
    chain: Chain | None = None
    target: Array | None = None

    def summary(self, *index: int) -> str:
        """Reason of one target with its numbers, or how many targets of a batch have which.

        Parameters
        ----------
        *index : int
            Index of a target in the batch; without it, all targets are counted.

        Returns
        -------
        text : str
            Lengths in mm, angles in degrees.

        Raises
        ------
        ShapeError
            If the index has not as many numbers as the batch has axes.
        IndexError
            If there is no such target.
        """
        if self.success.ndim and not index:
            return self._counts()
        flat = place(index, self.success.shape, "summary")
        reason = str(self.reason[index])
        off = f"{1e3 * self.position_error[index]:.4g} mm"
        off += f" and {np.degrees(self.rotation_error[index]):.4g}° off"
        if reason == SOLVED:
            return f"solved: {off}"
        if reason == BAD_TARGET:
            return "bad target: it is not made of finite numbers"
        nearest = f"the nearest pose found is {off}"
        if np.isnan(self.position_error[index]):
            nearest = "there is no nearest pose: the numbers are too large"
        return f"{reason}: {self._cause(reason, index, flat)}{nearest}{self._others(flat)}"

    def _counts(self) -> str:
        solved = int(self.success.sum())
        others = {reason: int((self.reason == reason).sum()) for reason in REASONS[1:]}
        rest = "".join(f", {count} {reason}" for reason, count in others.items() if count)
        return f"{solved} of {self.success.size} solved{rest}"

    def _cause(self, reason: str, index: tuple[int, ...], flat: int) -> str:
        beyond = self.distance_beyond_reach[index]
        if reason == LIMITS:
            names = ", ".join(map(quote, self.limits_hit[flat]))
            return f"solvable without them, in the way are those of {names}; "
        if reason == ITERATIONS:
            return "the nearest try was still moving when they ended; "
        if beyond > FAR:
            return (
                f"the target is {beyond:.4g} m beyond the arm's reach, as one in millimetres would"
                " be; poses are in m (of files in mm, --mm says so); "
            )
        if beyond > 0:
            return f"the target is farther than the arm's reach by {1e3 * beyond:.4g} mm; "
        return ""

    def _others(self, flat: int) -> str:
        """Tasks that the arm can do, where it has too few coordinates for the one asked."""
        tasks = self.reachable_tasks[flat] if self.reachable_tasks else ()
        if not tasks:
            return ""
        named = " or ".join(f"task={task!r}" for task in tasks)
        return f"; with so few coordinates the arm reaches this target only with {named}"

    def __repr__(self) -> str:
        joints = f": q = {self.q.tolist()}" * (self.success.ndim == 0)
        return f"<Solution {self.summary()}{joints}>"
