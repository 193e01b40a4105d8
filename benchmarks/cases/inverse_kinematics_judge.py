"""What joints are worth: their true pose error by `Chain.fk`, and whether they lie within the
limits.

Nothing that a solver says about itself counts here, but that it claims success: a claim that the
errors do not bear out is a false one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from poekin import Chain

TOLERANCE = 1e-9  # m and rad
SLACK = 1e-12  # rad or m by which a peer may pass a limit: it rounds, too


@dataclass(frozen=True)
class Judgement:
    """True errors of the joints for some targets: position (m), rotation (rad); inside the limits;
    claimed.
    """

    position: np.ndarray
    rotation: np.ndarray
    inside: np.ndarray
    claimed: np.ndarray

    @property
    def within(self) -> np.ndarray:
        """Which poses are within the tolerance, wherever the limits are."""
        return (self.position <= TOLERANCE) & (self.rotation <= TOLERANCE)

    @property
    def solved(self) -> np.ndarray:
        """Which are solved in truth: claimed, within the tolerance and within the limits."""
        return self.claimed & self.within & self.inside

    @property
    def false_claims(self) -> int:
        """How often success is claimed and is none."""
        return int((self.claimed & ~(self.within & self.inside)).sum())

    @property
    def worst(self) -> tuple[float, float]:
        """Largest errors (m, rad) of what is claimed; NaN where nothing is."""
        if not self.claimed.any():
            return float("nan"), float("nan")
        return float(self.position[self.claimed].max()), float(self.rotation[self.claimed].max())

    @property
    def said(self) -> str:
        """The largest errors in words."""
        position, rotation = self.worst
        return f"{position:.1e} m, {rotation:.1e} rad"


def judged(chain: Chain, T: np.ndarray, q: np.ndarray, claimed: np.ndarray, *, axis: np.ndarray | None = None,
           limits: bool = True) -> Judgement:  # fmt: skip
    """Joints q (N, m) for targets T (N, 4, 4); axis (3,): only this direction of the tool is asked
    for.

    The angle of a small rotation comes from a difference of matrices, which loses nothing: |R - R*|
    = 2 √2 sin(θ/2).
    """
    known = np.isfinite(q).all(axis=1)
    difference = np.full(T.shape, np.inf)
    difference[known] = chain.fk(q[known]) - T[known]
    position = np.linalg.norm(difference[:, :3, 3], axis=1)
    rotation = np.full(len(T), np.inf)
    if axis is None:
        half = np.linalg.norm(difference[known, :3, :3], axis=(1, 2)) / np.sqrt(8)
    else:
        half = np.linalg.norm(difference[known, :3, :3] @ axis, axis=1) / 2
    rotation[known] = 2 * np.arcsin(np.minimum(half, 1.0))
    lower, upper = chain.limits.T
    inside = (
        ((q >= lower - SLACK) & (q <= upper + SLACK)).all(axis=1)
        if limits
        else np.full(len(q), True)
    )
    return Judgement(position, rotation, inside, np.asarray(claimed, bool))


def share(part: np.ndarray) -> float:
    """Percent of true ones."""
    return 100.0 * float(np.mean(part))
