"""What the residuals of a fit say of the digits of pairs: borne out, too small, too large, or unknown."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.solve.calibration.exact import errors as module
from poekin.solve.calibration.exact.bounds import ROUNDING, Propagation
from poekin.solve.calibration.exact.digits import DecimalGrid, RotationGrid
from poekin.solve.calibration.exact.errors import LIMITS, Digits, judge, printed_digits
from poekin.solve.calibration.fit.losses import chi_square

N = 40
CHAIN = pk.Chain.from_space(
    [pk.screw.revolute([0, 0, 1.0], [0, 0, 0]), pk.screw.prismatic([1.0, 0, 0])],
    pk.se3.pose(np.eye(3), [2.0, 0, 0]),
)
REACH = CHAIN.reach
ANGLES = DecimalGrid(math.radians(1.0), "°", 2)
LENGTHS = DecimalGrid(1e-3, "mm", 1)
POSITIONS = DecimalGrid(1e-3, "mm", 3)
ROTATIONS = RotationGrid(DecimalGrid(1.0, "rad", 6), "rotation vector", 8e-7)
NONE = Digits(None, None, None, None)
OF_POSES = Digits(None, None, POSITIONS, ROTATIONS)
UNIFORM = 3.0**-0.5  # deviation of an error that is as likely anywhere up to 1


def fit_of(deviations: Any, moved: Any = 0.0, seed: int = 0) -> Propagation:
    """A fit that takes up nothing, with residuals of exactly these deviations (6,); `moved`: Jacobian
    (6, 2) of the pose in both joints.
    """
    e = np.random.default_rng(seed).normal(size=(N, 6))
    e = e.reshape(N, 2, 3)
    e /= np.sqrt(np.mean(e**2, axis=(0, 2), keepdims=True))
    errors = e.reshape(N, 6) * np.repeat(np.broadcast_to(deviations, 2), 3)
    J = np.broadcast_to(np.asarray(moved, float), (N, 6, 2))
    return Propagation(
        errors, np.zeros((N, 6, 1)), np.zeros((1, N, 6)), J, np.repeat([2.0, 3.0], 3)
    )


def test_residuals_of_rounded_poses_bear_their_digits_out():
    halves = OF_POSES.halves
    np.testing.assert_allclose(halves, [5e-7, 5e-7])
    found = judge(OF_POSES, fit_of(UNIFORM * halves), CHAIN)
    assert found.digits == OF_POSES
    assert not found.beyond_digits
    np.testing.assert_allclose(found.deviations, UNIFORM * halves, rtol=1e-12)
    assert found.largest.rotation == ROTATIONS.radius
    assert found.largest.position == POSITIONS.half
    assert found.largest.joints.tolist() == [0.0, 0.0]


@pytest.mark.parametrize("kind", [0, 1])
def test_residuals_three_times_as_large_as_rounding_are_beyond_the_digits(kind):
    deviations = UNIFORM * OF_POSES.halves
    deviations[kind] *= 3.0
    assert judge(OF_POSES, fit_of(deviations), CHAIN).beyond_digits


@pytest.mark.parametrize("kind", [0, 1])
@pytest.mark.parametrize(("times", "beyond"), [(0.98, False), (1.02, True)])
def test_numbers_without_digits_scatter_by_no_more_than_half_as_much_again_as_the_limits(
    kind, times, beyond
):
    deviations = 0.1 * np.array(LIMITS) * [1.0, REACH]
    deviations[kind] *= 15.0 * times
    found = judge(NONE, fit_of(deviations), CHAIN)
    assert found.beyond_digits == beyond
    assert found.digits == NONE
    largest = [found.largest.rotation, found.largest.position]
    np.testing.assert_allclose(largest, 5.0 * deviations, rtol=1e-12)


def test_no_error_is_smaller_than_that_of_forward_kinematics():
    found = judge(NONE, fit_of([0.0, 0.0]), CHAIN)
    assert found.largest.rotation == ROUNDING
    assert found.largest.position == pytest.approx(ROUNDING * REACH)
    assert not found.beyond_digits


def test_of_numbers_with_digits_and_others_each_has_its_own_error():
    only = NONE._replace(positions=POSITIONS)
    found = judge(only, fit_of([1e-8, UNIFORM * 5e-7]), CHAIN)
    assert found.digits == only
    assert not found.beyond_digits
    assert found.largest.rotation == pytest.approx(5e-8)
    assert found.largest.position == POSITIONS.half
    assert judge(only, fit_of([1e-8, 3 * UNIFORM * 5e-7]), CHAIN).beyond_digits
    assert judge(only, fit_of([1.6e-3, UNIFORM * 5e-7]), CHAIN).beyond_digits


def test_digits_of_readings_that_the_residuals_refute_were_not_rounded():
    """Both joints would move the pose by far more than the poses' own digits."""
    printed = Digits(ANGLES, LENGTHS, POSITIONS, ROTATIONS)
    moved = np.zeros((6, 2))
    moved[0, 0], moved[1, 1] = 1.0, 1.0
    by_joints = np.array([ANGLES.half, LENGTHS.half])
    kept = judge(printed, _with(UNIFORM * OF_POSES.halves, moved, UNIFORM * by_joints), CHAIN)
    assert kept.digits == printed
    np.testing.assert_allclose(kept.largest.joints, by_joints, rtol=1e-12)
    exact = judge(printed, fit_of(UNIFORM * OF_POSES.halves, moved), CHAIN)
    assert exact.digits == OF_POSES
    assert not exact.beyond_digits
    # their digits are those at which the residuals are not too small any more
    assert exact.largest.joints.max() <= 1e-5
    assert exact.largest.rotation == ROTATIONS.radius


