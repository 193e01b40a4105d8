"""Each kind of measurement: errors zero where the model is right, jacobian those of the errors, bad
input refused.
"""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import InputError, PoseError, ShapeError
from poekin.solve.calibration.measurements.inputs import parse_measurements, parse_readings
from poekin.solve.calibration.measurements.measurement import Measurement
from poekin.solve.calibration.measurements.points import Distances, Points
from poekin.solve.calibration.measurements.poses import EyeInHand, EyeToHand, Poses
from poekin.solve.calibration.model.error_model import ErrorModel
from poekin.solve.calibration.model.problem import Problem
from tests.findings import dataclasses_of, frozen_and_equal_only_where_its_parts_can_be
from tests.messages import says

ARM = pk.load("panda").chain(tip="panda_link8")
Q = ARM.random(5, 12)
T = ARM.fk(Q)
X = pk.se3.exp([0.3, -0.5, 0.2, 1.0, 0.4, -0.3])
Z = pk.se3.exp([-0.1, 0.2, 1.4, 0.05, -0.08, 0.1])
TOOL = np.array([[0.1, 0.02, 0.05], [-0.03, 0.2, 0.1]])
AT = TOOL @ np.swapaxes(T[:, :3, :3], 1, 2) + T[:, None, :3, 3]
CENTRE = np.array([1.5, -0.4, 0.3])
TRUE = {
    "Poses": (lambda: Poses(T), []),
    "poses in a device's frame": (lambda: Poses(pk.se3.inverse(X) @ T, frame="unknown"), [X]),
    "poses of a probe": (lambda: Poses(T @ Z, tool="unknown"), [Z]),
    "poses of a probe in a device's frame": (
        lambda: Poses(pk.se3.inverse(X) @ T @ Z, frame="unknown", tool="unknown"), [X, Z],
    ),
    "one point": (lambda: Points(AT[:, 0], TOOL[0]), []),
    "two points": (lambda: Points(AT, TOOL), []),
    "points in a device's frame": (
        lambda: Points((AT - X[:3, 3]) @ X[:3, :3], TOOL, frame="unknown"), [X],
    ),
    "points that are not known": (lambda: Points(AT, None), list(TOOL)),
    "a point that is not known in a device's frame": (
        lambda: Points((AT[:, :1] - X[:3, 3]) @ X[:3, :3], "tip", frame="unknown"), [X, TOOL[0]],
    ),
    "distances": (lambda: Distances(np.linalg.norm(AT[:, 0] - CENTRE, axis=1), CENTRE, TOOL[0]), []),
    "distances from somewhere": (lambda: Distances(np.linalg.norm(AT[:, 0] - CENTRE, axis=1), None, TOOL[0]), [CENTRE]),
    "EyeInHand": (lambda: EyeInHand(pk.se3.inverse(X) @ T @ Z), [X, Z]),
    "EyeToHand": (lambda: EyeToHand(pk.se3.inverse(X) @ T @ Z), [X, Z]),
}  # fmt: skip


@pytest.mark.parametrize("kind", TRUE)
def test_the_errors_of_a_true_model_are_rounding_and_unknown_frames_are_guessed(kind):
    make, places = TRUE[kind]
    problem = Problem(ErrorModel(ARM, ("home",), None), Q, [make()])
    assert len(problem.initial_frames) == len(places)
    for found, true in zip(problem.initial_frames, places, strict=True):
        np.testing.assert_allclose(found, true, rtol=0, atol=1e-11)
    (errors,) = problem.errors(np.zeros(problem.size))
    assert errors.shape == (12, problem.sets[0].width)
    np.testing.assert_allclose(errors, 0, rtol=0, atol=1e-11)


