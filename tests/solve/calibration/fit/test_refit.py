"""What only the true arm shows is found where the data tell of it, and left where they do not."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError
from poekin.solve.calibration import Distances, Points, calibrate
from poekin.solve.calibration.fit import refit
from poekin.solve.calibration.fit.fitting import Fit
from poekin.solve.calibration.fit.losses import OUTLIER, chi_square
from poekin.solve.calibration.fit.minimise import FitOptions, Minimum, Step
from poekin.solve.calibration.fit.noise import Noise
from poekin.solve.calibration.measurements.simulated import simulated

PANDA = pk.load("panda").chain(tip="panda_link8")
# The origins of these tips are points of the last axis, or of the last two.
ARMS = {"ur5": pk.load("ur5").chain(), "panda": PANDA, "puma560": pk.load("puma560").chain()}


@pytest.mark.parametrize(
    ("name", "loss"), [(name, "linear") for name in ARMS] + [("panda", "huber")]
)
def test_a_point_on_the_last_axis_is_exact_from_exact_data(name, loss):
    arm = ARMS[name]
    s = simulated(arm, 60, kind="points", tilt=5e-3, shift=5e-3, noise=(0, 0), seed=2)
    found = calibrate(arm, s.q, s.measurements, loss=loss, folds=2)
    assert found.success
    seen = found.identification
    assert seen.rank == seen.identifiable > pk.calibration.identify(arm, s.q, s.measurements).rank
    assert found.cross_validation is not None
    assert found.cross_validation.after.rms_length < 1e-12
    fresh = arm.random(9, 200)
    off = found.chain.fk(fresh)[:, :3, 3] - s.truth.fk(fresh)[:, :3, 3]
    assert np.abs(off).max() < 1e-12


def test_distances_from_a_place_that_is_not_known_are_exact_from_exact_data():
    s = simulated(PANDA, 100, kind="distances", unknown=True, noise=(0, 0), seed=3)
    found = calibrate(PANDA, s.q, s.measurements, folds=0)
    fresh = PANDA.random(9, 200)
    again, true = (
        np.linalg.norm(chain.fk(fresh)[:, :3, 3] - centre, axis=1)
        for chain, centre in ((found.chain, found.frames["centre"]), (s.truth, s.frames["centre"]))
    )
    np.testing.assert_allclose(again, true, rtol=0, atol=1e-12)
    # the arm keeps what it shares with the place, so that this moves by as much as the arm is off:
    # some mm
    np.testing.assert_allclose(found.frames["centre"], s.frames["centre"], rtol=0, atol=0.01)


def test_points_in_one_plane_take_a_rough_centre_on_either_side():
    arm = pk.Chain.from_space(
        [pk.screw.revolute([0, 0, 1], [x, 0, 0]) for x in (0, 0.4, 0.7)],
        pk.se3.exp([0, 0, 0, 0.9, 0, 0]),
    )
    s = simulated(arm, 60, kind="distances", unknown=True, noise=(0, 0), seed=3)
    d, centre = s.measurements.d, s.frames["centre"]  # type: ignore[attr-defined]
    with pytest.raises(
        InputError, match=r"give the centre, or a rough one \(guess=\), or measure out of the plane"
    ):
        calibrate(arm, s.q, Distances(d), folds=0)
    for side in (1, -1):
        guess = centre * [1, 1, side] + 0.2
        found = calibrate(arm, s.q, Distances(d, guess=guess), folds=0)
        np.testing.assert_allclose(found.frames["centre"], centre * [1, 1, side], rtol=0, atol=0.01)
        assert found.after.rms_length < 1e-6  # tilts out of the plane show in second order alone


@pytest.mark.parametrize("seed", range(3))
def test_what_noise_hides_stays_nominal(seed, monkeypatch):
    s = simulated(PANDA, 60, kind="points", noise=(0, 1e-4), seed=seed)
    p = Points(s.measurements.p)  # type: ignore[attr-defined]
    found = calibrate(PANDA, s.q, p, folds=0)
    monkeypatch.setattr(refit, "rank_at", lambda *_: 0)
    np.testing.assert_array_equal(found.values, calibrate(PANDA, s.q, p, folds=0).values)
    assert found.identification.rank == 29


def test_noise_of_a_micrometre_leaves_a_micrometre():
    """Where the nominal arm's view of itself leaves 3: a point is known better than it was measured
    once.
    """
    fresh, squares = PANDA.random(9, 200), []
    for seed in range(4):
        s = simulated(PANDA, 60, kind="points", noise=(0, 1e-6), seed=seed)
        found = calibrate(PANDA, s.q, Points(s.measurements.p), folds=0)  # type: ignore[attr-defined]
        squares.append((found.chain.fk(fresh)[:, :3, 3] - s.truth.fk(fresh)[:, :3, 3]) ** 2)
    assert np.sqrt(np.mean(squares)) < 1e-6


@pytest.mark.parametrize(("count", "rank"), [(28, 26), (60, 28)])
def test_a_second_look_needs_numbers_to_spare(count, rank):
    """28 distances would fit 28 parameters whatever they are, and nothing would say how far they
    scatter.
    """
    s = simulated(PANDA, count, kind="distances", unknown=True, noise=(0, 0), seed=3)
    assert calibrate(PANDA, s.q, s.measurements, folds=0).identification.rank == rank


STEPS = [Step(float(k), 0.0, 0.0) for k in range(9)]


@pytest.mark.parametrize("changed, again", [
    ({}, True), ({"converged": False}, False), ({"size": 3}, False), ({"seen": 3}, False), ({"more": 3}, False),
    ({"numbers": 5}, False), ({"numbers": 6}, True), ({"times": 0.99}, False), ({"settles": False}, False),
    ({"most": 3}, True),
])  # fmt: skip
def test_what_is_seen_at_the_end_is_fitted_too_where_it_fits_better_by_more_than_chance(
    changed, again, monkeypatch
):
    """Three directions first, five at the end; two steps of the first fit, one of the trial, three
    of the second.
    """
    case = {
        "converged": True,
        "size": 7,
        "seen": 5,
        "more": 5,
        "numbers": 20,
        "times": 1.01,
        "settles": True,
        "most": 40,
    }
    case |= changed
    few, many = np.zeros((7, 3)), np.zeros((7, case["more"]))
    first = Fit(np.ones(7), case["converged"], STEPS[:2], Noise([], []), few, few)
    second = Fit(np.full(7, 3.0), case["settles"], STEPS[3:6], Noise([], []), many, many)
    tried, asked = Minimum(np.full(7, 2.0), True, STEPS[2:3], np.eye(7)), []
    gain = case["times"] * chi_square(2, OUTLIER)

    def fit_parameters(problem, free, p, options):
        asked.append((free is few, p[0], *options))
        return first if len(asked) == 1 else second

    def minimise(problem, free, noise, p, options):
        asked.append((free is many, noise is first.noise, p[0], *options))
        return tried

    for function in (fit_parameters, minimise):
        monkeypatch.setattr(refit, function.__name__, function)
    monkeypatch.setattr(refit, "rank_at", lambda *given: case["seen"])
    monkeypatch.setattr(refit, "free_directions_at", lambda *given: many)
    monkeypatch.setattr(
        refit, "misfit", lambda problem, noise, name, p: gain if p is first.p else 0.0
    )
    problem: Any = SimpleNamespace(size=case["size"], n_equations=case["numbers"])
    most = case["most"]
    found = refit.fit_with_refit(problem, few, np.zeros(7), FitOptions("huber", None, most))
    assert asked[0] == (True, 0.0, "huber", None, most)
    if len(asked) > 1:
        assert asked[1] == (True, True, 1.0, "huber", None, min(3, most - 2))
    if len(asked) > 2:
        assert asked[2] == (False, 2.0, "huber", None, most - 3)
    if again:
        assert len(asked) == 3
        assert (found.steps, found.p[0], found.free is many) == (STEPS[:6], 3.0, True)
    else:
        assert found is first
