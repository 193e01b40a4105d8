"""The F-test is that of nested least squares, and with clusters that of the jackknife."""

from __future__ import annotations

import numpy as np
import pytest

from poekin.solve.calibration.diagnostics.effects import f_test as module
from poekin.solve.calibration.diagnostics.effects.f_test import (
    coefficients,
    f_survival,
    f_test,
    left_of,
)

RNG = np.random.default_rng(4)
A = RNG.normal(size=(60, 5))
X = RNG.normal(size=(60, 3))
E = RNG.normal(size=60) + X @ [0.3, 0.0, -0.2]
GROUPS = np.repeat(np.arange(15), 4)
stats = pytest.importorskip("scipy.stats")


@pytest.mark.parametrize("d", [1, 2, 3, 4, 6, 12])
@pytest.mark.parametrize("freedom", [1, 2, 5, 30, 83, 30_000])
def test_the_chance_is_that_of_the_f_distribution(d, freedom):
    for F in (0.0, 1e-6, 0.1, 0.5, 1.0, 2.0, 5.0, 100.0, 1e4):
        right = stats.f.sf(F, d, freedom)
        # SciPy's own is right to some 1e-11; both go below all floats
        assert f_survival(F, d, freedom) == pytest.approx(right, rel=1e-9, abs=1e-290)


@pytest.mark.parametrize("d", [1, 2, 6])
@pytest.mark.parametrize("freedom", [1, 3, 30])
def test_the_continued_fraction_is_asked_where_it_converges_fast(d, freedom, monkeypatch):
    asked = []

    def kept(a, b, x):
        asked.append((a, b, x))
        return 0.5

    monkeypatch.setattr(module, "_incomplete_beta", kept)
    for F in np.geomspace(1e-2, 1e2, 400):
        f_survival(F, d, freedom)
    sides = {(a, b) for a, b, _ in asked}
    assert sides == {(d / 2, freedom / 2), (freedom / 2, d / 2)}
    for a, b, x in asked:
        # where `_incomplete_beta` says that it wants it; rounding of 1 - x
        assert x <= (a + 1) / (a + b + 2) + 1e-15


class Counted(float):
    """A number that counts what is multiplied by it: two products each turn of the fraction."""

    products = 0

    def __rmul__(self, other):
        Counted.products += 1
        return float(self) * other


@pytest.mark.parametrize("a", [0.5, 1.5, 15_000.0])
@pytest.mark.parametrize("b", [0.5, 6.0, 15_000.0])
def test_the_continued_fraction_ends_where_it_has_converged(a, b, monkeypatch):
    monkeypatch.setattr(Counted, "products", 0)
    module._incomplete_beta(a, b, Counted((a + 1) / (a + b + 2)))
    # turns grow as the root of the larger of a and b (Press et al. 1992, section 6.4)
    assert Counted.products <= 2 * (20 + 2 * max(a, b) ** 0.5)


def test_coefficients_are_of_columns_of_any_sizes():
    sizes = np.array([1e-12, 1.0, 1e9])
    right = np.linalg.lstsq(X, E, rcond=None)[0]
    # X is well conditioned: a few roundings of the largest
    assert coefficients(X * sizes, E) * sizes == pytest.approx(right, rel=0, abs=1e-13)


def test_coefficients_that_are_not_told_are_no_larger_than_those_that_are():
    """Of twins that differ by rounding alone each has half, and a column of zeros has none."""
    twins = np.column_stack([X[:, 0], X[:, 0] + 1e-14 * X[:, 1], 0 * E])
    alone = X[:, 0] @ E / (X[:, 0] @ X[:, 0])
    assert coefficients(twins, E) == pytest.approx([alone / 2, alone / 2, 0], rel=0, abs=1e-12)


def rest(*columns):
    """Sum of squares that columns leave."""
    every = np.column_stack(columns)
    return np.sum((E - every @ np.linalg.lstsq(every, E, rcond=None)[0]) ** 2)


def outcome(left, columns):
    """Of the test of columns that can be tested."""
    found = f_test(left, columns)
    assert found is not None
    return found


def test_independent_numbers_are_tested_as_nested_models():
    found = outcome(left_of(E, A, None), X)
    before, after = rest(A), rest(A, X)
    F = (before - after) / 3 / (after / (60 - 5 - 3))
    assert found.p == pytest.approx(stats.f.sf(F, 3, 52), rel=1e-9)
    np.testing.assert_allclose(found.s @ found.s, before - after, rtol=1e-12)


def test_clusters_are_tested_by_the_jackknife_that_leaves_out_one_of_them():
    found = outcome(left_of(E, A, GROUPS), X)
    every = np.column_stack([A, X])
    whole = np.linalg.lstsq(every, E, rcond=None)[0][5:]
    V = np.zeros((3, 3))
    for g in range(15):
        others = g != GROUPS
        one = np.linalg.lstsq(every[others], E[others], rcond=None)[0][5:]
        V += np.outer(one - whole, one - whole)
    T = whole @ np.linalg.solve(V, whole)
    freedom = 15 - 3
    F = T * freedom / (3 * 14)
    assert found.p == pytest.approx(stats.f.sf(F, 3, freedom), rel=1e-8)


def test_what_was_fitted_is_not_tested_and_of_a_part_only_the_rest():
    left = left_of(E, A, None)
    assert f_test(left, A[:, :2] @ [[1.0], [2.0]]) is None
    assert f_test(left, np.zeros((60, 2))) is None
    part = outcome(left, np.column_stack([X[:, 0] + A[:, 1], A[:, 2]]))
    assert part.U.shape[1] == 1
    assert part.p == pytest.approx(outcome(left, X[:, :1]).p, rel=1e-9)


def test_without_numbers_to_spare_nothing_is_tested():
    assert f_test(left_of(E[:8], A[:8], None), X[:8]) is None
    assert f_test(left_of(E[:9], A[:9], None), X[:9]) is not None
    few = np.repeat(np.arange(3), 20)
    assert f_test(left_of(E, A, few), X) is None
    assert f_test(left_of(E, A, few), X[:, :2]) is not None


def test_units_of_columns_change_nothing():
    scaled = np.array([1e-9, 1.0, 1e9])
    one = outcome(left_of(E, A, None), X).p
    other = outcome(left_of(E, A * [1e8, 1, 1, 1, 1e-8], None), X * scaled).p
    assert other == pytest.approx(one, rel=1e-6)
