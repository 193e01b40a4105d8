"""The sentences of a comparison: what differs, what was aligned, and what else says the same."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ...errors import quote
from ...groups.arrays import Array
from ...model.chain import Chain
from ..amounts import Unit, amount, joint_unit
from ..axis_lines import Tolerances
from .alignment.diagnosis import AlignedTo
from .alignment.hypotheses import Hypothesis, motion_sizes, still
from .comparison import JointComparison
from .differences.end_zeros import end_turns


class Said(NamedTuple):
    """Matters said of joints beside axes, zeros and directions: the numbers of those with other
    limits, whether other names are, and the numbers of those behind another link that differ too.
    """

    limits: frozenset[int] = frozenset()
    names: bool = False
    apart: frozenset[int] = frozenset()


def joint_words(joint: JointComparison, tol: Tolerances) -> str:
    """Differences of one joint, as the end of a sentence that begins with its name; empty where
    there are none.
    """
    words = []
    if joint.kind_a != joint.kind_b:
        words.append(f"is {joint.kind_a} in one model and {joint.kind_b} in the other")
    elif joint.axis_differs:
        words.append(f"has {_axis_words(joint, tol)}")
    if joint.zero_differs:
        words.append(f"has its zero {amount(abs(joint.zero_offset), joint.unit)} elsewhere")
    if joint.reversed and joint.kind_a == joint.kind_b:
        words.append("has the sign of q flipped")
    if joint.coupling_differs:
        one, other = (said or "moves by itself" for said in (joint.follows_a, joint.follows_b))
        words.append(f"{one} in one model and {other} in the other")
    return " and ".join(words)


def _axis_words(joint: JointComparison, tol: Tolerances) -> str:
    """The difference of an axis."""
    shift = joint.shift or 0.0
    normal = joint.normal or 0.0
    far = ""
    if shift > tol.position:
        far = amount(shift, "m")
    if joint.angle > tol.rotation:
        apart = f"turned by {amount(joint.angle, 'rad')}"
        if normal > tol.position:
            apart = f"{amount(joint.angle, 'rad')} and {amount(normal, 'm')}"
        if far:
            far = f" ({far} at the arm)"
        return f"an axis that is {apart} from the other model's{far}"
    if far:
        return f"an axis that is {far} from the other model's"
    return "another pitch"


def joint_findings(
    joints: tuple[JointComparison, ...],
    tol: Tolerances,
    said: Said,
    link: int = 0,
) -> list[str]:
    """One clause a joint that differs; where the axes behind joint `link` moved together, one for
    them.

    As in "joint 4 ('elbow') has an axis that is 3.2 mm from the other model's: 4 mm at the tool".
    """
    found = []
    if link:
        behind = [j for j in joints[link:] if j.axis_differs and j.number not in said.apart]
        first = behind[0]
        only_axis = replace(first, zero_differs=False, reversed=False, coupling_differs=False)
        found.append(
            f"the link between {_named(joints[link - 1])} and {_named(joints[link])} differs: from joint"
            f" {first.number} on the axes have moved together, and "
            f"joint {first.number} {joint_words(only_axis, tol)}"
        )
    for k, joint in enumerate(joints):
        if 0 < link <= k and joint.number not in said.apart:
            joint = replace(joint, axis_differs=False)
        words = [joint_words(joint, tol)]
        if words[0]:
            words = [words[0] + _effect_words(joint.effect, tol)]
        if said.limits and joint.number in said.limits:
            words.append(limit_words(joint))
        if said.names and joint.name_a != joint.name_b:
            words.append(f"is called {quote(joint.name_b)} in model b")
        clause = ", and ".join(filter(None, words))
        if clause:
            found.append(f"{_named(joint)} {clause}")
    return found


def _named(joint: JointComparison) -> str:
    return f"joint {joint.number} ({quote(joint.name_a)})"


ARTICLES = {"lower": "a", "upper": "an"}


def limit_words(joint: JointComparison) -> str:
    """The difference of a joint's limits: "has its upper limit 10° lower in model b"."""
    sides = []
    for which, change, ahead in zip(
        ("lower", "upper"),
        joint.limits,
        (math.inf, -math.inf),
        strict=True,
    ):
        if math.isinf(change):
            model = "b" if change == ahead else "a"
            sides.append(f"{ARTICLES[which]} {which} limit in model {model} alone")
        elif change:
            way = "higher" if change > 0 else "lower"
            sides.append(f"its {which} limit {amount(abs(change), joint.unit)} {way} in model b")
    return f"has {' and '.join(sides)}"


