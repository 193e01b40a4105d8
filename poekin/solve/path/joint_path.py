"""A path of given configurations, as a result of `follow`."""

from __future__ import annotations

import numpy as np

from ...errors import InputError, ShapeError
from ...groups.arrays import Array
from ...model.chain import Chain
from ...model.coordinates import coordinates
from ..ik.solution import BAD_TARGET, SOLVED, Solution
from ..ik.task import make_task
from .path_interval import limits_of_joints
from .path_result import PathResult


def joint_path(chain: Chain, q: Array, times: Array | None = None) -> PathResult:
    """Path of the poses that configurations reach, which says what is hard on it.

    Parameters
    ----------
    chain : Chain
        The arm.
    q : (N, m) array_like
        Configurations, rad or m.
    times : (N,) array_like, optional
        Their times, s, none before the one above it.

    Returns
    -------
    path : PathResult
        Every finite pose is reached exactly; limits of speed are the chain's, where there are times.

    Raises
    ------
    ShapeError
        If q is no list of configurations.
    InputError
        If a time is not finite or before the one above it.

    Notes
    -----
    Source: none, it restates what is given.
    """
    q = coordinates(q, chain.q_names)
    if q.ndim != 2 or not len(q):
        raise ShapeError(f"q: expected configurations (N, {chain.dof}), got shape {q.shape}")
    if times is not None and not (np.isfinite(times).all() and (np.diff(times) >= 0).all()):
        raise InputError("times: expected finite seconds, none before the one above it")
    count = len(q)
    known = np.asarray(np.isfinite(q).all(axis=1))
    nothing = np.zeros(count, int)
    zero = np.zeros(count)
    solution = Solution(
        q,
        known,
        np.where(known, SOLVED, BAD_TARGET),
        zero,
        zero,
        nothing,
        nothing,
        zero,
        chain=chain,
        target=chain.fk(q),
    )
    return PathResult(
        chain=chain,
        solution=solution,
        branch_switches=(),
        task=make_task("pose", None, None),
        limits=chain.limits,
        times=times,
        speed=None if times is None else chain.velocity_limits,
        acceleration=None,
        joint_limits=limits_of_joints(chain),
    )
