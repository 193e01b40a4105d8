"""Result of `from_circles`: the arm, and how well each axis is known."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

from ....groups.arrays import Array
from ....model.chain import Chain
from ....results import Result
from .axis_fit import AxisFit


@dataclass(frozen=True, eq=False)
class FromCircles(Result):
    """Arm from sweeps of one joint at a time.

    Attributes
    ----------
    chain : Chain
        The arm; its base is the frame of the measurements.
    covariance : (6n, 6n) ndarray
        Covariance of the numbers of `chain.screws`, row by row; of 1 and m.
    axes : tuple of AxisFit
        Axis of each joint as its own sweep shows it: arc, radius, deviations, residual.
    warnings : tuple of str
        Sweeps that do not agree with the others.
    """

    left_out: ClassVar = ("chain",)

    chain: Chain
    covariance: Array = field(repr=False)
    axes: tuple[AxisFit, ...] = field(repr=False)
    warnings: tuple[str, ...] = ()

    def summary(self) -> str:
        """Axes and how well they are known, as text, in mrad and mm."""
        lines = [f"{len(self.axes)} axes from sweeps of one joint each"]
        for name, axis in zip(self.chain.joint_names, self.axes, strict=True):
            lines.append(f"{name}: {axis.summary()}")
        return "\n".join([*lines, *self.warnings])
