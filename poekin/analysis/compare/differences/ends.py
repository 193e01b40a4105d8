"""Base and tip that make two models comparable: links at which the longer one is to begin or end."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal, NamedTuple

from ....errors import quote
from ....groups import se3
from ....groups.arrays import Array
from ....model.chain import Chain
from ....model.robot import Robot
from ...axis_lines import Tolerances
from ..alignment.hypotheses import still
from ..comparison import Comparison

End = Literal["base", "tip"]


class Chosen(NamedTuple):
    """A robot, and the chain of it that is compared."""

    robot: Robot
    chain: Chain


class Remedy(NamedTuple):
    """The link of a model, "a" or "b", at which its chain is to begin or end, and why."""

    model: str
    end: End
    link: str
    reason: str


def remedies(result: Comparison, a: Chosen, b: Chosen) -> Iterator[Remedy]:
    """Links under which a longer base or end of one model is left out."""
    arms = {"a": a, "b": b}
    if result.unmatched_joints is not None:
        model, *names = result.unmatched_joints
        yield from _without_joints(model, arms[model], names)
        return
    if result.base is None or result.tool is None:
        return
    tol = Tolerances(result.tol_position, result.tol_rotation)
    # Poses, in the own frame, at which each model has the other's.
    bases = {"b": se3.inverse(result.base), "a": result.base}
    tips = {"b": result.tool, "a": se3.inverse(result.tool)}
    yield from _fixed(arms, "base", bases, tol)
    yield from _fixed(arms, "tip", tips, tol)


def _fixed(
    arms: dict[str, Chosen],
    end: End,
    wanted: dict[str, Array],
    tol: Tolerances,
) -> Iterator[Remedy]:
    """The link that is fixed to one model's end and stands where the other's is."""
    if still(wanted["b"], tol):
        return
    for model in ("b", "a"):
        own = getattr(arms[model].chain, end)
        link = _link_at(arms[model], own, wanted[model], tol)
        if link is not None:
            reason = f"its {quote(link)}, and not {quote(own)}, is where the other model's {end} is"
            yield Remedy(model, end, link, reason)
            return


def _without_joints(model: str, arm: Chosen, names: list[str]) -> Iterator[Remedy]:
    """The link behind joints that come first, and the one before joints that come last."""
    every = arm.chain.joint_names
    if len(names) == len(every):  # the other model has none
        return
    joints = {joint.name: joint for joint in arm.robot.joints}
    front = 0
    while every[front] in names:
        front += 1
    back = len(every)
    while every[back - 1] in names:
        back -= 1
    # Where a chain runs towards the root, its joints' links are the other way round.
    if front:
        link = joints[every[front - 1]].child
        if arm.robot.chain(base=link, tip=arm.chain.tip).joint_names == every[front:]:
            yield Remedy(model, "base", link, "it has a longer base")
    if back < len(every):
        link = joints[every[back]].parent
        if arm.robot.chain(base=arm.chain.base, tip=link).joint_names == every[:back]:
            yield Remedy(model, "tip", link, "it has a longer end")


def _link_at(
    arm: Chosen,
    end: str,
    T: Array,
    tol: Tolerances,
) -> str | None:
    """The link that is fixed to an end at a pose T in it, or None."""
    for link in arm.robot.links:
        if link == end:
            continue
        between = arm.robot.chain(base=end, tip=link)
        if not between.joint_names and still(se3.inverse(T) @ between.home, tol):
            return link
    return None
