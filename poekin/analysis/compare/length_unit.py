"""Two models in different length units: millimetres in one of them where the other has metres."""

from __future__ import annotations

import numpy as np

from ...groups.vectors import norm
from ...model.chain import Chain
from ..axis_lines import prismatic, uncoupled_at_zero
from .alignment.lines import lines

RATIO = 1000.0
SPAN = 5.0
"""The spread of an arm's axes differs by a factor of up to 2.6 between zero positions, measured
over nine arms.
"""
SPREAD_M = 0.17
"""Arms whose axes are millimetres to metres apart are on the same side of it, in m, as a wrong unit
puts them.
"""


def length_ratio(a: Chain, b: Chain) -> float:
    """Lengths of b by lengths of a where a factor of 1000 is suspected: 1000 or 0.001; 1 otherwise."""
    ours = _spread(a)
    theirs = _spread(b)
    for ratio in (RATIO, 1 / RATIO):
        if ours * ratio / SPAN < theirs < ours * ratio * SPAN:
            return ratio
    return 1.0


def to_one_unit(
    a: Chain,
    b: Chain,
    ratio: float,
) -> tuple[Chain, Chain]:
    """Both chains, the one rescaled whose lengths are the less likely in metres, so that tolerances
    keep their size.
    """
    larger_is_wrong = _spread(a) * _spread(b) > SPREAD_M**2
    if larger_is_wrong == (ratio > 1):
        return a, rescaled(b, 1 / ratio)
    return rescaled(a, ratio), b


def rescaled(chain: Chain, factor: float) -> Chain:
    """The chain with all its lengths multiplied by a factor."""
    slides = prismatic(chain)
    joints = np.where(slides, factor, 1.0)
    angles = [chain.is_angle(k) for k in range(chain.dof)]
    coordinates = np.where(angles, 1.0, factor)
    # A prismatic joint's screw is a direction: there the joint variable is the length.
    screws = chain.screws.copy()
    home = chain.home.copy()
    screws[~slides, 3:] *= factor
    home[:3, 3] *= factor
    coupling = chain.nontrivial_coupling
    if coupling is not None:
        coupling = joints[:, None] * coupling / coordinates
    return chain.replace(
        screws=screws,
        home=home,
        pitches=chain.pitches * factor,
        limits=chain.limits * coordinates[:, None],
        velocity_limits=chain.velocity_limits * coordinates,
        joint_limits=chain.joint_limits * joints[:, None],
        joint_velocity_limits=chain.joint_velocity_limits * joints,
        coupling=coupling,
        offset=chain.offset * joints,
    )


def _spread(chain: Chain) -> float:
    """Root sum of squares of the distances (m) of all axes to the point nearest to them."""
    return norm(lines(uncoupled_at_zero(chain)).places)
