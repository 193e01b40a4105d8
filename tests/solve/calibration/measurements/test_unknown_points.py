"""Points of the tool whose places are not known, and those of which the separations are."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError, ShapeError
from poekin.groups import se3
from poekin.solve.calibration import (
    Points,
    Separations,
    calibrate,
    choose_poses,
    identify,
    simulated,
)
from poekin.solve.calibration.fit.initial_guess import device_and_points
from poekin.solve.calibration.model.error_model import ErrorModel
from poekin.solve.calibration.model.problem import Problem
from tests.messages import says

ARM = pk.load("ur5").chain()
MADE = simulated(ARM, 40, seed=3)
Q = MADE.q
T = MADE.truth.fk(Q)
FRESH = ARM.random(9, 50)
DEVICE = se3.exp([0.3, -0.5, 0.2, 1.0, 0.4, -0.3])
OTHER = se3.exp([-0.3, 0.1, 0.2, 2.0, -0.4, 0.3])
TOOL = np.array([[0.1, 0.02, 0.05], [-0.03, 0.2, 0.1], [0.05, -0.1, 0.12]])
APART = np.linalg.norm(TOOL[:, None] - TOOL, axis=-1)
NOISE = 1e-4


def seen(poses, points: Sequence[np.ndarray] | np.ndarray = TOOL, device=None):
    """Positions (N, k, 3) of points of the tool, in the base or in a device's frame."""
    X = np.eye(4) if device is None else device
    return np.array([[(se3.inverse(X) @ pose @ [*y, 1.0])[:3] for y in points] for pose in poses])


@pytest.mark.parametrize("device", [None, DEVICE], ids=["base", "device"])
def test_the_arm_and_its_points_are_found_together(device):
    frame = "base" if device is None else "unknown"
    found = calibrate(ARM, Q, Points(seen(T, device=device), None, frame=frame), folds=0)
    assert found.success
    *base, a, b, c = found.frames.values()
    assert [name for name in found.frames if name.startswith("point")] == [
        "point 1",
        "point 2",
        "point 3",
    ]
    # from the arm in its own base, to the points as the device sees them: rounding, some hundred times
    there = found.chain.fk(FRESH)
    for X in base:
        there = se3.inverse(X) @ there
    truth = MADE.truth.fk(FRESH)
    np.testing.assert_allclose(
        seen(there, [a, b, c]), seen(truth, device=device), rtol=0, atol=1e-12
    )


def test_what_one_unknown_point_cannot_tell_is_said():
    """4 n - 1 numbers of an arm of n joints, with the three of where the point is among them."""
    known = identify(ARM, Q, Points(seen(T, TOOL[:1]), TOOL[0]))
    unknown = identify(ARM, Q, Points(seen(T, TOOL[:1]), None))
    assert (known.rank, unknown.rank) == (27, 27)
    assert (known.size, unknown.size) == (30, 33)
    assert unknown.unidentifiable == (
        "6 combined changes of home and point 1 that cancel out: point 1 may move, the arm does not",
    )
    assert unknown.unobserved == ()


def test_two_devices_that_see_one_plate_have_its_points_in_common():
    """The second in four configurations only, from which its frame and the points were not to be had."""
    few = Points(seen(T[36:], device=OTHER), "plate", rows=np.arange(36, 40), frame="unknown")
    many = Points(seen(T[:36], device=DEVICE), "plate", rows=np.arange(36), frame="unknown")
    found = calibrate(ARM, Q, [few, many], folds=0)
    assert list(found.frames) == [
        "T_base_device of measurement set 0", "point 1 of 'plate'", "point 2 of 'plate'",
        "point 3 of 'plate'", "T_base_device of measurement set 1",
    ]  # fmt: skip
    first = found.frames["T_base_device of measurement set 0"]
    second = found.frames["T_base_device of measurement set 1"]
    np.testing.assert_allclose(
        se3.inverse(first) @ second, se3.inverse(OTHER) @ DEVICE, rtol=0, atol=1e-11
    )


