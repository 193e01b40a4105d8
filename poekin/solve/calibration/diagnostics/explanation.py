"""Explanations of measurements that the nominal arm misses by far: another base, tool or arm.

Remarks with figures: the nominal arm is fitted with base and tool free, as to a camera and a board.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ....errors import InputError, quote
from ....groups import se3, so3
from ....groups.arrays import Array
from ....groups.vectors import norm, rotation_part, translation_part
from ..fit import initial_guess
from ..fit.fitting import fit_parameters
from ..fit.initial_guess import MISFIT
from ..fit.minimise import FitOptions
from ..measurements.measurement import Measurement
from ..measurements.points import Distances, Points
from ..measurements.poses import EyeInHand, Poses
from ..model.error_model import ErrorModel
from ..model.problem import Problem
from ..model.residuals import Residuals
from .identification import identify_directions
from .units import LARGE

TOOL = 0.03
TURN = 0.1
"""A tool that is off by more (reaches, rad) is another one, where it is off by more than the arm
itself, too.
"""
_MORE = 4.0  # times what is left by the arm itself
_ROUNDING = 1e-11
_WHOLE = 0.1  # m or rad from which on figures are not told in thousandths
_HINTS: dict[type[Measurement], str] = {
    Poses: "poses between a camera and a board, or a device and its target, are EyeInHand or"
    " EyeToHand (kind eye-in-hand or eye-to-hand), which estimate both frames jointly and leave the"
    " arm its own base and tip",
    Points: "points= says which point of the tool is measured, and frame='unknown' that it is in a"
    " device's own frame",
    Distances: "point= says of which point of the tool they are, and centre=None that it is not"
    " known from where",
}
_TOOL = "take the tip whose pose was measured, or put the tool on that it has (retooled)"


class Size(NamedTuple):
    """Size of an error: m, and rad, NaN where nothing turns."""

    length: float
    angle: float = math.nan

    def __str__(self) -> str:
        length = _short(self.length, "m")
        if math.isnan(self.angle):
            return length
        return f"{length} and {_short(self.angle, 'rad')}"


class Explanation(NamedTuple):
    """Motion of base and tool (None where one was free anyway), and the median error that is left
    then.
    """

    base: Size | None
    tool: Size | None
    left: Size

    def __str__(self) -> str:
        if self.base is None:
            return f"tool moved by {self.tool}"
        if self.tool is None:
            return f"base moved by {self.base}"
        return f"base moved by {self.base}, tool by {self.tool}"


class Remarks(NamedTuple):
    """Warnings, and remarks on what is as it should be as often as not."""

    warnings: tuple[str, ...]
    remarks: tuple[str, ...]


def explain(problem: Problem, before: Residuals, after: Residuals) -> Remarks:
    """Warnings and remarks on each set that the nominal arm misses by far and the calibrated one
    does not.

    A base that is elsewhere is a remark: a tracker stands anywhere. A tool or an arm that is
    another is a warning.
    """
    warnings = []
    remarks = []
    arm = problem.model.nominal
    for k, s in enumerate(problem.sets):
        was = median(before, k)
        now = median(after, k)
        if not far(was, arm.reach) or far(now, arm.reach):
            continue
        which = ""
        if len(problem.sets) > 1:
            which = f"measurement set {k} ({s.what}): "
        head = f"{which}the nominal arm is off by {was} (median), the calibrated one by {now}"
        found = explained(problem, k)
        if found is None or far(found.left, arm.reach):
            # of lengths without an initial guess of where they are from nothing more is known
            why = ""
            if found is not None or s.angular:
                why = ", and no other base and tool explain it"
            warnings.append(
                f"{head}{why}: is it this arm, in its order of joints, are lengths in m and angles "
                "in rad? compare() says which joints changed"
            )
        elif found.base is None or _is_other_tool(found, arm.reach):
            warnings.append(
                f"{head}: {found}; the calibrated arm's frames are then other ones than base "
                f"{quote(arm.base)} and tip {quote(arm.tip)}; {hint(s, found, arm.reach)}"
            )
        else:
            where = f"base moved by {found.base}, to the frame that was measured in"
            remarks.append(f"{head}: {where}; {hint(s, found, arm.reach)}")
    return Remarks(tuple(warnings), tuple(remarks))


def set_name(sets: Sequence[Measurement], k: int, alone: str) -> str:
    """Name of set k in messages: `alone` and its kind where there is no other set."""
    what = sets[k].what
    if len(sets) > 1:
        return f"measurement set {k} ({what})"
    return f"{alone} {what}"


def median(r: Residuals, k: int) -> Size:
    """The median errors of set k."""
    mine = r.of_set(k)
    return Size(mine.median_length, mine.median_angle)


def far(size: Size, reach: float) -> bool:
    """Whether that is more than any arm is off."""
    return size.length > LARGE * reach or size.angle > MISFIT


def hint(s: Measurement, found: Explanation, reach: float) -> str:
    """Advice on how to say that base or tool are others, of measurements that take them for the
    arm's.
    """
    if isinstance(s, Poses) and found.base and found.tool and not far(found.base, reach):
        return _TOOL
    return next(words for kind, words in _HINTS.items() if isinstance(s, kind))


def explained(problem: Problem, k: int) -> Explanation | None:
    """The nominal arm's fit of set k with base and tool free; None where both are anyway, or cannot
    be found.
    """
    s = problem.sets[k]
    base_free = s.frame == "unknown"
    tool_free = len(s.unknown_frames) > base_free
    try:
        own = _with_free_base_and_tool(problem, k)
    except InputError:
        return None
    if own is None or (base_free and tool_free):
        return None
    free = identify_directions(own)[1]
    fit = fit_parameters(own, free, np.zeros(own.size), FitOptions("huber"))
    base, *moving = own.frame_values(fit.p).values()
    where = moved = None
    if not base_free:
        where = _base(s, base)
    if not tool_free:
        tool = se3.exp(fit.p[: own.model_size])
        for T in moving:
            tool = tool @ T
        moved = size_of(tool)
        if s.width <= 3:  # one point does not tell how the tool is turned
            moved = Size(moved.length)
    left = median(own.residuals(fit.p), 0)
    return Explanation(where, moved, left)


def _with_free_base_and_tool(problem: Problem, k: int) -> Problem | None:
    """The problem of set k and the nominal arm, with base and tool free. Raises: InputError."""
    s = problem.sets[k]
    arm = problem.model.nominal
    q = problem.q[problem.rows[k]]
    tool = ErrorModel(arm, ("home",), None)
    if isinstance(s, Poses):
        return Problem(tool, q, [_poses(arm.fk(q), s.T)])
    if isinstance(s, Points):
        return Problem(tool, q, [Points(s.p, s.points, frame="unknown")])
    if isinstance(s, Distances):
        return Problem(tool, q, [Distances(s.d, None, s.point)])
    return None


def _base(s: Measurement, base: Array) -> Size:
    """Motion of the base that was found."""
    if isinstance(s, Distances):
        return Size(norm(base - s.centre))
    return size_of(base)


def _poses(T: Array, measured: Array) -> EyeInHand:
    """Poses in a base and of a tool that are free, with an initial guess for arms that do not turn
    about two axes, too.
    """
    try:
        base, tool = initial_guess.hand_eye(T, measured)
    except InputError:
        base = initial_guess.mean_pose(T @ se3.inverse(measured))
        tool = np.eye(4)
    return EyeInHand(measured, board=base, camera=tool)


def _is_other_tool(found: Explanation, reach: float) -> bool:
    """Whether the tool is another one."""
    tool = found.tool
    left = found.left
    if tool is None:
        return False
    shifted = tool.length > max(TOOL * reach, _MORE * left.length)
    return shifted or tool.angle > np.fmax(TURN, _MORE * left.angle)


def size_of(T: Array) -> Size:
    """Distance and angle by which a pose (4, 4) moves its frame."""
    return Size(
        norm(translation_part(T)),
        norm(so3.log(rotation_part(T))),
    )


def _short(value: float, unit: str) -> str:
    if value >= _WHOLE:
        return f"{value:.3g} {unit}"
    return f"{1e3 * value if value > _ROUNDING else 0:.3g} m{unit}"
