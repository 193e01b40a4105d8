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


def test_vectors_of_a_probe_that_sits_anywhere_on_the_tool_are_in_the_base_frame():
    made = pk.calibration.simulated(ARM, 40, seed=3)
    M = made.measurements.T @ pk.se3.exp([0.5, 0.9, -0.7, 0.05, 0.1, 0.15])  # type: ignore[attr-defined]
    probe = pk.calibration.Poses(M, tool="unknown")
    found = pk.calibrate(ARM, made.q, probe, folds=0, on_rank_deficiency="fix")
    assert found.residuals is not None
    off = found.chain.fk(made.q) @ found.frames["T_tip_probe"] - M
    np.testing.assert_allclose(found.residuals.after, off[:, :3, 3], atol=1e-14)


def test_the_vector_of_a_distance_points_along_the_line_to_the_centre():
    made, _, v = calibrated("distances")
    along = v.places - made.measurements.centre
    across = np.cross(v.after, along)
    assert np.abs(across).max() < 1e-16


def test_residuals_in_axes_of_the_tool_turn_with_it():
    made, found, v = calibrated("points")
    R = found.chain.fk(made.q)[:, :3, :3]
    np.testing.assert_allclose(v.R, R, atol=1e-15)
    own = v.in_axes("tool")
    # turned back they are the same, to rounding of three products
    for turned, base in ((own.before, v.before), (own.after, v.after)):
        np.testing.assert_allclose(np.einsum("nij,nj->ni", R, turned), base, atol=1e-17)
    assert v.in_axes("base") is v


def test_residuals_along_the_path_are_along_the_last_move_level_across_it_and_across_both():
    _, _, v = calibrated("points")
    way = np.diff(v.places, axis=0)
    np.testing.assert_allclose(v.moves[1:], way, atol=1e-15)
    path = v.in_axes("path").after
    assert np.isnan(path[0]).all()
    along = way / np.linalg.norm(way, axis=1, keepdims=True)
    e = v.after[1:]
    # 1e-17: rounding of tenths of a millimetre
    np.testing.assert_allclose(path[1:, 0], np.sum(e * along, axis=1), atol=1e-17)
    level = np.stack([-along[:, 1], along[:, 0], 0 * along[:, 0]], axis=1)
    level /= np.linalg.norm(level, axis=1, keepdims=True)
    np.testing.assert_allclose(path[1:, 1], np.sum(e * level, axis=1), atol=1e-17)
    np.testing.assert_allclose(path[1:, 2], np.sum(e * np.cross(along, level), axis=1), atol=1e-17)


def test_a_path_straight_up_has_its_second_axis_across_x():
    _, _, v = calibrated("points")
    up = v._replace(moves=np.tile([0.0, 0.0, 0.2], (len(v.moves), 1)))
    e = up.in_axes("path").after
    np.testing.assert_allclose(e, v.after[:, [2, 1, 0]] * [1, -1, 1], atol=1e-17)


def test_moves_are_from_the_readings_before_where_these_are_given():
    made = pk.calibration.simulated(ARM, 40, kind="points", seed=3)
    other = ARM.random(5, 40)
    options = {"on_rank_deficiency": "fix", "folds": 0, "conditions": {"previous": other}}
    found = pk.calibrate(ARM, made.q, made.measurements, **options)
    assert found.residuals is not None
    came = found.residuals.places - found.chain.fk(other)[:, :3, 3]
    np.testing.assert_allclose(found.residuals.moves, came, atol=1e-14)


def test_other_axes_are_refused():
    _, _, v = calibrated("points")
    wrong: Any = "world"
    with pytest.raises(pk.errors.InputError, match="axes: expected 'base', 'tool' or 'path'"):
        v.in_axes(wrong)
