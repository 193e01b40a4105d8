"""The laws of `of_groups` as `Law`s: what each is tried on, and how a case is shown."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from ...laws.measures import size
from ...oracles import exact
from ...strategies.group_strategies import (
    LENGTHS,
    SMALLEST,
    Arrays,
    batch_shapes,
    batches,
    noisy_rotations,
    rotation_vectors,
    st,
    twists,
)
from .. import confirm
from ..grades import Grade, Verdict, judged
from ..process.calls import called
from ..subjects.subject import JACOBIANS, SE3, SO3, Subject
from . import of_groups
from .law import Case, Law, Shown, drawable, typed

FAR = 10.0
"""The largest |ω| in rad that exp and the Jacobians of exp are tried at; log, and inverses, to π.
"""
EXAMPLES = 400
"""Cases of a law that costs a few milliseconds each."""
NOTHING = Verdict(Grade.EXACT, 0.0, "empty batch")
Checked = Callable[..., Verdict]


def element(xi: np.ndarray) -> np.ndarray:
    """The rotation or pose of floats nearest to the exact e^ξ."""
    return exact.rounded(exact.exp(xi))


def _largest(name: str) -> float:
    return math.pi if "log" in name or "inverse" in name or "adjoint" in name else FAR


def _numbers(name: str) -> Arrays:
    return rotation_vectors(_largest(name)) if name in SO3 else twists(_largest(name))


def _drawable(name: str, xi: np.ndarray) -> bool:
    angle = size(xi[:3])
    return (
        drawable(angle, (SMALLEST, math.inf))
        and angle <= _largest(name)
        and drawable(size(xi[3:]), LENGTHS)
    )


def _takes_element(name: str) -> bool:
    return name.endswith("log") or name == "adjoint"


def _argument(subject: Subject, name: str, xi: np.ndarray) -> np.ndarray:
    return subject.precision(name).rounded(element(xi)) if _takes_element(name) else xi


def _checked(name: str) -> Checked:
    plain = name.removeprefix("so3_")
    if plain in JACOBIANS:
        return of_groups.jacobian_of_exp(plain)
    return {
        "exp": of_groups.exp_is_e_to_the_xi,
        "log": of_groups.log_is_the_principal_logarithm,
        "adjoint": of_groups.adjoint_is_its_matrix,
    }[plain]


def _confirmed(subject: Subject, name: str, xi: np.ndarray) -> bool:
    plain = name.removeprefix("so3_")
    if plain in JACOBIANS:
        return confirm.of_jacobian(plain, xi)
    if plain == "exp":
        return confirm.of_exp(xi)
    X = _argument(subject, name, xi)
    # The argument itself stands on exp: it is confirmed too.
    return confirm.of_exp(xi) and (
        confirm.of_log(X)
        if plain == "log"
        else confirm.of_adjoint(X, 100 * subject.precision(name).unit)
    )


def _truth(subject: Subject, name: str, xi: np.ndarray) -> np.ndarray:
    return exact.rounded(getattr(exact, name.removeprefix("so3_"))(_argument(subject, name, xi)))


def _in_order(subject: Subject, name: str, x: np.ndarray) -> np.ndarray:
    """An argument or a result of a function, in the subject's own order."""
    if name in SO3 or x.shape[-2:] == (4, 4):
        return x
    return (
        subject.twist(x) if x.shape[-1:] == (6,) and x.shape[-2:] != (6, 6) else subject.square(x)
    )


def coordinates(xi: np.ndarray) -> str:
    """Exponential coordinates in words, to the last digit."""
    halves = [
        "(" + ", ".join(f"{x + 0.0!r}".removesuffix(".0") for x in half.tolist()) + ")"
        for half in (xi[:3], xi[3:])
    ]
    return f"ω = {halves[0]}" + (f", v = {halves[1]}" if len(xi) == 6 else "")


def _group_law(name: str) -> Law:
    check, largest = _checked(name), _largest(name)

    def measured(subject: Subject, case: Case) -> Verdict:
        x = _argument(subject, name, case.numbers)
        return check(subject.function(name), x, Grade.BROKEN, subject.precision(name))

    def show(subject: Subject, case: Case) -> Shown:
        x, truth = (
            _in_order(subject, name, y)
            for y in (of(subject, name, case.numbers) for of in (_argument, _truth))
        )
        words = coordinates(case.numbers)
        words = f"e^ξ, rounded, of {words}" if _takes_element(name) else words
        return Shown(words, subject.call(name, x=f"np.array({typed(x)})"), truth)

    return Law(
        name=name,
        says=SAYS[name if name == "so3_log" else name.removeprefix("so3_")].format(
            largest="π" if largest == math.pi else f"{largest:g}"
        ),
        needs=name,
        cases=lambda subject: _numbers(name).map(Case),
        check=measured,
        confirm=lambda subject, case: _confirmed(subject, name, case.numbers),
        show=show,
        allowed=lambda case: _drawable(name, case.numbers),
        examples=EXAMPLES,
    )


