"""`from_circles`: the screws of an arm from sweeps of one joint at a time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ....errors import InputError, safe_repr
from ....groups import se3
from ....groups.arrays import Array
from ....model.chain import Chain
from ....model.provenance import warn
from ..fit.initial_guess import mean_pose
from .agreement import apart, home_changes
from .axis_fit import AxisFit, fit_axis
from .from_circles_result import FromCircles
from .joint_sweep import JointSweep
from .rough_axis import carried_back


def from_circles(
    sweeps: Sequence[JointSweep], *, joint_names: Sequence[str] | None = None
) -> FromCircles:
    """Arm from sweeps of one joint at a time, without a nominal model: circle-point analysis.

    While joint i alone moves, each point of the tool is on a circle about its axis, or on a line.
    The readings tell the direction of the axis by their sign, and where the other joints stood, and
    nothing else.

    Parameters
    ----------
    sweeps : sequence of JointSweep
        One of each joint, in any order, all measured in one frame, of one point or tool. Others may
        stand anywhere.
    joint_names : sequence of str, optional
        Names of the joints from base to tip.

    Returns
    -------
    found : FromCircles
        The arm in the frame of the measurements, with the covariance of its axes. Its tip is the
        measured point, turned like that frame, or the measured tool.

    Raises
    ------
    ShapeError, InputError
        If a joint has no sweep, or two; if a sweep does not show its axis: the arc is too short,
        which would do is said; the point is on the axis; the readings are another joint's.

    Warns
    -----
    PoekinWarning
        Where the sweeps do not agree on the point; `warnings` holds the same.

    Notes
    -----
    Accuracy: of exact data within 1e-12 m and rad for arcs of a quarter turn and more; the
    deviations are to first order in the noise, which is estimated from the distances of each sweep
    from its circle (tests/solve/calibration/circles). An arm that this found is a start for
    `calibrate`, which weighs all readings together. Source: Mooring, Roth and Driels 1991,
    "Fundamentals of Manipulator Calibration", circle-point analysis; e^{A x} moved along the joints
    before: Park 1994, eq. (1).

    Examples
    --------
    >>> import numpy as np
    >>> import poekin as pk
    >>> arm = pk.load("ur5").chain()
    >>> T_device_base = pk.se3.exp([0.1, 0.2, 0.3, 1.0, 2.0, 0.5])  # nobody has to know it
    >>> tool = arm.retooled(pk.se3.pose(np.eye(3), [0.1, 0.0, 0.2])).rebased(T_device_base)
    >>> sweeps = []
    >>> for joint in range(6):
    ...     q = np.tile([0.0, -1.0, 1.0, 0.3, 0.2, 0.1], (20, 1))
    ...     q[:, joint] += np.linspace(-1, 1, 20)
    ...     sweeps.append(pk.calibration.JointSweep(joint, q, tool.fk(q)[:, :3, 3]))
    >>> found = pk.calibration.from_circles(sweeps)
    >>> bool(abs(found.chain.screws - tool.screws).max() < 1e-12)
    True
    """
    ordered = _by_joint(sweeps)
    fits = [fit_axis(sweep) for sweep in ordered]
    held = np.array([sweep.q.mean(axis=0) for sweep in ordered])
    screws, covariance = at_zero(fits, held)
    bare = Chain.from_space(
        screws,
        np.eye(4),
        joint_names=joint_names,
        base="device",
    )
    homes = []
    changes = []
    for sweep in ordered:
        back = se3.inverse(bare.fk(sweep.q))
        home = carried_back(sweep, back)
        homes.append(home)
        changes.append(home_changes(bare, sweep, back, home))
    chain = bare.replace(home=mean_pose(np.array(homes)))
    warnings = tuple(apart(fits, homes, changes, covariance))
    for words in warnings:
        warn(words)
    return FromCircles(chain, covariance, tuple(fits), warnings)


def _by_joint(sweeps: Any) -> list[JointSweep]:
    """The sweeps in the order of the joints. Raises: InputError."""
    given = list(sweeps) if isinstance(sweeps, (list, tuple)) else []
    for sweep in given:
        if not isinstance(sweep, JointSweep):
            raise InputError(f"sweeps: expected JointSweep objects, got {safe_repr(sweep)}")
    if not given:
        raise InputError(f"sweeps: expected a JointSweep of each joint, got {safe_repr(sweeps)}")
    kinds = {(sweep.q.shape[1], sweep.has_poses) for sweep in given}
    if len(kinds) > 1:
        raise InputError(
            "sweeps: expected readings of as many joints in all, and points in all or poses in all"
        )
    count = given[0].q.shape[1]
    joints = [sweep.joint for sweep in given]
    if sorted(joints) != list(range(count)):
        raise InputError(f"sweeps: expected one of each of {count} joints, got those of {joints}")
    return sorted(given, key=lambda sweep: sweep.joint)


def at_zero(fits: Sequence[AxisFit], held: Array) -> tuple[Array, Array]:
    """Screws (n, 6) at zero readings, and the covariance (6n, 6n) of their numbers.

    With P = e^{A_1 q_1} ... e^{A_{i-1} q_{i-1}} where joint i was swept, its axis there is L =
    Ad(P) A_i, so dA_i = Ad(P^-1) (dL + [L, dP P^-1]).
    """
    n = len(fits)
    screws = np.empty((n, 6))
    # derivatives of each screw by the measured ones, and the covariance of these
    G = np.zeros((n, 6, n, 6))
    C = np.zeros((n, 6, n, 6))
    for i, fit in enumerate(fits):
        C[i, :, i] = fit.covariance
        before = Chain.from_space(screws[:i], np.eye(4))
        q = held[i, :i]
        back = se3.inverse(before.fk(q))
        to_zero = se3.adjoint(back)
        screws[i] = to_zero @ fit.screw
        changes = before.screw_derivatives(q, wrt="components")
        twists = np.tensordot(changes.screws, G[:i], 2)
        carried = to_zero @ se3.ad(fit.screw)
        G[i] = np.tensordot(carried, twists, 1)
        G[i, :, i] += to_zero
    G = G.reshape(6 * n, 6 * n)
    C = C.reshape(6 * n, 6 * n)
    return screws, G @ C @ G.T
