"""The picture of joints over time shows each coordinate with its name, unit, limits and breaks."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.errors import ShapeError
from poekin.solve import motion

pytest.importorskip("matplotlib")

ARM = pk.Chain.from_space(
    [pk.screw.revolute([0, 0, 1], [0, 0, 0]), pk.screw.prismatic([1, 0, 0])], np.eye(4),
    joint_names=["turn", "slide"], limits=[[-50, 50], [0.25, 1.5]],
)  # fmt: skip


def test_each_coordinate_is_drawn_over_time_and_not_joined_across_a_break(drawn_figures):
    q = np.array([[0, 0], [1, 1], [2, 2], [10, 0], [12, 1.0]])
    times = np.array([0, 1, 3, 4, 8.0])
    motion.plot_joints(q, ARM, times=times, breaks=[0, 3, 5, 6])
    motion.plot_joints(q, ARM)
    timed, numbered = drawn_figures
    assert timed.get_size_inches() == pytest.approx([7.2, 2.7])
    for k, axes in enumerate(timed.axes):
        first, last, gap = axes.lines
        for line, part in ((first, slice(0, 3)), (last, slice(3, 5))):
            np.testing.assert_array_equal(line.get_xdata(), times[part])
            np.testing.assert_array_equal(line.get_ydata(), q[part, k])
        assert (gap.get_xdata(), gap.get_linestyle()) == (
            [3.5, 3.5],
            ":",
        )  # halfway between the third and the fourth
        assert axes.get_title(loc="left") == ["turn (rad)", "slide (m)"][k]
        assert all(0.5 <= line.get_linewidth() <= 1.5 for line in axes.lines)
        assert not axes.spines["top"].get_visible()
    assert [axes.get_xlabel() for axes in timed.axes] == ["", "time (s)"]
    assert [axes.get_xlabel() for axes in numbered.axes] == ["", "point"]
    np.testing.assert_array_equal(numbered.axes[1].lines[0].get_xdata(), np.arange(5))


def test_a_break_may_be_before_the_second_point_and_before_the_last(drawn_figures):
    motion.plot_joints(np.zeros((5, 2)), ARM, breaks=[1, 4])
    first, second = drawn_figures[0].axes
    curves = [len(line.get_xdata()) for line in first.lines]
    assert curves == [1, 3, 1, 2, 2]
    assert [line.get_xdata()[0] for line in first.lines[3:]] == [0.5, 3.5]
    assert first.get_shared_x_axes().joined(first, second)


def test_what_is_within_the_limits_is_shaded_behind_the_curve_and_limits_far_off_do_not_squeeze_it(
    drawn_figures,
):
    motion.plot_joints([[0, 0], [1, 1.0]], ARM)
    (drawn,) = drawn_figures
    for axes, (low, high) in zip(drawn.axes, ((-1.15, 2.15), (0.25, 1.5)), strict=True):
        (shade,) = axes.patches
        assert (shade.get_y(), shade.get_y() + shade.get_height()) == pytest.approx((low, high))
        assert shade.get_zorder() < axes.lines[0].get_zorder()
        assert axes.get_ylim() == pytest.approx((-0.05, 1.05))


def test_an_arm_without_joints_has_an_empty_picture(drawn_figures):
    motion.plot_joints(np.zeros((3, 0)), pk.Chain.from_space(np.zeros((0, 6)), np.eye(4)))
    assert drawn_figures[0].get_size_inches() == pytest.approx([7.2, 1.6])
    assert len(drawn_figures[0].axes) == 1


@pytest.mark.parametrize("q, times, words", [
    (np.zeros(2), None, r"q: expected shape \(N, 2\), got \(2,\)"),
    (np.zeros((4, 3)), None, r"q: expected shape \(N, 2\), got \(4, 3\)"),
    (np.zeros((4, 2)), np.zeros(3), r"times: expected shape \(4,\), got \(3,\)"),
])  # fmt: skip
def test_what_is_no_path_is_not_drawn(q, times, words):
    with pytest.raises(ShapeError, match=words):
        motion.plot_joints(q, ARM, times=times)
