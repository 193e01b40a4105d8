"""Observability indices of an identification matrix."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from poekin.errors import InputError, ShapeError
from poekin.solve.calibration.design.observability import observability_indices
from tests.messages import says

TOL = 1e-12  # 100 u times the condition numbers below, with room for the logarithms

sigmas = st.lists(st.floats(-2, 2).map(lambda e: 10**e), min_size=1, max_size=5).map(
    lambda s: sorted(s, reverse=True)
)


def with_singular_values(sigma, rows, seed):  # type: ignore[no-untyped-def]
    """A matrix (rows, len(sigma)) of these singular values, in axes that the seed turns."""
    rng = np.random.default_rng(seed)
    U = np.linalg.qr(rng.normal(size=(rows, rows)))[0][:, : len(sigma)]
    V = np.linalg.qr(rng.normal(size=(len(sigma), len(sigma))))[0]
    return U * np.array(sigma) @ V.T


@given(sigmas, st.integers(0, 4), st.integers(1, 50), st.integers(0, 99))
def test_each_index_is_its_definition_in_the_singular_values(sigma, more, m, seed):
    found = observability_indices(with_singular_values(sigma, len(sigma) + more, seed), m)
    product = 1.0
    for s in sigma:
        product *= s
    defined = (
        product ** (1 / len(sigma)) / m**0.5, sigma[0] / sigma[-1], sigma[-1], sigma[-1] ** 2 / sigma[0]
    )  # fmt: skip
    assert found == pytest.approx(
        defined, rel=1e4 * TOL
    )  # sigma_L is known to u sigma_1, and sigma_1 / sigma_L <= 1e4


@given(sigmas, st.integers(0, 99))
def test_measuring_everything_twice_leaves_O1_and_condition_and_gains_root_2_in_the_others(
    sigma, seed
):
    J = with_singular_values(sigma, len(sigma) + 1, seed)
    once, twice = observability_indices(J, 7), observability_indices(np.concatenate([J, J]), 14)
    root = 2**0.5
    expected = once.O1, once.condition, root * once.smallest, root * once.amplification
    assert twice == pytest.approx(expected, rel=1e4 * TOL)


def test_many_matrices_at_once_give_what_each_gives_alone():
    J = np.random.default_rng(0).normal(size=(3, 2, 8, 4))
    found = observability_indices(J, 5)
    for k in np.ndindex(3, 2):
        assert [x[k] for x in found] == pytest.approx(observability_indices(J[k], 5), rel=TOL)


def test_the_rank_leaves_out_the_directions_that_nothing_sees():
    J = with_singular_values([5.0, 2.0, 0.5], 6, 0)
    wide = np.concatenate([J, np.zeros((6, 2))], axis=1)
    assert observability_indices(wide, 3, rank=3) == pytest.approx(
        observability_indices(J, 3), rel=TOL
    )
    assert observability_indices(np.zeros((6, 2)), 3) == (0, np.inf, 0, 0)


def test_fewer_rows_than_directions_see_nothing_of_some():
    assert observability_indices(np.eye(4)[:3], 3) == (0, np.inf, 0, 0)
    for found, none in zip(
        observability_indices(np.ones((5, 2, 3, 4)), 3), (0, np.inf, 0, 0), strict=True
    ):
        np.testing.assert_array_equal(found, np.full((5, 2), none))


@pytest.mark.parametrize(
    ("J", "m", "rank", "error", "message"),
    [
        (np.ones(3), 1, None, ShapeError, "J: expected a matrix (..., rows, P), got shape (3,)"),
        (
            np.eye(3),
            0,
            None,
            InputError,
            "m: expected a whole number from 1 on, got 0",
        ),
        (
            np.eye(3),
            2.0,
            None,
            InputError,
            "m: expected a whole number from 1 on, got 2.0",
        ),
        (
            np.eye(3),
            3,
            0,
            InputError,
            "rank: expected a whole number from 1 to the 3 parameters, got 0",
        ),
        (
            np.eye(3),
            3,
            2.0,
            InputError,
            "rank: expected a whole number from 1 to the 3 parameters, got 2.0",
        ),
        (
            np.eye(3),
            True,
            None,
            InputError,
            "m: expected a whole number from 1 on, got True",
        ),
        (
            np.eye(3),
            3,
            4,
            InputError,
            "rank: expected a whole number from 1 to the 3 parameters, got 4",
        ),
        (
            np.eye(3),
            3,
            True,
            InputError,
            "rank: expected a whole number from 1 to the 3 parameters, got True",
        ),
    ],
    ids=[
        "vector",
        "m-zero",
        "m-float",
        "rank-zero",
        "rank-float",
        "m-bool",
        "rank-too-large",
        "rank-bool",
    ],
)
def test_what_is_no_identification_matrix_is_refused(J, m, rank, error, message):
    with pytest.raises(error) as caught:
        observability_indices(J, m, rank)
    assert says(caught.value, message)
