"""Words and probabilities of several targets at once: each one has its own."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from poekin.solve.ik_all.solution_sets.evidence import (
    Evidence,
    Sampling,
    SolverUsed,
    has_self_motion,
    missing_probability,
)
from poekin.solve.ik_all.solution_sets.found import Tally
from poekin.solve.ik_all.solution_sets.self_motion import SelfMotion

ALONG_A = SelfMotion(("a",), np.zeros(2))
ALL = SolverUsed("closed form", "closed form (X)")


def tally(*rows: tuple[int, int, int, int, bool, bool], moving: tuple[int, ...] = ()) -> Tally:
    """Numbers of targets: found, least_hits, ends, restarts, full and sure of each."""
    found, least, ends, restarts, full, sure = map(np.array, zip(*rows, strict=True))
    return Tally(found, least, ends, restarts, full, sure, dict.fromkeys(moving, ALONG_A))


def test_the_chance_of_a_missing_solution_is_that_of_each_target():
    chance = missing_probability(
        tally(
            (2, 10, 30, 40, False, False),
            (1, 1, 1, 1, False, False),  # a single try: half of the others found another one
            (3, 2, 4, 1, False, True),
            (8, 1, 8, 0, False, True),
            (0, 0, 0, 0, False, True),
            (8, 1, 8, 0, False, False),
            (0, 0, 0, 1, False, False),
            (0, 0, 0, 0, False, False),
            (0, 0, 0, 1, True, False),
            (40, 1, 9, 9, True, True),
            (1, 1, 9, 9, False, True),
            (1, 1, 9, 0, False, True),
            (1, 1, 9, 9, True, True),
            moving=(10, 11, 12),
        )
    )
    known = [(5 / 6) ** 30, 1 / 2, (3 / 4) ** 4, 0, 0]
    np.testing.assert_allclose(chance[:5], known, rtol=1e-12)
    assert np.isnan(chance[5:]).all()


def test_targets_that_have_a_continuum_are_known_by_number():
    assert has_self_motion({2: ALONG_A}, 4).tolist() == [False, False, True, False]


def evidence(**changes: Any) -> Evidence:
    """Of two targets, of which the second one is asked for."""
    given: dict[str, Any] = {
        "finite": True,
        "found": 2,
        "within": 2,
        "least_hits": 5,
        "ends": 20,
        "restarts": 30,
        "full": False,
        "sure": False,
        "p_missing": 0.25,
    }
    given |= {name: value for name, value in changes.items() if name in given}
    arrays = {name: np.array([9 if name == "found" else 0, value]) for name, value in given.items()}
    others = {name: value for name, value in changes.items() if name not in given}
    return Evidence(**arrays, **({"self_motion": {}, "free": 6, "solver": ALL} | others))


EACH = "each found 5 times or more; one that is half as easy to find as the rarest is missing with a chance of 0.2"
ODD = "; the number is odd: one of them is a double one, or one is missing"
OF_A = "infinitely many solutions, along which 'a' move; one of them"
SAMPLED = {"sampling": Sampling("a", 16), "solver": None}


@pytest.mark.parametrize(("changes", "words"), [
    ({"finite": False}, "0 solutions: bad target, it is not made of finite numbers"),
    ({}, f"2 solutions: search, 30 tries, {EACH}"),
    ({"restarts": 1}, f"2 solutions: search, 1 tries, {EACH}"),
    ({"restarts": 0}, "2 solutions: closed form (X)"),
    ({"restarts": 0, "solver": None},
     f"2 solutions: search, 0 tries, {EACH}"),
    ({"within": 1}, f"2 solutions, 1 of them within the limits: search, 30 tries, {EACH}"),
    ({"found": 1, "within": 1}, f"1 solution: search, 30 tries, {EACH}{ODD}"),
    ({"found": 1, "within": 1, "free": 5}, f"1 solution: search, 30 tries, {EACH}"),
    ({"found": 3, "within": 3, "free": 7}, f"3 solutions: search, 30 tries, {EACH}"),
    ({"found": 0, "within": 0}, "0 solutions: search, 30 tries"),
    ({"full": True}, "at least 2 solutions: search, 30 tries"),
    ({"p_missing": np.nan}, "2 solutions: search, 30 tries; at some values it is not known whether one is missing"),
    ({"self_motion": {1: ALONG_A}}, f"{OF_A} and 1 that stands alone: search, 30 tries"),
    ({"found": 3, "within": 3, "self_motion": {1: ALONG_A}}, f"{OF_A} and 2 that stand alone: search, 30 tries"),
    ({"found": 1, "within": 1, "self_motion": {1: ALONG_A}}, f"{OF_A}: search, 30 tries"),
    ({"self_motion": {0: ALONG_A}, "restarts": 0}, "2 solutions: closed form (X)"),
    ({"found": 1, "within": 1, **SAMPLED},
     "infinitely many solutions; 1 solution at 16 values of 'a': search, 30 tries, each found 5 "
     "times or more; one is missing with a chance of 0.2"),
    ({"found": 0, "within": 0, **SAMPLED}, "0 solutions at 16 values of 'a': search, 30 tries"),
    ({"full": True, **SAMPLED},
     "infinitely many solutions; at least 2 solutions at 16 values of 'a': search, 30 tries"),
])  # fmt: skip
def test_a_sentence_says_how_many_how_they_were_found_and_how_sure_it_is(changes, words):
    assert evidence(**changes).sentence(1) == words


def test_a_single_solution_at_values_of_a_coordinate_is_one_of_infinitely_many():
    one = evidence(found=1, sampling=Sampling("a", 16))
    assert one.continuum.tolist() == [True, True]
    assert evidence(found=0, sampling=Sampling("a", 16)).continuum.tolist() == [True, False]
    assert evidence(self_motion={1: ALONG_A}).continuum.tolist() == [False, True]


@pytest.mark.parametrize("changes", [
    {"sure": False},
    {"finite": False},
    {"restarts": 1},
    {"full": True},
    {"self_motion": {1: ALONG_A}},
])  # fmt: skip
def test_any_doubt_makes_the_solutions_not_surely_all(changes):
    certain: dict[str, Any] = {"sure": True, "restarts": 0}
    assert evidence(**certain).complete.tolist() == [False, True]
    assert evidence(**(certain | changes)).complete.tolist() == [False, False]
