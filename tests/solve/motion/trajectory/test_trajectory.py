"""A trajectory: its values at any time, its report, and its files read back."""

from __future__ import annotations

import json
import re

import numpy as np
import pytest
import yaml
from scipy.interpolate import CubicHermiteSpline

import poekin as pk
from poekin.errors import FileError, InputError, ModelError
from poekin.solve import motion

Q = np.array([[0, -1, 1, 0, 1, 0], [0.5, -1.2, 1.3, 0, 1, 0], [1, -1, 1, 0, 1, 0.2]])


@pytest.fixture(scope="module")
def arm():
    return pk.load("ur5").chain()


@pytest.fixture(scope="module")
def trajectory(arm):
    return motion.time_optimal(arm, Q, speed=2.0, acceleration=4.0)


def test_between_the_points_it_is_the_cubic_of_the_time(trajectory):
    expected = CubicHermiteSpline(trajectory.times, trajectory.q, trajectory.dq)
    t = np.linspace(0, trajectory.duration, 999).reshape(3, 333)[:, 1:-1]
    q, dq, ddq = trajectory(t)
    np.testing.assert_allclose(q, expected(t), rtol=0, atol=1e-14)
    # steps of 1 ms: roundings of 1e-16 by h and h²
    np.testing.assert_allclose(dq, expected(t, 1), rtol=0, atol=1e-11)
    np.testing.assert_allclose(ddq, expected(t, 2), rtol=0, atol=1e-7)


def test_its_accelerations_at_both_ends_are_those_of_the_first_step_and_the_last(trajectory):
    spline = CubicHermiteSpline(trajectory.times, trajectory.q, trajectory.dq)
    ends = np.array([0.0, trajectory.duration])
    expected = spline(ends, 2)
    assert np.abs(expected).max(axis=1).min() > 0.1
    np.testing.assert_allclose(trajectory(ends).ddq, expected, rtol=1e-6)


def test_before_and_after_it_rests_and_nan_stays_nan(trajectory):
    q, dq, ddq = trajectory([-1.0, trajectory.duration + 1, np.nan])
    np.testing.assert_array_equal(q[:2], Q[[0, -1]])
    np.testing.assert_array_equal([dq[:2], ddq[:2]], np.zeros((2, 2, 6)))
    assert np.isnan(np.stack([q[2], dq[2], ddq[2]])).all()
    assert trajectory(0.5).q.shape == (6,)
    with pytest.raises(InputError, match="t: expected"):
        trajectory("soon")


def test_csv_is_read_back_with_its_times_and_without_its_rates(trajectory, arm, tmp_path):
    trajectory.write(tmp_path / "t.csv")
    q, times = motion.read_joints(tmp_path / "t.csv", arm)
    np.testing.assert_array_equal(q, trajectory.q)
    np.testing.assert_array_equal(times, trajectory.times)
    header, *lines = (tmp_path / "t.csv").read_text().splitlines()
    assert header.split(",")[7:] == [f"{name}_velocity" for name in arm.q_names]
    rates = np.array([line.split(",")[7:] for line in lines], float)
    np.testing.assert_array_equal(rates, trajectory.dq)


def test_the_columns_of_rates_have_names_of_their_own():
    assert motion.csv_io.velocity_columns(["a", "a_velocity"]) == (
        "a_velocity_",
        "a_velocity_velocity",
    )
    taken = ["a_velocity_", "a", "a_velocity"]
    assert motion.csv_io.velocity_columns(taken)[1] == "a_velocity__"


@pytest.mark.parametrize("suffix", ["yaml", "yml", "json", "JSON"])
def test_a_message_of_ros_has_every_point(trajectory, arm, suffix, tmp_path):
    trajectory.write(tmp_path / f"t.{suffix}")
    text = (tmp_path / f"t.{suffix}").read_text()
    read = json.loads if suffix.lower() == "json" else yaml.safe_load
    message = read(text)
    assert message["joint_names"] == list(arm.q_names)
    points = message["points"]
    assert [p["positions"] for p in points] == trajectory.q.tolist()
    assert [p["velocities"] for p in points] == trajectory.dq.tolist()
    assert points[-1]["velocities"] == [0.0] * 6
    stamps = [p["time_from_start"]["sec"] + 1e-9 * p["time_from_start"]["nanosec"] for p in points]
    np.testing.assert_allclose(stamps, trajectory.times, rtol=0, atol=1e-15)
    assert (np.diff(stamps) > 0).all()


