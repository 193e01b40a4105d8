"""The fastest trajectory: within its limits between its points, too, and hardly any is faster."""

from __future__ import annotations

import itertools
import re
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline, CubicSpline

import poekin as pk
from poekin.errors import InputError, ShapeError, UnknownName
from poekin.solve import motion
from poekin.solve.motion.parameterization import time_optimal
from poekin.solve.motion.parameterization.time_optimal import LARGEST
from tests.solve.motion.dense_optimum import shortest_time

RNG = np.random.default_rng(3)
SPEED = RNG.uniform(1.5, 3.2, 6)
ACCELERATION = RNG.uniform(3, 15, 6)


@pytest.fixture(scope="module")
def arm():
    return pk.load("ur5").chain()


def along(corners: np.ndarray, count: int) -> np.ndarray:
    parts = [np.linspace(a, b, count, endpoint=False) for a, b in itertools.pairwise(corners)]
    return np.vstack([*parts, corners[-1:]])


def tool_path() -> np.ndarray:
    """Joints of a UR5 along a line of the tool and back, a sharp corner between."""
    arm = pk.load("ur5").chain()
    q0 = [0.0, -1.2, 1.5, -1.8, -1.5, 0.0]
    T_s0 = arm.fk(q0)
    T_s1 = T_s0.copy()
    T_s1[:2, 3] += 0.2, 0.2
    there = motion.line(T_s0, T_s1, np.linspace(0, 1, 60))
    T_s2 = T_s1.copy()
    T_s2[2, 3] -= 0.15
    down = motion.line(T_s1, T_s2, np.linspace(0, 1, 40))
    path = pk.follow(arm, np.concatenate([there, down[1:]]), q0=q0)
    assert path.ok
    return path.q


TURN = np.linspace(0, 2 * np.pi, 120)[:, None]
PATHS = {
    "knots": RNG.uniform(-2, 2, (8, 6)),
    "polyline": along(RNG.uniform(-2, 2, (5, 6)), 40),
    "circle": np.sin(TURN + np.arange(6)),
    "there and back": np.array([np.zeros(6), np.ones(6), np.zeros(6)]),
    "lines of the tool": tool_path(),
}


@pytest.fixture(scope="module", params=PATHS)
def found(request, arm):
    q = PATHS[request.param]
    return q, motion.time_optimal(arm, q, speed=SPEED, acceleration=ACCELERATION)


def test_no_limit_is_exceeded_as_a_controller_interpolates(found):
    _, trajectory = found
    cubic = CubicHermiteSpline(trajectory.times, trajectory.q, trajectory.dq)
    steps = np.diff(trajectory.times)
    for part in np.linspace(0, 1, 21):  # the ends are those of the steps' own cubics
        t = trajectory.times[:-1] + np.clip(part, 1e-7, 1 - 1e-7) * steps
        # an ulp of t, 2e-16, is 1e-11 of a step of 20 us
        assert (np.abs(cubic(t, 1)) <= SPEED * (1 + 1e-9)).all()
        assert (np.abs(cubic(t, 2)) <= ACCELERATION * (1 + 1e-9)).all()


def test_the_duration_is_at_most_two_percent_longer_than_the_shortest(found):
    q, trajectory = found
    h = np.linalg.norm(np.diff(q, axis=0), axis=1)
    knots = np.append(0, np.cumsum(h))
    s = np.unique(np.append(knots, np.linspace(0, knots[-1], 2001)))
    best = shortest_time(CubicSpline(knots, q), SPEED, ACCELERATION, s)
    assert 0.99 * best <= trajectory.duration <= 1.02 * best


def test_the_points_are_passed_in_order_at_their_rows(found):
    q, trajectory = found
    assert (np.diff(trajectory.waypoints) > 0).all()
    # times are rounded to 1 ns: 0.5e-9 s at 3.2 rad/s
    np.testing.assert_allclose(trajectory.q[trajectory.waypoints], q, rtol=0, atol=2e-9)
    np.testing.assert_array_equal(trajectory.q[[0, -1]], q[[0, -1]])


