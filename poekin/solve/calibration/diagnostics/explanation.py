"""What explains measurements that the nominal arm misses by far: another base, another tool, or an
arm that is another.

Told with figures: the nominal arm is fitted with base and tool free, as to a camera and a board.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ....errors import InputError, quote
from ....groups import se3, so3
from ....groups.arrays import Array
from ..fit import initial_guess
from ..fit.fitting import fitted
from ..fit.initial_guess import MISFIT
from ..measurements.measurement import Measurement
from ..measurements.points import Distances, Points
from ..measurements.poses import EyeInHand, Poses
from ..model.parameters import Arm
from ..model.problem import Problem
from ..model.residuals import Residuals, residuals
from .identification import judged
from .units import LARGE

TOOL, TURN = 0.03, 0.1
"""A tool that is off by more (reaches, rad) is another one, where it is off by more than the arm
itself, too.
"""
_MORE = 4.0  # times what is left by the arm itself
_ROUNDING = 1e-11
_WHOLE = 0.1  # m or rad from which on figures are not told in thousandths
_HINTS: dict[type[Measurement], str] = {
    Poses: "poses between a camera and a board, or a device and its target, are EyeInHand or EyeToHand (kind"
    " eye-in-hand or eye-to-hand), which solve both frames along and leave the arm its own base and tip",
    Points: "points= says which point of the tool is measured, and frame='unknown' that it is in a device's own frame",
    Distances: "point= says of which point of the tool they are, and centre=None that it is not known from where",
}
_TOOL = "take the tip whose pose was measured, or put the tool on that it has (retooled)"


class Size(NamedTuple):
    """How far something is off: m, and rad, None where nothing turns."""

    length: float
    angle: float | None

    def __str__(self) -> str:
        words = [_short(self.length, "m")] + (
            [] if self.angle is None else [_short(self.angle, "rad")]
        )
        return " and ".join(words)


class Explanation(NamedTuple):
    """How far base (None where it was free anyway) and tool moved, and the median error that is
    left then.
    """

    base: Size | None
    tool: Size
    left: Size

    def __str__(self) -> str:
        base = "" if self.base is None else f"base moved by {self.base}, "
        return f"{base}tool {'' if base else 'moved '}by {self.tool}"


class Told(NamedTuple):
    """Words: warnings, and remarks on what is as it should be as often as not."""

    warnings: tuple[str, ...]
    remarks: tuple[str, ...]


def told(problem: Problem, before: Residuals, after: Residuals) -> Told:
    """What there is to say of each set that the nominal arm misses by far and the calibrated one
    does not.

    A base that is elsewhere is a remark: a tracker stands anywhere. A tool or an arm that is
    another is a warning.
    """
    warnings, remarks, arm = [], [], problem.arm.nominal
    for k, s in enumerate(problem.sets):
        was, now = median(before, k, s), median(after, k, s)
        if not far(was, arm.reach) or far(now, arm.reach):
            continue
        which = f"measurement set {k} ({s.what}): " if len(problem.sets) > 1 else ""
        head = f"{which}the nominal arm is off by {was} (median), the calibrated one by {now}"
        found = explained(problem, k)
        if found is None or far(found.left, arm.reach):
            # of lengths without a first guess of where they are from nothing more is known
            why = (
                ", and no other base and tool explain it" if found is not None or s.angular else ""
            )
            warnings.append(
                f"{head}{why}: is it this arm, in its order of joints, are lengths in m and angles in rad? compare()"
                " says which joints changed"
            )
        elif found.base is None or _another(found, arm.reach):
            warnings.append(
                f"{head}: {found}; the calibrated arm's frames are then other ones than base {quote(arm.base)} and tip"
                f" {quote(arm.tip)}; {hint(s, found, arm.reach)}"
            )
        else:
            where = f"base moved by {found.base}, to the frame that was measured in"
            remarks.append(f"{head}: {where}; {hint(s, found, arm.reach)}")
    return Told(tuple(warnings), tuple(remarks))


def median(r: Residuals, k: int, s: Measurement) -> Size:
    """The median errors of set k."""
    mine = r.set == k
    return Size(
        float(np.median(r.length[mine])), float(np.median(r.angle[mine])) if s.angular else None
    )


def far(size: Size, reach: float) -> bool:
    """Whether that is more than any arm is off."""
    return size.length > LARGE * reach or (size.angle or 0.0) > MISFIT


def hint(s: Measurement, found: Explanation, reach: float) -> str:
    """How to say that base or tool are others, of measurements that take them for the arm's."""
    if isinstance(s, Poses) and found.base is not None and not far(found.base, reach):
        return _TOOL
    return next(words for kind, words in _HINTS.items() if isinstance(s, kind))


def explained(problem: Problem, k: int) -> Explanation | None:
    """How the nominal arm fits set k with base and tool free; None where both are anyway, or cannot
    be found.
    """
    s, arm, q = problem.sets[k], problem.arm.nominal, problem.q[problem.rows[k]]
    tool = Arm(arm, ("home",), None)
    try:
        if isinstance(s, Poses):
            own = Problem(tool, q, [_poses(arm.fk(q), s.T)])
        elif isinstance(s, Points):
            own = Problem(tool, q, [Points(s.p, s.points, frame="unknown")])
        elif isinstance(s, Distances):
            own = Problem(tool, q, [Distances(s.d, None, s.point)])
        else:
            return None
    except InputError:
        return None
    fit = fitted(own, judged(own)[1], "huber", np.zeros(own.size), None)
    base, *moving = own.placed(fit.p)
    T = se3.exp(fit.p[: own.arm_size]) @ (moving[0] if moving else np.eye(4))
    left = median(residuals(own.sets, own.rows, own.errors(fit.p)), 0, own.sets[0])
    if s.unknowns:
        there = None
    else:
        there = (
            Size(float(np.linalg.norm(base - s.centre)), None)
            if isinstance(s, Distances)
            else _size(base)
        )
    turned = s.width > 3  # one point does not tell how the tool is turned
    return Explanation(there, _size(T) if turned else _size(T)._replace(angle=None), left)


def _poses(T: Array, measured: Array) -> EyeInHand:
    """Poses in a base and of a tool that are free, with a first guess for arms that do not turn
    about two axes, too.
    """
    try:
        base, tool = initial_guess.hand_eye(T, measured)
    except InputError:
        base, tool = initial_guess.mean_pose(T @ se3.inverse(measured)), np.eye(4)
    return EyeInHand(measured, board=base, camera=tool)


def _another(found: Explanation, reach: float) -> bool:
    """Whether the tool is another one."""
    tool, left = found.tool, found.left
    shifted = tool.length > max(TOOL * reach, _MORE * left.length)
    return shifted or (tool.angle or 0.0) > max(TURN, _MORE * (left.angle or 0.0))


def _size(T: Array) -> Size:
    return Size(float(np.linalg.norm(T[:3, 3])), float(np.linalg.norm(so3.log(T[:3, :3]))))


def _short(value: float, unit: str) -> str:
    return (
        f"{value:.3g} {unit}"
        if value >= _WHOLE
        else f"{1e3 * value if value > _ROUNDING else 0:.3g} m{unit}"
    )
