"""Search for a case that breaks a law, outside any test: to show that a battery catches a planted
error.

Raises: what a check raises, where it says so. Source: Hypothesis, targeted search.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterable, Iterator
from typing import Any
from unittest import mock

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
    """Call a check on drawn cases, steered by `hypothesis.target`; nothing is stored or shrunk.

    The cases are the same in every run and in every program, whatever it has imported.

    Parameters
    ----------
    cases : SearchStrategy
        Strategy of the cases.
    examples : int
        Number of cases.
    check : callable
        Function of a case; what it raises ends the search.
    """

    # Cases of `derandomize` would depend on the text of the function; a seed does not.
    @seed(0)
    @settings(
        max_examples=examples,
        # A seed stores no case; older versions warn of a directory where none could be stored.
        database=None,
        deadline=None,
        phases=(Phase.generate, Phase.target),
        report_multiple_bugs=False,
        print_blob=False,
        verbosity=Verbosity.quiet,
        # How fast cases come, and how many a strategy rejects, matters to a test; here only a
        # violation does.
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
    none = type(vars(providers)["_local_constants"])()
    emptied = {"_get_local_constants": lambda: none, "CONSTANTS_CACHE": {}}
    with mock.patch.multiple(providers, **emptied):
        yield


def hunt(
    check: Callable[..., float],
    cases: Cases,
    examples: int = 100,
) -> None:
    """Call a law on drawn cases, steered towards the worst; the same cases in every run.

    Parameters
    ----------
    check : callable
        The law, check(*case), which returns error ÷ bound.
    cases : SearchStrategy
        Strategy of tuples of its arguments.
    examples : int, optional
        Number of cases.

    Raises
    ------
    LawViolation
        With the first case that breaks the law, as it was drawn (a test that uses the law shrinks
        it).
    """
    for_each(cases, examples, lambda case: target(check(*case)))


def first_violation(
    laws: Iterable[Law],
    check: Callable[..., float],
    cases: Callable[[tuple[Any, ...]], Cases],
    examples: int = 100,
) -> LawViolation | None:
    """First violation that a battery of laws finds in a subject.

    Parameters
    ----------
    laws : iterable of Law
        The battery.
    check : callable
        Call of a law on the subject, check(law, *case), which returns error ÷ bound.
    cases : callable
        Strategy of the arguments of a law by their kinds, cases(law.kinds).
    examples : int, optional
        Number of cases of each law.

    Returns
    -------
    violation : LawViolation or None
        The violation; None if the subject keeps every law.

    Examples
    --------
    >>> import numpy as np
    >>> import poekin as pk
    >>> from poekin.testing import strategies
    >>> from poekin.testing.accuracy import falsify
    >>> from poekin.testing.laws.group import make_group
    >>> from poekin.testing.laws.group_laws import GROUP_LAWS
    >>> wrong = make_group(pk.so3, 3)._replace(exp=lambda w: np.eye(3) + pk.so3.hat(w))
    >>> violation = falsify.first_violation(
    ...     GROUP_LAWS,
    ...     lambda law, *case: law.check(wrong, *case),
    ...     lambda kinds: strategies.group_cases(kinds, 3),
    ... )
    >>> violation.law
    'exp lands in the group'
    """
    for law in laws:
        try:
            hunt(lambda *case, law=law: check(law, *case), cases(law.kinds), examples)
        except LawViolation as violation:
            return violation
    return None
