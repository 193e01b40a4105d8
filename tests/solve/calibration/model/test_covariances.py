"""A covariance is one for all or one each, symmetric to a part in 1e9, and positive definite."""

from __future__ import annotations

import numpy as np
import pytest

from poekin.errors import InputError, ShapeError
from poekin.solve.calibration.model.covariances import covariances


def test_one_covariance_is_everybody_s_and_of_one_number_a_variance_will_do():
    C = np.array([[2.0, 0.5], [0.5, 1.0]])
    assert covariances(None, 3, 2, "s") is None
    for given in (C, C[None], np.tile(C, (3, 1, 1))):
        np.testing.assert_array_equal(covariances(given, 3, 2, "s"), np.tile(C, (3, 1, 1)))  # type: ignore[arg-type]
    for variances in (4.0, [4.0, 4.0, 4.0], [[4.0]]):
        np.testing.assert_array_equal(covariances(variances, 3, 1, "s"), np.full((3, 1, 1), 4.0))  # type: ignore[arg-type]


@pytest.mark.parametrize("shape", [(2,), (3,), (2, 2, 2), (3, 3), (4, 2, 2), ()])
def test_another_shape_is_refused(shape):
    with pytest.raises(ShapeError) as caught:
        covariances(np.ones(shape), 3, 2, "s")
    said = f"s: covariance: expected shape (2, 2), or (3, 2, 2), got {shape}"
    assert str(caught.value) == said


@pytest.mark.parametrize(
    ("C", "said"),
    [
        ([[0.0, 0], [0, 1]], " is not positive definite: its diagonal is [0.0, 1.0]"),
        ([[-1.0, 0], [0, 1]], " is not positive definite: its diagonal is [-1.0, 1.0]"),
        ([[4.0, 0], [0.012, 9]], " is not symmetric, by 0.002 of its diagonal"),
        ([[4.0, 0], [1.2e-8, 9]], " is not symmetric, by 2e-09 of its diagonal"),
        (
            [[1.0, 2], [2, 1]],
            " is not positive definite: scaled to a unit diagonal, its least eigenvalue is -1",
        ),
    ],
)
def test_what_is_no_covariance_is_named_with_what_it_is(C, said):
    with pytest.raises(InputError) as caught:
        covariances(C, 3, 2, "s")
    assert str(caught.value) == f"s: covariance{said}"
    with pytest.raises(InputError) as caught:
        covariances([np.eye(2), C, np.eye(2)], 3, 2, "s")  # type: ignore[list-item]
    assert str(caught.value) == f"s: covariance[1]{said}"


@pytest.mark.parametrize(
    ("left", "passes"), [(1e-12, True), (3e-14, True), (1.5e-14, False), (1e-15, False)]
)
def test_what_rounding_does_not_tell_from_singular_is_refused(left, passes):
    C = np.array([[1.0, 1.0 - left], [1.0 - left, 1.0]])  # its least eigenvalue is `left`
    if passes:
        assert covariances(C, 3, 2, "s") is not None
        return
    with pytest.raises(InputError, match="not positive definite: scaled"):
        covariances(C, 3, 2, "s")


def test_one_of_two_is_named_and_so_is_what_is_not_finite():
    with pytest.raises(InputError, match=r"^s: covariance\[1\] is not positive definite"):
        covariances([np.eye(2), -np.eye(2)], 2, 2, "s")  # type: ignore[list-item]
    with pytest.raises(InputError, match=r"^s: covariance\[0, 1\]: expected a finite number"):
        covariances([[1.0, np.nan], [0.0, 1.0]], 2, 2, "s")


def test_half_a_part_in_1e9_is_rounding():
    assert covariances([[4.0, 0], [3e-9, 9]], 3, 2, "s") is not None
