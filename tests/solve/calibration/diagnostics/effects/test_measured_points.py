"""The points of the tool that were measured: those that a diagnosis and the base and tool are of."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np

import poekin as pk
from poekin.groups import se3
from poekin.solve.calibration import Distances, Points, Poses
from poekin.solve.calibration.diagnostics.effects.diagnosis import FitEvidence
from poekin.solve.calibration.terms.conditions import at_rest

REACH = 2.0
DEVICE = se3.exp([0.1, 0.2, 0.3, 1.0, 2.0, 3.0])
Q = np.zeros((1, 2))


def measured(*sets: Any, frames: Any = ((),)) -> list[list[float]]:
    """Points of these sets, of which each has the unknown frames at its place."""
    problem: Any = SimpleNamespace(
        sets=sets,
        q=Q,
        model=SimpleNamespace(nominal=SimpleNamespace(reach=REACH)),
        frames_of_set=lambda k, p: list(frames[k]),
    )
    fit: Any = SimpleNamespace(p=np.zeros(3))
    return FitEvidence(problem, fit, "linear", at_rest(Q, {})).points.tolist()


def test_points_that_are_known_are_those_that_were_given_each_once():
    plate = [[0.1, 0.0, 0.0], [0.0, 0.2, 0.0]]
    both = Points(np.zeros((1, 2, 3)), plate), Points(np.zeros((1, 3)), plate[0])
    assert measured(*both, frames=((), ())) == sorted(plate)


def test_points_that_are_not_known_are_where_the_fit_has_them_and_the_device_is_none():
    p = np.zeros((1, 2, 3))
    s = Points(p, points=None, frame="unknown")
    found = [[0.0, 0.0, 0.3], [0.1, 0.0, 0.3]]
    frames = [DEVICE, *np.array(found)]
    assert measured(s, frames=(frames,)) == found
    assert measured(Points(p, points=None), frames=(frames[1:],)) == found


def test_points_that_are_known_are_so_in_the_frame_of_a_device_too():
    s = Points(np.zeros((1, 3)), [0.1, 0.2, 0.3], frame="unknown")
    assert measured(s, frames=([DEVICE],)) == [[0.1, 0.2, 0.3]]


def test_a_distance_is_measured_from_one_point_and_a_pose_is_told_by_four():
    wire = Distances([1.0], point=[0.0, 0.0, 0.4])
    assert measured(wire, frames=([np.ones(3)],)) == [[0.0, 0.0, 0.4]]
    # a tenth of the reach apart
    four = [[0.0, 0.0, 0.0], [0.0, 0.0, 0.2], [0.0, 0.2, 0.0], [0.2, 0.0, 0.0]]
    assert measured(Poses(np.eye(4)[None])) == four


def test_a_length_between_points_that_no_arm_carries_tells_no_point_of_the_tool():
    plate: Any = SimpleNamespace(sees_arm=False)
    wire = Distances([1.0], point=[0.0, 0.0, 0.4])
    assert measured(plate, wire, frames=((), ())) == [[0.0, 0.0, 0.4]]


def test_the_tool_of_a_calibration_with_unknown_points_is_told():
    arm = pk.load("ur5").chain()
    made = pk.calibration.simulated(arm, 40, kind="points", points=[0.05, 0.03, 0.1], seed=3)
    seen: Any = made.measurements
    s = Points(seen.p, points=None)
    found = pk.calibrate(arm, made.q, s, folds=0, on_rank_deficiency="fix")
    assert found.evidence is not None
    np.testing.assert_array_equal(found.evidence.points, [found.frames["point 1"]])
    assert [frame.name for frame in found.tool_and_base] == ["base", "tool"]
