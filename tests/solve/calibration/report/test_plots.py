"""The pictures of a calibration show the numbers that they are about, under the right names and
units.
"""

from __future__ import annotations

import numpy as np
import pytest

from poekin import svg
from poekin.solve.calibration.fit.minimise import Step
from poekin.solve.calibration.model.residuals import Residuals
from poekin.solve.calibration.report import plots
from poekin.solve.calibration.report.changes import NamedResiduals

matplotlib = pytest.importorskip("matplotlib")


@pytest.fixture
def drawn(drawn_figures):
    """The figures that are drawn; in the end each has to be legible."""
    yield drawn_figures
    for figure in drawn_figures:
        _legible(figure)


def _legible(figure):
    """Lines that are seen and are no bars, and dots that are dots; what is measured lies above grid
    and marks.
    """
    for axes in figure.axes:
        assert not axes.spines["top"].get_visible()
        assert axes.spines["left"].get_visible()
        for line in axes.lines:
            assert 0.5 <= line.get_linewidth() <= 1.6
            assert 3 <= line.get_markersize() <= 6
        grid = [
            line
            for axis in (axes.xaxis, axes.yaxis)
            for line in axis.get_gridlines()
            if line.get_visible()
        ]
        assert all(0.5 <= line.get_linewidth() <= 0.7 for line in grid)
        assert not grid or axes.get_axisbelow() in (True, "line")


def residuals(lengths, angles=None):
    n = len(lengths)
    angles = np.full(n, np.nan) if angles is None else np.array(angles)
    return Residuals(np.array(lengths), angles, np.zeros(n, int), np.arange(n))


def test_residuals_are_shown_in_mm_and_mrad_over_the_share_that_is_no_larger(drawn):
    curves = [NamedResiduals("nominal", residuals([0.004, 0.001], [2e-3, 1e-3])),
              NamedResiduals("calibrated", residuals([3e-6, 0.0, 1e-6, 2e-6], [0, 0, 0, 1e-6]))]  # fmt: skip
    text = plots.residuals(curves)
    assert text.startswith("<svg")
    (figure,) = drawn
    assert figure.get_size_inches().tolist() == [9.0, 3.5]
    position, rotation = figure.axes
    assert (position.get_xlabel(), rotation.get_xlabel()) == (
        "position error (mm)",
        "rotation error (mrad)",
    )
    assert (position.get_ylabel(), position.get_ylim()) == ("share of measurements (%)", (0, 103))
    assert position.get_shared_y_axes().joined(position, rotation)
    least = 1e-12  # where the logarithmic axis ends for what is 0
    for axes, expected in (
        (position, [([1, 4], [50, 100]), ([least, 1e-3, 2e-3, 3e-3], [25, 50, 75, 100])]),
        (rotation, [([1, 2], [50, 100]), ([least] * 3 + [1e-3], [25, 50, 75, 100])]),
    ):
        assert axes.get_xscale() == "log"
        *curves, half = axes.lines
        assert [line.get_label() for line in curves] == ["nominal", "calibrated"]
        for line, (x, share) in zip(curves, expected, strict=True):
            assert line.get_xdata() == pytest.approx(x, rel=1e-9, abs=0)
            assert line.get_ydata() == pytest.approx(share)
        assert half.get_ydata() == [50, 50]
        assert axes.xaxis.get_major_formatter()(1000.0, 0) == "1000"
    hollow, full = position.lines[:2]
    assert (hollow.get_markerfacecolor(), full.get_markerfacecolor()) == ("white", svg.INK)
    assert [words.get_text() for words in figure.legends[0].get_texts()] == [
        "nominal",
        "calibrated",
    ]
    assert figure.legends[0]._ncols == 3


def test_a_third_curve_is_dotted_and_as_legible(drawn):
    plots.residuals([NamedResiduals(name, residuals([1e-3, 2e-3])) for name in "abc"])
    third = drawn[0].axes[0].lines[2]
    assert (third.get_linestyle(), third.get_label()) == (":", "c")


def test_small_uncertainties_of_any_number_of_configurations_fill_the_picture(drawn):
    plots.uncertainty(np.full(30, 0.5e-3), np.full(30, 0.2e-3))
    for axes, value in zip(drawn[0].axes, (0.5, 0.2), strict=True):
        assert axes.get_xlim() == pytest.approx((0, 1.05 * value))
        assert axes.lines[0].get_xdata() == pytest.approx([value] * 2, rel=1e-9)
        assert sum(bar.get_height() for bar in axes.patches) == pytest.approx(100)


