"""Motions from pose to pose, time scaling, and their files and picture."""

from __future__ import annotations

import math
import os
import re
import sys
from dataclasses import FrozenInstanceError
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import FileError, InputError, MissingExtra, PoseError, ShapeError, UnknownName
from poekin.groups import se3, so3
from poekin.solve import motion
from poekin.solve.motion.paths import Path as PathKind

U = 2.0**-53
parts = st.floats(0, 1)
lengths = st.floats(1e-3, 1e3)
three = st.lists(lengths, min_size=3, max_size=3)
duration = st.floats(1e-3, 1e3)


def vector(size: float) -> st.SearchStrategy[np.ndarray]:
    return st.lists(st.floats(-size, size), min_size=3, max_size=3).map(np.array)


@st.composite
def poses(draw) -> np.ndarray:  # type: ignore[no-untyped-def]
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = so3.exp(draw(vector(1.8))), draw(vector(2.0))
    return T


PATHS = [motion.screw, motion.line]


@pytest.mark.parametrize("path", PATHS, ids=lambda f: f.__name__)
@given(T_s0=poses(), T_s1=poses())
def test_a_path_ends_exactly_at_its_poses(path, T_s0, T_s1):
    ends = path(T_s0, T_s1, [0.0, 1.0])
    np.testing.assert_array_equal(ends, [T_s0, T_s1])


def length(*vectors):
    """1 m, and the lengths of vectors (..., 3)."""
    return 1 + sum(np.linalg.norm(v, axis=-1) for v in vectors)


def largest(error, lengths):
    """The largest entry of a pose's error (..., 4, 4), lengths as multiples of some (...)."""
    off = np.abs(error)
    return np.maximum(off[..., :3, :3].max(axis=(-2, -1)), off[..., :3, 3].max(axis=-1) / lengths)


def one_way(w):
    """Whether a rotation vector (..., 3) is no half turn, where rounding decides on the way round."""
    return np.linalg.norm(w, axis=-1) < np.pi - 1e-9


def end_off(path, T_s0, T_s1):
    """How far 1 - 2 u of a path is from its last pose ÷ rounding.

    The relative pose is off by 16 u, an inverse and a product; the exponential of its logarithm by
    16 u, as the error of one is undone by the other; the last product by 8 u; and 2 u of the way is
    left, which is up to pi times as much as the lengths.
    """
    near = path(T_s0, T_s1, 1 - 2 * U)
    return largest(near - T_s1, length(T_s0[..., :3, 3], T_s1[..., :3, 3])) / (48 * U)


def twist_off(T_s0, T_s1, s, ds):
    """How far the body twist between two places of a screw motion is from its whole twist ÷
    rounding.

    Each place is off by 40 u as above, of its lengths and those of v; a logarithm by pi/2 times
    that, as its derivative is at most that; the twist itself too, and that is not divided by ds.
    """
    a, b = motion.screw(T_s0, T_s1, s), motion.screw(T_s0, T_s1, s + ds)
    xi = se3.log(se3.inverse(T_s0) @ T_s1)
    off = np.abs(se3.log(se3.inverse(a) @ b) / np.expand_dims(ds, -1) - xi)
    size = length(T_s0[..., :3, 3], T_s1[..., :3, 3], xi[..., 3:])
    worst = np.maximum(off[..., :3].max(axis=-1), off[..., 3:].max(axis=-1) / size)
    return np.where(one_way(xi[..., :3]), worst / (40 * U * np.pi / 2 * (2 / ds + 1)), 0)


def line_off(T_s0, T_s1, s):
    """How far a place of a line is from the straight way and the even turn ÷ rounding: some
    products and sums each.
    """
    T, part = motion.line(T_s0, T_s1, s), np.expand_dims(s, -1)
    p_0, p_1, R_0 = T_s0[..., :3, 3], T_s1[..., :3, 3], T_s0[..., :3, :3]
    w = so3.log(np.swapaxes(R_0, -1, -2) @ T_s1[..., :3, :3])
    expected = T.copy()
    expected[..., :3, :3], expected[..., :3, 3] = (
        R_0 @ so3.exp(part * w),
        (1 - part) * p_0 + part * p_1,
    )
    return np.where(one_way(w), largest(T - expected, length(p_0, p_1)) / (48 * U), 0)


