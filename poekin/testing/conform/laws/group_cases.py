"""The laws of `of_groups` as `SubjectLaw`s: what each is tried on, and how a case is shown."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable

import numpy as np

from ....groups.arrays import Array
from ...laws.measures import size
from ...oracles import exact
from ...strategies.batch_strategies import batch_shapes, batches
from ...strategies.group_strategies import (
    LENGTHS,
    SMALLEST,
    Arrays,
    noisy_rotations,
    rotation_vectors,
    twists,
)
from .. import confirm
from ..grades import Grade, Verdict, graded
from ..process.calls import called
from ..subjects.subject import JACOBIANS, SE3, SO3, Subject
from . import of_groups
from .law import Case, Cases, Shown, SubjectLaw, drawable, nothing, typed

FAR = 10.0
"""The largest |ω| in rad that exp and the Jacobians of exp are tried at; log, and inverses, to π.
"""
EXAMPLES = 400
"""Cases of a law that costs a few milliseconds each."""
NOTHING = Verdict(Grade.EXACT, 0.0, "empty batch")
Checked = Callable[..., Verdict]


def element(xi: Array) -> Array:
    """The rotation or pose of floats nearest to the exact e^ξ."""
    return exact.rounded(exact.exp(xi))


def _largest(name: str) -> float:
    if any(word in name for word in ("log", "inverse", "adjoint")):
        return math.pi
    return FAR


def _numbers(name: str) -> Arrays:
    strategy = {3: rotation_vectors, 6: twists}[_count(name)]
    return strategy(_largest(name))


def _count(name: str) -> int:
    """Number of exponential coordinates."""
    if name in SO3:
        return 3
    return 6


def _drawable(name: str, xi: Array) -> bool:
    angle = size(xi[:3])
    return (
        drawable(angle, (SMALLEST, math.inf))
        and angle <= _largest(name)
        and drawable(size(xi[3:]), LENGTHS)
    )


def _takes_element(name: str) -> bool:
    return name.endswith("log") or name == "adjoint"


def _argument(
    subject: Subject,
    name: str,
    xi: Array,
) -> Array:
    if not _takes_element(name):
        return xi
    return subject.precision(name).rounded(element(xi))


def _checked(name: str) -> Checked:
    plain = name.removeprefix("so3_")
    if plain in JACOBIANS:
        return of_groups.jacobian_of_exp(plain)
    return {
        "exp": of_groups.exp_is_e_to_the_xi,
        "log": of_groups.log_is_the_principal_logarithm,
        "adjoint": of_groups.adjoint_is_its_matrix,
    }[plain]


def _confirmed(
    subject: Subject,
    name: str,
    xi: Array,
) -> bool:
    plain = name.removeprefix("so3_")
    if plain in JACOBIANS:
        return confirm.of_jacobian(plain, xi)
    if plain == "exp":
        return confirm.of_exp(xi)
    X = _argument(subject, name, xi)
    # The argument itself stands on exp: it is confirmed too.
    if not confirm.of_exp(xi):
        return False
    if plain == "log":
        return confirm.of_log(X)
    return confirm.of_adjoint(X, 100 * subject.precision(name).unit)


def _truth(
    subject: Subject,
    name: str,
    xi: Array,
) -> Array:
    return exact.rounded(getattr(exact, name.removeprefix("so3_"))(_argument(subject, name, xi)))


def _in_order(
    subject: Subject,
    name: str,
    x: Array,
) -> Array:
    """An argument or a result of a function, in the subject's own order."""
    if name in SO3 or x.shape[-2:] == (4, 4):
        return x
    if x.shape[-2:] == (6, 6):
        return subject.square(x)
    return subject.twist(x)


def coordinates(xi: Array) -> str:
    """Exponential coordinates in words, to the last digit."""
    texts = [f"{x + 0.0!r}".removesuffix(".0") for x in xi.tolist()]
    words = f"ω = ({', '.join(texts[:3])})"
    if len(xi) == 6:
        words += f", v = ({', '.join(texts[3:])})"
    return words


def _group_law(name: str) -> SubjectLaw:
    check = _checked(name)

    def measured(subject: Subject, case: Case) -> Verdict:
        x = _argument(subject, name, case.numbers)
        return check(subject.function(name), x, Grade.BROKEN, subject.precision(name))

    def show(subject: Subject, case: Case) -> Shown:
        x = _in_order(subject, name, _argument(subject, name, case.numbers))
        truth = _in_order(subject, name, _truth(subject, name, case.numbers))
        words = coordinates(case.numbers)
        if _takes_element(name):
            words = f"e^ξ, rounded, of {words}"
        return Shown(words, subject.call(name, x=f"np.array({typed(x)})"), truth)

    return SubjectLaw(
        name=name,
        says=SAYS.get(name, SAYS.get(name.removeprefix("so3_"), "")),
        needs=name,
        cases=lambda _: _numbers(name).map(Case),
        check=measured,
        confirm=lambda subject, case: _confirmed(subject, name, case.numbers),
        show=show,
        allowed=lambda case: _drawable(name, case.numbers),
        examples=EXAMPLES,
    )


