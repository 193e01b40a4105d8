"""What is marked on a path, and which of its rows a page plays."""

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
from poekin.solve.path.joint_path import joint_path
from poekin.solve.path.path_events import PathEvent
from poekin.view.nodes import Label, Polyline, Triangles
from poekin.view.scenes import path as module
from poekin.view.scenes.stage import make_stage
from tests.view.narrowed import all_of

ARM = pk.load("stanford").chain()
Q = np.linspace(0.1, 0.3, 12)[:, None] * np.ones(6)


def test_a_page_plays_two_thousand_rows_in_ten_seconds_and_draws_two_dozen_poses():
    assert (module.ROWS, module.SECONDS, module.FRAMES) == (2000, 10.0, 24)


@pytest.mark.parametrize(
    ("first", "last", "played"),
    [
        (0, 11, (0, 3)),
        (0, 0, (0, 0)),
        (4, 8, (1, 2)),
        (5, 7, (2, 2)),  # between two rows: the next one
        (1, 8, (1, 2)),
        (4, 4, (1, 1)),
        (10, 11, (3, 3)),
        (12, 14, (3, 3)),  # behind them all: the last one
    ],
)
def test_an_event_is_marked_from_the_first_to_the_last_row_that_is_played_in_it(
    first, last, played
):
    event = PathEvent(first, last, "limit", "words")
    found = module._by_rows(event, np.array([0, 4, 8, 11]))
    assert (found.first, found.last) == played
    assert (found.kind, found.text) == ("limit", "words")


def drawn(monkeypatch, points, *events):
    """Size of the stage, and what is drawn of a path through points with these events."""
    path = joint_path(ARM, Q)
    monkeypatch.setattr(type(path), "events", property(lambda _: events))
    stage = make_stage(path.chain, path.q[0], None)
    return stage.size, list(module._way(path, points, stage))


def test_the_way_is_thin_a_stretch_of_it_thicker_and_a_single_pose_a_ball(monkeypatch):
    """Widths and the radius of the ball are 5, 12.5 and 12.5 thousandths of the arm's size."""
    points = ARM.fk(Q)[:, :3, 3]
    events = (
        PathEvent(4, 6, "limit", "a stretch"),
        PathEvent(11, 11, "singular", "the end"),
        PathEvent(3, 3, "switch", "a branch"),
    )
    size, (way, stretch, end, branch, label) = drawn(monkeypatch, points, *events)
    assert isinstance(way, Polyline)
    assert isinstance(stretch, Polyline)
    assert isinstance(label, Label)
    # 0.0125 size may be the product of three numbers or of two: a rounding each.
    assert way.width == pytest.approx(0.005 * size, rel=4e-16)
    assert stretch.width == pytest.approx(0.0125 * size, rel=4e-16)
    np.testing.assert_array_equal(way.points, points)
    np.testing.assert_array_equal(stretch.points, points[4:7])
    for ball, k in ((end, 11), (branch, 3)):
        assert isinstance(ball, Triangles)
        assert len(ball.vertices) == 7 * 16 + 2  # 16 sides, as far as a ball so small shows
        away = np.linalg.norm(ball.vertices - points[k], axis=1)
        np.testing.assert_allclose(away, 0.0125 * size, rtol=1e-9)
    np.testing.assert_allclose(label.point, points[3] + 0.03 * size, rtol=1e-15)
    assert label.text == "branch changes before pose 3"
    names = [node.attachment.name for node in (stretch, end, branch, label)]
    assert names == ["a stretch", "the end", "a branch", "a branch"]


def test_an_event_whose_poses_are_all_unknown_is_not_drawn_and_others_are(monkeypatch):
    points = ARM.fk(Q)[:, :3, 3]
    points[2:5] = np.nan
    events = (PathEvent(2, 4, "missed", "unknown"), PathEvent(3, 6, "limit", "half known"))
    _, nodes = drawn(monkeypatch, points, *events)
    way, half = all_of(Polyline, nodes)
    assert half.attachment.name == "half known"
    np.testing.assert_array_equal(half.points, points[5:7])
    np.testing.assert_array_equal(way.points, np.delete(points, [2, 3, 4], axis=0))