def test_it_rests_at_both_ends_exactly_and_times_are_whole_nanoseconds(found):
    _, trajectory = found
    np.testing.assert_array_equal(trajectory.dq[[0, -1]], np.zeros((2, 6)))
    assert not np.signbit(trajectory.dq[[0, -1]]).any()
    assert trajectory.times[0] == 0
    nanoseconds = trajectory.times * 1e9
    np.testing.assert_allclose(nanoseconds, np.round(nanoseconds), rtol=0, atol=1e-5)
    assert (np.diff(np.round(nanoseconds)) >= 1).all()


def test_between_its_points_it_is_on_the_spline_through_them(found):
    q, trajectory = found
    h = np.linalg.norm(np.diff(q, axis=0), axis=1)
    spline = CubicSpline(np.append(0, np.cumsum(h)), q)
    fine = spline(np.linspace(0, h.sum(), 200_001))
    for row in trajectory.q[::97]:
        # half a step of the fine points, 1e-4 rad, off at most, along the path
        assert np.linalg.norm(fine - row, axis=1).min() < 1e-4


def test_the_limits_are_used_up(found):
    _, trajectory = found
    speed = trajectory.largest_speed / SPEED
    acceleration = trajectory.largest_acceleration / ACCELERATION
    # rounded to 1 ns, a step of 0.5 ms changes its acceleration by less than 1 part in 10 000
    assert 0.9999 < max(speed.max() ** 2, acceleration.max()) <= 1


@pytest.mark.parametrize("acceleration, expected", [(4.0, 1 / 2 + 2 / 4), (1.0, 2.0)])
def test_a_straight_line_takes_the_bang_bang_time(arm, acceleration, expected):
    q = np.zeros((2, 6))
    q[1, :2] = 1.0, -0.5
    found = motion.time_optimal(arm, q, speed=2.0, acceleration=acceleration)
    # a switch within a step of 1000
    assert expected <= found.duration <= expected * 1.002


def test_the_way_back_takes_as_long_and_a_faster_clock_divides_the_time(arm):
    q = PATHS["knots"]
    once = motion.time_optimal(arm, q, speed=SPEED, acceleration=ACCELERATION).duration
    back = motion.time_optimal(arm, q[::-1], speed=SPEED, acceleration=ACCELERATION).duration
    assert back == pytest.approx(once, rel=5e-3)  # limits at the other ends of the steps
    slow = motion.time_optimal(arm, q, speed=0.1 * SPEED, acceleration=0.01 * ACCELERATION)
    assert slow.duration == pytest.approx(10 * once, rel=1e-6)  # rounding to nanoseconds


@pytest.mark.parametrize("count", [2, 50, 400])
def test_a_grid_has_the_knots_and_a_thousand_points_evenly_between_them(count):
    lengths = np.random.default_rng(count).uniform(0.1, 1, count - 1)
    knots = np.append(0.0, np.cumsum(lengths))
    s = time_optimal._grid(knots)
    assert np.isin(knots, s).all()
    assert np.diff(s).max() <= knots[-1] / time_optimal.STEPS * (1 + 1e-12)
    assert len(s) <= time_optimal.STEPS + count


def test_what_exceeds_a_limit_by_one_rounding_is_slowed_down(monkeypatch):
    tried = []

    def excess(motion, limits):
        tried.append(motion.times[-1])
        assert len(tried) < 5
        return np.array([np.nextafter(1.0, 2.0) if tried[-1] <= 1.0 else 1.0])

    even = np.array([0.0, 0.5, 1.0])
    monkeypatch.setattr(time_optimal, "_fastest", lambda spline, limits: (even, np.ones(3)))
    monkeypatch.setattr(
        time_optimal, "_timed", lambda spline, s, times, rate: SimpleNamespace(times=times)
    )
    monkeypatch.setattr(time_optimal, "_excess", excess)
    nothing: Any = None
    assert time_optimal._within_limits(nothing, nothing).times[-1] == pytest.approx(1, abs=1e-11)


def test_points_that_repeat_change_nothing(arm):
    q = PATHS["knots"]
    once = motion.time_optimal(arm, q, speed=SPEED, acceleration=ACCELERATION)
    twice = motion.time_optimal(
        arm, np.repeat(q, 2, axis=0), speed=SPEED, acceleration=ACCELERATION
    )
    np.testing.assert_array_equal(twice.q, once.q)
    np.testing.assert_array_equal(twice.times, once.times)
    np.testing.assert_array_equal(twice.waypoints, np.repeat(once.waypoints, 2))


