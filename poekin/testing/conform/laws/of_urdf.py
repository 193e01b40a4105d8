"""A reader of URDFs held to the definition: poses and Jacobians of what it read of a small one, and
how to show it.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, cast

import numpy as np

from ...oracles import exact_chain
from ...oracles.differences import NamedFrame
from .. import confirm
from ..grades import Verdict, graded
from ..process.calls import Undeclared, called, made, untouched
from ..subjects.subject import Subject, printed
from . import arm_cases, of_arms, small_urdf
from .law import Case, Shown, typed


def check(
    subject: Subject,
    case: Case,
    jacobian: bool,
) -> Verdict:
    """Whether what the subject reads out of the URDF has the pose, or the Jacobian, of the
    definition.
    """
    law = "read_urdf"
    read, fault = made(lambda: subject.own.read_urdf(small_urdf.text(case), "base", "tip"))
    if fault:
        return graded(law, fault)
    arm, q, names = small_urdf.arm(case)
    values, found, fault = _given(case, read, names)
    if fault:
        return graded(law, fault)
    if not jacobian:
        T, fault = called(lambda q: subject.noted(law, read.fk(q)), (4, 4), values)
        return graded(law, fault or of_arms.pose_parts(arm, q, T, subject.precision(law)))
    function, fault = made(lambda: getattr(read, "jacobian", None))
    if function is None and not fault:
        raise Undeclared(
            "what read_urdf returns has no `jacobian`, though the subject declares jacobian_frame"
        )
    J, fault = called(lambda q: subject.noted(law, read.jacobian(q)), (6, len(found)), values)
    if fault:
        return graded(law, fault)
    frame = cast(NamedFrame, subject.frame)
    J = subject.rows(J)[:, [found.index(name) for name in names]]
    return graded(law, of_arms.jacobian_parts(frame, arm, q, J, subject.precision(law)))


def check_robot(subject: Subject, case: Case) -> Verdict:
    """Whether what the subject reads out of the URDF has the pose of each link."""
    law = "read_robot"
    robot, fault = made(lambda: subject.own.read_robot(small_urdf.text(case)))
    if fault:
        return graded(law, fault)
    values, _, fault = _given(case, robot, small_urdf.coordinates(case))
    if fault:
        return graded(law, fault)
    poses, fault = made(lambda: untouched(robot.poses)(values.copy()))
    if not fault and not isinstance(poses, Mapping):
        poses, fault = made(lambda: dict(poses))
    if fault:
        return graded(law, fault)
    verdicts = []
    for k in range(len(small_urdf.rows_of(case))):
        name = small_urdf.link(case, k)
        arm, q, _ = small_urdf.arm(case, k)
        T, fault = called(lambda name=name: subject.noted(law, poses[name]), (4, 4))
        if fault:
            verdicts.append(graded(law, f"of link {name}: {fault}"))
            continue
        verdict = graded(law, of_arms.pose_parts(arm, q, T, subject.precision(law)))
        verdicts.append(verdict._replace(what=f"{verdict.what}, of {name}"))
    return max(verdicts, key=lambda verdict: verdict.rank)


def _given(
    case: Case,
    read: Any,
    names: Iterable[str],
) -> tuple[np.ndarray, list[str], str]:
    """The values of what was read, in its order, and its names; or the fault: one of these names is
    none of its.
    """
    found, fault = made(lambda: [str(name) for name in read.names])
    if fault:
        return np.array([]), [], f"`names` of what was read: {fault}"
    lost = [name for name in names if name not in found]
    if lost:
        return (
            np.array([]),
            [],
            f"no coordinate {', '.join(lost)} among those read: {', '.join(found) or 'none'}",
        )
    given = small_urdf.coordinates(case)
    return np.array([given.get(name, 0.0) for name in found]), found, ""


def confirmed(
    case: Case,
    jacobian: bool,
    links: Iterable[int] = (small_urdf.TIP,),
) -> bool:
    """Whether the exact poses of links, and the Jacobian, stand against the second oracle."""
    for k in links:
        arm, q, _ = small_urdf.arm(case, k)
        pose = confirm.near(confirm.chain_of(small_urdf.factors(case, k)), exact_chain.pose(arm, q))
        if not pose or not arm_cases.confirmed(arm, q, jacobian):
            return False
    return True


def show(
    subject: Subject,
    case: Case,
    function: str,
) -> Shown:
    """The URDF and the values of its joints, as Python; the function is fk, jacobian or poses, of
    what was read.

    The names that were read are printed as well: the pose is the exact one where only a name is
    wrong or missing.
    """
    values = small_urdf.coordinates(case)
    text = small_urdf.text(case)
    if function == "poses":
        places = range(len(small_urdf.rows_of(case)))
        links = [small_urdf.link(case, k) for k in places]
        read = f"read_robot({text!r})"
        result = f"[read.poses(q)[link] for link in {links!r}]"
        arms = [small_urdf.arm(case, k) for k in places]
        expected = np.array([arm_cases.truth(subject, arm, q, False) for arm, q, _ in arms])
        names = list(values)
    else:
        read = f"read_urdf({text!r}, 'base', 'tip')"
        result = f"read.{function}(q)"
        arm, q, names = small_urdf.arm(case)
        expected = arm_cases.truth(subject, arm, q, function == "jacobian")
    lines = [
        "import numpy as np",
        *subject.source.lines,
        f"read = {subject.source.made}.{read}",
        "print(list(read.names))",
        f"q = np.array([{values!r}.get(name, 0.0) for name in read.names])",
        printed(result),
    ]
    return Shown(f"q = {values}, {_words(case)}", "; ".join(lines), expected, tuple(names))


def _words(case: Case) -> str:
    """Each joint in a few words."""
    layout = case.layout
    said = []
    for k, (joint, own) in enumerate(zip(layout.joints, small_urdf.numbers_of(case), strict=True)):
        words = f"{joint.name} {joint.kind}"
        if layout.after[k] != k - 1:
            words += f" behind {small_urdf.link(case, layout.after[k])}"
        if joint.kind != "fixed":
            axis = "no axis written (which means x)"
            if joint.axis:
                axis = f"axis {typed(own.axis)}"
            words += f", {axis}"
        for what, numbers in (("xyz", own.xyz), ("rpy", own.rpy)):
            if np.any(numbers):
                words += f", {what} {typed(numbers)}"
        if joint.follows >= 0:
            master = layout.joints[joint.follows].name
            words += f", mimics {master} × {1 + own.factor:g} + {own.shift:g}"
        said.append(words)
    return "; ".join(said)