SAYS = {
    "exp": "exp ξ = e^ξ, |ω| up to {largest}",
    "so3_log": "log of a rotation is its principal logarithm, |ω| up to {largest}",
    "log": "log of a pose is its principal logarithm, |ω| up to {largest}",
    "adjoint": "Ad(T) = [R 0; [t] R R]",
    "left_jacobian": "(d e^ξ) e^-ξ = J_l dξ, |ω| up to {largest}",
    "right_jacobian": "e^-ξ (d e^ξ) = J_r dξ, |ω| up to {largest}",
    "left_jacobian_inverse": "the inverse of J_l, |ω| up to {largest}",
    "right_jacobian_inverse": "the inverse of J_r, |ω| up to {largest}",
}


def _noise_law() -> Law:
    def cases(subject: Subject) -> st.SearchStrategy[Case]:
        return noisy_rotations((1e-17, subject.noise)).map(lambda R: Case(np.asarray(R).ravel()))

    def R(case: Case) -> np.ndarray:
        return case.numbers.reshape(3, 3)

    def show(subject: Subject, case: Case) -> Shown:
        text = subject.call("so3_log", x=f"np.array({typed(R(case))})")
        return Shown("a rotation with noise", text, exact.rounded(exact.log(R(case))))

    def check(subject: Subject, case: Case) -> Verdict:
        precision = subject.precision("so3_log")
        return of_groups.log_forgives_noise(
            subject.function("so3_log"), R(case), Grade.BROKEN, precision
        )

    return Law(
        "noise", "log of a rotation with noise is that of the nearest rotation", "so3_log", cases, check,
        lambda subject, case: confirm.of_log(R(case)), show,
        # Shrinking would leave the neighbourhood of the rotations.
        triples=lambda case: (), allowed=lambda case: False, applies=lambda subject: subject.noise > 0,
        unless="noise is not declared", examples=EXAMPLES,
    )  # fmt: skip


def _batch_law(name: str) -> Law:
    count = 3 if name in SO3 else 6
    check = _checked(name)

    def cases(subject: Subject) -> st.SearchStrategy[Case]:
        def of(shape: tuple[int, ...]) -> st.SearchStrategy[Case]:
            return batches(_numbers(name), shape).map(lambda x: Case(np.asarray(x).ravel(), shape))

        return batch_shapes().flatmap(of)

    def arguments(subject: Subject, case: Case) -> np.ndarray:
        rows = case.numbers.reshape(-1, count)
        made = [_argument(subject, name, row) for row in rows]
        tail = _argument(subject, name, np.zeros(count)).shape
        return np.reshape(made, (*_shape(case), *tail))

    def together(subject: Subject, case: Case) -> Verdict:
        x = arguments(subject, case)
        tail = _truth(subject, name, np.zeros(count)).shape
        result, fault = called(subject.function(name), (*_shape(case), *tail), x)
        if fault:
            return judged(f"batches of {name}", fault)
        rows = result.reshape(-1, *tail)
        flat = x.reshape(-1, *x.shape[len(_shape(case)) :])
        precision = subject.precision(name)
        pairs = zip(flat, rows, strict=True)
        verdicts = [
            check(lambda _, row=row: row, one, Grade.BROKEN, precision) for one, row in pairs
        ]
        return max(verdicts, key=lambda v: v.rank, default=NOTHING)

    def show(subject: Subject, case: Case) -> Shown:
        x = _in_order(subject, name, arguments(subject, case))
        text = f"np.reshape({typed(x.ravel())}, {x.shape})"
        truth = np.reshape(
            [_truth(subject, name, row) for row in case.numbers.reshape(-1, count)] or np.zeros(0),
            -1,
        )
        tail = _truth(subject, name, np.zeros(count)).shape
        words = f"a batch {_shape(case)} of " + "; ".join(
            map(coordinates, case.numbers.reshape(-1, count))
        )
        return Shown(
            words,
            subject.call(name, x=text),
            _in_order(subject, name, truth.reshape(*_shape(case), *tail)),
        )

    def confirmed(subject: Subject, case: Case) -> bool:
        return all(_confirmed(subject, name, row) for row in case.numbers.reshape(-1, count))

    return Law(
        f"{name} of batches", f"{name} of a batch is {name} of each, in shapes (), (1,), (0,), (3, 1, 2)", name, cases,
        together, confirmed, show,
        allowed=lambda case: all(_drawable(name, row) for row in case.numbers.reshape(-1, count)),
        applies=lambda subject: subject.batch, unless="batch = True is not declared",
    )  # fmt: skip


def _shape(case: Case) -> tuple[int, ...]:
    return case.layout if isinstance(case.layout, tuple) else ()


GROUP_LAWS = (
    *(_group_law(name) for name in (*SO3, *SE3)),
    _noise_law(),
    *(_batch_law(name) for name in (*SO3, *SE3) if name != "adjoint"),
)
"""The battery for exp, log, adjoint and the Jacobians of exp."""
