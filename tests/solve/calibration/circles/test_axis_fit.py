"""The axis of one sweep: where it is, how well it is known, and readings that are not those of it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError
from poekin.solve.calibration import Points, Poses
from poekin.solve.calibration.circles.axis_fit import (
    AxisFit,
    _about,
    _covariance_root,
    _deviation,
    fit_axis,
)
from poekin.solve.calibration.circles.joint_sweep import JointSweep
from tests.messages import says
from tests.solve.calibration.circles.sweeps import SCARA, UR5, swept


def sweep_of(true: pk.Chain, joint: int, factor: float, poses: bool) -> JointSweep:
    """A sweep whose readings are so many times what the joint moved by."""
    q = swept(true, joint, np.full(true.dof, 0.3), half=0.5)
    T = true.fk(q)
    read = q.copy()
    read[:, joint] *= factor
    kind = "prismatic" if true.kinds[joint] == "prismatic" else "revolute"
    return JointSweep(joint, read, T if poses else T[:, :3, 3], kind)


@pytest.mark.parametrize("poses", [False, True])
@pytest.mark.parametrize("gain", [0.89, 0.91, 1.0, 1.09, 1.11])
def test_readings_may_be_off_by_a_tenth_of_the_measured_motion(gain, poses):
    sweep = sweep_of(UR5, 4, 1.0 / gain, poses)
    if 0.9 < gain < 1.1:
        found = fit_axis(sweep)
        np.testing.assert_allclose(found.arc, 1.0, rtol=1e-9)
        assert found.joint == 4
        return
    with pytest.raises(InputError) as caught:
        fit_axis(sweep)
    assert says(
        caught.value,
        f"sweep of joint 4: the measured motion is {gain:.3g} times that of the readings: are they those of "
        "this joint, in rad or m, and is it the kind of joint that it is said to be?",
    )


def test_radius_and_arc_are_those_of_the_circle_and_of_a_line_there_is_no_radius():
    sweep = sweep_of(UR5, 4, 1.0, False)
    found = fit_axis(sweep)
    assert found.rms == pytest.approx(0.0, abs=1e-12)
    u, v = found.screw[:3], found.screw[3:]
    away = np.cross(sweep.positions - np.cross(u, v), u)
    np.testing.assert_allclose(np.linalg.norm(away, axis=1), found.radius, rtol=1e-9)
    line = fit_axis(sweep_of(SCARA, 2, 1.0, False))
    assert (line.radius, line.shift) == (0.0, 0.0)
    assert line.arc == pytest.approx(1.0 / 3.0)


def test_the_deviation_of_a_place_is_that_of_the_axis_beside_the_middle_of_the_points():
    """Of an axis through c that is turned by dt and moved by ds, the point at c moves by ds alone."""
    u, c = np.array([0.0, 0.6, 0.8]), np.array([0.2, -0.1, 0.4])
    across = np.array([1.0, 0.0, 0.0])
    heights = np.array([0.1, 0.5, -0.2, 0.4])
    angles = np.array([0.0, 1.0, 2.0, 3.0])
    positions = c + heights[:, None] * u
    positions = positions + 0.3 * (
        np.cos(angles)[:, None] * across + np.sin(angles)[:, None] * np.cross(u, across)
    )
    middle = c + heights.mean() * u
    screw = np.concatenate([u, np.cross(c, u)])
    dt, ds = np.array([2e-3, 0.0, 0.0]), np.array([3e-4, 0.0, 0.0])
    # a line through m has v = m x u
    moved = np.concatenate([dt, np.cross(ds, u) + np.cross(middle, dt)])
    radius, shift = _about(screw, np.outer(moved, moved), positions)
    assert radius == pytest.approx(np.hypot(0.3, heights[0] - heights.mean()))
    assert shift == pytest.approx(3e-4, rel=1e-9)
    assert _about(np.array([0.0, 0, 0, 0, 0, 1.0]), np.eye(6), positions) == (0.0, 0.0)
    assert _deviation(np.diag([4.0, 9.0, 12.0])) == pytest.approx(5.0)


@pytest.mark.parametrize(("poses", "N"), [(True, 7), (False, 9), (True, 1)])
def test_each_kind_of_number_has_the_noise_that_the_fit_left_of_it(poses, N):
    """The covariance of least squares with a variance of its own for angles and for lengths; where
    the fit leaves less than one degree of freedom, one is taken.
    """
    rng = np.random.default_rng(3)
    width = 6 if poses else 3
    measured: Any = Poses(np.tile(np.eye(4), (N, 1, 1))) if poses else Points(np.zeros((N, 3)))
    columns = 5 if N > 1 else 4
    J = rng.normal(size=(N * width, columns))
    errors = rng.normal(size=(N, width))
    sigma = np.array([0.5, 0.5, 0.5, 2.0, 2.0, 2.0])[-width:]
    noise = SimpleNamespace(whitened_errors=lambda k, e: e / sigma if k == 0 else None)
    problem: Any = SimpleNamespace(sets=(measured,), errors=lambda p: [errors])
    fit: Any = SimpleNamespace(p=None, jacobian=J, noise=noise)
    H = _covariance_root(problem, fit)
    inverse = np.linalg.inv(J.T @ J)
    leverage = np.diag(J @ inverse @ J.T).reshape(N, width)
    whitened = (errors / sigma) ** 2
    variances = np.empty(width)
    for part in (slice(0, width - 3), slice(width - 3, width)):
        freedom = np.sum(1.0 - leverage[:, part])
        if N == 1:
            assert freedom < 2.0
        variances[part] = np.sum(whitened[:, part]) / max(freedom, 1.0)
    expected = inverse @ J.T @ np.diag(np.tile(variances, N)) @ J @ inverse
    np.testing.assert_allclose(H @ H.T, expected, rtol=1e-9, atol=1e-12)


def test_an_axis_is_told_with_its_deviations_in_milliradians_and_millimetres():
    axis = AxisFit(2, np.zeros(6), np.eye(6), 1.0, 0.5, 9.98e-4, 9.96e-3, 9.94e-5)
    words = "direction ± 1 mrad, place ± 10 mm; residual 0.099 mm rms"
    assert axis.summary() == words
    assert f"joint 2, {words}" in repr(axis)
    line = axis._replace(radius=0.0)
    assert line.summary() == "direction ± 1 mrad; residual 0.099 mm rms"


@pytest.mark.parametrize("size", [9.5455e-4, 9.4548e-4])
def test_a_milliradian_is_a_thousandth(size):
    """To two digits, where a factor of 999 or 1001 would make other ones of one of these."""
    axis = AxisFit(2, np.zeros(6), np.eye(6), 1.0, 0.5, size, size, size)
    assert axis.summary() == "direction ± 0.95 mrad, place ± 0.95 mm; residual 0.95 mm rms"
