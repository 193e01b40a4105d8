"""Residuals as vectors: as long as the residuals, and in the base frame whatever was measured."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.solve.calibration.model.residual_vectors import ResidualVectors

ARM = pk.load("ur5").chain()
KINDS = ["poses", "points", "distances", "eye-in-hand", "eye-to-hand"]


def calibrated(kind: Any, **options: Any) -> tuple[Any, Any, ResidualVectors]:
    """Simulated measurements, what is found of them, and its residuals as vectors."""
    made = pk.calibration.simulated(ARM, 40, kind=kind, seed=3, **options)
    options = {"on_rank_deficiency": "fix", "folds": 0}
    found = pk.calibrate(ARM, made.q, made.measurements, **options)
    assert found.residuals is not None
    return made, found, found.residuals


@pytest.mark.parametrize("kind", KINDS)
def test_each_vector_is_as_long_as_its_residual(kind):
    made, found, v = calibrated(kind)
    np.testing.assert_array_equal(v.q, made.q)
    np.testing.assert_array_equal(v.rows, found.before.row)
    for vectors, residuals in ((v.before, found.before), (v.after, found.after)):
        lengths = np.linalg.norm(vectors, axis=1)
        # a rotation of a vector keeps its length within 4 u
        np.testing.assert_allclose(lengths, residuals.length, rtol=1e-14, atol=1e-16)


def test_measured_points_are_where_the_arm_has_them_less_the_vector():
    made, _, v = calibrated("points", points=[[0.1, 0, 0], [0, 0.1, 0]])
    measured = made.measurements.p.reshape(-1, 3)
    # 1e-15: rounding of metres
    np.testing.assert_allclose(v.places - v.after, measured, atol=1e-15)
    np.testing.assert_array_equal(v.rows, np.repeat(np.arange(40), 2))


def test_vectors_measured_by_a_device_are_in_the_base_frame():
    made, found, v = calibrated("points", unknown=True)
    T = found.frames["T_base_device"]
    measured = made.measurements.p[:, 0] @ T[:3, :3].T + T[:3, 3]
    np.testing.assert_allclose(v.places - v.after, measured, atol=1e-14)


def test_the_vector_of_a_distance_points_along_the_line_to_the_centre():
    made, _, v = calibrated("distances")
    along = v.places - made.measurements.centre
    across = np.cross(v.after, along)
    assert np.abs(across).max() < 1e-16
