"""What residuals of a fit say of the digits: deviations, degrees of freedom, and errors of readings."""

from __future__ import annotations

import math

import numpy as np
import pytest

import poekin as pk
from poekin.solve.calibration.exact import errors as module
from poekin.solve.calibration.exact.bounds import Propagation
from poekin.solve.calibration.exact.digits import DecimalGrid, RotationGrid
from poekin.solve.calibration.exact.errors import Digits

DEGREES = DecimalGrid(math.radians(1.0), "°", 2)
MILLIMETRES = DecimalGrid(1e-3, "mm", 1)
ROTATIONS = RotationGrid(DecimalGrid(1.0, "rad", 3), "rotation vectors", 1e-3)
ALL = Digits(DEGREES, MILLIMETRES, MILLIMETRES, ROTATIONS)
NONE = Digits(None, None, None, None)


def fit(errors: np.ndarray, design: np.ndarray, gain: np.ndarray) -> Propagation:
    return Propagation(errors, design, gain, np.zeros((len(errors), 6, 1)), np.ones(6))


def test_digits_are_named_with_their_grids():
    assert str(ALL) == (
        "joint angles to 0.01°, joint lengths to 0.1 mm, positions to 0.1 mm, "
        "rotations (rotation vectors) to 0.001 rad"
    )
    assert str(NONE) == ""
    np.testing.assert_allclose(ALL.halves, [5e-4, 5e-5])
    assert NONE.halves.tolist() == [0, 0]


def test_residuals_have_the_freedom_that_the_parameters_leave_them():
    # one parameter that takes up half of the first number of three pairs, a fifth of the fourth
    design, gain = np.zeros((3, 6, 1)), np.zeros((1, 3, 6))
    design[:, 0, 0], gain[0, :, 0] = 1.0, 0.5
    design[:, 3, 0], gain[0, :, 3] = 2.0, 0.1
    errors = np.arange(18.0).reshape(3, 6)
    left = module._left(fit(errors, design, gain))
    np.testing.assert_allclose(left, [1.5, 3, 3, 2.4, 3, 3])
    turned = sum(x * x for row in errors.tolist() for x in row[:3])
    moved = sum(x * x for row in errors.tolist() for x in row[3:])
    np.testing.assert_allclose(
        module._deviations(fit(errors, design, gain), left),
        [math.sqrt(turned / 7.5), math.sqrt(moved / 8.4)],
    )


@pytest.mark.parametrize("freedom", [0.0, 0.2, 1.0])
def test_of_less_than_one_degree_of_freedom_one_is_taken(freedom):
    errors = np.zeros((2, 6))
    errors[:, 0], errors[:, 5] = [3.0, 4.0], [6.0, 8.0]
    left = np.array([freedom, 0, 0, 0, 0, freedom])
    found = module._deviations(fit(errors, np.zeros((2, 6, 1)), np.zeros((1, 2, 6))), left)
    np.testing.assert_allclose(found, [5.0, 10.0])


def test_a_fit_leaves_no_less_than_nothing():
    one = np.ones((1, 6, 1)), 2.0 * np.ones((1, 1, 6))
    assert module._left(fit(np.zeros((1, 6)), *one)).tolist() == [0] * 6


@pytest.mark.parametrize(("freedom", "size", "kept"), [
    (2.0, 0.9e-2, False),
    (2.0, 1.1e-2, True),
    (1.9, 0.0, True),
])  # fmt: skip
def test_digits_that_no_residual_bears_out_are_dropped(freedom, size, kept):
    left = np.full(6, freedom)  # of each kind's three numbers: six in all are telling
    found = module._borne_out(ALL, size * ALL.halves, left)
    assert (found.rotations, found.positions) == (
        (ROTATIONS, MILLIMETRES) if kept else (None, None)
    )
    assert (found.angles, found.lengths) == (DEGREES, MILLIMETRES)
    only = module._borne_out(ALL, ALL.halves * [1e-3, 1.0], np.full(6, 2.0))
    assert (only.rotations, only.positions) == (None, MILLIMETRES)


def test_readings_have_the_error_of_their_kind():
    screws = [pk.screw.revolute([0, 0, 1.0], [0, 0, 0]), pk.screw.prismatic([0, 0, 1.0])]
    chain = pk.Chain.from_space(screws, np.eye(4))
    np.testing.assert_allclose(module._joint_errors(ALL, chain), [math.radians(5e-3), 5e-5])
    assert module._joint_errors(NONE, chain).tolist() == [0, 0]


def test_readings_get_finer_a_decimal_at_a_time_and_are_then_exact():
    finer = list(module._refined(ALL))
    places = [one.angles.places for one in finer if one.angles is not None]
    assert places == [2, 3, 4, 5, 6, 7, 8, 9]
    lengths = [one.lengths.places for one in finer if one.lengths is not None]
    assert lengths == [1, 2, 3, 4, 5, 6, 7, 8, 9]
    assert finer[-1] == ALL._replace(angles=None, lengths=None)
    assert module._finer(None, 3) is None
