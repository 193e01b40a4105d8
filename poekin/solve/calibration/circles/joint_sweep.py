"""JointSweep: what was measured while one joint moved and all others stood."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal, get_args

import numpy as np

from ....checks import choice, whole
from ....errors import InputError, ShapeError
from ....groups.arrays import Array
from ....groups.vectors import translation_part
from ....model.checks import finite, read_only
from ....results import brief
from ..measurements.measurement import Measurement, pose_rows
from ..measurements.points import Points
from ..measurements.poses import Poses

SweepKind = Literal["revolute", "prismatic"]
HELD = 1e-4
"""rad or m: joints whose readings stay within it stand."""
MOST = 4.0 * np.pi
"""rad: no sweep is longer than two turns, one in degrees is."""
_LEAST = {"revolute": (4, 3), "prismatic": (3, 2)}  # readings of points and of poses


@dataclass(frozen=True, eq=False)
class JointSweep:
    """Measurements made while one joint moved and all others stood.

    Parameters
    ----------
    joint : int
        Number of the joint that moved, counted from 0 at the base.
    q : (N, n) array_like
        Readings of all joints, rad or m. At least 4 of points (3 of a joint that slides), or 3 (2)
        of poses.
    measured : (N, 3) or (N, 4, 4) array_like
        Positions of one point of the tool, or poses of the tool, in the frame of the measuring
        device, m: the same point, or tool, in all sweeps.
    kind : {"revolute", "prismatic"}, default "revolute"
        Kind of the joint.

    Raises
    ------
    ShapeError
        If an array has another shape.
    PoseError
        If an element is no pose.
    InputError
        If a number is not finite, the joint is none of these, rows are too few, the joint did not
        move or another one did, or the readings are in degrees.

    Examples
    --------
    >>> import numpy as np
    >>> import poekin as pk
    >>> q = np.zeros((9, 6))
    >>> q[:, 2] = np.linspace(-1, 1, 9)
    >>> p = pk.load("ur5").chain().fk(q)[:, :3, 3]
    >>> len(pk.calibration.JointSweep(2, q, p).readings)
    9
    """

    joint: int
    q: Any
    measured: Any
    kind: SweepKind = "revolute"

    def __post_init__(self) -> None:
        whole(self.joint, "joint", 0)
        choice(self.kind, get_args(SweepKind), "kind")
        what = f"sweep of joint {self.joint}"
        q = finite(self.q, f"{what}: q")
        if q.ndim != 2 or q.shape[1] <= self.joint:
            raise ShapeError(
                f"{what}: q: expected readings (N, n) of more than {self.joint} joints, got shape "
                f"{q.shape}"
            )
        measured = finite(self.measured, f"{what}: measured")
        if measured.ndim == 3:
            measured = pose_rows(measured, f"{what}: measured")
        if measured.shape not in ((len(q), 3), (len(q), 4, 4)):
            raise ShapeError(
                f"{what}: measured: expected points ({len(q)}, 3) or poses ({len(q)}, 4, 4), one a "
                f"row of q, got shape {measured.shape}"
            )
        of_points, of_poses = _LEAST[self.kind]
        least = of_points if measured.ndim == 2 else of_poses
        if len(q) < least:
            raise InputError(f"{what}: expected {least} readings or more, got {len(q)}")
        self._check_moves(np.ptp(q, axis=0), what)
        object.__setattr__(self, "q", read_only(q))
        object.__setattr__(self, "measured", read_only(measured))

    def _check_moves(self, spans: Array, what: str) -> None:
        """Refuse a joint that stood, others that did not, and degrees."""
        own = float(spans[self.joint])
        if own <= HELD:
            raise InputError(f"{what}: its readings stay within {own:.3g}, it did not move")
        if self.kind == "revolute" and own > MOST:
            raise InputError(f"{what}: its readings span {own:.3g} rad: are they in degrees?")
        moved = np.flatnonzero(spans > HELD)
        others = moved[moved != self.joint]
        if len(others):
            j = int(others[0])
            raise InputError(
                f"{what}: joint {j} moved, too, by {spans[j]:.3g} (rad or m); expected all others "
                f"to stand within {HELD:g}"
            )

    def __repr__(self) -> str:
        what = "poses" if self.has_poses else "points"
        span = float(np.ptp(self.readings))
        unit = "m" if self.kind == "prismatic" else "rad"
        return brief(self, f"joint {self.joint}, {len(self.q)} {what} over {span:.3g} {unit}")

    @property
    def readings(self) -> Array:
        """Readings (N,) of the joint that moved, rad or m, from their middle."""
        own = self.q[:, self.joint]
        return own - 0.5 * (own.min() + own.max())

    @property
    def has_poses(self) -> bool:
        """Whether poses were measured, and not points."""
        return self.measured.ndim == 3

    @property
    def positions(self) -> Array:
        """Positions (N, 3) of the point or of the tool, m."""
        return translation_part(self.measured) if self.has_poses else self.measured

    @property
    def measurements(self) -> Measurement:
        """The measurements as a calibration takes them."""
        return Poses(self.measured) if self.has_poses else Points(self.measured)
