"""Measures of the coordinates alone: distance to their limits, travel from a configuration."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...errors import InputError, ShapeError
from ...groups.arrays import Array, numbers
from ...model.chain import Chain
from ...model.sampling import sampling_range
from ...solve.joint_units import periods
from .measure import Measure


@dataclass(frozen=True)
class LimitMargin(Measure):
    """Relative distance to the joint limits: 0 at a limit, 1 where all coordinates are in the middle.

    It is that of the worst coordinate, its distance to the nearer limit over half its range; a
    coordinate that has not both limits, or cannot move between them, does not count.

    Examples
    --------
    >>> import poekin as pk
    >>> arm = pk.load("panda").chain(tip="panda_hand")
    >>> measure = pk.sweep.LimitMargin()
    >>> found = pk.sweep.reach(arm, resolution=0.2, samples=20_000, measure=measure)
    >>> bool((found.best[found.counts > 0] > 0).all())
    True
    """

    called = "limit_margin"
    kind = 5

    def at_best_turns(self, chain: Chain, q: Array) -> Array:
        """Configurations as near to the middles as whole turns bring them."""
        return _nearest_turns(chain, q, self.numbers(chain)[: chain.dof])

    def check(self, chain: Chain) -> None:
        """Refuses an arm without limits. Raises: InputError."""
        if not _has_limits(chain).any():
            raise InputError(f"sweep: measure {self.name!r}: no coordinate of {chain!r} has limits")

    def numbers(self, chain: Chain) -> Array:
        """Middles, and 1 over half the ranges."""
        is_limited = _has_limits(chain)
        lower, upper = np.where(is_limited[:, None], chain.limits, [-1.0, 1.0]).T
        return np.concatenate([lower / 2 + upper / 2, is_limited * 2.0 / (upper - lower)])


@dataclass(frozen=True)
class JointTravel(Measure):
    """Joint travel from a reference configuration: the largest change of a coordinate.

    Attributes
    ----------
    reference : tuple of float, optional
        The configuration, rad or m; by default all 0, or the limit that is nearest to that.
    speeds : tuple of float, optional
        Speeds of the coordinates, rad/s or m/s: with them travel is a time, s.

    Raises
    ------
    InputError
        If they are no numbers.

    Examples
    --------
    >>> import poekin as pk
    >>> arm = pk.load("ur5e").chain(tip="tool0")
    >>> home = (0.0, -1.5, 1.5, -1.5, -1.5, 0.0)
    >>> measure = pk.sweep.JointTravel(home, speeds=tuple(arm.velocity_limits))
    >>> found = pk.sweep.reach(arm, resolution=0.2, samples=20_000, measure=measure)
    >>> bool((found.best[found.counts > 0] < 5).all())  # seconds
    True
    """

    reference: tuple[float, ...] | None = None
    speeds: tuple[float, ...] | None = None

    kind = 4
    sign = -1

    def __post_init__(self) -> None:
        for what, values in (("reference", self.reference), ("speeds", self.speeds)):
            if values is not None:
                given = numbers(values, what)
                object.__setattr__(self, what, tuple(given.ravel().tolist()))

    @property
    def name(self) -> str:
        """Its name, another one where it is a time."""
        return "travel" if self.speeds is None else "travel_time"

    def at_best_turns(self, chain: Chain, q: Array) -> Array:
        """Configurations as near to the reference as whole turns bring them."""
        return _nearest_turns(chain, q, self.numbers(chain)[: chain.dof])

    def check(self, chain: Chain) -> None:
        """Refuses numbers of another arm. Raises: InputError, ShapeError."""
        for what, values in (("reference", self.reference), ("speeds", self.speeds)):
            if values is None:
                continue
            given = np.asarray(values, float)
            if given.shape != (chain.dof,):
                raise ShapeError(f"{what}: expected {chain.dof} numbers, got {given.shape}")
            least = 0.0 if what == "speeds" else -np.inf
            if not (np.isfinite(given) & (given > least)).all():
                raise InputError(f"{what}: expected finite numbers, speeds above 0, got {values}")

    def numbers(self, chain: Chain) -> Array:
        """Reference, and 1 over the speeds."""
        reference = self.reference
        if reference is None:
            reference = np.clip(0.0, *sampling_range(chain))
        speeds = np.ones(chain.dof) if self.speeds is None else np.asarray(self.speeds)
        return np.concatenate([reference, 1.0 / speeds])

    def describe(self) -> dict[str, object]:
        """Reference and speeds."""
        given = {"reference": self.reference, "speeds": self.speeds}
        return {what: None if x is None else list(map(float, x)) for what, x in given.items()}


def _nearest_turns(chain: Chain, q: Array, reference: Array) -> Array:
    """Configurations (S, m) within the limits, whole turns away where that is nearer to a reference."""
    if np.isfinite(chain.joint_limits).any():
        return q
    turn = periods(chain)
    length = np.where(turn > 0.0, turn, np.inf)
    lower, upper = chain.limits.T
    # 0 is allowed though rounding may have brought q beyond a limit
    least = np.minimum(np.ceil((lower - q) / length), 0.0)
    most = np.maximum(np.floor((upper - q) / length), 0.0)
    number = np.clip(np.round((reference - q) / length), least, most)
    return q + number * turn


def _has_limits(chain: Chain) -> np.ndarray:
    """Whether each coordinate (m,) has both limits, and moves between them."""
    lower, upper = chain.limits.T
    return np.isfinite(lower) & np.isfinite(upper) & (lower < upper)