def test_readings_of_few_digits_are_exact_where_the_residuals_are_rounding():
    moved = np.zeros((6, 2))
    moved[0, 0], moved[1, 1] = 1.0, 1.0
    found = judge(NONE._replace(angles=ANGLES, lengths=LENGTHS), fit_of(1e-15, moved), CHAIN)
    assert found.digits == NONE
    assert found.largest.joints.tolist() == [0.0, 0.0]


def _with(deviations: np.ndarray, moved: np.ndarray, of_joints: np.ndarray) -> Propagation:
    """A fit whose residuals have in the first two numbers those of the joints as well."""
    fit = fit_of(deviations, moved)
    errors = fit.errors.copy()
    e = np.random.default_rng(1).normal(size=(N, 2))
    errors[:, :2] += of_joints * e / np.sqrt(np.mean(e**2, axis=0))
    return fit._replace(errors=errors)


def test_digits_of_both_kinds_are_of_the_numbers_that_have_them():
    rng = np.random.default_rng(2)
    q = np.stack([np.radians(rng.uniform(-90, 90, 20).round(2)), rng.uniform(0, 1, 20).round(4)], 1)
    T = CHAIN.fk(rng.uniform(-1, 1, (20, 2)))
    T[:, :3, 3] = T[:, :3, 3].round(6)
    found = printed_digits(CHAIN, q, T)
    assert found.angles == ANGLES
    assert found.lengths == LENGTHS
    assert found.positions == POSITIONS
    assert found.rotations is None
    turns = pk.Chain.from_space(CHAIN.screws[:1], CHAIN.home)
    assert printed_digits(turns, q[:, :1], T).lengths is None
    slides = pk.Chain.from_space(CHAIN.screws[1:], CHAIN.home)
    only = printed_digits(slides, q[:, 1:], T)
    assert (only.angles, only.lengths) == (None, LENGTHS)


def expected_of(digits: Digits, fit: Propagation, left: np.ndarray) -> tuple[float, float, list]:
    """Ratio of the squares of the residuals to those expected, the degrees of freedom of these, and
    the deviations expected, number by number.
    """
    joints = [ANGLES.half if digits.angles else 0.0, LENGTHS.half if digits.lengths else 0.0]
    halves = digits.halves
    known = [bool(halves[k // 3] > 0 or not halves.any()) for k in range(6)]
    halves = [max(halves[0], ROUNDING), max(halves[1], ROUNDING * REACH)]
    total = mean = squares = 0.0
    variances = np.zeros((N, 6))
    found = 0.0
    for n in range(N):
        J = fit.jacobian[n]
        for a in range(6):
            for b in range(6):
                c = sum(J[a, j] * J[b, j] * joints[j] ** 2 for j in range(2)) / 3
                if a == b:
                    c += halves[a // 3] ** 2 / 3
                    variances[n, a] = c
                if known[a] and known[b]:
                    c /= fit.deviations[a] * fit.deviations[b]
                    total += c**2
                    if a == b:
                        squares += c
                        mean += c * left[a] / N
        for a in range(6):
            found += known[a] * (fit.errors[n, a] / fit.deviations[a]) ** 2
    freedom = max(1.0, mean * squares / total)
    each = variances.mean(axis=0)
    deviations = [math.sqrt(each[:3].mean()), math.sqrt(each[3:].mean())]
    return found / mean, freedom, deviations


CASES = {
    "of both": OF_POSES,
    "of positions": NONE._replace(positions=POSITIONS),
    "of rotations": NONE._replace(rotations=ROTATIONS),
    "of readings": NONE._replace(angles=ANGLES, lengths=LENGTHS),
    "of all": Digits(ANGLES, LENGTHS, POSITIONS, ROTATIONS),
    "of none": NONE,
}


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("part", [1.0, 1e-3])
def test_residuals_are_too_small_or_too_large_beyond_a_chance_of_one_in_a_million(case, part):
    """By Satterthwaite's degrees of freedom, of which a fit left a part."""
    digits = CASES[case]
    rng = np.random.default_rng(5)
    fit = fit_of([1e-6, 2e-6], rng.normal(size=(6, 2)))
    left = part * rng.uniform(20, 40, 6)
    ratio, freedom, deviations = expected_of(digits, fit, left)
    assert (freedom == 1.0) == (part < 1.0)
    first = module._expected(digits, fit, left, CHAIN)
    np.testing.assert_allclose(first.deviations, deviations, rtol=1e-12)
    low = chi_square(freedom, -4.75) / freedom / 1.5
    high = 1.5 * chi_square(freedom, 4.75) / freedom
    for size, small, large in (
        (0.99 * low, True, False),
        (1.01 * low, False, False),
        (0.99 * high, False, False),
        (1.01 * high, False, True),
    ):
        if size <= 0:  # so few say nothing is too small
            continue
        scaled = fit._replace(errors=fit.errors * math.sqrt(size / ratio))
        found = module._expected(digits, scaled, left, CHAIN)
        assert (found.too_small, found.too_large) == (small, large)
