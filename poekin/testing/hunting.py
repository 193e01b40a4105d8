"""Hunt for a case that breaks a law, outside any test: to show that a battery catches a planted error.

Parameters: check, which returns error ÷ bound; cases, a strategy of tuples of its arguments; laws, a battery; examples,
how many are tried of each law. Returns: settings, nothing, or a violation. Raises: LawViolation, where it says so.
Source: Hypothesis, targeted search.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from .laws import Law, LawViolation
from .strategies import st

# `strategies` has said what to install where hypothesis is missing.
from hypothesis import HealthCheck, Phase, Verbosity, given, settings, target  # isort: skip

Cases = st.SearchStrategy[tuple[Any, ...]]


def repeatable(examples: int) -> settings:
    """Settings of a hunt: the same cases in every run, steered towards what is worst; nothing is stored or shrunk."""
    return settings(
        max_examples=examples,
        database=None,
        deadline=None,
        derandomize=True,
        phases=(Phase.generate, Phase.target),
        report_multiple_bugs=False,
        print_blob=False,
        verbosity=Verbosity.quiet,
        # How fast cases come, and how many a strategy rejects, matters to a test; a hunt only looks for a violation.
        suppress_health_check=[
            HealthCheck.too_slow,
            HealthCheck.data_too_large,
            HealthCheck.filter_too_much,
            HealthCheck.large_base_example,
        ],
    )


def hunt(check: Callable[..., float], cases: Cases, examples: int = 100) -> None:
    """Call check(*case) -> error ÷ bound on drawn cases, steered towards the worst; the same cases in every run.

    Raises LawViolation with the first case that breaks the law, as it was drawn (a test that uses the law shrinks it).
    """

    @repeatable(examples)
    @given(cases)
    def one(case: tuple[Any, ...]) -> None:
        target(check(*case))

    one()


def caught(
    laws: Iterable[Law], check: Callable[..., float], cases: Callable[[tuple[str, ...]], Cases], examples: int = 100
) -> LawViolation | None:
    """The first violation that a battery finds in a subject, or None where the subject keeps every law.

    `check(law, *case)` calls the law on the subject; `cases(law.kinds)` is the strategy of its arguments.
    """
    for law in laws:
        try:
            hunt(lambda *case, law=law: check(law, *case), cases(law.kinds), examples)
        except LawViolation as violation:
            return violation
    return None
