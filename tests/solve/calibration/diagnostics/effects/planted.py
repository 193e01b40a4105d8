"""Simulated measurements with one planted effect beside other axes and noise."""

from __future__ import annotations

from functools import cache

import numpy as np

import poekin as pk
from poekin.groups import se3
from poekin.solve.calibration.diagnostics.effects.diagnosis import ResidualDiagnosis
from poekin.solve.calibration.terms.gravity import levers, wrist_in_tip

ARM = pk.load("ur5").chain()
POINTS = np.array([[0.05, 0.03, 0.1], [-0.05, 0.04, 0.08], [0.0, -0.06, 0.12]])
NOISE = 5e-5  # m
ROWS = 60
SIZES = {
    "sag": 3e-4,  # rad/m
    "rise": -3e-4,
    "lag": 3e-4,
    "ripple": 1e-3,  # rad
    "backlash": 4e-4,  # rad
    "drift": 3e-4,  # rad and m
    "scale": 5e-4,
    "loose": 1.5e-4,  # m
    "moved": 3e-4,  # m
    "nothing": 0.0,
}


def made(planted, seed, points=POINTS):
    """Readings (N, 6), and points measured in the base frame, with an effect of that name."""
    size = SIZES[planted]
    rng = np.random.default_rng([seed, 3])
    true = pk.calibration.simulated(ARM, 1, seed=seed).truth
    q = ARM.random(rng, ROWS)
    x = q.copy()
    if planted in ("sag", "rise"):
        down = np.tile([0.0, 0.0, -1.0], (ROWS, 1))
        x[:, 1] += size * levers(ARM, q, down, wrist_in_tip(ARM))[:, 1]
    if planted in ("lag", "backlash"):
        moves = np.diff(q, axis=0, prepend=q[:1])
        x += size * (moves if planted == "lag" else 0.5 * np.sign(moves))
    if planted == "ripple":
        x[:, 3] += size * np.sin(2.0 * q[:, 3])
    T = true.fk(x)
    if planted == "drift":
        T = se3.exp(np.linspace(-0.5, 0.5, ROWS)[:, None] * size * rng.normal(size=6)) @ T
    on_tool = np.tile(points, (ROWS, 1, 1))
    if planted == "loose":
        on_tool[:, 1] += rng.normal(scale=size, size=(ROWS, 3))
    if planted == "moved":
        on_tool[:, 1] += [size, 0.0, 0.0]
    p = np.einsum("nij,nkj->nki", T[:, :3, :3], on_tool) + T[:, None, :3, 3]
    if planted == "scale":
        p *= 1.0 + size * np.array([1.0, -1.0, 0.0])
    return q, p + rng.normal(scale=NOISE, size=p.shape)


def gross(p, seed):
    """Points (N, k, 3) with gross errors, 20 times the noise, in one configuration of 20."""
    rng = np.random.default_rng([seed, 7])
    p = p.copy()
    bad = rng.random(len(p)) < 0.05
    p[bad] += rng.normal(scale=20 * NOISE, size=p[bad].shape)
    return p


@cache
def calibrated(planted, seed, count=3):
    """Calibration of the arm by `count` points of the tool."""
    points = POINTS[:count]
    q, p = made(planted, seed, points)
    measured = pk.calibration.Points(p, points)
    return pk.calibrate(ARM, q, measured, folds=0, on_rank_deficiency="fix")


def diagnosis_of(found: pk.calibration.Calibration) -> ResidualDiagnosis:
    """Diagnosis of a calibration that has its measurements."""
    assert found.diagnosis is not None
    return found.diagnosis
