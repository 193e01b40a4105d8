"""monte_carlo: what errors of an arm do to its tool, by exact forward kinematics of arms drawn with
them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ...checks import KERNEL_INT, whole
from ...groups import se3, so3
from ...groups.arrays import Array
from ...groups.vectors import angular_part, linear_part, rotation_part, translation_part
from ...model.chain import Chain
from ...model.coordinates import coordinates
from ...model.kinematics.arm import Arm, chain_of
from ...model.readings.coupled import joint_values
from ...results import Result
from .pose_uncertainty import PoseUncertainty

_AT_ONCE = 10_000  # pairs of arms


@dataclass(frozen=True, eq=False)
class DrawnErrors(Result):
    """Errors of the tool of many arms that were drawn; the result of `monte_carlo`.

    Attributes
    ----------
    position : (...) ndarray
        Standard deviation of the tool's position about its mean, sqrt of the trace of the
        covariance, m.
    orientation : (...) ndarray
        Standard deviation of its orientation likewise, rad.
    position_bias : (..., 3) ndarray
        Mean of the position's error in the base frame, m: of second order in the errors.
    orientation_bias : (..., 3) ndarray
        Mean of the rotation vector from the true orientation, base axes, rad.
    draws : int
        Number of arms.
    """

    position: Array
    orientation: Array
    position_bias: Array
    orientation_bias: Array
    draws: int

    def summary(self) -> str:
        """The largest of the configurations.

        Returns
        -------
        text : str
            Line such as "10000 arms: position 0.12 mm, bias 0.0001 mm; orientation ...".
        """
        if not np.size(self.position):
            return "no configuration"
        bias = np.linalg.norm(self.position_bias, axis=-1)
        turn = np.linalg.norm(self.orientation_bias, axis=-1)
        return (
            f"{self.draws} arms, standard deviations: position {1e3 * np.max(self.position):.4g} mm, "
            f"bias {1e3 * np.max(bias):.2g} mm; orientation {1e3 * np.max(self.orientation):.4g} mrad, "
            f"bias {1e3 * np.max(turn):.2g} mrad"
        )


def monte_carlo(
    chain: Arm,
    q: Any,
    error: PoseUncertainty,
    *,
    draws: int = 10_000,
    seed: int = 0,
) -> DrawnErrors:
    """Errors of the tool by arms that are drawn at random, without linearising.

    Parameters
    ----------
    chain : Chain or CompiledChain
        The arm.
    q : (..., m) array_like or dict
        Configurations, rad or m; each meets the same arms.
    error : PoseUncertainty
        Errors of its screws and home pose; sources are drawn from normal distributions.
    draws : int, default 10000
        Number of arms, in pairs of opposite errors: their mean has no part of first order left.
    seed : int, default 0
        Seed of the random numbers.

    Returns
    -------
    drawn : DrawnErrors
        Standard deviations and biases (...) of position, m, and orientation, rad.

    Raises
    ------
    InputError
        If the error is of an arm of another number of joints, or a number cannot be used.
    ShapeError
        If `q` has not m coordinates.
    UnknownName
        If a dict `q` names a coordinate that the chain has not.

    See Also
    --------
    PoseUncertainty : The same to first order, for maps.

    Notes
    -----
    Accuracy: standard deviations within some 1 / sqrt(draws) of themselves, as random numbers have
    it, and biases too (tests/sweep/measures/test_monte_carlo.py).

    Examples
    --------
    >>> import poekin as pk
    >>> arm = pk.load("ur5e").chain(tip="tool0")
    >>> error = pk.sweep.PoseUncertainty.by_tolerances(arm, tilt=1e-4, offset=1e-4)
    >>> drawn = pk.sweep.monte_carlo(arm, [0.0, -1.0, 1.5, -2.0, -1.5, 0.0], error)
    >>> bool(1e-4 < drawn.position < 3e-4)  # m
    True
    """
    arm: Chain = chain_of(chain)
    whole(draws, "draws", 2)
    whole(seed, "seed", 0, KERNEL_INT)
    error.check(arm)
    q = coordinates(q, arm.q_names)
    rows = q.reshape(-1, arm.dof)
    sources = np.array(error.sources)
    rng = np.random.default_rng(seed)
    sums = np.zeros((len(rows), 6))
    squares = np.zeros((len(rows), 6))
    pairs = (draws + 1) // 2
    for first in range(0, pairs, _AT_ONCE):
        some = min(_AT_ONCE, pairs - first)
        factors = rng.standard_normal((some, len(sources)))
        eta = np.tensordot(factors, sources, axes=1)
        moves = se3.exp(np.concatenate([eta, -eta]))
        for k, row in enumerate(rows):
            errors = _errors(arm, row, moves)
            sums[k] += errors.sum(axis=0)
            squares[k] += np.square(errors).sum(axis=0)
    draws = 2 * pairs
    means = sums / draws
    # errors begin at the true pose: a mean is far smaller than what lies about it
    variances = squares / draws - np.square(means)
    both = variances.reshape(-1, 2, 3).sum(axis=2)
    of_orientation, of_position = np.sqrt(both).T
    batch = q.shape[:-1]
    return DrawnErrors(
        of_position.reshape(batch),
        of_orientation.reshape(batch),
        linear_part(means).reshape(*batch, 3),
        angular_part(means).reshape(*batch, 3),
        draws,
    )


def _errors(chain: Chain, q: Array, moves: Array) -> Array:
    """Errors (N, 6) of the tool, rotation vector and displacement, of arms whose screws and home pose
    have been moved (N, n + 1, 4, 4).
    """
    true = chain.fk(q)
    turns = se3.exp(chain.screws * joint_values(chain, q)[:, None])
    T = np.broadcast_to(np.eye(4), (len(moves), 4, 4))
    for i, turn in enumerate(turns):
        move = moves[:, i]
        T = T @ move @ turn @ se3.inverse(move)
    T = T @ chain.home @ moves[:, -1]
    R = rotation_part(T) @ rotation_part(true).T
    moved = translation_part(T) - translation_part(true)
    return np.concatenate([so3.log(R), moved], axis=1)
