"""Pictures of residuals: each panel has those along the motion of its joint against its own numbers."""

from __future__ import annotations

import numpy as np
import pytest

from poekin import svg
from poekin.solve.calibration.report import residual_plots
from poekin.solve.calibration.terms.gravity import levers, wrist_in_tip
from tests.solve.calibration.diagnostics.effects.planted import ARM, ROWS, calibrated

pytest.importorskip("matplotlib")


@pytest.fixture(scope="module")
def found():
    return calibrated("sag", 1)


@pytest.fixture(scope="module")
def pictures(found):
    return list(residual_plots.pictures(found.residuals, found.evidence))


def test_each_joint_has_its_residuals_along_its_motion(found, pictures):
    q = found.residuals.q
    e = found.residuals.after
    rows = np.repeat(np.arange(ROWS), 3)
    values = pictures[0]
    assert values.words == "Residuals along the motion of each joint against each joint's value."
    assert [panel.label for panel in values.panels] == [f"{name} (deg)" for name in ARM.q_names]
    step = 1e-6
    for i, panel in enumerate(values.panels):
        np.testing.assert_allclose(panel.x, np.rad2deg(q[rows, i]), rtol=1e-12)
        ahead = q.copy()
        ahead[:, i] += step
        moved = found.chain.fk(ahead) @ np.linalg.inv(found.chain.fk(q))
        places = found.residuals.places
        way = (moved[rows, :3, :3] @ places[..., None])[..., 0] + moved[rows, :3, 3] - places
        size = np.linalg.norm(way, axis=1)
        along = 1e3 * np.sum(e * way, axis=1) / size
        # differences of 1e-6: a part in 1e5 of 1 mm where the point moves by a centimetre
        some = size > 1e-2 * step
        np.testing.assert_allclose(panel.y[some], along[some], atol=1e-5)


def test_levers_are_of_joints_that_carry_and_moves_are_the_last(found, pictures):
    q = found.residuals.q
    rows = found.residuals.rows
    _, of_levers, of_moves, of_places = pictures
    down = np.tile([0.0, 0.0, -1.0], (ROWS, 1))
    carried = levers(ARM, q, down, wrist_in_tip(ARM))
    # joint 1 stands upright and carries nothing
    assert [panel.label for panel in of_levers.panels] == [
        f"{name} (m)" for name in ARM.q_names[1:]
    ]
    for i, panel in enumerate(of_levers.panels, 1):
        np.testing.assert_array_equal(panel.x, carried[rows, i])
    moves = np.diff(q, axis=0, prepend=q[:1])
    for i, panel in enumerate(of_moves.panels):
        np.testing.assert_allclose(panel.x, np.rad2deg(moves[rows, i]), rtol=1e-12)
    e = 1e3 * found.residuals.after
    for k, panel in enumerate(of_places.panels):
        np.testing.assert_array_equal(panel.y, e[:, k % 3])
        x = found.residuals.places[:, k % 3] if k > 2 else rows
        np.testing.assert_array_equal(panel.x, x)
    assert [panel.label for panel in of_places.panels[2:4]] == [
        "row: residual along z",
        "x (m): residual along x",
    ]


def test_panels_share_their_scale_and_show_means_with_their_errors(drawn_figures):
    rng = np.random.default_rng(0)
    x = rng.normal(size=400)
    y = 0.3 * x + rng.normal(size=400)
    y[::50] = np.nan
    panels = [residual_plots.Panel(x, k * y, f"panel {k}") for k in range(1, 5)]
    text = residual_plots.drawn(residual_plots.Picture(panels, "words"))
    assert text.startswith("<svg")
    (figure,) = drawn_figures
    assert figure.get_size_inches().tolist() == [9.0, pytest.approx(3.8)]
    axes = figure.axes
    assert [a.get_visible() for a in axes] == [True] * 4 + [False] * 2
    assert [a.get_ylabel() for a in axes[:4]] == ["mm", "", "", "mm"]
    assert axes[0].get_shared_y_axes().joined(axes[0], axes[3])
    dots = axes[1].lines[0]
    shown = np.asarray(dots.get_xdata(), float)
    some = x[np.isfinite(y)]
    assert (len(shown), shown[0], shown[-1]) == (120, some[0], some[-1])
    for line in (*axes[1].lines, *axes[1].get_ygridlines()):
        assert 0.5 <= line.get_linewidth() <= 1.5
    assert dots.get_color() == svg.PALE
    means, _, (bars,) = axes[1].containers[0]
    assert 0.5 <= min(bars.get_linewidths()) <= max(bars.get_linewidths()) <= 1.5
    assert 1.5 <= dots.get_markersize() < means.get_markersize() <= 4
    known = np.flatnonzero(np.isfinite(y))
    parts = np.array_split(known[np.argsort(x[known])], 8)
    np.testing.assert_allclose(
        np.asarray(means.get_xdata(), float), [x[part].mean() for part in parts]
    )
    np.testing.assert_allclose(
        np.asarray(means.get_ydata(), float), [2 * y[part].mean() for part in parts]
    )
    errors = [2 * np.std(2 * y[part], ddof=1) / np.sqrt(len(part)) for part in parts]
    lengths = [np.ptp(segment[:, 1]) / 2 for segment in bars.get_segments()]
    np.testing.assert_allclose(lengths, errors)


def test_two_residuals_are_enough_for_a_mean_with_its_error(drawn_figures):
    x = np.arange(11.0)
    residual_plots.drawn(residual_plots.Picture([residual_plots.Panel(x, x**2, "few")], "words"))
    means, _, _ = drawn_figures[0].axes[0].containers[0]
    # eight parts of eleven: three of two, five of one
    np.testing.assert_array_equal(means.get_xdata(), [0.5, 2.5, 4.5])


def test_one_residual_has_a_picture_too(drawn_figures):
    panel = residual_plots.Panel(np.ones(1), np.ones(1), "one")
    residual_plots.drawn(residual_plots.Picture([panel], "words"))
    assert not drawn_figures[0].axes[0].containers