# 12 numbers of the device's frame and 3 of each point, by 3 of each point of a measurement
@pytest.mark.parametrize("count, least", [(1, 5), (2, 3), (3, 3), (4, 2)])
def test_a_device_and_points_are_guessed_in_spite_of_outliers(count, least):
    points = np.array([*TOOL, [0.0, 0.1, -0.1]])[:count]
    p = seen(T, points, device=DEVICE)
    p[::5] += np.random.default_rng(0).uniform(-0.5, 0.5, (8, count, 3))
    X, y = device_and_points(T, p)
    np.testing.assert_allclose(X, DEVICE, rtol=0, atol=1e-12)
    np.testing.assert_allclose(y, points, rtol=0, atol=1e-12)
    message = (
        r"^an initial guess of a device's frame and of points of the tool needs "
        rf"{least} measurements or more, got {least - 1}$"
    )
    with pytest.raises(InputError, match=message):
        device_and_points(T[: least - 1], p[: least - 1])


def test_residuals_are_in_base_axes_and_at_the_points():
    p = seen(T, device=DEVICE) + NOISE * np.random.default_rng(2).normal(size=(40, 3, 3))
    found = calibrate(ARM, Q, Points(p, None, frame="unknown"), folds=0)
    vectors = found.residuals
    assert vectors is not None
    X, *points = found.frames.values()
    places = seen(found.chain.fk(Q), points)
    np.testing.assert_allclose(vectors.places, places.reshape(-1, 3), rtol=0, atol=1e-12)
    in_base = p @ X[:3, :3].T + X[:3, 3]
    np.testing.assert_allclose(vectors.after, (places - in_base).reshape(-1, 3), rtol=0, atol=1e-12)


def plate(sets=(), **options):
    noise = NOISE * np.random.default_rng(1).normal(size=(40, 3, 3))
    points = Points(seen(T, device=DEVICE) + noise, "plate", NOISE**2 * np.eye(9), frame="unknown")
    return calibrate(ARM, Q, [points, *sets], folds=0, **options)


def between(found, i, j):
    """Distance of two points, and its variance, as found."""
    y = [found.frames[f"point {k + 1} of 'plate'"] for k in range(3)]
    apart = y[i] - y[j]
    d = np.linalg.norm(apart)
    J = np.zeros(len(found.parameters))
    for k, sign in ((i, 1.0), (j, -1.0)):
        own = [n for n, p in enumerate(found.parameters) if p.owner == f"point {k + 1} of 'plate'"]
        J[own] = sign * apart / d
    return d, J @ found.covariance @ J


def test_known_separations_are_soft():
    """One of them, off by 0.1 mm, moves its two points by what its variance and theirs say."""
    free, variance = between(plate(), 0, 2)
    said = np.full((3, 3), np.nan)
    said[0, 2] = said[2, 0] = free + 1e-4
    for sigma in (1e-6, variance**0.5, 1e-2):
        found = plate([Separations(said, "plate", sigma**2)])
        weight = variance / (variance + sigma**2)
        d, after = between(found, 0, 2)
        # beyond first order: (1e-4 m)^2 over distances of 0.2 m
        assert d - free == pytest.approx(1e-4 * weight, abs=1e-7)
        assert after == pytest.approx(variance * (1.0 - weight), rel=1e-2)


def test_all_separations_hold_and_leave_the_arm_better_known():
    found = plate([Separations(APART, "plate", 1e-6**2)])
    for i, j in ((0, 1), (0, 2), (1, 2)):
        assert between(found, i, j)[0] == pytest.approx(APART[i, j], abs=4e-6)
    without = np.trace(plate().pose_covariance(FRESH)[:, 3:, 3:].mean(axis=0))
    assert np.trace(found.pose_covariance(FRESH)[:, 3:, 3:].mean(axis=0)) < without
    assert len(found.after.of_set(1)) == 3
    assert found.residuals is not None
    assert len(found.residuals.rows) == 120  # a separation is nowhere


