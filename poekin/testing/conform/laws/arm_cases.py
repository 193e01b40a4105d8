"""`fk` and `jacobian` of a subject as `SubjectLaw`s: of any arm, handed to it as screws, or of its own."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any, NamedTuple, cast

import numpy as np

from ....groups.arrays import Array
from ....model.kinematics.pose_jacobian import FRAME_NAMES
from ...laws.measures import size
from ...oracles import exact, exact_chain
from ...oracles.differences import NamedFrame
from ...strategies.configuration_strategies import at_limits, bounds, within_limits
from ...strategies.group_strategies import (
    SMALLEST,
    angles,
    axes,
    frozen,
    magnitudes,
    st,
    twists,
    vectors,
)
from .. import confirm
from ..grades import Grade, Verdict
from ..process.calls import real
from ..subjects.subject import Subject
from . import of_arms
from .group_cases import coordinates, element
from .law import Case, Cases, Shown, SubjectLaw, drawable, typed, unit
from .of_arms import ArmData

EACH = 8
"""Numbers of a joint: axis, a point on it, q, pitch; six more at the end are the home pose's ω and
v.
"""
TAIL = 6
LENGTHS = (1e-3, 3.0)
PITCHES = (1e-3, 1.0)
TRAVELS = (1e-6, 2.0)
TURNS = (SMALLEST, math.pi)
KINDS = ("revolute", "prismatic")


class ScrewNumbers(NamedTuple):
    """Numbers of a joint: its axis, a point on it, q, and its pitch."""

    axis: Array
    point: Array
    q: float
    pitch: float


def numbers_of(case: Case) -> list[ScrewNumbers]:
    """Numbers of each joint."""
    rows = case.numbers[:-TAIL].reshape(-1, EACH)
    return [ScrewNumbers(x[:3], x[3:6], *x[6:].tolist()) for x in rows]


class CoordinateLimits(NamedTuple):
    """Limits of the coordinates of a declared arm, in rad or m."""

    lower: tuple[float, ...]
    upper: tuple[float, ...]


def cases(subject: Subject, kinds: tuple[str, ...] = KINDS) -> Cases:
    """Arms of one to four joints of these kinds, and configurations; of a declared arm, the latter
    only.

    These stay within its limits: a driver may refuse others.
    """
    if subject.arm is not None:
        limits = CoordinateLimits(*(tuple(side) for side in bounds(subject.arm).T.tolist()))
        inside = st.one_of(within_limits(subject.arm), at_limits(subject.arm))
        return inside.map(lambda q: Case(np.asarray(q), limits))
    joints = st.lists(_joints(kinds), min_size=1, max_size=4)
    return st.builds(_case, joints, twists(math.pi, LENGTHS))


def _joints(kinds: tuple[str, ...]) -> st.SearchStrategy[tuple[str, Array]]:
    signs = st.sampled_from([1.0, -1.0])
    turns = st.builds(lambda x, sign: x * sign, angles(), signs)
    pitches = st.builds(lambda x, sign: x * sign, magnitudes(*PITCHES), signs)
    nought = st.just(0.0)
    one = {
        "revolute": st.builds(_numbers, axes(), vectors(LENGTHS), turns, nought),
        "prismatic": st.builds(
            _numbers,
            axes(),
            st.just(np.zeros(3)),
            magnitudes(*TRAVELS),
            nought,
        ),
        "helical": st.builds(_numbers, axes(), vectors(LENGTHS), turns, pitches),
    }
    return st.one_of(*(st.tuples(st.just(kind), one[kind]) for kind in kinds))


def _numbers(
    axis: Array,
    point: Array,
    q: float,
    pitch: float,
) -> Array:
    return frozen([*axis, *point, q, pitch])


def _case(
    joints: list[tuple[str, Array]],
    home: Array,
) -> Case:
    return Case(
        np.concatenate([*(numbers for _, numbers in joints), home]),
        tuple(kind for kind, _ in joints),
    )


def drawn(case: Case) -> tuple[ArmData, Array]:
    """The arm in floats, and q."""
    joints = numbers_of(case)
    screws = np.zeros((len(joints), 6))
    for kind, joint, screw in zip(_kinds(case), joints, screws, strict=True):
        n = joint.axis / math.hypot(*joint.axis)
        if kind == "prismatic":
            screw[3:] = n
        else:
            screw[:3] = n
            screw[3:] = np.cross(joint.point, n) + joint.pitch * n
    q = np.array([joint.q for joint in joints])
    return of_arms.arm(screws, element(case.numbers[-TAIL:])), q


def simpler(case: Case) -> Iterable[Case]:
    """With a joint less."""
    kinds = _kinds(case)
    if len(kinds) > 1:
        for k in range(len(kinds)):
            numbers = np.delete(case.numbers, slice(EACH * k, EACH * (k + 1)))
            yield Case(numbers, kinds[:k] + kinds[k + 1 :])


def allowed(case: Case) -> bool:
    """Axes keep their length, and all numbers their range; a declared arm stays within its limits."""
    if isinstance(case.layout, CoordinateLimits):
        return bool(
            np.all(case.numbers >= case.layout.lower) and np.all(case.numbers <= case.layout.upper)
        )
    w, v = np.split(case.numbers[-TAIL:], 2)
    if not (drawable(size(w), TURNS) and drawable(size(v), LENGTHS)):
        return False
    return all(map(_allowed, _kinds(case), numbers_of(case)))


def _allowed(kind: str, joint: ScrewNumbers) -> bool:
    return (
        unit(joint.axis)
        and drawable(size(joint.point), LENGTHS)
        and drawable(joint.q, TRAVELS if kind == "prismatic" else TURNS)
        and drawable(joint.pitch, PITCHES)
    )


def triples(case: Case) -> Iterable[int]:
    """Points on the axes, and the home pose's halves."""
    n = EACH * len(_kinds(case))
    if n == 0:
        return []
    return [*range(3, n, EACH), n, n + 3]


