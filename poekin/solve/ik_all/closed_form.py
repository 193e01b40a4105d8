"""Joints in closed form, where the axes of an arm allow it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np

from ...engine.kernels.branches import closed_arm
from ...errors import InputError, quote
from ...groups.arrays import Array
from ...model.chain import Chain
from ...model.geometry.decomposition.completions import completions
from ...model.geometry.decomposition.joints import Tolerance, joints_of
from ...model.geometry.decomposition.sharp_arm import ROUNDING, branch_rows, sharp_arm
from ...model.geometry.idealise import Idealised

EXACT = 1e-5
"""rad and m: an arm whose axes are parallel or meet within this is solved as if they were so, to
start from there.
"""

# a margin is of angles and of lengths by the reach, of which a link may be a tenth, and off by some
# four times what the arm is
_SHARE = 0.1
_FACTOR = 4.0
# a margin so far below 0 is no double root of any arm within EXACT, where there are other solutions
_HOPELESS = 0.01
_SQUARE = 1e-12  # cosine of a right angle but for rounding


@dataclass(frozen=True, eq=False)
class ClosedForm:
    """Closed form of one arm of m <= 6 joints, or of one that is nearly it.

    Attributes: arm, the array of `closed_arm`; dof, m; family, the three axes by which it is solved,
    in words; position_bound, rotation_bound, how far (m, rad) the arm that is solved is from the
    given one: 0 where it is the same; margin_bound, by how much margins are off for that at most.
    Source: Elias and Wen 2025, IK-Geo: unified robot inverse kinematics using subproblem
    decomposition; Murray, Li and Sastry 1994, Section 3.3.
    """

    method: ClassVar[Literal["closed form"]] = "closed form"
    most: ClassVar[int] = closed_arm.BRANCHES

    arm: Array
    dof: int
    family: str
    position_bound: float
    rotation_bound: float
    margin_bound: float = 0.0

    @property
    def is_exact(self) -> bool:
        """Whether the arm that is solved is the given one."""
        return not self.position_bound and not self.rotation_bound

    @property
    def none_below(self) -> float:
        """Margin of which all branches of a target have less where it has no solution; -inf where
        margins do not show that.

        They show it where the first step alone decides what is within reach: where infinitely many
        first steps exist and one is taken, a later step may be out of reach for that one only. The
        first step of prismatic joints does not always tell that there are infinitely many.
        """
        told = not self.arm[:6, closed_arm.SLIDES].any()
        if self.arm[closed_arm.RULE, closed_arm.FAMILY] == closed_arm.WRIST:
            # any rotation is within reach of axes at right angles
            h = self.arm[:6, closed_arm.DIRECTION : closed_arm.DIRECTION + 3]
            told &= max(abs(h[3] @ h[4]), abs(h[4] @ h[5])) <= _SQUARE
        return -max(_HOPELESS, self.margin_bound) if told else -np.inf

    def said(self) -> str:
        """The way to the solutions, in words."""
        if self.is_exact:
            return f"closed form ({self.family})"
        return (
            f"closed form ({self.family}) of the arm made exact, at most {self.position_bound:.1g} m and "
            f"{self.rotation_bound:.1g} rad away, tried down to the target"
        )

    def rows(self, T: Array) -> tuple[Array, Array]:
        """Branches (N, 8, m) of targets (N, 4, 4) and their margins (N, 8), NaN where there are
        fewer.

        A branch with a margin above 0 is a solution; another one is the least-squares answer where
        there is none, or a solution within rounding, which the caller has to try.
        """
        rows = self.branches(T)
        return rows[:, :, :-1], rows[:, :, -1]

    def branches(self, T: Array) -> Array:
        """Branches (N, 8, m + 1) of targets (N, 4, 4), each with its margin behind it; see `rows`."""
        return branch_rows(self.arm, self.dof, T)

    def starts(self, T: Array) -> tuple[Array, np.ndarray, np.ndarray]:
        """Configurations (S, m) for all of the targets (N, 4, 4), one target's after the other's,
        which the caller has to try and to check; how many each has (N,), and where there may be
        more solutions (N,).

        These are poses in which a joint that was added to fewer than six may be anywhere, or without
        any solution of these six, and those with a double solution, which may be two.
        """
        rows, margins = self.rows(T)
        solved = np.asarray((margins > 0.0).any(axis=1))
        taken = (margins > -_HOPELESS) | ~solved[:, None]
        taken &= np.isfinite(rows).all(axis=2)
        double = (margins > -closed_arm.DOUBLE) & (margins <= 0.0)
        unsure = ((margins == closed_arm.UNSURE) | double).any(axis=1)
        if self.dof < 6:
            unsure |= ~solved
        unsure &= np.isfinite(T).all(axis=(1, 2))
        return rows[taken], taken.sum(axis=1), unsure


def closed_form(chain: Chain) -> ClosedForm | None:
    """The closed form of an arm, or None where there is none.

    It is looked for of the arm itself, then of the arm with its geometry made exact within `EXACT`
    (`Chain.idealised`).

    Raises: InputError for joints that are helical or coupled.
    """
    for name, kind in zip(chain.joint_names, chain.kinds, strict=True):
        if kind == "helical":
            raise InputError(
                f"closed form: expected revolute and prismatic joints only, {quote(name)} is {kind}"
            )
    if chain.nontrivial_coupling is not None:
        raise InputError(
            f"closed form: expected one coordinate a joint, the {len(chain.kinds)} joints of {quote(chain.base)} -> "
            f"{quote(chain.tip)} are coupled to {chain.dof} coordinates"
        )
    if not 1 <= chain.dof <= 6:
        return None
    found = _of(Idealised(chain, 0.0, 0.0, ()))
    if found is not None or _ways(chain, EXACT) == _ways(chain, ROUNDING):
        return found
    return _of(chain.idealised(EXACT))


def _ways(chain: Chain, tolerance: float) -> list[str]:
    """The three axes by which an arm may be solved that are so within a tolerance, in words."""
    near = Tolerance(tolerance, tolerance * chain.reach)
    return [one.words for one in completions(joints_of(chain), chain.reach, near)]


def _of(near: Idealised[Chain]) -> ClosedForm | None:
    """The closed form of a chain that is exact but for rounding."""
    found = sharp_arm(near.chain)
    if found is None:
        return None
    off = max(near.rotation_bound, near.position_bound / (_SHARE * near.chain.reach))
    return ClosedForm(
        found.arm,
        near.chain.dof,
        found.words,
        near.position_bound,
        near.rotation_bound,
        _FACTOR * off,
    )