@pytest.mark.parametrize("path", PATHS, ids=lambda f: f.__name__)
@given(T_s0=poses(), T_s1=poses())
def test_a_path_comes_to_its_last_pose_and_is_not_put_there(path, T_s0, T_s1):
    assert end_off(path, T_s0, T_s1) <= 1


@given(T_s0=poses(), T_s1=poses(), s=parts, ds=st.floats(0.01, 0.5))
def test_a_screw_motion_has_a_constant_body_twist(T_s0, T_s1, s, ds):
    assert twist_off(T_s0, T_s1, s, ds) <= 1


@given(T_s0=poses(), T_s1=poses(), s=parts)
def test_a_line_is_straight_and_turns_evenly_about_one_axis(T_s0, T_s1, s):
    assert line_off(T_s0, T_s1, s) <= 1


@given(T_s0=poses(), T_s1=poses())
def test_lengths_are_those_of_a_path_cut_into_pieces(T_s0, T_s1):
    s = np.linspace(0, 1, 400)
    rounding = 400 * 40 * U * length(T_s0[:3, 3], T_s1[:3, 3])  # of each piece
    ways: tuple[tuple[PathKind, Any], ...] = (("line", motion.line), ("screw", motion.screw))
    for along, path in ways:
        T = path(T_s0, T_s1, s)
        way = np.linalg.norm(np.diff(T[:, :3, 3], axis=0), axis=1).sum()
        turn = np.linalg.norm(
            so3.log(np.swapaxes(T[:-1, :3, :3], 1, 2) @ T[1:, :3, :3]), axis=1
        ).sum()
        # a chord of an arc of pi / 400 is shorter than it by (pi / 400)^2 / 24 = 2.6e-6 of it
        np.testing.assert_allclose(
            [way, turn], motion.path_lengths(T_s0, T_s1, along), rtol=3e-6, atol=rounding
        )


@given(q_0=vector(3), q_1=vector(3), s=parts)
@example(np.array([2.225073858507e-311, 0, 0]), np.array([-2.225073858507203e-309, 0, 0]), 0.75)
def test_the_space_of_joints_is_crossed_on_a_straight_line(q_0, q_1, s):
    np.testing.assert_array_equal(motion.joint(q_0, q_1, [0, 1]), [q_0, q_1])
    off = np.abs(motion.joint(q_0, q_1, s) - ((1 - s) * q_0 + s * q_1))
    # three roundings of either, of at most both together, and half the last digit of each of four
    # products that are subnormal
    assert (off <= 6 * U * (np.abs(q_0) + np.abs(q_1)) + 2 * 5e-324).all()


@pytest.mark.parametrize("batch", [(), (0,), (1,), (3, 1, 2)], ids=str)
@pytest.mark.parametrize("path", PATHS, ids=lambda f: f.__name__)
def test_leading_axes_are_the_batch(path, batch):
    T_s0, T_s1 = se3.exp(np.random.default_rng(0).normal(size=(2, *batch, 6)))
    T = path(T_s0, T_s1, 0.3)
    assert T.shape == (*batch, 4, 4)
    assert path(np.eye(4), np.eye(4), np.zeros((5, *batch))).shape == (5, *batch, 4, 4)
    for i in np.ndindex(batch):
        np.testing.assert_array_equal(T[i], path(T_s0[i], T_s1[i], 0.3))


def test_nan_stays_in_its_element_and_a_bad_pose_is_named():
    T = np.tile(np.eye(4), (3, 1, 1))
    T[1, 0, 3] = np.nan
    result = motion.screw(T, np.eye(4), 0.5)
    np.testing.assert_array_equal(np.isnan(result).any((1, 2)), [False, True, False])
    T[1] = 2 * np.eye(4)
    with pytest.raises(PoseError, match=r"T_s1\[1\] is no pose"):
        motion.line(np.eye(4), T, 0.5)
    with pytest.raises(ShapeError, match=r"do not broadcast: T_s0 \(3, 4, 4\)"):
        motion.line(T[[0, 0, 0]], T[[0, 0]], 0.5)
    with pytest.raises(ShapeError, match=r"same m, got \(2,\) and \(3,\)"):
        motion.joint([0, 0], [0, 0, 0], 0.5)


def test_two_poses_that_each_miss_by_what_is_accepted_are_accepted_together():
    T = np.eye(4)
    T[:3, :3] *= 1 + 4.9e-6
    assert np.isfinite(motion.screw(T, T, 0.5)).all()