@pytest.mark.parametrize("kind", TRUE)
@settings(max_examples=3)  # every slope is looked at in each
@given(seed=st.integers(0, 2**16))
def test_the_slopes_are_those_of_the_errors_away_from_the_truth_too(kind, seed):
    make, places = TRUE[kind]
    problem = Problem(ErrorModel(ARM, ("screws", "home", "gains"), None), Q, [make()], places)
    p = 0.05 * np.random.default_rng(seed).normal(size=problem.size)
    (linear,) = problem.linearised(p)
    np.testing.assert_array_equal(linear.errors, problem.errors(p)[0])
    for k in range(problem.size):
        step = 1e-5 * np.eye(problem.size)[k]
        slope = (problem.errors(p + step)[0] - problem.errors(p - step)[0]) / 2e-5
        # truncation h² times third derivatives of up to some tens, rounding u / h
        np.testing.assert_allclose(linear.jacobian[..., k], slope, rtol=0, atol=1e-7)


def test_a_planted_error_in_each_slope_would_be_seen():
    class Wrong(Poses):
        def jacobian(self, T, places, errors, D):
            jacobian, others = super().jacobian(T, places, 0 * errors, D)
            return jacobian, others

    problem = Problem(ErrorModel(ARM, ("home",), None), Q, [Wrong(T)])
    p = np.full(6, 0.05)
    right = Problem(problem.model, Q, [Poses(T)]).linearised(p)[0].jacobian
    assert np.abs(problem.linearised(p)[0].jacobian - right).max() > 1e-3


def test_an_errors_rotation_comes_first_and_is_in_base_axes():
    turned = T.copy()
    turn = pk.so3.exp([0, 0, 0.01])
    turned[:, :3, :3] = turn.T @ T[:, :3, :3]
    turned[:, :3, 3] -= [0, 0.002, 0]
    (errors,) = Problem(ErrorModel(ARM, ("home",), None), Q, [Poses(turned)]).errors(np.zeros(6))
    np.testing.assert_allclose(
        errors, np.tile([0, 0, 0.01, 0, 0.002, 0], (12, 1)), rtol=0, atol=1e-14
    )


def test_rows_say_which_readings_a_set_belongs_to():
    rows = np.array([7, 2, 2])
    problem = Problem(
        ErrorModel(ARM, ("home",), None), Q, [Poses(T[rows], rows=rows), Points(T[:, :3, 3])]
    )
    one, two = problem.errors(np.zeros(6))
    assert (one.shape, two.shape) == ((3, 6), (12, 3))
    np.testing.assert_allclose(one, 0, rtol=0, atol=1e-14)
    part = problem.part(np.array([2, 5]))
    assert [len(s) for s in part.sets] == [2, 2]
    np.testing.assert_allclose(
        np.concatenate([e.ravel() for e in part.errors(np.zeros(6))]), 0, rtol=0, atol=1e-14
    )


def test_a_bare_array_is_poses_or_points():
    assert [type(s) for s in parse_measurements(T, 12)] == [Poses]
    assert [type(s) for s in parse_measurements(T[:, :3, 3], 12)] == [Points]


def nan(array):
    array = array.copy()
    array[3] = np.nan
    return array


