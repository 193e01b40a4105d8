"""The closed form of an arm: which function computes its branches, and from which numbers."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from ....engine.kernels.branches import closed_kernels
from ....engine.kernels.branches.closed_arm import BRANCHES
from ....errors import InputError, quote
from ....groups.arrays import Array
from ....model.chain import Chain
from ....model.geometry.decomposition.sharp_arm import branch_rows, sharp_arm

_JOINTS = 6


class ClosedArm(NamedTuple):
    """Closed form of an arm.

    Attributes: fill, function of the table `arm`, a target (4, 4) and rows, which writes some of
    these and returns how many; rows, columns, their number: coordinates and a margin; family, in
    words.
    """

    fill: Callable[[Array, Array, Array], int]
    arm: Array
    rows: int
    columns: int
    family: str

    def branches(self, target: Array) -> Array:
        """Rows for one target; those that are not filled in are NaN."""
        return branch_rows(self.arm, self.columns - 1, target[None])[0]


def closed_arm(chain: Chain) -> ClosedArm:
    """Closed form of a chain. Raises: InputError, with the reason, where none is known."""
    what = f"{quote(chain.base)} -> {quote(chain.tip)}"
    if not 1 <= chain.dof <= _JOINTS:
        raise InputError(
            "emit: expected an arm of one to six joints for its inverse kinematics, "
            f"{what} has {chain.dof} coordinates"
        )
    for name, kind in zip(chain.joint_names, chain.kinds, strict=True):
        if kind == "helical":
            raise InputError(
                "emit: expected revolute and prismatic joints only for the inverse kinematics, "
                f"{quote(name)} is {kind}"
            )
    if chain.nontrivial_coupling is not None:
        raise InputError(
            "emit: expected one coordinate a joint for the inverse kinematics, the "
            f"{len(chain.kinds)} joints of {what} are coupled to {chain.dof} coordinates"
        )
    found = sharp_arm(chain)
    if found is None:
        raise InputError(
            f"emit: {what} has no closed form that is known here: no three neighbouring axes meet in a "
            "point, and no three are parallel (or move in a plane). Chain.idealised makes rounded geometry "
            "exact; near= takes an arm nearby that has a closed form; ik_all solves any arm, in Python"
        )
    return ClosedArm(closed_kernels.fill, found.arm, BRANCHES, chain.dof + 1, found.words)