def test_where_nothing_turns_no_rotations_are_shown(drawn):
    mixed = NamedResiduals("b", residuals([1e-3, 2e-3], [np.nan, 5e-3]))
    plots.residuals([NamedResiduals("a", residuals([1e-3]))])
    plots.residuals([NamedResiduals("a", residuals([1e-3])), mixed])
    assert [len(figure.axes) for figure in drawn] == [1, 2]
    _, line, _ = drawn[1].axes[1].lines
    assert (line.get_xdata().tolist(), line.get_ydata().tolist()) == ([5.0], [100.0])


def test_many_measurements_are_thinned_out_evenly():
    values = np.random.default_rng(0).permutation(np.arange(1.0, 4001))
    x, share = plots._shares(values)
    assert len(x) == plots.MOST_DOTS
    assert (x[0], x[-1], share[-1]) == (1, 4000, 100)
    assert share == pytest.approx(100 * x / 4000)
    assert set(np.diff(x)) == {10, 11} or np.diff(x).max() - np.diff(x).min() <= 1
    assert [a.tolist() for a in plots._shares(np.array([np.nan]))] == [[], []]


def test_uncertainties_are_shares_of_the_configurations_in_mm_and_mrad(drawn):
    length, angle = 1e-3 * np.arange(1.0, 51), np.zeros(50)
    plots.uncertainty(length, angle)
    (figure,) = drawn
    assert figure.get_size_inches().tolist() == [9.0, 2.9]
    position, rotation = figure.axes
    assert position.get_xlabel() == "standard deviation of the position (mm)"
    assert rotation.get_xlabel() == "standard deviation of the rotation (mrad)"
    assert (position.get_xlim(), rotation.get_xlim()) == (
        pytest.approx((0, 52.5)),
        pytest.approx((0, 1.05)),
    )
    for axes, top, median in ((position, 50, 25.5), (rotation, 1, 0)):
        assert len(axes.patches) == 30
        assert sum(bar.get_height() for bar in axes.patches) == pytest.approx(100)
        assert axes.patches[0].get_x() == pytest.approx(0, abs=1e-12)
        assert axes.patches[-1].get_x() + axes.patches[-1].get_width() == pytest.approx(1.02 * top)
        assert axes.lines[0].get_xdata() == pytest.approx([median] * 2)
        assert 0.5 <= axes.patches[0].get_linewidth() <= 1
    assert rotation.patches[0].get_height() == pytest.approx(100)
    assert position.get_ylabel() == "share of configurations (%)"
    assert position.get_shared_y_axes().joined(position, rotation)
    assert not position.get_legend().get_frame_on()
    assert [words.get_text() for words in position.get_legend().get_texts()] == ["median"]


def test_the_steps_of_the_search_are_numbered_from_1_and_damped_ones_are_hollow(drawn):
    plots.steps([Step(100.0, 0.1, 0.0), Step(10.0, 0.0, 1e-4), Step(1.0, 0.01, 0.0)])
    plots.steps([Step(0.0, 0.0, 0.0)])
    figure, nothing = drawn
    assert figure.get_size_inches().tolist() == [9.0, 2.7]
    for axes, label, values in (
        (figure.axes[0], "cost before the step", [100, 10, 1]),
        (figure.axes[1], "length of the step (rad, reaches)", [0.1, np.nan, 0.01]),
    ):
        assert (axes.get_xlabel(), axes.get_ylabel(), axes.get_yscale()) == ("step", label, "log")
        way, full, damped = axes.lines
        np.testing.assert_array_equal(way.get_xdata(), [1, 2, 3])
        np.testing.assert_array_equal(way.get_ydata(), values)
        np.testing.assert_array_equal(full.get_xdata(), [1, 3])
        np.testing.assert_array_equal(full.get_ydata(), [values[0], values[2]])
        np.testing.assert_array_equal(damped.get_xdata(), [2])
        np.testing.assert_array_equal(damped.get_ydata(), values[1:2])
        assert (full.get_markerfacecolor(), damped.get_markerfacecolor()) == (svg.INK, "white")
        assert axes.xaxis.get_major_locator()._integer
    assert [axes.get_yscale() for axes in nothing.axes] == ["linear"] * 2
