"""Pairs in other frames, read otherwise, and what two parameters that move the poses alike share."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.groups import se3
from poekin.solve.calibration.diagnostics.explanation import size_of
from poekin.solve.calibration.exact import other_readings as module
from poekin.solve.calibration.exact.bounds import propagation
from poekin.solve.calibration.exact.other_readings import aligned, hint
from poekin.solve.calibration.fit.noise import NoiseEstimate
from poekin.solve.calibration.measurements.poses import Poses

ARM = pk.load("ur5").chain()
Q = ARM.random(2, 12)
X = se3.exp([0.0, 0.0, 0.4, 0.3, 0.0, 0.5])
Z = se3.exp([0.0, 0.2, 0.0, 0.0, 0.1, 0.2])


def test_an_arm_is_put_in_the_frames_of_poses_that_are_far_from_its_own():
    T = se3.inverse(X) @ ARM.fk(Q) @ Z
    found = aligned(ARM, Q, Poses(T))
    np.testing.assert_allclose(found.chain.fk(Q), T, rtol=0, atol=1e-9)
    assert found.moved == (
        f"the controller's frames are others: its base is moved by {size_of(X)} from '{ARM.base}', its flange by "
        f"{size_of(Z)} from '{ARM.tip}', by the nominal arm"
    )


@pytest.mark.parametrize("what", ["near", "no frames", "another arm"])
def test_an_arm_that_is_near_or_explains_the_poses_in_no_frames_stays_as_it_is(what):
    q = Q.copy()
    if what == "near":
        T = se3.exp([0, 0, 1e-3, 1e-3, 0, 0]) @ ARM.fk(Q)
    elif what == "no frames":
        q[:] = q[0]
        T = X @ ARM.fk(q)
    else:
        T = ARM.fk(np.roll(Q, 1, axis=0))
    found = aligned(ARM, q, Poses(T))
    assert found.chain is ARM
    assert found.moved == ""


@pytest.mark.parametrize(("missed", "named"), [
    ([0.9, 0.0024, 0.5], "the second"), ([0.9, 0.000999, 0.5], "the second"),
    ([0.0024, 0.9, 0.0025], "the first"), ([0.9, 0.0026, 0.5], None),
    ([np.inf, np.inf, np.inf], None), ([], None),
])  # fmt: skip
def test_the_reading_that_explains_the_pairs_best_is_named_where_it_is_four_times_better(
    missed, named, monkeypatch
):
    """As they stand, the pairs miss by 10 mm."""
    words = ["the first", "the second", "the third"]
    others = [SimpleNamespace(q=k, words=words[k]) for k in range(len(missed))]
    monkeypatch.setattr(module, "other_readings", lambda chain, q: others)
    by_q = {"as given": 0.01, **dict(enumerate(missed))}
    monkeypatch.setattr(module, "_missed", lambda chain, q, poses: by_q[q])
    given: Any = "as given"
    found = hint(ARM, given, Poses(ARM.fk(Q)))
    if named is None:
        assert found == ""
    else:
        mm = f"{1000 * min(missed):.3g}"
        assert mm in ("2.4", "0.999")
        assert found == f"; with {named}, the nominal arm is off by {mm} mm only (median)"


def test_pairs_miss_by_the_median_in_the_best_frames():
    poses = Poses(se3.inverse(X) @ ARM.fk(Q) @ Z)
    assert module._missed(ARM, Q, poses) == pytest.approx(0.0, abs=1e-9)
    still = np.tile(Q[0], (12, 1))
    assert module._missed(ARM, still, Poses(X @ ARM.fk(still))) == np.inf
    assert module._missed(ARM, np.roll(Q, 1, axis=0), poses) == np.inf


def test_a_miss_is_the_median_distance_and_angle():
    angles, lengths = np.array([0.1, 0.4, 0.2]), np.array([0.03, 0.01, 0.05])
    axis = np.array([0.6, 0.0, 0.8])
    T = se3.pose(pk.so3.exp(angles[:, None] * axis), lengths[:, None] * axis)
    found = module._miss(T, np.tile(np.eye(4), (3, 1, 1)))
    assert found.length == pytest.approx(0.03)
    assert found.angle == pytest.approx(0.2)


@pytest.mark.parametrize("unit", ["rad", "m", "1"])
@pytest.mark.parametrize("reach", [2.5, 0.4])
def test_parameters_that_move_the_poses_alike_share_in_radians_and_reaches(unit, reach):
    rng = np.random.default_rng(0)
    column = rng.normal(size=(3, 6, 1))
    D = np.concatenate([column, column], axis=2)
    T = np.tile(np.eye(4), (3, 1, 1))
    found: Any = SimpleNamespace(
        values=None,
        error_model=SimpleNamespace(poses_and_twists=lambda p, q: (T, D)),
        noise_std=[NoiseEstimate(2e-4, 5e-4)],
        parameters=[SimpleNamespace(unit="rad"), SimpleNamespace(unit=unit)],
        nominal=SimpleNamespace(reach=reach),
        chain=SimpleNamespace(jacobian=lambda q, frame: np.zeros((3, 6, 1))),
    )
    fit = propagation(found, np.zeros((3, 1)), Poses(T))
    ratio = reach**2 if unit == "m" else 1.0
    np.testing.assert_allclose(fit.gain[1], ratio * fit.gain[0], rtol=1e-9)
    # together they are the least squares of one
    sigma = np.repeat([2e-4, 5e-4], 3)
    weighted = column[..., 0] / sigma**2
    alone = weighted / np.sum(column[..., 0] * weighted)
    np.testing.assert_allclose(fit.gain.sum(axis=0), alone, rtol=1e-9, atol=1e-12)
    np.testing.assert_array_equal(fit.deviations, sigma)
