"""`fk` and `jacobian` of a subject as `Law`s: of any arm, handed to it as screws, or of its own."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np

from ...model.evaluation import FRAME_NAMES
from .. import exact
from ..configuration_strategies import at_limits, bounds, within_limits
from ..derivative_laws import exact_jacobians
from ..strategies import angles, axes, frozen, magnitudes, st, twists, vectors
from . import confirm, of_arms
from .grades import Grade, Verdict
from .group_cases import coordinates, element
from .law import Case, Law, Shown, typed
from .of_arms import Arm
from .subject import Subject

EACH = 7
"""Numbers of a joint: axis, a point on it, q; six more at the end are the home pose's ω and v."""
LENGTHS = (1e-3, 3.0)


class Limits(NamedTuple):
    """Of the coordinates of a declared arm, in rad or m."""

    lower: tuple[float, ...]
    upper: tuple[float, ...]


def cases(subject: Subject) -> st.SearchStrategy[Case]:
    """Arms of one to four revolute and prismatic joints, and configurations; of a declared arm, the latter only.

    These stay within its limits: a driver may refuse others.
    """
    if subject.arm is not None:
        limits = Limits(*(tuple(side) for side in bounds(subject.arm).T.tolist()))
        inside = st.one_of(within_limits(subject.arm), at_limits(subject.arm))
        return inside.map(lambda q: Case(np.asarray(q), limits))
    return st.lists(_joints(), min_size=1, max_size=4).flatmap(
        lambda joints: twists(math.pi, LENGTHS).map(lambda home: _case(joints, np.asarray(home)))
    )


def _joints() -> st.SearchStrategy[tuple[str, np.ndarray]]:
    signed = st.builds(lambda x, sign: x * sign, angles(), st.sampled_from([1.0, -1.0]))
    turning = st.builds(lambda n, p, q: ("revolute", frozen([*n, *p, q])), axes(), vectors(LENGTHS), signed)
    sliding = st.builds(lambda n, q: ("prismatic", frozen([*n, 0, 0, 0, q])), axes(), magnitudes(1e-6, 2.0))
    return st.one_of(turning, sliding)


def _case(joints: list[tuple[str, np.ndarray]], home: np.ndarray) -> Case:
    return Case(np.concatenate([*(numbers for _, numbers in joints), home]), tuple(kind for kind, _ in joints))


def drawn(case: Case) -> tuple[Arm, np.ndarray]:
    """The arm in floats, and q."""
    kinds, rows = _kinds(case), case.numbers[:-6].reshape(-1, EACH)
    screws = np.zeros((len(rows), 6))
    for kind, row, screw in zip(kinds, rows, screws, strict=True):
        n = row[:3] / math.hypot(*row[:3])
        screw[:] = [*n, *np.cross(row[3:6], n)] if kind == "revolute" else [0, 0, 0, *n]
    return of_arms.arm(screws, element(case.numbers[-6:])), rows[:, 6]


def simpler(case: Case) -> Iterable[Case]:
    """With a joint less."""
    kinds = _kinds(case)
    if len(kinds) > 1:
        for k in range(len(kinds)):
            numbers = np.delete(case.numbers, slice(EACH * k, EACH * (k + 1)))
            yield Case(numbers, kinds[:k] + kinds[k + 1 :])


def allowed(case: Case) -> bool:
    """No axis may vanish, and a declared arm stays within its limits."""
    if isinstance(case.layout, Limits):
        return bool(np.all(case.numbers >= case.layout.lower) and np.all(case.numbers <= case.layout.upper))
    kinds = _kinds(case)
    return all(np.any(case.numbers[EACH * k : EACH * k + 3]) for k in range(len(kinds)))


def triples(case: Case) -> Iterable[int]:
    """Axes, points, and the home pose's halves."""
    n = EACH * len(_kinds(case))
    starts = [at for k in range(0, n, EACH) for at in (k, k + 3)]
    return [*starts, n, n + 3] if n else []


def _of(subject: Subject, case: Case) -> tuple[Any, np.ndarray]:
    return drawn(case) if subject.arm is None else (subject.arm, case.numbers)


def _arguments(subject: Subject, arm: Any) -> tuple[np.ndarray, ...]:
    return () if subject.arm is not None else (subject.twist(arm.screws), arm.home)


def _check_fk(subject: Subject, case: Case) -> Verdict:
    arm, q = _of(subject, case)
    first = _arguments(subject, arm)
    return of_arms.fk_is_the_product_of_exponentials(
        lambda q: subject.own.fk(*map(np.array, first), q), arm, q, Grade.BROKEN
    )


def _check_jacobian(subject: Subject, case: Case) -> Verdict:
    arm, q = _of(subject, case)
    first = _arguments(subject, arm)

    def jacobian(q: np.ndarray) -> np.ndarray:
        J = np.asarray(subject.own.jacobian(*map(np.array, first), q), dtype=float)
        return subject.rows(J) if J.ndim == 2 and len(J) == 6 else J

    return of_arms.jacobian_is_the_derivative(jacobian, subject.frame, arm, q, Grade.BROKEN)


def confirmed(arm: Any, q: np.ndarray, jacobian: bool) -> bool:
    """Whether pose and space Jacobian of an arm stand against the second oracle."""
    x = of_arms.displacements(arm, q)
    if not confirm.of_pose(arm.screws, arm.home, x):
        return False
    every = Arm(arm.screws, arm.home, np.eye(len(x)), np.zeros(len(x)), len(x), 1.0)
    return not jacobian or confirm.of_velocities(arm.screws, arm.home, x, exact_jacobians(every, x)[0])


def _show(name: str, subject: Subject, case: Case) -> Shown:
    arm, q = _of(subject, case)
    values = [f"np.array({typed(x)})" for x in (*_arguments(subject, arm), q)]
    names = ["q"] if len(values) == 1 else ["screws", "home", "q"]
    words = f"q = {typed(q)}"
    if len(values) > 1:
        screws = "; ".join(f"{kind} ({coordinates(S)})" for kind, S in zip(_kinds(case), arm.screws, strict=True))
        words = f"screws {screws}; M = e^ξ of {coordinates(case.numbers[-6:])}; {words}"
    expected = exact.rounded(of_arms.pose(arm, q))
    if name == "jacobian":
        truth = exact_jacobians(arm, exact.exactly(q))[FRAME_NAMES.index(subject.frame)]
        expected = subject.rows(exact.rounded(truth))
    return Shown(words, subject.own_text(name, **dict(zip(names, values, strict=True))), expected)


def _kinds(case: Case) -> tuple[str, ...]:
    return case.layout if isinstance(case.layout, tuple) and not isinstance(case.layout, Limits) else ()


ARM_LAWS = (
    Law(
        "fk", "fk is the product of exponentials", "fk", cases, _check_fk,
        lambda subject, case: confirmed(*_of(subject, case), jacobian=False),
        lambda subject, case: _show("fk", subject, case), simpler, triples, allowed,
    ),
    Law(
        "jacobian", "the Jacobian is the derivative of the product of exponentials", "jacobian", cases,
        _check_jacobian, lambda subject, case: confirmed(*_of(subject, case), jacobian=True),
        lambda subject, case: _show("jacobian", subject, case), simpler, triples, allowed,
    ),
)  # fmt: skip
"""The battery for poses and Jacobians of arms."""
