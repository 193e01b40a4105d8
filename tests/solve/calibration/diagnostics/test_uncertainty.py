"""Covariances of what a calibration predicts are those of differences of the model."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError, ShapeError
from poekin.groups import se3, so3
from poekin.solve.calibration import (
    Calibration,
    Distances,
    EyeInHand,
    Points,
    Poses,
    calibrate,
    simulated,
)

ARM = pk.load("ur5").chain()
POINT = [0.05, -0.03, 0.1]
Q = ARM.random(1, 4)
STEP = 1e-6


def found(kind: Any, **options: Any) -> Calibration:
    made = simulated(ARM, 50, kind=kind, points=POINT, seed=2, **options)
    return calibrate(ARM, made.q, made.measurements, folds=0)


FOUND = {
    kind: found(kind, unknown=True) for kind in ("poses", "points", "distances", "eye-in-hand")
}


def differences(of: Any, result: Calibration) -> np.ndarray:
    """J C J^T by central differences of `of(chain, frames)` in all parameters."""
    n = len(result.error_model.parameters)
    columns = []
    for k in range(len(result.values)):
        ends = []
        for sign in (1.0, -1.0):
            p = result.values.copy()
            p[k] += sign * STEP
            chain = result.error_model.chain(p[:n])
            ends.append(of(chain, moved_frames(result, p)))
        columns.append((ends[0] - ends[1]) / (2 * STEP))
    J = np.stack(columns, axis=-1)
    return J @ result.covariance @ np.swapaxes(J, -1, -2)


def moved_frames(result: Calibration, p: np.ndarray) -> list[np.ndarray]:
    frames = []
    for name, frame in result.frames.items():
        own = [i for i, parameter in enumerate(result.parameters) if parameter.owner == name]
        if len(own) == 3:
            frames.append(frame + p[own] - result.values[own])
        else:
            first = frame @ se3.inverse(se3.exp(result.values[own]))
            frames.append(first @ se3.exp(p[own]))
    return frames


def same(C: np.ndarray, expected: np.ndarray) -> None:
    # differences of a step 1e-6 are right to rounding, 1e-16 / 1e-6, and its square
    np.testing.assert_allclose(C, expected, rtol=0, atol=1e-7 * np.abs(expected).max())


LIKE = {
    "poses": Poses(ARM.fk(Q)),
    "points": Points(ARM.fk(Q)[:, :3, 3], POINT, frame="unknown"),
    "distances": Distances(np.ones(4), None, POINT),
    "eye-in-hand": EyeInHand(ARM.fk(Q)),
}


@pytest.mark.parametrize("kind", FOUND)
def test_the_covariance_of_a_predicted_measurement_is_that_of_differences(kind):
    result = FOUND[kind]
    # the errors of measurements that the model predicts exactly
    chain, frames = result.chain, moved_frames(result, result.values)
    T = chain.fk(Q)
    exact: dict[str, Any] = {
        "poses": lambda: Poses(T),
        "points": lambda: Points((se3.inverse(frames[0]) @ T @ se3.exp([0, 0, 0, *POINT]))[:, :3, 3],
                                 POINT, frame="unknown"),
        "distances": lambda: Distances(np.linalg.norm(T[:, :3, :3] @ POINT + T[:, :3, 3] - frames[0], axis=1),
                                       None, POINT),
        "eye-in-hand": lambda: EyeInHand(se3.inverse(frames[0]) @ T @ frames[1]),
    }  # fmt: skip
    s = exact[kind]()
    expected = differences(lambda chain, frames: s.errors(chain.fk(Q), frames), result)
    same(result.measurement_covariance(Q, LIKE[kind]), expected)


def test_the_covariance_of_a_predicted_pose_is_that_of_the_pose():
    result = FOUND["poses"]
    same(result.measurement_covariance(Q, LIKE["poses"]), result.pose_covariance(Q))


def test_the_covariance_of_a_relative_motion_is_that_of_differences():
    result = FOUND["poses"]
    now = se3.inverse(result.chain.fk(Q[0])) @ result.chain.fk(Q[1])

    def errors(chain: pk.Chain, frames: Any) -> np.ndarray:
        motion = se3.inverse(chain.fk(Q[0])) @ chain.fk(Q[1])
        return np.concatenate([so3.log(motion[:3, :3] @ now[:3, :3].T), motion[:3, 3] - now[:3, 3]])

    same(result.relative_covariance(Q[0], Q[1]), differences(errors, result))
    assert result.relative_covariance(Q, Q[::-1]).shape == (4, 6, 6)


def test_the_deviation_of_a_distance_is_that_of_differences():
    result = FOUND["points"]

    def distance(chain: pk.Chain, frames: Any) -> np.ndarray:
        a, b = (T[:3, :3] @ POINT + T[:3, 3] for T in chain.fk(Q[:2]))
        return np.array([np.linalg.norm(a - b)])

    found = result.distance_deviation(Q[0], Q[1], POINT)
    assert found**2 == pytest.approx(differences(distance, result).item(), rel=1e-6)
    assert result.distance_deviation(Q, Q).tolist() == [0.0] * 4


def test_the_workspace_is_known_by_the_covariance_of_its_poses():
    result = FOUND["poses"]
    known = result.workspace(50, seed=3)
    np.testing.assert_array_equal(known.q, ARM.random(3, 50))
    variances = np.diagonal(result.pose_covariance(known.q), axis1=1, axis2=2)
    np.testing.assert_allclose(known.length**2, variances[:, 3:].sum(1), rtol=1e-12)
    np.testing.assert_allclose(known.angle**2, variances[:, :3].sum(1), rtol=1e-12)
    np.testing.assert_array_equal(known.worst, known.q[np.argmax(known.length)])


def test_the_summary_says_how_well_the_tool_is_known_and_where_worst():
    result = FOUND["poses"]
    known = result.workspace()
    mm, mrad = (f"{1e3 * np.median(x):.3g}" for x in (known.length, known.angle))
    worst = ", ".join(f"{x:.3g}" for x in known.worst)
    line = (
        f"the tool is known to {mm} mm and {mrad} mrad over the workspace (standard deviation, median), "
        f"worst {1e3 * known.length.max():.3g} mm at q = ({worst})"
    )
    assert line in str(result).splitlines()
    said: Any = result.to_dict()["workspace"]
    assert said["worst_q"] == known.worst.tolist()
    assert said["worst_length"] == known.length.max()
    assert (said["median_length"], said["median_angle"]) == (
        np.median(known.length),
        np.median(known.angle),
    )


def test_frames_of_several_sets_and_shared_frames_are_found_by_set():
    made = simulated(ARM, 40, kind="eye-in-hand", seed=2)
    seen = made.measurements.T  # type: ignore[attr-defined]
    other = se3.exp([0.3, 0, 0, 0.1, 0, 0]) @ seen
    sets = [EyeInHand(seen, camera="wrist"), EyeInHand(other, camera="wrist")]
    result = calibrate(ARM, made.q, sets, folds=0)
    assert set(result.frames) == {
        "T_base_board of measurement set 0",
        "T_tip_camera of 'wrist'",
        "T_base_board of measurement set 1",
    }
    first, second = (result.measurement_covariance(Q, s, k) for k, s in enumerate(sets))
    assert first.shape == second.shape == (4, 6, 6)
    frames = dict(result.frames)
    frames["T_base_board of measurement set 1"] = frames["T_base_board of measurement set 0"]
    np.testing.assert_allclose(
        replace(result, frames=frames).measurement_covariance(Q, sets[0]), first
    )
    frames = dict(result.frames)
    frames["T_base_board of measurement set 0"] = frames["T_base_board of measurement set 1"]
    np.testing.assert_allclose(
        replace(result, frames=frames).measurement_covariance(Q, sets[1], 1), second
    )


def test_what_does_not_fit_is_refused():
    result = FOUND["poses"]
    with pytest.raises(
        InputError, match=r"^measurement: no frame 'T_base_device' was estimated; available: none$"
    ):
        result.measurement_covariance(Q, LIKE["points"])
    with pytest.raises(ShapeError, match=r"^q_b: expected the shape of q_a, \(6,\), got \(4, 6\)$"):
        result.relative_covariance(Q[0], Q)
    with pytest.raises(ShapeError, match=r"^point: expected one point \(3,\), got 2$"):
        result.distance_deviation(Q[0], Q[1], [Q[0, :3]] * 2)
    with pytest.raises(InputError, match=r"^count: "):
        result.workspace(0)
    with pytest.raises(InputError, match=r"^seed: "):
        result.workspace(seed=-1)
