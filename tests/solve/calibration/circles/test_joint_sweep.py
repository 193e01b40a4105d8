"""Sweeps that do not show an axis are refused, with what would."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError, PoseError, ShapeError
from poekin.groups import se3
from poekin.solve.calibration import JointSweep, from_circles
from poekin.solve.calibration.circles.axis_fit import fit_axis
from tests.messages import says
from tests.solve.calibration.circles.sweeps import SCARA, UR5, noisy, sweep_all, swept

HELD = np.array([0.0, -1.0, 1.0, 0.3, 0.2, 0.1])
Q = swept(UR5, 2, HELD, count=9)
T = UR5.fk(Q)
P = T[:, :3, 3]
WRONG: Any = "fixed"


def also(joint, by):
    q = Q.copy()
    q[3, joint] += by
    return q


def nan():
    p = P.copy()
    p[3, 1] = np.nan
    return p


BAD = {
    "no joint": (lambda: JointSweep(-1, Q, P), InputError, "joint: expected a whole number from 0 on, got -1"),
    "another kind": (
        lambda: JointSweep(2, Q, P, WRONG), InputError,
        "kind: expected 'revolute' or 'prismatic', got 'fixed'",
    ),
    "a joint that is not there": (
        lambda: JointSweep(6, Q, P), ShapeError,
        "sweep of joint 6: q: expected readings (N, n) of more than 6 joints, got shape (9, 6)",
    ),
    "one row": (
        lambda: JointSweep(2, Q[0], P), ShapeError,
        "sweep of joint 2: q: expected readings (N, n) of more than 2 joints, got shape (6,)",
    ),
    "NaN": (
        lambda: JointSweep(2, Q, nan()), InputError,
        "sweep of joint 2: measured[3, 1]: expected a finite number, got nan",
    ),
    "no pose": (
        lambda: JointSweep(2, Q, 2 * T), PoseError,
        "sweep of joint 2: measured[0] is no pose: its last row is [0.0, 0.0, 0.0, 2.0], expected [0, 0, 0, 1]",
    ),
    "fewer points": (
        lambda: JointSweep(2, Q, P[:5]), ShapeError,
        "sweep of joint 2: measured: expected points (9, 3) or poses (9, 4, 4), one a row of q, got shape (5, 3)",
    ),
    "three points": (
        lambda: JointSweep(2, Q[:3], P[:3]), InputError,
        "sweep of joint 2: expected 4 readings or more, got 3",
    ),
    "two poses": (
        lambda: JointSweep(2, Q[:2], T[:2]), InputError,
        "sweep of joint 2: expected 3 readings or more, got 2",
    ),
    "two points of a line": (
        lambda: JointSweep(2, Q[:2], P[:2], "prismatic"), InputError,
        "sweep of joint 2: expected 3 readings or more, got 2",
    ),
    "a joint that stood": (
        lambda: JointSweep(3, Q, P), InputError,
        "sweep of joint 3: its readings stay within 0, it did not move",
    ),
    "another joint moved": (
        lambda: JointSweep(2, also(4, 0.01), P), InputError,
        (
            "sweep of joint 2: joint 4 moved, too, by 0.01 (rad or m); expected all others to stand "
            "within 0.0001"
        ),
    ),
    "two others moved": (
        lambda: JointSweep(2, also(4, 0.01) + also(1, 0.02) - Q, P), InputError,
        (
            "sweep of joint 2: joint 1 moved, too, by 0.02 (rad or m); expected all others to stand "
            "within 0.0001"
        ),
    ),
    "degrees": (
        lambda: JointSweep(2, np.rad2deg(Q) * [0, 0, 1, 0, 0, 0], P), InputError,
        "sweep of joint 2: its readings span 115 rad: are they in degrees?",
    ),
}  # fmt: skip


@pytest.mark.parametrize("what", BAD)
def test_a_bad_sweep_is_refused_and_said_where(what):
    make, error, message = BAD[what]
    with pytest.raises(error) as caught:
        make()
    assert says(caught.value, message)


def test_a_jittering_joint_stands():
    assert len(JointSweep(2, also(4, 9e-5), P).readings) == 9
    with pytest.raises(ValueError, match="read-only"):
        JointSweep(2, Q, P).q[0] = 0


SWEEPS = sweep_all(UR5, HELD)
SETS = {
    "none": ([], "sweeps: expected a JointSweep of each joint, got []"),
    "one": (SWEEPS[0], "sweeps: expected a JointSweep of each joint, got ..."),
    "arrays": ([P], "sweeps: expected JointSweep objects, got ..."),
    "a joint without": (SWEEPS[1:], "sweeps: expected one of each of 6 joints, got those of [1, 2, 3, 4, 5]"),
    "a joint twice": (
        [*SWEEPS, SWEEPS[2]],
        "sweeps: expected one of each of 6 joints, got those of [0, 1, 2, 3, 4, 5, 2]",
    ),
    "points and poses": (
        [*SWEEPS[:2], JointSweep(2, Q, T), *SWEEPS[3:]],
        "sweeps: expected readings of as many joints in all, and points in all or poses in all",
    ),
    "arms of two sizes": (
        [*SWEEPS, sweep_all(SCARA, HELD[:4])[0]],
        "sweeps: expected readings of as many joints in all, and points in all or poses in all",
    ),
}  # fmt: skip


@pytest.mark.parametrize("what", SETS)
def test_sets_of_sweeps_that_make_no_arm_are_refused(what):
    sweeps, message = SETS[what]
    with pytest.raises(InputError) as caught:
        from_circles(sweeps)
    assert says(caught.value, message)


def arc(half: float, *, poses: bool = False, seed: int = 0) -> JointSweep:
    q = swept(UR5, 1, HELD, half, 24)
    rng = np.random.default_rng(seed)
    return JointSweep(1, q, noisy(UR5.fk(q), 1e-4 if not poses else 1e-3, rng, poses))


SHORT = re.compile(
    r"^sweep of joint 1: an arc of (\S+)° leaves the axis known to (\S+) rad and (\S+) mm "
    r"\(one standard deviation\), expected 0\.02 rad or less; with as many readings an arc of (\S+)° would do$"
)


def test_an_arc_that_is_too_short_is_refused_and_the_one_that_is_named_would_do():
    with pytest.raises(InputError) as caught:
        fit_axis(arc(0.03))
    said = SHORT.match(str(caught.value))
    assert said is not None, str(caught.value)
    degrees, tilt, shift, needed = map(float, said.groups())
    assert degrees == pytest.approx(np.rad2deg(0.06), rel=0.01)
    # the noise is known from 63 numbers, to 9 %
    found = fit_axis(arc(np.deg2rad(1.2 * needed) / 2))
    assert found.tilt < 0.02
    with pytest.raises(InputError, match="an arc of"):
        fit_axis(arc(np.deg2rad(needed / 1.3) / 2))
    # of an arc so short the direction is known as well as the centre, in radii
    assert shift == pytest.approx(1e3 * tilt * found.radius, rel=0.3)


def test_of_poses_and_of_a_line_a_shorter_motion_is_enough_and_the_one_that_is_named_would_do():
    with pytest.raises(InputError) as caught:
        fit_axis(arc(0.01, poses=True))
    said = SHORT.match(str(caught.value))
    assert said is not None, str(caught.value)
    needed = np.deg2rad(float(said[4]))
    # the noise is known from some 100 numbers, to 7 %
    assert 0.01 < fit_axis(arc(1.2 * needed / 2, poses=True)).tilt < 0.02
    with pytest.raises(
        InputError,
        match=r"^sweep of joint 2: a stroke of 4 mm leaves the axis known to (\S+) rad \(one standard "
        r"deviation\), expected 0\.02 rad or less; with as many readings a stroke of (\S+) mm would do$",
    ) as caught:
        fit_axis(stroke(0.002))
    needed = 1e-3 * float(str(caught.value).split()[-4])
    assert 0.01 < fit_axis(stroke(1.2 * needed / 2)).tilt < 0.02


def stroke(half: float) -> JointSweep:
    q = swept(SCARA, 2, HELD[:4], 3 * half, 24)
    p = noisy(SCARA.fk(q), 1e-4, np.random.default_rng(0), False)
    return JointSweep(2, q, p, "prismatic")


def test_few_noisy_readings_near_the_axis_no_arc_would_mend():
    q = swept(UR5, 5, HELD, 3.0, 5)
    near = UR5.retooled(se3.pose(np.eye(3), [-0.097, -0.05, 0.0]))
    p = noisy(near.fk(q), 1e-4, np.random.default_rng(0), False)
    with pytest.raises(
        InputError, match=r"no arc would do: measure farther from the axis, or more"
    ):
        fit_axis(JointSweep(5, q, p))


def test_a_point_on_the_axis_is_said_to_be_there_but_poses_on_it_are_no_fault():
    q = swept(UR5, 5, HELD)
    # joint 6 turns about the tip's own z axis
    tip = pk.load("ur5").chain()
    message = (
        "sweep of joint 5: the point moves by {} mm and scatters by {} mm about what the readings "
        "say: it is on the axis (fix it farther away), or these are not this joint's readings, in "
        "rad or m"
    )
    for noise in (0.0, 1e-4):
        T = tip.fk(q)
        p = noisy(T, noise, np.random.default_rng(0), False)
        with pytest.raises(InputError, match=re.escape(message).replace(r"\{\}", r"\S+")):
            fit_axis(JointSweep(5, q, p))
    found = fit_axis(JointSweep(5, q, tip.fk(q)))
    assert found.radius < 1e-12
    np.testing.assert_allclose(found.screw[:3], T[0, :3, 2], rtol=0, atol=1e-12)


def test_readings_of_another_motion_are_refused():
    q = swept(UR5, 2, HELD, 0.5)
    wider = swept(UR5, 2, HELD, 0.6)
    with pytest.raises(
        InputError,
        match=r"^sweep of joint 2: the measured motion is 1\.2 times that of the readings: are they "
        r"those of this joint, in rad or m, and is it the kind of joint that it is said to be\?$",
    ):
        fit_axis(JointSweep(2, q, UR5.fk(wider)[:, :3, 3]))
    with pytest.raises(InputError, match=r"^sweep of joint 2: the point moves by"):
        fit_axis(JointSweep(2, q, UR5.fk(wider)[np.random.default_rng(0).permutation(16), :3, 3]))