BAD: dict[str, tuple] = {
    "T of the wrong shape": (
        lambda: Poses(T[0]),
        ShapeError,
        "T: expected poses (N, 4, 4), got shape (4, 4)",
    ),
    "NaN in a pose": (
        lambda: Poses(nan(T)),
        InputError,
        "T[3, 0, 0]: expected a finite number, got nan",
    ),
    "no pose": (
        lambda: Poses(2 * T),
        PoseError,
        "T[0] is no pose: its last row is [0.0, 0.0, 0.0, 2.0], expected [0, 0, 0, 1]",
    ),
    "NaN in a point": (
        lambda: Points(nan(AT[:, 0])),
        InputError,
        "p[3, 0]: expected a finite number, got nan",
    ),
    "as many points as are said": (
        lambda: Points(AT, TOOL[0]),
        ShapeError,
        "p: expected positions (N, 1, 3), of 1 points, got shape (12, 2, 3)",
    ),
    "points of four numbers": (
        lambda: Points(AT, [[1.0] * 4] * 2),
        ShapeError,
        "points: expected (3,) or (k, 3) in the tip frame, got [[1.0, 1.0, 1.0, 1.0], [1.0, 1.0, 1.0, 1.0]]",
    ),
    "a point of two numbers": (
        lambda: Points(AT, [1.0, 2.0]),
        ShapeError,
        "points: expected (3,) or (k, 3) in the tip frame, got [1.0, 2.0]",
    ),
    "no points": (
        lambda: Points(AT[:, :0], np.ones((0, 3))),
        ShapeError,
        "points: expected (3,) or (k, 3) in the tip frame, got array([], shape=(0, 3), dtype=float64)",
    ),
    "a point that is not finite": (
        lambda: Points(AT[:, 0], [0.0, np.inf, 0.0]),
        InputError,
        "points[1]: expected a finite number, got inf",
    ),
    "points without a name": (
        lambda: Points(AT, ""),
        InputError,
        "points: expected positions, a name or None, got ''",
    ),
    "unknown points of four numbers": (
        lambda: Points(np.ones((12, 2, 4)), None),
        ShapeError,
        "p: expected positions (N, 2, 3), of 2 points, got shape (12, 2, 4)",
    ),
    "unknown points in a row": (
        lambda: Points(np.ones(12), None),
        ShapeError,
        "p: expected positions (N, 1, 3), of 1 points, got shape (12,)",
    ),
    "positions of four axes": (
        lambda: Points(AT[None], TOOL),
        ShapeError,
        "p: expected positions (N, 2, 3), of 2 points, got shape (1, 12, 2, 3)",
    ),
    "distances in a row": (
        lambda: Distances(np.ones((3, 1))),
        ShapeError,
        "d: expected distances (N,), got shape (3, 1)",
    ),
    "a point that is none": (
        lambda: Distances([1.0], point=[0.0, np.nan, 0.0]),
        InputError,
        "point[1]: expected a finite number, got nan",
    ),
    "a guess that is none": (
        lambda: Distances([1.0], guess=[1.0, 2.0]),
        ShapeError,
        "guess: expected three numbers, got [1.0, 2.0]",
    ),
    "a nameless frame": (
        lambda: EyeInHand(T, board=""),
        InputError,
        "T_base_board: expected a pose, a name or None, got ''",
    ),
    "several frames": (
        lambda: EyeInHand(T, board=T[:2]),
        ShapeError,
        "T_base_board: expected one pose (4, 4), got shape (2, 4, 4)",
    ),
    "rows in halves": (
        lambda: Poses(T, rows=np.arange(12) / 2),
        ShapeError,
        "rows: expected 12 whole numbers, the row of q of each measurement, got float64 of shape (12,)",
    ),
    "a covariance that is not finite": (
        lambda: Poses(T, np.full((6, 6), np.nan)),
        InputError,
        "Poses: covariance[0, 0]: expected a finite number, got nan",
    ),
    "a frame": (
        lambda: Points(AT[:, 0], frame="device"),  # type: ignore[arg-type]
        InputError,
        "frame: expected 'base' or 'unknown', got 'device'",
    ),
    "a frame of poses": (
        lambda: Poses(T, frame="camera"),  # type: ignore[arg-type]
        InputError,
        "frame: expected 'base' or 'unknown', got 'camera'",
    ),
    "a tool of poses": (
        lambda: Poses(T, tool="probe"),  # type: ignore[arg-type]
        InputError,
        "tool: expected 'tip' or 'unknown', got 'probe'",
    ),
    "a negative distance": (
        lambda: Distances([1.0, -1.0]),
        InputError,
        "d[1]: expected a distance above 0, got -1",
    ),
    "a distance of 0": (
        lambda: Distances([1.0, 0.0, -1.0]),
        InputError,
        "d[1]: expected a distance above 0, got 0",
    ),
    "a centre": (
        lambda: Distances([1.0], centre=[0, 0]),
        ShapeError,
        "centre: expected three numbers, got [0, 0]",
    ),
    "a centre of four numbers": (
        lambda: Distances([1.0], centre=[0, 0, 0, 1]),
        ShapeError,
        "centre: expected three numbers, got [0, 0, 0, 1]",
    ),
    "a covariance's shape": (
        lambda: Poses(T, np.eye(3)),
        ShapeError,
        "Poses: covariance: expected shape (6, 6), or (12, 6, 6), got (3, 3)",
    ),
    "a negative variance": (
        lambda: Poses(T, np.diag([1, 1, 1, 1, -1, 1.0])),
        InputError,
        "Poses: covariance is not positive definite: its diagonal is [1.0, 1.0, 1.0, 1.0, -1.0, 1.0]",
    ),
    "an indefinite covariance": (
        lambda: Points(T[:, :3, 3], covariance=[[1, 2, 0], [2, 1, 0], [0, 0, 1]]),
        InputError,
        "Points: covariance is not positive definite: scaled to a unit diagonal, its least eigenvalue is -1",
    ),
    "one of many covariances": (
        lambda: Points(T[:, :3, 3], covariance=[*[np.eye(3)] * 11, np.zeros((3, 3))]),
        InputError,
        "Points: covariance[11] is not positive definite: its diagonal is [0.0, 0.0, 0.0]",
    ),
    "a covariance that is not symmetric": (
        lambda: Points(T[:, :3, 3], covariance=[[1, 0.1, 0], [0, 1, 0], [0, 0, 1]]),
        InputError,
        "Points: covariance is not symmetric, by 0.1 of its diagonal",
    ),
    "a negative row": (
        lambda: Poses(T, rows=np.arange(12) - 1),
        InputError,
        "rows: expected rows of q counted from 0, got -1",
    ),
    "too few rows": (
        lambda: Poses(T, rows=[0]),
        ShapeError,
        "rows: expected 12 whole numbers, the row of q of each measurement, got int64 of shape (1,)",
    ),
    "a row beyond q": (
        lambda: parse_measurements(Poses(T, rows=np.arange(12) + 2), 12),
        InputError,
        "measurements: rows names row 13 of q, which has 12",
    ),
    "another number of rows": (
        lambda: parse_measurements(T[:5], 12),
        ShapeError,
        "measurements: 5 Poses for 12 rows of q; say which with rows=",
    ),
    "a guess": (
        lambda: EyeInHand(T, board=np.eye(3)),
        ShapeError,
        "T_base_board: expected shape (..., 4, 4), got (3, 3):"
        " pk.se3.pose(R, p) makes a pose of a rotation and a translation",
    ),
    "no measurements": (
        lambda: parse_measurements("poses", 12),
        ShapeError,
        (
            "measurements: expected Poses, Points, Distances, EyeInHand, EyeToHand, a list of "
            "them, or an array (N, 4, 4) of poses or (N, 3) of points, got str of shape ()"
        ),
    ),
    "a wrong member": (
        lambda: parse_measurements([Poses(T), T], 12),
        InputError,
        "measurements[1]: expected Poses, Points, Distances, EyeInHand or EyeToHand, got ...",
    ),
    "the number of joints": (
        lambda: parse_readings(ARM, Q[:, :6]),
        ShapeError,
        (
            "q: expected 7 coordinates on the last axis ('panda_joint1', 'panda_joint2', "
            "'panda_joint3', 'panda_joint4', 'panda_joint5', 'panda_joint6', 'panda_joint7'), "
            "got shape (12, 6)"
        ),
    ),
    "one configuration": (
        lambda: parse_readings(ARM, Q[0]),
        ShapeError,
        "q: expected readings (N, 7), one row a measurement, got shape (7,)",
    ),
    "configurations in rows": (
        lambda: parse_readings(ARM, Q[None]),
        ShapeError,
        "q: expected readings (N, 7), one row a measurement, got shape (1, 12, 7)",
    ),
    "poses in rows": (
        lambda: Poses(T[None]),
        ShapeError,
        "T: expected poses (N, 4, 4), got shape (1, 12, 4, 4)",
    ),
    "no readings": (
        lambda: parse_readings(ARM, Q[:0]),
        InputError,
        "q: expected readings, got none",
    ),
    "NaN in q": (
        lambda: parse_readings(ARM, nan(Q)),
        InputError,
        "q[3, 0]: expected a finite number, got nan",
    ),
}


