"""A chain against what Pinocchio makes of a URDF text that ought to say the same."""

from __future__ import annotations

import math

import numpy as np

from poekin.model.chain import Chain
from poekin.testing.oracles.pinocchio_oracle import PinocchioOracle

SAMPLES = 5


def values_of(chain: Chain) -> list[tuple[str, float, float] | None]:
    """For each coordinate the URDF's joint that stands for it, and its value in terms of q: ratio q
    + shift.
    """
    result = []
    for column in chain.coupling.T:
        rows = [
            (float(r), float(c), name)
            for r, c, name in zip(column, chain.offset, chain.joint_names, strict=True)
            if r
        ]
        if not rows:
            result.append(None)
            continue
        # Best one that is the coordinate itself, then one with an offset, then one the other way
        # round.
        r, c, name = min(
            rows, key=lambda row: [(1, 0), (1, row[1]), (-1, row[1]), row[:2]].index(row[:2])
        )
        result.append((name, 1.0, 0.0) if abs(r) == 1 else (name, r, c))
    return result


def pinocchio_errors(chain: Chain, text: str, seed: int, samples: int = SAMPLES) -> np.ndarray:
    """Errors of pose and Jacobians of a chain against what Pinocchio makes of a text, lengths ÷
    reach.

    Parameters: chain; text, its URDF; seed, of `samples` random configurations within ±3 rad or m.
    Returns: the worst of each configuration, one alone where nothing moves; infinite where a
    coordinate of the chain has no joint in the text.
    """
    oracle, values = PinocchioOracle(text), values_of(chain)
    q = np.random.default_rng(seed).uniform(-3, 3, (samples, chain.dof))
    named = {v[0]: v[1] * q[:, k] + v[2] for k, v in enumerate(values) if v}
    if set(named) - set(oracle.coordinates):
        return np.array([math.inf])
    T, J = oracle.evaluate(
        named or dict.fromkeys(oracle.coordinates, np.zeros(samples)), chain.tip, chain.base
    )
    weight = np.array([1, 1, 1, 1 / chain.reach])
    worst = np.abs((chain.fk(q)[: len(T)] - T)[:, :3] * weight).max(axis=(1, 2))
    for frame, columns in J.items():
        wanted = np.zeros((len(T), 6, chain.dof))
        for k, v in enumerate(values):
            if v:
                wanted[:, :, k] = columns[:, :, oracle.coordinates.index(v[0])] * v[1]
        off = (chain.jacobian(q, frame)[: len(T)] - wanted) * np.repeat([1, 1 / chain.reach], 3)[
            :, None
        ]
        worst = np.maximum(worst, np.abs(off).max(axis=(1, 2), initial=0.0))
    return worst
