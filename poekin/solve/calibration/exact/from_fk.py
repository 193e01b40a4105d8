"""`from_fk`: the screws of an arm from pairs (q, T) of a controller's own forward kinematics."""

from __future__ import annotations

from typing import Any, NamedTuple

from ....errors import InputError, quote
from ....groups.arrays import Array
from ....model.chain import Chain
from ....model.kinematics.arm import Arm, chain_of
from ..calibrate import calibrate
from ..calibration import Calibration
from ..diagnostics.identification import identify
from ..measurements.inputs import parse_measurements, parse_readings
from ..measurements.poses import Poses
from . import other_readings
from .bounds import Propagation, propagation, screw_bounds
from .errors import Judged, judge, printed_digits
from .from_fk_result import FromFk, drawn_pose_errors

FEW = 20
"""Pairs from which on it shows well whether they are those of a rigid arm."""


class _Fit(NamedTuple):
    """A calibration from pairs, its linear estimate, and what the digits of the pairs say of it."""

    found: Calibration
    linear: Propagation
    judged: Judged


def from_fk(chain: Arm, q: Any, T: Any) -> FromFk:
    """Arm that a controller calculates with, from pairs (q, T) of its own forward kinematics.

    Controllers of calibrated arms answer with the calibrated pose, though their parameters are
    not to be had. T = f(q) is solved for all axes and the home pose. As nothing was measured, only
    the digits of the pairs limit the result, and how far is said.

    Parameters
    ----------
    chain : Chain or CompiledChain
        The nominal arm, in any base and tool frame; with coupled readings as `Chain.coupled` has
        them.
    q : (N, m) array_like or dict
        Joint readings, rad or m: 20 to 60 configurations, spread over the whole range of each
        joint.
    T : (N, 4, 4) array_like
        Pose T_base_flange that the controller gives for each, m, printed with as many digits as it
        can.

    Returns
    -------
    found : FromFk
        The calibration, and bounds on the errors of its screws and poses.

    Raises
    ------
    ShapeError, InputError, PoseError
        If the pairs are too few or leave an axis unobserved, which is named; if they are not in SI
        units; if no rigid arm near the nominal one explains them to their digits, with what would:
        coupled readings, a reversed joint, joints in another order.

    Notes
    -----
    Accuracy: screws to 1e-12 of the reach from pairs with all digits of a double. Readings that
    were rounded are taken to be off by half a unit of their last digit at most, and the bounds
    follow from that to first order. Joint readings of few digits may be exact; they are taken to be
    so where the residuals are too small for anything else. Source: `calibrate`; the triangle
    inequality for the bounds.

    Examples
    --------
    >>> import numpy as np
    >>> import poekin as pk
    >>> arm = pk.load("ur5e").chain()
    >>> truth = pk.calibration.simulated(arm, 1, seed=4).truth  # inside the controller
    >>> q = arm.random(0, 40)
    >>> found = pk.calibration.from_fk(arm, q, truth.fk(q))
    >>> bool(abs(found.chain.screws - truth.screws).max() < 1e-12)
    True
    >>> T = truth.fk(q)
    >>> T[:, :3, 3] = T[:, :3, 3].round(6)  # printed in mm with three decimals
    >>> rounded = pk.calibration.from_fk(arm, q, T)
    >>> rounded.digits
    'positions to 0.001 mm'
    >>> bool((abs(rounded.chain.screws - truth.screws) < rounded.screw_bounds).all())
    True
    """
    chain = chain_of(chain)
    q = parse_readings(chain, q)
    poses = Poses(T)
    parse_measurements(poses, len(q))
    _check_pairs(chain, q, poses)
    start = other_readings.aligned(chain, q, poses)
    try:
        fit = _fit(start.chain, q, poses)
    except InputError as fault:
        raise InputError(f"{fault}{other_readings.hint(chain, q, poses)}") from fault
    found, linear, judged = fit
    if judged.beyond_digits:
        raise InputError(_misfit(fit) + _why(start.chain, q, poses, linear))
    typical, worst = drawn_pose_errors(found, linear, judged.largest)
    return FromFk(
        calibration=found,
        digits=str(judged.digits),
        errors=judged.largest,
        screw_bounds=screw_bounds(found, linear, judged.largest),
        typical=typical,
        worst=worst,
        remarks=tuple(_remarks(start.moved, fit)),
        fit=linear,
    )


def _check_pairs(chain: Chain, q: Array, poses: Poses) -> None:
    """Refuse pairs that do not identify all axes and the home pose with some to spare."""
    if not chain.dof:
        raise InputError(
            f"chain: expected joints that move between {quote(chain.base)} and "
            f"{quote(chain.tip)}, there are none"
        )
    seen = identify(chain, q, poses)
    if seen.n_equations <= seen.identifiable:
        least = seen.identifiable // 6 + 1
        raise InputError(
            f"{len(q)} pairs for {seen.identifiable} parameters: at least {least} are needed, and "
            f"{FEW} to 60 say whether the arm is a rigid one"
        )
    if seen.rank < seen.identifiable:
        raise InputError(
            f"these pairs identify {seen.rank} of {seen.identifiable} parameters. Unobserved: "
            f"{'; '.join(seen.unobserved)}. Ask for poses with these joints in more positions"
        )


def _fit(chain: Chain, q: Array, poses: Poses) -> _Fit:
    """The arm of least squares, and how it fits. Raises: InputError, as `calibrate`."""
    found = calibrate(chain, q, poses, folds=0)
    linear = propagation(found, q, poses)
    printed = printed_digits(chain, q, poses.T)
    return _Fit(found, linear, judge(printed, linear, chain))


def _misfit(fit: _Fit) -> str:
    """Words for pairs that are no rigid arm's to their digits."""
    angle, length = fit.judged.deviations.tolist()
    digits = str(fit.judged.digits) or "no digits that were rounded"
    return (
        f"no rigid arm explains these pairs to their digits ({digits}): the best misses them by "
        f"{1e6 * length:.3g} µm and {1e6 * angle:.3g} µrad (standard deviation); are they the controller's own "
        "forward kinematics, no measurement (that is what calibrate is for), with the joints at "
        "rest and one tool, and are its joint readings not coupled?"
    )


def _why(chain: Chain, q: Array, poses: Poses, linear: Propagation) -> str:
    """End of that message: what would explain the pairs."""
    slight = other_readings.slight_coupling(chain, q, linear)
    if slight:
        return slight
    robust = calibrate(chain, q, poses, folds=0, loss="tukey")
    return other_readings.odd_pairs(robust, len(q))


def _remarks(moved: str, fit: _Fit) -> list[str]:
    """Remarks on frames, digits and number of the pairs."""
    digits = str(fit.judged.digits)
    count = len(fit.linear.errors)
    remarks = [moved] if moved else []
    if digits:
        remarks.append(f"the digits of the pairs are the limit: {digits}")
    if count < FEW:
        remarks.append(f"{count} pairs: {FEW} and more say better whether the arm is a rigid one")
    return remarks