@pytest.mark.parametrize("what", BAD)
def test_bad_input_is_refused_and_said_where(what):
    make, error, message = BAD[what]
    with pytest.raises(error) as caught:
        make()
    assert says(caught.value, message)


def test_measurements_are_frozen_copies():
    given = T.copy()
    poses = Poses(given)
    given[0] = 0
    np.testing.assert_array_equal(poses.T, T)
    with pytest.raises(ValueError, match="read-only"):
        poses.T[0] = 0
    assert isinstance(poses, Measurement)


def test_unknown_frames_are_named_by_their_set_where_there_are_several():
    home, camera = ErrorModel(ARM, ("home",), None), EyeInHand(pk.se3.inverse(X) @ T @ Z)
    assert Problem(home, Q, [camera]).frame_names == ["T_base_board", "T_tip_camera"]
    assert Problem(home, Q, [Poses(T), camera]).frame_names == [
        "T_base_board of measurement set 1", "T_tip_camera of measurement set 1"
    ]  # fmt: skip


@pytest.mark.parametrize(
    "kind", dataclasses_of("poekin.solve.calibration.measurements", "points poses")
)
def test_measurements_cannot_be_changed_and_are_equal_to_themselves_alone(kind):
    assert frozen_and_equal_only_where_its_parts_can_be(kind)


