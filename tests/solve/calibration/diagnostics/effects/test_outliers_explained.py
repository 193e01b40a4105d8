"""Measurements that stand out by an effect are no outliers; those that stand out beside it are."""

from __future__ import annotations

import numpy as np

import poekin as pk
from poekin.solve.calibration.fit.losses import OUTLIER, chi_square
from poekin.solve.calibration.terms.gravity import levers, wrist_in_tip
from tests.solve.calibration.diagnostics.effects.planted import (
    ARM,
    NOISE,
    POINTS,
    diagnosis_of,
    made,
)

OPTIONS = {"folds": 0, "on_rank_deficiency": "fix"}
UPRIGHT = np.arange(80) % 8 > 0


def raw_outliers(found, width=3):
    """Measurements that are off by more than one good one in 10^4, whatever explains them."""
    fit = found.evidence.fit
    (squares,) = fit.noise.squares(found.evidence.problem.errors(fit.p))
    return np.flatnonzero(squares > chi_square(width, OUTLIER)).tolist()


def hanging(row, beyond, loss):
    """Calibration of a sagging arm whose wrist, in most rows, hangs above the shoulder; a row of the
    others is off by so much more in the direction in which it sags, m.
    """
    rng = np.random.default_rng(0)
    q = ARM.random(rng, 80)
    q[UPRIGHT, 1] = -np.pi / 2 + rng.normal(scale=0.15, size=70)
    q[UPRIGHT, 2] = rng.normal(scale=0.3, size=70)
    x = q.copy()
    down = np.tile([0.0, 0.0, -1.0], (80, 1))
    x[:, 1] += 1e-3 * levers(ARM, q, down, wrist_in_tip(ARM))[:, 1]
    true = pk.calibration.simulated(ARM, 1, seed=0).truth
    point = [*POINTS[0], 1.0]
    p = true.fk(x)[:, :3] @ point + rng.normal(scale=NOISE, size=(80, 3))
    sag = p[row] - true.fk(q[row])[:3] @ point
    p[row] += beyond * sag / np.linalg.norm(sag)
    return pk.calibrate(ARM, q, pk.calibration.Points(p, POINTS[0]), loss=loss, **OPTIONS)


def test_outliers_that_an_effect_explains_are_none_and_others_stay():
    found = hanging(0, 2e-3, "huber")
    raw = raw_outliers(found)
    assert set(raw) > {0}
    assert not UPRIGHT[raw].any()
    assert diagnosis_of(found).findings[0].verdict == "joint 2 (shoulder_lift_joint) sags"
    assert [(o.set, o.index, o.row) for o in found.outliers] == [(0, 0, 0)]


def test_an_outlier_is_judged_by_the_noise_that_an_effect_leaves():
    """By 0.3 mm: six times the noise, and hardly what it is without the effect."""
    found = hanging(8, 3e-4, "linear")
    assert raw_outliers(found) == [8]
    assert [o.row for o in found.outliers] == [8]


def test_a_loose_reflector_makes_no_outliers():
    q, p = made("loose", 1)
    found = pk.calibrate(ARM, q, pk.calibration.Points(p, POINTS), loss="huber", **OPTIONS)
    assert raw_outliers(found, 9)
    assert found.outliers == ()