def test_a_script_samples_it_evenly_within_its_limits(trajectory, tmp_path):
    trajectory.write(tmp_path / "t.script")
    text = (tmp_path / "t.script").read_text()
    found = np.array([row.split(",") for row in re.findall(r"\[(.*?)\]", text)], float)
    t = 0.008 * np.arange(len(found))
    np.testing.assert_array_equal(found, trajectory(t).q)
    assert t[-2] < trajectory.duration + 0.1 <= t[-1]
    np.testing.assert_array_equal(found[-12:], np.tile(Q[-1], (12, 1)))
    # differences of samples are means of dq and ddq, and those are within the limits
    assert np.abs(np.diff(found, axis=0)).max() / 0.008 <= 2.0 * (1 + 1e-12)
    assert np.abs(np.diff(found, n=2, axis=0)).max() / 0.008**2 <= 4.0 * (1 + 1e-9)


def test_the_cycle_and_the_servo_s_numbers_can_be_chosen(trajectory):
    for count in (200, 201):
        step = (trajectory.duration + 0.05) / (count - 0.5)
        text = trajectory.to_urscript(step=step, lookahead=0.05, gain=500)
        assert text.count(f", 0, 0, {step!r}, 0.05, 500.0)") == count


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ({"step": 0}, "step: expected a positive number, got 0"),
        ({"step": np.nan}, "step: expected a positive number, got nan"),
        ({"lookahead": 0.02}, "lookahead: expected a number from 0.03 to 0.2, got 0.02"),
        ({"lookahead": 0.21}, "lookahead: expected a number from 0.03 to 0.2, got 0.21"),
        ({"gain": 99}, "gain: expected a number from 100 to 2000, got 99"),
        ({"gain": "300"}, "gain: expected a number from 100 to 2000, got '300'"),
    ],
    ids=str,
)
def test_numbers_that_no_servo_takes_are_refused(trajectory, options, says):
    with pytest.raises(InputError, match=f"^{re.escape(says)}$"):
        trajectory.to_urscript(**options)


@pytest.mark.parametrize(("lookahead", "gain"), [(0.03, 2000), (0.2, 100)])
def test_the_ends_of_a_servo_s_ranges_are_taken(trajectory, lookahead, gain):
    text = trajectory.to_urscript(lookahead=lookahead, gain=gain)
    assert f", 0.008, {lookahead}, {gain:.1f})" in text


@pytest.mark.parametrize("name", ["t.txt", "t", "t.npy", "csv"])
def test_a_name_that_says_no_format_is_refused(trajectory, name, tmp_path):
    with pytest.raises(FileError, match=r"\.csv, \.yaml, \.yml, \.json, \.script expected"):
        trajectory.write(tmp_path / name)
    assert list(tmp_path.iterdir()) == []


def test_a_script_for_an_arm_that_is_no_ur_is_not_written(tmp_path):
    panda = pk.load("panda").chain(tip="panda_hand")
    found = motion.time_optimal(panda, [np.zeros(7), 0.1 * np.ones(7)], acceleration=1.0)
    with pytest.raises(ModelError, match="6 revolute joints"):
        found.write(tmp_path / "t.script")
    assert list(tmp_path.iterdir()) == []


def test_a_format_of_messages_that_is_none_is_refused(trajectory):
    with pytest.raises(InputError, match="format: expected 'yaml' or 'json', got 'xml'"):
        trajectory.to_joint_trajectory("xml")


