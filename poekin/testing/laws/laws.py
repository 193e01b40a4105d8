"""Laws: plain functions of a subject and its arguments that measure an error and hold it to a
bound.

A law returns error ÷ bound (hand it to `hypothesis.target`, which then hunts the worst case) and
raises LawViolation where that exceeds 1. Laws use neither Hypothesis nor pytest, so any test-suite
can call them.
Source: each law names its own.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np

SHOWN = 400
"""Arrays of more numbers than this are cut short in a message."""


class LawViolation(AssertionError):
    """A law does not hold: the message has its name, the measured error, its bound, and each
    argument in full.

    Fields: law (its name), error, bound (in the unit of the law: rad, m, or multiples of what
    float64 can attain where the name says so), seen (a dict of the arguments). Arrays in the
    message can be pasted, with NumPy as np.
    """

    def __init__(
        self,
        law: str,
        error: float,
        bound: float,
        seen: Mapping[str, Any],
    ):
        arguments = "".join(f"\n  {name} = {_pasted(value)}" for name, value in seen.items())
        super().__init__(f"{law}: error {error:.3g} exceeds {bound:.3g}{arguments}")
        self.law = law
        self.error = error
        self.bound = bound
        self.seen = dict(seen)

    def __reduce__(self):
        return type(self), (self.law, self.error, self.bound, self.seen)


class Law(NamedTuple):
    """A law of a battery: `check(subject, *arguments) -> error ÷ bound`, and the kinds of its
    arguments.

    Fields: check; kinds, names such as "twist" or "q", which `strategies.group_cases` and
    `chain_strategies.chain_cases` turn into Hypothesis strategies.
    """

    check: Callable[..., float]
    kinds: tuple[str, ...]

    @property
    def name(self) -> str:
        """The law's name, for test ids and messages."""
        return self.check.__name__


def check_bounds(
    law: str,
    *measured: tuple[float, float],
    **seen: object,
) -> float:
    """The worst error ÷ bound of the measured (error, bound) pairs, where none exceeds 1: what a
    law ends with.

    Parameters: law, its name for the message; measured, pairs (error, bound), of which a bound of 0
    asks for an error of 0; seen, the law's arguments by their names. Returns: 0 to 1.
    Raises: LawViolation with the first pair that does not hold (NaN never does).
    """
    worst = 0.0
    for error, bound in measured:
        if not error <= bound:
            raise LawViolation(law, float(error), float(bound), seen)
        if error:
            worst = max(worst, float(error / bound))
    if not math.isfinite(worst):
        return 0.0
    return worst


def _pasted(value: object) -> str:
    """A value as Python writes it; an array to the last digit, which NumPy's own way would round to
    8.
    """
    if not isinstance(value, np.ndarray) or value.dtype == object or value.size > SHOWN:
        return repr(value)
    if value.size == 0:
        return f"np.zeros({value.shape!r})"
    return f"np.array({value.tolist()!r})"
