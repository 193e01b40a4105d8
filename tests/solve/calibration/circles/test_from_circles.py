"""`from_circles`: exact on exact data, within its deviations on noisy data, a start for `calibrate`."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import poekin as pk
from poekin.groups import se3
from poekin.solve.calibration import JointSweep, Points, calibrate, from_circles
from poekin.solve.calibration.circles.axis_fit import fit_axis
from poekin.solve.calibration.circles.from_circles import at_zero
from tests.solve.calibration.circles.sweeps import (
    ARMS,
    DEVICE,
    SCARA,
    TOOL,
    UR5,
    noisy,
    sweep_all,
    swept,
)

HELD = np.array([0.0, -1.0, 1.0, 0.3, 0.2, 0.1])
NOISE = 1e-4
EVERY = [(name, poses) for name in ARMS for poses in (False, True)]


@pytest.mark.parametrize(("name", "poses"), EVERY)
@settings(max_examples=4)
@given(seed=st.integers(0, 2**32 - 1), half=st.floats(0.5, 3.0))
def test_exact_sweeps_give_the_arm_wherever_the_other_joints_stand(name, poses, seed, half):
    true = ARMS[name]
    held = np.random.default_rng(seed).uniform(-0.5, 0.5, true.dof)
    found = from_circles(sweep_all(true, held, half=half, poses=poses))
    # a circle of radius r and half an arc h shows its centre by r h^2 / 2 of each point, and its
    # direction by as much: so many times the rounding of 16 u at lengths of the reach, once a joint
    seen = [1.0 if poses else max(axis.radius, half * 0.3) for axis in found.axes]
    bound = 16 * 2.0**-53 * true.reach * sum(2.0 / (r * min(half, 1.0) ** 2) for r in seen)
    assert np.abs(found.chain.screws - true.screws).max() <= bound
    assert np.abs(found.chain.home[:3, 3] - true.home[:3, 3]).max() <= bound
    assert found.warnings == ()
    if poses:
        assert np.abs(found.chain.home - true.home).max() <= bound


def test_readings_tell_the_direction_and_nothing_else_of_their_own_joint():
    """By 3 % too large, and not even: where the axis is stays the same, and its sign does."""
    exact = sweep_all(UR5, np.zeros(6))
    wrong = []
    for sweep in exact:
        q = sweep.q * 1.03
        q[:, sweep.joint] += 0.01 * np.sin(3 * q[:, sweep.joint])
        wrong.append(JointSweep(sweep.joint, q, sweep.measured))
    with pytest.warns(pk.PoekinWarning, match=r"readings with errors of their own"):
        found = from_circles(wrong)
    np.testing.assert_allclose(found.chain.screws, UR5.screws, rtol=0, atol=1e-11)
    back = [JointSweep(s.joint, -s.q, s.measured) for s in exact]
    np.testing.assert_allclose(from_circles(back).chain.screws, -UR5.screws, rtol=0, atol=1e-11)
    assert found.axes[1].arc == pytest.approx(2.0, abs=1e-11)


NOISY = {
    "an arc of points": (UR5, 1, False),
    "an arc of poses": (UR5, 4, True),
    "a line": (SCARA, 2, False),
}


@pytest.mark.parametrize("what", NOISY)
def test_a_noisy_axis_is_within_its_deviations(what):
    true, joint, poses = NOISY[what]
    kind = "prismatic" if true.kinds[joint] == "prismatic" else "revolute"
    q = swept(true, joint, HELD[: true.dof], count=24)
    T = true.fk(q)
    exact = fit_axis(JointSweep(joint, q, T if poses else T[:, :3, 3], kind)).screw
    rng = np.random.default_rng(5)
    inside = []
    for _ in range(40):
        found = fit_axis(JointSweep(joint, q, noisy(T, NOISE, rng, poses), kind))
        deviations = np.sqrt(np.diag(found.covariance))
        seen = deviations > 1e-12  # not the zeros of a joint that slides
        inside.append(np.abs(found.screw - exact)[seen] <= 1.96 * deviations[seen])
    # 40 runs of at least two independent numbers: 0.95 within three deviations of 0.218 / sqrt(80)
    assert np.mean(inside) >= 0.877
    assert np.mean(inside) < 0.998


def test_the_covariance_of_all_axes_is_that_of_the_measured_ones_carried_to_zero():
    rng = np.random.default_rng(1)
    fits = from_circles(sweep_all(UR5, HELD, noise=NOISE, rng=rng)).axes
    held = rng.uniform(-1, 1, (6, 6))
    fits = [fit._replace(covariance=motions(fit.screw)) for fit in fits]
    h = 1e-6
    columns = []
    for i in range(6):
        for k in range(6):
            ends = []
            for sign in (1, -1):
                moved = list(fits)
                # along the axis's own motions, as screws stay unit screws
                change = np.eye(6) + sign * h * pk.se3.ad(np.eye(6)[k])
                moved[i] = fits[i]._replace(screw=change @ fits[i].screw)
                ends.append(at_zero(moved, held)[0].ravel())
            columns.append((ends[0] - ends[1]) / (2 * h))
    J = np.array(columns).T
    _, covariance = at_zero(fits, held)
    # truncation h^2 and rounding u / h, times lengths of 3 m and the square of the derivatives
    np.testing.assert_allclose(covariance, J @ J.T, rtol=0, atol=1e-6)


def motions(screw):
    """Covariance of a screw that moves by a unit twist in each direction."""
    S = np.array([pk.se3.ad(np.eye(6)[k]) @ screw for k in range(6)]).T
    return S @ S.T


def test_calibrate_ends_at_the_same_fit_as_from_the_nominal_arm():
    true = in_error()
    rng = np.random.default_rng(4)
    found = from_circles(sweep_all(true, HELD, noise=NOISE, rng=rng))
    q = pk.load("ur5").chain().random(rng, 60)
    p = true.fk(q)[:, :3, 3] + NOISE * rng.normal(size=(60, 3))
    mine = calibrate(found.chain, q, p, folds=0)
    nominal = pk.load("ur5").chain().retooled(TOOL)
    other = calibrate(nominal, q, Points(p, frame="unknown"), folds=0)
    assert mine.success
    assert other.success
    fresh = nominal.random(rng, 100)
    X = other.frames["T_base_device"]
    theirs = (se3.inverse(X) @ other.chain.fk(fresh))[:, :3, 3]
    # where a search ends, a step would gain 1e-10 of the cost: 1e-5 deviations of the noise
    np.testing.assert_allclose(mine.chain.fk(fresh)[:, :3, 3], theirs, rtol=0, atol=1e-5 * NOISE)


def in_error():
    truth = pk.calibration.simulated(pk.load("ur5").chain(), 1, seed=3).truth
    return truth.retooled(TOOL).rebased(DEVICE)


def test_the_summary_says_how_well_each_axis_is_known():
    sweeps = sweep_all(SCARA, HELD[:4], noise=NOISE)
    found = from_circles(sweeps, joint_names=["turn", "elbow", "lift", "roll"])
    lines = str(found).splitlines()
    assert lines[0] == "4 axes from sweeps of one joint each"
    turn = found.axes[0]
    assert lines[1] == (
        f"turn: direction ± {1e3 * turn.tilt:.2g} mrad, place ± {1e3 * turn.shift:.2g} mm; "
        f"residual {1e3 * turn.rms:.2g} mm rms"
    )
    assert lines[3].startswith("lift: direction ± ")
    assert "place" not in lines[3]
    # two of three coordinates are from the circle, the third is along it
    rms = [axis.rms for axis in found.axes]
    np.testing.assert_allclose(rms, np.sqrt(2) * NOISE, rtol=0.5)
    assert found.chain.base == "device"
    axes: Any = found.to_dict()["axes"]
    assert axes[2]["radius"] == 0.0


def test_a_sweep_of_another_point_is_named():
    sweeps = sweep_all(UR5, HELD)
    q = swept(UR5, 2, HELD)
    sweeps[2] = JointSweep(2, q, UR5.fk(q)[:, :3] @ [0.01, 0.0, 0.0, 1.0])
    words = (
        "sweep of joint 2: its point is 10 mm from that of the others: another point of the tool, "
        "or readings with errors of their own (gain, gears, coupled joints)"
    )
    with pytest.warns(pk.PoekinWarning) as caught:
        found = from_circles(sweeps)
    assert [str(one.message) for one in caught] == [words]
    assert found.warnings == (words,)
    assert str(found).endswith(words)


@pytest.mark.parametrize(("name", "poses"), EVERY)
def test_a_sweep_of_a_point_a_millimetre_away_is_named_and_noise_is_not(name, poses):
    """Noise of 0.05 mm and 0.05 mrad: the axes tell the point within 0.1 mm."""
    true = ARMS[name]
    joint = 1
    held = HELD[: true.dof]
    rng = np.random.default_rng(7)
    sweeps = sweep_all(true, held, noise=5e-5, rng=rng, poses=poses, count=20)
    assert from_circles(sweeps).warnings == ()
    moved = true.retooled(pk.se3.pose(np.eye(3), [0.0, 6e-4, 8e-4]))
    q = sweeps[joint].q
    measured = noisy(moved.fk(q), 5e-5, rng, poses)
    sweeps[joint] = JointSweep(joint, q, measured)
    with pytest.warns(pk.PoekinWarning, match=r"its point is") as caught:
        from_circles(sweeps)
    (words,) = (str(one.message) for one in caught)
    found = re.fullmatch(
        r"sweep of joint 1: its point is (\S+) mm from that of the others: .*", words
    )
    assert found
    assert float(found[1]) == pytest.approx(1.0, abs=0.3)


def test_where_the_other_joints_stand_elsewhere_uncertain_axes_are_no_fault_of_a_sweep():
    """Then each axis moves the points of the sweeps apart, by more than the noise of one."""
    rng = np.random.default_rng(11)
    for _ in range(10):
        sweeps = []
        for joint in range(UR5.dof):
            q = swept(UR5, joint, rng.uniform(-1.5, 1.5, UR5.dof), half=0.5)
            sweeps.append(JointSweep(joint, q, noisy(UR5.fk(q), 2e-5, rng, False)))
        assert from_circles(sweeps).warnings == ()