def timings() -> st.SearchStrategy[motion.Timing]:
    return st.one_of(
        duration.map(motion.cubic),
        duration.map(motion.quintic),
        st.tuples(duration, st.floats(1e-3, 0.5)).map(lambda x: motion.trapezoidal(*x)),
    )


@given(timing=timings())
def test_a_timing_begins_and_ends_at_rest(timing):
    T = timing.duration
    s, ds, _ = timing([0.0, T])
    np.testing.assert_array_equal([s, ds], [[0, 1], [0, 0]])
    s, ds, dds = timing([-T, 2 * T])
    np.testing.assert_array_equal([s, ds, dds], [[0, 1], [0, 0], [0, 0]])


@given(timing=timings())
def test_s_never_goes_back_and_its_rates_are_its_rates(timing):
    t = np.linspace(0, timing.duration, 2001)
    s, ds, dds = timing(t)
    assert (np.diff(s) >= 0).all()
    assert (s.min(), s.max()) == (0, 1)
    h, size = timing.duration / 2000, 1 / timing.duration
    # the mean rate of a step is that at its middle to h^2 s''' / 24, of a trapezoid's corner to h
    # s''
    rough = h * np.abs(dds).max()
    np.testing.assert_allclose(
        np.diff(s) / h, 0.5 * (ds[1:] + ds[:-1]), rtol=0, atol=rough + 1e-9 * size
    )
    corner = np.abs(dds).max() if timing.law == "trapezoidal" else 0.01 * np.abs(dds).max()
    np.testing.assert_allclose(
        np.diff(ds) / h, 0.5 * (dds[1:] + dds[:-1]), rtol=0, atol=corner + 1e-9 * size**2
    )


@pytest.mark.parametrize("law", ["cubic", "quintic", "trapezoidal"])
@example(distance=np.array([0.0, 0.0, 2e-313]), speed=[1.0] * 3, acceleration=[1.0] * 3)
@example(distance=np.array([5e-324, 0.0, 0.0]), speed=[1.0] * 3, acceleration=[2.0, 1.0, 1.0])
@given(distance=vector(3), speed=three, acceleration=three)
def test_the_fastest_timing_keeps_every_limit_and_reaches_one(law, distance, speed, acceleration):
    timing = motion.minimum_time(law, distance, speed=speed, acceleration=acceleration)
    if timing.duration == 0:
        assert np.abs(distance).max() < 1e-90
        return
    # the peaks: the middle, the ends, where a quintic's acceleration is greatest, and a grid
    u = np.concatenate(
        [np.linspace(0, 1, 999), [0.5 - math.sqrt(3) / 6, timing.acceleration_fraction]]
    )
    _, ds, dds = timing(u * timing.duration)
    used = np.stack(
        [np.abs(distance) * ds.max() / speed, np.abs(distance) * np.abs(dds).max() / acceleration]
    )
    assert used.max() <= 1
    if np.abs(distance).max() > 1e-100:
        assert used.max() > 1 - 1e-9


@pytest.mark.parametrize(("law", "missing"), [("cubic", "speed"), ("quintic", "speed"), ("trapezoidal", "speed"),
                                              ("cubic", "acceleration"), ("quintic", "acceleration")])  # fmt: skip
def test_one_limit_is_enough(law, missing):
    given = {"speed": 2.0, "acceleration": 3.0}
    del given[missing]
    timing = motion.minimum_time(law, [1.0, -2.0], **given)
    _, ds, dds = timing(np.linspace(0, timing.duration, 1001))
    for name, x in (("speed", ds), ("acceleration", dds)):
        if name in given:
            assert 2 * np.abs(x).max() == pytest.approx(given[name], rel=1e-4)


def test_a_trapezoid_is_a_triangle_where_the_speed_is_not_reached():
    timing = motion.minimum_time("trapezoidal", 1.0, speed=10.0, acceleration=4.0)
    assert (timing.acceleration_fraction, timing.duration) == (0.5, pytest.approx(1.0, rel=1e-14))
    timing = motion.minimum_time("trapezoidal", 1.0, speed=1.0, acceleration=4.0)
    assert timing.duration == pytest.approx(1.25, rel=1e-14)


@pytest.mark.parametrize("distance, speed, acceleration", [(1.0, 1.0, 1e13), (1.0, 1.0, 1e20), (3.0, 0.1, 1e300),
                                                           (1e-12, 1e-3, 1.7e308)])  # fmt: skip
