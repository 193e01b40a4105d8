"""The result of `from_fk`: bounds and scatter of poses, and the words on them."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.solve.calibration.exact.bounds import ReadingErrors, propagation, worst_case
from poekin.solve.calibration.exact.from_fk_result import (
    FromFk,
    PoseErrors,
    drawn_pose_errors,
    pose_bound,
)
from poekin.solve.calibration.measurements.poses import Poses

ARM = pk.load("ur5").chain()
MADE = pk.calibration.simulated(ARM, 12, noise=(1e-7, 1e-7), seed=1)
POSES = Poses(MADE.measurements.measured)
FOUND = pk.calibrate(ARM, MADE.q, POSES, folds=0)
FIT = propagation(FOUND, MADE.q, POSES)
LARGEST = ReadingErrors(np.full(6, 1e-7), 2e-7, 3e-7)
Q = ARM.random(4, 6)


def test_the_bound_of_a_pose_is_the_length_of_those_of_its_numbers():
    found = pose_bound(FOUND, FIT, LARGEST, Q.reshape(2, 3, 6))
    assert found.rotation.shape == found.position.shape == (2, 3)
    h = 1e-5
    P = len(FOUND.values)
    model = FOUND.error_model
    for row, q in enumerate(Q):
        T = model.poses(FOUND.values, q[None])[0]
        J = np.empty((6, P))
        for k in range(P):
            ends = [model.poses(FOUND.values + s * h * np.eye(P)[k], q[None])[0] for s in (1, -1)]
            X = (ends[0] - ends[1])[:3, :3] @ T[:3, :3].T / (2 * h)
            J[:3, k] = X[2, 1], X[0, 2], X[1, 0]
            J[3:, k] = (ends[0] - ends[1])[:3, 3] / (2 * h)
        each = worst_case(J, FIT, LARGEST)
        at = divmod(row, 3)
        # difference quotients are right to 1e-9 or so
        assert found.rotation[at] == pytest.approx(np.linalg.norm(each[:3]), rel=1e-6)
        assert found.position[at] == pytest.approx(np.linalg.norm(each[3:]), rel=1e-6)


def test_drawn_poses_are_a_thousand_with_their_root_mean_square_and_their_largest_bound():
    typical, worst = drawn_pose_errors(FOUND, FIT, LARGEST)
    q = FOUND.chain.random(0, 1000)
    C = FOUND.pose_covariance(q)
    for part, mean in ((slice(3), typical.rotation), (slice(3, 6), typical.position)):
        squares = [np.trace(one[part, part]) for one in C]
        assert mean == pytest.approx(np.mean(squares) ** 0.5, rel=1e-9)
    bounds = pose_bound(FOUND, FIT, LARGEST, q)
    assert worst.rotation == pytest.approx(bounds.rotation.max(), rel=1e-12)
    assert worst.position == pytest.approx(bounds.position.max(), rel=1e-12)
    assert isinstance(worst.rotation, np.ndarray)


def test_what_is_typical_is_no_more_than_the_worst():
    none = ReadingErrors(np.zeros(6), 1e-12, 0.0)
    typical, worst = drawn_pose_errors(FOUND, FIT, none)
    assert typical.rotation == worst.rotation > 0
    assert typical.position == worst.position > 0


def result(remarks: tuple[str, ...] = ()) -> FromFk:
    fit = FIT._replace(errors=np.array([[1.0, -4, 2, 5, 6, -7.5], [3, 0, 0, 7, 0, 0]]) * 1e-6)
    bounds = np.zeros((6, 6))
    bounds[2, 1], bounds[4, 5], bounds[0, 3] = 1.1e-5, 2.2e-5, 2.1e-5
    typical = PoseErrors(np.array(3e-6), np.array(4e-5))
    worst = PoseErrors(np.array(5e-6), np.array(6e-5))
    return FromFk(FOUND, "", LARGEST, bounds, typical, worst, remarks, fit)


def test_the_summary_has_the_largest_of_all_in_micrometres_and_microradians():
    assert result(("a remark", "another")).summary().splitlines() == [
        "2 exact pairs, residuals of at most 4 µrad and 7.5 µm",
        "screws: directions and moments known to 11 µrad and 22 µm at worst",
        "poses: known to 3 µrad and 40 µm rms, 5 µrad and 60 µm at worst",
        "a remark",
        "another",
    ]
    assert len(result().summary().splitlines()) == 3


def test_a_result_is_shown_as_its_summary_and_cannot_be_changed():
    found = result()
    assert found.chain is FOUND.chain
    assert found != result()
    with pytest.raises(AttributeError):
        found.digits = "none"  # type: ignore[misc]
    bound = found.pose_bound(dict(zip(ARM.q_names, Q[0], strict=True)))
    assert bound.position == pytest.approx(found.pose_bound(Q[0]).position, rel=1e-12)
