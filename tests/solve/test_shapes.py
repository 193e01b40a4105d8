"""Arrays of fewer axes or numbers than expected, or of more, are refused with the shape that was expected."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError, ShapeError
from poekin.solve import motion
from poekin.solve.calibration import Distances, Points, Poses, average_repeats, simulated
from poekin.solve.calibration.terms.conditions import at_rest
from poekin.solve.calibration.terms.term import Term, checked_basis
from poekin.solve.per_coordinate import per_coordinate

ARM = pk.load("ur5").chain()
Q = np.linspace(-1, 1, 24).reshape(4, 6)
T = ARM.fk(Q)
P = T[:, :3, 3]
calibrate: Any = pk.calibrate


def basis(B):  # type: ignore[no-untyped-def]
    parameters = (pk.calibration.Parameter("joint", "sag", "rad"),)
    term = Term("sag", parameters, lambda q, conditions: np.asarray(B))
    return checked_basis(term, Q, at_rest(Q, {}))


READINGS = "q: expected readings (N, 6), one row a measurement, got shape "
OF_REPEATS = "q: expected readings (N, m) with a row for each of 4 Poses, got shape "
SPLINE = "q: expected shape (N, 6), N >= 2, got "
JOINTS = "q: expected shape (N, 6), got "
NOISE = "noise: expected two standard deviations, (rad, m), got "
DIRECTION = "axis: expected a direction (3,) that is not zero, got "
WEIGHTS = "weights: expected six positive numbers (rotation; position), got "
REFUSED: dict[str, Any] = {
    f"{READINGS}(6,)": lambda: calibrate(ARM, Q[0], T),
    f"{READINGS}(1, 4, 6)": lambda: calibrate(ARM, Q[None], T),
    "T: expected poses (N, 4, 4), got shape (4, 4)": lambda: Poses(T[0]),
    "T: expected poses (N, 4, 4), got shape (1, 4, 4, 4)": lambda: Poses(T[None]),
    "p: expected positions (N, 1, 3), of 1 points, got shape (1, 4, 1, 3)": (
        lambda: Points(P[None, :, None], [0, 0, 0])
    ),
    "p: expected positions (N, 1, 3), of 1 points, got shape (4, 1, 4)": (
        lambda: Points(np.ones((4, 1, 4)), [0, 0, 0])
    ),
    "p: expected positions (N, 1, 3), of 1 points, got shape (4, 1, 2)": (
        lambda: Points(np.ones((4, 1, 2)), [0, 0, 0])
    ),
    "points: expected (3,) or (k, 3) in the tip frame, got [[[0, 0, 0], [0, 0, 0], [0, 0, 0]]]": (
        lambda: Points(P, [[[0, 0, 0]] * 3])
    ),
    "d: expected distances (N,), got shape ()": lambda: Distances(1.0),
    "d: expected distances (N,), got shape (1, 1)": lambda: Distances([[1.0]]),
    "rows: expected 4 whole numbers, the row of q of each measurement, got int64 of shape (5,)": (
        lambda: Poses(T, rows=np.arange(5))
    ),
    f"{OF_REPEATS}(6,)": lambda: average_repeats(Q[0], Poses(T)),
    f"{OF_REPEATS}(1, 4, 6)": lambda: average_repeats(Q[None], Poses(T)),
    f"{OF_REPEATS}(3, 6)": lambda: average_repeats(Q[:3], Poses(T)),
    "conditions['payload']: expected a number for each of 4 rows of q, got shape (3,)": (
        lambda: average_repeats(Q, Poses(T), {"payload": np.ones(3)})
    ),
    "conditions['payload']: expected a number for each of 4 rows of q, got shape (5,)": (
        lambda: average_repeats(Q, Poses(T), {"payload": np.ones(5)})
    ),
    f"{NOISE}[0.1]": lambda: simulated(ARM, 4, noise=[0.1]),  # type: ignore[arg-type]
    f"{NOISE}[0.1, 0.1, 0.1]": lambda: simulated(ARM, 4, noise=[0.1] * 3),  # type: ignore[arg-type]
    "q: expected shape (4, 6), got (3, 6)": lambda: simulated(ARM, 4, q=Q[:3]),
    "q: expected shape (3, 6), got (4, 6)": lambda: simulated(ARM, 3, q=Q),
    "basis of the term 'sag': expected shape (4, 6, 1), got (4, 6)": lambda: basis(Q),
    "basis of the term 'sag': expected shape (4, 6, 1), got (4, 6, 2)": (
        lambda: basis(np.ones((4, 6, 2)))
    ),
    "J: expected a matrix (..., rows, P), got shape (3,)": (
        lambda: pk.calibration.observability_indices(np.ones(3), m=1)
    ),
    "poses: expected a path (N, 4, 4), got shape (4, 4)": lambda: pk.follow(ARM, T[0]),
    "poses: expected a path (N, 4, 4), got shape (1, 4, 4, 4)": lambda: pk.follow(ARM, T[None]),
    "times: expected one for each pose (4,), got shape (3,)": (
        lambda: pk.follow(ARM, T, times=[0, 1, 2])
    ),
    "times: expected one for each pose (4,), got shape (5,)": (
        lambda: pk.follow(ARM, T, times=np.arange(5))
    ),
    "T: expected poses (N, 4, 4), got (4, 4)": lambda: motion.write_poses("p.csv", T[0], "7"),
    "T: expected poses (N, 4, 4), got (1, 4, 4, 4)": (
        lambda: motion.write_poses("p.csv", T[None], "7")
    ),
    f"{JOINTS}(6,)": lambda: motion.write_joints("q.csv", Q[0], ARM),
    f"{JOINTS}(1, 4, 6)": lambda: motion.write_joints("q.csv", Q[None], ARM),
    f"{JOINTS}(4, 5)": lambda: motion.write_joints("q.csv", Q[:, :5], ARM),
    f"{JOINTS}(3, 8)": lambda: motion.write_joints("q.csv", Q.reshape(3, 8), ARM),
    "times: expected shape (4,), got (3,)": lambda: motion.write_joints(
        "q.csv", Q, ARM, times=[0, 1, 2]
    ),
    "times: expected shape (4,), got (5,)": (
        lambda: motion.write_joints("q.csv", Q, ARM, times=np.arange(5))
    ),
    "q_0, q_1: expected (..., m) with the same m, got (4, 6) and (4, 5)": (
        lambda: motion.joint(Q, Q[:, :5], 0.5)
    ),
    "q_0, q_1: expected (..., m) with the same m, got (4, 5) and (4, 6)": (
        lambda: motion.joint(Q[:, :5], Q, 0.5)
    ),
    f"{SPLINE}(6,)": lambda: motion.time_optimal(ARM, Q[0], acceleration=1.0),
    f"{SPLINE}(1, 4, 6)": lambda: motion.time_optimal(ARM, Q[None], acceleration=1.0),
    f"{SPLINE}(4, 5)": lambda: motion.time_optimal(ARM, Q[:, :5], acceleration=1.0),
    f"{SPLINE}(3, 8)": lambda: motion.time_optimal(ARM, Q.reshape(3, 8), acceleration=1.0),
    f"{SPLINE}(1, 6)": lambda: motion.time_optimal(ARM, Q[:1], acceleration=1.0),
    "speed: expected one number, or one a coordinate (6,), got shape (4, 6)": (
        lambda: per_coordinate(Q, ARM, "speed")
    ),
    f"{DIRECTION}array([[1., 0., 0.]])": lambda: pk.ik(
        ARM, T[0], task="direction", axis=[[1, 0, 0]]
    ),
    f"{WEIGHTS}array([[1., 1., 1., 1., 1., 1.]])": lambda: pk.ik(
        ARM, T[0], weights=[[1, 1, 1, 1, 1, 1]]
    ),
}


@pytest.mark.parametrize("message", REFUSED)
def test_another_shape_is_refused_with_the_one_expected(message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises((ShapeError, InputError), match=f"^{re.escape(message)}"):
        REFUSED[message]()
    assert not any(tmp_path.iterdir())
