"""What a law is: a plain function of a subject and its arguments that measures an error and holds it to a bound.

A law returns error ÷ bound (hand it to `hypothesis.target`, which then hunts the worst case) and raises LawViolation
where that exceeds 1. Laws use neither Hypothesis nor pytest, so any test-suite can call them.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple


class LawViolation(AssertionError):
    """A law does not hold: carries `law` (name), the measured `error`, its `bound` and the arguments `seen`."""

    def __init__(self, law: str, error: float, bound: float, seen: Mapping[str, Any]):
        arguments = "".join(f"\n  {name} = {value!r}" for name, value in seen.items())
        super().__init__(f"{law}: error {error:.3g} exceeds {bound:.3g}{arguments}")
        self.law, self.error, self.bound, self.seen = law, error, bound, dict(seen)

    def __reduce__(self):
        return type(self), (self.law, self.error, self.bound, self.seen)


class Law(NamedTuple):
    """A law of a battery: `check(subject, *arguments) -> error ÷ bound`, and the kinds of its arguments.

    The kinds are names, such as "twist" or "q"; `strategies.group_cases` and `chain_strategies.chain_cases` turn them
    into Hypothesis strategies.
    """

    check: Callable[..., float]
    kinds: tuple[str, ...]

    @property
    def name(self) -> str:
        """The law's name, for test ids and messages."""
        return self.check.__name__


def held(law: str, *measured: tuple[float, float], **seen: object) -> float:
    """The worst error ÷ bound of the measured (error, bound) pairs, where none exceeds 1.

    A bound of 0 asks for an error of 0. Raises LawViolation with the first pair that does not hold (NaN never does).
    """
    worst = 0.0
    for error, bound in measured:
        if not error <= bound:
            raise LawViolation(law, float(error), float(bound), seen)
        worst = max(worst, float(error / bound) if error else 0.0)
    return worst if math.isfinite(worst) else 0.0
