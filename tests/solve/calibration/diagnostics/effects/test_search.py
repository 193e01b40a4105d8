"""The search of effects is a forward selection by F-tests of nested weighted fits."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from scipy.stats import f as f_distribution

from poekin.solve.calibration.diagnostics.effects.columns import Effect, effects
from poekin.solve.calibration.diagnostics.effects.search import EffectSearch
from poekin.solve.calibration.fit.losses import OUTLIER, LossName, chi_square, loss
from poekin.solve.calibration.terms.conditions import parse_conditions
from tests.solve.calibration.diagnostics.effects.mixed import (
    COUNTS,
    ENDS,
    SIGMA,
    WIDTHS,
    Q,
    fit_of,
    parts_of,
    problem_of,
)

CONDITIONS, _ = parse_conditions(None, Q)
NUMBER_OF_POINTS = COUNTS[0] + 3 * COUNTS[1] + COUNTS[2]


class Searched:
    """Search of errors (M,), with the columns of what was fitted and of all effects by name."""

    def __init__(self, e: np.ndarray, name: LossName = "linear", known: bool = True) -> None:
        problem = problem_of(e, known)
        fit = fit_of(problem)
        self.fitted = fit.jacobian
        self.effects = {(o.kind, o.whose): o.columns for o in effects(problem, fit, CONDITIONS)}
        self.search = EffectSearch(problem, fit, name, CONDITIONS)


@cache
def columns_of(key: tuple[str, str]) -> np.ndarray:
    """Columns of an effect where there are no errors."""
    return Searched(np.zeros(ENDS[-1])).effects[key]


def errors_of(seed: int) -> np.ndarray:
    """Noise of unit size, some measurements with ten times as much."""
    rng = np.random.default_rng(seed)
    e = [rng.normal(size=(n, d)) for n, d in zip(COUNTS, WIDTHS, strict=True)]
    for of_set in e:
        of_set[rng.random(len(of_set)) < 0.1] *= 10.0
    return np.concatenate([of_set.ravel() for of_set in e])


def roots_of(e: np.ndarray, name: LossName) -> np.ndarray:
    """Root (M,) of the weight of each number."""
    found = []
    for of_set in parts_of(e):
        weight = loss(name, np.sum(of_set**2, axis=1), of_set.shape[1]).weight
        found.append(np.repeat(np.sqrt(weight), of_set.shape[1]))
    return np.concatenate(found)


def left_by(columns: np.ndarray, e: np.ndarray) -> tuple[np.ndarray, int]:
    """Residuals of a least-squares fit, and its rank, of columns of any size."""
    sizes = np.linalg.norm(columns, axis=0)
    columns = columns / np.where(sizes, sizes, 1.0)
    z, _, rank, _ = np.linalg.lstsq(columns, e, rcond=1e-9)
    return e - columns @ z, int(rank)


def rms_of_points(whitened: np.ndarray) -> float:
    """Root mean square length of the errors of all measured points, m."""
    total = 0.0
    for of_set, sigma, angular in zip(parts_of(whitened), SIGMA, (3, 0, 0), strict=True):
        total += float(np.sum((of_set * sigma)[:, angular:] ** 2))
    return (total / NUMBER_OF_POINTS) ** 0.5


@pytest.mark.parametrize("name", ["linear", "huber", "tukey"])
def test_each_chance_is_that_of_two_nested_fits_times_the_number_of_tests(name):
    e = errors_of(1)
    roots = roots_of(e, name)
    kept = roots > 0
    assert kept.all() == (name != "tukey")
    weighted = (e * roots)[kept]
    made = Searched(e, name)
    found = made.search
    J = made.fitted * roots[:, None]
    before, rank = left_by(J[kept], weighted)
    by_name = {(one.kind, one.whose): one for one in found.tests}
    count = len(found.tests)
    assert {kind for kind, _ in by_name} >= {"gravity", "angle", "lag", "place", "set", "loose"}
    for key, columns in made.effects.items():
        both = np.concatenate([J, columns * roots[:, None]], axis=1)[kept]
        after, rank_after = left_by(both, weighted)
        d = rank_after - rank
        freedom = len(weighted) - rank_after
        if d == 0:
            assert key not in by_name
            continue
        F = (before @ before - after @ after) / d / (after @ after / freedom)
        p = float(f_distribution.sf(F, d, freedom))
        one = by_name[key]
        assert one.p == pytest.approx(min(1.0, count * p), rel=1e-5)
        explained = np.zeros(len(e))
        explained[kept] = (before - after) / roots[kept]
        assert one.size == pytest.approx(rms_of_points(explained), rel=1e-6)
    chances = [one.p for one in found.tests]
    assert chances == sorted(chances)


def planted(*sizes: tuple[tuple[str, str], float], seed: int = 2) -> np.ndarray:
    """Noise beside effects of these sizes, root mean square in standard deviations."""
    e = np.random.default_rng(seed).normal(size=ENDS[-1])
    for key, size in sizes:
        columns = columns_of(key).sum(axis=1)
        e = e + size * columns / np.sqrt(np.mean(columns**2))
    return e


DRIFT = ("drift", "")
SECOND = ("reflector", "reflector 2 of measurement set 1")


def test_what_is_found_is_fitted_before_the_next_is_looked_for():
    e = planted((DRIFT, 4.0), (SECOND, 1.0))
    made = Searched(e)
    found = made.search
    keys = [(one.kind, one.whose) for one in found.findings]
    assert keys[:2] == [DRIFT, SECOND]
    J = np.concatenate([made.fitted, made.effects[DRIFT]], axis=1)
    before, rank = left_by(J, e)
    after, rank_after = left_by(np.concatenate([J, made.effects[SECOND]], axis=1), e)
    d = rank_after - rank
    freedom = len(e) - rank_after
    F = (before @ before - after @ after) / d / (after @ after / freedom)
    p = float(f_distribution.sf(F, d, freedom))
    assert found.findings[1].p == pytest.approx(len(found.tests) * p, rel=1e-5)
    assert all(one.p <= 0.05 for one in found.findings)
    assert len(set(keys)) == len(keys)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_joint_that_yields_the_other_way_is_against_its_load(sign):
    """Errors are model − measured: a joint that yields has them along minus its column."""
    lift = ("gravity", "joint 2 (shoulder_lift_joint)")
    found = Searched(planted((lift, sign * 6.0))).search
    first = found.findings[0]
    assert (first.kind, first.whose) == lift
    assert first.against == (sign > 0)
    other = Searched(planted((DRIFT, sign * 6.0))).search.findings[0]
    assert (other.kind, other.against) == ("drift", False)


@pytest.mark.parametrize(("size", "tested"), [(0.9e-9, False), (1.1e-9, True)])
@pytest.mark.parametrize("name", ["linear", "huber"])
def test_residuals_below_a_billionth_of_a_metre_show_nothing(size, tested, name):
    e = np.random.default_rng(4).normal(size=ENDS[-1])
    e *= size / rms_of_points(e)
    found = Searched(e, name).search
    assert bool(found.tests) == tested
    assert found.findings == []


@pytest.mark.parametrize("known", [True, False])
@pytest.mark.parametrize("name", ["linear", "huber"])
def test_outliers_are_those_beyond_what_the_fit_leaves_of_one_good_measurement_in_ten_thousand(
    known, name
):
    e = spread(5)
    made = Searched(e, name, known)
    found, J = made.search, made.fitted
    found._fitted = J
    roots = roots_of(e, name)
    z = np.linalg.lstsq(J * roots[:, None], e * roots, rcond=1e-12)[0]
    left = e - J @ z
    weighted = left * roots
    variance = 1.0 if known else weighted @ weighted / (len(e) - J.shape[1])
    masks = found.gross()
    for mask, of_set, width in zip(masks, parts_of(left), WIDTHS, strict=True):
        squares = np.sum(of_set**2, axis=1) / variance
        assert mask.tolist() == (squares > chi_square(width, OUTLIER)).tolist()
    assert 0 < sum(map(np.sum, masks)) < sum(COUNTS)


def spread(seed: int) -> np.ndarray:
    """Errors of which one in five is of one to three times the size of an outlier."""
    rng = np.random.default_rng(seed)
    found = []
    for n, d in zip(COUNTS, WIDTHS, strict=True):
        of_set = 0.5 * rng.normal(size=(n, d))
        far = of_set[::5]
        sizes = rng.uniform(1.0, 3.0, (len(far), 1)) * chi_square(d, OUTLIER) ** 0.5
        of_set[::5] = sizes * far / np.linalg.norm(far, axis=1, keepdims=True)
        found.append(of_set.ravel())
    return np.concatenate(found)


@pytest.mark.parametrize("known", [True, False])
def test_a_loose_reflector_counts_nowhere(known):
    """The third: its own errors are neither fitted nor outliers, and the others are two points."""
    e = spread(6)
    made = Searched(e, "linear", known)
    found, J = made.search, made.fitted
    found._fitted = J
    found._firm[:] = True
    found._take((1, 2))
    firm = np.ones(len(e), bool)
    firm[ENDS[1] : ENDS[2]].reshape(-1, 9)[:, 6:] = False
    np.testing.assert_array_equal(found._firm, firm)
    z = np.linalg.lstsq(J[firm], e[firm], rcond=1e-12)[0]
    left = (e - J @ z) * firm
    variance = 1.0 if known else left @ left / (firm.sum() - J.shape[1])
    widths = (6, 6, 1)
    for mask, of_set, width in zip(found.gross(), parts_of(left), widths, strict=True):
        squares = np.sum(of_set**2, axis=1) / variance
        assert mask.tolist() == (squares > chi_square(width, OUTLIER)).tolist()


def test_what_effects_explain_is_their_own_part_of_the_fit():
    e = planted((DRIFT, 4.0))
    made = Searched(e)
    found, columns = made.search, made.effects[DRIFT]
    found._fitted = made.fitted
    found._take(Effect("drift", "", columns))
    J = np.concatenate([made.fitted, columns], axis=1)
    z = np.linalg.lstsq(J, e, rcond=1e-12)[0]
    explained = columns @ z[-columns.shape[1] :]
    np.testing.assert_allclose(found._explained, explained, rtol=0, atol=1e-6)
    np.testing.assert_allclose(J @ found._coefficients(), J @ z, rtol=0, atol=1e-6)