def test_a_point_that_stands_at_the_centre_of_distances_has_no_slope():
    q = np.zeros((1, 7))
    centre = ARM.fk(q)[0, :3, 3]
    problem = Problem(ErrorModel(ARM, ("home",), None), q, [Distances([1.0], centre)])
    assert not problem.jacobians(np.zeros(6))[0].any()
    free = Problem(ErrorModel(ARM, ("home",), None), q, [Distances([1.0], guess=centre)])
    assert not free.jacobians(np.zeros(9))[0].any()


def test_an_unknown_frame_has_six_parameters_however_it_is_said():
    for said in (None, "shared", X):
        for unknown in EyeInHand(T, board=said, camera=said).unknown_frames:
            assert (unknown.size, unknown.shared) == (
                6,
                "shared" if isinstance(said, str) else None,
            )
            assert (unknown.guess is None) == (said is not X)
    poses = Poses(T, frame="unknown", tool="unknown").unknown_frames
    assert [(u.name, u.size) for u in poses] == [("T_base_device", 6), ("T_tip_probe", 6)]
    assert Distances([1.0]).unknown_frames[0].size == 3


def test_lengths_of_any_number_of_points_and_of_poses_are_taken_in_another_unit():
    five = Points(np.ones((2, 5, 3)), np.zeros((5, 3)))
    assert (five.scaled(1e-3).measured == 1e-3).all()
    poses = Poses(T)
    scaled = poses.scaled(1e-3).measured
    assert (scaled[:, :3, 3] == 1e-3 * T[:, :3, 3]).all()
    assert (scaled[:, :3, :3] == T[:, :3, :3]).all()
    assert (poses.T == T).all()


def test_a_covariance_is_symmetric_or_not_by_its_own_diagonal():
    C = 1e-10 * np.array([[1.0, 0.05, 0], [0.04, 1, 0], [0, 0, 4]])
    with pytest.raises(InputError, match=r"covariance is not symmetric, by 0\.01 of its diagonal$"):
        Points(AT[:, 0], TOOL[0], C)
    C[1, 0] = C[0, 1]
    np.testing.assert_array_equal(Points(AT[:, 0], TOOL[0], C).covariance[0], C)
