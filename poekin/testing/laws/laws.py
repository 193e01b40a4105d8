"""Laws: plain functions of a subject and its arguments that measure an error and hold it to a
bound.

A law returns error ÷ bound (hand it to `hypothesis.target`, which then hunts the worst case) and
raises LawViolation where that exceeds 1. Laws use neither Hypothesis nor pytest, so any test-suite
can call them.
Raises: LawViolation, by the laws alone. Source: each law names its own.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from typing import Any, Concatenate, Literal, NamedTuple, ParamSpec, TypeVar

import numpy as np

P = ParamSpec("P")
S = TypeVar("S")
GroupKind = Literal["twist", "far_twist", "element", "noisy_element"]
"""Kinds of arguments that a law of a group may ask for."""
Pairs = list[tuple[float, float]]
"""Measured errors, each with its bound."""
SHOWN = 400
"""Arrays of more numbers than this are cut short in a message."""


class LawViolation(AssertionError):
    """Violation of a law: its name, the measured error, its bound, and each argument in full.

    Arrays in the message can be pasted, with NumPy as np.

    Parameters
    ----------
    law : str
        Name of the law.
    error, bound : float
        Error and bound in the unit of the law: rad, m, or multiples of what float64 can attain where
        the name says so.
    seen : Mapping
        Arguments of the law by their names.
    """

    def __init__(
        self,
        law: str,
        error: float,
        bound: float,
        seen: Mapping[str, Any],
    ) -> None:
        arguments = "".join(f"\n  {name} = {_pasted(value)}" for name, value in seen.items())
        super().__init__(f"{law}: error {error:.3g} exceeds {bound:.3g}{arguments}")
        self.law = law
        self.error = error
        self.bound = bound
        self.seen = dict(seen)

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.law, self.error, self.bound, self.seen)


class Law(NamedTuple):
    """Law of a battery, and the kinds of its arguments.

    Parameters
    ----------
    check : callable
        The law, check(subject, *arguments), which returns error ÷ bound.
    kinds : tuple of str
        Kinds of the arguments, such as "twist", which `strategies.group_cases` turns into Hypothesis
        strategies.
    """

    check: Callable[..., float]
    kinds: tuple[Any, ...]

    @property
    def name(self) -> str:
        """Name of the law, for test ids and messages."""
        return self.check.__name__


def check_bounds(
    law: str,
    *measured: tuple[float, float],
    **seen: object,
) -> float:
    """Worst error ÷ bound of measured errors, none of which exceeds its bound.

    A law ends with it. A bound of 0 asks for an error of 0.

    Parameters
    ----------
    law : str
        Name of the law, for the message.
    *measured : tuple of float
        Pairs (error, bound), in the unit of the law.
    **seen : object
        Arguments of the law by their names, for the message.

    Returns
    -------
    ratio : float
        Largest error ÷ bound, 0 to 1.

    Raises
    ------
    LawViolation
        At the first pair that does not hold; NaN never does.

    Examples
    --------
    >>> from poekin.testing.laws.laws import check_bounds
    >>> check_bounds("my law", (1e-16, 2e-16), (0.0, 0.0), q=[0.1, 0.2])
    0.5
    """
    worst = 0.0
    for error, bound in measured:
        if not error <= bound:
            raise LawViolation(law, float(error), float(bound), seen)
        if error:
            worst = max(worst, float(error / bound))
    return worst


def checked(
    title: str = "",
) -> Callable[[Callable[Concatenate[S, P], Pairs]], Callable[Concatenate[S, P], float]]:
    """Decorator that makes a law of a function that measures pairs (error, bound) of a subject.

    Parameters
    ----------
    title : str, optional
        Name of the law for the message; the function's own by default.

    Returns
    -------
    decorate : callable
        Makes measure(subject, *arguments) a law of the same arguments, that ends with `check_bounds`.
    """

    def decorate(measure: Callable[Concatenate[S, P], Pairs]) -> Callable[Concatenate[S, P], float]:
        names = measure.__code__.co_varnames[1 : measure.__code__.co_argcount]
        name = title or measure.__name__.replace("_", " ")

        @functools.wraps(measure)
        def law(
            subject: S,
            *arguments: P.args,
            **named: P.kwargs,
        ) -> float:
            seen: dict[str, Any] = dict(zip(names, arguments, strict=False))
            return check_bounds(name, *measure(subject, *arguments, **named), **seen, **named)

        return law

    return decorate


def _pasted(value: object) -> str:
    """A value as Python writes it; an array to the last digit, which NumPy's own way would round to
    8.
    """
    if not isinstance(value, np.ndarray) or value.dtype == object or value.size > SHOWN:
        return repr(value)
    if value.size == 0:
        return f"np.zeros({value.shape!r})"
    return f"np.array({value.tolist()!r})"
