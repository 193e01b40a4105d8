"""Simulated measurements: an arm whose axes are moved and stay axes, noise of the size that is
said, known outliers.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import poekin as pk
from poekin.errors import InputError, ShapeError
from poekin.groups import so3
from poekin.solve.calibration.measurements.data import KINDS
from poekin.solve.calibration.measurements.simulated import (
    GROSS_SHIFT,
    GROSS_TURN,
    Simulated,
    _Sensor,
    simulated,
)
from poekin.testing.strategies import chain_strategies
from tests.findings import dataclasses_of, frozen_and_equal_only_where_its_parts_can_be
from tests.messages import says

PANDA = pk.load("panda").chain(tip="panda_link8")
TOOL = np.array([[0.1, 0, 0], [0, 0.2, 0], [0, 0, 0.3]])
seeds = st.integers(0, 2**32)
WAYS = [(kind, unknown) for kind in KINDS for unknown in (False, True)]
U = 2.0**-53


def errors(made: Simulated) -> np.ndarray:
    """Model minus measurement (N, width), written out: X^-1 f Z, X^-1 p, |p - c| of the truth."""
    m: Any = made.measurements
    T = made.truth.fk(made.q)
    X = np.eye(4) if made.X is None else made.X
    Z = np.eye(4) if made.Z is None else made.Z
    G = np.linalg.inv(X) @ T @ Z
    if hasattr(m, "T"):
        w = so3.log(G[:, :3, :3] @ np.swapaxes(m.T[:, :3, :3], 1, 2))
        return np.hstack([w, G[:, :3, 3] - m.T[:, :3, 3]])
    assert made.points is not None
    points = np.hstack([made.points, np.ones((len(made.points), 1))])
    there = np.einsum("nij,kj->nki", G, points)[..., :3]
    if hasattr(m, "p"):
        return (there - m.p).reshape(len(T), -1)
    centre = made.frames.get("centre", m.centre)
    return (np.linalg.norm(there[:, 0] - centre, axis=1) - m.d)[:, None]


@given(arm=chain_strategies.chains(), seed=seeds, tilt=st.floats(0, 0.5), shift=st.floats(0, 0.5))
def test_moved_axes_stay_unit_and_keep_their_pitch(arm, seed, tilt, shift):
    truth = simulated(arm, 1, seed=seed, tilt=tilt, shift=shift).truth
    assert truth.kinds == arm.kinds
    turning = np.array([kind != "prismatic" for kind in arm.kinds], bool)
    w, v = truth.screws[:, :3], truth.screws[:, 3:]
    np.testing.assert_allclose(
        np.linalg.norm(np.where(turning[:, None], w, v), axis=1), 1, atol=4 * U, rtol=0
    )
    assert not w[~turning].any()
    before = (arm.screws[:, :3] * arm.screws[:, 3:]).sum(1)
    # a pitch is a difference of products of the size of |v|, moved by two products of 6x6 matrices
    rounding = 100 * U * (1 + np.linalg.norm(arm.screws[:, 3:], axis=1) + np.linalg.norm(v, axis=1))
    assert (np.abs((w * v).sum(1) - before) <= rounding).all()
    revolute = np.array([kind == "revolute" for kind in arm.kinds], bool)
    assert (
        np.abs((w * v).sum(1))[revolute] <= 4 * U * (1 + np.linalg.norm(v[revolute], axis=1))
    ).all()


@given(arm=chain_strategies.chains(), seed=seeds)
def test_without_tilt_and_shift_the_truth_is_the_arm_itself(arm, seed):
    made = simulated(arm, 1, seed=seed, tilt=0, shift=0)
    assert not made.parameters.any()
    np.testing.assert_allclose(made.truth.screws, arm.screws, atol=20 * U * arm.reach, rtol=4 * U)
    np.testing.assert_allclose(made.truth.home, arm.home, rtol=0, atol=4 * U * arm.reach)


def test_axes_are_tilted_and_shifted_by_what_is_said():
    n = 400
    line = pk.Chain.from_space(
        [pk.screw.revolute([0, 0, 1], [0.01 * i, 0, 0]) for i in range(n)], np.eye(4)
    )
    tilted = simulated(line, 1, tilt=1e-3, shift=0).truth.screws[:, :3]
    shifted = simulated(line, 1, tilt=0, shift=1e-3).truth.screws
    np.testing.assert_array_equal(shifted[:, :3], line.screws[:, :3])
    feet = np.cross(shifted[:, :3], shifted[:, 3:]) - np.cross(
        line.screws[:, :3], line.screws[:, 3:]
    )
    for off in (tilted[:, :2], feet[:, :2]):
        # the standard deviation of 800 numbers is known to 1 / sqrt(1600) = 2.5 %: four times that
        assert np.sqrt(np.mean(off**2)) == pytest.approx(1e-3, rel=0.1)


def test_errors_grow_with_what_is_said_and_stay_the_same_otherwise():
    one, two = (simulated(PANDA, 1, tilt=k * 1e-3, shift=k * 1e-4).parameters for k in (1, 2))
    np.testing.assert_array_equal(2 * one, two)
    assert len(one) == 4 * 7 + 6


@pytest.mark.parametrize(("kind", "unknown"), WAYS)
def test_without_noise_the_truth_explains_all(kind, unknown):
    made = simulated(PANDA, 20, kind=kind, unknown=unknown, noise=(0, 0), points=TOOL)
    assert made.measurements.covariance is None
    # a handful of products of poses of a metre or two
    np.testing.assert_allclose(errors(made), 0, rtol=0, atol=50 * U)


@pytest.mark.parametrize(("kind", "unknown"), WAYS)
def test_noise_has_the_covariance_that_the_measurements_say(kind, unknown):
    made = simulated(
        PANDA, 4000, kind=kind, unknown=unknown, noise=(3e-4, 2e-5), points=TOOL, seed=1
    )
    e, C = errors(made), made.measurements.covariance
    assert C is not None
    found = e.T @ e / len(e) / np.sqrt(np.outer(np.diag(C[0]), np.diag(C[0])))
    # a covariance of 4000 is known to sqrt(2 / 4000) = 2.2 %, the largest of 81 to four times that
    np.testing.assert_allclose(found, np.eye(len(found)), rtol=0, atol=0.09)


@pytest.mark.parametrize(("kind", "unknown"), WAYS)
def test_the_outliers_are_those_that_are_said_and_gross(kind, unknown):
    made = simulated(
        PANDA, 200, kind=kind, unknown=unknown, outliers=0.05, noise=(1e-4, 1e-4), points=TOOL
    )
    e = np.abs(errors(made))
    assert made.outliers.sum() == 10
    assert e[~made.outliers].max() < 1e-3
    gross = e[made.outliers]
    if gross.shape[1] == 6:
        angles = np.linalg.norm(gross[:, :3], axis=1)
        assert GROSS_TURN[0] - 1e-3 < angles.min() < angles.max() < GROSS_TURN[1] + 1e-3
        gross = gross[:, 3:]
    far = np.linalg.norm(gross[:, :3], axis=1) / PANDA.reach
    assert GROSS_SHIFT[0] - 1e-3 < far.min() < far.max() < GROSS_SHIFT[1] + 1e-3


@pytest.mark.parametrize(("kind", "unknown"), WAYS)
def test_the_frames_are_those_that_the_measurements_do_not_know(kind, unknown):
    made = simulated(PANDA, 3, kind=kind, unknown=unknown)
    assert {u.name: (u.size,) for u in made.measurements.unknown_frames} == {
        name: (6,) if T.shape == (4, 4) else T.shape for name, T in made.frames.items()
    }
    assert len(made.measurements) == 3


@given(seed=seeds, kind=st.sampled_from(list(KINDS)))
def test_a_seed_gives_the_same_truth_and_readings_whatever_is_measured(seed, kind):
    one = simulated(PANDA, 5, seed=seed)
    two = simulated(PANDA, 9, seed=seed, kind=kind, noise=(0, 1e-3), outliers=0.3)
    assert one.truth == two.truth
    np.testing.assert_array_equal(one.q, two.q[:5])
    lower, upper = PANDA.limits.T
    assert ((lower <= two.q) & (two.q <= upper)).all()
    assert not np.array_equal(one.parameters, simulated(PANDA, 1, seed=seed + 1).parameters)


def test_q_may_be_given():
    q = PANDA.random(3, 4)
    made = simulated(PANDA, 4, q=q, noise=(0, 0))
    np.testing.assert_array_equal(made.q, q)
    np.testing.assert_allclose(made.measurements.T, made.truth.fk(q), rtol=0, atol=20 * U)  # type: ignore[attr-defined]


def test_a_distance_never_becomes_negative():
    here = pk.Chain.from_space([], np.eye(4))
    for seed in range(50):
        centre = simulated(here, 1, kind="distances", unknown=True, seed=seed).frames["centre"]
        made = simulated(
            here,
            20,
            kind="distances",
            outliers=0.9,
            seed=seed,
            tilt=0,
            shift=0,
            points=1.05 * centre,
        )
        d = made.measurements.d  # type: ignore[attr-defined]
        np.testing.assert_allclose(d[~made.outliers], 0.1, rtol=0, atol=1e-3)
        assert (d > 0).all()


def test_a_gross_distance_is_too_short_or_too_long_and_too_long_where_none_would_be_left():
    here = pk.Chain.from_space([], np.eye(4))
    point = np.array([1.0, 0.0, 0.0])

    class Drawn:
        """Draws that are given: the second distance would be 0."""

        def choice(self, signs, count):
            return np.array([-1.0, -1.0, -1.0, 1.0])

        def uniform(self, low, high, count):
            return np.array([0.25, 1.0, 1.5, 0.25])

    sensor = _Sensor(
        reach=1.0,
        noise=(0.0, 0.0),
        rng=np.random.default_rng(0),
        outlier_rng=Drawn(),  # type: ignore[arg-type]
        gross=np.ones(4, bool),
    )
    d = sensor.distances(here.fk(np.zeros((4, 0))), point, np.zeros(3))
    assert d.tolist() == [0.75, 2.0, 2.5, 1.25]


def test_the_arm_the_noise_and_the_frames_are_drawn_apart():
    made = simulated(PANDA, 7, tilt=1, shift=1, noise=(1, 1), kind="distances", seed=5)
    drawn = [made.parameters[:7], errors(made)[:, 0], made.q[0]]
    for i, x in enumerate(drawn):
        for y in drawn[:i]:
            assert not np.isclose(np.abs(x), np.abs(y)).any()


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        ({"n": 0}, InputError, "n: expected a whole number from 1 on, got 0"),
        ({"n": True}, InputError, "n: expected a whole number from 1 on, got True"),
        ({"seed": -1}, InputError, "seed: expected a whole number from 0 on, got -1"),
        (
            {"kind": "pose"},
            InputError,
            "kind: expected 'poses', 'eye-in-hand', 'eye-to-hand', 'points' or 'distances', got 'pose'",
        ),
        ({"tilt": -1e-3}, InputError, "tilt: expected a finite number of at least 0, got -0.001"),
        ({"shift": np.nan}, InputError, "shift: expected a finite number of at least 0, got nan"),
        (
            {"noise": 1e-4},
            ShapeError,
            "noise: expected two standard deviations, (rad, m), got 0.0001",
        ),
        (
            {"noise": (1e-4, np.inf)},
            InputError,
            "noise[1]: expected a finite number of at least 0, got inf",
        ),
        (
            {"outliers": 1},
            InputError,
            "outliers: expected a part of the measurements, 0 <= outliers < 1, got 1",
        ),
        (
            {"outliers": -0.1},
            InputError,
            "outliers: expected a part of the measurements, 0 <= outliers < 1, got -0.1",
        ),
        ({"seed": True}, InputError, "seed: expected a whole number from 0 on, got True"),
        ({"tilt": [0, 0]}, InputError, "tilt: expected a finite number of at least 0, got [0, 0]"),
        (
            {"points": [[np.nan, 0, 0]]},
            InputError,
            "points[0, 0]: expected a finite number, got nan",
        ),
        (
            {"points": np.zeros((0, 3))},
            ShapeError,
            "points: expected (3,) or (k, 3) in the tip frame, got array([], shape=(0, 3), dtype=float64)",
        ),
        (
            {"q": np.full((4, 7), np.nan)},
            InputError,
            "q[0, 0]: expected a finite number, got nan",
        ),
        (
            {"outliers": 5},
            InputError,
            "outliers: expected a part of the measurements, 0 <= outliers < 1, got 5",
        ),
        ({"q": np.zeros((3, 7))}, ShapeError, "q: expected shape (4, 7), got (3, 7)"),
        (
            {"points": [1, 2]},
            ShapeError,
            "points: expected (3,) or (k, 3) in the tip frame, got [1, 2]",
        ),
    ],
    ids=[
        "none",
        "bool",
        "seed",
        "kind",
        "tilt",
        "shift",
        "noise",
        "noisy",
        "all",
        "below",
        "seed in words",
        "several",
        "nan",
        "no points",
        "q nan",
        "outliers",
        "q",
        "points",
    ],
)
def test_what_cannot_be_simulated_is_refused(options, error, message):
    with pytest.raises(error) as caught:
        simulated(PANDA, **{"n": 4, **options})
    assert says(caught.value, message)


def test_frames_stand_where_an_arm_can_be_measured_from():
    turns = []
    for seed in range(40):
        made = simulated(PANDA, 1, kind="eye-in-hand", seed=seed)
        assert made.X is not None
        assert made.Z is not None
        for T, far in ((made.X, 0.7), (made.Z, 0.1)):
            assert np.linalg.norm(T[:3, 3]) == pytest.approx(far * PANDA.reach)
            turns.append(float(np.linalg.norm(so3.log(T[:3, :3]))))
        centre = simulated(PANDA, 1, kind="distances", unknown=True, seed=seed).frames["centre"]
        assert np.linalg.norm(centre) == pytest.approx(2 * PANDA.reach)
        ways = np.array([made.X[:3, 3] / 0.7, made.Z[:3, 3] / 0.1, centre / 2]) / PANDA.reach
        # No two are alike: of 40 seeds the closest two have the cosine 0.9998.
        assert (np.abs(ways @ ways.T) < 1 - 1e-9).sum() == 6
    assert 0.5 <= min(turns) < 0.7
    assert 2.3 < max(turns) <= 2.5
    assert (made.X is made.frames["T_base_board"], made.Z is made.frames["T_tip_camera"]) == (
        True,
        True,
    )
    plain = simulated(PANDA, 1)
    assert (plain.X, plain.Z, plain.points, plain.frames) == (None, None, None, {})
    assert simulated(PANDA, 1, kind="distances", points=TOOL).points is not None


def test_gross_errors_lie_all_over_their_bounds_in_every_direction():
    made = simulated(PANDA, 4000, outliers=0.5, noise=(0, 0), seed=1)
    e = errors(made)[made.outliers]
    assert len(e) == 2000
    assert np.abs(errors(made)[~made.outliers]).max() < 1e-13
    for part, (low, high) in ((e[:, :3], GROSS_TURN), (e[:, 3:] / PANDA.reach, GROSS_SHIFT)):
        size = np.linalg.norm(part, axis=1)
        # Even between them: the mean of 2000 is known to 1 / sqrt(12 * 2000) = 0.65 % of the range,
        # five times that.
        assert np.mean((size - low) / (high - low)) == pytest.approx(0.5, abs=0.035)
        assert (low <= size).all()
        assert (size <= high).all()
        # Even over the sphere: each component's mean 0, its mean square 1/3, to 1/sqrt(3 * 2000)
        # and 0.3/sqrt(2000).
        u = part / size[:, None]
        np.testing.assert_allclose(u.mean(axis=0), 0, atol=0.065)
        np.testing.assert_allclose((u**2).mean(axis=0), 1 / 3, atol=0.035)


@pytest.mark.parametrize(
    "kind", dataclasses_of("poekin.solve.calibration.measurements", "simulated")
)
def test_what_was_simulated_cannot_be_changed_and_is_equal_to_itself_alone(kind):
    assert frozen_and_equal_only_where_its_parts_can_be(kind)


@pytest.mark.parametrize("kind", KINDS)
def test_gross_errors_are_as_many_reaches_of_a_large_arm(kind):
    large = pk.Chain.from_space(
        [pk.screw.revolute([0, 0, 1], [0, 0, 0])], pk.se3.exp([0, 0, 0, 40.0, 0, 30.0])
    )
    made = simulated(large, 60, kind=kind, outliers=0.5, noise=(0, 0), tilt=0, shift=0)
    off = (
        np.linalg.norm(errors(made)[made.outliers][:, -3 if kind != "distances" else -1 :], axis=1)
        / large.reach
    )
    assert large.reach > 40
    # 1e-12: a difference of lengths of 100 m
    assert off.min() >= GROSS_SHIFT[0] - 1e-12
    assert off.max() <= GROSS_SHIFT[1] + 1e-12
    assert off.max() > 3 * off.min()


def test_what_is_not_said_of_a_simulation_is_a_tilt_of_2_mrad_and_a_tenth_of_a_millimetre_of_noise():
    said: dict[str, Any] = {
        "kind": "poses",
        "tilt": 2e-3,
        "shift": 1e-3,
        "noise": (1e-4, 1e-4),
        "outliers": 0.0,
        "seed": 0,
        "unknown": False,
    }
    found, same = simulated(PANDA, 5), simulated(PANDA, 5, **said)
    np.testing.assert_array_equal(found.parameters, same.parameters)
    np.testing.assert_array_equal(found.measurements.T, same.measurements.T)  # type: ignore[attr-defined]
    np.testing.assert_array_equal(found.measurements.covariance, same.measurements.covariance)
    assert not found.outliers.any()
    point = simulated(PANDA, 5, kind="points")
    assert point.points is not None
    assert point.points.tolist() == [[0, 0, 0]]
    assert point.frames == {}


def test_the_covariance_of_two_points_has_the_noise_of_lengths_alone():
    points = [[0.0, 0.0, 0.0], [0.1, 0.0, 0.0]]
    made = simulated(
        pk.load("puma560").chain(), 3, kind="points", points=points, noise=(1e-2, 1e-3)
    )
    np.testing.assert_allclose(made.measurements.covariance[0], 1e-6 * np.eye(6), rtol=1e-12)


def test_the_summary_counts_measurements_and_outliers():
    made = simulated(PANDA, 20, kind="points", outliers=0.1)
    assert str(made) == "20 simulated Points, 2 of them gross outliers"
    assert made.to_dict()["outliers"] == made.outliers.tolist()
