"""Intervals are honest: 95 % ones hold 92 to 98 % of what they are of."""

from __future__ import annotations

import numpy as np
import pytest

from poekin.solve.calibration import Calibration, Measurement, calibrate
from tests.solve.calibration.fit.sagging import ARM, POINTS, SAG, measured, sagged, true_arm

TRUTHS = 15
EACH = 20
ROWS = 50
KNOWN = 2500
"""Configurations from which an arm is known: a fit's errors are smaller there by the root of 50."""
TWO_SIGMA = 1.96
KINDS = [("reflectors", SAG), ("reflectors", 0.0), ("poses", 0.0), ("poses", SAG), ("point", 0.0), ("point", SAG),
         ("distance", 0.0), ("camera", 0.0), ("camera", SAG)]  # fmt: skip


def predicted(found: Calibration, q: np.ndarray, s: Measurement) -> np.ndarray:
    """What the calibrated arm predicts of s at q (N, d), from any origin."""
    return s.errors(found.chain.fk(q), list(found.frames.values()))


@pytest.mark.parametrize(("kind", "sag"), KINDS)
def test_intervals_of_predictions_hold_their_share(kind, sag):
    """The arm that the best fit of all configurations is, sag or none, is what a fit looks for."""
    inside: dict[str, list[float]] = {"measurements": [], "distances": [], "motions": []}
    for truth in range(TRUTHS):
        rng = np.random.default_rng([truth, 7])
        true = true_arm(rng)

        def fitted(count: int, rng: np.random.Generator = rng, true=true) -> Calibration:
            q = ARM.random(rng, count)
            return calibrate(ARM, q, measured(kind, sagged(true, q, sag), rng), folds=0)

        best = fitted(KNOWN)
        for _ in range(EACH):
            found = fitted(ROWS)
            q = ARM.random(rng, 2)
            s = measured(kind, ARM.fk(q), rng)
            off = predicted(found, q, s) - predicted(best, q, s)
            C = found.measurement_covariance(q, s)
            sizes = np.sqrt(np.diagonal(C, axis1=1, axis2=2))
            inside["measurements"].append(float(np.mean(np.abs(off) < TWO_SIGMA * sizes)))
            if kind == "poses":
                inside["distances"].append(_distance_is_inside(found, best, q, POINTS[0]))
                inside["motions"].append(_share_of_motion(found, best, q))
    # 300 calibrations of 50 configurations: the share is known to a per cent
    shares = {what: np.mean(values) for what, values in inside.items() if values}
    assert all(0.92 <= share <= 0.98 for share in shares.values()), shares


def _distance_is_inside(
    found: Calibration, best: Calibration, q: np.ndarray, point: np.ndarray
) -> bool:
    a, b = q
    off = _distance(found, a, b, point) - _distance(best, a, b, point)
    return bool(abs(off) < TWO_SIGMA * found.distance_deviation(a, b, point))


def _share_of_motion(found: Calibration, best: Calibration, q: np.ndarray) -> float:
    a, b = q
    off = _motion(found, a, b)[:3, 3] - _motion(best, a, b)[:3, 3]
    sizes = np.sqrt(np.diag(found.relative_covariance(a, b))[3:])
    return float(np.mean(np.abs(off) < TWO_SIGMA * sizes))


def _motion(found: Calibration, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.linalg.inv(found.chain.fk(a)) @ found.chain.fk(b)


def _distance(found: Calibration, a: np.ndarray, b: np.ndarray, point: np.ndarray) -> float:
    places = [T[:3, :3] @ point + T[:3, 3] for T in found.chain.fk(np.array([a, b]))]
    return float(np.linalg.norm(places[0] - places[1]))


def test_what_is_kept_aside_of_repeated_readings_is_as_far_off_as_fresh_ones():
    ratios = []
    for truth in range(TRUTHS):
        rng = np.random.default_rng([truth, 9])
        true = true_arm(rng)
        q = np.repeat(ARM.random(rng, ROWS), 4, axis=0)
        q += 1e-4 * rng.normal(size=q.shape)
        found = calibrate(ARM, q, measured("point", sagged(true, q, SAG), rng), folds=10)
        fresh = ARM.random(rng, 500)
        s = measured("point", sagged(true, fresh, SAG), rng)
        off = np.linalg.norm(s.errors(found.chain.fk(fresh), []), axis=1)
        assert found.cross_validation is not None
        ratios.append(found.cross_validation.after.rms_length / np.sqrt(np.mean(off**2)))
    # nine tenths of the readings foretell a little worse than all
    assert 0.9 <= np.mean(ratios) <= 1.15
