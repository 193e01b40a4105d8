"""The jackknife of clusters: refits that leave out one at a time."""

from __future__ import annotations

import numpy as np
import pytest

from poekin.solve.calibration.selection.jackknife import Jackknife
from poekin.solve.calibration.selection.spans import beside


@pytest.mark.parametrize("sizes", [[3] * 8, [1, 2, 3, 4, 5, 6, 6, 6], [4] * 4 + [0, 9]])
def test_the_sandwich_is_the_jackknife_that_leaves_out_a_configuration_at_a_time(sizes):
    """Of a linear problem its refits without a cluster differ by (J^T J)^-1 J_g^T (I - H_g)^-1 e_g."""
    rng = np.random.default_rng(0)
    clusters = rng.permutation(np.repeat(np.arange(len(sizes)), sizes))
    J = rng.normal(size=(len(clusters), 4))
    y = rng.normal(size=len(clusters))
    whole = np.linalg.lstsq(J, y, rcond=None)[0]
    expected = np.zeros((4, 4))
    for g in range(len(sizes)):
        rest = clusters != g
        change = np.linalg.lstsq(J[rest], y[rest], rcond=None)[0] - whole
        expected += np.outer(change, change)
    Q, R = np.linalg.qr(J)
    inverse = np.linalg.inv(R)
    found = inverse @ Jackknife(Q, clusters).meat(y - J @ whole) @ inverse.T
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12 * np.abs(expected).max())


def test_what_one_configuration_alone_tells_is_known_to_the_noise_of_the_others():
    # the last column is seen by the last cluster alone, in one number
    J = np.zeros((9, 2))
    J[:, 0] = 1.0
    J[8, 1] = 2.0
    Q, R = np.linalg.qr(J)
    inverse = np.linalg.inv(R)
    e = np.array([1.0, -1.0] * 4 + [0.0])
    jackknife = Jackknife(Q, np.repeat(np.arange(5), [2, 2, 2, 2, 1]))
    found = inverse @ jackknife.meat(e) @ inverse.T
    assert 0.2 < found[1, 1] < 0.6


@pytest.mark.parametrize("left", [0.0, 1e-3, 1.0])
def test_what_two_numbers_of_one_configuration_alone_tell_is_known_to_the_noise_along_both(left):
    """Whatever a fit that has not quite converged left of them."""
    J = np.zeros((9, 2))
    J[:7, 0] = 1.0
    J[7:, 1] = [2.0, 1.0]
    e = np.array([1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 0.0, 2.0 * left, left])
    Q, R = np.linalg.qr(J)
    inverse = np.linalg.inv(R)
    jackknife = Jackknife(Q, np.repeat(np.arange(5), [2, 2, 2, 1, 2]))
    found = inverse @ jackknife.meat(e) @ inverse.T
    np.testing.assert_allclose(found[1, 1], 1.0 / 5.0, rtol=1e-12)  # a unit error over |(2, 1)|


def test_a_prior_s_rows_count_as_they_are():
    Q = np.linalg.qr(np.random.default_rng(0).normal(size=(12, 3)))[0]
    e = np.zeros(9)
    jackknife = Jackknife(Q, np.repeat(range(3), 3))
    np.testing.assert_allclose(jackknife.meat(e), Q[9:].T @ Q[9:], atol=1e-15)


@pytest.mark.parametrize("sizes", [[3] * 8, [1, 2, 3, 4, 5, 6, 6, 6], [4] * 4 + [0, 9]])
@pytest.mark.parametrize("d", [1, 3])
def test_columns_beside_count_as_those_that_were_fitted(sizes, d):
    rng = np.random.default_rng(len(sizes))
    clusters = rng.permutation(np.repeat(np.arange(len(sizes)), sizes))
    both = np.linalg.qr(rng.normal(size=(len(clusters), 4 + d)))[0]
    e = beside(both, rng.normal(size=len(clusters)))
    expected = Jackknife(both, clusters).meat(e)[4:, 4:]
    found = Jackknife(both[:, :4], clusters).meat_beside(both[:, 4:], e)
    # the inverses of I - Q_g Q_g^T, of eigenvalues above 1e-3 here, carry its rounding
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-11 * np.abs(expected).max())


@pytest.mark.parametrize("whose", [1, 2])
def test_a_column_beside_that_one_configuration_alone_tells_counts_by_the_noise_of_others(whose):
    """The last cluster alone tells the column, and with two one that was fitted, too."""
    J = np.random.default_rng(0).normal(size=(12, 4))
    J[:9, -whose:] = 0.0
    J[9:, -1] = [1.0, 0.0, 0.0]
    J[9:, -2] = [0.0, 2.0, 1.0]
    Q = np.linalg.qr(J)[0]
    clusters = np.repeat(range(4), 3)
    e = beside(Q, np.random.default_rng(1).normal(size=12))
    found = Jackknife(Q[:, :3], clusters).meat_beside(Q[:, 3:], e)
    assert 0.5 < found[0, 0] < 2.0
