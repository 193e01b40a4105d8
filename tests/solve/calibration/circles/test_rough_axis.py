"""The axis from which a fit starts is linear in the points, and of exact ones the joint's own."""

from __future__ import annotations

import re

import numpy as np
import pytest

from poekin.errors import InputError
from poekin.groups import so3
from poekin.solve.calibration import JointSweep
from poekin.solve.calibration.circles.joint_sweep import SweepKind
from poekin.solve.calibration.circles.rough_axis import check_arc, rough_axis
from tests.solve.calibration.circles.sweeps import ARMS, noisy, swept

HELD = np.array([0.4, -1.0, 1.0, 0.3, 0.2, 0.1])


@pytest.mark.parametrize("poses", [False, True], ids=["points", "poses"])
@pytest.mark.parametrize(
    ("name", "joint"), [("ur5", 0), ("ur5", 2), ("ur5", 4), ("scara", 1), ("scara", 2)]
)
def test_the_rough_axis_of_exact_measurements_is_the_column_of_the_jacobian(name, joint, poses):
    arm = ARMS[name]
    slides = arm.kinds[joint] == "prismatic"
    middle = HELD[: arm.dof].copy()
    q = swept(arm, joint, middle)[np.random.default_rng(0).permutation(16)]
    T = arm.fk(q)
    sweep = JointSweep(joint, q, T if poses else T[:, :3, 3], "prismatic" if slides else "revolute")
    found = rough_axis(sweep, "")
    # rounding of metres over an arc of 2 rad, of circles of 0.1 m and more
    expected = arm.jacobian(middle, "space")[:, joint]
    np.testing.assert_allclose(found.screw, expected, rtol=0, atol=1e-12)
    home = arm.fk(middle)
    np.testing.assert_allclose(found.home[:3, 3], home[:3, 3], rtol=0, atol=1e-12)
    R = home[:3, :3] if poses else np.eye(3)
    np.testing.assert_allclose(found.home[:3, :3], R, rtol=0, atol=1e-12)


@pytest.mark.parametrize("poses", [False, True], ids=["points", "poses"])
def test_the_rough_axis_of_noisy_measurements_is_off_by_some_of_their_noise(poses):
    arm, noise = ARMS["ur5"], 1e-5
    q = swept(arm, 2, HELD, count=40)
    T = arm.fk(q)
    sweep = JointSweep(2, q, noisy(T, noise, np.random.default_rng(0), poses))
    found = rough_axis(sweep, "")
    expected = arm.jacobian(HELD, "space")[:, 2]
    # 40 readings leave a sixth of the noise of each, over radii of 0.5 m and levers of 3 m
    np.testing.assert_allclose(found.screw, expected, rtol=0, atol=6 * noise)
    turned = so3.log(found.home[:3, :3].T @ (arm.fk(HELD)[:3, :3] if poses else np.eye(3)))
    assert np.abs(turned).max() < noise
    assert np.abs(found.home[:3, 3] - arm.fk(HELD)[:3, 3]).max() < noise


def sweep_of(x, p, kind: SweepKind = "revolute") -> JointSweep:
    return JointSweep(0, np.asarray(x, float)[:, None], p, kind)


# over even readings this misses every line, by its size at each
ACROSS = np.array([1.0, -1, -1, 1])


@pytest.mark.parametrize(("times", "scatter", "said"), [
    (2.9, 1.1, None),
    (2.75, 1.0505, ("3.1", "1.1")),
    (2.75, 1.0495, ("3.1", "1")),
    (2.75, 3.1505 / np.hypot(2.75, 1), ("3.2", "1.1")),
    (2.75, 3.1495 / np.hypot(2.75, 1), ("3.1", "1.1")),
])  # fmt: skip
def test_a_point_has_to_move_by_three_times_its_scatter(times, scatter, said):
    """By times and 1 scatters across the line, hence hypot(times, 1) in all: 2.93 or 3.07."""
    x = np.array([-0.3, -0.1, 0.1, 0.3])
    e = 1e-3 * scatter
    p = np.column_stack([times * e * x / 0.3, e * ACROSS, np.zeros(4)]) + np.array([1, 2, 3])
    sweep = sweep_of(x, p, "prismatic")
    if said is None:
        np.testing.assert_allclose(rough_axis(sweep, "").screw, [0, 0, 0, 1, 0, 0], atol=1e-12)
        return
    message = (
        f"here: the point moves by {said[0]} mm and scatters by {said[1]} mm about what the readings "
        "say: it is on the axis (fix it farther away), or these are not this joint's readings, in "
        "rad or m"
    )
    with pytest.raises(InputError, match=f"^{re.escape(message)}$"):
        rough_axis(sweep, "here")