SAYS = {
    "exp": f"exp ξ = e^ξ, |ω| up to {FAR:g}",
    "so3_log": "log of a rotation is its principal logarithm, |ω| up to π",
    "log": "log of a pose is its principal logarithm, |ω| up to π",
    "adjoint": "Ad(T) = [R 0; [t] R R]",
    "left_jacobian": f"(d e^ξ) e^-ξ = J_l dξ, |ω| up to {FAR:g}",
    "right_jacobian": f"e^-ξ (d e^ξ) = J_r dξ, |ω| up to {FAR:g}",
    "left_jacobian_inverse": "the inverse of J_l, |ω| up to π",
    "right_jacobian_inverse": "the inverse of J_r, |ω| up to π",
}


def _noise_law() -> SubjectLaw:
    def cases(subject: Subject) -> Cases:
        return noisy_rotations((1e-17, subject.noise)).map(lambda R: Case(np.asarray(R).ravel()))

    def R(case: Case) -> Array:
        return case.numbers.reshape(3, 3)

    def show(subject: Subject, case: Case) -> Shown:
        text = subject.call("so3_log", x=f"np.array({typed(R(case))})")
        return Shown("a rotation with noise", text, exact.rounded(exact.log(R(case))))

    def check(subject: Subject, case: Case) -> Verdict:
        precision = subject.precision("so3_log")
        return of_groups.log_forgives_noise(
            subject.function("so3_log"),
            R(case),
            Grade.BROKEN,
            precision,
        )

    return SubjectLaw(
        name="noise",
        says="log of a rotation with noise is that of the nearest rotation",
        needs="so3_log",
        cases=cases,
        check=check,
        confirm=lambda _, case: confirm.of_log(R(case)),
        show=show,
        triples=nothing,
        # Shrinking would leave the neighbourhood of the rotations.
        allowed=lambda _: False,
        applies=lambda subject: subject.noise > 0,
        unless="noise is not declared",
        examples=EXAMPLES,
    )


def _batch_law(name: str) -> SubjectLaw:
    """The law of a function of a batch: its value is that of each element."""
    count = _count(name)
    numbers = _numbers(name)
    judge = _checked(name)

    @functools.cache
    def of(shape: tuple[int, ...]) -> Cases:
        return batches(numbers, shape).map(lambda x: Case(np.asarray(x).ravel(), shape))

    def rows(case: Case) -> Array:
        return case.numbers.reshape(-1, count)

    def batch(
        subject: Subject,
        case: Case,
        function: Callable[[Subject, str, Array], Array],
    ) -> Array:
        """Values of a function at each row, in the shape of the batch."""
        one = function(subject, name, np.zeros(count))
        made = [function(subject, name, row) for row in rows(case)]
        return np.reshape(made, (*case.layout, *one.shape))

    def check(subject: Subject, case: Case) -> Verdict:
        x = batch(subject, case, _argument)
        tail = _truth(subject, name, np.zeros(count)).shape
        result, fault = called(subject.function(name), (*case.layout, *tail), x)
        if fault:
            return graded(f"batches of {name}", fault)
        flat = x.reshape(-1, *x.shape[len(case.layout) :])
        precision = subject.precision(name)
        verdicts = [
            judge(lambda _, row=row: row, one, Grade.BROKEN, precision)
            for one, row in zip(flat, result.reshape(-1, *tail), strict=True)
        ]
        return max(verdicts, key=lambda v: v.rank, default=NOTHING)

    def show(subject: Subject, case: Case) -> Shown:
        x = _in_order(subject, name, batch(subject, case, _argument))
        text = f"np.reshape({typed(x.ravel())}, {x.shape})"
        words = f"a batch {case.layout} of {'; '.join(map(coordinates, rows(case)))}"
        expected = _in_order(subject, name, batch(subject, case, _truth))
        return Shown(words, subject.call(name, x=text), expected)

    return SubjectLaw(
        name=f"{name} of batches",
        says=f"{name} of a batch is {name} of each, in shapes (), (1,), (0,), (3, 1, 2)",
        needs=name,
        cases=lambda _: batch_shapes().flatmap(of),
        check=check,
        confirm=lambda subject, case: all(_confirmed(subject, name, row) for row in rows(case)),
        show=show,
        allowed=lambda case: all(_drawable(name, row) for row in rows(case)),
        applies=lambda subject: subject.batch,
        unless="batch = True is not declared",
    )


GROUP_LAWS = (
    *(_group_law(name) for name in (*SO3, *SE3)),
    _noise_law(),
    *(_batch_law(name) for name in (*SO3, *SE3) if name != "adjoint"),
)
"""The battery for exp, log, adjoint and the Jacobians of exp."""