def test_the_report_says_what_is_used_of_each_limit(trajectory):
    lines = trajectory.summary().splitlines()
    assert lines[0] == (
        f"{trajectory.duration:.6g} s, {len(trajectory.times)} points, at rest at both ends"
    )
    assert lines[1] == (
        f"between its waypoints the tip is at most {1e3 * trajectory.path_deviation:.3g} mm off "
        "the straight lines"
    )
    speed = 50 * trajectory.largest_speed[0]
    acceleration = 25 * trajectory.largest_acceleration[0]
    assert lines[2] == (
        f"'shoulder_pan_joint': {speed:.3g} % of its speed, {acceleration:.3g} % of its "
        "acceleration"
    )
    assert len(lines) == 8
    assert repr(trajectory) == (
        f"<Trajectory {trajectory.duration:.6g} s, {len(trajectory.times)} points>"
    )
    document = json.loads(trajectory.to_json())
    assert document["duration"] == trajectory.duration
    assert document["waypoints"] == trajectory.waypoints.tolist()


def test_the_report_says_how_near_joints_of_coupled_readings_come_to_their_own_speeds():
    arm = pk.load("puma560").chain().replace(velocity_limits=np.full(6, 2.0))
    chain = arm.coupled("J3 = J2 + J3")
    q = np.zeros((2, 6))
    q[1, 1:3] = 10.0  # joint 3 turns by 20 rad
    lines = motion.time_optimal(chain, q, acceleration=1e4).summary().splitlines()
    assert lines[3].startswith("'joint2': 50 % of its speed")
    said = [line for line in lines if line.endswith("its own speed")]
    assert said == ["joint 'joint3': 100 % of its own speed"]


def test_how_far_the_tip_leaves_the_lines_between_its_waypoints_is_measured():
    slides = [pk.screw.prismatic([1, 0, 0]), pk.screw.prismatic([0, 1, 0])]
    table = pk.Chain.from_space(slides, np.eye(4))
    straight = motion.time_optimal(table, [[0, 0], [3, 4]], speed=1.0, acceleration=1.0)
    assert straight.path_deviation < 1e-15
    bent = motion.time_optimal(table, [[0, 0], [1, 0], [1, 1]], speed=1.0, acceleration=1.0)
    # the parabola over s = 0, 1, 2: (s (3 - s) / 2, s (s - 1) / 2): y = -1/8 at s = 1/2
    assert bent.path_deviation == pytest.approx(1 / 8, rel=1e-5)
    for count in (4, 5):
        on_one_line = np.outer(np.arange(count), [3, 4])
        found = motion.time_optimal(table, on_one_line, speed=1.0, acceleration=1.0)
        # positions of up to 20 m, rounded a few times
        assert found.path_deviation < 2e-14


def test_beyond_the_end_of_a_line_the_tip_is_off_it_too():
    slide = pk.Chain.from_space([pk.screw.prismatic([1, 0, 0])], np.eye(4))
    found = motion.time_optimal(slide, [[0.0], [1.0], [0.5]], speed=1.0, acceleration=1.0)
    # the parabola s - 4/3 s (s - 1) is largest, 49/48, at s = 7/8
    assert found.path_deviation == pytest.approx(1 / 48, abs=1e-6)  # of rows 1.5e-3 apart


def test_a_tip_that_turns_where_it_is_leaves_no_line():
    turn = pk.Chain.from_space([pk.screw.revolute([0, 0, 1], [0, 0, 0])], np.eye(4))
    found = motion.time_optimal(turn, [[0.0], [1.0], [1.5]], speed=1.0, acceleration=1.0)
    assert found.path_deviation == 0


def test_a_spline_that_swings_beyond_a_limit_is_said():
    slides = [pk.screw.prismatic([1, 0, 0]), pk.screw.prismatic([0, 1, 0])]
    limits = [[0.0, 1.0], [-0.1, 1.0]]
    table = pk.Chain.from_space(slides, np.eye(4), limits=limits)
    found = motion.time_optimal(table, [[0, 0], [1, 0], [1, 1]], speed=1.0, acceleration=1.0)
    # x = s (3 - s) / 2 is 9/8 at s = 3/2, and y = -1/8 at s = 1/2
    np.testing.assert_allclose(found.beyond_limits, [0.125, 0.025], rtol=1e-4)
    assert f"{table.q_names[0]!r} leaves its limits by 0.125 (rad or m)" in found.summary()
    inside = motion.time_optimal(table, [[0, 0], [1, 1]], speed=1.0, acceleration=1.0)
    assert inside.beyond_limits.tolist() == [0, 0]
    assert "leaves" not in inside.summary()