def test_the_last_of_some_points_that_are_all_but_the_same_is_the_end(arm):
    q = np.zeros((3, 6))
    q[1, 0] = 1.0
    q[2, 0] = 1.0 + 1e-9
    found = motion.time_optimal(arm, q, speed=1.0, acceleration=1.0)
    assert found.q[-1, 0] == 1.0 + 1e-9


def test_the_arm_s_own_limits_of_speed_count_where_none_are_given():
    panda = pk.load("panda").chain(tip="panda_hand")
    q = np.array([np.zeros(7), np.ones(7)])
    own = motion.time_optimal(panda, q, acceleration=5.0)
    np.testing.assert_array_equal(own.speed, panda.velocity_limits)
    slower = motion.time_optimal(panda, q, acceleration=5.0, speed={"panda_joint3": 0.5})
    expected = panda.velocity_limits.copy()
    expected[2] = 0.5
    np.testing.assert_array_equal(slower.speed, expected)
    assert slower.largest_speed[2] == pytest.approx(0.5, rel=1e-3)
    compiled = motion.time_optimal(panda.compile(), q, acceleration=5.0)
    assert compiled.duration == own.duration


SAID = {
    "Fanuc": "J3 = J2 + J3",
    "differential wrist": ["J5 = 1/2 J5 + 1/2 J6", "J6 = 1/2 J5 - 1/2 J6"],
}


@pytest.mark.parametrize("path", ["knots", "polyline", "circle"])
@pytest.mark.parametrize("said", SAID)
def test_a_joint_of_several_readings_is_as_fast_as_its_own_limit_and_no_faster(arm, said, path):
    own = arm.replace(velocity_limits=SPEED)
    chain = own.coupled(SAID[said])
    q = PATHS[path]
    found = motion.time_optimal(chain, q, acceleration=ACCELERATION)
    cubic = CubicHermiteSpline(found.times, found.q, found.dq)
    fine = cubic(np.linspace(0, found.duration, 20_001), 1)
    assert (np.abs(fine @ chain.coupling.T) <= SPEED * (1 + 1e-9)).all()
    assert (np.abs(fine) <= chain.velocity_limits * (1 + 1e-9)).all()
    assert (found.largest_acceleration <= ACCELERATION).all()
    values = np.hstack([q, q @ chain.coupling.T])
    knots = np.append(0, np.cumsum(np.linalg.norm(np.diff(q, axis=0), axis=1)))
    s = np.unique(np.append(knots, np.linspace(0, knots[-1], 2001)))
    best = shortest_time(
        CubicSpline(knots, values),
        np.append(np.full(6, 1e9), SPEED),  # the joints' own alone
        np.append(ACCELERATION, np.full(6, 1e9)),
        s,
    )
    assert 0.99 * best <= found.duration <= 1.02 * best


def test_a_joint_s_own_limit_of_speed_counts_unless_all_its_readings_are_given(arm):
    chain = arm.replace(velocity_limits=np.ones(6)).coupled("J3 = J2 + J3")
    names = chain.q_names
    q = np.zeros((2, 6))
    q[1, 1:3] = 10.0  # joint 3 turns by 20 rad

    def duration(speed):
        return motion.time_optimal(chain, q, acceleration=1e4, speed=speed).duration

    assert duration(None) == pytest.approx(20.0, rel=3e-3)  # two steps of 1000
    q[1, 2] = 0.0  # joints 2 and 3 turn by 10 rad
    assert duration(None) == pytest.approx(10.0, rel=3e-3)  # two steps of 1000
    q[1, 2] = 10.0
    assert duration({names[1]: 1.0}) == pytest.approx(20.0, rel=3e-3)  # two steps of 1000
    assert duration({names[1]: 1.0, names[2]: 1.0}) == pytest.approx(
        10.0, rel=3e-3
    )  # two steps of 1000
    assert duration(1.0) == pytest.approx(10.0, rel=3e-3)  # two steps of 1000


def test_a_speed_of_infinity_is_no_limit(arm):
    q = np.array([np.zeros(6), np.ones(6)])
    found = motion.time_optimal(arm, q, speed=np.inf, acceleration=4.0)
    assert found.duration == pytest.approx(1.0, rel=2e-3)  # 2 sqrt(1 / 4)


