"""Base and tool: those that were planted, with their covariance, and said to be held where they are."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import poekin as pk
from poekin.groups import se3
from poekin.model import screw
from poekin.solve.calibration.diagnostics.base_and_tool import (
    _fixed,
    base_and_tool,
    pose_points,
)
from poekin.solve.calibration.model.error_model import ErrorModel
from poekin.solve.calibration.report import pendant

ARM = pk.load("ur5").chain()
POSE = pose_points(ARM.reach)
OPTIONS = {"folds": 0, "on_rank_deficiency": "fix"}


def calibrated(kind, **options):
    made = pk.calibration.simulated(ARM, 40, kind=kind, seed=3, **options)
    return pk.calibrate(ARM, made.q, made.measurements, **OPTIONS)


@pytest.fixture(scope="module")
def of_poses():
    return calibrated("poses")


@pytest.fixture(scope="module")
def of_one_point():
    return calibrated("points", points=[0.05, 0.03, 0.1])


@pytest.fixture(scope="module")
def of_board():
    return calibrated("eye-in-hand")


SMALL = (
    se3.exp([0.01, -0.02, 0.03, 0.05, -0.1, 0.2]),
    se3.exp([0.0, 0.02, 0.1, 0.02, 0.0, 0.1]),
)
FAR = (se3.exp([0.0, 0.0, 2.0, 1.0, 2.0, 0.5]), se3.exp([1.0, 1.5, 0.0, 0.1, 0.1, 0.3]))


def seen(found, P, Q, p) -> Any:
    """Estimate of an arm with parameters p, whose nominal one has another base and another tool."""
    return SimpleNamespace(
        model=SimpleNamespace(nominal=ARM.rebased(se3.inverse(P)).retooled(se3.inverse(Q))),
        at=lambda q: found.error_model.poses_and_twists(p, q),
    )


@pytest.mark.parametrize(("P", "Q"), [SMALL, FAR])
def test_a_base_and_a_tool_that_were_moved_are_found(P, Q, of_poses):
    nothing = np.zeros(len(of_poses.values))
    found = base_and_tool(seen(of_poses, P, Q, nothing), POSE)
    # rounding of poses of some m, by a condition below 100
    np.testing.assert_allclose(found.base, P, atol=1e-12)
    np.testing.assert_allclose(found.tool, Q, atol=1e-12)
    assert found.before > 0.05
    assert found.after < 1e-12


def test_a_tool_turned_by_half_a_turn_is_found_on_an_arm_of_two_joints():
    # from where the search begins it ends 0.77 m off
    axes = [screw.revolute([0, 0, 1], [0, 0, 0]), screw.revolute([0, 1, 0], [0.3, 0, 0.5])]
    arm = pk.Chain.from_space(axes, se3.exp([0, 0, 0, 0.8, 0, 0.5]))
    P, Q = se3.exp([0, 0, 1.5, 1, 0.5, 0]), se3.exp([0, 3.0, 0, 0.1, 0, 0.2])
    model = ErrorModel(arm, ("screws", "home"), None)
    nothing = np.zeros(len(model.parameters))
    estimate: Any = SimpleNamespace(
        model=SimpleNamespace(nominal=arm.rebased(se3.inverse(P)).retooled(se3.inverse(Q))),
        at=lambda q: model.poses_and_twists(nothing, q),
    )
    found = base_and_tool(estimate, pose_points(arm.reach))
    assert found.before > 1.0
    assert found.after < 1e-12


@pytest.mark.parametrize(("P", "Q"), [SMALL, FAR])
def test_motions_are_the_derivatives_of_base_and_tool(P, Q, of_poses):
    p = of_poses.values
    found = base_and_tool(seen(of_poses, P, Q, p), POSE)
    step = 1e-5 * np.random.default_rng(0).normal(size=len(p))
    ahead = base_and_tool(seen(of_poses, P, Q, p + step), POSE)
    behind = base_and_tool(seen(of_poses, P, Q, p - step), POSE)
    for frame, part in (("base", slice(0, 6)), ("tool", slice(6, 12))):
        change = se3.log(se3.inverse(getattr(behind, frame)) @ getattr(ahead, frame))
        # Gauss-Newton's derivative leaves out the residuals' curvature: 5 mm of 1 m, and over
        # the tenth of a metre that tells a rotation
        close = 0.05 * np.abs(change).max()
        np.testing.assert_allclose(found.motions[part] @ (2 * step), change, atol=close)


def test_poses_tell_all_of_base_and_tool(of_poses):
    base, tool = of_poses.tool_and_base
    assert (base.name, tool.name) == ("base", "tool")
    for frame in (base, tool):
        assert not any(number.held for number in pendant.typed(frame, "ur"))
        assert (np.diag(frame.covariance) > 0).all()


def test_one_point_tells_its_place_on_the_tool_and_no_rotation(of_one_point):
    base, tool = of_one_point.tool_and_base
    assert not any(number.held for number in pendant.typed(base, "kuka"))
    numbers = pendant.typed(tool, "kuka")
    assert [number.held for number in numbers] == [False] * 3 + [True] * 3
    # the point, to 5 mm: the arm's own errors are of 1 mm
    np.testing.assert_allclose([n.value for n in numbers[:3]], [50.0, 30.0, 100.0], atol=5.0)


@pytest.mark.parametrize(
    ("kind", "options", "held"),
    [
        ("points", {"points": np.eye(3) / 10}, False),
        ("points", {"points": np.eye(3)[:2] / 10}, True),
        ("distances", {}, True),
    ],
)
def test_the_tool_is_turned_as_three_points_of_it_tell(kind, options, held):
    found = calibrated(kind, **options)
    turned = pendant.typed(found.tool_and_base[1], "ur")[3:]
    assert any(number.held for number in turned) == held


def test_frames_of_a_camera_hold_base_and_tool_and_stand_beside_them(of_board):
    frames = {frame.name: frame for frame in of_board.tool_and_base}
    assert list(frames) == ["base", "tool", "T_base_board", "T_tip_camera"]
    assert pendant.is_held(frames["base"])
    assert pendant.is_held(frames["tool"])
    for name in ("base", "tool"):
        assert np.linalg.matrix_rank(frames[name].held, tol=0.1) == 6
    board = frames["T_base_board"]
    np.testing.assert_array_equal(board.T, of_board.frames["T_base_board"])
    assert not any(number.held for number in pendant.typed(board, "fanuc"))
    mine = [k for k, p in enumerate(of_board.parameters) if p.owner == "T_base_board"]
    J = se3.right_jacobian(of_board.values[mine])
    C = of_board.covariance[np.ix_(mine, mine)]
    np.testing.assert_allclose(board.covariance, J @ C @ J.T, rtol=1e-12)


@pytest.mark.parametrize("form", list(pendant.FORMS.values()))
def test_intervals_are_those_of_numbers_of_frames_that_scatter(form, of_board):
    frame = of_board.tool_and_base[2]
    rng = np.random.default_rng(1)
    xi = rng.multivariate_normal(np.zeros(6), frame.covariance, 4000)
    drawn = pk.poses.to_numbers(frame.T @ se3.exp(xi), form)
    numbers = pendant.typed(frame, form)
    np.testing.assert_array_equal([n.value for n in numbers], pk.poses.to_numbers(frame.T, form))
    # a deviation of 4000 numbers is known to 1.1 %: five of these
    np.testing.assert_allclose([n.margin for n in numbers], 1.96 * drawn.std(axis=0), rtol=0.056)


def test_a_terminal_shows_all_forms_and_what_is_held(of_one_point, of_board):
    lines = str(of_one_point).split("\n")
    at = lines.index("tool in the nominal tip 'tool', to be typed in (± 95 %):")
    for line, name in zip(lines[at + 1 : at + 6], pendant.FORMS, strict=True):
        assert line.startswith(f"  {name} (")
        assert line.count("±") == 3 + (name == "ROS xyz xyzw")
        assert line.count("held") == 3
    tool = of_one_point.tool_and_base[1]
    x, *_, w = pendant.typed(tool, "fanuc")
    assert f"  Fanuc (mm, deg): X {x.value:.3f} ± {x.margin:.3f}  Y " in lines[at + 3]
    assert lines[at + 3].endswith(f"R {w.value + 0.0:.4f} held")
    held = "base 'base' in the frame that was measured in: held, these measurements do not tell it"
    lines = str(of_board).split("\n")
    assert held in lines
    assert "T_base_board, to be typed in (± 95 %):" in lines


def test_directions_without_variance_are_told_in_rad_and_reaches():
    known = np.array([0.6, 0.8])  # of 0.6 rad and 0.8 reaches of 2 m
    scale = np.array([1.0, 2.0])
    estimate: Any = SimpleNamespace(
        model=SimpleNamespace(nominal=SimpleNamespace(reach=2.0)),
        parameters=[SimpleNamespace(unit="rad"), SimpleNamespace(unit="m")],
        covariance=np.outer(scale * known, scale * known),
    )
    (direction,) = _fixed(estimate).T
    np.testing.assert_allclose(direction * np.sign(direction[0]), [0.8, -0.6], atol=1e-15)