def _effect_words(effect: float, tol: Tolerances) -> str:
    """The largest motion of the tool that a difference makes, or empty: ": 64 mm at the tool"."""
    if not effect > tol.position:
        return ""
    return f": {_rounded(effect)} at the tool"


def _rounded(length: float) -> str:
    """A length in mm to whole mm, or two digits where it is small."""
    if length >= 0.01:
        return f"{1e3 * length:.0f} mm"
    return amount(length, "m", 2)


def frame_words(
    what: str,
    T: Array,
    tol: Tolerances,
    effect: float = 0.0,
) -> str:
    """The motion of a frame, or empty: "the base frame is moved by 12 mm and turned by 3°", and
    what that makes at the tool.
    """
    if still(T, tol):
        return ""
    distance, angle = map(float, motion_sizes(T))
    said = []
    if distance > tol.position:
        said.append(f"moved by {amount(distance, 'm')}")
    if angle > tol.rotation:
        said.append(f"turned by {amount(angle, 'rad')}")
    return f"the {what} frame is {' and '.join(said)}{_effect_words(effect, tol)}"


def unit_words(ratio: float) -> str:
    """The sentence on lengths of one model that are 1000 times the other's: ratio is b's by a's."""
    larger = "ab"[ratio > 1]
    smaller = "ab"[ratio < 1]
    times = max(ratio, 1 / ratio)
    return f"lengths of model {larger} are {times:.4g} times those of model {smaller} (millimetres against metres?)"


def count_words(count: int) -> str:
    """A number of joints: "one joint", "3 joints"."""
    return {1: "one joint", 2: "two joints"}.get(count, f"{count} joints")


def alignment_words(aligned_to: AlignedTo) -> str:
    """The way in which base and tool were aligned, ahead of what moved."""
    if aligned_to == "all axes":
        return "aligned to all axes by least squares, as fewer than half agree"
    return "aligned"


def mirror_words(axis: str) -> str:
    """The sentence on a model that mirrors the other one."""
    return f"model b is a mirrored: {axis} of its base is -{axis} of a's (left-handed coordinates?)"


ZERO_DEGREES = "zeros differ as if one model had degrees for radians (degrees in rpy?)"


def degree_words(model: str) -> str:
    """The sentence on a model with degrees where radians are meant."""
    return f"links of model {model} turn by as many radians as the other's by degrees (degrees in rpy?)"


def equivalents(
    a: Chain,
    b: Chain,
    numbers: Iterable[int],
    first: Hypothesis,
    others: list[Hypothesis],
    tol: Tolerances,
) -> list[str]:
    """Other readings of the same difference: frames turned about an end joint, other joints that
    may be implicated.
    """
    said = []
    named = zip(numbers, a.joint_names, strict=True)
    names = [f"joint {number} ({quote(name)})" for number, name in named]
    units: list[Unit] = [joint_unit(kind) for kind in b.kinds]
    for frame, k, z in end_turns(a, b, first, tol):
        far = amount(z, units[k])
        said.append(
            f"the {frame} moved by {far} along or about the axis of {names[k]} is the "
            f"same as a zero offset of {far} of that joint"
        )
    k = first.link
    if k and a.kinds[k] == "prismatic" and not first.moved[k]:
        said.append(f"the link behind {names[k]}, which slides, explains it as well")
    for other in others:
        (k,) = np.flatnonzero(other.implicated)
        change = "the other direction"
        if other.moved[k]:
            change = "another axis"
        elif other.offset[k]:
            change = "a zero offset"
        if other.offset[k]:
            change += f" of {amount(other.zeros[k], units[k])}"
        said.append(
            f"{change} of {names[k]}, with the base and tool frames "
            "aligned to that, explains it as well"
        )
    return said
