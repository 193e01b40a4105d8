"""Damping and bending of the steps of a search."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from poekin.solve.calibration.fit import minimise as minimising
from poekin.solve.calibration.fit.minimise import _bent, _Damping, _Linear, _Valley


def test_damping_doubles_and_redoubles_and_falls_to_a_tenth_where_the_gain_is_as_predicted():
    damping = _Damping()
    assert damping.value == 0.0
    values = []
    for _ in range(4):
        damping.grow()
        values.append(damping.value)
    np.testing.assert_allclose(values, [1e-6, 2e-6, 8e-6, 64e-6])
    damping.fall(1.0, 1.0)
    assert damping.value == pytest.approx(64e-7)
    damping.fall(0.5, 1.0)  # half of what was predicted: as it is
    assert damping.value == pytest.approx(64e-7)
    damping.fall(0.0, 1.0)
    assert damping.value == pytest.approx(2 * 64e-7)
    damping.grow()
    assert damping.value == pytest.approx(4 * 64e-7)
    # a bent step may gain where the linear problem has a loss: as much as could be
    damping.fall(1.0, -3.0)
    assert damping.value == pytest.approx(4 * 64e-8)


def bent(second: float, damping: float) -> tuple[np.ndarray, np.ndarray]:
    """A step, plain and bent, of errors r = A z + second |z|^2 / 2 in one of them, from z = 0."""
    rng = np.random.default_rng(0)
    A = rng.normal(size=(5, 2))
    b = rng.normal(size=5)

    def errors(p: np.ndarray) -> list[np.ndarray]:
        return [(A @ p + b + np.array([second, 0, 0, 0, 0]) * (p @ p) / 2)[:, None]]

    problem: Any = type("Problem", (), {"errors": staticmethod(errors)})
    noise: Any = type("Noise", (), {"stacked": staticmethod(lambda e: e[0].ravel())})
    objective = minimising._Objective(problem, noise, "linear", np.zeros(2), np.eye(2))
    Q, R = np.linalg.qr(A)
    linear = _Linear(R, Q.T @ b)
    valley = _Valley(np.column_stack([A, b]), A, np.ones(5))
    plain = minimising._solution(linear, damping)
    found = _bent(objective, np.zeros(2), linear, damping, valley)
    D = np.diag(np.sum(R**2, axis=0))
    r = np.array([second, 0, 0, 0, 0]) * (plain @ plain)
    expected = plain - 0.5 * np.linalg.solve(R.T @ R + damping * D, A.T @ r)
    return found - plain, expected - plain


@pytest.mark.parametrize("damping", [0.0, 0.1, 10.0])
def test_a_step_bends_by_half_the_acceleration_of_the_errors_along_it(damping):
    found, expected = bent(0.1, damping)
    # second differences of a square are exact but for rounding, 1e-16 / 0.1^2
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-13)
    assert np.linalg.norm(found) > 0


def test_a_step_stays_straight_where_it_would_bend_by_more_than_three_eighths():
    assert bent(100.0, 0.0)[0].tolist() == [0.0, 0.0]


def search(
    errors: Any,
    linearised: Any,
    start: float,
    angular: int = 0,
    reach: float = 1.0,
) -> minimising.Minimum:
    """Search in one number for the least of two errors, the first `angular` of them angles."""
    s = SimpleNamespace(width=2, angular=angular)
    nominal = SimpleNamespace(nominal=SimpleNamespace(reach=reach))
    problem: Any = SimpleNamespace(
        scale=np.ones(1), sets=[s], model=nominal, errors=errors, linearised=linearised
    )
    noise: Any = SimpleNamespace(
        stacked=lambda every: every[0].ravel(),
        squares=lambda every: [np.sum(every[0] ** 2, axis=1)],
        whitened=lambda k, J: J,
        whitened_errors=lambda k, e: e,
    )
    options = minimising.FitOptions("linear")
    return minimising.minimise(problem, np.eye(1), noise, np.array([start]), options)


def slow_search(start: float, wall: tuple[float, float] = (0.0, 0.0)) -> minimising.Minimum:
    """Search of the errors x and 1 - 0.45 x^2, of which each step leaves 0.9 of x; between the walls
    no step may end.
    """

    def errors(p: np.ndarray) -> list[np.ndarray]:
        x = float(p[0])
        if wall[0] < x < wall[1]:
            return [np.full((1, 2), 1e3)]
        return [np.array([[x, 1.0 - 0.45 * x * x]])]

    def linearised(p: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
        return [(errors(p)[0], np.array([[[1.0], [-0.9 * p[0]]]]))]

    return search(errors, linearised, start)


def test_a_slow_search_goes_to_its_end_where_no_step_was_damped():
    found = slow_search(0.5)
    assert found.converged
    assert all(step.damping == 0.0 for step in found.steps)
    # the linear problem promises (0.1 x)^2 of a cost of 1: below 1e-10 of it from x = 1e-4 on
    assert abs(found.p[0]) <= 1e-4


def test_a_slow_search_that_was_damped_once_ends_where_steps_gain_nothing_beside_the_noise():
    plain = slow_search(0.5).steps[0].step
    landing = 0.5 - plain
    found = slow_search(0.5, (landing - 0.01, landing + 0.01))
    assert found.converged
    assert len(found.steps) > 10
    assert found.steps[0].damping > 0.0
    assert 0.0 < found.steps[-1].damping < 1e-6
    # a step from x gains 0.1 (1 - 0.9^2) x^2, less than 1e-4 from 0.07 on
    assert 0.05 < abs(found.p[0]) < 0.08


def stuck_search(error: tuple[float, float], reach: float) -> minimising.Minimum:
    """Search of an angle's and a length's error, smallest where it begins, of an arm of that reach."""

    def errors(p: np.ndarray) -> list[np.ndarray]:
        return [np.array([error if p[0] == 0.0 else (1e3, 1e3)])]

    def linearised(p: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
        # so flat that no step is so short that it is rounding itself
        return [(errors(p)[0], np.array([[[1e-6], [0.5e-6]]]))]

    return search(errors, linearised, 0.0, angular=1, reach=reach)


@pytest.mark.parametrize("reach", [0.01, 1.0, 1000.0])
@pytest.mark.parametrize(
    ("angle", "length", "converged"), [(0.9, 0.9, True), (1.1, 0.0, False), (0.0, 1.1, False)]
)
def test_a_search_that_no_step_betters_has_converged_where_its_errors_are_rounding_of_rad_and_of_the_reach(
    angle, length, converged, reach
):
    # 1e-13 in rad and reaches: some 900 roundings of 1.1e-16
    found = stuck_search((angle * 1e-13, length * 1e-13 * reach), reach)
    assert found.converged is converged
    assert found.p.tolist() == [0.0]
    assert not found.steps
