"""Measures of how well an arm moves its tool: those of `poekin.manipulability`, pose part."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...analysis.dexterity.jacobian_part import generic_rank
from ...checks import positive
from ...errors import InputError
from ...groups.arrays import Array
from ...model.chain import Chain
from .measure import Measure

if TYPE_CHECKING:
    from ...engine.straight_line.program import Program

_FULL = 6  # coordinates from which on det(J Jᵀ) is the same in every frame


class _OfJacobian(Measure):
    """Measure that is 0 everywhere where an arm's rank is not full."""

    def check(self, chain: Chain) -> None:
        """Refuses an arm whose measure is 0 everywhere. Raises: InputError."""
        most = min(chain.dof, _FULL)
        if generic_rank(chain, "pose") < most:
            raise InputError(
                f"sweep: measure {self.name!r}: the tool of {chain!r} moves in fewer than {most} ways at a time, "
                "so that it is 0 everywhere"
            )


@dataclass(frozen=True)
class PoseManipulability(_OfJacobian):
    """Yoshikawa's manipulability of the pose, sqrt(det J Jᵀ), in SI units."""

    called = "manipulability"
    kind = 1

    def program(self, chain: Chain) -> Program:
        """Pose and determinant."""
        from ...engine.straight_line.specialise import measured_program

        return measured_program(chain.compile().structure)

    def outputs(self, chain: Chain) -> int:
        """The determinant."""
        return 1


@dataclass(frozen=True)
class _SingularValues(_OfJacobian):
    """Measure of the singular values of the hybrid Jacobian."""

    length: float = 1.0

    def __post_init__(self) -> None:
        positive(self.length, "length")

    def program(self, chain: Chain) -> Program:
        """Pose and Jacobian."""
        return chain.compile().program("hybrid", pose=True)

    def outputs(self, chain: Chain) -> int:
        """The Jacobian."""
        return 6 * chain.dof

    def numbers(self, chain: Chain) -> Array:
        """1 / length."""
        return np.array([1.0 / self.length])

    def describe(self) -> dict[str, object]:
        """Its length."""
        return {"length": self.length}


@dataclass(frozen=True)
class InverseCondition(_SingularValues):
    """Inverse condition number of the hybrid Jacobian, smallest over largest singular value.

    1 where the tool moves as well in every direction, 0 at a singularity.

    Attributes
    ----------
    length : float, default 1.0
        Length by which the rows of the linear velocity are divided, m.

    Raises
    ------
    InputError
        If the length is not positive.

    Notes
    -----
    Singular values are within 64 u of the largest, u = 2⁻⁵³, of a Jacobian as it was computed, and
    where they nearly meet too.

    Examples
    --------
    >>> import poekin as pk
    >>> arm = pk.load("ur5e").chain(tip="tool0")
    >>> measure = pk.sweep.InverseCondition(length=0.3)
    >>> found = pk.sweep.reach(arm, resolution=0.2, samples=20_000, measure=measure)
    >>> bool((found.best[found.counts > 0] <= 1).all())
    True
    """

    called = "inverse_condition"
    kind = 3


@dataclass(frozen=True)
class SmallestSingularValue(_SingularValues):
    """Distance to a singularity: smallest singular value of the hybrid Jacobian.

    It is the tool's speed in its worst direction for rates of size 1, and how far the Jacobian is
    from one that loses a direction.

    Attributes
    ----------
    length : float, default 1.0
        Length by which the rows of the linear velocity are divided, m.

    Raises
    ------
    InputError
        If the length is not positive.

    Notes
    -----
    Singular values are within 64 u of the largest, u = 2⁻⁵³, of a Jacobian as it was computed, and
    where they nearly meet too.

    Examples
    --------
    >>> import poekin as pk
    >>> arm = pk.load("ur5e").chain(tip="tool0")
    >>> measure = pk.sweep.SmallestSingularValue()
    >>> found = pk.sweep.reach(arm, resolution=0.2, samples=20_000, measure=measure)
    >>> q = found.configurations(found.counts > 0)
    >>> bool((pk.manipulability(arm, q).pose.smallest > 0).all())
    True
    """

    called = "smallest_singular_value"
    kind = 2
