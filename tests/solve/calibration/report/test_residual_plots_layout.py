"""Panels of residuals have room: what is written beside them is in the picture and on no other."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from poekin.solve.calibration.report import residual_plots

pytest.importorskip("matplotlib")


@pytest.mark.parametrize("count, lines", [(1, 1), (3, 1), (4, 2), (7, 3)])
def test_labels_of_panels_are_in_the_picture_and_on_no_other_panel(count, lines, drawn_figures):
    rng = np.random.default_rng(0)
    # as wide as labels of residuals get: a sign and two digits before a point
    panels = [
        residual_plots.Panel(rng.normal(size=50), 12.5 * rng.normal(size=50), f"joint_{k} (deg)")
        for k in range(count)
    ]
    residual_plots.drawn(residual_plots.Picture(panels, "words"))
    (figure,) = drawn_figures
    width, height = figure.get_size_inches()
    assert (width, height) == pytest.approx((9.0, 0.4 + 1.7 * lines))
    shown = [axes for axes in figure.axes if axes.get_visible()]
    boxes = [axes.get_tightbbox() for axes in shown]
    for box in boxes:
        x0, y0, x1, y1 = box.extents / figure.dpi
        assert 0.0 < x0 < x1 < width
        assert 0.0 < y0 < y1 < height
    assert not any(one.overlaps(other) for one, other in combinations(boxes, 2))
    for axes in shown:
        own = axes.get_window_extent()
        # of a ninth of nine inches for what is written, and of two thirds of a line
        assert own.width / figure.dpi > 2.5
        assert own.height / figure.dpi > 1.15
    # the ends of the first column of labels, of the last row and of the first one
    left, bottom, _, top = np.transpose([box.extents / figure.dpi for box in boxes])
    assert left.min() < 0.3
    assert bottom.min() < 0.3
    assert height - top.max() < 0.3
    # panels from half an inch above the lower edge to a tenth below the upper one
    assert height * figure.subplotpars.bottom == pytest.approx(0.5, rel=1e-12)
    assert height * (1.0 - figure.subplotpars.top) == pytest.approx(0.1, rel=1e-12)
