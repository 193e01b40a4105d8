"""Hunt for a case that breaks a law, outside any test: to show that a battery catches a planted
error.

Parameters: check, which returns error ÷ bound; cases, a strategy of tuples of its arguments; laws,
a battery; examples, how many are tried of each law. Returns: nothing, or a violation. Raises:
LawViolation, where it says so.
Source: Hypothesis, targeted search.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterable, Iterator
from typing import Any

from ..laws.laws import Law, LawViolation
from ..strategies.group_strategies import st

# `group_strategies` has said what to install where hypothesis is missing.
from hypothesis import HealthCheck, Phase, Verbosity, given, seed, settings, target  # isort: skip
from hypothesis.internal import conjecture  # isort: skip

Cases = st.SearchStrategy[tuple[Any, ...]]


def for_each(
    cases: st.SearchStrategy[Any],
    examples: int,
    check: Callable[[Any], object],
) -> None:
    """Call check(case) on drawn cases, steered by `hypothesis.target`; nothing is stored or shrunk.

    The cases are the same in every run and in every program, whatever it has imported. A seed says
    which ones, as those of `derandomize` depend on the text of the function.
    """

    @seed(0)
    @settings(
        max_examples=examples,
        database=None,
        deadline=None,
        phases=(Phase.generate, Phase.target),
        report_multiple_bugs=False,
        print_blob=False,
        verbosity=Verbosity.quiet,
        # How fast cases come, and how many a strategy rejects, matters to a test; a hunt only looks
        # for a violation.
        suppress_health_check=[
            HealthCheck.too_slow,
            HealthCheck.data_too_large,
            HealthCheck.filter_too_much,
            HealthCheck.large_base_example,
        ],
    )
    @given(cases)
    def one(case: Any) -> None:
        check(case)

    with _without_constants_of_modules():
        one()


@contextlib.contextmanager
def _without_constants_of_modules() -> Iterator[None]:
    """Hypothesis draws no numbers out of the source of loaded modules, as it does since 6.131.

    There is no setting for it. Modules outside of site-packages are looked at, so that cases would
    differ between a program and an interactive session, and between a checkout of this package and
    its wheel.
    """
    providers: Any = getattr(conjecture, "providers", None)
    if not hasattr(providers, "CONSTANTS_CACHE"):
        yield
        return
    none = type(providers._local_constants)()
    before = (providers._get_local_constants, providers.CONSTANTS_CACHE)
    providers._get_local_constants = lambda: none
    providers.CONSTANTS_CACHE = {}
    try:
        yield
    finally:
        providers._get_local_constants, providers.CONSTANTS_CACHE = before


def hunt(
    check: Callable[..., float],
    cases: Cases,
    examples: int = 100,
) -> None:
    """Call check(*case) -> error ÷ bound on drawn cases, steered towards the worst; the same cases
    in every run.

    Raises LawViolation with the first case that breaks the law, as it was drawn (a test that uses
    the law shrinks it).
    """
    for_each(cases, examples, lambda case: target(check(*case)))


def first_violation(
    laws: Iterable[Law],
    check: Callable[..., float],
    cases: Callable[[tuple[str, ...]], Cases],
    examples: int = 100,
) -> LawViolation | None:
    """The first violation that a battery finds in a subject, or None where the subject keeps every
    law.

    `check(law, *case)` calls the law on the subject; `cases(law.kinds)` is the strategy of its
    arguments.
    """
    for law in laws:
        try:
            hunt(lambda *case, law=law: check(law, *case), cases(law.kinds), examples)
        except LawViolation as violation:
            return violation
    return None
