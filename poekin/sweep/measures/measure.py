"""A measure of configurations as data: what a sweep keeps besides counts."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, NamedTuple

import numpy as np

from ...groups.arrays import Array
from ...model.chain import Chain

if TYPE_CHECKING:
    from ...engine.straight_line.program import Program

_FULL = 6  # coordinates from which on the Jacobian has as many rows as it ever has


class MeasureLabel(NamedTuple):
    """A measure in words: what it is, its unit, how many of them are one in SI, and whether a larger
    one (1) or a smaller one (-1) is better.
    """

    words: str
    unit: str = ""
    per_si: float = 1.0
    sign: int = 1

    def value(self, x: float) -> str:
        """A value with its unit."""
        return f"{self.per_si * x:.4g} {self.unit}".rstrip()

    def between(self, a: float, b: float) -> str:
        """Two values, from one to the other, with their unit."""
        return f"{self.per_si * a:.4g} to {self.value(b)}"


@dataclass(frozen=True)
class Measure:
    """Measure of a configuration, in SI units; which it is, its parameters say.

    Two measures of equal parameters are equal.
    """

    sign: ClassVar[int] = 1
    """1 where a larger one is better, -1 where a smaller one is."""

    kind: ClassVar[int]
    """Kind, as the kernel calls it."""
    called: ClassVar[str] = ""
    of_poses: ClassVar[bool] = False
    """Whether it is of samples that are poses alone."""

    @property
    def name(self) -> str:
        """Name by which maps call it."""
        return self.called

    def check(self, chain: Chain) -> None:
        """Refuses an arm that has no such measure. Raises: InputError."""

    def program(self, chain: Chain) -> Program:
        """The arm's pose, and behind it what the kernel makes the measure of."""
        return chain.compile().program(None)

    def outputs(self, chain: Chain) -> int:
        """Number of outputs that the program has behind the pose."""
        return 0

    def numbers(self, chain: Chain) -> Array:
        """Numbers of the kernel."""
        return np.empty(0)

    def at_best_turns(self, chain: Chain, q: Array) -> Array:
        """Configurations (S, m), whole turns away where the measure is better there."""
        return q

    def describe(self) -> dict[str, object]:
        """Plain data from which the same measure is known again."""
        return {}

    def whole_numbers(self, chain: Chain, sign: int) -> np.ndarray:
        """Whole numbers of the kernel, as `engine.kernels.sweep.measures` has them."""
        m = chain.dof
        rows = min(m, _FULL)
        return np.array([self.kind, sign, self.outputs(chain), rows, max(m, _FULL)], np.int64)


@dataclass(frozen=True)
class Reach(Measure):
    """No measure: samples only count."""

    called = "reach"
    kind = 0
