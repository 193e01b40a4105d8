"""The cases of a hunt are the same whatever the program has imported and whatever its settings are."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.internal import conjecture

from poekin.testing.accuracy import falsify
from poekin.testing.laws.laws import LawViolation

ODD = 1.2345678912345


def _hunted(examples: int = 400) -> list[float]:
    found: list[float] = []
    falsify.for_each(st.floats(-10, 10), examples, found.append)
    return found


def test_a_hunt_tries_as_many_cases_as_it_is_told():
    assert len(_hunted(37)) == 37


def test_numbers_in_the_source_of_a_loaded_module_change_no_case(monkeypatch):
    providers: Any = getattr(conjecture, "providers", None)
    if not hasattr(providers, "CONSTANTS_CACHE"):
        pytest.skip("this version of Hypothesis draws no numbers out of modules")
    before = _hunted()
    constants = type(providers._local_constants)()
    constants.floats.add(ODD)
    monkeypatch.setattr(providers, "_get_local_constants", lambda: constants)
    monkeypatch.setattr(providers, "CONSTANTS_CACHE", {})
    drawn = []

    @settings(
        max_examples=400,
        database=None,
        derandomize=True,
        suppress_health_check=[HealthCheck.too_slow],
    )
    @given(st.floats(-10, 10))
    def plain(x: float) -> None:
        drawn.append(x)

    plain()
    assert ODD in drawn
    assert _hunted() == before
    plain()
    assert ODD in drawn[400:], "a hunt leaves Hypothesis as it was"


def test_profiles_change_no_case():
    before = _hunted()
    settings.register_profile("before", settings())
    settings.register_profile("other", derandomize=False, max_examples=3, phases=())
    settings.load_profile("other")
    try:
        assert _hunted() == before
    finally:
        settings.load_profile("before")


def test_a_hunt_is_steered_towards_the_worst_case():
    cases = st.tuples(*[st.integers(0, 1000)] * 20)
    drawn: list[int] = []
    hunted: list[int] = []

    def error(*case: int) -> float:
        hunted.append(sum(case))
        return float(hunted[-1])

    falsify.for_each(cases, 400, lambda case: drawn.append(sum(case)))
    falsify.hunt(error, cases, 400)
    assert max(hunted) > max(drawn)


def test_the_first_case_that_breaks_a_law_is_raised():
    seen: list[int] = []

    def law(k: int) -> float:
        seen.append(k)
        if k > 90:
            raise LawViolation("small", k, 90.0, {"k": k})
        return k / 90

    with pytest.raises(LawViolation) as broken:
        falsify.hunt(law, st.tuples(st.integers(0, 100)))
    assert broken.value.seen == {"k": seen[-1]}
    assert all(k <= 90 for k in seen[: seen.index(seen[-1])])
