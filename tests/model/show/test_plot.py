"""The figure of a chain: points, axes and frames where the chain has them, names as they are."""

from __future__ import annotations

import sys

import numpy as np
import pytest

import poekin as pk
from poekin.errors import InputError, MissingExtra
from poekin.model.show.plot import AXES_COLORS

pytest.importorskip("matplotlib")

HELIX = [0, 0, 1, 0, 0, 0.1]


@pytest.fixture
def arm():
    screws = [pk.screw.revolute([0, 0, 1], [0.2, 0, 0]), pk.screw.prismatic([1, 0, 0]), HELIX]
    home = pk.se3.pose(np.eye(3), [0.5, 0.1, 0.3])
    return pk.Chain(screws, home, frame="space", joint_names=["turn", "slide", "drill"])


def of(axes, style):
    return [np.array(line.get_data_3d()) for line in axes.lines if line.get_linestyle() == style]


def names(axes):
    return [text.get_text().strip() for text in axes.texts]


def test_the_skeleton_joins_base_joints_and_tool(arm):
    q = [0.3, 0.2, -0.4]
    (axes,) = arm.plot(q).axes
    expected = [[0, 0, 0], *arm.joint_poses(q)[:, :3, 3], arm.fk(q)[:3, 3]]
    assert np.array_equal(of(axes, "-")[0].T, expected)


def test_an_axis_lies_on_its_screw_and_shows_its_kind(arm):
    q = [0.3, 0.2, -0.4]
    (axes,) = arm.plot(q).axes
    J = arm.jacobian(q, "space")
    for style, screw, pitch in (("-.", J[:, 0], 0.0), ("--", J[:, 2], 0.1)):
        (line,) = of(axes, style)
        for point in line.T:
            # a point of the axis moves along it alone: ω × p + v = h ω; rounding of numbers below 1 m
            assert np.allclose(
                np.cross(screw[:3], point) + screw[3:], pitch * screw[:3], atol=4e-16
            )
    (slide,) = of(axes, ":")
    direction = slide[:, 1] - slide[:, 0]
    assert np.allclose(direction / np.linalg.norm(direction), J[3:, 1], rtol=0, atol=4e-16)


def test_axes_are_numbered_and_names_out_of_files_are_no_formulas(arm):
    (axes,) = arm.retooled(np.eye(4), "$x$").plot().axes
    assert names(axes) == ["$A_{1}$", "$A_{2}$", "$A_{3}$", "base", r"\$x\$"]


def test_the_frames_are_those_of_base_and_tool_to_one_scale(arm):
    q = [0.3, 0.2, -0.4]
    (axes,) = arm.plot(q, size=(3.0, 4.0)).axes
    assert axes.figure.get_size_inches().tolist() == [3.0, 4.0]
    widths = np.ptp([axes.get_xlim3d(), axes.get_ylim3d(), axes.get_zlim3d()], axis=1)
    frames = [c for c in axes.collections if c.get_linewidth()[0] == 1.6]
    for T, arrows in ((np.eye(4), frames[:3]), (arm.fk(q), frames[3:])):
        shafts = np.array([arrow._segments3d[0] for arrow in arrows])
        lengths = shafts[:, 0] - shafts[:, 1]
        assert np.allclose(shafts[:, 1], T[:3, 3], rtol=0, atol=1e-15)
        # 0.35 of half the arm's size, around which the box leaves a tenth
        assert np.allclose(lengths / (0.35 * widths[0] / 2.2), T[:3, :3].T)
    assert len(frames) == 2 * len(AXES_COLORS)
    assert np.allclose(widths, widths[0])
    assert np.ptp(axes._box_aspect) == 0.0  # and they are drawn as long


def test_axes_their_numbers_and_labels_are_within_the_page(arm):
    figure = arm.plot([0.3, 0.2, -0.4])
    (axes,) = figure.axes
    figure.draw_without_rendering()
    found = axes.get_tightbbox()
    assert figure.bbox.x0 <= found.x0 < found.x1 <= figure.bbox.x1
    assert figure.bbox.y0 <= found.y0 < found.y1 <= figure.bbox.y1


@pytest.mark.parametrize("q", [np.zeros((2, 3)), [0.0, np.nan, 0.0]], ids=["batch", "nan"])
def test_what_is_no_single_finite_configuration_is_refused(arm, q):
    with pytest.raises(InputError, match=r"^q: expected one finite configuration \(3,\), got "):
        arm.plot(q)


def test_without_matplotlib_the_extra_is_named(arm, monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(MissingExtra, match=r"pip install 'poekin\[report\]'"):
        arm.plot()


def test_the_box_holds_the_arm_in_its_middle_and_the_labels_stand_ahead_of_their_axes(arm):
    """Half the box is 1.1 of half the longest side; an arrow is 0.3, a label 1.5 of half a line ahead."""
    q = [0.3, 0.2, -0.4]
    (axes,) = arm.plot(q).axes
    skeleton = of(axes, "-")[0]
    low, high = skeleton.min(axis=1), skeleton.max(axis=1)
    half = np.ptp(skeleton, axis=1).max() / 2
    box = np.array([axes.get_xlim3d(), axes.get_ylim3d(), axes.get_zlim3d()])
    assert np.allclose(box.mean(axis=1), (low + high) / 2)
    assert np.allclose(np.ptp(box, axis=1), 2.2 * half)
    frames = arm.joint_poses(q)
    labels = np.array([text.get_position_3d() for text in axes.texts[:3]])
    assert np.allclose(labels, frames[:, :3, 3] + 0.45 * half * frames[:, :3, 2])
    arrows = [c for c in axes.collections if c.get_linewidth()[0] == 0.8]
    for arrow, frame in zip(arrows, frames, strict=True):
        tip, start = arrow._segments3d[0]
        assert np.allclose(start, frame[:3, 3] + 0.3 * half * frame[:3, 2])
        assert np.allclose(tip - start, 0.09 * half * frame[:3, 2])
