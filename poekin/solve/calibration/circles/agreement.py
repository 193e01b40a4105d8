"""Whether sweeps of one joint at a time show the same point of the tool."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from ....groups import se3, so3
from ....groups.arrays import Array
from ....groups.vectors import norm, translation_part
from ....model.chain import Chain
from .axis_fit import AxisFit
from .joint_sweep import JointSweep

_TIMES = 5.0  # standard deviations by which the point of a sweep may be off
_ROUNDING = 1e-11  # m: of exact data points are as near


def home_changes(bare: Chain, sweep: JointSweep, back: Array, home: Array) -> Array:
    """Derivative (3, 6n) of where a sweep has the tip at zero, by the screws of the joints.

    Of p_0 = T^-1 p, with dT = [xi] T, it is -(omega x p_0 + v) with (omega, v) = Ad(T^-1) xi.
    """
    xi = bare.screw_derivatives(sweep.q, wrt="components").screws
    twists = se3.adjoint(back) @ xi.reshape(len(back), 6, -1)
    of_twist = np.hstack([so3.hat(home[:3, 3]), -np.eye(3)])
    return of_twist @ twists.mean(axis=0)


def apart(
    fits: Sequence[AxisFit], homes: Sequence[Array], changes: Sequence[Array], covariance: Array
) -> Iterator[str]:
    """Sweeps whose point is elsewhere than that of most, by more than noise explains."""
    places = translation_part(np.array(homes))
    offs = places - np.median(places, axis=0)
    relative = changes - np.mean(changes, axis=0)
    for fit, off, J in zip(fits, offs, relative, strict=True):
        spread = J @ covariance @ J.T + (fit.rms**2 + _ROUNDING**2) * np.eye(3)
        if off @ np.linalg.solve(spread, off) > _TIMES**2:
            yield (
                f"sweep of joint {fit.joint}: its point is {1e3 * norm(off):.3g} mm from that of the "
                "others: another point of the tool, or readings with errors of their own (gain, "
                "gears, coupled joints)"
            )
