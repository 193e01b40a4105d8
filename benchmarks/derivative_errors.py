"""Errors of a chain's derivatives against those of Pinocchio."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from poekin.model.kinematics.pose_jacobian import FRAME_NAMES
from poekin.testing.oracles.pinocchio_oracle import PinocchioOracle

from .pinocchio_derivatives import derivatives


class DerivativeErrors(NamedTuple):
    """Worst errors of the derivatives of one chain, those of linear rows ÷ its reach.

    Attributes
    ----------
    rate : float
        Error of the rate of the Jacobian, dJ/dt.
    hessian : float
        Error of the Hessian.
    acceleration : float
        Error of the acceleration.
    """

    rate: float
    hessian: float
    acceleration: float

    @property
    def worst(self) -> float:
        """The largest of the three; NaN where one is."""
        return float(np.max(self))


def derivative_errors(
    chain: Any,
    oracle: PinocchioOracle,
    samples: int,
    seed: int = 0,
) -> DerivativeErrors:
    """Errors of the derivatives of a chain against those of Pinocchio, in all three frames.

    Configurations are those of `PinocchioOracle.random`, the first all zeros; rates and
    accelerations of the chain's coordinates are uniform in ±1 (rad or m per s, per s²). An error is
    the largest absolute entry of a difference, its linear rows ÷ R, R the chain's reach; columns of
    coordinates that the chain does not have must be zero.

    Parameters
    ----------
    chain : Chain
        A chain of the oracle's robot.
    oracle : PinocchioOracle
        The robot.
    samples : int
        Number of configurations.
    seed : int, default 0
        Seed of the random configurations.

    Returns
    -------
    errors : DerivativeErrors
        The worst errors.

    Raises
    ------
    UnknownName
        For a coordinate of the chain that Pinocchio does not know.
    InputError
        As `derivatives`.
    """
    rng = np.random.default_rng(seed)
    m = len(oracle.coordinates)
    q = oracle.random(rng, samples)
    for values in q.values():
        values[:1] = 0.0
    own = [oracle.coordinates.index(name) for name in chain.q_names]
    rates = np.zeros((2, samples, m))
    rates[:, :, own] = rng.uniform(-1, 1, (2, samples, len(own)))
    expected = derivatives(oracle, q, rates[0], rates[1], chain.tip, chain.base)
    at = np.stack([q[name] for name in chain.q_names], axis=-1) if own else np.zeros((samples, 0))
    dq, ddq = rates[:, :, own]
    weight = np.repeat([1.0, 1.0 / chain.reach], 3)
    errors = np.zeros(3)
    for frame in FRAME_NAMES:
        dJ = np.zeros((samples, 6, m))
        H = np.zeros((samples, 6, m, m))
        dJ[:, :, own] = chain.jacobian_rate(at, dq, frame)
        H[np.ix_(range(samples), range(6), own, own)] = chain.hessian(at, frame)
        A = chain.acceleration(at, dq, ddq, frame)
        off = (
            (dJ - expected.rate[frame]) * weight[:, None],
            (H - expected.hessian[frame]) * weight[:, None, None],
            (A - expected.acceleration[frame]) * weight,
        )
        errors = np.maximum(errors, [np.abs(x).max(initial=0.0) for x in off])
    return DerivativeErrors(*map(float, errors))
