"""The scene of a calibration: two arms at the same coordinates, and residuals as arrows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import poekin as pk
from poekin.view.nodes import Cloud, Triangles
from poekin.view.scenes.arm import arm_size
from poekin.view.scenes.arm_parts.of_chain import chain_geometry
from poekin.view.scenes.calibration import MOST, calibration_scene

ARM = pk.load("ur5").chain()


@pytest.fixture(scope="module")
def found():
    made = pk.calibration.simulated(ARM, 40, kind="points", seed=2)
    return pk.calibrate(ARM, made.q, made.measurements, on_rank_deficiency="fix", folds=0)


def test_both_arms_have_the_same_coordinates_and_the_calibrated_one_is_that_of_the_result(found):
    scene = calibration_scene(found)
    first, second = scene.arms
    assert scene.q.tolist() in found.residuals.q.tolist()
    np.testing.assert_array_equal(second.base, np.eye(4))
    np.testing.assert_array_equal(second.factors[:-1], np.eye(6))
    assert second.shift[-1] == scene.exaggerated > 1
    assert [s.name for s in first.coordinates] == list(ARM.q_names)


def test_joints_of_a_calibrated_arm_with_coupled_readings_follow_the_same_sliders():
    arm = pk.dh.to_chain(pk.dh.published("puma560")).coupled("J3 = J2 + J3")
    made = pk.calibration.simulated(arm, 30, seed=2)
    found = pk.calibrate(arm, made.q, made.measurements, on_rank_deficiency="fix", folds=0)
    _, second = calibration_scene(found).arms
    np.testing.assert_array_equal(second.factors[:-1], arm.coupling)
    assert not np.array_equal(arm.coupling, np.eye(6))


def test_arrows_go_from_the_measured_points_by_the_residuals_enlarged_as_the_words_say(found):
    scene = calibration_scene(found)
    v = found.residuals
    (cloud,) = [n for n in scene.nodes if isinstance(n, Cloud)]
    np.testing.assert_allclose(cloud.points, v.places - v.after, atol=1e-15)
    (words,) = [w for w in scene.words if w.startswith("Residuals are drawn")]
    k = float(words.split()[3])
    (red,) = [n for n in scene.nodes if isinstance(n, Triangles) and n.attachment.role == "differs"]
    assert red.attachment.name == f"residuals of the nominal arm × {k:g}"
    tips = cloud.points + k * v.before
    # each arrow ends at its tip
    gaps = np.linalg.norm(red.vertices[:, None] - tips, axis=-1).min(axis=0)
    assert gaps.max() < 1e-12


def test_the_page_opens_at_the_measured_configuration_at_which_the_arm_is_largest(found):
    arm = chain_geometry(ARM)
    sizes = [arm_size(arm, q) for q in found.residuals.q]
    scene = calibration_scene(found)
    assert scene.size == max(sizes)
    np.testing.assert_array_equal(scene.q, found.residuals.q[np.argmax(sizes)])


def test_corrections_are_a_table_with_a_row_for_each_axis(found):
    (table,) = calibration_scene(found).tables
    assert [row[0] for row in table.rows] == list(ARM.joint_names)
    assert {len(row) for row in table.rows} == {len(table.heads)}


def test_a_calibration_out_of_a_file_is_drawn_without_residuals(found, tmp_path):
    found.save(tmp_path / "arm.toml")
    scene = calibration_scene(pk.calibration.load(tmp_path / "arm.toml"))
    assert not [n for n in scene.nodes if n.attachment.layer == "cloud"]
    assert len(scene.arms) == 2


def test_of_many_residuals_some_are_drawn():
    made = pk.calibration.simulated(ARM, MOST + 100, seed=1)
    many = pk.calibrate(ARM, made.q, made.measurements, folds=0)
    (cloud,) = [n for n in calibration_scene(many).nodes if isinstance(n, Cloud)]
    assert len(cloud.points) == MOST


def test_residuals_of_nothing_have_no_arrows_and_small_ones_are_drawn_a_thousand_times():
    """The calibrated arm is the true one: what is left of its residuals is rounding."""
    screws = ARM.screws.copy()
    screws[2] = pk.se3.adjoint(pk.se3.exp([0, 0, 0, 1e-6, 1e-6, 1e-6])) @ screws[2]
    q = ARM.random(3, size=30)
    found = pk.calibrate(ARM, q, ARM.replace(screws=screws).fk(q), folds=0)
    scene = calibration_scene(found)
    arrows = [n for n in scene.nodes if isinstance(n, Triangles) and n.attachment.layer == "cloud"]
    assert [n.attachment.name for n in arrows] == ["residuals of the nominal arm × 1000"]
    assert all(np.isfinite(n.vertices).all() for n in arrows)


WARNINGS = ("The tool may have slipped.", "An axis is not known.")


@pytest.fixture(scope="module")
def doubtful(found):
    return calibration_scene(replace(found, warnings=WARNINGS))


def test_warnings_of_the_calibration_are_said_on_its_page(doubtful):
    assert doubtful.words[1:3] == WARNINGS


def test_measured_points_are_coloured_by_the_residuals_of_the_nominal_arm(found, doubtful):
    (cloud,) = [n for n in doubtful.nodes if isinstance(n, Cloud)]
    lengths = np.linalg.norm(found.residuals.before, axis=1)
    np.testing.assert_allclose(np.asarray(cloud.values), lengths, rtol=1e-14)


def test_nine_of_ten_arrows_of_both_arms_are_within_a_tenth_of_the_arm(found, doubtful):
    (words,) = [w for w in doubtful.words if w.startswith("Residuals are drawn")]
    both = np.array([found.residuals.before, found.residuals.after])
    lengths = float(words.split()[3]) * np.linalg.norm(both, axis=-1)
    assert np.quantile(lengths, 0.9) <= 0.1 * doubtful.size
