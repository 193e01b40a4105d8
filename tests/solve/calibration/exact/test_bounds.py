"""The worst case is a bound that errors of the worst signs reach."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.solve.calibration.diagnostics.uncertainty import pose_jacobian
from poekin.solve.calibration.exact.bounds import (
    ReadingErrors,
    propagation,
    screw_bounds,
    worst_case,
)
from poekin.solve.calibration.measurements.poses import Poses
from poekin.solve.calibration.model.error_model import ErrorModel

ARM = pk.load("ur10e").chain()
MADE = pk.calibration.simulated(ARM, 12, noise=(0, 0), seed=1)
POSES = Poses(MADE.truth.fk(MADE.q))
FOUND = pk.calibrate(ARM, MADE.q, POSES, folds=0)
FIT = propagation(FOUND, MADE.q, POSES)
NONE = ReadingErrors(np.zeros(6), 0.0, 0.0)
ROWS = np.random.default_rng(0).normal(size=(4, 30))


def estimated(errors: np.ndarray) -> np.ndarray:
    """The parameters that errors (N, 6) of the poses make, by least squares written out."""
    weights = np.tile(1.0 / FIT.deviations, len(errors))
    J = FIT.design.reshape(-1, 30) * weights[:, None]
    return np.linalg.lstsq(J, weights * errors.ravel(), rcond=None)[0]


@pytest.mark.parametrize("source", ["joints", "position", "rotation"])
def test_errors_of_the_worst_signs_reach_the_bound_of_each_kind(source):
    largest = {
        "joints": NONE._replace(joints=np.array([1e-3, 2e-3, 0.0, 3e-3, 1e-3, 1e-3])),
        "position": NONE._replace(position=2e-3),
        "rotation": NONE._replace(rotation=2e-3),
    }[source]
    bound = worst_case(ROWS, FIT, largest)
    for y, expected in zip(ROWS, bound, strict=True):
        L = np.einsum("p,pnk->nk", y, FIT.gain)
        errors = np.zeros((12, 6))
        if source == "joints":
            signs = np.sign(np.einsum("nk,nkm->nm", L, FIT.jacobian))
            errors = np.einsum("nkm,nm->nk", FIT.jacobian, signs * largest.joints)
        elif source == "position":
            errors[:, 3:] = 2e-3 * np.sign(L[:, 3:])
        else:
            errors[:, :3] = 2e-3 * L[:, :3] / np.linalg.norm(L[:, :3], axis=1)[:, None]
        assert y @ estimated(errors) == pytest.approx(expected, rel=1e-9)


def test_kinds_add_up_and_many_rows_are_taken_in_parts(monkeypatch):
    each = ReadingErrors(np.full(6, 1e-3), 2e-3, 3e-3)
    alone = [
        NONE._replace(joints=each.joints),
        NONE._replace(rotation=each.rotation),
        NONE._replace(position=each.position),
    ]
    whole = worst_case(ROWS, FIT, each)
    np.testing.assert_allclose(sum(worst_case(ROWS, FIT, one) for one in alone), whole, rtol=1e-12)
    monkeypatch.setattr("poekin.solve.calibration.exact.bounds._AT_ONCE", 1)
    np.testing.assert_allclose(worst_case(ROWS, FIT, each), whole, rtol=1e-12)
    assert worst_case(ROWS.reshape(2, 2, 30), FIT, each).shape == (2, 2)


def test_twice_the_second_order_of_a_tilt_and_a_shift_is_added(monkeypatch):
    tilt = 1e-2
    shift = 3e-2
    first = np.zeros((6, 6))
    first[:, 0] = tilt
    first[:, 3] = shift
    monkeypatch.setattr("poekin.solve.calibration.exact.bounds.worst_case", lambda *_: first)
    added = screw_bounds(FOUND, FIT, NONE) - first
    v = np.linalg.norm(FOUND.chain.screws[:, 3:], axis=1)
    # What rounding adds is 2e-14 of some metres.
    np.testing.assert_allclose(added[:, :3].T, [np.full(6, 2 * tilt**2 / 2)] * 3, atol=1e-12)
    moved = 2 * (tilt**2 / 2 * v + tilt * shift)
    np.testing.assert_allclose(added[:, 3:].T, [moved] * 3, atol=1e-12)


def test_jacobians_are_the_difference_quotients_of_screws_and_poses():
    model = FOUND.error_model
    step = 1e-6 * np.random.default_rng(1).normal(size=30)
    plus = model.joints(FOUND.values + step)
    minus = model.joints(FOUND.values - step)
    screws = model.screw_jacobian(FOUND.values) @ step[:24]
    np.testing.assert_allclose(2 * screws, plus.screws - minus.screws, rtol=0, atol=1e-14)
    q = ARM.random(1, 3)
    moved = pose_jacobian(*model.poses_and_twists(FOUND.values, q)) @ step
    a, b = plus.fk(q), minus.fk(q)
    turned = pk.so3.log(a[:, :3, :3] @ np.swapaxes(b[:, :3, :3], 1, 2))
    np.testing.assert_allclose(2 * moved[:, :3], turned, rtol=0, atol=1e-14)
    np.testing.assert_allclose(2 * moved[:, 3:], a[:, :3, 3] - b[:, :3, 3], rtol=0, atol=1e-14)


@pytest.mark.parametrize(("every", "count"), [(1, 10), (2, 8)])
def test_screws_turn_and_shift_as_their_parameters_say(every, count):
    arm = pk.Chain.from_space(
        [[0, 0, 1, 0.1, 0, 0.02], [0, 0, 0, 0.6, 0.8, 0], [0, 1, 0, -0.4, 0, 0.5]],
        pk.se3.exp([0.2, -0.1, 0.3, 0.9, 0.1, 0.4]),
    )  # helical, prismatic, revolute
    moving = arm.joint_names[::every]
    model = ErrorModel(arm, ("screws", "home", "offsets", "gains"), moving)
    p, step = 0.1 * np.random.default_rng(0).normal(size=(2, len(model.parameters)))
    D = model.screw_jacobian(p)
    assert D.shape == (3, 6, count)
    h = 1e-5
    quotient = (model.joints(p + h * step).screws - model.joints(p - h * step).screws) / (2 * h)
    np.testing.assert_allclose(D @ step[:count], quotient, rtol=0, atol=1e-10)
