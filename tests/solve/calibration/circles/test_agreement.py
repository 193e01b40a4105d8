"""Sweeps agree on the point of the tool where they are no farther apart than their deviations allow."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.model.chain import Chain
from poekin.solve.calibration.circles.agreement import apart, home_changes
from poekin.solve.calibration.circles.axis_fit import AxisFit
from poekin.solve.calibration.circles.joint_sweep import JointSweep
from poekin.solve.calibration.circles.rough_axis import carried_back
from tests.solve.calibration.circles.sweeps import UR5, swept

HELD = np.array([0.4, -1.0, 1.0, 0.3, 0.2, 0.1])
PLACE = np.array([0.3, -0.2, 0.7])


def fit(joint: int, rms: float) -> AxisFit:
    return AxisFit(joint, np.zeros(6), np.zeros((6, 6)), 1.0, 1.0, 0.0, 0.0, rms)


def said(offs: list, rms: float, changes: np.ndarray, covariance: np.ndarray) -> list[str]:
    """What is said of sweeps of the joints 0, 1, ... whose point is off by so much."""
    homes = [pk.se3.pose(np.eye(3), PLACE + off) for off in offs]
    fits = [fit(joint, rms) for joint in range(len(offs))]
    return list(apart(fits, homes, list(changes), covariance))


def words(joint: int, size: str) -> str:
    return (
        f"sweep of joint {joint}: its point is {size} mm from that of the others: another point of the "
        "tool, or readings with errors of their own (gain, gears, coupled joints)"
    )


@pytest.mark.parametrize("direction", [[1.0, 0, 0], [0, -0.6, 0.8]])
@pytest.mark.parametrize(("rms", "unit"), [(2e-4, 2e-4), (0.0, 1e-11)])
def test_a_point_is_another_beyond_five_of_its_deviations(direction, rms, unit):
    nothing = np.zeros((4, 3, 24)), np.eye(24)
    near, far = (times * unit * np.array(direction) for times in (4.9, 5.1))
    assert said([0 * near, 0 * near, near, 0 * near], rms, *nothing) == []
    size = f"{5.1e3 * unit:.3g}"
    assert said([0 * far, 0 * far, far, 0 * far], rms, *nothing) == [words(2, size)]
    assert said([far, 0 * far, 0 * far, 0 * far], rms, *nothing) == [words(0, size)]


def test_what_the_axes_leave_open_of_a_point_is_added_to_its_noise():
    """Of three axes with variances 1, 4 and 9: each moves the point of the last sweep by itself."""
    rms, unit = 3e-4, 2e-4
    changes = np.zeros((4, 3, 24))
    changes[3, [0, 1, 2], [0, 7, 23]] = 4.0 / 3.0  # 1 from the mean of the four
    deviations = np.ones(24)
    deviations[[7, 23]] = 2.0, 3.0
    covariance = np.diag((unit * deviations) ** 2)
    for axis, deviation in enumerate([1.0, 2.0, 3.0]):
        spread = np.hypot(deviation * unit, rms)
        for times in (4.9, 5.1):
            offs = np.zeros((4, 3))
            offs[3, axis] = times * spread
            found = said(list(offs), rms, changes, covariance)
            expected = [words(3, f"{1e3 * times * spread:.3g}")] if times > 5 else []
            assert found == expected
            # that all points are moved alike says nothing of one of them
            assert said(list(offs), rms, changes + 7.0, covariance) == expected


def test_the_point_moves_with_the_screws_as_their_difference_quotient():
    joint = 3
    q = swept(UR5, joint, HELD)
    bare = Chain.from_space(UR5.screws, np.eye(4))
    sweep = JointSweep(joint, q, UR5.fk(q)[:, :3, 3])

    def home(arm: Chain) -> np.ndarray:
        return carried_back(sweep, pk.se3.inverse(arm.fk(q)))

    J = home_changes(bare, sweep, pk.se3.inverse(bare.fk(q)), home(bare))
    assert J.shape == (3, 36)
    h = 1e-6
    for i in range(6):
        for k in range(6):
            along = pk.se3.ad(np.eye(6)[k]) @ bare.screws[i]
            ends = []
            for sign in (1, -1):
                screws = bare.screws.copy()
                screws[i] += sign * h * along
                ends.append(home(Chain.from_space(screws, np.eye(4)))[:3, 3])
            slope = (ends[0] - ends[1]) / (2 * h)
            # h^2 of third derivatives of some m, and rounding of 1e-15 m over h
            np.testing.assert_allclose(J[:, 6 * i : 6 * i + 6] @ along, slope, rtol=0, atol=1e-8)
