"""The sentences of a comparison: what differs, what was aligned, and what else says the same."""

from __future__ import annotations

import numpy as np

from ...errors import quote
from ...groups import se3
from ...groups.arrays import Array
from ...model.chain import Chain
from ..amounts import amount, joint_unit
from ..axis_lines import Tolerances
from .alignment.hypotheses import Hypothesis, motion_sizes, still
from .comparison import JointComparison


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
        words.append(
            f"has its zero position {amount(abs(joint.zero_offset), joint.unit)} from the other model's"
        )
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


def differences(
    joints: tuple[JointComparison, ...],
    tol: Tolerances,
    link: int = 0,
) -> list[str]:
    """One clause a joint that differs; where the axes behind joint `link` moved together, one for
    them.

    As in "joint 4 ('elbow') has an axis that is 3.2 mm from the other model's".
    """
    if link and not any(joint.coupling_differs for joint in joints):
        first = next(joint for joint in joints[link:] if joint.axis_differs)
        return [
            f"the link between joint {link} ({quote(joints[link - 1].name_a)}) and joint {link + 1} "
            f"({quote(joints[link].name_a)}) differs: from joint {first.number} on the axes have moved together, and "
            f"joint {first.number} {joint_words(first, tol)}"
        ]
    named = ((j, joint_words(j, tol)) for j in joints)
    return [f"joint {j.number} ({quote(j.name_a)}) {words}" for j, words in named if words]


def frame_words(what: str, T: Array, tol: Tolerances) -> str:
    """The motion of a frame, or empty: "the base frame is moved by 12 mm and turned by 3°"."""
    if still(T, tol):
        return ""
    distance, angle = map(float, motion_sizes(T))
    said = []
    if distance > tol.position:
        said.append(f"moved by {amount(distance, 'm')}")
    if angle > tol.rotation:
        said.append(f"turned by {amount(angle, 'rad')}")
    return f"the {what} frame is {' and '.join(said)}"


def unit_words(ratio: float) -> str:
    """The sentence on lengths of one model that are 1000 times the other's: ratio is b's by a's."""
    larger = "b"
    smaller = "a"
    if ratio < 1:
        larger = "a"
        smaller = "b"
        ratio = 1 / ratio
    return f"lengths of model {larger} are {ratio:.4g} times those of model {smaller} (millimetres against metres?)"


def equivalents(
    a: Chain,
    b: Chain,
    first: Hypothesis,
    others: list[Hypothesis],
    tol: Tolerances,
) -> list[str]:
    """Other readings of the same difference: frames turned about an end joint, other joints that
    may be implicated.
    """
    said = []
    if len(a.screws):
        last = se3.adjoint(se3.inverse(b.home)) @ b.screws[-1]
        ends = (
            ("base", first.base, a.screws[0] * first.directions[0], 1),
            ("tool", first.tool, last, len(a.screws)),
        )
        for what, T, S, number in ends:
            size = _about(T, S, tol)
            if size is not None and not still(T, tol):
                far = amount(size, joint_unit(b.kinds[number - 1]))
                name = a.joint_names[number - 1]
                said.append(
                    f"the {what} moved by {far} along or about the axis of joint {number} ({quote(name)}) is the same "
                    f"as a zero offset of {far} of that joint"
                )
    for other in others:
        (k,) = np.flatnonzero(other.implicated)
        change = "the other direction"
        if other.moved[k]:
            change = "another axis"
        elif other.offset[k]:
            change = "a zero offset"
        if other.offset[k]:
            change += f" of {amount(other.zeros[k], joint_unit(b.kinds[k]))}"
        said.append(
            f"{change} of joint {k + 1} ({quote(a.joint_names[k])}), with the base and tool frames "
            "aligned to that, explains it as well"
        )
    return said


def _about(T: Array, S: Array, tol: Tolerances) -> float | None:
    """z with T = e^{S z} within tolerance, or None."""
    xi = se3.log(T)
    part = slice(0, 3)
    if not S[:3].any():
        part = slice(3, 6)
    z = float(xi[part] @ S[part])
    for value in (z, -z):  # at half a turn the logarithm may come with either sign
        if still(se3.inverse(se3.exp(S * value)) @ T, tol):
            return value
    return None
