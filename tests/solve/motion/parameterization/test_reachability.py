"""The passes of reachability analysis, against exact laws and a dense optimum of another kind."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from poekin.solve.motion.parameterization.joint_spline import PathDerivatives
from poekin.solve.motion.parameterization.reachability import fastest, times_of
from tests.solve.motion.dense_optimum import shortest_time


def line(s: np.ndarray, direction: np.ndarray) -> PathDerivatives:
    first = np.tile(direction, (len(s), 1))
    return PathDerivatives(s[:, None] * direction, first, 0 * first)


def duration(s, path, speed, acceleration) -> float:
    return float(times_of(s, fastest(s, path, np.array(speed), np.array(acceleration)))[-1])


def straight_line_time(direction, speed, acceleration) -> float:
    """Bang-bang over a unit of s: up, even, down; or up and down where the speed is not reached."""
    v = min(s / abs(d) for s, d in zip(speed, direction, strict=True))
    a = min(s / abs(d) for s, d in zip(acceleration, direction, strict=True))
    return 1 / v + v / a if v * v <= a else 2 / np.sqrt(a)


LINES = {
    "speed is reached": ([1.0, -0.3, 0.5], [1.0, 2.0, 3.0], [4.0, 9.0, 9.0]),
    "speed is not reached": ([1.0, -0.3, 0.5], [1.0, 2.0, 3.0], [0.8, 9.0, 9.0]),
    "no limit of speed": ([0.2, 1.0, -1.0], [np.inf] * 3, [1.0, 2.0, 3.0]),
}


@pytest.mark.parametrize("case", LINES)
def test_a_straight_line_takes_the_bang_bang_time(case):
    direction, speed, acceleration = LINES[case]
    expected = straight_line_time(direction, speed, acceleration)
    for steps in (64, 1000):
        s = np.linspace(0, 1, steps + 1)
        found = duration(s, line(s, np.array(direction)), speed, acceleration)
        # a switch lies within a step: one step is passed at most by 1/sqrt(2) too slowly
        assert expected * (1 - 1e-12) <= found <= expected * (1 + 1 / steps)


def test_a_switch_on_the_grid_is_exact():
    s = np.linspace(0, 1, 9)  # v² / 2a = 1/8
    found = duration(s, line(s, np.array([1.0])), [1.0], [4.0])
    assert found == pytest.approx(1.25, rel=4e-16)


def splines():
    rng = np.random.default_rng(7)
    for _ in range(5):
        spline = CubicSpline(np.linspace(0, 1, 8), rng.uniform(-2, 2, (8, 6)))
        yield spline, rng.uniform(1.5, 3.2, 6), rng.uniform(3, 15, 6)


def derivatives(spline, s) -> PathDerivatives:
    return PathDerivatives(*(spline(s, k) for k in range(3)))


@pytest.mark.parametrize("number", range(5))
def test_five_splines_take_at_most_one_percent_longer_than_by_linear_programming(number):
    spline, speed, acceleration = list(splines())[number]
    s = np.linspace(0, 1, 1001)
    best = shortest_time(spline, speed, acceleration, s)
    found = duration(s, derivatives(spline, s), speed, acceleration)
    # both are off by their switches within steps, of some steps in 1000
    assert 0.995 * best <= found <= 1.01 * best


@pytest.mark.parametrize("number", range(5))
def test_toppra_finds_the_same_time(number):
    toppra = pytest.importorskip("toppra")
    spline, speed, acceleration = list(splines())[number]
    s = np.linspace(0, 1, 501)
    constraints = [
        toppra.constraint.JointVelocityConstraint(np.stack([-speed, speed], axis=1)),
        toppra.constraint.JointAccelerationConstraint(
            np.stack([-acceleration, acceleration], axis=1),
            discretization_scheme=toppra.constraint.DiscretizationType.Interpolation,
        ),
    ]
    path = toppra.SplineInterpolator(spline.x, spline(spline.x))
    instance = toppra.algorithm.TOPPRA(
        constraints, path, gridpoints=s, parametrizer="ParametrizeConstAccel"
    )
    expected = instance.compute_trajectory(0, 0).duration
    found = duration(s, derivatives(spline, s), speed, acceleration)
    assert found == pytest.approx(expected, rel=1e-4)  # its solver's tolerances are 1e-6 and more


@pytest.mark.parametrize("number", range(5))
def test_the_way_back_takes_as_long(number):
    spline, speed, acceleration = list(splines())[number]
    s = np.linspace(0, 1, 1001)
    path = derivatives(spline, s)
    back = PathDerivatives(path.q[::-1], -path.first[::-1], path.second[::-1])
    there = duration(s, path, speed, acceleration)
    # forward and backward, the limits at a step's ends are not the same ones: 1 step in 1000
    assert duration(s, back, speed, acceleration) == pytest.approx(there, rel=2e-3)


@pytest.mark.parametrize("factor", [1e-3, 0.5, 30.0])
def test_limits_of_a_faster_clock_divide_the_time(factor):
    for spline, speed, acceleration in splines():
        s = np.linspace(0, 1, 201)
        path = derivatives(spline, s)
        once = duration(s, path, speed, acceleration)
        found = duration(s, path, factor * speed, factor**2 * acceleration)
        assert found * factor == pytest.approx(once, rel=1e-12)


def test_no_limit_is_exceeded_at_the_ends_of_any_step():
    for spline, speed, acceleration in splines():
        s = np.linspace(0, 1, 301)
        path = derivatives(spline, s)
        x = fastest(s, path, speed, acceleration)
        assert x[0] == x[-1] == 0
        assert (x[1:-1] > 0).all()
        assert (np.abs(path.first) * np.sqrt(x)[:, None] <= speed * (1 + 1e-12)).all()
        u = np.diff(x) / (2 * np.diff(s))
        for end in (slice(None, -1), slice(1, None)):
            found = path.first[end] * u[:, None] + path.second[end] * x[end, None]
            # of terms that cancel, each some times the limit
            assert (np.abs(found) <= acceleration * (1 + 1e-9)).all()


def test_a_coordinate_without_limits_does_not_count():
    for spline, speed, acceleration in splines():
        s = np.linspace(0, 1, 201)
        path = derivatives(spline, s)
        one = PathDerivatives(*(part[:, :1] for part in path))
        alone = duration(s, one, speed[:1], acceleration[:1])
        free = np.full(5, np.inf)
        found = duration(s, path, np.append(speed[:1], free), np.append(acceleration[:1], free))
        assert found == pytest.approx(alone, rel=1e-12)


def test_where_a_coordinate_turns_back_its_bending_limits_the_speed():
    s = np.linspace(-1, 1, 201)
    zero = np.zeros((201, 1))
    # q = (s, s²): at s = 0 the second one turns back, and 2 x <= a
    first = np.concatenate([zero + 1, 2 * s[:, None]], axis=1)
    path = PathDerivatives(first, first, np.concatenate([zero, zero + 2], axis=1))
    x = fastest(s, path, np.full(2, np.inf), np.array([1e6, 3.0]))
    assert x[100] == pytest.approx(1.5, rel=1e-9)
