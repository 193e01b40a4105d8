"""`choose`: terms by the error of held-out readings, as long as there is one that adds something."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np

from poekin.solve.calibration.selection.choose_terms import choose


def candidates(scores: dict[int, float], names: dict[str, int]) -> Any:
    """Terms, each with how many columns it adds; an error by the number of columns."""

    def held_out(Q):
        return SimpleNamespace(score=scores[Q.shape[1]], deviation=0.1)

    def with_group(Q, name):
        return np.zeros((9, Q.shape[1] + names[name]))

    fit = SimpleNamespace(held_out=held_out, with_group=with_group)
    return SimpleNamespace(fit=fit, names=tuple(names), columns=lambda _: np.zeros((9, 1)))


def test_terms_that_add_no_column_are_not_chosen_and_end_the_search():
    assert choose(candidates({1: 1.0}, {"twin": 0, "other twin": 0})) == []


def test_terms_of_which_a_fold_has_to_itself_what_is_known_are_passed_over():
    found = candidates({1: 1.0, 2: 0.5, 3: 0.1}, {"alone": 2, "a": 1})
    every = found.fit.held_out
    found.fit.held_out = lambda Q: None if Q.shape[1] > 2 else every(Q)
    assert choose(found) == ["a"]


def test_the_fewest_terms_within_a_standard_error_of_the_least_error_are_chosen():
    each = {"a": 1, "b": 1, "c": 1, "d": 1}
    assert choose(candidates({1: 1.0, 2: 0.55, 3: 0.5, 4: 0.42, 5: 0.41}, each)) == ["a", "b"]
    assert choose(candidates({1: 1.0, 2: 0.5, 3: 0.5, 4: 0.1, 5: 0.0}, each)) == ["a"]
