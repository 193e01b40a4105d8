"""Conventions of a model: what may differ between two models of one arm, and what may not."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal, NamedTuple, get_args

from ....checks import alternatives
from ....errors import InputError, safe_repr
from ...axis_lines import Tolerances
from ..alignment.hypotheses import Hypothesis, still
from ..comparison import JointComparison, Outcome

Convention = Literal["base", "tool", "zeros", "directions", "limits", "names"]

CONVENTIONS: tuple[Convention, ...] = get_args(Convention)
BUT_NAMES: tuple[Convention, ...] = ("base", "tool", "zeros", "directions", "limits")


class Asked(NamedTuple):
    """Conventions that may not differ, tolerances and samples of a comparison, and whether it is
    strict, as the caller gave them.
    """

    same: tuple[Convention, ...]
    strict: bool
    tol_position: float
    tol_rotation: float
    samples: int
    seed: int

    @property
    def tol(self) -> Tolerances:
        """Both tolerances."""
        return Tolerances(self.tol_position, self.tol_rotation)


class Judgement(NamedTuple):
    """Whether the arm is the same up to free choices, and the outcome."""

    same_arm: bool
    outcome: Outcome


def checked(same: Any) -> tuple[Convention, ...]:
    """Names of conventions, each once and in their order. Raises: InputError."""
    if not isinstance(same, (tuple, list, set, frozenset)):
        raise InputError(
            f"same: expected a tuple of {alternatives(CONVENTIONS)}, got {safe_repr(same)}"
        )
    for word in same:
        if not (isinstance(word, str) and word in CONVENTIONS):
            raise InputError(
                f"same: expected names out of {alternatives(CONVENTIONS)}, got {safe_repr(word)}"
            )
    return tuple(word for word in CONVENTIONS if word in same)


def judged(
    joints: Sequence[JointComparison],
    reading: Hypothesis,
    alike: bool,
    same: Sequence[Convention],
    tol: Tolerances,
) -> Judgement:
    """Outcome of a comparison in which `same` may not differ; `alike`, whether nothing but
    conventions can differ.

    Limits are no convention: with other limits an arm reaches other poses.
    """
    found: dict[Convention, bool] = {
        "base": not still(reading.base, tol),
        "tool": not still(reading.tool, tol),
        "zeros": any(joint.zero_differs for joint in joints),
        "directions": any(joint.reversed for joint in joints),
        "limits": any(limits_differ(joint, same, tol) for joint in joints),
        "names": any(joint.name_a != joint.name_b for joint in joints),
    }
    moved = any(joint.axis_differs or joint.coupling_differs for joint in joints)
    same_arm = alike and not moved
    counted = [word for word in same if found[word]]
    if not same_arm or "limits" in counted:
        return Judgement(same_arm, "differ")
    if counted:
        return Judgement(same_arm, "conventions")
    return Judgement(same_arm, "same")


def limits_differ(
    joint: JointComparison,
    same: Sequence[Convention],
    tol: Tolerances,
) -> bool:
    """Whether a joint's limits differ where it stands, by more than its zero or direction says."""
    small = tol.rotation
    if joint.unit == "m":
        small = tol.position
    if not _beyond(joint.limits, small):
        return False
    # The same numbers about another zero: the zero is what differs.
    counted = joint.zero_differs and "zeros" in same
    counted = counted or (joint.reversed and "directions" in same)
    return not counted or _beyond(joint.limit_numbers, small)


def _beyond(limits: tuple[float, float], small: float) -> bool:
    return any(abs(side) > small for side in limits)