@pytest.mark.parametrize("size", [1e-13, 1e-11])
def test_a_motion_of_rounding_is_none(size):
    x = np.array([-0.3, -0.1, 0.1, 0.3])
    sweep = sweep_of(x, np.outer(x, [size, 0, 0]), "prismatic")
    if size > 1e-12:
        assert rough_axis(sweep, "").screw[3] == pytest.approx(1.0)
        return
    with pytest.raises(InputError, match=r"moves by 3e-11 mm and scatters by \S+ mm"):
        rough_axis(sweep, "")


# each 1.05 times as long as the one before, until (tilt / 0.02) times the deviation is gone
@pytest.mark.parametrize(
    ("tilt", "steps"), [(0.0201, 1), (0.023, 3), (0.04, 15), (0.1, 33), (1.0, 81)]
)
def test_of_a_line_the_stroke_that_would_do_is_as_many_times_as_long_as_it_is_too_loose(
    tilt, steps
):
    x = np.linspace(0.2, 0.4, 6)
    sweep = sweep_of(x, np.zeros((6, 3)), "prismatic")
    check_arc(sweep, 0.02, 1.0, "here")
    would = 200 * 1.05**steps
    message = (
        f"here: a stroke of 200 mm leaves the axis known to {tilt:.2g} rad (one standard deviation), "
        f"expected 0.02 rad or less; with as many readings a stroke of {would:.3g} mm would do"
    )
    with pytest.raises(InputError, match=f"^{re.escape(message)}$"):
        check_arc(sweep, tilt, 1.0, "here")


@pytest.mark.parametrize("poses", [False, True], ids=["points", "poses"])
@pytest.mark.parametrize("tilt", [0.021, 0.05, 0.11, 0.121, 0.14, 0.16, 40.0])
def test_the_arc_that_would_do_shows_the_circle_so_many_times_better(poses, tilt):
    """Deviations by the inverse of the sums over the readings, of cosine and sine or of the turn."""
    x = np.linspace(-0.5, 0.5, 9)

    def spread(arc):
        y = arc * x
        columns = [np.ones(9), y] if poses else [np.ones(9), np.cos(y), np.sin(y)]
        sums = np.array([[a @ b for b in columns] for a in columns])
        return np.sqrt(np.diag(np.linalg.inv(sums))[1:].sum())

    measured = np.tile(np.eye(4), (9, 1, 1)) if poses else np.zeros((9, 3))
    arc = 1.0
    while arc < 2 * np.pi and spread(arc) > spread(1.0) * 0.02 / tilt:
        arc *= 1.05
    would = f"with as many readings an arc of {np.rad2deg(arc):.3g}° would do"
    if arc >= 2 * np.pi:
        would = "no arc would do: measure farther from the axis, or more readings"
    message = (
        f"here: an arc of 57.3° leaves the axis known to {tilt:.2g} rad and {13 if poses else 12} mm (one standard "
        f"deviation), expected 0.02 rad or less; {would}"
    )
    with pytest.raises(InputError, match=f"^{re.escape(message)}$"):
        check_arc(sweep_of(x, measured), tilt, 0.012506 if poses else 0.012495, "here")


def test_a_circle_is_known_by_what_its_points_miss_it_by_for_each_number_that_is_over():
    x = 2 * np.pi * np.arange(8) / 8
    e = 0.05
    # what turns twice is seen by no sum of 1, cosine and sine: 8 misses of e / sqrt(2)
    p = np.column_stack([np.cos(x), np.sin(x), e * np.cos(2 * x)]) + np.array([1, 2, 3])
    sigma = np.sqrt(8 * e**2 / 2 / (3 * 8 - 3 * 3))
    shift = sigma * np.sqrt(1 / 4 + 1 / 4)
    y = x - x.mean()
    slope = np.linalg.norm(y @ (p - p.mean(axis=0))) / (y @ y)
    message = f"here: an arc of 315° leaves the axis known to {shift / slope:.2g} rad and {1e3 * shift:.2g} mm"
    with pytest.raises(InputError, match=f"^{re.escape(message)} "):
        rough_axis(sweep_of(x, p), "here")