def test_a_ramp_of_next_to_no_time_keeps_the_limits_too(distance, speed, acceleration):
    timing = motion.minimum_time("trapezoidal", distance, speed=speed, acceleration=acceleration)
    assert timing.duration == pytest.approx(distance / speed, rel=1e-12)
    u = np.array(
        [
            0.0,
            0.5 * timing.acceleration_fraction,
            timing.acceleration_fraction,
            0.5,
            1 - timing.acceleration_fraction,
            1.0,
        ]
    )
    s, ds, dds = timing(u * timing.duration)
    assert np.isfinite([s, ds, dds]).all()
    assert s[-1] == 1
    assert distance * ds.max() <= speed
    assert distance * np.abs(dds).max() <= acceleration


def test_no_way_takes_no_time():
    timing = motion.minimum_time("cubic", [0.0, 0.0], speed=1.0)
    assert timing.duration == 0
    np.testing.assert_array_equal(timing([-1, 0, 1]).s, [0, 1, 1])


def test_limits_for_way_and_angle_of_a_pose():
    T_s0, T_s1 = np.eye(4), se3.exp([0, 0, 1.0, 0, 0, 0.5])
    timing = motion.minimum_time("quintic", motion.path_lengths(T_s0, T_s1), speed=[0.25, 10.0])
    assert timing.duration == pytest.approx(1.875 * 0.5 / 0.25)


def test_the_middle_of_a_timing_without_an_even_part_still_speeds_up():
    middle = motion.trapezoidal(2.0, 0.5)(1.0)
    assert (middle.s, middle.ds, middle.dds) == (0.5, 1.0, 1.0)


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda: motion.cubic(0), r"duration: expected a positive number of seconds, got 0"),
        (lambda: motion.quintic(math.nan), r"duration: .* got nan"),
        (lambda: motion.trapezoidal(1, 0.6), r"acceleration_fraction: .* at most 0\.5, got 0\.6"),
        (
            lambda: motion.minimum_time("linear", 1, speed=1),  # type: ignore[arg-type]
            r"law: expected 'cubic', .* or .*, got 'linear'",
        ),
        (
            lambda: motion.minimum_time("cubic", 1),
            r"expected a limit of speed, of acceleration, or of both",
        ),
        (lambda: motion.minimum_time("cubic", math.inf, speed=1), r"distance: expected finite"),
        (
            lambda: motion.minimum_time("cubic", [1, 0], speed=[math.inf, 1]),
            r"expected a finite limit for some distance",
        ),
        (
            lambda: motion.minimum_time("trapezoidal", 1, speed=math.inf, acceleration=math.inf),
            r"expected a finite limit",
        ),
        (
            lambda: motion.minimum_time("cubic", 1, speed=0),
            r"speed: expected positive limits, got 0",
        ),
        (
            lambda: motion.minimum_time("cubic", 1, speed=math.nan),
            r"speed: expected positive limits",
        ),
        (
            lambda: motion.minimum_time("cubic", [1, 2], speed=[1, 2, 3]),
            r"speed: shape \(3,\) does not fit",
        ),
        (
            lambda: motion.minimum_time("trapezoidal", 1, speed=1),
            r"acceleration: the trapezoidal law needs a finite one",
        ),
        (
            lambda: motion.path_lengths(np.eye(4), np.eye(4), "arc"),  # type: ignore[arg-type]
            r"along: expected .*, got 'arc'",
        ),
    ],
    ids=["zero", "nan", "ramp", "law", "no-limit", "far", "infinite", "both", "no-speed", "nan-speed", "shape",
         "trapezoid", "along"],
)  # fmt: skip
def test_what_is_no_timing_is_refused(call, says):
    with pytest.raises(InputError, match=says):
        call()


FORMATS = [("12", None), ("16", None), ("7", "wxyz"), ("7", "xyzw")]