def test_the_slopes_of_separations_are_those_of_their_errors():
    sets = [Points(seen(T), "plate"), Separations(APART + 0.01 * (1 - np.eye(3)), "plate", 1e-10)]
    problem = Problem(ErrorModel(ARM, ("home",), None), Q, sets)
    p = 0.05 * np.random.default_rng(0).normal(size=problem.size)
    J = problem.linearised(p)[1].jacobian[:, 0]
    for k, step in enumerate(1e-5 * np.eye(problem.size)):
        slope = (problem.errors(p + step)[1] - problem.errors(p - step)[1])[:, 0] / 2e-5
        np.testing.assert_allclose(J[:, k], slope, rtol=0, atol=1e-8)
    np.testing.assert_allclose(problem.errors(np.zeros(problem.size))[1], -0.01, rtol=0, atol=2e-3)


def test_folds_hold_separations_out_with_the_first_reading():
    sets = [Points(seen(T), "plate"), Separations(APART, "plate", 1e-10)]
    found = calibrate(ARM, Q, sets, folds=2)
    assert found.cross_validation is not None
    assert found.cross_validation.after.rms_length < 1e-11
    assert len(found.cross_validation.after) == 43
    assert sets[1].subset(np.array([2])).pairs.tolist() == [[1, 2]]


def table(i, j, value, back=None):
    d = APART.copy()
    d[i, j] = value
    d[j, i] = value if back is None else back
    return d


BAD = {
    "a row": (
        lambda: Separations(APART[0], "plate", 1.0), ShapeError,
        "d: expected a table (k, k) of distances between points, got shape (3,)",
    ),
    "one point": (
        lambda: Separations([[0.0]], "plate", 1.0), ShapeError,
        "d: expected a table (k, k) of distances between points, got shape (1, 1)",
    ),
    "halves that differ": (
        lambda: Separations(table(0, 1, 0.3, 0.2), "plate", 1.0), InputError,
        "d[0, 1] is 0.3 and d[1, 0] 0.2",
    ),
    "one half that is not known": (
        lambda: Separations(table(0, 1, 0.3, np.nan), "plate", 1.0), InputError,
        "d[0, 1] is 0.3 and d[1, 0] nan",
    ),
    "a distance of 0": (
        lambda: Separations(table(1, 2, 0.0), "plate", 1.0), InputError,
        "d[1, 2]: expected a distance above 0, got 0",
    ),
    "an infinite one": (
        lambda: Separations(table(1, 2, np.inf), "plate", 1.0), InputError,
        "d[1, 2]: expected a distance above 0, got inf",
    ),
    "nothing known": (
        lambda: Separations(np.full((2, 2), np.nan), "plate", 1.0), InputError,
        "d: expected a distance that is known, got none",
    ),
    "no name": (
        lambda: Separations(APART, None, 1.0), InputError,
        "points: expected the name of points, got None",
    ),
    "no variance": (
        lambda: Separations(APART, "plate", None), InputError,
        "covariance: expected the variance of d, m², got None",
    ),
    "a negative variance": (
        lambda: Separations(APART, "plate", -1.0), InputError,
        "Separations: covariance is not positive definite: its diagonal is [-1.0]",
    ),
    "points that nothing measures": (
        lambda: identify(ARM, Q, [Points(seen(T), None), Separations(APART, "plate", 1.0)]), InputError,
        "Separations: no Points with points='plate' measure point 1",
    ),
    "where to measure points that are not known": (
        lambda: choose_poses(ARM, 9, 20, measurements=Points(seen(T[:1]), None)), InputError,
        "measurements: Points: expected points=, roughly where it is: nothing is measured yet",
    ),
    "where to measure separations": (
        lambda: choose_poses(ARM, 9, 20, measurements=Separations(APART, "plate", 1.0)), InputError,
        (
            "measurements: expected 'poses', 'points', or an example of Poses, Points, Distances, "
            "EyeInHand or EyeToHand, or a list of them, got ..."
        ),
    ),
}  # fmt: skip


@pytest.mark.parametrize("what", BAD)
def test_bad_separations_are_refused_and_said_where(what):
    make, error, message = BAD[what]
    with pytest.raises(error) as caught:
        make()
    assert says(caught.value, message), str(caught.value)


def test_points_are_guessed_by_what_measures_them_however_many_separations_there_are():
    sets = [Separations(APART, "plate", 1e-10), Points(seen(T[:2]), "plate")]
    seen_by = identify(ARM, Q[:2], sets)
    assert seen_by.n_equations == 3 + 18
