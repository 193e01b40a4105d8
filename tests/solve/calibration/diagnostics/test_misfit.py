"""Sets that no arm explains, and covariances that the residuals contradict: from where on, and in
which words.
"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from poekin.errors import InputError
from poekin.solve.calibration.diagnostics import misfit
from poekin.solve.calibration.fit.losses import OUTLIER, chi_square
from poekin.solve.calibration.model.residuals import Residuals

COVARIANCE = np.eye(1)


def fit(free: int = 0, converged: bool = True) -> Any:
    return SimpleNamespace(free=np.zeros((50, free)), converged=converged, noise=None, p=None)


def problem(*sets: tuple[int, Any], numbers: int = 0, reach: float = 2.0) -> Any:
    """Sets of (width, covariance)."""
    named = [
        SimpleNamespace(width=w, covariance=C, what=f"Kind{k}", angular=3)
        for k, (w, C) in enumerate(sets)
    ]
    arm = SimpleNamespace(nominal=SimpleNamespace(reach=reach))
    return SimpleNamespace(
        sets=named, rows=None, errors=lambda p: None, n_equations=numbers, model=arm
    )


def contradicted(squares: list, what: Any, of: Any) -> list[misfit.Contradiction]:
    of.noise = SimpleNamespace(squares=lambda errors: squares)
    return misfit.contradicted(what, of)


@pytest.mark.parametrize(
    "times, said", [(2.9, False), (3.1, True), (1 / 2.9, False), (1 / 3.1, True)]
)
def test_a_covariance_is_contradicted_by_residuals_three_times_as_large_or_as_small(times, said):
    # 100 numbers for 20 parameters: the residuals of right covariances are smaller by the root of
    # 80/100
    usual = chi_square(6, 0.0) * 80 / 100
    squares = [times**2 * usual * np.array([0.1, 1.0, 1.0, 1.0, 50.0])]
    found = contradicted(squares, problem((6, COVARIANCE), numbers=100), fit(20))
    if not said:
        assert found == []
        return
    ((how, words),) = found
    assert how == pytest.approx(times)
    assert words == (
        f"the Kind0: the residuals are {times:.2g} times as large as covariance= says, and the deviations of the "
        "parameters are wrong by as much; without it they are estimated from the residuals"
    )


def test_of_several_sets_those_with_a_contradicted_covariance_are_named():
    squares = [np.full(40, 1e6), np.full(40, chi_square(1, 0.0)), np.full(40, 1e6)]
    sets = problem((1, None), (1, COVARIANCE), (1, COVARIANCE), numbers=120)
    ((_, words),) = contradicted(squares, sets, fit())
    assert words.startswith("measurement set 2 (Kind2): the residuals are ")


@pytest.mark.parametrize("width, count, numbers, free, said", [
    (2, 15, 1000, 10, True), (1, 29, 1000, 10, False), (1, 30, 1000, 10, True),
    (6, 100, 600, 570, True), (6, 100, 600, 571, False),
])  # fmt: skip
def test_a_contradiction_is_told_from_thirty_numbers_beyond_the_parameters(
    width, count, numbers, free, said
):
    sets, squares = problem((width, COVARIANCE), numbers=numbers), [np.full(count, 1e6)]
    assert bool(contradicted(squares, sets, fit(free))) == said
    assert contradicted(squares, sets, fit(free, converged=False)) == []


def checked(
    monkeypatch, sets: Any, lengths: list[float], squares: list[float], other: Any = None
) -> None:
    """`check` of sets of one measurement each, off by these lengths."""
    count = range(len(lengths))
    found = Residuals(np.array(lengths), np.zeros(len(lengths)), np.array(count), np.array(count))
    sets.residuals = lambda p: found
    sets.q = None
    monkeypatch.setattr(misfit, "most_likely", lambda *given: other)
    ended = fit()
    ended.noise = SimpleNamespace(squares=lambda errors: [np.array([s]) for s in squares])
    misfit.check(sets, ended)


def test_a_set_is_refused_that_is_missed_by_more_than_any_arm_is_off_and_than_was_said_to_be_noise(
    monkeypatch,
):
    gross = chi_square(6, OUTLIER)
    one = problem((6, None))
    checked(monkeypatch, one, [0.19], [1e9])
    with pytest.raises(
        InputError,
        match=r"^no arm near the nominal one explains these Kind0: .* off by 0\.21 m and ",
    ):
        checked(monkeypatch, one, [0.21], [0.0])
    noisy = problem((6, COVARIANCE), (6, COVARIANCE), (6, None))
    checked(monkeypatch, noisy, [0.3, 0.3, 0.1], [0.99 * gross, 0.99 * gross, 1e9])
    with pytest.raises(
        InputError, match=r"explains measurement set 1 \(Kind1\): the best .* is off by 0\.4 m"
    ):
        checked(monkeypatch, noisy, [0.3, 0.4, 0.5], [0.99 * gross, 1.01 * gross, 1e9])
    with pytest.raises(InputError, match=r"explains measurement set 2 \(Kind2\)"):
        checked(monkeypatch, noisy, [0.3, 0.3, 0.5], [0.99 * gross, 0.99 * gross, 1e9])


def test_a_refusal_names_the_cause_that_explains_the_set_and_asks_where_none_does(monkeypatch):
    for cause, words in (("the cause", "in the median; most likely: the cause"),
                         (None, "of the point that it is said to be?")):  # fmt: skip
        with pytest.raises(InputError) as caught:
            checked(monkeypatch, problem((6, None)), [0.5], [0.0], cause)
        assert str(caught.value).endswith(words)