def directions(case: Case) -> Iterable[int]:
    """Axes."""
    return range(0, EACH * len(_kinds(case)), EACH)


def _of(
    subject: Subject,
    name: str,
    case: Case,
) -> tuple[Any, Array]:
    if subject.arm is not None:
        return subject.arm, case.numbers
    arm, q = drawn(case)
    rounded = subject.precision(name).rounded
    return of_arms.arm(rounded(arm.screws), rounded(arm.home)), q


def _arguments(subject: Subject, arm: Any) -> tuple[Array, ...]:
    if subject.arm is not None:
        return ()
    return subject.twist(arm.screws), arm.home


def _check_fk(subject: Subject, case: Case) -> Verdict:
    arm, q = _of(subject, "fk", case)
    first = _arguments(subject, arm)
    return of_arms.fk_is_the_product_of_exponentials(
        lambda q: subject.plain("fk")(*map(np.array, first), q),
        arm,
        q,
        Grade.BROKEN,
        subject.precision("fk"),
    )


def _check_jacobian(subject: Subject, case: Case) -> Verdict:
    arm, q = _of(subject, "jacobian", case)
    first = _arguments(subject, arm)

    def jacobian(q: Array) -> Array:
        J = real(subject.plain("jacobian")(*map(np.array, first), q))
        if J.shape != (6, len(q)):
            return J
        return subject.rows(J)

    frame = cast(NamedFrame, subject.frame)
    precision = subject.precision("jacobian")
    return of_arms.jacobian_is_the_derivative(jacobian, frame, arm, q, Grade.BROKEN, precision)


def confirmed(
    arm: Any,
    q: Array,
    jacobian: bool,
) -> bool:
    """Whether pose and space Jacobian of an arm stand against the second oracle."""
    x = exact_chain.displacements(arm, q)
    if not confirm.of_pose(arm.screws, arm.home, x):
        return False
    every = of_arms.arm(arm.screws, arm.home)
    return not jacobian or confirm.of_velocities(
        arm.screws,
        arm.home,
        x,
        exact_chain.jacobians(every, x)[0],
    )


def _show(
    name: str,
    subject: Subject,
    case: Case,
) -> Shown:
    arm, q = _of(subject, name, case)
    values = [f"np.array({typed(x)})" for x in (*_arguments(subject, arm), q)]
    names = ("screws", "home", "q")[-len(values) :]
    words = f"q = {typed(q)}"
    if len(values) > 1:
        screws = "; ".join(
            f"{kind} ({coordinates(S)})" for kind, S in zip(_kinds(case), arm.screws, strict=True)
        )
        words = f"screws {screws}; M = e^ξ of {coordinates(case.numbers[-TAIL:])}; {words}"
    expected = truth(subject, arm, q, name == "jacobian")
    return Shown(words, subject.call(name, **dict(zip(names, values, strict=True))), expected)


def truth(
    subject: Subject,
    arm: Any,
    q: Array,
    jacobian: bool,
) -> Array:
    """The exact pose, or the Jacobian as the subject has it, in floats; what is 0 to 60 digits of
    the largest is 0.
    """
    if jacobian:
        J = exact_chain.jacobians(arm, exact.exactly(q))[FRAME_NAMES.index(subject.frame)]
        return subject.rows(_without_rounding(J))
    return _without_rounding(exact_chain.pose(arm, q))


def _without_rounding(found: Array) -> Array:
    x = exact.rounded(found)
    return np.where(np.abs(x) < 1e-60 * np.max(np.abs(x), initial=0.0), 0.0, x)


def _kinds(case: Case) -> tuple[str, ...]:
    if isinstance(case.layout, CoordinateLimits):
        return ()
    return case.layout


def _law(
    function: str,
    says: str,
    helical: bool = False,
) -> SubjectLaw:
    jacobian = function == "jacobian"
    name = function
    kinds = KINDS
    if helical:
        name = f"{function} helical"
        kinds = (*KINDS, "helical")

    def about(case: Case) -> bool:
        return not helical or any(joint.pitch for joint in numbers_of(case))

    return SubjectLaw(
        name=name,
        says=says,
        needs=function,
        cases=lambda subject: cases(subject, kinds),
        check=_check_jacobian if jacobian else _check_fk,
        confirm=lambda subject, case: confirmed(*_of(subject, function, case), jacobian),
        show=lambda subject, case: _show(function, subject, case),
        simpler=simpler,
        triples=triples,
        directions=directions,
        allowed=allowed,
        applies=lambda subject: not helical or (subject.helical and subject.arm is None),
        about=about,
        unless="helical = True is not declared, or an arm is",
        examples=150,
    )


ARM_LAWS = (
    _law("fk", "fk is the product of exponentials"),
    _law(
        "jacobian",
        "the Jacobian is the derivative of the product of exponentials",
    ),
    _law("fk", "a joint with a pitch turns and slides at once", True),
    _law(
        "jacobian",
        "the Jacobian of joints with a pitch is the derivative",
        True,
    ),
)
"""The battery for poses and Jacobians of arms."""