def test_a_joint_s_own_limit_of_speed_that_is_no_robot_s_is_refused():
    arm = pk.load("puma560").chain().replace(velocity_limits=np.ones(6))
    joint_speeds = np.full(6, np.inf)
    joint_speeds[2] = 1e-300
    chain = arm.coupled("J3 = J2 + J3").replace(joint_velocity_limits=joint_speeds)
    q = np.array([np.zeros(6), np.ones(6)])
    with pytest.raises(InputError, match="speed: expected numbers from 1e-09 to 1e"):
        motion.time_optimal(chain, q, acceleration=1.0)


ONES = np.array([np.zeros(6), np.ones(6)])
BAD = {
    "no limit of speed": (
        (ONES, {"acceleration": 1.0}),
        "speed: the model states no limit for 'shoulder_pan_joint', 'shoulder_lift_joint', "
        "'elbow_joint', 'wrist_1_joint', 'wrist_2_joint', 'wrist_3_joint'; give one for each",
    ),
    "some limits of speed": (
        (ONES, {"acceleration": 1.0, "speed": dict.fromkeys(
            ["shoulder_pan_joint", "elbow_joint", "wrist_1_joint", "wrist_2_joint", "wrist_3_joint"], 1.0)}),
        "speed: the model states no limit for 'shoulder_lift_joint'; give one for each",
    ),
    "acceleration 0": ((ONES, {"speed": 1.0, "acceleration": 0.0}), "acceleration: expected positive numbers"),
    "acceleration infinite": (
        (ONES, {"speed": 1.0, "acceleration": np.inf}), "acceleration: expected numbers from 1e-09 to 1e+09, got [inf"
    ),
    "acceleration tiny": (
        (ONES, {"speed": 1.0, "acceleration": 1e-10}), "acceleration: expected numbers from 1e-09 to 1e+09, got [1e-10"
    ),
    "speed huge": ((ONES, {"speed": 1e10, "acceleration": 1.0}), "speed: expected numbers from 1e-09 to 1e+09"),
    "one point": ((ONES[:1], {"speed": 1.0, "acceleration": 1.0}), "q: expected shape (N, 6), N >= 2, got (1, 6)"),
    "width": ((ONES[:, :5], {"speed": 1.0, "acceleration": 1.0}), "q: expected shape (N, 6), N >= 2, got (2, 5)"),
    "axes": ((ONES[0], {"speed": 1.0, "acceleration": 1.0}), "q: expected shape (N, 6), N >= 2, got (6,)"),
    "NaN": ((ONES * np.nan, {"speed": 1.0, "acceleration": 1.0}), "q: expected numbers up to 1e+09, got [nan"),
    "huge": ((ONES * 1e10, {"speed": 1.0, "acceleration": 1.0}), "in q[1]"),
    "nothing moves": (
        (ONES[[1, 1]], {"speed": 1.0, "acceleration": 1.0}),
        "q: expected points that are not all the same: nothing moves",
    ),
    "too fast": (
        (1e-9 * ONES, {"speed": 1e9, "acceleration": 1e9}),
        "time_optimal: the limits are so large that points are less than a nanosecond apart",
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", BAD)
def test_what_has_no_fastest_trajectory_is_refused(arm, case):
    (q, limits), says = BAD[case]
    kind = ShapeError if "shape" in says else InputError
    with pytest.raises(kind, match=re.escape(says)):
        motion.time_optimal(arm, q, **limits)


def test_a_coordinate_that_the_arm_has_not_is_refused(arm):
    with pytest.raises(UnknownName, match="speed: no coordinate 'elbow'"):
        motion.time_optimal(arm, ONES, acceleration=1.0, speed={"elbow": 1.0})


def test_limits_up_to_the_largest_are_taken():
    joint = pk.Chain.from_space([pk.screw.revolute([0, 0, 1], [0, 0, 0])], np.eye(4))
    q = [[0.0], [1e6]]
    found = motion.time_optimal(joint, q, speed=LARGEST, acceleration=LARGEST)
    assert found.duration == pytest.approx(2 * np.sqrt(1e6 / LARGEST), rel=2e-3)
    slow = motion.time_optimal(joint, [[0.0], [1.0]], speed=1 / LARGEST, acceleration=1.0)
    assert slow.duration == pytest.approx(LARGEST, rel=3e-3)  # two steps of 1000