@pytest.mark.parametrize(("format", "order"), FORMATS, ids=str)
@settings(max_examples=max(settings().max_examples // 5, 10))
@given(Ts=st.lists(poses(), max_size=4))
def test_poses_go_through_a_csv_file(format, order, Ts, tmp_path_factory):
    path, T = tmp_path_factory.mktemp("csv") / "T.csv", np.array(Ts).reshape(-1, 4, 4)
    motion.write_poses(path, T, format, quaternion=order)
    back = motion.read_poses(path, format, quaternion=order)
    # a matrix is written to the last bit; a quaternion's log and exp take some roundings
    np.testing.assert_allclose(back, T, atol=0 if order is None else 40 * U, rtol=0)


def test_a_header_orders_the_quaternion(tmp_path):
    path = tmp_path / "T.csv"
    path.write_text("x,y,z,qx,qy,qz,qw\n1,2,3,1,0,0,0\n")
    np.testing.assert_array_equal(
        motion.read_poses(path, "7", quaternion="wxyz"),
        motion.read_poses(path, "7", quaternion="xyzw"),
    )
    T = motion.read_poses(path, "7", quaternion="wxyz")[0]
    np.testing.assert_allclose(
        T[:3, :3], np.diag([1, -1, -1]), rtol=0, atol=2 * U
    )  # sin(pi) is 1.2e-16 in float64


@pytest.mark.parametrize(
    ("text", "format", "order", "kind", "says"),
    [
        ("1,2,3,0,0,0,1", "7", None, InputError, r"needs the order of its quaternion, wxyz or xyzw; none was given"),
        ("1,2,3,0,0,0,1", "7", "xyz", InputError, r"wxyz or xyzw; got 'xyz'"),
        ("1,2,3,0,0,0,1", "12", "xyzw", InputError, r"the format 12 does not take an order"),
        ("1,2,3", "8", None, InputError, r"expected one of matrix, .* doosan; got '8'"),
        ("1,2,3,0,0,0,1\n1,2,3,0,0,0,2", "7", "xyzw", PoseError, r"T\.csv:2: the quaternion's length is 2, expected 1"),
        ("1,2,3,0,0,0,0", "7", "xyzw", PoseError, r"T\.csv:1: the quaternion's length is 0"),
        ("\n" + ",".join("1" * 12), "12", None, PoseError, r"T\.csv:2: its rotation misses orthonormality"),
        ("1,2", "7", "xyzw", InputError, r"T\.csv:1: 7 values expected"),
        ("1,2,3,0,0,0,one", "7", "xyzw", InputError, r"T\.csv:1, column 7: a number expected, got 'one'"),
        ("x,y,z,w,a,b,c", "7", "xyzw", UnknownName, r"T\.csv:1: 'w' is neither a number nor a column"),
    ],
    ids=["unsaid", "order", "useless", "format", "length", "zero", "matrix", "short", "word", "header"],
)  # fmt: skip
def test_a_bad_file_of_poses_is_refused_with_its_line(text, format, order, kind, says, tmp_path):
    (tmp_path / "T.csv").write_text(text)
    with pytest.raises(kind, match=says):
        motion.read_poses(tmp_path / "T.csv", format, quaternion=order)


def test_joints_and_times_go_through_a_csv_file_to_the_last_bit(tmp_path):
    arm, path = pk.load("panda").chain(tip="panda_hand"), tmp_path / "q.csv"
    q, t = arm.random(0, 5), np.arange(5) / 3
    motion.write_joints(path, q, arm)
    back, none = motion.read_joints(path, arm)
    np.testing.assert_array_equal(back, q)
    assert none is None
    motion.write_joints(path, q, arm, times=t)
    back, times = motion.read_joints(path, arm.q_names)
    np.testing.assert_array_equal(back, q)
    np.testing.assert_array_equal(times, t)


@pytest.mark.parametrize(
    "text, q, times",
    [
        ("1,2\n3,4", [[1, 2], [3, 4]], None),
        ("b,a\n1,2", [[2, 1]], None),
        ("time,a,b\n0.5,1,2", [[1, 2]], [0.5]),
        ("\n b , time,a\n1,0.5,2\n", [[2, 1]], [0.5]),
    ],
    ids=["no header", "other order", "times", "a blank line first"],
)  # fmt: skip
@pytest.mark.skipif(not os.path.exists("/dev/fd"), reason="an open pipe has no name here")
def test_joints_come_out_of_a_pipe_as_out_of_a_file(text, q, times, tmp_path):
    (tmp_path / "q.csv").write_text(text)
    reading, writing = os.pipe()
    with open(reading), open(writing, "w") as stream:
        stream.write(text)
        stream.close()
        for path in (tmp_path / "q.csv", f"/dev/fd/{reading}"):
            found = motion.read_joints(path, ["a", "b"])
            np.testing.assert_array_equal(found[0], q)
            assert times is None if found[1] is None else found[1].tolist() == times


def test_a_coordinate_called_time_is_no_time(tmp_path):
    (tmp_path / "q.csv").write_text("b,time\n1,2")
    q, times = motion.read_joints(tmp_path / "q.csv", ["time", "b"])
    assert (q.tolist(), times) == ([[2.0, 1.0]], None)


def test_what_cannot_be_read_or_written_is_said(tmp_path):
    with pytest.raises(FileError, match=r"cannot read .*no\.csv: No such file"):
        motion.read_poses(tmp_path / "no.csv", "12")
    with pytest.raises(FileError, match=r"cannot write .*no/T\.csv"):
        motion.write_poses(tmp_path / "no" / "T.csv", np.eye(4)[None], "12")
    (tmp_path / "b.csv").write_bytes(b"\xff\xfe")
    with pytest.raises(FileError, match=r"b\.csv is no text file: byte 0"):
        motion.read_joints(tmp_path / "b.csv", ["a"])
    with pytest.raises(ShapeError, match=r"expected shape \(N, 2\), got \(3,\)"):
        motion.write_joints(tmp_path / "q.csv", [1, 2, 3], ["a", "b"])
    with pytest.raises(ShapeError, match=r"expected shape \(N, 2\), got \(1, 3\)"):
        motion.write_joints(tmp_path / "q.csv", [[1, 2, 3]], ["a", "b"])
    with pytest.raises(InputError, match=r"names: expected a chain or names"):
        motion.write_joints(tmp_path / "q.csv", [[1.0]], "a")
    (tmp_path / "t.csv").write_text("time,a,b\n0,1\n")
    with pytest.raises(InputError, match=r"t\.csv:2: 3 values expected \(time, a, b\), got 2"):
        motion.read_joints(tmp_path / "t.csv", ["a", "b"])


def test_a_plot_is_svg_with_names_made_harmless(tmp_path):
    pytest.importorskip("matplotlib")
    arm = pk.Chain.from_space(
        [pk.screw.revolute([0, 0, 1], [0, 0, 0])], np.eye(4), joint_names=["<b>$x^$\n"]
    )
    text = motion.plot_joints(
        [[0.0], [1.0], [2.0], [np.nan]], arm, breaks=[2], path=tmp_path / "q.svg"
    )
    assert text.startswith("<svg")
    assert "<b>" not in text
    assert "&lt;b&gt;$x^$\\n (rad)" in text
    assert (tmp_path / "q.svg").read_text(encoding="utf-8").endswith(text)
    assert text == motion.plot_joints([[0.0], [1.0], [2.0], [np.nan]], arm, breaks=[2])


def test_a_plot_without_matplotlib_names_the_extra(monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(MissingExtra, match=r"pip install 'poekin\[report\]'"):
        motion.plot_joints(
            [[0.0]], pk.Chain.from_space([pk.screw.revolute([0, 0, 1], [0, 0, 0])], np.eye(4))
        )


@pytest.mark.parametrize("T", [1.0, 2.5])
def test_each_law_is_its_formula(T):
    u = np.array([0.0, 0.1, 0.3, 0.5, 0.6, 0.95, 1.0])
    s, ds, dds = motion.cubic(T)(u * T)
    np.testing.assert_allclose(s, 3 * u**2 - 2 * u**3, atol=1e-15)
    np.testing.assert_allclose(ds, np.where(u < 1, 6 * u - 6 * u**2, 0) / T, atol=1e-14)
    np.testing.assert_allclose(dds, (6 - 12 * u) / T**2, atol=1e-14)
    s, ds, dds = motion.quintic(T)(u * T)
    np.testing.assert_allclose(s, 10 * u**3 - 15 * u**4 + 6 * u**5, atol=1e-15)
    np.testing.assert_allclose(ds, 30 * u**2 * (1 - u) ** 2 / T, atol=1e-14)
    np.testing.assert_allclose(dds, (60 * u - 180 * u**2 + 120 * u**3) / T**2, atol=1e-13)
    s, ds, dds = motion.trapezoidal(T, 0.2)(u * T)
    top = 1 / 0.8
    np.testing.assert_allclose(
        s, [0, top * 0.025, top * 0.2, 0.5, top * 0.5, 1 - top * 0.00625, 1], atol=1e-15
    )
    np.testing.assert_allclose(ds * T, [0, top / 2, top, top, top, top / 4, 0], atol=1e-14)
    np.testing.assert_allclose(
        dds * T**2, [5 * top, 5 * top, 0, 0, 0, -5 * top, -5 * top], atol=1e-13
    )


def test_a_timing_holds_nan_apart_and_rests_outside():
    for timing in (
        motion.cubic(2.0),
        motion.quintic(2.0),
        motion.trapezoidal(2.0),
        motion.minimum_time("cubic", 0, speed=1),
    ):
        s, ds, dds = timing([np.nan, -1.0, 3.0])
        assert np.isnan([s[0], ds[0], dds[0]]).all()
        np.testing.assert_array_equal([s[1:], ds[1:], dds[1:]], [[0, 1], [0, 0], [0, 0]])
        assert timing(1.0).s.shape == ()
    assert (
        motion.trapezoidal(2.0).acceleration_fraction,
        motion.trapezoidal(2.0, 0.5).acceleration_fraction,
    ) == (0.25, 0.5)
    assert motion.cubic(np.float64(2.0)) == motion.Timing("cubic", 2.0)
    assert (
        motion.cubic(2.0).acceleration_fraction
        == motion.quintic(2.0).acceleration_fraction
        == motion.minimum_time("quintic", 1, speed=1).acceleration_fraction
        == 0.5
    )
    with pytest.raises(FrozenInstanceError):
        motion.cubic(2.0).duration = 3.0  # type: ignore[misc]


@pytest.mark.parametrize("law, speed, acceleration, duration, ramp", [
    ("cubic", 3.0, None, 1.5 * 6 / 3, 0.5), ("cubic", None, 4.0, math.sqrt(6 * 6 / 4), 0.5),
    ("cubic", 3.0, 4.0, 3.0, 0.5), ("cubic", 4.0, 1.0, 6.0, 0.5),
    ("quintic", 3.0, None, 1.875 * 2, 0.5), ("quintic", None, 4.0, math.sqrt(10 / math.sqrt(3) * 1.5), 0.5),
    ("trapezoidal", 2.0, 4.0, 3 + 0.5, 0.5 / 3.5), ("trapezoidal", 6.0, 6.0, 2.0, 0.5),
    ("trapezoidal", 7.0, 6.0, 2.0, 0.5), ("trapezoidal", math.inf, 6.0, 2.0, 0.5), ("trapezoidal", None, 6.0, 2.0, 0.5),
])  # fmt: skip
def test_the_fastest_timing_over_six_units_is_known(law, speed, acceleration, duration, ramp):
    for distance in (6.0, -6.0, [1.0, -6.0, 2.0]):
        timing = motion.minimum_time(law, distance, speed=speed, acceleration=acceleration)
        assert (timing.law, timing.duration, timing.acceleration_fraction) == (
            law,
            pytest.approx(duration),
            pytest.approx(ramp),
        )
        assert timing.duration >= duration * (1 - 1e-15)


def test_each_joint_has_its_own_limits():
    timing = motion.minimum_time(
        "cubic", [2.0, 3.0], speed=[1.0, 2.0], acceleration=[100.0, math.inf]
    )
    assert timing.duration == pytest.approx(1.5 * 2.0)
    timing = motion.minimum_time(
        "trapezoidal", [2.0, 3.0], speed=[math.inf, 1.0], acceleration=[1.0, math.inf]
    )
    assert (timing.duration, timing.acceleration_fraction) == (
        pytest.approx(3 + 2 / 3),
        pytest.approx(2 / 11),
    )


@pytest.mark.parametrize("call, says", [
    (lambda: motion.cubic(math.inf), "duration: expected a positive number of seconds, got inf"),
    (lambda: motion.cubic(True), "duration: expected a positive number of seconds, got True"),
    (lambda: motion.cubic(1e-101), "duration: expected a positive number of seconds, got 1e-101"),
    (lambda: motion.cubic("1"),  # type: ignore[arg-type]
     "duration: expected a positive number of seconds, got '1'"),
    (lambda: motion.trapezoidal(1, 0), "acceleration_fraction: expected a number above 0 and at most 0.5, got 0"),
    (lambda: motion.trapezoidal(1, -0.1), "acceleration_fraction: expected a number above 0 and at most 0.5, got -0.1"),
    (lambda: motion.trapezoidal(1, True), "acceleration_fraction: expected a number above 0 and at most 0.5, got True"),
    (lambda: motion.minimum_time("cubic", [0, 1], acceleration=[1, -1]),
     "acceleration: expected positive limits, got [1, -1]"),
    (lambda: motion.minimum_time("cubic", 1e300, acceleration=1e-300),
     "minimum_time: the limits are so small that there is no finite duration"),
    (lambda: motion.minimum_time("trapezoidal", 1, speed=1, acceleration=math.inf),
     "acceleration: the trapezoidal law needs a finite one, or it would reach its speed in no time"),
    (lambda: motion.minimum_time("cubic", [1, 2], acceleration=[1, 2, 3]),
     "acceleration: shape (3,) does not fit the distances' (2,)"),
    (lambda: motion.minimum_time("cubic", 1),
     "minimum_time: expected a limit of speed, of acceleration, or of both, got none"),
    (lambda: motion.minimum_time("cubic", [1, 0], speed=[math.inf, 1]),
     "minimum_time: expected a finite limit for some distance that is not 0, got none"),
    (lambda: motion.minimum_time("cubic", [math.inf, 1], speed=1),
     "distance: expected finite numbers, got [inf, 1]"),
    (lambda: motion.minimum_time(3, 1, speed=1),  # type: ignore[arg-type]
     "law: expected 'cubic', 'quintic' or 'trapezoidal', got 3"),
])  # fmt: skip
def test_why_there_is_no_timing_is_said_whole(call, says):
    with pytest.raises(InputError, match=f"^{re.escape(says)}$"):
        call()


def test_limits_may_vanish_where_nothing_moves():
    for law in ("cubic", "quintic", "trapezoidal"):
        assert (
            motion.minimum_time(law, [0.0, 1e-101], speed=1e300, acceleration=1e300).duration == 0
        )
        assert motion.minimum_time(law, 0.0, speed=math.inf, acceleration=math.inf).duration == 0
        assert motion.minimum_time(law, [], speed=1, acceleration=1).duration == 0
    assert motion.minimum_time("cubic", 1e-99, speed=1.0).duration == pytest.approx(1.5e-99)


SAME_M = "q_0, q_1: expected (..., m) with the same m, got "


@pytest.mark.parametrize("call, says", [
    (lambda: motion.screw(np.tile(np.eye(4), (2, 1, 1)), np.tile(np.eye(4), (3, 1, 1)), np.zeros(5)),
     "the leading axes do not broadcast: T_s0 (2, 4, 4), T_s1 (3, 4, 4) and s (5,)"),
    (lambda: motion.path_lengths(np.tile(np.eye(4), (2, 1, 1)), np.tile(np.eye(4), (3, 1, 1))),
     "the leading axes do not broadcast: T_s0 (2, 4, 4), T_s1 (3, 4, 4) and s ()"),
    (lambda: motion.joint(np.zeros((2, 3)), np.zeros((4, 3)), np.zeros(5)),
     "q_0, q_1: the leading axes do not broadcast: (2, 3), (4, 3) and s (5,)"),
    (lambda: motion.joint(np.zeros(3), np.zeros(4), 0), f"{SAME_M}(3,) and (4,)"),
    (lambda: motion.joint(np.zeros((4, 4)), np.zeros((4, 3)), 0), f"{SAME_M}(4, 4) and (4, 3)"),
    (lambda: motion.joint(0.0, np.zeros(4), 0), f"{SAME_M}() and (4,)"),
    (lambda: motion.joint(np.zeros(4), 0.0, 0), f"{SAME_M}(4,) and ()"),
    (lambda: motion.path_lengths(np.eye(4), np.eye(4), 3),  # type: ignore[arg-type]
     "along: expected 'line' or 'screw', got 3"),
])  # fmt: skip
def test_poses_or_joints_that_do_not_fit_are_told_with_their_shapes(call, says):
    with pytest.raises(InputError, match=f"^{re.escape(says)}$"):
        call()


def test_paths_go_on_beyond_their_ends():
    s = np.array([-1.0, 0.5, 2.0])
    np.testing.assert_array_equal(motion.joint([0, 1.0], [1, 3.0], s), [[-1, -1], [0.5, 2], [2, 5]])
    T_s1 = se3.exp([0, 0, 0.5, 1, 2, 3])
    np.testing.assert_allclose(
        motion.screw(np.eye(4), T_s1, s), se3.exp(s[:, None] * se3.log(T_s1)), atol=1e-14
    )
    np.testing.assert_allclose(
        motion.line(np.eye(4), T_s1, s)[:, :3, 3], s[:, None] * T_s1[:3, 3], atol=1e-14
    )
